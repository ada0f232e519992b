//! One run with its output. If the run stopped after it had left generated code, the run is
//! repeated without generated code.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use dynamics::{SceneCode, Stop};
use report::{OutputDirectory, Trajectory, TrajectoryTable};

use super::SweepError;
use super::run::{MadeRun, PreparedRun};
use crate::study::more_columns;
use crate::tables_of_run::acceleration;
use crate::tables_of_run::table_units;

/// Output of runs in addition to their rows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Keep<'d> {
    /// No further output.
    Rows,
    /// The trajectories, written to this directory.
    Trajectories(&'d Path),
}

/// A run that has begun, with its output.
pub(super) struct Job {
    pub(super) run: u64,
    pub(super) begun: PreparedRun,
    /// Directory of the trajectory.
    folder: Option<OutputDirectory>,
}

impl Job {
    /// Creates a run with its output. `runs` is the number of all runs.
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
                // Another process may perform the same run.
                Some(OutputDirectory::create(folder)?.with_own_parts())
            }
        };
        Ok(Self { run, begun, folder })
    }

    /// Performs the run up to its end and stores the trajectory. Returns `None` if `stop` ended the
    /// run; the run is then repeated later. If several runs are performed at once, `evaluator`
    /// evaluates the code of the run.
    pub(super) fn go(
        mut self,
        evaluator: Option<&dyn SceneCode>,
        stop: &Stop<'_>,
    ) -> Result<Option<MadeRun>, SweepError> {
        let ended = self.attempt(evaluator, stop)?;
        if ended.as_ref().is_some_and(MadeRun::has_lost_its_way) {
            // The interpreter passes some configurations only if it starts well before these
            // configurations, and not if it starts at the state at which the run left generated
            // code.
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
        let study = &self.begun.study;
        let mut table = match &self.folder {
            Some(folder) => {
                let file = folder.file("trajectory.csv")?;
                let more = more_columns(&study.scene.output);
                let trajectory = Trajectory::new(&study.prepared.mechanism, more);
                let units = table_units(&study.scene);
                Some(TrajectoryTable::new(file, trajectory, units)?)
            }
            None => None,
        };
        let mut unwritten = None;
        let ended = self.begun.go(evaluator, stop, |sample| {
            if let Some(table) = &mut table {
                let a = acceleration(table, sample)?;
                let written = table.row(sample.t, (sample.q, sample.v), a.as_deref());
                unwritten = written.err();
            }
            Ok(if unwritten.is_some() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            })
        });
        if let Some(error) = unwritten {
            return Err(error.into());
        }
        // The run may have ended shortly before the request.
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

/// Returns the directory of the files of a run. The number in the name has as many digits as the
/// number of the last run.
fn folder(directory: &Path, run: u64, runs: u64) -> PathBuf {
    let width = runs.to_string().len();
    directory.join("runs").join(format!("{run:0width$}"))
}
