//! The interval of integration, its break times, and the one-sided evaluation of f at the break
//! times.
//!
//! The code calls the interval between two neighbouring break times a *leg*. A step never crosses
//! the end of a leg, but ends exactly at this end. f is evaluated only at times within the leg. At
//! a break time, the neighbouring floating-point number replaces the time. Therefore f has its left
//! limit in the previous leg and its right limit in the next leg. This applies to any form of the
//! condition `if t < …` in the problem.

use crate::error::IntegrationError;
use std::error::Error;

/// The interval of integration: from `t0` to `t_end`, forwards or backwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval<'a> {
    /// Start.
    pub t0: f64,
    /// End; it may be smaller than `t0`.
    pub t_end: f64,
    /// Times at which f or one of its derivatives with respect to t jumps, in any order. A step
    /// ends exactly at each of these times. Times outside the interval are ignored; `t0` and
    /// `t_end` may be included.
    pub break_times: &'a [f64],
}

impl Interval<'static> {
    /// Returns the interval without break times.
    #[must_use]
    pub fn new(t0: f64, t_end: f64) -> Self {
        Self {
            t0,
            t_end,
            break_times: &[],
        }
    }
}

/// A smooth part of the interval, which is the part between two neighbouring break times. `inside`
/// are the first and last times at which f may be evaluated, in the direction of integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Leg {
    pub(crate) start: f64,
    pub(crate) end: f64,
    inside: (f64, f64),
}

impl Leg {
    /// Returns `t`, or the nearest time within the leg.
    #[inline]
    pub(crate) fn evaluation_time(&self, t: f64) -> f64 {
        let (a, b) = self.inside;
        t.clamp(a.min(b), a.max(b))
    }
}

impl Interval<'_> {
    /// Returns +1 for integration forwards, or −1 for integration backwards.
    pub(crate) fn direction(&self) -> f64 {
        if self.t_end < self.t0 { -1.0 } else { 1.0 }
    }

    /// Checks the times and divides the interval at its break times, in the direction of
    /// integration. The list of parts is empty if t0 = t_end.
    pub(crate) fn legs<E: Error + 'static>(&self) -> Result<Vec<Leg>, IntegrationError<E>> {
        let invalid = |name, value| Err(IntegrationError::InvalidTime { name, value });
        if !self.t0.is_finite() {
            return invalid("t0", self.t0);
        }
        if !(self.t_end - self.t0).is_finite() {
            return invalid("t_end", self.t_end);
        }
        if let Some(&t) = self.break_times.iter().find(|t| t.is_nan()) {
            return invalid("break time", t);
        }
        if self.t0 == self.t_end {
            return Ok(Vec::new());
        }
        let sign = self.direction();
        let mut borders: Vec<f64> = self
            .break_times
            .iter()
            .copied()
            .filter(|&t| (t - self.t0) * sign > 0.0 && (self.t_end - t) * sign > 0.0)
            .chain([self.t0, self.t_end])
            .collect();
        borders.sort_by(|a, b| (a * sign).total_cmp(&(b * sign)));
        borders.dedup();
        Ok(borders.windows(2).map(|w| self.leg(w[0], w[1])).collect())
    }

    fn leg(&self, start: f64, end: f64) -> Leg {
        let sign = self.direction();
        let towards = |t: f64, ahead: bool| {
            let is_end = t == self.t0 || t == self.t_end;
            if is_end && !self.break_times.contains(&t) {
                t
            } else if ahead == (sign > 0.0) {
                t.next_up()
            } else {
                t.next_down()
            }
        };
        let inside = (towards(start, true), towards(end, false));
        // There is no number between neighbouring floating-point numbers. Therefore two such break
        // times have no time between them.
        let inside = if (inside.1 - inside.0) * sign >= 0.0 {
            inside
        } else {
            (start, end)
        };
        Leg { start, end, inside }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn legs(t0: f64, t_end: f64, break_times: &[f64]) -> Vec<Leg> {
        let interval = Interval {
            t0,
            t_end,
            break_times,
        };
        interval.legs::<Infallible>().expect("times are finite")
    }

    #[test]
    fn breaks_are_sorted_deduplicated_and_cut_to_the_interval() {
        let ends: Vec<f64> = legs(0.0, 3.0, &[2.0, -1.0, 1.0, 2.0, 3.0, 9.0])
            .iter()
            .map(|l| l.end)
            .collect();
        assert_eq!(ends, [1.0, 2.0, 3.0]);
        let ends: Vec<f64> = legs(3.0, 0.0, &[1.0, 2.0]).iter().map(|l| l.end).collect();
        assert_eq!(ends, [2.0, 1.0, 0.0]);
        assert!(legs(1.0, 1.0, &[1.0]).is_empty());
    }

    #[test]
    fn f_is_never_evaluated_at_a_break_time() {
        let l = legs(0.0, 2.0, &[1.0]);
        assert_eq!(l[0].evaluation_time(1.0), 1.0_f64.next_down());
        assert_eq!(l[1].evaluation_time(1.0), 1.0_f64.next_up());
        assert_eq!(l[0].evaluation_time(0.0), 0.0);
        assert_eq!(l[1].evaluation_time(2.0), 2.0);
        let back = legs(2.0, 0.0, &[1.0]);
        assert_eq!(back[0].evaluation_time(1.0), 1.0_f64.next_up());
        assert_eq!(back[1].evaluation_time(1.0), 1.0_f64.next_down());
    }

    #[test]
    fn neighbouring_break_times_keep_their_own_times() {
        let next = 1.0_f64.next_up();
        let l = legs(0.0, 2.0, &[1.0, next]);
        assert_eq!(
            (l[1].evaluation_time(1.0), l[1].evaluation_time(next)),
            (1.0, next)
        );
    }
}
