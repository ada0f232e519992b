//! Kernels of constraints and forces as trait objects, and the spaces of these kernels.

use joints::spec::{ConstraintSpec, ForceSpec};
use joints::{
    Constraint, ConstraintKernels, Force, ForceElement, Plane, RecordedNumber, Ring, Rows, Scalar,
    Space, Space3,
};

use crate::body::{BodyRef, DescribedBody};
use crate::called::CalledWrench;
use crate::coupling::CouplingError;
use crate::law::{DriveForce, Law, LawError, UndefinedValue};
use crate::space::SpaceKind;

/// A space for kernels and for descriptions of bodies: the plane, or three-dimensional space.
pub trait BodySpace: joints::Space + Sized {
    /// Description of a body.
    type Body: Clone + std::fmt::Debug + Into<DescribedBody>;

    /// The kind of this space in a mechanism.
    const KIND: SpaceKind;

    /// Wraps kernels for use in a mechanism.
    #[doc(hidden)]
    fn any_constraint(kernels: Box<dyn ConstraintKernels<Self>>) -> AnyConstraint;

    /// Wraps kernels of a force for use in a mechanism.
    #[doc(hidden)]
    fn any_force(kernels: Box<dyn ForceKernels<Self>>) -> AnyForce;

    /// Returns a point of a body as three components.
    #[doc(hidden)]
    fn point(point: Self::Vector<f64>) -> [f64; 3];

    /// Returns the vector of this space with these components.
    #[doc(hidden)]
    fn vector(components: [f64; 3]) -> Self::Vector<f64>;

    /// Converts a point in ground axes to a point relative to the centre of mass of a body, in the
    /// axes of the body.
    #[doc(hidden)]
    fn to_local(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// Returns a force law on the joint coordinate of a drive. The law replaces the motion of the
    /// drive.
    #[doc(hidden)]
    fn law<K: Constraint<Self>>(
        drive: K,
        law: Law,
    ) -> Result<Box<dyn ForceKernels<Self>>, LawError>;

    /// Returns the kernels of a called wrench.
    #[doc(hidden)]
    fn wrench(wrench: CalledWrench) -> Box<dyn ForceKernels<Self>>;

    /// Returns the kernels of a force and of a torque at the centre of mass of a body. Their
    /// components are in ground axes.
    #[doc(hidden)]
    fn loads() -> [Box<dyn ForceKernels<Self>>; 2];

    /// Returns the constraint that makes the second joint coordinate a polynomial of the first.
    #[doc(hidden)]
    fn couple(
        measures: [AttachedMeasure<Self>; 2],
        coefficients: &[f64],
    ) -> Result<AttachedConstraint<Self>, CouplingError>;
}

/// Kernels of a constraint in the plane or in space.
#[doc(hidden)]
#[derive(Clone)]
pub enum AnyConstraint {
    /// Kernels in the plane.
    Plane(Box<dyn ConstraintKernels>),
    /// Kernels in space.
    Space3(Box<dyn ConstraintKernels<Space3>>),
}

/// Kernels of a force in the plane or in space.
#[doc(hidden)]
#[derive(Clone)]
pub enum AnyForce {
    /// Kernels in the plane.
    Plane(Box<dyn ForceKernels>),
    /// Kernels in space.
    Space3(Box<dyn ForceKernels<Space3>>),
}

/// Evaluates an expression in which `$element` denotes the kernels, and `$space` denotes the space
/// of the kernels.
macro_rules! with {
    ($any:ident, $kernels:expr, $element:ident, $space:ident => $body:expr) => {
        match $kernels {
            $any::Plane($element) => {
                type $space = joints::Plane;
                $body
            }
            $any::Space3($element) => {
                type $space = joints::Space3;
                $body
            }
        }
    };
}
pub(super) use with;

/// A joint coordinate for a coupling: the bodies of its joint, and the kernels of its drive.
pub type AttachedMeasure<S = Plane> = (Vec<BodyRef>, Box<dyn ConstraintKernels<S>>);

/// A constraint with its bodies.
pub type AttachedConstraint<S = Plane> = (Vec<BodyRef>, Box<dyn ConstraintKernels<S>>);

/// Arguments of a drive for the evaluation of its rows.
pub(crate) struct RowsAt<'a, S: Space, T: Ring> {
    pub(crate) kernels: &'a dyn ConstraintKernels<S>,
    /// The values that the operation lists read.
    pub(crate) stored: &'a [T],
    pub(crate) x: &'a [S::Pose<T>],
    pub(crate) f: &'a [[T; 3]],
}

impl<'a, S: Space, T: Ring> RowsAt<'a, S, T> {
    fn rows(&self) -> Rows<'a, T> {
        self.kernels.programs().of(self.stored)
    }
}

/// A number type in which force laws and couplings evaluate the rows of a drive. With `f64`, the
/// kernels are evaluated. With recording numbers, the operation lists are evaluated.
pub(crate) trait DriveScalar: Scalar {
    /// Returns the values that the operation lists read. Each value is created from a number and
    /// its index. The list is empty for kernels, which read the values stored in them.
    fn stored_by<S: Space>(
        kernels: &dyn ConstraintKernels<S>,
        number: impl Fn(f64, usize) -> Self,
    ) -> Vec<Self>;

    fn phi<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]);

    /// Computes all entries of C.
    fn c<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]);

    fn gamma<S: Space>(at: &RowsAt<'_, S, Self>, v: &[S::Twist<Self>], out: &mut [Self]);

    fn component<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]);
}

impl DriveScalar for f64 {
    fn stored_by<S: Space>(
        _: &dyn ConstraintKernels<S>,
        _: impl Fn(f64, usize) -> Self,
    ) -> Vec<Self> {
        Vec::new()
    }

    fn phi<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]) {
        at.kernels.phi(at.x, at.f, out);
    }

    fn c<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]) {
        at.kernels.c_constant(out);
        at.kernels.c(at.x, at.f, out);
    }

    fn gamma<S: Space>(at: &RowsAt<'_, S, Self>, v: &[S::Twist<Self>], out: &mut [Self]) {
        at.kernels.gamma(at.x, v, at.f, out);
    }

    fn component<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]) {
        at.kernels.component(at.x, at.f, out);
    }
}

impl DriveScalar for RecordedNumber {
    fn stored_by<S: Space>(
        kernels: &dyn ConstraintKernels<S>,
        number: impl Fn(f64, usize) -> Self,
    ) -> Vec<Self> {
        let places = 0..;
        let values = stored(kernels).into_iter();
        values
            .zip(places)
            .map(|(value, place)| number(value, place))
            .collect()
    }

    fn phi<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]) {
        at.rows().phi::<S>(at.x, at.f, out);
    }

    fn c<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]) {
        at.rows().c_constant::<S>(at.x, at.f, out);
        at.rows().c::<S>(at.x, at.f, out);
    }

    fn gamma<S: Space>(at: &RowsAt<'_, S, Self>, v: &[S::Twist<Self>], out: &mut [Self]) {
        at.rows().gamma::<S>(at.x, v, at.f, out);
    }

    fn component<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]) {
        at.rows().component::<S>(at.x, at.f, out);
    }
}

/// Returns the values that the operation lists of a constraint read, in any number type.
pub(crate) fn stored<S: Space, T: From<f64>>(kernels: &dyn ConstraintKernels<S>) -> Vec<T> {
    let mut numbers = Vec::new();
    kernels.stored(&mut numbers);
    numbers.into_iter().map(T::from).collect()
}

/// The kernels of a force as a trait object.
pub trait ForceKernels<S: BodySpace = Plane>: ForceElement<f64, S> {
    /// Evaluates the entries of Q with a number type that records its operations.
    fn recorded_q(
        &self,
        x: &[S::Pose<RecordedNumber>],
        v: &[S::Twist<RecordedNumber>],
        f: &[[RecordedNumber; 3]],
        out: &mut [RecordedNumber],
    );
    /// Returns a copy of the kernels.
    fn boxed(&self) -> Box<dyn ForceKernels<S>>;
    /// Returns whether the element is a drive with a force law.
    fn is_law(&self) -> bool {
        false
    }
    /// Returns whether the force is computed by a callback, which returns only values. The
    /// derivatives of such a force are NaN.
    fn is_called(&self) -> bool {
        false
    }
    /// Returns the number of states of the force law.
    fn n_states(&self) -> usize {
        0
    }
    /// Computes the rates of the states of the force law. The states are the last values of `f`.
    fn state_rates(
        &self,
        _x: &[S::Pose<f64>],
        _v: &[S::Twist<f64>],
        _f: &[[f64; 3]],
        _out: &mut [f64],
    ) {
    }
    /// Computes the states of the force law at the start.
    fn first_states(
        &self,
        _x: &[S::Pose<f64>],
        _v: &[S::Twist<f64>],
        _f: &[[f64; 3]],
        _out: &mut [f64],
    ) {
    }
    /// Returns the reason why the callback has no value, if the force is undefined because of the
    /// callback.
    fn undefined(
        &self,
        _x: &[S::Pose<f64>],
        _v: &[S::Twist<f64>],
        _f: &[[f64; 3]],
    ) -> Option<UndefinedValue> {
        None
    }
    /// Returns this drive with another force law for the same joint coordinate. If the current law
    /// uses the change since the start, the new law uses it as well. Returns `None` if the element
    /// is not a drive with a force law.
    fn with_law(&self, _law: &Law) -> Option<Box<dyn ForceKernels<S>>> {
        None
    }
    /// Computes the force along the joint coordinate of a drive with a force law.
    fn drive(
        &self,
        _x: &[S::Pose<f64>],
        _v: &[S::Twist<f64>],
        _f: &[[f64; 3]],
    ) -> Option<DriveForce> {
        None
    }
}

impl<K: Force<S>, S: BodySpace> ForceKernels<S> for K {
    fn recorded_q(
        &self,
        x: &[S::Pose<RecordedNumber>],
        v: &[S::Twist<RecordedNumber>],
        f: &[[RecordedNumber; 3]],
        out: &mut [RecordedNumber],
    ) {
        self.element::<RecordedNumber>().q(x, v, f, out);
    }
    fn boxed(&self) -> Box<dyn ForceKernels<S>> {
        Box::new(self.clone())
    }
}

impl<S: BodySpace> Clone for Box<dyn ForceKernels<S>> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

impl AnyConstraint {
    pub(crate) fn spec(&self) -> &'static ConstraintSpec {
        with!(AnyConstraint, self, element, _S => element.spec())
    }

    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        with!(AnyConstraint, self, element, S => {
            element.points().into_iter().map(S::point).collect()
        })
    }

    pub(crate) fn data(&self, out: &mut [f64]) {
        with!(AnyConstraint, self, element, _S => element.data(out));
    }

    /// Writes the entries of C that depend only on parameters; the other entries do not change.
    pub(crate) fn c_constant(&self, out: &mut [f64]) {
        with!(AnyConstraint, self, element, _S => element.c_constant(out));
    }
}

impl AnyForce {
    pub(crate) fn spec(&self) -> &'static ForceSpec {
        with!(AnyForce, self, element, _S => element.spec())
    }

    /// Returns the number of states of the force law.
    pub(crate) fn n_states(&self) -> usize {
        with!(AnyForce, self, element, _S => element.n_states())
    }

    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        with!(AnyForce, self, element, S => {
            element.points().into_iter().map(S::point).collect()
        })
    }
}
