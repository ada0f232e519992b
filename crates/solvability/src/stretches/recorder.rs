//! Collects the verdicts on numbers at instants of a simulation, and divides the simulation into
//! intervals.

use std::collections::VecDeque;
use std::ops::Range;

use super::{SpecialInstant, VerdictStretch, VerdictTrack, worst};
use crate::verdict::Verdict;

/// Position of an instant in the simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstantOrder {
    /// The next instant in chronological order.
    Next,
    /// A later instant. Of several later instants, it is the next one in chronological order.
    /// Earlier instants may follow.
    Ahead,
}

/// The verdicts at an instant, one for each number. A verdict is `None` if the instant gives no
/// verdict on its interval.
pub(super) type Verdicts = Vec<Option<Verdict>>;

/// The verdicts on some numbers at instants of a simulation.
#[derive(Clone, Debug)]
pub struct VerdictRecorder {
    times: Vec<f64>,
    numbers: Vec<VerdictHistory>,
    cuts: Vec<f64>,
    /// Later instants, stored until all earlier instants are known.
    ahead: VecDeque<(f64, Verdicts)>,
}

/// The verdicts on one number, each with the first instant at which it occurred again.
#[derive(Clone, Debug, Default)]
struct VerdictHistory {
    changes: Vec<(usize, Option<Verdict>)>,
}

impl VerdictRecorder {
    /// Creates a recorder for this number of numbers.
    #[must_use]
    pub fn new(numbers: usize) -> Self {
        Self {
            times: Vec::new(),
            numbers: vec![VerdictHistory::default(); numbers],
            cuts: Vec::new(),
            ahead: VecDeque::new(),
        }
    }

    /// Adds the verdicts at an instant, one for each number. A verdict is `None` if the instant
    /// gives no verdict on its interval. If two instants have the same time, the first instant
    /// counts.
    pub fn see(&mut self, t: f64, looked: InstantOrder, verdicts: Vec<Option<Verdict>>) {
        match looked {
            InstantOrder::Ahead => self.ahead.push_back((t, verdicts)),
            InstantOrder::Next => {
                self.catch_up(t);
                self.take(t, verdicts);
            }
        }
    }

    /// Starts another interval at this time.
    pub fn cut(&mut self, t: f64) {
        self.cuts.push(t);
    }

    /// Returns the verdict on a number at the last examined instant.
    pub(super) fn latest(&self, number: usize) -> Option<&Verdict> {
        match self.ahead.back() {
            Some((_, verdicts)) => verdicts[number].as_ref(),
            None => self.numbers[number].changes.last()?.1.as_ref(),
        }
    }

    /// Returns the number of recorded numbers.
    pub(super) fn numbers(&self) -> usize {
        self.numbers.len()
    }

    /// Returns whether no instant after this time has been examined.
    #[must_use]
    pub fn is_blank_since(&self, t: f64) -> bool {
        let is_before = |seen: &f64| *seen <= t;
        self.times.last().is_none_or(is_before)
            && self.ahead.iter().all(|(ahead, _)| is_before(ahead))
    }

    /// Adds the stored later instants up to this time.
    fn catch_up(&mut self, t: f64) {
        while let Some((ahead, verdicts)) = self.ahead.pop_front_if(|(ahead, _)| *ahead <= t) {
            self.take(ahead, verdicts);
        }
    }

    fn take(&mut self, t: f64, verdicts: Verdicts) {
        if self.times.last().is_some_and(|last| *last >= t) {
            return;
        }
        let index = self.times.len();
        self.times.push(t);
        for (seen, verdict) in self.numbers.iter_mut().zip(verdicts) {
            if seen.changes.last().is_none_or(|(_, last)| *last != verdict) {
                seen.changes.push((index, verdict));
            }
        }
    }

    /// Returns the verdicts on each number from start to end.
    #[must_use]
    pub fn finish(mut self, [from, to]: [f64; 2]) -> Vec<VerdictTrack> {
        self.catch_up(f64::INFINITY);
        let inside = |t: &f64| from < *t && *t < to;
        self.cuts.retain(inside);
        self.cuts.sort_by(f64::total_cmp);
        self.cuts.dedup();
        let ends: Vec<f64> = std::iter::once(from)
            .chain(self.cuts.iter().copied())
            .chain([to])
            .collect();
        let times = &self.times;
        // Instants that belong to each interval, and the instants inside the interval.
        let last = ends.len() - 2;
        let pieces: Vec<RecordedStretch> = (0..=last)
            .map(|k| {
                let [begin, end] = [ends[k], ends[k + 1]];
                let first = times.partition_point(|t| *t < begin);
                let own = if k == last {
                    times.len()
                } else {
                    times.partition_point(|t| *t < end)
                };
                let inner = times.partition_point(|t| *t <= begin);
                let inner_end = times.partition_point(|t| *t < end);
                RecordedStretch {
                    ends: [begin, end],
                    own: first..own.max(first),
                    inside: inner..inner_end.max(inner),
                }
            })
            .collect();
        let numbers = self.numbers.iter();
        numbers.map(|seen| seen.track(times, &pieces)).collect()
    }
}

/// A time interval with its instants.
struct RecordedStretch {
    ends: [f64; 2],
    /// All instants that belong to the interval.
    own: Range<usize>,
    /// The instants between the ends of the interval.
    inside: Range<usize>,
}

impl VerdictHistory {
    /// Returns the verdict at an instant.
    fn at(&self, index: usize) -> Option<&Verdict> {
        let begun = self.changes.partition_point(|(k, _)| *k <= index);
        self.changes[begun.checked_sub(1)?].1.as_ref()
    }

    /// Returns the verdicts at a range of instants, one for each change.
    fn over(&self, range: &Range<usize>) -> impl Iterator<Item = &Verdict> {
        let begun = self.changes.partition_point(|(k, _)| *k <= range.start);
        let ended = self.changes.partition_point(|(k, _)| *k < range.end);
        let changes = self.changes.get(begun.saturating_sub(1)..ended);
        let changes = changes.filter(|_| !range.is_empty());
        let changes = changes.unwrap_or_default().iter();
        changes.filter_map(|(_, verdict)| verdict.as_ref())
    }

    fn track(&self, times: &[f64], pieces: &[RecordedStretch]) -> VerdictTrack {
        let mut special = Vec::new();
        let mut stretches = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let verdict = self.verdict(piece);
            let differs = |v: &Verdict| v.word() != verdict.word();
            if verdict.is_decided() && self.over(&piece.own).any(differs) {
                let seen = piece.own.clone().filter_map(|k| Some((k, self.at(k)?)));
                special.extend(seen.filter(|(_, v)| differs(v)).map(|(k, verdict)| {
                    SpecialInstant {
                        time: times[k],
                        verdict: verdict.clone(),
                    }
                }));
            }
            let [from, to] = piece.ends;
            stretches.push(VerdictStretch { from, to, verdict });
        }
        VerdictTrack::new(stretches, special)
    }

    /// Returns the verdict on an interval. The result is the verdict on the inside of the interval.
    /// A simulation of one instant has the verdict of this instant.
    fn verdict(&self, piece: &RecordedStretch) -> Verdict {
        let [from, to] = piece.ends;
        let range = if from == to {
            &piece.own
        } else {
            &piece.inside
        };
        let mut seen = self.over(range).peekable();
        if seen.peek().is_none() {
            let reason =
                format!("no state was analysed between the events at {from:.6e} s and {to:.6e} s");
            return Verdict::Undecided { reason };
        }
        worst(seen).clone()
    }
}
