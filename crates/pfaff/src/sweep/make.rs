//! Runs made on one thread, one after another or together, each handed over as soon as it is
//! finished. Whoever makes several at once makes them here.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use dynamics::{SceneCode, Stop};
use report::{OutputDirectory, SweepRow, TrajectoryTable};

use super::lanes::together;
use super::run::{Begun, Ended};
use super::{Sweep, SweepError};

/// Largest number of runs that are begun together.
pub(super) const TOGETHER: usize = 32;

/// What is kept of runs besides their rows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Keep<'d> {
    /// Nothing.
    Rows,
    /// The trajectories, in this directory.
    Trajectories(&'d Path),
}

impl Sweep<'_> {
    /// Makes these runs (from 1, ascending, at most [`TOGETHER`]) on this thread, and hands each
    /// row over. What a row has does not depend on the others. Runs that are interrupted have no
    /// row.
    pub(super) fn make(
        &self,
        runs: &[u64],
        keep: Keep<'_>,
        interrupted: &Stop<'_>,
        sink: &mut dyn FnMut(SweepRow) -> Result<(), SweepError>,
    ) -> Result<(), SweepError> {
        let mut begun = Vec::with_capacity(runs.len());
        for &run in runs {
            if interrupted() {
                return Ok(());
            }
            #[cfg(test)]
            super::tests::begins(run);
            match self.begin(run) {
                Ok(own) => begun.push(self.job(run, own, keep)?),
                Err(error) => sink(self.refused(run, &error))?,
            }
        }
        together(begun, interrupted, &mut |run, ended| match ended? {
            Some(ended) => sink(self.row_of(run, ended)),
            None => Ok(()),
        })
    }

    /// A run with what it writes.
    fn job(&self, run: u64, begun: Begun, keep: Keep<'_>) -> Result<Job, SweepError> {
        let folder = match keep {
            Keep::Rows => None,
            Keep::Trajectories(directory) => {
                let folder = folder(directory, run, self.runs());
                // Another process may make the same run.
                Some(OutputDirectory::create(folder)?.with_own_parts())
            }
        };
        Ok(Job { run, begun, folder })
    }
}

/// A run that has begun, with what it writes.
pub(super) struct Job {
    pub(super) run: u64,
    pub(super) begun: Begun,
    /// Where its trajectory goes.
    folder: Option<OutputDirectory>,
}

impl Job {
    /// Moves it to its end and stores its trajectory; `None` if `stop` has ended it: it is made
    /// again then. `evaluator` evaluates its code, if there are several runs at once.
    pub(super) fn go(
        mut self,
        evaluator: Option<&dyn SceneCode>,
        stop: &Stop<'_>,
    ) -> Result<Option<Ended>, SweepError> {
        let ended = self.attempt(evaluator, stop)?;
        if ended.as_ref().is_some_and(Ended::has_lost_its_way) {
            // The interpreter passes some places from where it comes, and not from where code
            // leaves it.
            self.begun.leave_code();
            return self.attempt(None, stop);
        }
        Ok(ended)
    }

    fn attempt(
        &self,
        evaluator: Option<&dyn SceneCode>,
        stop: &Stop<'_>,
    ) -> Result<Option<Ended>, SweepError> {
        if stop() {
            return Ok(None);
        }
        let mechanism = &self.begun.study.prepared.mechanism;
        let mut table = match &self.folder {
            Some(folder) => {
                let file = folder.file("trajectory.csv")?;
                Some(TrajectoryTable::new(file, mechanism)?)
            }
            None => None,
        };
        let mut unwritten = None;
        let ended = self.begun.go(evaluator, stop, |sample| {
            if let Some(table) = &mut table {
                unwritten = table.row(sample.t, sample.q, sample.v).err();
            }
            if unwritten.is_some() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        if let Some(error) = unwritten {
            return Err(error.into());
        }
        // The run may have ended just before the request.
        if stop() {
            return Ok(None);
        }
        if let Some(table) = table {
            // The trajectory is stored on disk before the journal records the run.
            let mut file = table.finish()?;
            file.sync()?;
            file.finish()?;
        }
        Ok(Some(ended))
    }
}

/// Directory of the files of a run; its number has as many digits as that of the last run.
fn folder(directory: &Path, run: u64, runs: u64) -> PathBuf {
    let width = runs.to_string().len();
    directory.join("runs").join(format!("{run:0width$}"))
}
