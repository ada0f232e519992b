//! The folder `shards` of the directory of a sweep: the plan, finished shards, and the journals of
//! attempts. The name of a file contains the runs of the file, so that a process reads only the
//! files that it needs.
//!
//! | file | content |
//! | --- | --- |
//! | `plan` | the description of the sweep, written by the first process |
//! | `0001-0500.rows` | a finished shard; the file is always complete |
//! | `0001-0500.parquet` | the same shard as Parquet, written before the `.rows` file |
//! | `0001-0500.HOST-PID-TIME.journal` | an attempt |
//!
//! Files are written next to their final paths, synchronised and renamed. Therefore two processes
//! may write the same file; the two contents differ only in the column `seconds`. There are no
//! locks.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use super::error::{json, mark, same};
use super::journal::{self, Journal};
use super::line::{Entry, Head, intact, line, record};
use super::records::RecordCollection;
use super::{JournalError, Records, Runs, SweepPlan};
use crate::files::process::{Life, Process};
use crate::files::{FileError, own_part};

/// Extension of the names of finished shards.
const ROWS: &str = ".rows";
/// Name of the plan.
const PLAN: &str = "plan";
/// Name of the folder.
const FOLDER: &str = "shards";

/// Maximum number of repeated readings of the folder. A reading is repeated if a file has
/// disappeared because another process has finished a shard and removed its journals.
const LOOKS: usize = 1000;

/// The shards of a sweep in a directory.
#[derive(Clone, Debug)]
pub struct Shards {
    folder: PathBuf,
    plan: SweepPlan,
    /// Digest of the plan.
    pub(super) mark: String,
}

/// A file of the folder.
struct ShardFile {
    path: PathBuf,
    runs: Runs,
    is_sealed: bool,
}

/// The content of a file.
struct ShardRecords {
    found: ShardFile,
    entries: Vec<Entry>,
    by: Option<Process>,
}

impl Shards {
    /// Opens the shards of a directory, and creates them if the directory contains no shards.
    ///
    /// # Errors
    /// - [`JournalError::Changed`], [`JournalError::Damaged`]: the directory contains another
    ///   sweep.
    /// - [`JournalError::File`]: the operating system reported an error.
    pub fn open(directory: &Path, plan: &SweepPlan) -> Result<Self, JournalError> {
        let folder = directory.join(FOLDER);
        fs::create_dir_all(&folder).map_err(FileError::refused("make the directory", &folder))?;
        let path = folder.join(PLAN);
        let found = match Self::plan_in(&path)? {
            Some(found) => found,
            None => {
                publish(&path, &line(&json(plan)), Publish::Once)?;
                // Another process may have written the plan first.
                Self::plan_in(&path)?.ok_or(JournalError::Damaged { path: path.clone() })?
            }
        };
        same(&path, &found, plan)?;
        Ok(Self {
            folder,
            mark: mark(plan),
            plan: found,
        })
    }

    /// The shards that were started in a directory.
    ///
    /// # Errors
    /// - [`JournalError::Missing`]: the directory contains no shards.
    /// - [`JournalError::Damaged`], [`JournalError::File`]: the shards cannot be read.
    pub fn find(directory: &Path) -> Result<Self, JournalError> {
        fs::metadata(directory).map_err(FileError::refused("read", directory))?;
        let folder = directory.join(FOLDER);
        let plan = Self::plan_in(&folder.join(PLAN))?;
        let plan = plan.ok_or_else(|| JournalError::Missing {
            directory: directory.to_owned(),
        })?;
        Ok(Self {
            folder,
            mark: mark(&plan),
            plan,
        })
    }

    /// Whether a directory contains shards.
    #[must_use]
    pub fn are_in(directory: &Path) -> bool {
        directory.join(FOLDER).join(PLAN).exists()
    }

    /// The description of the sweep.
    #[must_use]
    pub fn plan(&self) -> &SweepPlan {
        &self.plan
    }

    /// All runs of the sweep, if there are any.
    #[must_use]
    pub fn all(&self) -> Option<Runs> {
        Runs::new(1, self.plan.runs)
    }

    fn plan_in(path: &Path) -> Result<Option<SweepPlan>, JournalError> {
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
                return Ok(None);
            }
            Err(e) => return Err(FileError::refused("read", path)(e).into()),
        };
        let (_, mut lines) = intact(&bytes);
        let plan = lines
            .next()
            .and_then(|text| serde_json::from_slice(text).ok());
        plan.map(Some).ok_or_else(|| JournalError::Damaged {
            path: path.to_owned(),
        })
    }

    /// The files that contain some of these runs, in the order of their names.
    fn found(&self, wanted: Runs) -> Result<Vec<ShardFile>, JournalError> {
        let refused = || FileError::refused("read", &self.folder);
        let mut all = Vec::new();
        for entry in fs::read_dir(&self.folder).map_err(refused())? {
            let entry = entry.map_err(refused())?;
            let name = entry.file_name();
            let name = name.to_string_lossy();
            let is_sealed = name.ends_with(ROWS);
            let runs = name.split('.').next().and_then(Runs::of_name);
            if let Some(runs) = runs.filter(|runs| runs.meets(wanted))
                && (is_sealed || name.ends_with(journal::EXTENSION))
            {
                all.push(ShardFile {
                    path: entry.path(),
                    runs,
                    is_sealed,
                });
            }
        }
        all.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(all)
    }

    /// The runs of the finished shards, determined only from the file names.
    ///
    /// # Errors
    /// [`JournalError::File`]: the folder cannot be read.
    pub fn sealed(&self) -> Result<Vec<Runs>, JournalError> {
        let Some(all) = self.all() else {
            return Ok(Vec::new());
        };
        let found = self.found(all)?.into_iter();
        Ok(found
            .filter(|file| file.is_sealed)
            .map(|file| file.runs)
            .collect())
    }

    /// The records of some runs, from all files that contain them.
    ///
    /// # Errors
    /// - [`JournalError::Changed`], [`JournalError::Damaged`]: a file belongs to another sweep.
    /// - [`JournalError::Differs`]: two rows of one run differ.
    /// - [`JournalError::File`]: the operating system reported an error.
    pub fn read(&self, wanted: Runs) -> Result<Records, JournalError> {
        let mut gathered = RecordCollection::new(self.plan.clone());
        self.gather(wanted, &mut gathered)?;
        Ok(gathered.records())
    }

    /// Adds the records of some runs.
    pub(super) fn gather(
        &self,
        wanted: Runs,
        gathered: &mut RecordCollection,
    ) -> Result<(), JournalError> {
        let mut looks = 0;
        let told = loop {
            match self.told(wanted) {
                // The rows of this file are now in a finished shard.
                Err(JournalError::File(FileError::Refused { source, .. }))
                    if source.kind() == ErrorKind::NotFound && looks < LOOKS =>
                {
                    looks += 1;
                }
                told => break told?,
            }
        };
        for ShardRecords { found, entries, by } in told {
            let mut begun: BTreeMap<u64, bool> = BTreeMap::new();
            let mut has_ended = false;
            let mut count = 0;
            for entry in entries {
                match entry {
                    Entry::Begin(runs) => begun.extend(runs.into_iter().map(|run| (run, false))),
                    Entry::Alone(run) => drop(begun.insert(run, true)),
                    Entry::End => has_ended = true,
                    Entry::Row(run, cells) => {
                        begun.remove(&run);
                        count += 1;
                        gathered.take(run, cells, &found.path)?;
                    }
                }
            }
            if found.is_sealed {
                let common = wanted.without(&wanted.without(&[found.runs]));
                let expected: u64 = common.iter().map(|runs| runs.count()).sum();
                // The runs of a damaged shard are repeated.
                if count >= expected {
                    gathered.sealed.push(found.runs);
                }
                continue;
            }
            let is_dead = match by.as_ref().map(Process::life) {
                Some(Life::Runs) => false,
                Some(Life::Gone) => true,
                // If it is unknown whether the process of a journal is still running, the process
                // counts as ended only if exactly the runs of the journal are requested.
                Some(Life::Unknown) | None => found.runs == wanted,
            };
            if !has_ended && is_dead {
                gathered.blame(begun);
            }
        }
        Ok(())
    }

    fn told(&self, wanted: Runs) -> Result<Vec<ShardRecords>, JournalError> {
        let columns = self.plan.columns();
        let mut all = Vec::new();
        for found in self.found(wanted)? {
            let bytes = fs::read(&found.path).map_err(FileError::refused("read", &found.path))?;
            let Some((head, lines)) = self.content(&found, &bytes)? else {
                continue;
            };
            let entries = lines.filter_map(|line| Entry::read(line, &columns, wanted));
            all.push(ShardRecords {
                entries: entries.collect(),
                by: head.by,
                found,
            });
        }
        Ok(all)
    }

    /// Returns the first line of a file and the other lines. Returns `None` if the first line is
    /// incomplete.
    fn content<'b>(
        &self,
        found: &ShardFile,
        bytes: &'b [u8],
    ) -> Result<Option<(Head, impl Iterator<Item = &'b [u8]> + use<'b>)>, JournalError> {
        if !bytes.contains(&b'\n') {
            return Ok(None);
        }
        let (begins, mut lines) = intact(bytes);
        let head = lines.next().filter(|_| begins);
        let head = head.and_then(|text| serde_json::from_slice::<Head>(text).ok());
        let damaged = || JournalError::Damaged {
            path: found.path.clone(),
        };
        let head = head.ok_or_else(damaged)?;
        if head.runs() != Some(found.runs) {
            return Err(damaged());
        }
        if head.plan != self.mark {
            return Err(JournalError::Changed {
                path: found.path.clone(),
                what: "the digest of its plan",
                was: head.plan,
                now: self.mark.clone(),
            });
        }
        Ok(Some((head, lines)))
    }

    /// Starts an attempt to make some runs.
    ///
    /// # Errors
    /// [`JournalError::File`]: the operating system reported an error.
    pub fn begin(&self, runs: Runs) -> Result<Journal, JournalError> {
        Journal::begin_in(&self.folder, (&self.plan, &self.mark), runs)
    }

    /// Writes a finished shard. All runs of the shard have rows.
    ///
    /// # Errors
    /// [`JournalError::File`]: the shard could not be written.
    pub fn seal(&self, runs: Runs, records: &Records) -> Result<(), JournalError> {
        let path = self.folder.join(runs.name(self.plan.runs) + ROWS);
        let rows = || records.rows.range(runs.first()..=runs.last());
        #[cfg(feature = "parquet")]
        if Some(runs) != self.all() {
            let part = path.with_extension("parquet");
            let columns = self.plan.columns();
            let rows = rows()
                .map(|(_, cells)| cells.as_slice())
                .collect::<Vec<_>>();
            let written = super::parquet::write(Vec::new(), &self.plan, &columns, &rows);
            let bytes = written
                .map_err(|e| FileError::refused("write", &part)(std::io::Error::other(e)))?;
            publish(&part, &bytes, Publish::Anew)?;
        }
        let head = Head {
            plan: self.mark.clone(),
            runs: (runs.first(), runs.last()),
            by: None,
        };
        let mut bytes = line(&serde_json::to_vec(&head).unwrap_or_default());
        for (_, cells) in rows() {
            let text = record(cells).map_err(FileError::refused("write", &path))?;
            bytes.extend(line(&text));
        }
        Ok(publish(&path, &bytes, Publish::Anew)?)
    }

    /// Removes journals of attempts that have ended and whose runs are in finished shards.
    ///
    /// # Errors
    /// [`JournalError::File`]: the operating system reported an error.
    pub fn tidy(&self, runs: Runs) -> Result<(), JournalError> {
        let sealed = self.sealed()?;
        for found in self.found(runs)? {
            if found.is_sealed || !found.runs.without(&sealed).is_empty() {
                continue;
            }
            // Another process may have removed the file.
            let Ok(bytes) = fs::read(&found.path) else {
                continue;
            };
            let Some((head, lines)) = self.content(&found, &bytes)? else {
                continue;
            };
            let end = Entry::End.text();
            let life = head.by.as_ref().map(Process::life);
            if life == Some(Life::Gone) || lines.into_iter().any(|line| line == end) {
                let _ = fs::remove_file(&found.path);
            }
        }
        Ok(())
    }

    /// Deletes the rows of runs during which the process ended, and removes these runs from the
    /// list of suspects. These runs are then performed again, like runs that were never started.
    /// Returns the number of these runs. At the same time, no process may make runs of the sweep.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::read`]; [`JournalError::File`]: a file could not be
    /// written or removed.
    pub fn forget_crashed(&self) -> Result<u64, JournalError> {
        let Some(all) = self.all() else { return Ok(0) };
        let records = self.read(all)?;
        let crashed = records.crashed();
        if crashed.is_empty() {
            return Ok(0);
        }
        let files = self.found(all)?;
        let files = files
            .iter()
            .filter(|file| crashed.iter().any(|run| file.runs.has(*run)));
        // The other rows are written to the disk again before their files are removed.
        let mut journal = self.begin(all)?;
        for (run, cells) in &records.rows {
            if crashed.binary_search(run).is_err() {
                journal.append_cells(cells)?;
            }
        }
        journal.finish()?;
        for file in files {
            let path = &file.path;
            fs::remove_file(path).map_err(FileError::refused("remove", path))?;
            if file.is_sealed {
                // Only programs with the feature `parquet` write this file.
                let _ = fs::remove_file(path.with_extension("parquet"));
            }
        }
        Ok(crashed.len() as u64)
    }

    /// Removes the folder if it contains only the plan.
    pub fn forget(&self) {
        let files = fs::read_dir(&self.folder).map_or(0, Iterator::count);
        if files == 1 && fs::remove_file(self.folder.join(PLAN)).is_ok() {
            // This fails if other processes have started runs.
            let _ = fs::remove_dir(&self.folder);
        }
    }
}

/// Records in the journals of this process that the end of the process is intended and that the
/// started runs did not cause the end. This function is for a process that ends without unwinding.
pub fn end_attempts(directory: &Path) {
    let Ok(shards) = Shards::find(directory) else {
        return;
    };
    let Some(Ok(files)) = shards.all().map(|all| shards.found(all)) else {
        return;
    };
    let own = Process::own();
    for found in files.iter().filter(|found| !found.is_sealed) {
        let bytes = fs::read(&found.path).unwrap_or_default();
        if let Ok(Some((head, _))) = shards.content(found, &bytes)
            && head.by.as_ref() == Some(&own)
        {
            let file = File::options().append(true).open(&found.path);
            // The process ends even if this fails.
            let _ = file.and_then(|mut file| file.write_all(&line(&Entry::End.text())));
        }
    }
}

/// Treatment of an older file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Publish {
    /// The older file is kept.
    Once,
    /// The older file is replaced.
    Anew,
}

/// Writes a file next to its final path, synchronises it with the disk and renames it.
fn publish(path: &Path, bytes: &[u8], how: Publish) -> Result<(), FileError> {
    let part = own_part(path);
    let written = || {
        let mut file = File::create(&part)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    let placed = || match how {
        // If the file system does not support links, the file is renamed.
        Publish::Once => match fs::hard_link(&part, path) {
            Ok(()) => fs::remove_file(&part),
            Err(e) if e.kind() == ErrorKind::AlreadyExists => fs::remove_file(&part),
            Err(_) => fs::rename(&part, path),
        },
        Publish::Anew => fs::rename(&part, path),
    };
    let done = written()
        .map_err(FileError::refused("write", path))
        .and_then(|()| placed().map_err(FileError::refused("rename to", path)));
    if done.is_err() {
        // Only the first error is reported.
        let _ = fs::remove_file(&part);
    }
    done?;
    // The content of the file is on the disk. Some systems cannot synchronise the directory entry.
    if let Some(folder) = path.parent() {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
    Ok(())
}
