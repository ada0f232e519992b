//! Verdicts of a simulation by time interval (stretch), separately for each component.
//!
//! At constant rank, and between breaks of the functions of time, the coefficients of a component
//! in the left null space are analytic in time. A component is therefore determined either
//! throughout such an interval or only at isolated instants in it. The time of a simulation is
//! divided into intervals at its events and at break times. On an interval the verdict is
//!
//! - unique if the component is unique at every examined instant inside,
//! - not unique if the component is not unique at one of these instants,
//! - undecided otherwise.
//!
//! Instants with a different verdict are special. These instants are listed, but do not affect the
//! verdict on the interval. An instant between two intervals belongs to the later interval, and the
//! last instant belongs to the last interval.

mod all;
mod carried;
mod recorder;
#[cfg(test)]
mod tests;

use model::ConstraintId;

use crate::value::Value;
use crate::verdict::Verdict;

pub use carried::{CarriedState, CarriedVerdicts};
pub use recorder::{InstantOrder, VerdictRecorder};

/// The verdict on a number over a time interval.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct VerdictStretch {
    /// Start time (s).
    pub from: f64,
    /// End time (s).
    pub to: f64,
    /// The verdict.
    pub verdict: Verdict,
}

/// An instant at which the verdict differs from that of its interval.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SpecialInstant {
    /// Time (s).
    pub time: f64,
    /// The verdict at this instant.
    pub verdict: Verdict,
}

/// The verdicts on one number during a simulation.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct VerdictTrack {
    /// Intervals in chronological order, without gaps. Neighbouring intervals have different
    /// verdicts.
    stretches: Vec<VerdictStretch>,
    special: Vec<SpecialInstant>,
}

impl VerdictTrack {
    /// Creates a track with one verdict from start to end.
    #[must_use]
    pub fn constant([from, to]: [f64; 2], verdict: Verdict) -> Self {
        Self {
            stretches: vec![VerdictStretch { from, to, verdict }],
            special: Vec::new(),
        }
    }

    /// Creates a track from these intervals in chronological order, without gaps. Neighbouring
    /// intervals with the same verdict are merged.
    #[must_use]
    pub fn of(stretches: impl IntoIterator<Item = VerdictStretch>) -> Self {
        Self::new(stretches, Vec::new())
    }

    /// Creates a track with special instants.
    pub(crate) fn new(
        stretches: impl IntoIterator<Item = VerdictStretch>,
        special: Vec<SpecialInstant>,
    ) -> Self {
        let mut joined: Vec<VerdictStretch> = Vec::new();
        for stretch in stretches {
            match joined.last_mut() {
                Some(last) if last.verdict == stretch.verdict => last.to = stretch.to,
                _ => joined.push(stretch),
            }
        }
        Self {
            stretches: joined,
            special,
        }
    }

    /// Returns the intervals in chronological order, without gaps.
    #[must_use]
    pub fn stretches(&self) -> &[VerdictStretch] {
        &self.stretches
    }

    /// Returns the instants at which the verdict differs from that of their interval, in
    /// chronological order.
    #[must_use]
    pub fn special(&self) -> &[SpecialInstant] {
        &self.special
    }

    /// Removes all special instants.
    pub(crate) fn forget_special(&mut self) {
        self.special.clear();
    }

    /// Adds another examined instant if its verdict is decided and differs from the verdict of its
    /// interval.
    pub(crate) fn look(&mut self, time: f64, verdict: &Verdict) {
        let place = self.special.partition_point(|s| s.time < time);
        let is_known = self.special.get(place).is_some_and(|s| s.time == time);
        let differs = verdict.is_decided() && verdict.word() != self.at(time).word();
        if differs && !is_known {
            let verdict = verdict.clone();
            self.special.insert(place, SpecialInstant { time, verdict });
        }
    }

    /// Returns the verdict on the interval that contains the time. If two intervals meet at this
    /// time, the later interval counts.
    #[must_use]
    pub fn at(&self, t: f64) -> &Verdict {
        let begun = self.stretches.partition_point(|s| s.from <= t);
        &self.stretches[begun.max(1) - 1].verdict
    }

    /// Returns a number of a solution at a time. The number has the verdict on the interval that
    /// contains the time.
    #[must_use]
    pub fn value(&self, t: f64, number: f64) -> Value {
        Value::new(number, self.at(t).clone(), None)
    }

    /// Returns the verdict on the simulation. The verdict is unique if the number is unique on all
    /// intervals, and not unique if the number is not unique on one interval.
    #[must_use]
    pub fn of_run(&self) -> &Verdict {
        worst(self.stretches.iter().map(|s| &s.verdict))
    }

    /// Returns the intervals on which the number is determined.
    #[must_use]
    pub fn determined(&self) -> Vec<[f64; 2]> {
        let unique = self.stretches.iter().filter(|s| s.verdict.is_unique());
        unique.map(|s| [s.from, s.to]).collect()
    }

    /// Returns the verdict on several numbers together. At each time, it is the worst of their
    /// verdicts.
    ///
    /// # Panics
    /// Panics if the list is empty.
    #[must_use]
    pub fn together(tracks: &[&Self]) -> Self {
        let mut ends: Vec<f64> = tracks
            .iter()
            .flat_map(|track| track.stretches.iter().flat_map(|s| [s.from, s.to]))
            .collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        if ends.len() == 1 {
            ends.push(ends[0]);
        }
        let on = |ends: &[f64]| VerdictStretch {
            from: ends[0],
            to: ends[1],
            verdict: worst(tracks.iter().map(|track| track.at(ends[0]))).clone(),
        };
        let joined = Self::new(ends.windows(2).map(on), Vec::new());
        let special = Self::special_together(tracks, &joined);
        Self { special, ..joined }
    }

    fn special_together(tracks: &[&Self], joined: &Self) -> Vec<SpecialInstant> {
        let mut times: Vec<f64> = tracks
            .iter()
            .flat_map(|track| track.special.iter().map(|s| s.time))
            .collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let there = |t: f64| {
            let of = |track: &&'_ Self| -> Verdict { track.exactly_at(t).clone() };
            let all: Vec<Verdict> = tracks.iter().map(of).collect();
            worst(all.iter()).clone()
        };
        times
            .into_iter()
            .map(|time| SpecialInstant {
                time,
                verdict: there(time),
            })
            .filter(|s| s.verdict.word() != joined.at(s.time).word())
            .collect()
    }

    /// Returns the verdict at an examined instant.
    fn exactly_at(&self, t: f64) -> &Verdict {
        let special = self.special.iter().find(|s| s.time == t);
        special.map_or_else(|| self.at(t), |s| &s.verdict)
    }
}

/// Returns the worst of the verdicts. If several verdicts are equally bad, the first verdict is
/// returned.
pub(crate) fn worst<'v>(verdicts: impl Iterator<Item = &'v Verdict>) -> &'v Verdict {
    let mut worst: Option<&Verdict> = None;
    for verdict in verdicts {
        if worst.is_none_or(|known| verdict.severity() > known.severity()) {
            worst = Some(verdict);
        }
    }
    worst.unwrap_or(&Verdict::Unique)
}

/// The verdicts on the reaction of a joint or drive, as functions of time during a simulation.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionStretches {
    /// The joint or drive.
    pub id: ConstraintId,
    /// The verdict on all components together.
    pub whole: VerdictTrack,
    /// The verdicts on the components that are not identically zero, and on the named component of
    /// the definition, with their names.
    pub components: Vec<(&'static str, VerdictTrack)>,
}

impl ReactionStretches {
    /// Returns the verdicts on the component with this name, or `None` for a component that is zero
    /// under any load.
    #[must_use]
    pub fn component(&self, name: &str) -> Option<&VerdictTrack> {
        let mut own = self.components.iter();
        own.find(|(known, _)| *known == name)
            .map(|(_, track)| track)
    }

    /// Returns a component of a solution at a time, with the verdict on the interval that contains
    /// the time. A component that is zero under any load is unique.
    ///
    /// ```
    /// use pfaff_solvability::{ReactionStretches, Verdict, VerdictTrack};
    /// let track = VerdictTrack::constant([0.0, 2.0], Verdict::NotUnique);
    /// let hinge = ReactionStretches {
    ///     id: model::ConstraintId(0),
    ///     whole: track.clone(),
    ///     components: vec![("Fx", track)],
    /// };
    /// assert_eq!(hinge.value("Fx", 1.0, 3.5).determined(), None);
    /// assert_eq!(hinge.value("T", 1.0, 0.0).determined(), Some(0.0));
    /// ```
    #[must_use]
    pub fn value(&self, component: &str, t: f64, number: f64) -> Value {
        let track = self.component(component);
        track.map_or_else(|| Value::unique(number), |track| track.value(t, number))
    }
}

/// The verdicts on a group during a simulation.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GroupStretches {
    /// The verdict on the whole group.
    pub whole: VerdictTrack,
    /// The verdicts on the numbers of the group, with their names: `sum`, or the components of a
    /// wrench.
    pub numbers: Vec<(&'static str, VerdictTrack)>,
}

/// The verdicts of a simulation.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stretches {
    /// Start and end of the simulation (s).
    pub extent: [f64; 2],
    /// Joints and drives in the order of their rows.
    pub reactions: Vec<ReactionStretches>,
    /// Groups in the order of the request.
    pub groups: Vec<GroupStretches>,
}
