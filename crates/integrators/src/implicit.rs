//! Problems for methods that solve linear systems with the Jacobian J = ∂f/∂y.
//!
//! The module `dense_implicit` treats a plain problem with dense matrices.

use crate::ode::Ode;

/// A problem that stores its Jacobian and solves with the two matrices of Radau IIA.
///
/// The linear algebra belongs to the problem, because the problem determines the dependencies
/// between the components. A problem without its own linear algebra can be wrapped in
/// [`DenseImplicit`](crate::DenseImplicit). J may be an approximation. The accuracy of J affects
/// the convergence of Newton's method, but not the result.
pub trait Implicit: Ode {
    /// Computes J = ∂f/∂y at (t, y) and stores it; `y` has length n.
    ///
    /// # Errors
    ///
    /// Returns errors of the problem. The trial step is then rejected.
    fn linearise(&mut self, t: f64, y: &[f64]) -> Result<(), Self::Error>;

    /// Factors `a·I − J` for a = `real` and for a = `complex[0]` + i·`complex[1]`, with the last
    /// stored J. The function may be called several times with the same J.
    ///
    /// # Errors
    ///
    /// Returns errors of the problem, in particular for a singular matrix. The trial step is then
    /// rejected and repeated with a smaller step size.
    fn factor(&mut self, real: f64, complex: [f64; 2]) -> Result<(), Self::Error>;

    /// Overwrites `x` (length n) with the solution of the real system.
    fn solve(&mut self, x: &mut [f64]);

    /// Overwrites `re` + i·`im` (length n each) with the solution of the complex system.
    fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]);
}
