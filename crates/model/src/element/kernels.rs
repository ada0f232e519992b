//! Kernels of constraints and forces as trait objects, and the spaces that they are in.

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

/// A space of kernels in which bodies are described: the plane, or space.
pub trait BodySpace: joints::Space + Sized {
    /// A body as described.
    type Body: Clone + std::fmt::Debug + Into<DescribedBody>;

    /// The space of a mechanism of such bodies.
    const KIND: SpaceKind;

    /// Kernels as one of those of a mechanism.
    #[doc(hidden)]
    fn any_constraint(kernels: Box<dyn ConstraintKernels<Self>>) -> AnyConstraint;

    /// The same of a force.
    #[doc(hidden)]
    fn any_force(kernels: Box<dyn ForceKernels<Self>>) -> AnyForce;

    /// A point of a body with three coordinates.
    #[doc(hidden)]
    fn point(point: Self::Vector<f64>) -> [f64; 3];

    /// The components of a vector in this space.
    #[doc(hidden)]
    fn vector(components: [f64; 3]) -> Self::Vector<f64>;

    /// A global point relative to the centre of mass of a body, in its axes.
    #[doc(hidden)]
    fn to_local(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// A law on the measure of a drive, in the place of its motion.
    #[doc(hidden)]
    fn law<K: Constraint<Self>>(
        drive: K,
        law: Law,
    ) -> Result<Box<dyn ForceKernels<Self>>, LawError>;

    /// The kernels of a called wrench.
    #[doc(hidden)]
    fn wrench(wrench: CalledWrench) -> Box<dyn ForceKernels<Self>>;

    /// The constraint by which the second measure follows the first.
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
    /// In the plane.
    Plane(Box<dyn ConstraintKernels>),
    /// In space.
    Space3(Box<dyn ConstraintKernels<Space3>>),
}

/// Kernels of a force in the plane or in space.
#[doc(hidden)]
#[derive(Clone)]
pub enum AnyForce {
    /// In the plane.
    Plane(Box<dyn ForceKernels>),
    /// In space.
    Space3(Box<dyn ForceKernels<Space3>>),
}

/// Evaluates an expression in which `$element` are the kernels, and `$space` their space.
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

/// A measure that can be coupled: the bodies of its joint, and the kernels of its drive.
pub type AttachedMeasure<S = Plane> = (Vec<BodyRef>, Box<dyn ConstraintKernels<S>>);

/// A constraint with its bodies.
pub type AttachedConstraint<S = Plane> = (Vec<BodyRef>, Box<dyn ConstraintKernels<S>>);

/// Where the rows of a constraint are evaluated.
pub(crate) struct RowsAt<'a, S: Space, T: Ring> {
    pub(crate) kernels: &'a dyn ConstraintKernels<S>,
    /// The numbers that its programs take of it.
    pub(crate) stored: &'a [T],
    pub(crate) x: &'a [S::Pose<T>],
    pub(crate) f: &'a [[T; 3]],
}

impl<'a, S: Space, T: Ring> RowsAt<'a, S, T> {
    fn rows(&self) -> Rows<'a, T> {
        self.kernels.programs().of(self.stored)
    }
}

/// A number type in which a law and a coupling have the rows of a drive: `f64` by its kernels,
/// numbers that record by its programs.
pub(crate) trait DriveScalar: Scalar {
    /// The numbers that the programs take, each made of its value and its place; none for kernels,
    /// which read their own.
    fn stored_by<S: Space>(
        kernels: &dyn ConstraintKernels<S>,
        number: impl Fn(f64, usize) -> Self,
    ) -> Vec<Self>;

    fn phi<S: Space>(at: &RowsAt<'_, S, Self>, out: &mut [Self]);

    /// All entries of C.
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

/// The numbers that the programs of a constraint take of it, in any number type.
pub(crate) fn stored<S: Space, T: From<f64>>(kernels: &dyn ConstraintKernels<S>) -> Vec<T> {
    let mut numbers = Vec::new();
    kernels.stored(&mut numbers);
    numbers.into_iter().map(T::from).collect()
}

/// The kernels of a force as a trait object.
pub trait ForceKernels<S: BodySpace = Plane>: ForceElement<f64, S> {
    /// Entries of Q by numbers that record their operations.
    fn recorded_q(
        &self,
        x: &[S::Pose<RecordedNumber>],
        v: &[S::Twist<RecordedNumber>],
        f: &[[RecordedNumber; 3]],
        out: &mut [RecordedNumber],
    );
    /// A copy.
    fn boxed(&self) -> Box<dyn ForceKernels<S>>;
    /// Whether this is a drive by a law.
    fn is_law(&self) -> bool {
        false
    }
    /// Whether it calls a function of which values alone are known: then its derivatives are NaN.
    fn is_called(&self) -> bool {
        false
    }
    /// Why its called function has no value, if that is the cause.
    fn undefined(
        &self,
        _x: &[S::Pose<f64>],
        _v: &[S::Twist<f64>],
        _f: &[[f64; 3]],
    ) -> Option<UndefinedValue> {
        None
    }
    /// The same drive by another law, of the same measure: since the start, if the present one is.
    /// `None` if this is no drive by a law.
    fn with_law(&self, _law: &Law) -> Option<Box<dyn ForceKernels<S>>> {
        None
    }
    /// The force along the measure of a drive by a law.
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

    /// Entries of C that depend on parameters only; the others are left as they are.
    pub(crate) fn c_constant(&self, out: &mut [f64]) {
        with!(AnyConstraint, self, element, _S => element.c_constant(out));
    }
}

impl AnyForce {
    pub(crate) fn spec(&self) -> &'static ForceSpec {
        with!(AnyForce, self, element, _S => element.spec())
    }

    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        with!(AnyForce, self, element, S => {
            element.points().into_iter().map(S::point).collect()
        })
    }
}
