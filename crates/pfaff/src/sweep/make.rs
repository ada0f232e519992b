//! Performs runs on one thread, one after another or together. Each result is passed on as soon as
//! its run is finished. All callers that perform several runs at once use this module.

use dynamics::Stop;
use report::SweepRow;

use super::job::{Job, Keep};
#[cfg(not(target_family = "wasm"))]
use super::lanes::together;
#[cfg(target_family = "wasm")]
use super::one_by_one::together;
use super::{Sweep, SweepError};

/// Largest number of runs that are begun together.
pub(super) const TOGETHER: usize = 32;

impl Sweep<'_> {
    /// Performs these runs (1-based, ascending, at most [`TOGETHER`]) on this thread, and passes on
    /// each row. The contents of a row do not depend on the other runs. Interrupted runs have no
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
                Ok(own) => begun.push(Job::new(run, own, keep, self.runs())?),
                Err(error) => sink(self.refused(run, &error))?,
            }
        }
        together(begun, interrupted, &mut |run, ended| match ended? {
            Some(ended) => sink(self.row_of(run, ended)),
            None => Ok(()),
        })
    }
}
