//! The spread of two choices of rows: within a stated tolerance the motion depends on which rows
//! are kept, by about as much as the dropped ones miss.

use std::ops::ControlFlow;

use dynamics::plan::Reactions;
use dynamics::{MotionError, Plan, Prepared, Sample, Stop, Summary, Wanted};
use report::documents::SpreadDocument;

/// Configurations of a run at its rows of output.
#[derive(Default)]
pub(crate) struct Path(Vec<Vec<f64>>);

impl Path {
    /// Takes a row, if rows of this run may miss.
    pub(crate) fn take(&mut self, prepared: &Prepared, sample: &Sample<'_, '_>) {
        if prepared.may_miss {
            self.0.push(sample.q.to_vec());
        }
    }

    /// Compares these rows with those of a run on other rows: the run is repeated with each row
    /// that has missed kept instead of the one that takes the largest part in its dependency.
    /// Returns `None` if no row has missed, or no other rows can be dropped.
    pub(crate) fn spread(
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
        other: &Prepared,
        spread: &mut SpreadDocument,
        stop: &Stop<'_>,
    ) -> Result<(), MotionError> {
        let wanted = Wanted {
            rows: plan.rows.value,
            accelerations: false,
            reactions: Reactions::None,
        };
        let other_plan = Plan::new(other, plan.options(), &wanted)?;
        let space = other.mechanism.space();
        let mut rows = self.0.iter();
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
