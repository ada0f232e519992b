//! Exchange of kept rows that have become nearly dependent, at accepted and polished points only.

use model::System;
use solvability::{RowDecision, decide_holonomic_rows, decide_rows};

use super::{KeptRowMotion, KeptRows};
use crate::error::MotionFault;
use crate::events::{Event, EventKind};
use crate::guards::GUARDED;
use crate::options::RowChoice;

/// Rows of output are looked at below this share of the reference pivots only: what kept rows
/// multiply rounding by is small above it.
const SOUND: f64 = 0.5;

/// Other rows are worth an exchange if their coefficients are so many times smaller.
const WORTH_EXCHANGE: f64 = 3.0;

impl KeptRowMotion<'_> {
    /// Whether [`KeptRowMotion::review`] has something to decide at freshly factored rows.
    pub(super) fn wants_review(&mut self) -> bool {
        self.aside.is_some() || self.position_wants_exchange() || self.want_exchange()
    }

    /// The same for the rows that hold the position, which nobody chooses. Projections that had
    /// nothing to do have not factored them here.
    fn position_wants_exchange(&mut self) -> bool {
        let Self {
            mechanism,
            s,
            position,
            ..
        } = self;
        !position.dropped.is_empty()
            && position.factor(mechanism, s).is_ok()
            && (position.are_lost() || position.are_poor(mechanism, s))
    }

    /// Whether other kept rows should be looked for. Rows that the user chose stay as long as they
    /// can.
    fn want_exchange(&mut self) -> bool {
        let may_choose = self.choice == RowChoice::Automatic;
        self.velocity.are_lost() || may_choose && self.velocity.are_poor(self.mechanism, &self.s)
    }

    /// Looks at the pivots of a settled position at coordinates q.
    pub(super) fn review(&mut self, q: &[f64]) -> Result<Option<Event>, MotionFault> {
        if self.position_wants_exchange() {
            let decision = decide_holonomic_rows(self.mechanism, &self.s, q);
            let mut old = self.position.clone();
            if let Some(better) = self.better(decision, &mut old)? {
                self.position = better;
                self.is_unsettled = true;
            }
        }
        if self.aside.is_some() && self.chosen_rows_recovered() {
            self.swap_aside();
            self.aside = None;
            self.velocity.factor(self.mechanism, &self.s)?;
            return Ok(Some(
                self.event("the rows asked for are independent again and kept again"),
            ));
        }
        if !self.want_exchange() {
            return Ok(None);
        }
        let decision = decide_rows(self.mechanism, &self.s, q);
        let mut lost = self.velocity.clone();
        let Some(rows) = self.better(decision, &mut lost)? else {
            return Ok(None);
        };
        self.velocity = rows;
        if let (RowChoice::Drop(_), None) = (&self.choice, &self.aside) {
            self.aside = Some(lost);
        }
        Ok(Some(self.event("the kept rows became nearly dependent")))
    }

    /// Rows that imply the others better than the kept ones do at a settled row of output: between
    /// two steps that keep rows which suit both, the mechanism may pass where they do not.
    pub(super) fn better_for_row(&mut self, q: &[f64]) -> Result<Option<KeptRows>, MotionFault> {
        let is_sound = !GUARDED || self.velocity.relative_pivot() >= SOUND;
        if self.chart.is_some() || is_sound || !self.want_exchange() {
            return Ok(None);
        }
        let decision = decide_rows(self.mechanism, &self.s, q);
        let mut kept = self.velocity.clone();
        self.better(decision, &mut kept)
    }

    /// Exchanges the kept rows and the ones set aside, if there are any.
    pub(super) fn swap_aside(&mut self) {
        if let Some(aside) = &mut self.aside {
            std::mem::swap(aside, &mut self.velocity);
        }
    }

    fn chosen_rows_recovered(&mut self) -> bool {
        let Some(aside) = &mut self.aside else {
            return false;
        };
        aside.factor(self.mechanism, &self.s).is_ok() && aside.are_recovered()
    }

    /// Freshly factored kept rows of a new decision, if they have the rank of the old ones and
    /// imply the dropped ones by smaller coefficients. Another rank is that of a singular
    /// configuration nearby, not of the motion.
    fn better(
        &self,
        decision: Result<RowDecision, solvability::AnalysisError>,
        old: &mut KeptRows,
    ) -> Result<Option<KeptRows>, MotionFault> {
        let time = self.s.t;
        let decision = decision.map_err(|e| MotionFault::NoRows {
            time,
            what: e.to_string(),
        })?;
        if !decision.is_decided() || decision.rank != old.kept.len() || decision.kept == old.kept {
            return Ok(None);
        }
        let (kept, dropped) = (&decision.kept, &decision.dropped);
        let mut rows = KeptRows::new(self.mechanism, self.size, kept, dropped)
            .map_err(|source| MotionFault::Saddle { time, source })?;
        rows.factor(self.mechanism, &self.s)?;
        rows.compare_as(old);
        let [new, old] = [&mut rows, old].map(|r| r.largest_coefficient(self.mechanism, &self.s));
        Ok((WORTH_EXCHANGE * new < old).then_some(rows))
    }

    fn event(&self, why: &str) -> Event {
        let dropped: Vec<String> = self
            .velocity
            .dropped
            .iter()
            .map(|&i| self.mechanism.layout().labels[i].number.to_string())
            .collect();
        let redundancy = dropped.len();
        Event {
            time: self.s.t,
            kind: EventKind::RowsExchanged,
            redundancy_before: redundancy,
            redundancy_after: redundancy,
            dropped: self.velocity.dropped.clone(),
            text: format!(
                "{why}; now dropped: {}. The motion is the same.",
                dropped.join(", ")
            ),
        }
    }
}
