//! The problem that every library gets: one right-hand side, whose evaluations are counted in one
//! place, and the task of an integration.
//!
//! The problems themselves (`problems`) and the libraries (`libraries`) are not part of this
//! module.

use std::cell::Cell;

/// y' = f(t, y) with N components.
pub trait Problem<const N: usize> {
    /// Writes f(t, y) to `dy`; NaN if it cannot be evaluated.
    fn rhs(&self, t: f64, y: &[f64; N], dy: &mut [f64; N]);
}

/// A problem with a known Jacobian.
pub trait Differentiated<const N: usize>: Problem<N> {
    /// Writes ∂f/∂y to `j`: `j[i][k]` = ∂f_i/∂y_k.
    fn jacobian(&self, t: f64, y: &[f64; N], j: &mut [[f64; N]; N]);
}

/// A problem that counts its evaluations, including those for Jacobians by differences.
pub struct Counted<'a, P> {
    problem: &'a P,
    evaluations: Cell<u64>,
}

impl<'a, P> Counted<'a, P> {
    /// A counter that starts at zero.
    pub fn new(problem: &'a P) -> Self {
        Self {
            problem,
            evaluations: Cell::new(0),
        }
    }

    /// Evaluations so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// f(t, y), counted.
    #[inline]
    pub fn rhs<const N: usize>(&self, t: f64, y: &[f64; N], dy: &mut [f64; N])
    where
        P: Problem<N>,
    {
        self.evaluations.set(self.evaluations.get() + 1);
        self.problem.rhs(t, y, dy);
    }

    /// Works like [`Self::rhs`], for libraries that use slices.
    ///
    /// # Panics
    /// Panics if a slice does not have length N.
    #[inline]
    pub fn rhs_of_slices<const N: usize>(&self, t: f64, y: &[f64], dy: &mut [f64])
    where
        P: Problem<N>,
    {
        self.rhs(t, array(y), array_mut(dy));
    }

    /// ∂f/∂y, not counted.
    pub fn jacobian<const N: usize>(&self, t: f64, y: &[f64; N], j: &mut [[f64; N]; N])
    where
        P: Differentiated<N>,
    {
        self.problem.jacobian(t, y, j);
    }
}

/// A slice as an array.
///
/// # Panics
/// Panics if the slice does not have length N.
#[inline]
pub fn array<const N: usize>(y: &[f64]) -> &[f64; N] {
    y.try_into().expect("a state has N components")
}

/// A slice as a mutable array.
///
/// # Panics
/// Panics if the slice does not have length N.
#[inline]
pub fn array_mut<const N: usize>(y: &mut [f64]) -> &mut [f64; N] {
    y.try_into().expect("a state has N components")
}

/// The task of one integration from t = 0.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a, const N: usize> {
    /// Initial state.
    pub y0: [f64; N],
    /// Last time.
    pub t_end: f64,
    /// Times inside the interval at which a step must end and the method must restart.
    pub break_times: &'a [f64],
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance, the same for all components.
    pub atol: f64,
    /// First step, if the method does not choose it.
    pub first_step: Option<f64>,
}

/// The end of an integration and its cost.
#[derive(Clone, Copy, Debug)]
pub struct End<const N: usize> {
    /// State.
    pub y: [f64; N],
    /// Evaluations of f.
    pub evaluations: u64,
    /// Accepted steps.
    pub steps: u64,
}

/// The end of an integration, or the error message of the library.
pub type Solved<const N: usize> = Result<End<N>, String>;

impl<const N: usize> Asked<'_, N> {
    /// Integrates each interval between two break times: `leg(t0, t1, y)` advances y from t0 to t1
    /// and returns the number of accepted steps.
    ///
    /// # Errors
    /// Same errors as `leg`.
    pub fn by_legs(
        &self,
        mut leg: impl FnMut(f64, f64, &mut [f64; N]) -> Result<u64, String>,
    ) -> Result<([f64; N], u64), String> {
        let (mut y, mut t0, mut steps) = (self.y0, 0.0, 0);
        let inside = |t: &&f64| **t > 0.0 && **t < self.t_end;
        for &t1 in self.break_times.iter().filter(inside).chain([&self.t_end]) {
            steps += leg(t0, t1, &mut y)?;
            t0 = t1;
        }
        Ok((y, steps))
    }
}
