//! Decides whether simplified Newton iterations have converged, will not converge, or have reached
//! the noise of rounding. All implicit methods use this module.
//!
//! Source: Hairer, Wanner II, 2nd ed., IV.8. The constants are those of the authors' program
//! RADAU5. The rule for noise is new.

pub(crate) const MAX_ITERATIONS: u32 = 7;
/// If the convergence rate is at most this value, the matrices are used for another step.
pub(crate) const GOOD_RATE: f64 = 1e-3;
/// If the convergence rate is at least this value, the iteration does not converge.
const BAD_RATE: f64 = 0.99;
/// Step-size factor if the convergence rate is not known.
const FACTOR_WITHOUT_RATE: f64 = 0.5;
/// An iteration may have reached the noise of rounding if it first converged at this rate and then
/// stops converging.
const RATE_ABOVE_NOISE: f64 = 0.1;
/// Largest increment of an iteration that has reached this noise, as a fraction of the permitted
/// error.
const LARGEST_NOISE: f64 = 0.03;

/// The decision after an iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Verdict {
    /// Iterate again.
    GoOn,
    /// The solution is accurate enough.
    Converged,
    /// The iteration ends without success. The iteration might converge with `factor` times the
    /// step size.
    Diverged { factor: f64 },
}

/// Convergence of the iterations of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Convergence {
    /// Number of iterations so far.
    pub(crate) iterations: u32,
    /// Smoothed quotient of successive increments.
    pub(crate) rate: f64,
    /// Bound rate/(1 − rate) on the remaining error relative to the last increment. For the first
    /// iteration, the bound comes from earlier steps.
    remaining: f64,
    norm: f64,
    quotient: f64,
    smallest_quotient: f64,
}

impl Default for Convergence {
    fn default() -> Self {
        Self {
            iterations: 0,
            rate: GOOD_RATE,
            remaining: 1.0,
            norm: 0.0,
            quotient: 0.0,
            smallest_quotient: f64::INFINITY,
        }
    }
}

impl Convergence {
    /// Returns the state for the next solve. The first iteration of the next solve uses the bound
    /// on the remaining error from this solve.
    pub(crate) fn next(self) -> Self {
        Self {
            remaining: self.remaining.max(f64::EPSILON).powf(0.8),
            ..Self::default()
        }
    }

    /// Evaluates an iteration with increments of the given norm. `permitted` is the permitted norm
    /// of the remaining error.
    pub(crate) fn judge(&mut self, norm: f64, permitted: f64) -> Verdict {
        self.iterations += 1;
        let (last_norm, last_quotient) = (self.norm.max(f64::EPSILON), self.quotient);
        self.norm = norm;
        if !norm.is_finite() {
            self.rate = norm;
            return Verdict::Diverged {
                factor: FACTOR_WITHOUT_RATE,
            };
        }
        let mut factor = None;
        if self.iterations > 1 {
            self.quotient = norm / last_norm;
            self.rate = match self.iterations {
                2 => self.quotient,
                _ => (self.quotient * last_quotient).sqrt(),
            };
            factor = self.factor_if_hopeless(permitted);
        }
        let is_noise = self.smallest_quotient <= RATE_ABOVE_NOISE && norm <= LARGEST_NOISE;
        self.smallest_quotient = match self.iterations {
            1 => f64::INFINITY,
            _ => self.smallest_quotient.min(self.quotient),
        };
        match factor {
            Some(_) if is_noise => {
                (self.rate, self.remaining) = (self.smallest_quotient, self.smallest_quotient);
                Verdict::Converged
            }
            Some(factor) => Verdict::Diverged { factor },
            None if self.remaining * norm <= permitted => Verdict::Converged,
            None if self.iterations == MAX_ITERATIONS => Verdict::Diverged {
                factor: FACTOR_WITHOUT_RATE,
            },
            None => Verdict::GoOn,
        }
    }

    /// Sets `remaining`. Returns a factor of the step size if the remaining iterations will not be
    /// sufficient.
    fn factor_if_hopeless(&mut self, permitted: f64) -> Option<f64> {
        if self.rate >= BAD_RATE {
            return Some(FACTOR_WITHOUT_RATE);
        }
        self.remaining = self.rate / (1.0 - self.rate);
        let left = MAX_ITERATIONS - self.iterations;
        let end = self.remaining * self.norm * self.rate.powf(f64::from(left)) / permitted;
        (end >= 1.0).then(|| 0.8 * end.min(20.0).powf(-1.0 / f64::from(4 + left)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judge_all(norms: &[f64], permitted: f64) -> (Vec<Verdict>, Convergence) {
        let mut convergence = Convergence::default();
        let verdicts = norms
            .iter()
            .map(|n| convergence.judge(*n, permitted))
            .collect();
        (verdicts, convergence)
    }

    #[test]
    fn iterations_end_by_their_rate() {
        use Verdict::{Converged, Diverged, GoOn};
        // The bound is 1e-2/(1 − 1e-2)·1e-4 ≤ 1e-5.
        let (verdicts, last) = judge_all(&[1.0, 1e-2, 1e-4], 1e-5);
        assert_eq!(verdicts, [GoOn, GoOn, Converged]);
        assert!((last.rate - 1e-2).abs() < 1e-16);
        assert_eq!(judge_all(&[1.0, 1.0], 1e-5).0[1], Diverged { factor: 0.5 });
        // With a rate of 0.5, even the last permitted increment is far larger than 1e-8.
        let (verdicts, _) = judge_all(&[1.0, 0.5], 1e-8);
        assert!(matches!(verdicts[1], Diverged { factor } if factor > 0.5 && factor < 0.8));
        assert_eq!(judge_all(&[f64::NAN], 1e-5).0, [Diverged { factor: 0.5 }]);
    }

    #[test]
    fn noise_is_what_no_longer_contracts_and_is_small() {
        use Verdict::{Converged, Diverged};
        let (verdicts, last) = judge_all(&[1.0, 1e-3, 1e-3, 1e-3], 1e-6);
        assert_eq!(verdicts[3], Converged);
        assert_eq!(last.rate, 1e-3);
        // The increments are too large to be noise, and they have not decreased before.
        let (verdicts, _) = judge_all(&[1e3, 1.0, 1.0, 1.0], 1e-6);
        assert!(matches!(verdicts[3], Diverged { .. }));
        assert!(matches!(
            judge_all(&[1e-3, 1e-3], 1e-6).0[1],
            Diverged { .. }
        ));
    }
}
