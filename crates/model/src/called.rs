//! Forces that call a function of the caller: of the laws of drives, and of wrenches on bodies,
//! values alone are known. Nothing that needs derivatives works with them.

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use joints::spec::{ForceSpec, Parameter, Shape, Spec, Unit};
use joints::{Definition, ForceElement, Plane, Recorded, Space, Space3, plane, space3};

use crate::element::ForceKernels;
use crate::law::Undefined;

/// Why a called function has no value; its message ends the run.
pub type CallError = Box<dyn Error + Send + Sync>;

/// What the force of a drive depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DriveState {
    /// Time (s).
    pub time: f64,
    /// The measure (m or rad).
    pub measure: f64,
    /// Its rate (m/s or rad/s).
    pub rate: f64,
}

/// The state of a body, of its centre of mass, in ground axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodyState {
    /// Time (s).
    pub time: f64,
    /// Place of the centre of mass (m).
    pub position: [f64; 3],
    /// From the frame of the body to ground axes, by rows.
    pub rotation: [[f64; 3]; 3],
    /// Angle in the plane (rad), not reduced to one revolution; 0 in space.
    pub angle: f64,
    /// Velocity of the centre of mass (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub angular_velocity: [f64; 3],
}

/// A force through the centre of mass of a body, and a torque, in ground axes. In the plane the
/// components out of it do nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force (N).
    pub force: [f64; 3],
    /// Torque (N·m).
    pub torque: [f64; 3],
}

/// A function that is called. It is equal to its copies only.
pub(crate) struct Called<I, O>(Arc<Function<I, O>>);

type Function<I, O> = dyn Fn(&I) -> Result<O, CallError> + Send + Sync;

impl<I, O> Called<I, O> {
    pub(crate) fn new(
        function: impl Fn(&I) -> Result<O, CallError> + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(function))
    }
}

impl<I, O> Clone for Called<I, O> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<I, O> PartialEq for Called<I, O> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<I, O> fmt::Debug for Called<I, O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Called(..)")
    }
}

fn failed(why: &CallError) -> Undefined {
    Undefined::Failed(why.to_string())
}

impl Called<DriveState, f64> {
    /// Its value for measure, rate and time.
    pub(crate) fn value(&self, [measure, rate, time]: [f64; 3]) -> Result<f64, Undefined> {
        if !(measure.is_finite() && rate.is_finite()) {
            return Err(Undefined::Input);
        }
        let state = DriveState {
            time,
            measure,
            rate,
        };
        match (self.0)(&state).map_err(|why| failed(&why))? {
            force if force.is_finite() => Ok(force),
            other => Err(Undefined::Returned(other.to_string())),
        }
    }
}

/// A wrench on one body by a function of its state.
#[derive(Clone, Debug, PartialEq)]
pub struct CalledWrench(Called<BodyState, Wrench>);

impl CalledWrench {
    /// The wrench that a function returns, under the conditions of [`crate::Law::called`].
    pub fn new(
        function: impl Fn(&BodyState) -> Result<Wrench, CallError> + Send + Sync + 'static,
    ) -> Self {
        Self(Called::new(function))
    }

    /// Force and torque in ground axes.
    fn value(&self, state: &BodyState) -> Result<Wrench, Undefined> {
        let [r, v, omega] = [state.position, state.velocity, state.angular_velocity];
        if !r.iter().chain(&v).chain(&omega).all(|x| x.is_finite()) {
            return Err(Undefined::Input);
        }
        let found = (self.0.0)(state).map_err(|why| failed(&why))?;
        let Wrench { force, torque } = found;
        if force.iter().chain(&torque).all(|x| x.is_finite()) {
            Ok(found)
        } else {
            Err(Undefined::Returned(format!(
                "the force {force:?} and the torque {torque:?}"
            )))
        }
    }
}

/// A space in which bodies have called wrenches.
trait Acted: Space {
    const SPEC: ForceSpec;

    fn state(time: f64, x: &Self::Pose<f64>, v: &Self::Twist<f64>) -> BodyState;

    /// The components of a wrench along the freedoms of the body.
    fn components(of: &Wrench, x: &Self::Pose<f64>) -> [f64; 6];
}

const COMMON: Spec = Spec {
    name: "CalledWrench",
    scene_type: "called-wrench",
    variant: None,
    doc: "A force and a torque on a body by a function that is called.",
    text: "",
    slots: &["j"],
    parameters: &[Parameter::required(
        "time",
        Shape::Functions(&[Unit::Ratio]),
        "The time.",
    )],
    points_apart: false,
    bearings: false,
    requirements: &[],
};

const fn spec(q: &'static [usize], pairs: &'static [[usize; 2]]) -> ForceSpec {
    ForceSpec {
        common: COMMON,
        q,
        dq_dx: pairs,
        dq_dv: pairs,
        dissipative: true,
        turns: 0,
        rheonomic: true,
    }
}

impl Acted for Plane {
    const SPEC: ForceSpec = spec(&[0, 1, 2], crate::law::full(3));

    fn state(time: f64, x: &plane::Pose, v: &plane::Twist) -> BodyState {
        BodyState {
            time,
            position: [x.x, x.y, 0.0],
            rotation: [[x.cos, -x.sin, 0.0], [x.sin, x.cos, 0.0], [0.0, 0.0, 1.0]],
            angle: x.angle,
            velocity: [v.x, v.y, 0.0],
            angular_velocity: [0.0, 0.0, v.omega],
        }
    }

    fn components(of: &Wrench, _: &plane::Pose) -> [f64; 6] {
        [of.force[0], of.force[1], of.torque[2], 0.0, 0.0, 0.0]
    }
}

impl Acted for Space3 {
    const SPEC: ForceSpec = spec(&[0, 1, 2, 3, 4, 5], crate::law::full(6));

    fn state(time: f64, x: &space3::Pose, v: &space3::Twist) -> BodyState {
        let to_ground = |row: [f64; 3]| row.iter().zip(v.omega).map(|(r, w)| r * w).sum();
        BodyState {
            time,
            position: x.r,
            rotation: x.rot,
            angle: 0.0,
            velocity: v.v,
            angular_velocity: x.rot.map(to_ground),
        }
    }

    /// Torques are those in the frame of the body.
    fn components(of: &Wrench, x: &space3::Pose) -> [f64; 6] {
        let [a, b, c] = of.torque;
        let own = |k: usize| x.rot[0][k] * a + x.rot[1][k] * b + x.rot[2][k] * c;
        let [fx, fy, fz] = of.force;
        [fx, fy, fz, own(0), own(1), own(2)]
    }
}

/// The facts of a called wrench in a space.
struct Facts<S>(std::marker::PhantomData<S>);

impl<S: Acted> Facts<S> {
    const SPEC: ForceSpec = S::SPEC;
}

impl<S: Acted> Definition<S> for CalledWrench {
    fn initialise(&mut self, _: &[S::Pose<f64>]) {}

    fn requirement(&self, _: usize, _: &[S::Pose<f64>]) -> bool {
        true
    }
}

impl<S: Acted> ForceElement<f64, S> for CalledWrench {
    fn spec(&self) -> &'static ForceSpec {
        &Facts::<S>::SPEC
    }

    fn q(&self, x: &[S::Pose<f64>], v: &[S::Twist<f64>], f: &[[f64; 3]], out: &mut [f64]) {
        match self.value(&S::state(f[0][0], &x[0], &v[0])) {
            Ok(wrench) => {
                let components = S::components(&wrench, &x[0]);
                out.iter_mut().zip(components).for_each(|(out, x)| *out = x);
            }
            Err(_) => out.fill(f64::NAN),
        }
    }

    fn dq_dx(&self, _: &[S::Pose<f64>], _: &[S::Twist<f64>], _: &[[f64; 3]], out: &mut [f64]) {
        out.fill(f64::NAN);
    }

    fn dq_dv(&self, _: &[S::Pose<f64>], _: &[S::Twist<f64>], _: &[[f64; 3]], out: &mut [f64]) {
        out.fill(f64::NAN);
    }
}

type Poses<'a, S> = &'a [<S as Space>::Pose<Recorded>];
type Twists<'a, S> = &'a [<S as Space>::Twist<Recorded>];

/// A function that is called cannot be recorded: generators of code refuse it.
impl<S: Acted> ForceElement<Recorded, S> for CalledWrench {
    fn spec(&self) -> &'static ForceSpec {
        &Facts::<S>::SPEC
    }

    fn q(&self, _: Poses<'_, S>, _: Twists<'_, S>, _: &[[Recorded; 3]], out: &mut [Recorded]) {
        out.fill(f64::NAN.into());
    }

    fn dq_dx(&self, _: Poses<'_, S>, _: Twists<'_, S>, _: &[[Recorded; 3]], out: &mut [Recorded]) {
        out.fill(f64::NAN.into());
    }

    fn dq_dv(&self, _: Poses<'_, S>, _: Twists<'_, S>, _: &[[Recorded; 3]], out: &mut [Recorded]) {
        out.fill(f64::NAN.into());
    }
}

/// A downstream crate might make kernels of its own space, so this cannot be said of all spaces.
macro_rules! force_kernels {
    ($space:ident) => {
        impl ForceKernels<$space> for CalledWrench {
            fn recorded(&self) -> &dyn ForceElement<Recorded, $space> {
                self
            }

            fn boxed(&self) -> Box<dyn ForceKernels<$space>> {
                Box::new(self.clone())
            }

            fn is_called(&self) -> bool {
                true
            }

            fn undefined(
                &self,
                x: &[<$space as Space>::Pose<f64>],
                v: &[<$space as Space>::Twist<f64>],
                f: &[[f64; 3]],
            ) -> Option<Undefined> {
                let state = <$space as Acted>::state(f[0][0], &x[0], &v[0]);
                self.value(&state).err()
            }
        }
    };
}

force_kernels!(Plane);
force_kernels!(Space3);
