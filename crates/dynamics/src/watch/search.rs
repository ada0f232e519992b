//! Searches the dense output of an accepted step for singular configurations. The result is the
//! time and the number of dependent rows of each singular configuration.

use model::System;
use solvability::along::search::{minimum, root};
use solvability::decide_rows;

use super::passage::Now;
use crate::events::{Event, EventKind};
use crate::limits::{BEYOND, GLANCES, PLACES, RISES, SHARP, STAYS, STEEPER, VANISHES};
use crate::solve::{Evaluation, KeptEquations, KeptRows};

/// A singular configuration within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Singular {
    /// Time (s).
    pub(crate) t: f64,
    /// Number of independent rows that are dependent at the singular configuration. In a reported
    /// event, it is the loss of rank.
    pub(crate) dependent: usize,
}

/// Returns the largest change between neighbouring values.
fn steepest(pivots: &[f64]) -> f64 {
    let changes = pivots.windows(2).map(|w| (w[1] - w[0]).abs());
    changes.fold(0.0, f64::max)
}

/// Returns the time at which a motion from the last accepted state `now` will be singular, if its
/// pivots vanish near the expected time.
pub(super) fn foresee(equations: &KeptEquations<'_>, now: Now<'_>, expected: f64) -> Option<f64> {
    let noise = VANISHES * equations.velocity.relative_pivot();
    let mut way = vec![0.0; now.v.len()];
    let mut state = |time: f64, out: &mut [f64]| {
        let dt = time - now.t;
        for ((way, v), a) in way.iter_mut().zip(now.v).zip(now.a) {
            *way = dt * (v + 0.5 * dt * a);
        }
        out.copy_from_slice(now.q);
        equations.at.mechanism.displace(out, &way);
    };
    let interval = [now.t, now.t + BEYOND * (expected - now.t)];
    let mut search = SingularitySearch::new(equations);
    if search.is_promising(interval, &mut state) {
        search.find(interval, noise, state).map(|found| found.t)
    } else {
        None
    }
}

/// Searches for singular configurations of the independent rows.
pub(crate) struct SingularitySearch<'m> {
    at: Evaluation<'m>,
    rows: KeptRows,
}

impl<'m> SingularitySearch<'m> {
    /// Creates a search with the current rows, with separate storage for intermediate results.
    pub(crate) fn new(equations: &KeptEquations<'m>) -> Self {
        Self {
            at: equations.at.clone(),
            rows: equations.velocity.clone(),
        }
    }

    /// Returns whether the pivots fall, or the bordered determinant has changed its sign, at one of
    /// a few times. Each time costs a factorisation, until the result is true. Returns `true` in
    /// case of doubt.
    fn is_promising(
        &mut self,
        [now, end]: [f64; 2],
        mut state: impl FnMut(f64, &mut [f64]),
    ) -> bool {
        let mut q = vec![0.0; self.at.mechanism.layout().n_q];
        let Some(first) = self.pivot_at(now, &mut q, &mut state) else {
            return true;
        };
        let mut frame = Vec::new();
        self.rows.null_frame(&mut frame);
        let sign = self.rows.orientation(&frame);
        (1..=GLANCES).any(|k| {
            let t = now + (end - now) * (k as f64 / GLANCES as f64);
            let pivot = self.pivot_at(t, &mut q, &mut state);
            pivot.is_none_or(|pivot| pivot < STAYS * first)
                || self.rows.orientation(&frame) * sign < 0.0
        })
    }

    /// Returns the smallest pivot at a time, relative to the reference.
    fn pivot_at(
        &mut self,
        t: f64,
        q: &mut [f64],
        state: &mut impl FnMut(f64, &mut [f64]),
    ) -> Option<f64> {
        state(t, q);
        self.at.pose(t, q);
        let factored = self.rows.factor_above(0.0, &self.at);
        factored.ok().map(|()| self.rows.relative_pivot())
    }

    /// Returns the singular configuration between t0 and t1, if there is one. The configuration is
    /// at a change of sign of the bordered determinant, or at a minimum of the smallest relative
    /// pivot below `noise`. `state` must return the coordinates at a time.
    pub(crate) fn find(
        &mut self,
        [t0, t1]: [f64; 2],
        noise: f64,
        mut state: impl FnMut(f64, &mut [f64]),
    ) -> Option<Singular> {
        let mut q = vec![0.0; self.at.mechanism.layout().n_q];
        let mut at = |t: f64, search: &mut Self| search.pivot_at(t, &mut q, &mut state);
        let time = |k: usize| t0 + (t1 - t0) * (k as f64 / PLACES as f64);
        let mut frame = Vec::new();
        let (mut pivots, mut signs) = ([0.0; PLACES + 1], [0.0; PLACES + 1]);
        for k in 0..=PLACES {
            pivots[k] = at(time(k), self)?;
            if k == 0 {
                self.rows.null_frame(&mut frame);
            }
            signs[k] = self.rows.orientation(&frame);
        }
        let flip = signs.windows(2).position(|w| w[0] * w[1] < 0.0);
        let t = match flip {
            // The pivot multiplied by the sign of the determinant crosses zero nearly linearly.
            Some(k) => {
                let ends = [pivots[k], -pivots[k + 1]];
                let signed = |t: f64| {
                    let pivot = at(t, self).ok_or(())?;
                    Ok::<f64, ()>(pivot * self.rows.orientation(&frame) * signs[k])
                };
                root([time(k), time(k + 1)], ends, 0.0, signed).ok()?
            }
            None => {
                let k = (1..PLACES).min_by(|&a, &b| pivots[a].total_cmp(&pivots[b]))?;
                if pivots[k] - STEEPER * steepest(&pivots) > noise {
                    return None;
                }
                let interval = [time(k - 1), time(k + 1)];
                let enough = SHARP * (interval[1] - interval[0]);
                let least = minimum(interval, noise, enough, |t| at(t, self).ok_or(()));
                let (t, pivot) = least.ok()??;
                // A pivot has no minimum if it falls up to an end of the searched interval without
                // rising again.
                if pivot > RISES * pivots[k - 1].min(pivots[k + 1]) {
                    return None;
                }
                t
            }
        };
        let pivot = at(t, self)?;
        if flip.is_none() && pivot > noise {
            return None;
        }
        let share = noise.max(2.0 * pivot);
        self.rows.factor_above(share, &self.at).ok()?;
        Some(Singular {
            t,
            dependent: self.rows.n_left_out().max(1),
        })
    }

    /// Returns the loss of rank of all rows at a configuration at which the independent rows lose
    /// rank. The loss may be smaller than that of the independent rows, because other rows may
    /// replace the independent rows that become dependent. In case of doubt, both losses count as
    /// equal.
    pub(crate) fn rank_lost(
        &mut self,
        Singular { t, dependent }: Singular,
        mut state: impl FnMut(f64, &mut [f64]),
    ) -> usize {
        if self.rows.dropped.is_empty() {
            return dependent;
        }
        let mut q = vec![0.0; self.at.mechanism.layout().n_q];
        state(t, &mut q);
        self.at.pose_and_phi(t, &q);
        match decide_rows(self.at.mechanism, &self.at.s, &q) {
            Ok(decision) if decision.is_decided() => {
                self.rows.kept.len().saturating_sub(decision.rank)
            }
            _ => dependent,
        }
    }

    /// Returns the event that reports the configuration. `uniqueness` states whether the motion is
    /// unique at this configuration.
    pub(crate) fn event(&self, singular: Singular, uniqueness: &str) -> Event {
        let redundancy = self.rows.dropped.len();
        let Singular { t, dependent } = singular;
        let (rows, verb) = match dependent {
            1 => ("row", "depends"),
            _ => ("rows", "depend"),
        };
        Event {
            time: t,
            kind: EventKind::SingularPassage,
            redundancy_before: redundancy,
            redundancy_after: redundancy + dependent,
            dropped: self.rows.dropped.clone(),
            text: format!(
                "passed a singular configuration, where {dependent} more {rows} {verb} on the others for an instant: {uniqueness}. \
                 The run continued smoothly."
            ),
            impulses: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pivot falls to zero like a square root between two instants. Near zero its change is
    /// steeper than its changes between instants show. The factor is 1/(√3 − 1) if the pivot
    /// vanishes in the middle.
    #[test]
    fn a_pivot_that_vanishes_as_a_root_is_searched_for() {
        for middle in 0..=10 {
            let zero = 0.5 * PLACES as f64 + 0.1 * f64::from(middle);
            let pivots = (0..=PLACES).map(|k| (k as f64 - zero).abs().sqrt());
            let pivots: Vec<f64> = pivots.collect();
            let least = pivots.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(least <= STEEPER * steepest(&pivots), "{zero}: {pivots:?}");
        }
    }

    /// A pivot that changes by a sixth of its smallest value between instants does not become zero.
    #[test]
    fn a_pivot_that_hardly_changes_is_not_searched_for() {
        let pivots = [4.0, 3.5, 3.0, 3.5, 4.0].map(|x: f64| x / 3.0);
        assert!(1.0 - STEEPER * steepest(&pivots) > 0.5);
    }
}
