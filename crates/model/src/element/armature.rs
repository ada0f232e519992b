//! An armature with its indices in the mechanism.

use joints::spec::{ConstraintSpec, Unit};
use joints::{SlopedOutputs, Space};

use super::bodies::Bodies;
use super::slots::{Kinematics, Rates, Site, Slots};
use super::{AnyConstraint, FramedConstraint, PoseOf, with};
use crate::law::full;

/// Largest number of bodies of a joint with an armature. No joint of the library has more bodies.
pub(crate) const MOST_BODIES: usize = 4;
/// Largest number of velocity components of these bodies.
const MOST: usize = MOST_BODIES * 6;

/// The inertia of a joint coordinate with its indices in the mechanism. The kernels are the kernels
/// of the drive of this coordinate, without a motion.
#[derive(Clone)]
pub(crate) struct PlacedArmature {
    /// Name of the joint, and name of the joint coordinate.
    pub(crate) joint: String,
    pub(crate) measure: &'static str,
    /// Inertia (kg or kg·m²).
    pub(crate) inertia: f64,
    pub(crate) site: Site,
    framed: FramedConstraint,
    /// The entries of the row of the drive that do not belong to the ground.
    moving: Vec<usize>,
}

/// The values that replace a motion in the kernels of a drive. For an angle in space they are the
/// cosine and the sine of the present angle, so that the row of the drive is zero.
type MotionValues = [[f64; 3]; 2];

fn motion<S: Kinematics>(
    element: &dyn joints::ConstraintKernels<S>,
    x: &[PoseOf<S>],
) -> MotionValues {
    if !element.spec().turning {
        return MotionValues::default();
    }
    let still = [(); MOST_BODIES].map(|()| S::twist(&[0.0; 6]));
    let [cos, sin, _] = element.turned(0, x, &still[..x.len().min(MOST_BODIES)]);
    [[cos, 0.0, 0.0], [sin, 0.0, 0.0]]
}

impl PlacedArmature {
    pub(crate) fn new(
        (joint, measure): (&str, &'static str),
        inertia: f64,
        framed: FramedConstraint,
        site: Site,
    ) -> Self {
        let entries = framed.kernels().spec().c.iter().enumerate();
        let moving = entries.filter(|(_, e)| site.bodies[e.slot].moving().is_some());
        Self {
            joint: joint.to_owned(),
            measure,
            inertia,
            moving: moving.map(|(k, _)| k).collect(),
            framed,
            site,
        }
    }

    pub(crate) fn framed(&self) -> &FramedConstraint {
        &self.framed
    }

    pub(crate) fn spec(&self) -> &'static ConstraintSpec {
        self.framed.kernels().spec()
    }

    /// Returns whether the joint coordinate is an angle.
    pub(crate) fn is_angle(&self) -> bool {
        self.spec()
            .common
            .functions()
            .any(|(_, unit)| unit == Unit::Angle)
    }

    /// Returns the columns of the gradient of the joint coordinate.
    pub(crate) fn columns(&self) -> Vec<usize> {
        let (spec, n) = (self.spec(), self.site.space.n_v());
        let column = |&k: &usize| self.site.column(n * spec.c[k].slot + spec.c[k].dof);
        self.moving.iter().filter_map(column).collect()
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        let site = &self.site;
        with!(AnyConstraint, self.framed.kernels_mut(), element, S => {
            element.initialise(&site.poses::<S, f64>(bodies));
        });
    }

    /// Returns the ranges of the data that the drive has in common with its joint: the range in the
    /// drive, and the range in the joint.
    fn shared(
        &self,
        joint: &'static ConstraintSpec,
    ) -> impl Iterator<Item = [std::ops::Range<usize>; 2]> + use<> {
        self.spec().data.iter().filter_map(|datum| {
            let same = joint
                .data
                .iter()
                .find(|of_joint| of_joint.name == datum.name)?;
            let both = [datum.numbers(), same.numbers()];
            (both[0].len() == both[1].len()).then_some(both)
        })
    }

    /// Takes the values of the data that the drive has in common with its joint.
    pub(crate) fn share(&mut self, joint: &'static ConstraintSpec, numbers: &[f64]) {
        let mut own = vec![0.0; self.spec().n_data()];
        self.framed.kernels().data(&mut own);
        for [to, from] in self.shared(joint) {
            own[to].copy_from_slice(&numbers[from]);
        }
        with!(AnyConstraint, self.framed.kernels_mut(), element, _S => element.set_data(&own));
    }

    /// Computes the gradient of the joint coordinate, in the order of [`Self::columns`].
    pub(crate) fn gradient(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, self.framed.kernels(), element, S => {
            self.gradient_in::<S>(element.as_ref(), self.site.x::<S>(s), out);
        });
    }

    /// Works like [`Self::gradient`], for the poses of all bodies. The function allocates memory.
    pub(crate) fn gradient_at(&self, bodies: &Bodies, out: &mut [f64]) {
        with!(AnyConstraint, self.framed.kernels(), element, S => {
            self.gradient_in::<S>(element.as_ref(), &self.site.poses::<S, f64>(bodies), out);
        });
    }

    fn gradient_in<S: Kinematics>(
        &self,
        element: &dyn joints::ConstraintKernels<S>,
        x: &[PoseOf<S>],
        out: &mut [f64],
    ) {
        let mut all = [0.0; MOST];
        let all = &mut all[..self.spec().c.len()];
        element.c_constant(all);
        element.c(x, &motion(element, x), all);
        for (out, &k) in out.iter_mut().zip(&self.moving) {
            *out = all[k];
        }
    }

    /// Adds the derivatives of `yᵀ·gᵀ·a·g·v̇` with respect to the data of the joint to `out`. `y`
    /// and `acceleration` are velocities of the bodies of the joint.
    pub(crate) fn add_slopes(
        &self,
        s: &Slots,
        joint: &'static ConstraintSpec,
        [y, acceleration]: [&[f64]; 2],
        out: &mut [f64],
    ) {
        let (spec, n) = (self.spec(), self.site.space.n_v());
        let mut all = [0.0; MOST];
        let all = &mut all[..spec.c.len()];
        let slopes = with!(AnyConstraint, self.framed.kernels(), element, S => {
            let x = self.site.x::<S>(s);
            let f = motion(element.as_ref(), x);
            element.c_constant(all);
            element.c(x, &f, all);
            element.slopes(x, &f, SlopedOutputs::C)
        });
        let times = |x: &[f64]| -> f64 {
            let terms = spec.c.iter().zip(&*all);
            terms.map(|(e, g)| g * x[n * e.slot + e.dof]).sum()
        };
        let [along, load] = [times(y), self.inertia * times(acceleration)];
        let mut own = vec![0.0; spec.n_data()];
        slopes.power(&[load], y, &mut own);
        let mut others = vec![0.0; spec.n_data()];
        slopes.power(&[self.inertia * along], acceleration, &mut others);
        for [from, to] in self.shared(joint) {
            let slopes = own[from.clone()].iter().zip(&others[from]);
            for (out, (a, b)) in out[to].iter_mut().zip(slopes) {
                *out += a + b;
            }
        }
    }

    /// Returns γ of the joint coordinate s, with `s̈ = g·v̇ − γ`.
    pub(crate) fn gamma(&self, s: &Slots) -> f64 {
        let mut gamma = [0.0];
        with!(AnyConstraint, self.framed.kernels(), element, S => {
            let (x, v) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates));
            element.gamma(x, v, &motion(element.as_ref(), x), &mut gamma);
        });
        gamma[0]
    }

    /// Returns the pattern of the derivatives of the load: all pairs of columns of the bodies.
    pub(crate) fn pairs(&self) -> &'static [[usize; 2]] {
        full(self.n())
    }

    fn n(&self) -> usize {
        self.site.space.n_v() * self.site.bodies.len()
    }

    /// Computes the derivatives of the load of the inertia, `−gᵀ·a·(g·v̇ − γ)`, with respect to a
    /// displacement and to the velocities, in the order of [`Self::pairs`].
    pub(crate) fn derivatives(
        &self,
        s: &Slots,
        accelerations: &Rates,
        [by_x, by_v]: [&mut [f64]; 2],
    ) {
        let (spec, n) = (self.spec(), self.n());
        let mut gradient = [0.0; MOST];
        let [mut of_residual, mut of_gamma] = [[0.0; MOST]; 2];
        let mut values = [0.0; MOST * MOST];
        by_x.fill(0.0);
        let mut rate = 0.0;
        with!(AnyConstraint, self.framed.kernels(), element, S => {
            let (x, v) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates));
            let f = motion(element.as_ref(), x);
            let mut all = [0.0; MOST];
            element.c_constant(&mut all[..spec.c.len()]);
            element.c(x, &f, &mut all[..spec.c.len()]);
            let a = self.site.v::<S>(accelerations);
            let mut load = [-self.inertia * self.gamma(s)];
            for (e, value) in spec.c.iter().zip(all) {
                gradient[n / self.site.bodies.len() * e.slot + e.dof] = value;
                let along = |x: &[super::TwistOf<S>]| S::velocities(&x[e.slot]).nth(e.dof).unwrap_or(0.0);
                rate += value * along(v);
                load[0] += self.inertia * value * along(a);
            }
            element.d_force_dx(x, &f, &load, &mut values[..spec.d_force_dx.len()]);
            for (&[i, j], value) in spec.d_force_dx.iter().zip(values) {
                by_x[n * i + j] -= value;
            }
            element.d_residual_dx(x, v, a, &f, &mut values[..spec.d_residual_dx.len()]);
            for (&[_, j], value) in spec.d_residual_dx.iter().zip(values) {
                of_residual[j] += value;
            }
            element.d_gamma_dv(x, v, &f, &mut values[..spec.d_gamma_dv.len()]);
            for (&[_, j], value) in spec.d_gamma_dv.iter().zip(values) {
                of_gamma[j] += value;
            }
        });
        // The row of an angle in space is the sine of the difference to the present angle. Its
        // second derivative contains the term −sin·rate², which the angle does not have.
        let turning = if spec.turning { rate * rate } else { 0.0 };
        for i in 0..n {
            let force = self.inertia * gradient[i];
            for j in 0..n {
                by_x[n * i + j] -= force * (of_residual[j] + turning * gradient[j]);
                by_v[n * i + j] = force * of_gamma[j];
            }
        }
    }
}
