//! Chooses the order and the step size with the least work per unit of time.
//!
//! Source: HNW I, II.9, "Order and step size control", with the constants and the rules for first,
//! last and rejected steps of the program ODEX. Columns are counted from 1.

use super::columns::{COLUMNS, substeps, work};

/// The next step size is `SAFETY · (SAFETY_ERROR / err)^(1/(2j − 1))` times the current step size.
const SAFETY: f64 = 0.94;
const SAFETY_ERROR: f64 = 0.65;
/// Factors of h are between `MIN_FACTOR^(1/(2j−1)) / MAX_DIVISOR` and the inverse of
/// `MIN_FACTOR^(1/(2j−1))`.
const MIN_FACTOR: f64 = 0.02;
const MAX_DIVISOR: f64 = 4.0;
/// The order is lowered if the work per unit of time of the lower order is below the first fraction
/// of the current work. The order is raised if the work of the current order is below the second
/// fraction of the work of the lower order.
const LOWER_ORDER: f64 = 0.8;
const HIGHER_ORDER: f64 = 0.9;
/// Factor of the step size if the columns diverge.
const FACTOR_DIVERGED: f64 = 0.5;

/// The decision after a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    NextColumn,
    /// The trial ends: the step has converged, or it will not converge.
    Done,
}

/// Target column, and the predictions from the columns of the last trial.
#[derive(Debug, Clone)]
pub(super) struct OrderControl {
    /// Column in which convergence is expected; 2 ≤ `target` < `COLUMNS`.
    pub(super) target: usize,
    /// Last column of the last trial.
    pub(super) last: usize,
    /// For each column j, the best next step size, and the work per unit of time with this step
    /// size.
    sizes: [f64; COLUMNS + 1],
    rates: [f64; COLUMNS + 1],
    previous_error: f64,
    has_diverged: bool,
    after_rejection: bool,
    /// Whether this is the first step after the initial time or after an event.
    pub(super) is_first: bool,
}

impl OrderControl {
    pub(super) fn new() -> Self {
        Self {
            target: 4,
            last: 0,
            sizes: [0.0; COLUMNS + 1],
            rates: [f64::INFINITY; COLUMNS + 1],
            previous_error: f64::INFINITY,
            has_diverged: false,
            after_rejection: false,
            is_first: true,
        }
    }

    /// Sets the first target column from a relative tolerance.
    pub(super) fn aim(&mut self, rtol: f64) {
        let column = 1.5 - 0.6 * rtol.log10();
        self.target = (column as usize).clamp(2, COLUMNS - 1);
    }

    pub(super) fn begin(&mut self) {
        self.last = 1;
        self.previous_error = f64::INFINITY;
        self.has_diverged = false;
    }

    /// Decides after column j ≥ 2 of a trial of size |h| with error norm `error`. `is_fresh` is
    /// true for the first and the last step of an interval between two events, because the step
    /// size control did not choose the sizes of these steps.
    pub(super) fn judge(&mut self, j: usize, h: f64, error: f64, is_fresh: bool) -> Verdict {
        self.last = j;
        if !error.is_finite() || (j > 2 && error > (4.0 * self.previous_error).max(1.0)) {
            self.has_diverged = true;
            return Verdict::Done;
        }
        self.previous_error = error;
        let exponent = 1.0 / (2 * j - 1) as f64;
        let least = MIN_FACTOR.powf(exponent);
        let divisor = (error / SAFETY_ERROR).powf(exponent) / SAFETY;
        self.sizes[j] = h / divisor.max(least).min(MAX_DIVISOR / least);
        self.rates[j] = work(j) / self.sizes[j];

        let k = self.target;
        let n = |j: usize| substeps(j) as f64;
        if error <= 1.0 && (is_fresh || j >= k || (j + 1 == k && !self.after_rejection)) {
            return Verdict::Done;
        }
        // Largest error that the remaining columns can probably reduce below 1.
        let hope = if j > k {
            0.0
        } else if j == k {
            (n(k + 1) / n(1)).powi(2)
        } else if j + 1 == k && !is_fresh && !self.after_rejection {
            (n(k + 1) * n(k) / n(1).powi(2)).powi(2)
        } else {
            f64::INFINITY
        };
        if error > hope {
            Verdict::Done
        } else {
            Verdict::NextColumn
        }
    }

    /// Returns the best column after convergence in column c.
    fn best(&self) -> usize {
        let (c, k, w) = (self.last, self.target, &self.rates);
        let highest = COLUMNS - 1;
        if c == 2 {
            return if self.after_rejection { 2 } else { 3 };
        }
        if c <= k {
            if w[c] < HIGHER_ORDER * w[c - 1] {
                (c + 1).min(highest)
            } else if w[c - 1] < LOWER_ORDER * w[c] {
                c - 1
            } else {
                c
            }
        } else {
            let lower = if c > 3 && w[c - 2] < LOWER_ORDER * w[c - 1] {
                c - 2
            } else {
                c - 1
            };
            if w[c] < HIGHER_ORDER * w[lower] {
                c.min(highest)
            } else {
                lower
            }
        }
    }

    /// Deletes the data of previous steps; the target column is set again from the tolerance.
    pub(super) fn restart(&mut self) {
        self.is_first = true;
        self.after_rejection = false;
    }

    /// Returns the size of the next step after an accepted step.
    pub(super) fn accept(&mut self, h: f64) -> f64 {
        let (c, best) = (self.last, self.best());
        let size = if self.after_rejection {
            self.target = best.min(c);
            h.min(self.sizes[self.target])
        } else if best <= c {
            self.target = best;
            self.sizes[best]
        } else {
            // The test considers one more column than was computed, and assumes the same work per
            // unit of time.
            let rising = c < self.target && self.rates[c] < HIGHER_ORDER * self.rates[c - 1];
            self.target = best;
            let ahead = if rising {
                (best + 1).min(COLUMNS)
            } else {
                best
            };
            self.sizes[c] * work(ahead) / work(c)
        };
        self.after_rejection = false;
        self.is_first = false;
        size
    }

    /// Returns the size of the next step after a rejected step.
    pub(super) fn reject(&mut self, h: f64) -> f64 {
        self.after_rejection = true;
        self.is_first = false;
        if self.has_diverged {
            return FACTOR_DIVERGED * h;
        }
        self.target = self.target.min(self.last).clamp(2, COLUMNS - 1);
        if self.target > 2 && self.rates[self.target - 1] < LOWER_ORDER * self.rates[self.target] {
            self.target -= 1;
        }
        self.sizes[self.target]
    }
}
