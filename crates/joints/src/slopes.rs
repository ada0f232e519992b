//! Differentiates the rows of a constraint automatically: the programs of the kernels run with dual
//! numbers. This gives the derivatives with respect to the values that a constraint stores. It also
//! gives the derivatives with respect to poses and velocities if these derivatives have no compiled
//! closed form.

use std::ops::{Add, Mul, Neg, Sub};

use crate::program::Programs;
use crate::space::Space;
use crate::spec::{ConstraintSpec, Entry};

/// Number of directions of one dual number: the number of velocity components of a body in space.
const LANES: usize = 6;

/// A value with its derivatives along a few directions.
#[derive(Clone, Copy, Debug)]
struct Dual {
    value: f64,
    slopes: [f64; LANES],
}

impl Dual {
    fn with(value: f64, slope: impl FnMut(usize) -> f64) -> Self {
        Self {
            value,
            slopes: std::array::from_fn(slope),
        }
    }

    /// Returns a value that depends on two dual numbers, given its derivatives with respect to
    /// both.
    fn of(value: f64, [(x, by_x), (y, by_y)]: [(Self, f64); 2]) -> Self {
        Self::with(value, |k| by_x * x.slopes[k] + by_y * y.slopes[k])
    }
}

impl From<f64> for Dual {
    fn from(value: f64) -> Self {
        Self::with(value, |_| 0.0)
    }
}

impl Add for Dual {
    type Output = Self;

    fn add(self, y: Self) -> Self {
        Self::with(self.value + y.value, |k| self.slopes[k] + y.slopes[k])
    }
}

impl Sub for Dual {
    type Output = Self;

    fn sub(self, y: Self) -> Self {
        Self::with(self.value - y.value, |k| self.slopes[k] - y.slopes[k])
    }
}

impl Mul for Dual {
    type Output = Self;

    fn mul(self, y: Self) -> Self {
        Self::of(self.value * y.value, [(self, y.value), (y, self.value)])
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        Self::with(-self.value, |k| -self.slopes[k])
    }
}

/// A kind of constraint, and the values of one constraint in the form that the programs need.
pub(crate) struct OfKind<'k> {
    pub(crate) spec: &'static ConstraintSpec,
    pub(crate) programs: &'k Programs,
    /// The stored values of the constraint that the programs need.
    pub(crate) stored: Vec<f64>,
}

/// The state at which the rows are evaluated.
#[derive(Clone, Copy)]
pub(crate) struct At<'a, S: Space> {
    pub(crate) x: &'a [S::Pose<f64>],
    /// The twists. Γ is computed only if the twists are given.
    pub(crate) v: Option<&'a [S::Twist<f64>]>,
    pub(crate) f: &'a [[f64; 3]],
}

/// Arguments of the kernels of a constraint, with their derivatives along a few directions.
struct DualInputs {
    stored: Vec<Dual>,
    x: Vec<Dual>,
    v: Vec<Dual>,
    f: Vec<[Dual; 3]>,
}

impl DualInputs {
    fn new<S: Space>(of: &OfKind<'_>, at: At<'_, S>) -> Self {
        let (mut x, mut v) = (Vec::new(), Vec::new());
        at.x.iter()
            .for_each(|pose| S::numbers_of_pose(pose, &mut x));
        let twists = at.v.unwrap_or_default().iter();
        v.extend(twists.flat_map(S::velocities));
        let dual = |numbers: Vec<f64>| numbers.into_iter().map(Dual::from).collect();
        Self {
            stored: dual(of.stored.clone()),
            x: dual(x),
            v: dual(v),
            f: at.f.iter().map(|jet| jet.map(Dual::from)).collect(),
        }
    }

    fn poses<S: Space>(&self) -> Vec<S::Pose<Dual>> {
        self.x.chunks_exact(S::N_POSE).map(S::pose).collect()
    }

    fn twists<S: Space>(&self) -> Vec<S::Twist<Dual>> {
        self.v.chunks_exact(S::N_DOF).map(S::twist).collect()
    }

    /// Adds the derivatives of the pose of a body along each of its velocity components.
    fn move_slot<S: Space>(&mut self, slot: usize, pose: &S::Pose<f64>) {
        let own = &mut self.x[S::N_POSE * slot..][..S::N_POSE];
        let mut rates = vec![0.0; S::N_POSE];
        for dof in 0..S::N_DOF {
            S::rates_of_pose(pose, dof, &mut rates);
            for (x, rate) in own.iter_mut().zip(&rates) {
                x.slopes[dof] = *rate;
            }
        }
    }

    /// Adds the derivatives with respect to each velocity component of a body.
    fn accelerate_slot<S: Space>(&mut self, slot: usize) {
        for (dof, v) in self.v[S::N_DOF * slot..][..S::N_DOF].iter_mut().enumerate() {
            v.slopes[dof] = 1.0;
        }
    }
}

/// Sets all derivatives to zero.
fn still(numbers: &mut [Dual]) {
    numbers.iter_mut().for_each(|x| x.slopes = [0.0; LANES]);
}

/// The kernel to be differentiated, with the rows of the block that contain its outputs.
enum Kernel<'a, S: Space> {
    /// Cᵀλ
    Force(&'a [f64]),
    /// C·a − Γ
    Residual(&'a [S::Twist<f64>]),
    /// C·v − b
    Velocity,
    /// Γ
    Gamma,
}

/// Computes the entries of a derivative with respect to the pose or, for Γ, with respect to
/// velocities, in the order of a pattern.
fn block<S: Space>(
    kind: &OfKind<'_>,
    at: At<'_, S>,
    pattern: &[[usize; 2]],
    kernel: &Kernel<'_, S>,
    out: &mut [f64],
) {
    let spec = kind.spec;
    let rows = spec.rows.len();
    let mut seeded = DualInputs::new(kind, at);
    let mut factors = Vec::new();
    match kernel {
        Kernel::Force(lambda) => factors.extend_from_slice(lambda),
        Kernel::Residual(a) => factors.extend(a.iter().flat_map(S::velocities)),
        Kernel::Velocity => factors.extend(seeded.v.iter().map(|v| v.value)),
        Kernel::Gamma => {}
    }
    let column = |e: &Entry| S::N_DOF * e.slot + e.dof;
    for slot in 0..spec.common.slots.len() {
        let by_velocity = matches!(kernel, Kernel::Gamma);
        if by_velocity {
            seeded.accelerate_slot::<S>(slot);
        } else {
            seeded.move_slot::<S>(slot, &at.x[slot]);
        }
        let (x, v) = (seeded.poses::<S>(), seeded.twists::<S>());
        let rows_of = kind.programs.of(&seeded.stored);
        let zero = Dual::from(0.0);
        // Derivatives of the rows, or of the entries of Cᵀλ.
        let mut sums = vec![[0.0; LANES]; rows.max(S::N_DOF * spec.common.slots.len())];
        let mut add = |to: usize, factor: f64, d: &Dual| {
            let slopes = sums[to].iter_mut().zip(d.slopes);
            slopes.for_each(|(sum, slope)| *sum += factor * slope);
        };
        if !by_velocity {
            let mut entries = vec![zero; spec.c.len()];
            rows_of.c::<S>(&x, &seeded.f, &mut entries);
            for (e, d) in spec.c.iter().zip(&entries) {
                match kernel {
                    Kernel::Force(_) => add(column(e), factors[e.row], d),
                    _ => add(e.row, factors[column(e)], d),
                }
            }
        }
        let mut right = vec![zero; rows];
        match kernel {
            Kernel::Force(_) => {}
            Kernel::Velocity => rows_of.b::<S>(&x, &seeded.f, &mut right),
            Kernel::Residual(_) | Kernel::Gamma => {
                rows_of.gamma::<S>(&x, &v, &seeded.f, &mut right);
            }
        }
        let sign = if by_velocity { 1.0 } else { -1.0 };
        for (row, d) in right.iter().enumerate() {
            add(row, sign, d);
        }
        for (&[row, column], out) in pattern.iter().zip(&mut *out) {
            if column / S::N_DOF == slot {
                *out = sums[row][column % S::N_DOF];
            }
        }
        still(&mut seeded.x);
        still(&mut seeded.v);
    }
}

/// `∂(Cᵀλ)/∂x`, by the pattern of the specification.
pub(crate) fn d_force_dx<S: Space>(
    kind: &OfKind<'_>,
    (x, f): (&[S::Pose<f64>], &[[f64; 3]]),
    lambda: &[f64],
    out: &mut [f64],
) {
    let at = At::<S> { x, v: None, f };
    let pattern = kind.spec.d_force_dx;
    block(kind, at, pattern, &Kernel::Force(lambda), out);
}

/// `∂(C·a − Γ)/∂x`
pub(crate) fn d_residual_dx<S: Space>(
    kind: &OfKind<'_>,
    at: At<'_, S>,
    a: &[S::Twist<f64>],
    out: &mut [f64],
) {
    let pattern = kind.spec.d_residual_dx;
    block(kind, at, pattern, &Kernel::Residual(a), out);
}

/// `∂Γ/∂v`
pub(crate) fn d_gamma_dv<S: Space>(kind: &OfKind<'_>, at: At<'_, S>, out: &mut [f64]) {
    block(kind, at, kind.spec.d_gamma_dv, &Kernel::Gamma, out);
}

/// `∂(C·v − b)/∂x`
pub(crate) fn d_velocity_dx<S: Space>(kind: &OfKind<'_>, at: At<'_, S>, out: &mut [f64]) {
    block(kind, at, kind.spec.d_velocity_dx, &Kernel::Velocity, out);
}

/// The outputs of the rows to be differentiated.
#[derive(Clone, Copy, Debug)]
pub enum SlopedOutputs<'a, S: Space> {
    /// Φ.
    Phi,
    /// C.
    C,
    /// Φ, C, and Γ at these twists of the bodies.
    All(&'a [S::Twist<f64>]),
}

/// Derivatives of Φ, C and Γ with respect to each value p of [`crate::Definition::data`]. A value
/// that is computed from other stored values is differentiated as a function of these stored
/// values. Stored initial values are constant in these derivatives, because they are separate
/// values.
///
/// ```
/// use pfaff_joints::generated::Distance;
/// use pfaff_joints::{Argument, Constraint, ConstraintKernels, Definition, Pose, SlopedOutputs};
/// # fn main() -> Result<(), pfaff_joints::ArgumentError> {
/// let ends = [Argument::Pair([0.0, 0.0]), Argument::Pair([0.0, 0.0])];
/// let mut rod = Distance::from_arguments(&ends)?;
/// let x = [Pose::GROUND, Pose::new(3.0, 4.0, 0.0)];
/// rod.initialise(&x);
/// let mut gradient = [0.0; 5];
/// rod.slopes(&x, &[], SlopedOutputs::Phi).phi(&[10.0], &mut gradient);
/// // Φ = (d·d − L²)/(2L): the derivatives are 10·(∓d/L) for the ends and −10 for the length.
/// let expected = [-6.0, -8.0, 6.0, 8.0, -10.0];
/// assert!(gradient.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-14 * e.abs()));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Slopes {
    /// Derivatives of the holonomic rows of Φ with respect to each value. As in the other fields,
    /// the list is empty if these derivatives were not requested.
    phi: Vec<f64>,
    /// Derivatives of the entries of C with respect to each value.
    c: Vec<f64>,
    /// Derivatives of the rows of Γ with respect to each value. The list is empty without
    /// velocities.
    gamma: Vec<f64>,
    entries: &'static [Entry],
    sizes: [usize; 3],
    n_dof: usize,
}

impl Slopes {
    pub(crate) fn of<S: Space>(
        kind: &OfKind<'_>,
        of_stored: &[(usize, usize, f64)],
        (x, f): (&[S::Pose<f64>], &[[f64; 3]]),
        of: SlopedOutputs<'_, S>,
    ) -> Self {
        let spec = kind.spec;
        let n = spec.n_data();
        let sizes = [spec.holonomic, spec.c.len(), spec.rows.len()];
        let (v, has_phi, has_c) = match of {
            SlopedOutputs::Phi => (None, true, false),
            SlopedOutputs::C => (None, false, true),
            SlopedOutputs::All(v) => (Some(v), true, true),
        };
        let mut slopes = Self {
            phi: Vec::new(),
            c: Vec::new(),
            gamma: Vec::new(),
            entries: spec.c,
            sizes,
            n_dof: S::N_DOF,
        };
        let mut seeded = DualInputs::new(kind, At::<S> { x, v, f });
        let (x, v) = (seeded.poses::<S>(), seeded.twists::<S>());
        for first in (0..n).step_by(LANES) {
            let lanes = first..n.min(first + LANES);
            still(&mut seeded.stored);
            for &(stored, number, slope) in of_stored.iter().filter(|(_, p, _)| lanes.contains(p)) {
                seeded.stored[stored].slopes[number - first] += slope;
            }
            let rows = kind.programs.of(&seeded.stored);
            let lanes = lanes.len();
            let add = |to: &mut Vec<f64>, n: usize, kernel: &dyn Fn(&mut [Dual])| {
                let mut out = vec![Dual::from(0.0); n];
                kernel(&mut out);
                (0..lanes).for_each(|lane| to.extend(out.iter().map(|d| d.slopes[lane])));
            };
            let f = &seeded.f;
            if has_phi {
                add(&mut slopes.phi, sizes[0], &|out| rows.phi::<S>(&x, f, out));
            }
            if has_c {
                add(&mut slopes.c, sizes[1], &|out| {
                    rows.c_constant::<S>(&x, f, out);
                    rows.c::<S>(&x, f, out);
                });
            }
            if !v.is_empty() {
                add(&mut slopes.gamma, sizes[2], &|out| {
                    rows.gamma::<S>(&x, &v, f, out);
                });
            }
        }
        slopes
    }

    /// Computes `∂(λᵀ·Φ)/∂p`, with the λ of the holonomic rows.
    pub fn phi(&self, lambda: &[f64], out: &mut [f64]) {
        let rows = self.sizes[0];
        for (p, out) in out.iter_mut().enumerate() {
            let own = self.phi[rows * p..].iter().take(rows).zip(lambda);
            *out = own.map(|(slope, lambda)| slope * lambda).sum();
        }
    }

    /// Computes `∂(λᵀ·C·y)/∂p`, for the velocities or accelerations y of the bodies.
    pub fn power(&self, lambda: &[f64], y: &[f64], out: &mut [f64]) {
        let factor = |e: &Entry| lambda[e.row] * y[self.n_dof * e.slot + e.dof];
        for (p, out) in out.iter_mut().enumerate() {
            let own = self.c[self.sizes[1] * p..].iter().zip(self.entries);
            *out = own.map(|(slope, entry)| slope * factor(entry)).sum();
        }
    }

    /// Computes `∂(λᵀ·(C·a − Γ))/∂p`, for the accelerations a of the bodies.
    pub fn residual(&self, lambda: &[f64], a: &[f64], out: &mut [f64]) {
        self.power(lambda, a, out);
        let rows = self.sizes[2];
        for (gamma, out) in self.gamma.chunks_exact(rows).zip(out) {
            let own = gamma.iter().zip(lambda);
            *out -= own.map(|(slope, lambda)| slope * lambda).sum::<f64>();
        }
    }
}
