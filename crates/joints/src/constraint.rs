//! Constraints: the trait that a definition expands to, and its face as an object.
//!
//! A block has one row for each constraint row and three columns for each body slot (x, y, rotation). Slices `x` and `v` hold
//! the poses and twists of the slots in order, `f` the jets `[f, ḟ, f̈]` of the functions of time.
//! Output slices are overwritten. Sparse outputs follow the pattern of the [`ConstraintSpec`].

use crate::arguments::{Argument, ArgumentError};
use crate::plane::{Pose, Twist};
use crate::ring::Ring;
use crate::spec::ConstraintSpec;
use crate::visitor::Visitor;

/// A constraint definition in closed form. Implemented by generated code only.
pub trait Constraint: Clone + Send + Sync + Sized + 'static {
    /// The facts of the definition.
    const SPEC: ConstraintSpec;

    /// The constraint with these values for its parameters; initial values are zero until
    /// [`Constraint::initialise`].
    ///
    /// # Errors
    /// If a value is missing, of another shape or out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// Shows the drives of the definition's measures to a visitor, in the order of the measures.
    fn visit_drives<V: Visitor>(visitor: &mut V);

    /// Takes the values that the definition keeps from the assembled start.
    fn initialise(&mut self, x: &[Pose]);

    /// Whether requirement `k` of the definition holds at the assembled start.
    fn requirement(&self, k: usize, x: &[Pose]) -> bool;

    /// Points that the definition takes hold of, each in the frame of its body: values of the parameters of this shape, in their
    /// order. None where a definition does not say.
    fn points(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// `Φ`, one value for each row. Nothing for nonholonomic constraints.
    fn phi<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of the block of C that depend on parameters only; the others are left alone.
    fn c_constant(&self, out: &mut [f64]);

    /// The other entries of the block of C: `C = ∂Φ̇/∂v` or `Ψ`.
    fn c<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// `b = −Φt` or `−ψ`, one value for each row. Nothing for scleronomic constraints, whose b is zero.
    fn b<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// `Γ` of `C·a = Γ`, one value for each row.
    fn gamma<T: Ring>(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of the 3 × rows map `W` of the wrench on the first body, `[Fx, Fy, T] = W·λ`, T about the place.
    fn wrench<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Coefficients of the named component of the reaction, `Σ out·λ`. Nothing where there is none.
    fn component<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// The point at which the reaction is reported, global components.
    fn place<T: Ring>(&self, x: &[Pose<T>]) -> [T; 2];

    /// Entries of `∂(Cᵀλ)/∂x`, by the degrees of freedom of the slots.
    fn d_force_dx<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]);

    /// Entries of `∂(C·a − Γ)/∂x`.
    fn d_residual_dx<T: Ring>(
        &self,
        x: &[Pose<T>],
        v: &[Twist<T>],
        a: &[Twist<T>],
        f: &[[T; 3]],
        out: &mut [T],
    );

    /// Entries of `∂Γ/∂v`.
    fn d_gamma_dv<T: Ring>(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂(C·v − b)/∂x`.
    fn d_velocity_dx<T: Ring>(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
}

/// A constraint as an object, for one number type.
pub trait Element<T: Ring = f64>: Send + Sync {
    /// The facts of the definition.
    fn spec(&self) -> &'static ConstraintSpec;
    /// See [`Constraint::initialise`].
    fn initialise(&mut self, x: &[Pose]);
    /// See [`Constraint::requirement`].
    fn requirement(&self, k: usize, x: &[Pose]) -> bool;
    /// See [`Constraint::points`].
    fn points(&self) -> Vec<[f64; 2]>;
    /// See [`Constraint::phi`].
    fn phi(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Constraint::c_constant`].
    fn c_constant(&self, out: &mut [f64]);
    /// See [`Constraint::c`].
    fn c(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Constraint::b`].
    fn b(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Constraint::gamma`].
    fn gamma(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Constraint::wrench`].
    fn wrench(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Constraint::component`].
    fn component(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Constraint::place`].
    fn place(&self, x: &[Pose<T>]) -> [T; 2];
    /// See [`Constraint::d_force_dx`].
    fn d_force_dx(&self, x: &[Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]);
    /// See [`Constraint::d_residual_dx`].
    fn d_residual_dx(
        &self,
        x: &[Pose<T>],
        v: &[Twist<T>],
        a: &[Twist<T>],
        f: &[[T; 3]],
        out: &mut [T],
    );
    /// See [`Constraint::d_gamma_dv`].
    fn d_gamma_dv(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Constraint::d_velocity_dx`].
    fn d_velocity_dx(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
}

impl<T: Ring, K: Constraint> Element<T> for K {
    fn spec(&self) -> &'static ConstraintSpec {
        &K::SPEC
    }
    fn initialise(&mut self, x: &[Pose]) {
        Constraint::initialise(self, x);
    }
    fn requirement(&self, k: usize, x: &[Pose]) -> bool {
        Constraint::requirement(self, k, x)
    }
    fn points(&self) -> Vec<[f64; 2]> {
        Constraint::points(self)
    }
    fn phi(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::phi(self, x, f, out);
    }
    fn c_constant(&self, out: &mut [f64]) {
        Constraint::c_constant(self, out);
    }
    fn c(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::c(self, x, f, out);
    }
    fn b(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::b(self, x, f, out);
    }
    fn gamma(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::gamma(self, x, v, f, out);
    }
    fn wrench(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::wrench(self, x, f, out);
    }
    fn component(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::component(self, x, f, out);
    }
    fn place(&self, x: &[Pose<T>]) -> [T; 2] {
        Constraint::place(self, x)
    }
    fn d_force_dx(&self, x: &[Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]) {
        Constraint::d_force_dx(self, x, f, lambda, out);
    }
    fn d_residual_dx(
        &self,
        x: &[Pose<T>],
        v: &[Twist<T>],
        a: &[Twist<T>],
        f: &[[T; 3]],
        out: &mut [T],
    ) {
        Constraint::d_residual_dx(self, x, v, a, f, out);
    }
    fn d_gamma_dv(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::d_gamma_dv(self, x, v, f, out);
    }
    fn d_velocity_dx(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        Constraint::d_velocity_dx(self, x, v, f, out);
    }
}
