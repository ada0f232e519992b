//! Verdicts of a run: on stretches of time, one component at a time.
//!
//! At constant rank, and between breaks of the functions of time, the coefficients of a component
//! in the left null space are analytic in time. So the component is determined throughout such a
//! stretch or, but for isolated instants, nowhere in it. A run is cut into stretches at its events
//! and at break times. On a stretch the verdict is
//!
//! - unique if it is unique at every instant that was looked at inside,
//! - not unique if it is not unique at one of them,
//! - undecided otherwise.
//!
//! Instants with another verdict are special: they are listed and decide nothing. An instant on a
//! cut belongs to the stretch that begins there, the last instant to the last stretch.

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

/// The verdict on a number over an interval of time.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct VerdictStretch {
    /// Begin (s).
    pub from: f64,
    /// End (s).
    pub to: f64,
    /// The verdict.
    pub verdict: Verdict,
}

/// An instant at which another verdict holds than on its stretch.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SpecialInstant {
    /// Time (s).
    pub time: f64,
    /// The verdict there.
    pub verdict: Verdict,
}

/// The verdicts on one number during a run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct VerdictTrack {
    /// In the order of time, without gaps; neighbours differ in their verdicts.
    stretches: Vec<VerdictStretch>,
    special: Vec<SpecialInstant>,
}

impl VerdictTrack {
    /// One verdict from begin to end.
    #[must_use]
    pub fn constant([from, to]: [f64; 2], verdict: Verdict) -> Self {
        Self {
            stretches: vec![VerdictStretch { from, to, verdict }],
            special: Vec::new(),
        }
    }

    /// These stretches in the order of time, without gaps; neighbours with the same verdict are
    /// joined.
    #[must_use]
    pub fn of(stretches: impl IntoIterator<Item = VerdictStretch>) -> Self {
        Self::new(stretches, Vec::new())
    }

    /// The same, with special instants.
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

    /// The stretches in the order of time, without gaps.
    #[must_use]
    pub fn stretches(&self) -> &[VerdictStretch] {
        &self.stretches
    }

    /// The instants at which another verdict holds than on their stretch, in the order of time.
    #[must_use]
    pub fn special(&self) -> &[SpecialInstant] {
        &self.special
    }

    /// Leaves out all special instants.
    pub(crate) fn forget_special(&mut self) {
        self.special.clear();
    }

    /// Adds another instant that was looked at, if a verdict is decided there and differs from that
    /// of its stretch.
    pub(crate) fn look(&mut self, time: f64, verdict: &Verdict) {
        let place = self.special.partition_point(|s| s.time < time);
        let is_known = self.special.get(place).is_some_and(|s| s.time == time);
        let differs = verdict.is_decided() && verdict.word() != self.at(time).word();
        if differs && !is_known {
            let verdict = verdict.clone();
            self.special.insert(place, SpecialInstant { time, verdict });
        }
    }

    /// The verdict on the stretch that contains the time: of two that meet there, the later one.
    #[must_use]
    pub fn at(&self, t: f64) -> &Verdict {
        let begun = self.stretches.partition_point(|s| s.from <= t);
        &self.stretches[begun.max(1) - 1].verdict
    }

    /// A number of a solution at a time with the verdict on the stretch that contains it.
    #[must_use]
    pub fn value(&self, t: f64, number: f64) -> Value {
        Value::new(number, self.at(t).clone(), None)
    }

    /// The verdict on the run: unique if it is on all stretches, not unique if it is not on one.
    #[must_use]
    pub fn of_run(&self) -> &Verdict {
        worst(self.stretches.iter().map(|s| &s.verdict))
    }

    /// The intervals on which the number is determined.
    #[must_use]
    pub fn determined(&self) -> Vec<[f64; 2]> {
        let unique = self.stretches.iter().filter(|s| s.verdict.is_unique());
        unique.map(|s| [s.from, s.to]).collect()
    }

    /// The verdicts on several numbers together: the worst of theirs at each time.
    ///
    /// # Panics
    /// If there is no number.
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

    /// The verdict at an instant that was looked at.
    fn exactly_at(&self, t: f64) -> &Verdict {
        let special = self.special.iter().find(|s| s.time == t);
        special.map_or_else(|| self.at(t), |s| &s.verdict)
    }
}

/// The worst of verdicts, the first of equals.
pub(crate) fn worst<'v>(verdicts: impl Iterator<Item = &'v Verdict>) -> &'v Verdict {
    let mut worst: Option<&Verdict> = None;
    for verdict in verdicts {
        if worst.is_none_or(|known| verdict.severity() > known.severity()) {
            worst = Some(verdict);
        }
    }
    worst.unwrap_or(&Verdict::Unique)
}

/// The verdicts on a joint or drive during a run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionStretches {
    /// The joint or drive.
    pub id: ConstraintId,
    /// The verdict on all its components together.
    pub whole: VerdictTrack,
    /// The verdicts on its components that are not identically zero, and on the named component of
    /// its definition, with their names.
    pub components: Vec<(&'static str, VerdictTrack)>,
}

impl ReactionStretches {
    /// The verdicts on a component, by its name; `None` for one that is zero under any load.
    #[must_use]
    pub fn component(&self, name: &str) -> Option<&VerdictTrack> {
        let mut own = self.components.iter();
        own.find(|(known, _)| *known == name)
            .map(|(_, track)| track)
    }

    /// A component of a solution at a time with the verdict on the stretch that contains it. One
    /// that is zero under any load is unique.
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

/// The verdicts on a group during a run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GroupStretches {
    /// The verdict on the whole group.
    pub whole: VerdictTrack,
    /// The verdicts on its numbers, with their names: `sum`, or the components of a wrench.
    pub numbers: Vec<(&'static str, VerdictTrack)>,
}

/// The verdicts of a run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stretches {
    /// Begin and end of the run (s).
    pub extent: [f64; 2],
    /// Joints and drives in the order of their rows.
    pub reactions: Vec<ReactionStretches>,
    /// Groups in the order in which they were asked for.
    pub groups: Vec<GroupStretches>,
}
