//! Constraints: the traits that a definition implements.
//!
//! A block has one row for each constraint row, and for each body slot as many columns as a body
//! has velocities: x, y, rotation in the plane; x, y, z and three rotations in space. Slices `x`
//! and `v` hold the poses and twists of the slots in order, `f` the values and derivatives `[f, ḟ,
//! f̈]` of the functions of time. Output slices are overwritten. Sparse outputs follow the pattern
//! of the [`ConstraintSpec`].

use crate::arguments::{Argument, ArgumentError};
use crate::definition::Definition;
use crate::ring::{Real, Ring};
use crate::space::{Plane, Space};
use crate::spec::ConstraintSpec;
use crate::visitor::Visitor;

/// A constraint definition as a type: its specification, its constructor and its kernels in any
/// number type. Implemented by generated code only.
pub trait Constraint<S: Space = Plane>: Derivatives<f64, S> + Clone + 'static {
    /// The specification of the definition.
    const SPEC: ConstraintSpec;

    /// The constraint with these values for its parameters; initial values are zero until
    /// [`Definition::initialise`].
    ///
    /// # Errors
    /// If a value is missing, of another shape or out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// Calls a visitor with the drives of the measures, in the order of the measures.
    fn visit_drives<V: Visitor<S>>(visitor: &mut V);

    /// Its rows at poses in a number type.
    fn positions<T: Ring>(&self) -> &dyn Positions<T, S>;

    /// Its kernels in a number type.
    fn element<T: Ring>(&self) -> &dyn Element<T, S>;

    /// Its kernels with further derivatives in a number type.
    fn derivatives<T: Ring>(&self) -> &dyn Derivatives<T, S>;
}

/// The rows of a constraint at poses in closed form, for one number type: all that proofs of ranks
/// and bounds on the rounding of data need.
pub trait Positions<T: Ring = f64, S: Space = Plane>: Definition<S> {
    /// The specification of the definition.
    fn spec(&self) -> &'static ConstraintSpec;

    /// Writes `Φ`, one value for each holonomic row.
    fn phi(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes the entries of the block of C that depend on parameters only; the others are not
    /// changed.
    fn c_constant(&self, out: &mut [f64]);

    /// Writes the other entries of the block of C: `C = ∂Φ̇/∂v` or `Ψ`.
    fn c(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);
}

/// The kernels of a constraint in closed form, for one number type.
pub trait Element<T: Ring = f64, S: Space = Plane>: Positions<T, S> {
    /// Writes `b = −Φt` or `−ψ`, one value for each row; nothing for scleronomic constraints, whose
    /// b is zero.
    fn b(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes `Γ` of `C·a = Γ`, one value for each row.
    fn gamma(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of the map `W` (components × rows) of the wrench on the first body, `W·λ` =
    /// `[Fx, Fy, T]` or `[Fx, Fy, Fz, Tx, Ty, Tz]`, with the moment about the place.
    fn wrench(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T])
    where
        T: Real;

    /// Writes the coefficients of the named component of the reaction, `Σ out·λ`; nothing if there
    /// is none.
    fn component(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// The point at which the reaction is reported, global components.
    fn place(&self, x: &[S::Pose<T>]) -> S::Vector<T>
    where
        T: Real;

    /// Writes `∂(λᵀ·Φ)/∂p`, one value for each number p of [`Definition::data`], from the λ of the
    /// holonomic rows.
    ///
    /// Values that are computed from other numbers change with them. Values stored at the start do
    /// not: they are numbers of their own.
    ///
    /// ```
    /// use joints::{Argument, Constraint, Definition, Element, Pose, generated::Distance};
    /// # fn main() -> Result<(), joints::ArgumentError> {
    /// let ends = [Argument::Pair([0.0, 0.0]), Argument::Pair([0.0, 0.0])];
    /// let mut rod = Distance::from_arguments(&ends)?;
    /// let x = [Pose::GROUND, Pose::new(3.0, 4.0, 0.0)];
    /// rod.initialise(&x);
    /// let mut gradient = [0.0; 5];
    /// rod.d_phi_dp(&x, &[], &[10.0], &mut gradient);
    /// // Φ = (d·d − L²)/(2L): the derivatives are 10·(∓d/L) for the ends and −10 for the length.
    /// assert_eq!(gradient, [-6.0, -8.0, 6.0, 8.0, -10.0]);
    /// # Ok(())
    /// # }
    /// ```
    fn d_phi_dp(&self, x: &[S::Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]);
}

/// Further derivatives of the kernels of a constraint, for implicit methods and for what hangs on
/// data. They are most of the code of a definition; a number type that does not need them has none
/// of it.
pub trait Derivatives<T: Ring = f64, S: Space = Plane>: Element<T, S> {
    /// Entries of `∂(Cᵀλ)/∂x`, by the degrees of freedom of the slots.
    fn d_force_dx(&self, x: &[S::Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]);

    /// Entries of `∂(C·a − Γ)/∂x`.
    fn d_residual_dx(
        &self,
        x: &[S::Pose<T>],
        v: &[S::Twist<T>],
        a: &[S::Twist<T>],
        f: &[[T; 3]],
        out: &mut [T],
    );

    /// Entries of `∂Γ/∂v`.
    fn d_gamma_dv(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂(C·v − b)/∂x`.
    fn d_velocity_dx(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes `∂(λᵀ·(C·a − Γ))/∂p`, one value for each number p of [`Definition::data`], with
    /// dependent values as in [`Element::d_phi_dp`]. At `v = 0` and `f = 0` it is the gradient of
    /// `λᵀ·C·a`.
    fn d_residual_dp(
        &self,
        x: &[S::Pose<T>],
        v: &[S::Twist<T>],
        a: &[S::Twist<T>],
        f: &[[T; 3]],
        lambda: &[T],
        out: &mut [T],
    );
}
