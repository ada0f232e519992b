//! Constraints: the trait that a definition expands to, and its face as an object.
//!
//! A block has one row for each constraint row and three columns for each body slot (x, y,
//! rotation). Slices `x` and `v` hold the poses and twists of the slots in order, `f` the jets
//! `[f, ḟ, f̈]` of the functions of time. Output slices are overwritten. Sparse outputs follow the
//! pattern of the [`ConstraintSpec`].

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

    /// Points that the definition takes hold of, each in the frame of its body: values of the
    /// parameters of this shape, in their order. None where a definition does not say.
    fn points(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// The numbers that the constraint stores, in the order of [`ConstraintSpec::data`].
    fn data(&self, out: &mut [f64]);

    /// Puts numbers in the place of those that [`Constraint::data`] tells, as they are: directions
    /// are not normalised. What [`Constraint::initialise`] computed from other numbers alone is
    /// computed again.
    fn set_data(&mut self, numbers: &[f64]);

    /// `Φ`, one value for each row. Nothing for nonholonomic constraints.
    fn phi<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of the block of C that depend on parameters only; the others are left alone.
    fn c_constant(&self, out: &mut [f64]);

    /// The other entries of the block of C: `C = ∂Φ̇/∂v` or `Ψ`.
    fn c<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// `b = −Φt` or `−ψ`, one value for each row. Nothing for scleronomic constraints, whose b is
    /// zero.
    fn b<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// `Γ` of `C·a = Γ`, one value for each row.
    fn gamma<T: Ring>(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of the 3 × rows map `W` of the wrench on the first body, `[Fx, Fy, T] = W·λ`, T
    /// about the place.
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

    /// `∂(λᵀ·Φ)/∂p`, one value for each number p of [`Constraint::data`]; zeros for nonholonomic
    /// constraints.
    ///
    /// What is computed from other numbers changes with them. What is kept from the start does not:
    /// it is a number of its own.
    ///
    /// ```
    /// use joints::{Argument, Constraint, Element, Pose, generated::Distance};
    /// # fn main() -> Result<(), joints::ArgumentError> {
    /// let ends = [Argument::Pair([0.0, 0.0]), Argument::Pair([0.0, 0.0])];
    /// let mut rod = Distance::from_arguments(&ends)?;
    /// let x = [Pose::GROUND, Pose::new(3.0, 4.0, 0.0)];
    /// Constraint::initialise(&mut rod, &x);
    /// let mut gradient = [0.0; 5];
    /// Element::d_phi_dp(&rod, &x, &[], &[10.0], &mut gradient);
    /// // Φ = (d·d − L²)/(2L): by the ends 10·(∓d/L), by the length −10.
    /// assert_eq!(gradient, [-6.0, -8.0, 6.0, 8.0, -10.0]);
    /// # Ok(())
    /// # }
    /// ```
    fn d_phi_dp<T: Ring>(&self, x: &[Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]);

    /// `∂(λᵀ·(C·a − Γ))/∂p`, one value for each number p of [`Constraint::data`], with the chain of
    /// [`Constraint::d_phi_dp`]. At `v = 0` and `f = 0` it is the gradient of `λᵀ·C·a`.
    fn d_residual_dp<T: Ring>(
        &self,
        x: &[Pose<T>],
        v: &[Twist<T>],
        a: &[Twist<T>],
        f: &[[T; 3]],
        lambda: &[T],
        out: &mut [T],
    );
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
    /// See [`Constraint::data`].
    fn data(&self, out: &mut [f64]);
    /// See [`Constraint::set_data`].
    fn set_data(&mut self, numbers: &[f64]);
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
    /// See [`Constraint::d_phi_dp`].
    fn d_phi_dp(&self, x: &[Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]);
    /// See [`Constraint::d_residual_dp`].
    fn d_residual_dp(
        &self,
        x: &[Pose<T>],
        v: &[Twist<T>],
        a: &[Twist<T>],
        f: &[[T; 3]],
        lambda: &[T],
        out: &mut [T],
    );
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
    fn data(&self, out: &mut [f64]) {
        Constraint::data(self, out);
    }
    fn set_data(&mut self, numbers: &[f64]) {
        Constraint::set_data(self, numbers);
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
    fn d_phi_dp(&self, x: &[Pose<T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]) {
        Constraint::d_phi_dp(self, x, f, lambda, out);
    }
    fn d_residual_dp(
        &self,
        x: &[Pose<T>],
        v: &[Twist<T>],
        a: &[Twist<T>],
        f: &[[T; 3]],
        lambda: &[T],
        out: &mut [T],
    ) {
        Constraint::d_residual_dp(self, x, v, a, f, lambda, out);
    }
}
