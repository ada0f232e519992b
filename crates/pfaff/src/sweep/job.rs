//! One run with what it writes: moved to its end, again without code if it has lost its way.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use dynamics::{SceneCode, Stop};
use report::{OutputDirectory, TrajectoryTable};

use super::SweepError;
use super::run::{MadeRun, PreparedRun};

/// What is kept of runs besides their rows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Keep<'d> {
    /// Nothing.
    Rows,
    /// The trajectories, in this directory.
    Trajectories(&'d Path),
}

/// A run that has begun, with what it writes.
pub(super) struct Job {
    pub(super) run: u64,
    pub(super) begun: PreparedRun,
    /// Where its trajectory goes.
    folder: Option<OutputDirectory>,
}

impl Job {
    /// A run of so many with what it writes.
    pub(super) fn new(
        run: u64,
        begun: PreparedRun,
        keep: Keep<'_>,
        runs: u64,
    ) -> Result<Self, SweepError> {
        let folder = match keep {
            Keep::Rows => None,
            Keep::Trajectories(directory) => {
                let folder = folder(directory, run, runs);
                // Another process may make the same run.
                Some(OutputDirectory::create(folder)?.with_own_parts())
            }
        };
        Ok(Self { run, begun, folder })
    }

    /// Moves it to its end and stores its trajectory; `None` if `stop` has ended it: it is made
    /// again then. `evaluator` evaluates its code, if there are several runs at once.
    pub(super) fn go(
        mut self,
        evaluator: Option<&dyn SceneCode>,
        stop: &Stop<'_>,
    ) -> Result<Option<MadeRun>, SweepError> {
        let ended = self.attempt(evaluator, stop)?;
        if ended.as_ref().is_some_and(MadeRun::has_lost_its_way) {
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
    ) -> Result<Option<MadeRun>, SweepError> {
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
