//! The difference between the motions for two choices of rows. Within a stated tolerance, the
//! motion depends on the choice of independent rows. The difference has about the size of the
//! violations of the redundant rows.

use std::ops::ControlFlow;

use crate::documents::Ending;
use crate::documents::SpreadDocument;
use dynamics::plan::Reactions;
use dynamics::{MotionError, OutputRequest, Plan, PreparedMechanism, Sample, Stop, Summary};

use crate::rows::{RowFault, RowSink, RunEnd};

/// Configurations of a run at its output rows. They are recorded if redundant rows may be violated.
pub(crate) struct Path {
    may_miss: bool,
    rows: Vec<Vec<f64>>,
}

impl RowSink for Path {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        if self.may_miss {
            self.rows.push(sample.q.to_vec());
        }
        Ok(ControlFlow::Continue(()))
    }
}

impl Path {
    pub(crate) fn new(prepared: &PreparedMechanism) -> Self {
        Self {
            may_miss: prepared.may_miss,
            rows: Vec::new(),
        }
    }

    /// Computes the difference for a run that has reached its end.
    pub(crate) fn spread_of(
        &self,
        plan: &Plan<'_>,
        ended: &RunEnd,
        stop: &Stop<'_>,
    ) -> Option<SpreadDocument> {
        match ended.ending() {
            Ending::Complete => self.spread(plan, &ended.summary, stop),
            _ => None,
        }
    }

    /// Compares these configurations with the configurations of a run on other rows. The second run
    /// keeps each violated row. In its place, it deletes the row with the largest coefficient in
    /// the same dependency. Returns `None` if no row is violated, or if no other rows can be
    /// deleted.
    fn spread(
        &self,
        plan: &Plan<'_>,
        summary: &Summary,
        stop: &Stop<'_>,
    ) -> Option<SpreadDocument> {
        let prepared = plan.prepared();
        if summary.misfits.is_empty() {
            return None;
        }
        let dropped = prepared.other_rows(&summary.misfits).ok()??;
        let other = match prepared.dropping(&dropped) {
            Ok(other) => other?,
            Err(error) => return Some(SpreadDocument::stopped(&dropped, &error)),
        };
        let mut spread = SpreadDocument::new(&dropped);
        match self.compare(plan, &other, &mut spread, stop) {
            Ok(()) => {}
            Err(error) => spread.error = Some(error.to_string()),
        }
        Some(spread)
    }

    fn compare(
        &self,
        plan: &Plan<'_>,
        other: &PreparedMechanism,
        spread: &mut SpreadDocument,
        stop: &Stop<'_>,
    ) -> Result<(), MotionError> {
        let wanted = OutputRequest {
            rows: plan.rows.value,
            accelerations: false,
            reactions: Reactions::None,
            uniqueness: false,
            ..OutputRequest::default()
        };
        let other_plan = Plan::new(other, plan.options(), &wanted)?;
        let space = other.mechanism.space();
        let mut rows = self.rows.iter();
        let outcome = other_plan.simulate_watched(&|_| ControlFlow::Continue(()), stop, |sample| {
            let Some(q) = rows.next() else {
                return Ok(ControlFlow::Break(()));
            };
            spread.take(sample.t, &other.mechanism.difference_of(sample.q, q), space);
            Ok(ControlFlow::Continue(()))
        });
        outcome.map(drop).map_err(|failure| failure.error)
    }
}
