//! Decides whether a step may end, and stores information about singular configurations during the
//! motion.
//!
//! Near a singular configuration, stages are moved onto the constraint manifold before their
//! evaluation, and steps are chosen such that the configuration is between two stages. A step must
//! not end so close to the configuration that a projection could not distinguish the branches. A
//! step over the configuration is accepted under two conditions. The correction of the step must be
//! small relative to the distance of the branches. The velocities after the step must continue the
//! velocities before the step.

use integrators::Delicate;
use model::System;

use super::exchange::{self, Exchange};
use super::passage::{Now, Passage};
use super::pivots::are_delicate;
use super::search;
use crate::error::MotionFault;
use crate::events::Event;
use crate::guards::GUARDED;
use crate::limits::{
    FALLEN, FORESIGHT, JUST_AHEAD, LEAST_SCALE, NEARBY, NEAREST, NEAREST_MAX, NEAREST_TOLERANCES,
    NO_REACTIONS, NO_REACTIONS_MAX, NO_REACTIONS_TOLERANCES, PASSED, SMOOTH, SUSPECT,
};
use crate::options::{MotionOptions, RowChoice};
use crate::solve::{KeptEquations, KeptRows};

/// Result of the checks at the end of a step.
pub(crate) enum Next {
    /// The step is accepted.
    Accept,
    /// The step is repeated with a smaller length.
    Reject,
    /// The step is accepted with other independent rows.
    Keep(Box<Exchange>),
    /// The step is rejected. If no shorter step is accepted, the run stops with this fault.
    Stop(MotionFault),
}

impl Next {
    /// Returns the exchange of rows that must be carried out if the step is accepted, or the result
    /// that rejects the step.
    pub(crate) fn stands(self) -> Result<Option<Box<Exchange>>, Self> {
        match self {
            Self::Accept => Ok(None),
            Self::Keep(rows) => Ok(Some(rows)),
            Self::Reject | Self::Stop(_) => Err(self),
        }
    }
}

impl From<MotionFault> for Next {
    fn from(fault: MotionFault) -> Self {
        Self::Stop(fault)
    }
}

/// State of the monitors of a motion.
pub(crate) struct Monitors {
    choice: RowChoice,
    pub(crate) passage: Passage,
    /// An event of the last accepted steps that has not been reported.
    pending: Option<Event>,
    rtol: f64,
    t_end: f64,
    /// Whether the last accepted step may have moved through a singular configuration.
    pub(crate) is_suspect: bool,
    /// Expected time of the next singular configuration.
    pub(super) delicate: Option<f64>,
    /// The last time at which a step was rejected because of a redundant row, and the fault.
    contradicted: Option<(f64, MotionFault)>,
}

impl Monitors {
    pub(crate) fn new(choice: &RowChoice, options: &MotionOptions) -> Self {
        Self {
            choice: choice.clone(),
            passage: Passage::default(),
            pending: None,
            rtol: options.rtol,
            t_end: options.t_end,
            is_suspect: false,
            delicate: None,
            contradicted: None,
        }
    }

    /// Returns the relative pivot below which this run treats a pivot as zero. A step must not end
    /// closer than this distance to a singular configuration, unless a break time requires it.
    pub(crate) fn nearest(&self) -> f64 {
        (NEAREST_TOLERANCES * self.rtol).clamp(NEAREST, NEAREST_MAX)
    }

    /// Returns the relative pivot below which reactions are not reported.
    pub(crate) fn blind(&self) -> f64 {
        (NO_REACTIONS_TOLERANCES * self.rtol).clamp(NO_REACTIONS, NO_REACTIONS_MAX)
    }

    /// Returns the expected time of a singular configuration.
    pub(crate) fn delicate_time(&self) -> Option<f64> {
        self.delicate
    }

    /// Returns the expected time of a singular configuration of a mechanism of this size (m), and
    /// the factor by which steps over it may exceed their tolerance.
    pub(crate) fn delicate(&self, size: f64) -> Option<Delicate> {
        self.delicate.map(|t| Delicate {
            t,
            slack: (PASSED / self.rtol).max(1.0),
            least_scale: LEAST_SCALE * self.rtol * size,
        })
    }

    /// Returns whether a step must not end at t, at freshly factored rows. Steps must end at break
    /// times and at the end of the run, at any configuration. A step that suddenly approaches a
    /// singular configuration should end farther away from the configuration.
    pub(crate) fn judge_place(
        &self,
        equations: &KeptEquations<'_>,
        t: f64,
        has_to_end: bool,
    ) -> Next {
        if has_to_end {
            return Next::Accept;
        }
        let pivot = equations.velocity.relative_pivot();
        if pivot < self.nearest() {
            return Next::Stop(self.no_way_over(t));
        }
        // The next step over the singular configuration would start so close to the configuration
        // that its stages are mostly rounding errors.
        let fell = pivot < FALLEN * self.passage.pivot();
        if fell && pivot < NEARBY * self.nearest() {
            Next::Reject
        } else {
            Next::Accept
        }
    }

    /// Decides which rows are independent rows at a settled position. The rows must be factored at
    /// this position.
    pub(crate) fn judge_rows(&self, equations: &mut KeptEquations<'_>, q: &[f64]) -> Next {
        match Exchange::due(equations, &self.choice, q) {
            Ok(Some(exchange)) => Next::Keep(Box::new(exchange)),
            Ok(None) => Next::Accept,
            Err(fault) => Next::Stop(fault),
        }
    }

    /// Returns whether [`Monitors::judge_rows`] must make a decision for freshly factored rows.
    pub(crate) fn may_exchange(&self, equations: &mut KeptEquations<'_>) -> bool {
        exchange::may_be_due(equations, &self.choice)
    }

    /// Returns rows that determine the position of an output row better than the rows of the
    /// surrounding steps.
    pub(crate) fn position_rows_for_output(
        &self,
        equations: &mut KeptEquations<'_>,
        q: &[f64],
    ) -> Result<Option<KeptRows>, MotionFault> {
        exchange::better_position_for_row(equations, q)
    }

    /// Returns rows that are more suitable for an output row than the rows of the surrounding
    /// steps.
    pub(crate) fn rows_for_output(
        &self,
        equations: &mut KeptEquations<'_>,
        q: &[f64],
    ) -> Result<Option<KeptRows>, MotionFault> {
        exchange::better_for_row(equations, &self.choice, q)
    }

    /// Stores an event. The event is reported when the step is accepted.
    pub(crate) fn tell_later(&mut self, event: Option<Event>) {
        self.pending = event.or(self.pending.take());
    }

    /// Records a step to t that was rejected because of a redundant row.
    pub(crate) fn note_refused(&mut self, t: f64, fault: &MotionFault) {
        let is_of_dropped_row = matches!(
            fault,
            MotionFault::DroppedRow { .. } | MotionFault::BeyondTolerance { .. }
        );
        if is_of_dropped_row {
            self.contradicted = Some((t, fault.clone()));
        }
    }

    /// Returns the redundant row that caused the collapse of the step size at time t. The small
    /// steps accepted before a contradiction are valid and do not show the contradiction.
    pub(crate) fn contradiction(&mut self, t: f64) -> Option<MotionFault> {
        let (end, fault) = self.contradicted.take()?;
        (end - t <= JUST_AHEAD * self.t_end).then_some(fault)
    }

    /// Returns whether a step to freshly factored rows may have moved through a singular
    /// configuration.
    pub(crate) fn may_have_passed(
        &self,
        equations: &mut KeptEquations<'_>,
        [t0, t1]: [f64; 2],
    ) -> bool {
        let is_foreseen = self.delicate.is_some_and(|t| t0 < t && t <= t1);
        is_foreseen || GUARDED && self.passage.is_suspect(&mut equations.velocity)
    }

    /// Returns whether the last accepted step ended far from singular configurations.
    pub(crate) fn came_from_afar(&self) -> bool {
        self.passage.pivot() >= SUSPECT
    }

    /// Checks the correction, in the error norm, of a step to t that may have moved through a
    /// singular configuration. The distance to other branches is as large as the distance to the
    /// end of the step.
    pub(crate) fn judge_correction(
        &self,
        equations: &KeptEquations<'_>,
        t: f64,
        correction: f64,
    ) -> Next {
        let distance = equations.velocity.relative_pivot().max(NEAREST);
        if correction * self.rtol > SMOOTH * distance {
            Next::Stop(self.no_way_over(t))
        } else {
            Next::Accept
        }
    }

    /// Checks the velocities and accelerations at the end of a step. After a singular configuration
    /// they must continue the velocities and accelerations before the configuration. If the motion
    /// is still close to the configuration, the check is postponed.
    pub(crate) fn judge_motion(
        &mut self,
        equations: &KeptEquations<'_>,
        now: Now<'_>,
        may_have_passed: bool,
    ) -> Next {
        let mass = equations.at.mechanism.mass();
        let remains_to_be_seen = !GUARDED || are_delicate(&equations.velocity);
        if may_have_passed && !remains_to_be_seen && !self.passage.is_continued_by(now, mass) {
            return Next::Stop(self.no_way_over(now.t));
        }
        if let Some(delicate) = self.came_upon(equations, now) {
            self.delicate = Some(delicate);
            return Next::Reject;
        }
        // A motion that turns close to a singular configuration continues from step to step.
        if remains_to_be_seen && self.passage.is_continued_by(now, mass) {
            self.passage.enter(now);
        }
        self.enter(equations, now);
        Next::Accept
    }

    /// Returns the time of a singular configuration just ahead that was not predicted. The pivots
    /// at this configuration grew up to the last step and have fallen within this step. The step is
    /// repeated with this prediction, so that the step over the singular configuration starts
    /// farther away. At a larger distance, rounding errors do not yet dominate the stages.
    fn came_upon(&self, equations: &KeptEquations<'_>, now: Now<'_>) -> Option<f64> {
        let (before, pivot) = (self.passage.pivot(), equations.velocity.relative_pivot());
        if !GUARDED || self.delicate.is_some() || pivot >= FALLEN * before.min(1.0) {
            return None;
        }
        let step = now.t - self.passage.since();
        search::foresee(equations, now, now.t + pivot / (before - pivot) * step)
    }

    /// Records an accepted state far from singular configurations.
    pub(crate) fn enter(&mut self, equations: &KeptEquations<'_>, now: Now<'_>) {
        if GUARDED && !are_delicate(&equations.velocity) {
            self.passage.enter(now);
        }
    }

    /// Stores the state just evaluated as the end of an accepted step. Returns the event since the
    /// last accepted step.
    pub(crate) fn accept(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        may_have_passed: bool,
    ) -> Option<Event> {
        self.is_suspect = may_have_passed;
        self.passage.take(&mut equations.velocity, t);
        self.pending.take()
    }

    /// Predicts singular configurations from an accepted state. The prediction covers several steps
    /// as long as the last step.
    pub(crate) fn look_ahead(&mut self, equations: &KeptEquations<'_>, now: Now<'_>, step: f64) {
        let t_last = now.t + FORESIGHT * step;
        let known = self.delicate.filter(|&known| known > now.t);
        let expected = self.passage.expected().or(known).filter(|&e| e <= t_last);
        self.delicate = expected.and_then(|expected| search::foresee(equations, now, expected));
    }

    /// Returns the fault for a step to t over a singular configuration that is rejected.
    pub(crate) fn no_way_over(&self, t: f64) -> MotionFault {
        MotionFault::SingularPassage {
            from: self.passage.since(),
            to: t,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row with a motion error equal to the tolerance has a reaction error of tolerance/pivot.
    /// Reported reactions are accurate to three digits if the tolerance is neither loose nor near
    /// the rounding error. Two digits are sufficient to distinguish branches.
    #[test]
    fn pivots_are_compared_with_what_the_tolerance_leaves_of_them() {
        for (rtol, nearest, blind) in [
            (1e-2, 0.1, 1e-2),
            (1e-4, 1e-2, 1e-2),
            (1e-7, 1e-3, 1e-4),
            (1e-15, 1e-3, 1e-6),
        ] {
            let options = MotionOptions {
                rtol,
                ..MotionOptions::to(1.0)
            };
            let watch = Monitors::new(&RowChoice::Automatic, &options);
            let is = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-9;
            assert!(is(watch.nearest(), nearest), "{rtol}");
            assert!(is(watch.blind(), blind), "{rtol}");
        }
    }

    /// A step that was rejected just ahead of the present time is the reason why the run cannot
    /// continue. A step that was rejected farther away is not the reason.
    #[test]
    fn a_contradiction_just_ahead_is_why_a_run_stops() {
        for (ahead, is_why) in [(0.7e-9, true), (1.4e-9, false)] {
            let mut watch = Monitors::new(&RowChoice::Automatic, &MotionOptions::to(10.0));
            let fault = watch.no_way_over(5.0 + 10.0 * ahead);
            watch.contradicted = Some((5.0 + 10.0 * ahead, fault));
            assert_eq!(watch.contradiction(5.0).is_some(), is_why, "{ahead}");
        }
    }
}
