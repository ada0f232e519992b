//! Mechanical problems for methods that treat the constraints as equations of their own.
//!
//! Not here: methods that see only accelerations (every [`Ode`]); which rows are kept and how they are solved (the problem).

#[cfg(test)]
pub(crate) mod problems;

use crate::ode::Ode;

/// A problem of motion with independent constraints,
///
/// ```text
/// q' = T(q)·v,   M(t, q)·v' + Gᵀ·λ = f(t, q, v),   G(t, q)·v = b(t, q),   Φ(t, q) = 0
/// ```
///
/// and the state y = [q; v; rest]. The rows of G are independent, those of Φ' = 0 first (holonomic rows), then the others; `rest` are
/// quadratures such as work, on which nothing else depends. [`Ode::rhs`] gives y' with v' from `G·v' = b' − G'·v`.
///
/// Lengths: q has n_q, v has n_v, λ has r components. n_q = n_v in the plane; in space T is not the identity.
pub trait Constrained: Ode {
    /// Lengths of the parts. Between two steps holonomic rows may be exchanged for others; all lengths but these two are fixed, and so is r.
    fn sizes(&self) -> Sizes;

    /// Writes `q + T(q)·d` (or a better approximation of the motion from q over the small displacement d) to `out` (length n_q); d has
    /// length n_v.
    fn displace(&self, q: &[f64], d: &[f64], out: &mut [f64]);

    /// Writes the residuals of the equations at (t, y) for the accelerations `a` and the multipliers `lambda` to `out`, length n_v + r:
    /// `M·a + Gᵀ·λ − f`, then Φ for the holonomic rows, then `G·v − b` for the others.
    ///
    /// # Errors
    ///
    /// The problem's own.
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        a: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Self::Error>;

    /// Factors
    ///
    /// ```text
    /// [ M + c_v·D + c_q·K   Gᵀ ]        D = −∂f/∂v,   K = ∂(M·a + Gᵀ·λ − f)/∂q
    /// [ G                   0  ]
    /// ```
    ///
    /// at (t, y). D and K may be approximations: they decide how fast Newton's method converges, not to what.
    ///
    /// # Errors
    ///
    /// The problem's own, above all a singular matrix.
    fn factor(&mut self, point: &Linearisation<'_>) -> Result<(), Self::Error>;

    /// Overwrites `x` (length n_v + r) with the solution of the system that was factored last.
    fn solve(&mut self, x: &mut [f64]);
}

/// Where and with which weights [`Constrained::factor`] linearises.
#[derive(Debug, Clone, Copy)]
pub struct Linearisation<'a> {
    /// Time.
    pub t: f64,
    /// State.
    pub y: &'a [f64],
    /// Accelerations.
    pub a: &'a [f64],
    /// Multipliers.
    pub lambda: &'a [f64],
    /// Weight of D, in units of time.
    pub c_v: f64,
    /// Weight of K, in units of time squared.
    pub c_q: f64,
}

/// Lengths of the parts of a [`Constrained`] problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// n_q.
    pub positions: usize,
    /// n_v.
    pub velocities: usize,
    /// Independent rows that are derivatives of Φ = 0.
    pub holonomic: usize,
    /// Independent rows that are not.
    pub nonholonomic: usize,
}

impl Sizes {
    /// r, number of rows and of multipliers.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.holonomic + self.nonholonomic
    }

    /// Where v lies in y.
    pub(crate) fn velocity_range(&self) -> std::ops::Range<usize> {
        self.positions..self.positions + self.velocities
    }

    /// Where the quadratures begin in y.
    pub(crate) fn rest(&self) -> usize {
        self.positions + self.velocities
    }
}
