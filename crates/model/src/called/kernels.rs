//! The kernels of a called wrench, in the plane and in space.

use joints::spec::{ForceSpec, Parameter, Shape, Spec, Unit};
use joints::{Definition, ForceElement, Plane, RecordedNumber, Space, Space3, plane, space3};

use super::{BodyState, CalledWrench, Wrench};
use crate::element::ForceKernels;
use crate::law::UndefinedValue;

/// A space in which callbacks can apply wrenches to bodies.
trait WrenchSpace: Space {
    const SPEC: ForceSpec;

    fn state(time: f64, x: &Self::Pose<f64>, v: &Self::Twist<f64>) -> BodyState;

    /// Returns the components of a wrench along the velocity components of the body.
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

impl WrenchSpace for Plane {
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

impl WrenchSpace for Space3 {
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

    /// In the equations, torques are in the axes of the body frame.
    fn components(of: &Wrench, x: &space3::Pose) -> [f64; 6] {
        let [a, b, c] = of.torque;
        let own = |k: usize| x.rot[0][k] * a + x.rot[1][k] * b + x.rot[2][k] * c;
        let [fx, fy, fz] = of.force;
        [fx, fy, fz, own(0), own(1), own(2)]
    }
}

/// The constant properties of a called wrench in a space.
struct WrenchFacts<S>(std::marker::PhantomData<S>);

impl<S: WrenchSpace> WrenchFacts<S> {
    const SPEC: ForceSpec = S::SPEC;
}

impl<S: WrenchSpace> Definition<S> for CalledWrench {
    fn initialise(&mut self, _: &[S::Pose<f64>]) {}

    fn requirement(&self, _: usize, _: &[S::Pose<f64>]) -> bool {
        true
    }
}

impl<S: WrenchSpace> ForceElement<f64, S> for CalledWrench {
    fn spec(&self) -> &'static ForceSpec {
        &WrenchFacts::<S>::SPEC
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

/// A macro is necessary. A downstream crate might define kernels for its own space, so a generic
/// implementation for all spaces is not possible.
macro_rules! force_kernels {
    ($space:ident) => {
        impl ForceKernels<$space> for CalledWrench {
            /// A called function cannot be recorded, so code generators reject it.
            fn recorded_q(
                &self,
                _: &[<$space as Space>::Pose<RecordedNumber>],
                _: &[<$space as Space>::Twist<RecordedNumber>],
                _: &[[RecordedNumber; 3]],
                out: &mut [RecordedNumber],
            ) {
                out.fill(f64::NAN.into());
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
            ) -> Option<UndefinedValue> {
                let state = <$space as WrenchSpace>::state(f[0][0], &x[0], &v[0]);
                self.value(&state).err()
            }
        }
    };
}

force_kernels!(Plane);
force_kernels!(Space3);
