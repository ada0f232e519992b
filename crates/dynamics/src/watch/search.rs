//! Searches the dense output of an accepted step for singular configurations. The result is the
//! time and the number of dependent rows of each singular configuration.

use model::System;
use solvability::along::search::{corner, root};
use solvability::decide_rows;

use super::passage::Now;
use crate::events::{Event, EventKind};
use crate::limits::{BEYOND, GLANCES, IMPLIED, PLACES, RISES, SHARP, STAYS, STEEPER, VANISHES};
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

/// A singular configuration, and whether the pivots fall again before it and after it within the
/// searched interval.
pub(crate) struct SearchResult {
    pub(crate) singular: Singular,
    pub(crate) falls_again: [bool; 2],
}

/// The smallest pivots and the signs of the bordered determinant at equidistant times.
struct Samples {
    times: Vec<f64>,
    pivots: Vec<f64>,
    signs: Vec<f64>,
}

impl Samples {
    fn flips(&self, k: usize) -> bool {
        self.signs[k] * self.signs[k + 1] < 0.0
    }

    /// Returns whether the pivots fall again before and after a minimum that is between two of the
    /// samples. On both sides of a single singular configuration they rise.
    fn fall_again(&self, [before, after]: [usize; 2]) -> [bool; 2] {
        let rises = |k: usize| self.pivots[k] < self.pivots[k + 1] && !self.flips(k);
        let falls = |k: usize| self.pivots[k] > self.pivots[k + 1] && !self.flips(k);
        [
            !(0..before).all(falls),
            !(after..self.times.len() - 1).all(rises),
        ]
    }
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
        search
            .find(interval, noise, state)
            .map(|found| found.singular.t)
    } else {
        None
    }
}

/// Searches for singular configurations of the independent rows.
pub(crate) struct SingularitySearch<'m> {
    at: Evaluation<'m>,
    rows: KeptRows,
    /// A basis of the motions at the first sample, with which the determinant is bordered.
    frame: Vec<f64>,
    /// The coordinates at a time.
    q: Vec<f64>,
}

impl<'m> SingularitySearch<'m> {
    /// Creates a search with the current rows, with separate storage for intermediate results.
    pub(crate) fn new(equations: &KeptEquations<'m>) -> Self {
        Self {
            at: equations.at.clone(),
            rows: equations.velocity.clone(),
            frame: Vec::new(),
            q: vec![0.0; equations.at.mechanism.layout().n_q],
        }
    }

    /// Returns whether the pivots fall, or the bordered determinant has changed its sign, at one of
    /// a few instants. C is factorised at each instant up to the first at which this is true.
    /// Returns `true` in case of doubt.
    fn is_promising(
        &mut self,
        [now, end]: [f64; 2],
        mut state: impl FnMut(f64, &mut [f64]),
    ) -> bool {
        let Some(first) = self.pivot_at(now, &mut state) else {
            return true;
        };
        self.rows.null_frame(&mut self.frame);
        let sign = self.rows.orientation(&self.frame);
        (1..=GLANCES).any(|k| {
            let t = now + (end - now) * (k as f64 / GLANCES as f64);
            let pivot = self.pivot_at(t, &mut state);
            pivot.is_none_or(|pivot| pivot < STAYS * first)
                || self.rows.orientation(&self.frame) * sign < 0.0
        })
    }

    /// Returns the smallest pivot at a time, relative to the reference.
    fn pivot_at(&mut self, t: f64, state: &mut impl FnMut(f64, &mut [f64])) -> Option<f64> {
        state(t, &mut self.q);
        self.at.pose(t, &self.q);
        let factored = self.rows.factor_above(0.0, &self.at);
        factored.ok().map(|()| self.rows.relative_pivot())
    }

    /// Evaluates the rows at the ends of equal intervals between t0 and t1. Each time costs a
    /// factorisation. `state` must return the coordinates at a time.
    fn samples(
        &mut self,
        [t0, t1]: [f64; 2],
        intervals: usize,
        state: &mut impl FnMut(f64, &mut [f64]),
    ) -> Option<Samples> {
        let time = |k: usize| t0 + (t1 - t0) * (k as f64 / intervals as f64);
        let mut samples = Samples {
            times: (0..=intervals).map(time).collect(),
            pivots: Vec::with_capacity(intervals + 1),
            signs: Vec::with_capacity(intervals + 1),
        };
        for k in 0..=intervals {
            samples.pivots.push(self.pivot_at(samples.times[k], state)?);
            if k == 0 {
                self.rows.null_frame(&mut self.frame);
            }
            samples.signs.push(self.rows.orientation(&self.frame));
        }
        Some(samples)
    }

    /// Returns the singular configuration between t0 and t1, if there is one.
    pub(crate) fn find(
        &mut self,
        interval: [f64; 2],
        noise: f64,
        mut state: impl FnMut(f64, &mut [f64]),
    ) -> Option<SearchResult> {
        let samples = self.samples(interval, PLACES, &mut state)?;
        self.locate(&samples, noise, state)
    }

    /// Returns the singular configuration between the samples, if there is one. The configuration
    /// is at a change of sign of the bordered determinant, or at a minimum of the smallest relative
    /// pivot below `noise`.
    fn locate(
        &mut self,
        samples: &Samples,
        noise: f64,
        mut state: impl FnMut(f64, &mut [f64]),
    ) -> Option<SearchResult> {
        let Samples {
            times,
            pivots,
            signs,
        } = samples;
        let last = times.len() - 1;
        let flip = (0..last).find(|&k| samples.flips(k));
        let (t, ends) = match flip {
            // The pivot multiplied by the sign of the determinant crosses zero nearly linearly.
            Some(k) => {
                let ends = [pivots[k], -pivots[k + 1]];
                let signed = |t: f64| {
                    let pivot = self.pivot_at(t, &mut state).ok_or(())?;
                    Ok::<f64, ()>(pivot * self.rows.orientation(&self.frame) * signs[k])
                };
                let t = root([times[k], times[k + 1]], ends, 0.0, signed).ok()?;
                (t, [k, k + 1])
            }
            None => {
                let k = (1..last).min_by(|&a, &b| pivots[a].total_cmp(&pivots[b]))?;
                if pivots[k] - STEEPER * steepest(pivots) > noise {
                    return None;
                }
                let mut ends = [k - 1, k, k + 1].map(|k| (times[k], pivots[k]));
                let enough = SHARP * (ends[2].0 - ends[0].0);
                let mut pivot_at = |t| self.pivot_at(t, &mut state).ok_or(());
                // If the pivot falls up to an end, a minimum is only possible if it rises just
                // before this end.
                let [first, middle, last] = ends;
                let beside = if first.1 < middle.1 && first.1 < last.1 {
                    Some(first.0 + enough)
                } else if last.1 < middle.1 {
                    Some(last.0 - enough)
                } else {
                    None
                };
                if let Some(t) = beside {
                    ends[1] = (t, pivot_at(t).ok()?);
                    if ends[1].1 >= first.1.min(last.1) {
                        return None;
                    }
                }
                let (t, pivot) = corner(ends, noise, enough, pivot_at).ok()??;
                // A pivot has no minimum if it falls up to an end of the searched interval without
                // rising again.
                if pivot > RISES * pivots[k - 1].min(pivots[k + 1]) {
                    return None;
                }
                (t, [k - 1, k + 1])
            }
        };
        let pivot = self.pivot_at(t, &mut state)?;
        if flip.is_none() && pivot > noise {
            return None;
        }
        let share = noise.max(2.0 * pivot);
        self.rows.factor_above(share, &self.at).ok()?;
        Some(SearchResult {
            singular: Singular {
                t,
                dependent: self.rows.n_left_out().max(1),
            },
            falls_again: samples.fall_again(ends),
        })
    }

    /// Returns the loss of rank of all rows at a configuration that was just found. If the
    /// independent rows that are still used imply the redundant rows, the loss is that of the
    /// independent rows. Otherwise redundant rows may replace independent rows, and the rank is
    /// decided. In case of doubt, both losses count as equal.
    pub(crate) fn rank_lost(
        &mut self,
        Singular { t, dependent }: Singular,
        mut state: impl FnMut(f64, &mut [f64]),
    ) -> usize {
        if self.rows.imply_dropped(&self.at, IMPLIED) {
            return dependent;
        }
        state(t, &mut self.q);
        self.at.pose_and_phi(t, &self.q);
        match decide_rows(self.at.mechanism, &self.at.s, &self.q) {
            Ok(decision) if decision.is_decided() => {
                self.rows.kept.len().saturating_sub(decision.rank)
            }
            _ => dependent,
        }
    }

    /// Returns the event that reports the configuration. `uniqueness` states whether the motion is
    /// unique at this configuration, if this is requested.
    pub(crate) fn event(&self, singular: Singular, uniqueness: Option<&str>) -> Event {
        let redundancy = self.rows.dropped.len();
        let Singular { t, dependent } = singular;
        let (rows, verb) = match dependent {
            1 => ("row", "depends"),
            _ => ("rows", "depend"),
        };
        let uniqueness = uniqueness.map_or_else(String::new, |words| format!(": {words}"));
        Event {
            time: t,
            kind: EventKind::SingularPassage,
            redundancy_before: redundancy,
            redundancy_after: redundancy + dependent,
            dropped: self.rows.dropped.clone(),
            text: format!(
                "passed a singular configuration, where {dependent} more {rows} {verb} on the others for an instant{uniqueness}. \
                 The run continued smoothly."
            ),
            impulses: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use joints::{Line, PointOnLine};
    use model::{Body, Description, Mechanism, StartOptions};

    use super::*;
    use crate::options::{Method, RowChoice};
    use crate::{PreparedMechanism, prepare};

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

    /// A beam on rollers at 0, ε and x, and a guide above it. The row at ε is left out. The last
    /// row replaces it if its roller is far from the others.
    #[test]
    fn a_row_that_replaces_another_is_no_loss() {
        let prepared = |rollers: [f64; 3]| {
            let mut d = Description::new("beam");
            let beam = d.body(Body::new("beam", 1.0, 1.0));
            let guide = Line::new([0.0; 2], [0.0, 1.0]).expect("a line");
            let above = PointOnLine {
                s: [0.0, 1.0],
                line: guide,
            };
            d.joint("guide", &[beam], above);
            let line = Line::new([0.0; 2], [1.0, 0.0]).expect("a line");
            for (name, x) in ["left", "middle", "right"].into_iter().zip(rollers) {
                d.joint(name, &[beam], PointOnLine { s: [x, 0.0], line });
            }
            let mechanism = Mechanism::build(&d).expect("builds");
            let choice = RowChoice::Drop(vec![3]);
            prepare(mechanism, &StartOptions::default(), &choice).expect("starts")
        };
        let rows = |p: &PreparedMechanism, left_out: Option<&KeptRows>| {
            let mut at = Evaluation::new(&p.mechanism, p.assembly.size);
            let mut rows =
                KeptRows::new(&at, &p.decision, p.solver_needs(Method::Auto)).expect("three rows");
            at.pose(0.0, &p.q);
            if let Some(others) = left_out {
                rows.compare_as(others);
                rows.factor_above(0.1, &at).expect("two rows");
                assert_eq!(rows.n_left_out(), 1);
            } else {
                rows.factor(&at).expect("three rows");
            }
            let is_implied = rows.imply_dropped(&at, IMPLIED);
            (rows, is_implied)
        };
        let (apart, is_implied) = rows(&prepared([0.0, 0.5, 1.0]), None);
        assert!(is_implied);
        for (last, expected) in [(1.0, false), (0.1, false), (2e-3, true)] {
            let (_, is_implied) = rows(&prepared([0.0, 1e-3, last]), Some(&apart));
            assert_eq!(is_implied, expected, "{last}");
        }
    }
}
