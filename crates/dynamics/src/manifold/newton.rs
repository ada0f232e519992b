//! Newton's method on one level of rows, either positions or velocities. The level computes
//! residuals and corrections.

use crate::limits::CONVERGENCE;

/// A level of a state that is moved onto the constraints.
pub(super) trait Level {
    /// Reason why the level cannot be corrected.
    type Fault;

    /// Returns the residual of the independent rows after this number of corrections. The result is
    /// the row with the largest residual, and this residual in rounding errors of the terms of the
    /// row.
    fn misses(&mut self, corrections: usize) -> (usize, f64);

    /// Makes one correction. `converges` states whether the last correction reduced the residual to
    /// a tenth or less.
    fn correct(&mut self, converges: bool) -> Result<(), Self::Fault>;
}

/// Stopping rules.
pub(super) struct Limits {
    /// Smallest and largest number of corrections.
    pub(super) corrections: [usize; 2],
    /// Rows count as satisfied below this number of rounding errors of their terms.
    pub(super) enough: f64,
    /// The limit that applies if a further correction does not help.
    pub(super) stalled: f64,
}

/// State of the iteration at its end.
pub(super) struct End {
    pub(super) corrections: usize,
    /// The row with the largest residual.
    pub(super) worst: usize,
    /// Whether this row counts as satisfied.
    pub(super) is_reached: bool,
}

/// Corrects a level until its rows count as satisfied.
pub(super) fn correct<L: Level>(level: &mut L, limits: &Limits) -> Result<End, L::Fault> {
    let [least, most] = limits.corrections;
    let mut best = f64::INFINITY;
    let mut corrections = 0;
    loop {
        let (worst, roundings) = level.misses(corrections);
        // Rounding errors may leave a slightly larger residual. An iteration that stalls near this
        // limit has also converged.
        let is_stalled = roundings >= 0.5 * best && roundings <= limits.stalled;
        let is_reached = corrections >= least && (roundings <= limits.enough || is_stalled);
        if is_reached || corrections == most || roundings.is_nan() {
            return Ok(End {
                corrections,
                worst,
                is_reached,
            });
        }
        let converges = roundings <= CONVERGENCE * best;
        best = best.min(roundings);
        corrections += 1;
        level.correct(converges)?;
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;
    use crate::limits::{ROUNDINGS, STALLED_ROUNDINGS};

    /// A row whose residual is multiplied by a factor at each correction. The residual has a lower
    /// limit.
    struct Shrinking {
        misfit: f64,
        factor: f64,
        floor: f64,
    }

    impl Level for Shrinking {
        type Fault = Infallible;

        fn misses(&mut self, _: usize) -> (usize, f64) {
            (3, self.misfit)
        }

        fn correct(&mut self, _: bool) -> Result<(), Infallible> {
            self.misfit = (self.misfit * self.factor).max(self.floor);
            Ok(())
        }
    }

    fn run(misfit: f64, factor: f64, floor: f64, corrections: [usize; 2]) -> (usize, bool) {
        let mut level = Shrinking {
            misfit,
            factor,
            floor,
        };
        let limits = Limits {
            corrections,
            enough: ROUNDINGS,
            stalled: STALLED_ROUNDINGS,
        };
        let Ok(end) = correct(&mut level, &limits);
        assert_eq!(end.worst, 3);
        (end.corrections, end.is_reached)
    }

    #[test]
    fn rows_are_corrected_until_they_are_satisfied_or_stall_close_to_it() {
        assert_eq!(run(5.0, 0.1, 0.0, [0, 20]), (0, true));
        assert_eq!(run(5.0, 0.1, 0.0, [1, 20]), (1, true));
        assert_eq!(run(1e4, 0.1, 0.0, [0, 20]), (3, true));
        // A lower limit of 30 roundings is accepted, but a limit of 100 roundings is not.
        assert_eq!(run(1e4, 0.1, 30.0, [0, 20]), (4, true));
        assert_eq!(run(1e4, 0.1, 100.0, [0, 20]), (20, false));
        assert_eq!(run(f64::NAN, 0.1, 0.0, [0, 20]), (0, false));
    }
    /// A row whose residual falls by a constant factor. The row records whether old factors may be
    /// used again.
    struct Falling {
        misfit: f64,
        share: f64,
        served: Vec<bool>,
    }

    impl Level for Falling {
        type Fault = Infallible;

        fn misses(&mut self, _: usize) -> (usize, f64) {
            (0, self.misfit)
        }

        fn correct(&mut self, converges: bool) -> Result<(), Infallible> {
            self.served.push(converges);
            self.misfit *= self.share;
            Ok(())
        }
    }

    /// A factorisation costs about as much as ten corrections. A factorisation is therefore made if
    /// one correction does not reduce the residual to a tenth.
    #[test]
    fn factors_serve_as_long_as_a_correction_gains_a_digit() {
        for (share, serves) in [(0.09, true), (0.11, false)] {
            let mut level = Falling {
                misfit: 1e6,
                share,
                served: Vec::new(),
            };
            let limits = Limits {
                corrections: [0, 3],
                enough: 0.0,
                stalled: 0.0,
            };
            let Ok(_) = correct(&mut level, &limits);
            // The first correction shows whether the factors of the earlier state can be used.
            assert_eq!(level.served, [true, serves, serves], "share {share}");
        }
    }
}
