//! Runs made on one thread, one after another or together, each handed over as soon as it is
//! finished. Whoever makes several at once makes them here.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use dynamics::Stop;
use report::{OutputDirectory, SweepRow, TrajectoryTable};

use super::{Sweep, SweepError};

/// Largest number of runs that are begun together.
pub(super) const TOGETHER: usize = 16;

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
        for run in runs {
            match self.whole_row(*run, keep, interrupted)? {
                Some(row) => sink(row)?,
                None => break,
            }
        }
        Ok(())
    }

    /// Makes a run, with its trajectory if that is kept. Returns `None` if it was interrupted.
    fn whole_row(
        &self,
        run: u64,
        keep: Keep<'_>,
        interrupted: &Stop<'_>,
    ) -> Result<Option<SweepRow>, SweepError> {
        if interrupted() {
            return Ok(None);
        }
        #[cfg(test)]
        super::tests::begins(run);
        let begun = match self.begin(run) {
            Ok(begun) => begun,
            Err(error) => return Ok(Some(self.refused(run, &error))),
        };
        if interrupted() {
            return Ok(None);
        }
        let mut table = match keep {
            Keep::Rows => None,
            Keep::Trajectories(directory) => {
                let folder = folder(directory, run, self.runs());
                // Another process may make the same run.
                let folder = OutputDirectory::create(folder)?.with_own_parts();
                let file = folder.file("trajectory.csv")?;
                let mechanism = &begun.study.prepared.mechanism;
                Some(TrajectoryTable::new(file, mechanism)?)
            }
        };
        let mut unwritten = None;
        let row = begun.go(interrupted, |sample| {
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
        // The run may have ended just before the request; it is made again then.
        if interrupted() {
            return Ok(None);
        }
        if let Some(table) = table {
            // The trajectory is stored on disk before the journal records the run.
            let mut file = table.finish()?;
            file.sync()?;
            file.finish()?;
        }
        Ok(Some(row))
    }
}

/// Directory of the files of a run; its number has as many digits as that of the last run.
fn folder(directory: &Path, run: u64, runs: u64) -> PathBuf {
    let width = runs.to_string().len();
    directory.join("runs").join(format!("{run:0width$}"))
}
