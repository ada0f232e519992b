//! Exchange of independent rows that have become ill-conditioned although the rank stays the same.
//! Rows are exchanged only at accepted and corrected states, and the motion does not change.

use model::System;
use model::words::listed;
use solvability::{RowDecision, decide_holonomic_rows, decide_rows, rows_of_rank};

use super::pivots::{are_lost, are_recovered, are_sound, position_wants_exchange, want_exchange};
use crate::error::MotionFault;
use crate::events::{Event, EventKind};
use crate::guards::GUARDED;
use crate::limits::WORTH_EXCHANGE;
use crate::options::RowChoice;
use crate::solve::{Evaluation, KeptEquations, KeptRows};

/// Independent rows to be used from an accepted state on.
pub(crate) struct Exchange {
    position: Option<KeptRows>,
    velocity: Option<Velocity>,
}

enum Velocity {
    /// The rows requested by the user, which are well-conditioned again.
    Requested,
    /// Rows other than the current rows. The flag states whether the user requested the current
    /// rows.
    Others(Box<KeptRows>, bool),
}

impl Exchange {
    /// Checks the pivots at a settled position with coordinates q. The rows must be factored at
    /// this position.
    pub(super) fn due(
        equations: &mut KeptEquations<'_>,
        choice: &RowChoice,
        q: &[f64],
    ) -> Result<Option<Self>, MotionFault> {
        if equations.have_missed() {
            return Self::due_within_tolerance(equations, q);
        }
        let mut position = None;
        let mut decided = None;
        if position_wants_exchange(equations) {
            let (at, old) = (&equations.at, &mut equations.position);
            let decision = decide_holonomic_rows(at.mechanism, &at.s, q);
            // Without nonholonomic rows, both levels have the same rows.
            decided = decision
                .clone()
                .ok()
                .filter(|_| at.mechanism.layout().h == 0);
            position = better(at, decision, old)?;
        }
        let velocity = if requested_rows_recovered(equations) {
            Some(Velocity::Requested)
        } else if want_exchange(equations, choice) {
            let (at, old) = (&equations.at, &mut equations.velocity);
            let decision = match decided {
                Some(decided) => Ok(decided),
                None => decide_rows(at.mechanism, &at.s, q),
            };
            let rows = better(at, decision, old)?;
            let were_asked_for = matches!(choice, RowChoice::Drop(_));
            rows.map(|rows| Velocity::Others(Box::new(rows), were_asked_for))
        } else {
            None
        };
        let is_due = position.is_some() || velocity.is_some();
        Ok(is_due.then_some(Self { position, velocity }))
    }

    /// Returns the decision if redundant rows are violated within a stated tolerance. An exchange
    /// moves the mechanism by about this violation. Therefore rows are exchanged only if they have
    /// become ill-conditioned. Without nonholonomic rows both levels have the same independent
    /// rows.
    fn due_within_tolerance(
        equations: &mut KeptEquations<'_>,
        q: &[f64],
    ) -> Result<Option<Self>, MotionFault> {
        if !are_lost(&equations.velocity) {
            return Ok(None);
        }
        let KeptEquations {
            at,
            velocity,
            position,
            ..
        } = equations;
        let layout = at.mechanism.layout();
        let of_rank =
            |count: usize, rank: usize| rows_of_rank(at.mechanism, &at.s, q, (count, rank), None);
        let found = of_rank(layout.rows(), velocity.kept.len());
        let Some(rows) = better(at, found, velocity)? else {
            return Ok(None);
        };
        let position = better(at, of_rank(layout.m, position.kept.len()), position)?;
        Ok(Some(Self {
            position,
            velocity: Some(Velocity::Others(Box::new(rows), false)),
        }))
    }

    /// Uses the new rows. Returns the event, and whether the rows of the position constraints have
    /// changed. If these rows have changed, the caller must project the coordinates onto the
    /// position constraints again.
    pub(crate) fn keep(
        self,
        equations: &mut KeptEquations<'_>,
    ) -> Result<(bool, Option<Event>), MotionFault> {
        let moves = self.position.is_some();
        if let Some(rows) = self.position {
            equations.position = rows;
        }
        let why = match self.velocity {
            None => return Ok((moves, None)),
            Some(Velocity::Requested) => {
                equations.swap_requested_rows();
                equations.requested_rows = None;
                equations.velocity.factor(&equations.at)?;
                "the requested rows are independent again and are kept again"
            }
            Some(Velocity::Others(rows, were_asked_for)) => {
                let lost = std::mem::replace(&mut equations.velocity, *rows);
                if were_asked_for && equations.requested_rows.is_none() {
                    equations.requested_rows = Some(lost);
                }
                "the kept rows became nearly dependent"
            }
        };
        let dropped = &equations.velocity.dropped;
        let labels = &equations.at.mechanism.layout().labels;
        let numbers: Vec<_> = dropped
            .iter()
            .map(|&i| labels[i].number.to_string())
            .collect();
        let consequence = if equations.have_missed() {
            "These rows are redundant within the stated tolerance: the mechanism moves by their former constraint violation."
        } else {
            "The motion is the same."
        };
        if let Some(misfits) = &mut equations.misfits {
            misfits.interrupt();
        }
        let text = format!("{why}; now dropped: {}. {consequence}", listed(&numbers));
        let time = equations.at.s.t;
        let event = Event::at(time, EventKind::RowsExchanged, dropped, text);
        Ok((moves, Some(event)))
    }
}

/// Returns whether [`Exchange::due`] must make a decision for freshly factored rows.
pub(super) fn may_be_due(equations: &mut KeptEquations<'_>, choice: &RowChoice) -> bool {
    equations.requested_rows.is_some()
        || position_wants_exchange(equations)
        || want_exchange(equations, choice)
}

/// Returns rows whose coefficients in the redundant rows are smaller than those of the current
/// independent rows, at a settled output row. Between two steps, the mechanism may reach
/// configurations for which the current rows are not suitable.
pub(super) fn better_for_row(
    equations: &mut KeptEquations<'_>,
    choice: &RowChoice,
    q: &[f64],
) -> Result<Option<KeptRows>, MotionFault> {
    if suit_output(equations) || !want_exchange(equations, choice) {
        return Ok(None);
    }
    let (at, old) = (&equations.at, &mut equations.velocity);
    better(at, decide_rows(at.mechanism, &at.s, q), old)
}

/// Works like [`better_for_row`], for the rows that determine the position.
pub(super) fn better_position_for_row(
    equations: &mut KeptEquations<'_>,
    q: &[f64],
) -> Result<Option<KeptRows>, MotionFault> {
    if suit_output(equations) || !position_wants_exchange(equations) {
        return Ok(None);
    }
    let (at, old) = (&equations.at, &mut equations.position);
    better(at, decide_holonomic_rows(at.mechanism, &at.s, q), old)
}

/// Returns whether an output row uses the current independent rows without a search for other rows.
fn suit_output(equations: &KeptEquations<'_>) -> bool {
    !GUARDED || equations.have_missed() || are_sound(&equations.velocity)
}

fn requested_rows_recovered(equations: &mut KeptEquations<'_>) -> bool {
    let requested = equations.requested_rows.as_mut();
    requested.is_some_and(|rows| rows.factor(&equations.at).is_ok() && are_recovered(rows))
}

/// Returns freshly factored independent rows of a new decision, if they have the same rank as the
/// old rows and smaller coefficients in the redundant rows. A different rank belongs to a singular
/// configuration nearby, not to the motion.
fn better<E: std::fmt::Display>(
    at: &Evaluation<'_>,
    decision: Result<RowDecision, E>,
    old: &mut KeptRows,
) -> Result<Option<KeptRows>, MotionFault> {
    let decision = decision.map_err(|e| MotionFault::NoRows {
        time: at.s.t,
        what: e.to_string(),
    })?;
    if !decision.is_decided() || decision.rank != old.kept.len() {
        return Ok(None);
    }
    old.unavoidable = old.largest_coefficient(at);
    if decision.kept == old.kept {
        return Ok(None);
    }
    let mut rows = old.others(at, &decision)?;
    rows.factor(at)?;
    rows.compare_as(old);
    let largest = rows.largest_coefficient(at);
    Ok((WORTH_EXCHANGE * largest < old.unavoidable).then_some(rows))
}
