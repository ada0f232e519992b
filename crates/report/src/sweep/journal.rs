//! The journal of one attempt to make the runs of a shard. A line is written before runs start, and
//! a line is written at the end of each run. Lines are never changed. Only one process writes a
//! journal, so no lock is needed.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::line::{Entry, Head, line, record};
use super::{Cell, JournalError, Runs, SweepPlan, SweepRow};
use crate::files::FileError;
use crate::files::process::Process;

/// Extension of the names of journals.
pub(super) const EXTENSION: &str = ".journal";

/// Shortest time between two synchronisations of the journal with the disk. The journal is not
/// synchronised after each line, because waiting for the disk takes longer than a short run. After
/// a power failure, at most the runs that finished within this time after the last synchronisation
/// are lost. After a crash of the program, no run is lost.
const SYNC: Duration = Duration::from_millis(100);

/// A journal that is being written. When the journal is dropped, a line is written which states
/// that the started runs did not end the process. This line is missing only if the process ends
/// abruptly.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    plan: SweepPlan,
    synced: Instant,
    has_ended: bool,
}

impl Journal {
    /// Starts a journal for these runs in the folder of the shards of a plan with this digest.
    pub(super) fn begin_in(
        folder: &Path,
        (plan, mark): (&SweepPlan, &str),
        runs: Runs,
    ) -> Result<Self, JournalError> {
        let process = Process::own();
        let head = Head {
            plan: mark.to_owned(),
            runs: (runs.first(), runs.last()),
            by: Some(process.clone()),
        };
        let mut time = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default()
            .as_micros();
        let (path, file) = loop {
            let (shard, process) = (runs.name(plan.runs), process.name());
            let path = folder.join(format!("{shard}.{process}-{time}{EXTENSION}"));
            let mut options = File::options();
            match options.append(true).create_new(true).open(&path) {
                Ok(file) => break (path, file),
                // Another thread of this process has started a journal at the same time.
                Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => time += 1,
                Err(e) => return Err(FileError::refused("make", &path)(e).into()),
            }
        };
        let mut journal = Self {
            file,
            path,
            plan: plan.clone(),
            synced: Instant::now(),
            has_ended: false,
        };
        let head = serde_json::to_vec(&head).unwrap_or_default();
        journal.line(&head, SyncWhen::Now)?;
        Ok(journal)
    }

    /// Writes a line which states that the given runs start. The line is not synchronised with the
    /// disk, because it is needed only after a crash of the process, and not after a failure of the
    /// machine.
    ///
    /// # Errors
    /// [`JournalError::File`]: the journal could not be written.
    pub fn begin(&mut self, runs: &[u64]) -> Result<(), JournalError> {
        self.line(&Entry::Begin(runs.to_vec()).text(), SyncWhen::Seldom)
    }

    /// Writes a line which states that a run starts, and that this process makes no other run at
    /// the same time.
    ///
    /// # Errors
    /// [`JournalError::File`]: the journal could not be written.
    pub fn begin_alone(&mut self, run: u64) -> Result<(), JournalError> {
        self.line(&Entry::Alone(run).text(), SyncWhen::Seldom)
    }

    /// Writes a line with the results of a finished run.
    ///
    /// # Errors
    /// [`JournalError::File`]: the journal could not be written.
    pub fn append(&mut self, row: &SweepRow) -> Result<(), JournalError> {
        let cells = self.plan.cells(row);
        self.append_cells(&cells)
    }

    /// Writes a line with the results of a finished run that were read from another file.
    pub(super) fn append_cells(&mut self, cells: &[Cell]) -> Result<(), JournalError> {
        let text = record(cells).map_err(FileError::refused("write", &self.path))?;
        self.line(&text, SyncWhen::Seldom)
    }

    /// Closes the journal after all of its content is on the disk.
    ///
    /// # Errors
    /// [`JournalError::File`]: the journal could not be written.
    pub fn finish(mut self) -> Result<(), JournalError> {
        self.end()
    }

    /// Removes the journal. The effect is the same as if the journal had not been started.
    ///
    /// # Errors
    /// [`JournalError::File`]: the journal could not be removed.
    pub fn discard(mut self) -> Result<(), JournalError> {
        self.has_ended = true;
        Ok(fs::remove_file(&self.path).map_err(FileError::refused("remove", &self.path))?)
    }

    fn end(&mut self) -> Result<(), JournalError> {
        if self.has_ended {
            return Ok(());
        }
        self.has_ended = true;
        self.line(&Entry::End.text(), SyncWhen::Now)
    }

    /// Each line is written by a single call, so lines of several threads are never mixed.
    fn line(&mut self, text: &[u8], when: SyncWhen) -> Result<(), JournalError> {
        let mut written = self.file.write_all(&line(text));
        let due = matches!(when, SyncWhen::Now) || self.synced.elapsed() > SYNC;
        if written.is_ok() && due {
            written = self.file.sync_data();
            self.synced = Instant::now();
        }
        Ok(written.map_err(FileError::refused("write", &self.path))?)
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        // If this line is missing, the next attempt makes the runs one at a time. There is no other
        // effect.
        let _ = self.end();
    }
}

#[derive(Clone, Copy)]
enum SyncWhen {
    Now,
    Seldom,
}
