//! Many runs of one scene with different numbers. The runs are parallel and may be divided into
//! shards on any number of machines. If a process ends, no finished run is lost.
//!
//! Each run is read, checked, assembled and simulated like any scene. An error for one combination
//! of numbers is reported in the row of this combination; the other runs continue. Only unique
//! reactions have values.
//!
//! [`scene::Template`] describes the meaning of a key, and [`report::sweep`] the format of files.
//!
//! A run counts as finished once a journal contains its line. A journal belongs to one process. The
//! process only appends lines, and each line contains a digest. Once all runs of a shard are
//! finished, they are written to one file next to its final name. This file is synchronised and
//! renamed. No lock is necessary, because a process that repeats a run writes the same line. Runs
//! that a crashed process left unfinished are retried first, one per process (`gate`). A run that
//! then ends two processes is reported as a row. Slurm, Dask or Ray start the processes, not this
//! module.
//!
//! We rejected three alternatives. A shard of every n-th run has rows that are distributed over the
//! whole grid, and n cannot be changed later. Locks are not necessary. If every shard wrote the
//! tables, 200 shards would write all rows 200 times.

mod attempt;
mod axis;
mod code;
mod error;
mod gate;
mod job;
#[cfg(not(target_family = "wasm"))]
mod lanes;
mod make;
#[cfg(target_family = "wasm")]
mod one_by_one;
mod run;
mod shard;
#[cfg(test)]
mod tests;
mod varied;

use std::path::Path;

use report::sweep::{Extent, Records, Shards, write_sweep};
use report::{OutputDirectory, SweepDocument};

use attempt::Attempt;
use job::Keep;

pub use attempt::SweepProgress;
pub use axis::{Axis, AxisError};
pub use error::SweepError;
pub use report::sweep::end_attempts;
pub use shard::{Shard, ShardError};
pub use varied::Sweep;

/// Settings of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SweepSettings {
    /// The runs that this process performs.
    pub shard: Shard,
    /// Number of threads. 0 means one thread for each core.
    pub threads: usize,
}

impl Default for SweepSettings {
    fn default() -> Self {
        Self {
            shard: Shard::WHOLE,
            threads: 0,
        }
    }
}

impl Sweep<'_> {
    /// Performs the runs of a shard that are not finished yet, and writes the shard as one file. If
    /// all runs of the sweep are then finished, or if the shard is the whole sweep, the tables are
    /// written: `sweep.csv`, `sweep.parquet` and `summary.json`. `progress` is called with each
    /// finished run, in any order. `interrupted` is called often. If it returns true, the sweep
    /// ends, and no finished run is lost.
    ///
    /// Any number of processes may work in one directory, also on the same shard. If the process
    /// ends during a run, this run is repeated alone. If the process ends twice during the
    /// repetition, the row of the run reports this.
    ///
    /// # Errors
    /// - [`SweepError::NoneBegins`]: no run of the sweep can begin; nothing is written.
    /// - [`SweepError::Journal`]: the directory belongs to another sweep.
    /// - [`SweepError::File`], [`SweepError::Table`]: the operating system reported an error.
    pub fn run_into(
        &self,
        directory: &Path,
        settings: &SweepSettings,
        interrupted: impl Fn() -> bool + Sync,
        mut progress: impl FnMut(SweepProgress<'_>) + Send,
    ) -> Result<SweepOutcome, SweepError> {
        let is_new = !directory.exists();
        let output = OutputDirectory::create(directory)?.shared()?;
        let shards = Shards::open(directory, &self.plan)?;
        let Some(runs) = settings.shard.runs(self.runs()) else {
            progress(SweepProgress::Begin {
                runs: 0,
                finished: 0,
            });
            let records = Records::none(&self.plan);
            return self.ended(&output, &shards, settings.shard, records);
        };
        let known = shards.read(runs)?;
        let pending = known.missing(runs);
        let left: u64 = pending.iter().map(|runs| runs.count()).sum();
        progress(SweepProgress::Begin {
            runs: runs.count(),
            finished: runs.count() - left,
        });
        if left == 0 && runs.without(&known.sealed).is_empty() {
            shards.tidy(runs)?;
            return self.ended(&output, &shards, settings.shard, known);
        }
        let keep = if self.plan.keep_rows {
            Keep::Trajectories(directory)
        } else {
            Keep::Rows
        };
        let journal = shards.begin(runs)?;
        let attempt = Attempt::new(self, keep, &interrupted, journal, &mut progress);
        attempt.make(&known, &pending, settings.threads)?;
        let refused = !known.has_begun() && !attempt.has_begun() && !interrupted();
        if refused && let Some(error) = attempt.none_begins(runs, &known)? {
            attempt.into_journal().discard()?;
            shards.forget();
            if is_new {
                drop(output);
                // Other processes may have begun.
                let _ = std::fs::remove_dir(directory);
            }
            return Err(error);
        }
        attempt.into_journal().finish()?;
        let now = shards.read(runs)?;
        if now.missing(runs).is_empty() {
            for hole in runs.without(&now.sealed) {
                shards.seal(hole, &now)?;
            }
            shards.tidy(runs)?;
        }
        self.ended(&output, &shards, settings.shard, now)
    }

    /// Writes the tables, if all their runs are finished.
    fn ended(
        &self,
        output: &OutputDirectory,
        shards: &Shards,
        shard: Shard,
        records: Records,
    ) -> Result<SweepOutcome, SweepError> {
        let runs = shard.runs(self.runs());
        if shard.n() == 1 {
            let document = write_all(output, shards, records)?;
            return Ok(SweepOutcome {
                document,
                tables: Tables::Written,
            });
        }
        let document = SweepDocument::new(&records, Extent::Shard(runs));
        drop(records);
        let sealed = shards.sealed()?;
        let all = shards.all();
        let tables = if all.is_some_and(|all| all.without(&sealed).is_empty()) {
            let records = all.map_or_else(|| Ok(Records::none(&self.plan)), |all| shards.read(all));
            write_all(output, shards, records?)?;
            Tables::Written
        } else {
            Tables::NotYet
        };
        Ok(SweepOutcome { document, tables })
    }
}

/// The end of a sweep or of a shard.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepOutcome {
    /// Runs of the sweep or shard.
    pub document: SweepDocument,
    /// The tables of all runs.
    pub tables: Tables,
}

/// Whether the tables of all runs have been written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tables {
    /// This call has written the tables.
    Written,
    /// Runs of other shards are missing. The process that performs the last run writes the tables,
    /// or [`merge`] writes them.
    NotYet,
}

/// Deletes the rows of runs that ended their process. The next call of [`Sweep::run_into`] in this
/// directory repeats these runs. Returns the number of these runs. During this call, no process may
/// perform runs of the sweep.
///
/// # Errors
/// [`SweepError::Journal`]: the directory cannot be read or written.
pub fn forget_crashed(directory: &Path) -> Result<u64, SweepError> {
    if !Shards::are_in(directory) {
        return Ok(0);
    }
    Ok(Shards::find(directory)?.forget_crashed()?)
}

/// Merges the results of several directories into one set of tables.
///
/// # Errors
/// [`SweepError::Journal`]: the directories belong to different sweeps, or two rows of one run
/// differ; [`SweepError::File`], [`SweepError::Table`]: a file could not be written.
pub fn merge<P: AsRef<Path>>(directories: &[P], into: &Path) -> Result<MergedSweep, SweepError> {
    let records = Records::merged(directories)?;
    let output = OutputDirectory::create(into)?.shared()?;
    Ok(MergedSweep {
        document: write_sweep::<SweepError>(&output, &records)?,
        shards: Shard::number(records.plan.runs, &records.sealed),
    })
}

/// Result of [`merge`].
#[derive(Clone, Debug, PartialEq)]
pub struct MergedSweep {
    /// All runs of the directories.
    pub document: SweepDocument,
    /// The number of shards in which the runs were performed, if the finished shards determine it.
    pub shards: Option<u64>,
}

/// Writes the tables of a sweep. In the meantime, other processes may have finished shards and
/// written tables with more rows. In this case, the tables are written again.
fn write_all(
    output: &OutputDirectory,
    shards: &Shards,
    mut records: Records,
) -> Result<SweepDocument, SweepError> {
    loop {
        let document: SweepDocument = write_sweep::<SweepError>(output, &records)?;
        let Some(all) = shards.all().filter(|_| document.partial) else {
            return Ok(document);
        };
        let again = shards.read(all)?;
        if again.rows.len() <= records.rows.len() {
            return Ok(document);
        }
        records = again;
    }
}
