//! The journal of a sweep: a line for each finished run, written immediately and never changed.
//! Every line begins with a digest of the rest, so that a line cut off by a crash is recognised: it
//! is ignored, and its run is made again.
//!
//! ```text
//! 4be1d0… {"scene":"pendulum","digest":"…","vary":["body.bob.mass=1:2:11"],…}
//! 09f3a7… 3,1.2,done,,dop853,10.0,…
//! ```

use model::codes::Code;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::{Cell, Column, SweepPlan, SweepRow, SweepRows};
use crate::files::FileError;

/// Extension of the names of journals.
const ENDING: &str = ".journal";

/// If this time has passed since the journal was last synchronised with the disk, the next line
/// synchronises it again; waiting for the disk takes longer than a short run. A power failure loses
/// at most the runs that finished within this time after the last synchronisation; a crash of the
/// program loses none.
const SYNC: Duration = Duration::from_millis(100);

/// Reason why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// The operating system reported an error.
    #[error(transparent)]
    File(#[from] FileError),
    /// Another process is writing it.
    #[error("another sweep is writing `{}`; wait for its end, or take a shard of your own (`--shard i/n`)", path.display())]
    Busy {
        /// The journal.
        path: PathBuf,
    },
    /// It belongs to another sweep.
    #[error(
        "`{}` belongs to another sweep: {what} is {now}, and was {was}; take another directory, or remove the journal to begin again",
        path.display()
    )]
    Changed {
        /// The journal.
        path: PathBuf,
        /// The entry that differs.
        what: &'static str,
        /// Its previous value.
        was: String,
        /// Its present value.
        now: String,
    },
    /// Its first line is damaged, or does not describe a sweep.
    #[error("the first line of `{}` is not that of a sweep: nobody knows what its rows belong to; remove it to begin again", path.display())]
    Damaged {
        /// The journal.
        path: PathBuf,
    },
    /// There is no journal.
    #[error("no sweep was begun in `{}`", directory.display())]
    Missing {
        /// The directory.
        directory: PathBuf,
    },
}

impl JournalError {
    /// Its code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::File(e) => e.code(),
            Self::Busy { .. } => const { Code::new(504) },
            Self::Changed { .. } => const { Code::new(505) },
            Self::Damaged { .. } => const { Code::new(506) },
            Self::Missing { .. } => const { Code::new(507) },
        }
    }
}

/// A journal that is being written; no other process can write it at the same time.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    plan: SweepPlan,
    synced: Instant,
    /// Lock held while the journal is written. It is a separate file, because on some systems a
    /// locked file cannot be read.
    _lock: File,
}

impl Journal {
    /// Opens a journal with this name (without extension), or creates it. An incomplete last line
    /// left by a crash is removed.
    ///
    /// # Errors
    /// - [`JournalError::Busy`], [`JournalError::Changed`], [`JournalError::Damaged`]: the journal
    ///   cannot be continued.
    /// - [`JournalError::File`]: the operating system reported an error.
    pub fn open(directory: &Path, name: &str, plan: &SweepPlan) -> Result<Self, JournalError> {
        let path = directory.join(format!("{name}{ENDING}"));
        // Also checks the journals of other shards: a journal of another sweep in the same
        // directory would make its tables inconsistent.
        for other in journals(directory)?.iter().filter(|other| **other != path) {
            let bytes = fs::read(other).map_err(FileError::refused("read", other))?;
            if let Some(found) = Content::of(&bytes).plan(other)? {
                same(other, &found, plan)?;
            }
        }
        let lock = directory.join(format!("{name}.lock"));
        let held = File::create(&lock).map_err(FileError::refused("make", &lock))?;
        held.try_lock().map_err(|e| match e {
            TryLockError::WouldBlock => JournalError::Busy { path: path.clone() },
            TryLockError::Error(e) => FileError::refused("lock", &lock)(e).into(),
        })?;
        let mut options = File::options();
        let opened = options.read(true).append(true).create(true).open(&path);
        let mut file = opened.map_err(FileError::refused("open", &path))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)
            .map_err(FileError::refused("read", &path))?;
        let content = Content::of(&bytes);
        let found = content.plan(&path)?;
        if let Some(found) = &found {
            same(&path, found, plan)?;
        }
        file.set_len(content.length as u64)
            .map_err(FileError::refused("cut", &path))?;
        let mut journal = Self {
            file,
            path,
            plan: plan.clone(),
            synced: Instant::now(),
            _lock: held,
        };
        if found.is_none() {
            journal.line(&json(plan), SyncWhen::Now)?;
        }
        Ok(journal)
    }

    /// Adds a finished run.
    ///
    /// # Errors
    /// [`JournalError::File`]: it could not be written.
    pub fn append(&mut self, row: &SweepRow) -> Result<(), JournalError> {
        let cells = self.plan.cells(row);
        let text = record(&cells).map_err(FileError::refused("write", &self.path))?;
        self.line(&text, SyncWhen::Seldom)
    }

    /// Closes the journal after everything is on the disk.
    ///
    /// # Errors
    /// [`JournalError::File`]: it could not be written.
    pub fn finish(self) -> Result<(), JournalError> {
        let synced = self.file.sync_data();
        Ok(synced.map_err(FileError::refused("write", &self.path))?)
    }

    /// Each line is a single write, so lines of other processes are never mixed into it.
    fn line(&mut self, text: &[u8], when: SyncWhen) -> Result<(), JournalError> {
        let mut line = format!("{:016x} ", digest(text)).into_bytes();
        line.extend_from_slice(text);
        line.push(b'\n');
        let mut written = self.file.write_all(&line);
        let due = matches!(when, SyncWhen::Now) || self.synced.elapsed() > SYNC;
        if written.is_ok() && due {
            written = self.file.sync_data();
            self.synced = Instant::now();
        }
        Ok(written.map_err(FileError::refused("write", &self.path))?)
    }
}

#[derive(Clone, Copy)]
enum SyncWhen {
    Now,
    Seldom,
}

/// All journals of some directories.
#[derive(Clone, Debug, PartialEq)]
pub struct Journals {
    /// The common description of the sweep.
    pub plan: SweepPlan,
    /// The finished runs.
    pub rows: SweepRows,
}

impl Journals {
    /// Reads all journals. A run that was made twice counts once.
    ///
    /// # Errors
    /// - [`JournalError::Missing`]: a directory has none.
    /// - [`JournalError::Changed`], [`JournalError::Damaged`]: they belong to different sweeps.
    /// - [`JournalError::File`]: the operating system reported an error.
    pub fn read<P: AsRef<Path>>(directories: &[P]) -> Result<Self, JournalError> {
        let mut all: Option<Self> = None;
        let mut missing = PathBuf::new();
        for directory in directories.iter().map(AsRef::as_ref) {
            let mut is_empty = true;
            for path in journals(directory)? {
                let bytes = fs::read(&path).map_err(FileError::refused("read", &path))?;
                let content = Content::of(&bytes);
                // A journal that was cut off before its first line was complete is empty.
                let Some(plan) = content.plan(&path)? else {
                    continue;
                };
                is_empty = false;
                let all = all.get_or_insert_with(|| Self {
                    plan: plan.clone(),
                    rows: SweepRows::new(),
                });
                same(&path, &plan, &all.plan)?;
                let columns = plan.columns();
                let rows = content.lines.iter().skip(1);
                for (run, cells) in rows.filter_map(|line| read_record(line, &columns)) {
                    all.rows.entry(run).or_insert(cells);
                }
            }
            if is_empty {
                return Err(JournalError::Missing {
                    directory: directory.to_owned(),
                });
            }
            missing = directory.to_owned();
        }
        all.ok_or(JournalError::Missing { directory: missing })
    }
}

/// Paths of the journals of a directory, in the order of their names.
fn journals(directory: &Path) -> Result<Vec<PathBuf>, JournalError> {
    let refused = || FileError::refused("read", directory);
    let mut paths = Vec::new();
    for entry in fs::read_dir(directory).map_err(refused())? {
        let entry = entry.map_err(refused())?;
        if entry.file_name().to_string_lossy().ends_with(ENDING) {
            paths.push(entry.path());
        }
    }
    paths.sort();
    Ok(paths)
}

/// The valid lines of a journal.
struct Content<'b> {
    lines: Vec<&'b [u8]>,
    /// Whether the first line is valid.
    begins: bool,
    /// Whether there is a complete line that is not as it was written.
    has_damage: bool,
    /// Number of bytes up to the end of the last valid line.
    length: usize,
}

impl<'b> Content<'b> {
    fn of(bytes: &'b [u8]) -> Self {
        let mut content = Self {
            lines: Vec::new(),
            begins: false,
            has_damage: false,
            length: 0,
        };
        let mut at = 0;
        for line in bytes.split_inclusive(|b| *b == b'\n') {
            if let Some(text) = intact(line) {
                content.begins |= at == 0;
                content.lines.push(text);
                content.length = at + line.len();
            } else {
                content.has_damage |= line.ends_with(b"\n");
            }
            at += line.len();
        }
        content
    }

    /// The description in its first line; `None` if there is none yet.
    fn plan(&self, path: &Path) -> Result<Option<SweepPlan>, JournalError> {
        let plan = match self.lines.first() {
            None if !self.has_damage => return Ok(None),
            Some(first) if self.begins => serde_json::from_slice(first).ok(),
            _ => None,
        };
        plan.map(Some).ok_or_else(|| JournalError::Damaged {
            path: path.to_owned(),
        })
    }
}

/// The text of a line, if it is complete.
fn intact(line: &[u8]) -> Option<&[u8]> {
    let (head, text) = line.strip_suffix(b"\n")?.split_at_checked(17)?;
    let written = std::str::from_utf8(head).ok()?.strip_suffix(' ')?;
    (u64::from_str_radix(written, 16).ok()? == digest(text)).then_some(text)
}

fn json(plan: &SweepPlan) -> Vec<u8> {
    // Texts, numbers and lists of texts, so this cannot fail.
    serde_json::to_vec(plan).unwrap_or_default()
}

fn record(cells: &[Cell]) -> io::Result<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    writer.serialize(cells).map_err(io::Error::other)?;
    let mut text = writer.into_inner().map_err(|e| e.into_error())?;
    text.pop();
    Ok(text)
}

/// The run and the cells of a line, if they fit the columns.
fn read_record(line: &[u8], columns: &[Column]) -> Option<(u64, Vec<Cell>)> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(line);
    let record = reader.records().next()?.ok()?;
    if record.len() != columns.len() {
        return None;
    }
    let fields = record.iter().zip(columns);
    let cells: Vec<Cell> = fields
        .map(|(field, column)| Cell::read(field, column.kind))
        .collect::<Option<_>>()?;
    match cells.first() {
        Some(Cell::Count(Some(run))) => Some((*run, cells)),
        _ => None,
    }
}

/// Returns an error that names the difference if two descriptions differ.
fn same(path: &Path, was: &SweepPlan, now: &SweepPlan) -> Result<(), JournalError> {
    let keeps = |plan: &SweepPlan| {
        if plan.keep_rows {
            "with trajectories".to_owned()
        } else {
            "without trajectories".to_owned()
        }
    };
    let differing = [
        (
            "the text of the scene",
            was.digest.clone(),
            now.digest.clone(),
        ),
        ("the grid", was.vary.join(" "), now.vary.join(" ")),
        ("the program", was.version.clone(), now.version.clone()),
        ("it", keeps(was), keeps(now)),
    ];
    let found = differing.into_iter().find(|(_, was, now)| was != now);
    let what = match found {
        Some(difference) => difference,
        None if was == now => return Ok(()),
        None => (
            "what the rows have",
            String::from_utf8_lossy(&json(was)).into_owned(),
            String::from_utf8_lossy(&json(now)).into_owned(),
        ),
    };
    Err(JournalError::Changed {
        path: path.to_owned(),
        what: what.0,
        was: what.1,
        now: what.2,
    })
}

/// A 64-bit digest that differs for different texts unless they are constructed to agree: FNV-1a
/// with a final mix of its bits.
#[must_use]
pub fn digest(bytes: &[u8]) -> u64 {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325, step);
    let mixed = (hash ^ (hash >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    mixed ^ (mixed >> 32)
}
