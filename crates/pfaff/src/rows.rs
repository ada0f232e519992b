//! Consumers of the rows of a run: one value for each file or array.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::documents::Ending;
use dynamics::{Failure, MotionError, MotionFault, Plan, Sample, Stop, Summary};
use report::TableError;
use solvability::Stretches;

use crate::error::StudyError;

/// Receives the output rows of a run during the run, and the verdicts at the end. Until the run
/// ends, the values of nonunique reactions belong to one of the possible solutions.
pub trait RowSink {
    /// Receives a row. A quantity of the sample is computed at the first access.
    ///
    /// # Errors
    /// [`RowFault`]: the row cannot be computed or written. The run then ends.
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault>;

    /// Receives the verdicts of the run, for any kind of ending. The verdicts are `None` if no
    /// reactions were requested.
    ///
    /// # Errors
    /// [`StudyError::File`], [`StudyError::Table`]: the final contents cannot be written.
    fn end(&mut self, verdicts: Option<&Stretches>, ending: &Ending<'_>) -> Result<(), StudyError> {
        let _ = (verdicts, ending);
        Ok(())
    }
}

/// Reason why a row cannot be processed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RowFault {
    /// The row cannot be computed.
    #[error(transparent)]
    Motion(#[from] MotionFault),
    /// The row cannot be written.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// A sink that calls a function.
pub(crate) struct Calling<F>(pub(crate) F);

impl<F> RowSink for Calling<F>
where
    F: FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault>,
{
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        (self.0)(sample)
    }
}

/// A run that has ended.
pub(crate) struct RunEnd {
    pub(crate) summary: Summary,
    /// Reason why the run stopped before its end.
    pub(crate) error: Option<MotionError>,
    interrupted: bool,
    /// Reason why a row could not be written.
    pub(crate) unwritten: Option<TableError>,
}

impl RunEnd {
    /// Returns how the run ended. A run is partial if its rows could not be written.
    pub(crate) fn ending(&self) -> Ending<'_> {
        match (&self.error, self.interrupted || self.unwritten.is_some()) {
            (Some(error), _) => Ending::Stopped(error),
            (None, true) => Ending::Interrupted,
            (None, false) => Ending::Complete,
        }
    }
}

/// Runs a plan and passes the rows to sinks. `watch` is called with the time of each row and may
/// end the run. If no rows are requested, `watch` is called with the time of each step. `stop` is
/// called at each evaluation and may also end the run.
///
/// # Errors
/// - [`StudyError::Motion`]: the run could not begin.
/// - [`StudyError::Interrupted`]: the run was ended before the first row.
pub(crate) fn run_into(
    plan: &Plan<'_>,
    (watch, stop): (&(dyn Fn(f64) -> ControlFlow<()> + Sync), &Stop<'_>),
    each: &mut dyn FnMut(f64) -> ControlFlow<()>,
    sinks: &mut [&mut dyn RowSink],
) -> Result<RunEnd, StudyError> {
    let interrupted = AtomicBool::new(false);
    let note = |flow: ControlFlow<()>| {
        interrupted.fetch_or(flow.is_break(), Ordering::Relaxed);
        flow
    };
    let asked = || {
        let is_asked = stop();
        interrupted.fetch_or(is_asked, Ordering::Relaxed);
        is_asked
    };
    let mut unwritten = None;
    let mut rows = 0_usize;
    let outcome = plan.simulate_watched(&|t| note(watch(t)), &asked, |sample| {
        rows += 1;
        for sink in sinks.iter_mut() {
            match sink.row(sample) {
                Ok(flow) if note(flow).is_break() => return Ok(flow),
                Ok(_) => {}
                Err(RowFault::Motion(fault)) => return Err(fault),
                Err(RowFault::Table(error)) => {
                    unwritten = Some(error);
                    return Ok(ControlFlow::Break(()));
                }
            }
        }
        Ok(note(each(sample.t)))
    });
    let (summary, error) = match outcome {
        // If there is no row, files of an earlier run are not replaced.
        Ok(_) if rows == 0 => return Err(StudyError::Interrupted),
        Err(failure) if rows == 0 => return Err(failure.error.into()),
        Ok(summary) => (summary, None),
        Err(failure) => {
            let Failure { summary, error, .. } = *failure;
            (summary, Some(error))
        }
    };
    Ok(RunEnd {
        summary,
        error,
        interrupted: interrupted.into_inner(),
        unwritten,
    })
}
