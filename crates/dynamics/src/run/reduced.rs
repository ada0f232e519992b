//! The Jacobian of the motion on independent coordinates, and the linear systems of implicit
//! methods.
//!
//! The function `f(y) = F(P·y)` depends only on w = [z; u], so `∂f/∂y = D·S`. S computes w from y
//! (if q̇ = v it selects entries), and D has a column for each entry of w. D is computed by
//! implicit differentiation, with the factors that also solve the equations of motion:
//!
//! | | equation |
//! | --- | --- |
//! | coordinates | `Φq·dq = 0`, dq given on z |
//! | velocities | `C·dv = −∂(C·v − b)/∂q·dq`, dv given on u |
//! | accelerations | `M·da + Cᵀ·dλ = ∂(Q − Cᵀ·λ)/∂q·dq + ∂Q/∂v·dv`, `C·da = −∂(C·a − Γ)/∂q·dq + ∂Γ/∂v·dv` |
//!
//! The system `(σ·I − D·S)·x = r` needs only a factorisation of the order of w, `(σ·I − S·D)·x_w =
//! r_w`. The dependent entries of x need not be exact, because each completion of a state computes
//! the dependent entries of y from w by iteration. At most, the initial values of this iteration
//! depend on the dependent entries of x. The dependent entries of x are computed from x_w in the
//! same way as the dependent entries of dq and dv. The exact solution, `σ·x = r + D·x_w`, is not
//! used for these entries. The exact solution would include stiff forces in the dependent
//! directions, amplified by the lever arms of the mechanism. The method would then fail to converge
//! although w has converged. No pose changes along the normals of the coordinates, so f does not
//! depend on y along these normals. The exact solution `σ·x = r` is used along the normals.

use linalg::{Lu, Matrix};
use model::{Derivatives, Mechanism, System};

use crate::counts::{WorkKind, note};
use crate::error::MotionFault;
use crate::manifold::Origin;
use crate::motion::KeptRowMotion;
use crate::solve::KeptEquations;

/// The Jacobian at one instant, and factors of shifted Jacobians.
///
/// ```
/// use pfaff_dynamics::{KeptRowMotion, ReducedJacobian, RowChoice, prepare};
/// use joints::Revolute;
/// use model::{Body, BodyRef, Description, Joint, Mechanism, StartOptions};
/// // A pendulum of length 1 at rest below its pivot: u̇ = −g/(l² + I/m)·l·z with its angle z, here −10/(1 + 0.25) = −8.
/// let pendulum = Description {
///     gravity: [0.0, -10.0],
///     bodies: vec![Body { name: "bob".into(), mass: 2.0, inertia: 0.5, position: [0.0, -1.0], ..Body::default() }],
///     joints: vec![Joint::new("pivot", &[BodyRef::Ground, BodyRef::Body(0)], Revolute { s_i: [0.0; 2], s_j: [0.0, 1.0] })],
///     ..Description::default()
/// };
/// let mechanism = Mechanism::build(&pendulum).unwrap();
/// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
/// let mut motion = KeptRowMotion::new(&prepared)?;
/// let mut reduced = ReducedJacobian::new(&motion);
/// reduced.linearise(&mut motion, 0.0, &[0.0, -1.0, 0.0, 0.0, 0.0, 0.0])?;
/// let jacobian = reduced.jacobian();
/// // w is [angle; angular velocity] or [x; v_x], which are the same here.
/// assert!((jacobian[(0, 1)] - 1.0).abs() < 1e-14 && (jacobian[(1, 0)] + 8.0).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct ReducedJacobian {
    /// Work memory, allocated at the first use.
    derivatives: Option<Derivatives>,
    partition: ReducedCoordinates,
    /// Row j contains column j of D.
    columns: Matrix,
    /// The product S·D.
    on_w: Matrix,
    /// Row j contains the change of y with w_j along the constraint manifold, without the entries
    /// on which no rate depends.
    tangents: Matrix,
    /// Row j contains the displacements of tangent j along the columns of C, n_v values.
    displacements: Matrix,
    /// Time of the Jacobian.
    time: f64,
    shifted: ShiftedFactors,
    storage: EvaluationStorage,
}

/// Computation of w from y for one choice of independent coordinates.
#[derive(Default)]
struct ReducedCoordinates {
    generation: u64,
    /// Number of the reference configuration for rotations.
    base: u64,
    /// Columns of C whose coordinates are independent, and columns whose velocities are
    /// independent.
    z: Vec<usize>,
    u: Vec<usize>,
    /// Row j of S contains entry j of w, as indices into y with coefficients.
    reads: Vec<Vec<(usize, f64)>>,
    /// Directions of y along which no pose changes.
    normals: Vec<Vec<(usize, f64)>>,
    /// Entries of y on which no rate depends. Each of these entries has its own equation. The
    /// entries are the work, and the unwrapped angles, of which only the revolutions are used.
    quadratures: Vec<usize>,
}

/// The factored matrices `σ·I − S·D` for a real σ and a complex σ.
struct ShiftedFactors {
    real: Lu,
    /// Factors of the real form [αI − S·D, −βI; βI, αI − S·D].
    complex: Lu,
    shift: f64,
    complex_shift: [f64; 2],
    /// Solutions for w, as real and imaginary parts.
    w: Vec<f64>,
}

/// Vectors of one evaluation.
struct EvaluationStorage {
    dq: Vec<f64>,
    dv: Vec<f64>,
    force: Vec<f64>,
    rows: Vec<f64>,
    lambda: Vec<f64>,
    dy: Vec<f64>,
    /// Loads of armatures, n_v values.
    armatures: Vec<f64>,
}

impl ReducedCoordinates {
    /// Sets this configuration as the reference for coordinates, and computes the normals.
    fn read_from(&mut self, mechanism: &Mechanism, q: &[f64], base: u64) {
        self.base = base;
        for (terms, &z) in self.reads.iter_mut().zip(&self.z) {
            mechanism.space().read_velocity(q, z, terms);
        }
        self.normals = mechanism.space().normals(mechanism.of_bodies(q));
    }
}

impl ShiftedFactors {
    /// Allocates work memory for k entries of w.
    fn new(k: usize) -> Self {
        Self {
            real: Lu::new(k),
            complex: Lu::new(2 * k),
            shift: 1.0,
            complex_shift: [1.0, 0.0],
            w: vec![0.0; 2 * k],
        }
    }
}

impl ReducedJacobian {
    /// Allocates memory for a motion. The Jacobian is not yet evaluated.
    #[must_use]
    pub fn new(motion: &KeptRowMotion<'_>) -> Self {
        note(WorkKind::LinearSystems);
        let mechanism = motion.mechanism();
        let layout = mechanism.layout();
        Self {
            derivatives: None,
            partition: ReducedCoordinates::default(),
            columns: Matrix::default(),
            on_w: Matrix::default(),
            tangents: Matrix::default(),
            displacements: Matrix::default(),
            time: 0.0,
            shifted: ShiftedFactors::new(0),
            storage: EvaluationStorage {
                dq: vec![0.0; layout.n_v],
                dv: vec![0.0; layout.n_v],
                force: vec![0.0; layout.n_v],
                rows: vec![0.0; layout.rows()],
                lambda: vec![0.0; layout.rows()],
                dy: vec![0.0; layout.n_q + layout.n_v],
                armatures: vec![0.0; layout.n_v],
            },
        }
    }

    /// Evaluates the Jacobian at t and y. The state y is completed first. A motion on all
    /// coordinates is switched to independent coordinates.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowMotion::derivative`], and [`MotionFault::NoDerivatives`]
    /// if a force calls an external function.
    ///
    /// # Panics
    /// Panics if y is shorter than n_q + n_v.
    pub fn linearise(
        &mut self,
        motion: &mut KeptRowMotion<'_>,
        t: f64,
        y: &[f64],
    ) -> Result<(), MotionFault> {
        let mut d = match self.derivatives.take() {
            Some(d) => d,
            None => derivatives(motion.mechanism())?,
        };
        let done = self.linearise_with(&mut d, motion, t, y);
        self.derivatives = Some(d);
        done
    }

    fn linearise_with(
        &mut self,
        d: &mut Derivatives,
        motion: &mut KeptRowMotion<'_>,
        t: f64,
        y: &[f64],
    ) -> Result<(), MotionFault> {
        let mechanism = motion.mechanism();
        let n_q = mechanism.layout().n_q;
        if motion.independent().is_none() {
            motion.use_independent_coordinates(t, &y[..n_q])?;
        }
        motion.begin_step(|_| true)?;
        self.storage.dy.resize(y.len(), 0.0);
        motion.derivative(t, y, &mut self.storage.dy)?;
        self.take_partition(motion, y);
        let EvaluationStorage { dy, lambda, .. } = &mut self.storage;
        let equations = &mut motion.equations;
        let a = &dy[n_q..n_q + mechanism.layout().n_v];
        equations.multipliers_for(a, lambda)?;
        d.differentiate(mechanism, a, lambda, &equations.at.s);
        equations.position.factor(&equations.at)?;
        self.time = t;
        let reads = self.partition.reads.len();
        for j in 0..reads {
            self.differentiate(d, motion, j)?;
        }
        let entry = |i: usize, j| read(&self.partition.reads[i], self.columns.row(j));
        self.on_w = Matrix::from_fn(reads, reads, entry);
        Ok(())
    }

    /// Linearises and factors again if the partition changed at the start of the step. After such a
    /// change, f is a different function of y, although the motion is the same.
    ///
    /// # Errors
    /// Returns the same errors as [`ReducedJacobian::linearise`] and [`ReducedJacobian::factor`].
    pub(crate) fn follow_partition(
        &mut self,
        motion: &mut KeptRowMotion<'_>,
    ) -> Result<(), MotionFault> {
        let Some(coordinates) = &motion.manifold.coordinates else {
            return Ok(());
        };
        let own = &mut self.partition;
        if own.reads.is_empty() {
            return Ok(());
        }
        if coordinates.partition.generation == own.generation {
            if coordinates.bases != own.base {
                let (mechanism, q) = (motion.mechanism(), &coordinates.base);
                own.read_from(mechanism, q, coordinates.bases);
                // The Jacobian in terms of rotations remains valid, because only the quaternions
                // have changed.
                for j in 0..own.reads.len() {
                    let tangent = &mut self.tangents.row_mut(j)[..q.len()];
                    mechanism.rate(q, self.displacements.row(j), tangent);
                }
            }
            return Ok(());
        }
        let Origin { t, q, v } = coordinates.partition.origin.clone();
        let mut y = [q, v].concat();
        y.resize(self.columns.ncols(), 0.0);
        self.linearise(motion, t, &y)?;
        self.factor(self.shifted.shift, self.shifted.complex_shift)
    }

    /// Returns the dense matrix `∂ẇ/∂w`.
    #[must_use]
    pub fn jacobian(&self) -> &Matrix {
        &self.on_w
    }

    /// Returns the dense matrix `∂f/∂w`. The function allocates memory.
    #[must_use]
    pub fn columns(&self) -> Matrix {
        self.columns.transpose()
    }

    /// Stores the partition of the motion, and the computation of w from y.
    fn take_partition(&mut self, motion: &KeptRowMotion<'_>, y: &[f64]) {
        let coordinates = motion.manifold.coordinates.as_ref();
        let coordinates = coordinates.expect("linearise has chosen them");
        let (z, u) = (&coordinates.partition.z, &coordinates.partition.u);
        let (mechanism, n) = (motion.mechanism(), y.len());
        let n_q = mechanism.layout().n_q;
        let own = &mut self.partition;
        own.generation = coordinates.partition.generation;
        own.reads.resize_with(z.len() + u.len(), Vec::new);
        for (terms, u) in own.reads[z.len()..].iter_mut().zip(u) {
            terms.clear();
            terms.push((n_q + u, 1.0));
        }
        let is_known = self.columns.ncols() == n && *z == own.z && *u == own.u;
        if !is_known {
            (own.z, own.u) = (z.clone(), u.clone());
        }
        own.read_from(mechanism, &y[..n_q], coordinates.bases);
        if is_known {
            return;
        }
        let moving = n_q + mechanism.layout().n_v;
        let first = n_q - mechanism.layout().turns;
        own.quadratures = (first..n_q).chain(moving..n).collect();
        let (k, shifted) = (own.reads.len(), &self.shifted);
        self.columns = Matrix::zeros(k, n);
        self.tangents = Matrix::zeros(k, n);
        self.displacements = Matrix::zeros(k, mechanism.layout().n_v);
        self.shifted = ShiftedFactors {
            shift: shifted.shift,
            complex_shift: shifted.complex_shift,
            ..ShiftedFactors::new(k)
        };
    }

    /// Computes column j of D.
    fn differentiate(
        &mut self,
        d: &Derivatives,
        motion: &mut KeptRowMotion<'_>,
        j: usize,
    ) -> Result<(), MotionFault> {
        let KeptEquations {
            at,
            velocity,
            position,
            ..
        } = &mut motion.equations;
        let coordinates = motion.manifold.coordinates.as_ref();
        let coordinates = coordinates.expect("linearise has chosen them");
        let mechanism = at.mechanism;
        let layout = mechanism.layout();
        let partition = &self.partition;
        let EvaluationStorage {
            dq,
            dv,
            force,
            rows,
            dy,
            armatures,
            ..
        } = &mut self.storage;
        dq.fill(0.0);
        dv.fill(0.0);
        match partition.z.get(j) {
            Some(&z) => {
                dq[z] = 1.0;
                position.rhs.fill(0.0);
                position.complete(at, dq)?;
            }
            None => dv[partition.u[j - partition.z.len()]] = 1.0,
        }
        rows.fill(0.0);
        d.velocity_dq.subtract_product(dq, rows);
        velocity.take_rhs(|i| rows[i]);
        velocity.complete(at, dv)?;
        self.displacements.row_mut(j).copy_from_slice(dq);
        let tangent = self.tangents.row_mut(j);
        mechanism.rate(&coordinates.q, dq, &mut tangent[..layout.n_q]);
        tangent[layout.n_q..layout.n_q + layout.n_v].copy_from_slice(dv);

        force.fill(0.0);
        d.force_dq.add_product(dq, force);
        d.reaction_dq.subtract_product(dq, force);
        d.force_dv.add_product(dv, force);
        // The power of an armature also changes with its load at fixed accelerations.
        let mut power = 0.0;
        if mechanism.has_armatures() {
            armatures.fill(0.0);
            d.armature_dq.add_product(dq, armatures);
            d.armature_dv.add_product(dv, armatures);
            for ((force, load), v) in force.iter_mut().zip(&*armatures).zip(&coordinates.v) {
                *force += load;
                power -= load * v;
            }
        }
        rows.fill(0.0);
        d.residual_dq.subtract_product(dq, rows);
        d.gamma_dv.add_product(dv, rows);
        velocity.take_rhs(|i| rows[i]);
        let (d_rate, rest) = self.columns.row_mut(j).split_at_mut(layout.n_q);
        let (da, d_work) = rest.split_at_mut(layout.n_v);
        velocity.solve(at, Some(force), da)?;
        mechanism.rate(&coordinates.q, dv, d_rate);
        if let Some(d_work) = d_work.first_mut() {
            // Derivative of the power (M·a − weight)·v with respect to v and to a.
            let a = &dy[layout.n_q..layout.n_q + layout.n_v];
            let inertia = mechanism.inertia(&at.s).between(da, &coordinates.v);
            *d_work = mechanism.energy_rate(&at.s, dv, a) + inertia + power;
        }
        Ok(())
    }

    /// Factors `σ·I − ∂f/∂y` for a real σ and a complex σ, `[Re σ, Im σ]`.
    ///
    /// # Errors
    /// Returns [`MotionFault::IterationMatrix`] if a matrix is singular.
    pub fn factor(&mut self, real: f64, complex: [f64; 2]) -> Result<(), MotionFault> {
        let (k, time, on_w) = (self.partition.reads.len(), self.time, &self.on_w);
        let own = &mut self.shifted;
        let shifted = |sigma: f64, i: usize, j: usize| {
            let diagonal = if i == j { sigma } else { 0.0 };
            diagonal - on_w[(i, j)]
        };
        let singular = |source| MotionFault::IterationMatrix { time, source };
        let factored = own.real.factor(|i, j| shifted(real, i, j));
        factored.map_err(singular)?;
        let [alpha, beta] = complex;
        let coupled = |i: usize, j: usize| if i == j { beta } else { 0.0 };
        let factored = own.complex.factor(|i, j| match (i < k, j < k) {
            (true, true) => shifted(alpha, i, j),
            (true, false) => -coupled(i, j - k),
            (false, true) => coupled(i - k, j),
            (false, false) => shifted(alpha, i - k, j - k),
        });
        factored.map_err(singular)?;
        (own.shift, own.complex_shift) = (real, complex);
        Ok(())
    }

    /// Solves `(σ·I − ∂f/∂y)·x = r` for the real σ. On entry, `x` contains r. Dependent entries are
    /// computed from the independent entries.
    pub fn solve(&mut self, x: &mut [f64]) {
        let Self {
            partition, shifted, ..
        } = self;
        let w = &mut shifted.w[..partition.reads.len()];
        for (w, terms) in w.iter_mut().zip(&partition.reads) {
            *w = read(terms, x);
        }
        shifted.real.solve(w);
        let w = &self.shifted.w[..self.partition.reads.len()];
        let shift = self.shifted.shift;
        let own = |&at: &usize| (x[at] + self.rate_along(w, at)) / shift;
        let own: Vec<f64> = self.partition.quadratures.iter().map(own).collect();
        let normals = self.partition.normals.iter();
        let along_normals: Vec<f64> = normals.map(|n| read(n, x) / shift).collect();
        self.follow(w, &along_normals, x);
        for (&at, own) in self.partition.quadratures.iter().zip(own) {
            x[at] = own;
        }
    }

    /// Works like [`Self::solve`], for the complex σ.
    pub fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]) {
        let Self {
            partition, shifted, ..
        } = self;
        let k = partition.reads.len();
        for (j, terms) in partition.reads.iter().enumerate() {
            shifted.w[j] = read(terms, re);
            shifted.w[k + j] = read(terms, im);
        }
        shifted.complex.solve(&mut shifted.w);
        let (w_re, w_im) = self.shifted.w.split_at(k);
        let [alpha, beta] = self.shifted.complex_shift;
        let norm = alpha * alpha + beta * beta;
        let quotient =
            |a: f64, b: f64| ((alpha * a + beta * b) / norm, (alpha * b - beta * a) / norm);
        let own = |&at: &usize| {
            let a = re[at] + self.rate_along(w_re, at);
            let b = im[at] + self.rate_along(w_im, at);
            quotient(a, b)
        };
        let own: Vec<(f64, f64)> = self.partition.quadratures.iter().map(own).collect();
        let normals = self.partition.normals.iter();
        let (n_re, n_im): (Vec<f64>, Vec<f64>) =
            normals.map(|n| quotient(read(n, re), read(n, im))).unzip();
        self.follow(w_re, &n_re, re);
        self.follow(w_im, &n_im, im);
        for (&at, own) in self.partition.quadratures.iter().zip(own) {
            (re[at], im[at]) = own;
        }
    }

    /// Returns the change along w of the rate of an entry on which no rate depends.
    fn rate_along(&self, w: &[f64], at: usize) -> f64 {
        w.iter()
            .enumerate()
            .map(|(j, w)| w * self.columns[(j, at)])
            .sum()
    }

    /// Computes `x ← Σ w_j·(tangent j) + Σ factor_k·(normal k)`.
    fn follow(&self, w: &[f64], factors: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        for (j, &w) in w.iter().enumerate() {
            for (x, d) in x.iter_mut().zip(self.tangents.row(j)) {
                *x += d * w;
            }
        }
        for (normal, factor) in self.partition.normals.iter().zip(factors) {
            for &(place, entry) in normal {
                x[place] += factor * entry;
            }
        }
    }
}

/// Allocates work memory for the derivatives that implicit methods need.
pub(crate) fn derivatives(mechanism: &Mechanism) -> Result<Derivatives, MotionFault> {
    Derivatives::of(mechanism).map_err(|source| MotionFault::NoDerivatives {
        needs: "method radau5 needs",
        source,
        instead: "use an explicit method: dop853, dopri5, tsit5 or auto",
    })
}

/// Returns an entry of w, computed from a vector like y.
fn read(terms: &[(usize, f64)], x: &[f64]) -> f64 {
    terms.iter().map(|&(place, factor)| factor * x[place]).sum()
}
