//! Problems for methods that solve linear systems with the Jacobian J = ∂f/∂y.
//!
//! Not here: how a plain problem does it with dense matrices (`dense_implicit`); constraints as
//! equations (`constrained`).

use crate::ode::Ode;

/// A problem that keeps its Jacobian and solves with the two matrices of Radau IIA.
///
/// The linear algebra belongs to the problem: it knows which components depend on each other.
/// Whoever has none of his own wraps the problem in [`DenseImplicit`](crate::DenseImplicit). J may
/// be an approximation: it decides how fast Newton's method converges, not to what.
pub trait Implicit: Ode {
    /// Computes J = ∂f/∂y at (t, y) and keeps it; `y` has length n.
    ///
    /// # Errors
    ///
    /// The problem's own; the trial step is then rejected.
    fn linearise(&mut self, t: f64, y: &[f64]) -> Result<(), Self::Error>;

    /// Factors `a·I − J` for a = `real` and for a = `complex[0]` + i·`complex[1]`, with the J kept
    /// last. May be called again with the same J.
    ///
    /// # Errors
    ///
    /// The problem's own, above all a singular matrix; the trial step is then rejected and repeated
    /// with a shorter step.
    fn factor(&mut self, real: f64, complex: [f64; 2]) -> Result<(), Self::Error>;

    /// Overwrites `x` (length n) with the solution of the real system.
    fn solve(&mut self, x: &mut [f64]);

    /// Overwrites `re` + i·`im` (length n each) with the solution of the complex system.
    fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]);
}
