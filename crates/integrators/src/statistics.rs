//! Cost of an integration.

use std::ops::Add;

/// Counts of one integration. The counts are also complete after a failure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Statistics {
    /// Evaluations of f for the steps, including starts, restarts at break times, stages and
    /// rejected trials.
    pub evaluations: u64,
    /// Evaluations of f for dense output.
    pub output_evaluations: u64,
    /// Evaluations of f reported by [`crate::Ode::end_of_step`].
    pub hook_evaluations: u64,
    /// Evaluations of a Jacobian or of the matrices of a constrained problem. Evaluations of f for
    /// differences are not counted in `evaluations`.
    pub jacobians: u64,
    /// Factorisations for one step size. A real and a complex factorisation (Radau IIA) count as
    /// one.
    pub factorisations: u64,
    /// Solutions of a linear system. A real and a complex solution of the same iteration count as
    /// one.
    pub solves: u64,
    /// Iterations of Newton's method.
    pub newton_iterations: u64,
    /// Accepted steps.
    pub accepted: u64,
    /// Trials rejected because the estimated error was too large.
    pub rejected_by_error: u64,
    /// Trials rejected because f or the hook failed or a value was not finite.
    pub rejected_by_failure: u64,
    /// Trials rejected by [`crate::StepEnd::Reject`].
    pub rejected_by_hook: u64,
    /// Accepted steps that were projected.
    pub projections: u64,
    /// Largest reported correction of an accepted step.
    pub largest_correction: f64,
}

impl Statistics {
    /// Returns the number of rejected trials for any reason.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.rejected_by_error + self.rejected_by_failure + self.rejected_by_hook
    }

    /// Returns the number of all evaluations of f: for steps, in the hook and for output.
    #[must_use]
    pub fn total_evaluations(&self) -> u64 {
        self.evaluations + self.hook_evaluations + self.output_evaluations
    }
}

/// Adds the costs of two successive integrations.
impl Add for Statistics {
    type Output = Self;

    fn add(self, next: Self) -> Self {
        Self {
            evaluations: self.evaluations + next.evaluations,
            output_evaluations: self.output_evaluations + next.output_evaluations,
            hook_evaluations: self.hook_evaluations + next.hook_evaluations,
            jacobians: self.jacobians + next.jacobians,
            factorisations: self.factorisations + next.factorisations,
            solves: self.solves + next.solves,
            newton_iterations: self.newton_iterations + next.newton_iterations,
            accepted: self.accepted + next.accepted,
            rejected_by_error: self.rejected_by_error + next.rejected_by_error,
            rejected_by_failure: self.rejected_by_failure + next.rejected_by_failure,
            rejected_by_hook: self.rejected_by_hook + next.rejected_by_hook,
            projections: self.projections + next.projections,
            largest_correction: self.largest_correction.max(next.largest_correction),
        }
    }
}
