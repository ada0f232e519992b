//! Files of an output directory. Each file is written as `<name>.part` and renamed when it is
//! finished, so that a file with its final name is always complete. When the value of an unfinished
//! file is dropped, the file is removed. A directory that was created for files and contains no
//! file is also removed. If writing fails, all unfinished files are truncated after the last
//! complete line and are still named `.part`. An older file with the final name does not change.
//!
//! A result of several files is replaced in one step, as far as the system allows this. All files
//! are first written as `.part` files and then renamed. Finally, the files of an earlier result of
//! the same [`Family`] are removed, except files that the new result contains.
//!
//! No content is written through a symbolic link. A link at the path of a file is replaced by the
//! file, and the target of the link does not change. No file is removed through a link.

mod family;
mod lock;
mod made;
mod ours;
pub(crate) mod process;

use model::codes::Code;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::mem;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError, Weak};
use std::thread::sleep;
use std::time::Duration;

pub use family::Family;
use made::NewDirectories;
use ours::is_marked;
pub use ours::{PROVENANCE, is_ours};

/// Reason why a file cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system reported an error.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Refused {
        /// The operation that failed.
        action: &'static str,
        /// Path of the file or directory.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// The name is not a plain file name. The file would be outside of the directory.
    #[error("`{name}` is not the name of a file inside `{}`: omit directories", directory.display())]
    Name {
        /// The name.
        name: String,
        /// The directory.
        directory: PathBuf,
    },
    /// Another process is writing into the directory.
    #[error("another run of pfaff is writing into `{}`; wait until it ends, or choose another directory", directory.display())]
    Busy {
        /// The directory.
        directory: PathBuf,
    },
    /// A file would be replaced.
    #[error("`{}` exists already; use --force to replace it, or --out for another file", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The path of a file is the path of a directory, a device, a pipe or a link.
    #[error("`{}` is a directory, a device or a link, not a file; choose another path", path.display())]
    NoFile {
        /// The path.
        path: PathBuf,
    },
    /// Files would be replaced that were not written by pfaff.
    #[error(
        "`{}` was not written by pfaff; use --force to replace it, or choose another path",
        paths_of(paths)
    )]
    Foreign {
        /// Paths of these files.
        paths: Vec<PathBuf>,
    },
}

impl FileError {
    /// Error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Foreign { .. } => const { Code::new(4) },
            Self::Busy { .. } => const { Code::new(5) },
            _ if self.is_place() => const { Code::new(3) },
            _ => const { Code::new(6) },
        }
    }
}

impl FileError {
    pub(crate) fn refused(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Refused {
            action,
            path,
            source,
        }
    }

    /// Whether the path is the cause of the error: no file can be created at the path, or an
    /// existing file must not be replaced. Otherwise, a write operation has failed.
    #[must_use]
    pub fn is_place(&self) -> bool {
        match self {
            Self::Refused { action, source, .. } => {
                let full = [ErrorKind::StorageFull, ErrorKind::QuotaExceeded];
                action.starts_with(MAKE) && !full.contains(&source.kind())
            }
            Self::Name { .. }
            | Self::Exists { .. }
            | Self::NoFile { .. }
            | Self::Foreign { .. } => true,
            Self::Busy { .. } => false,
        }
    }
}

/// The operation that creates a file or a directory.
const MAKE: &str = "make";

fn paths_of(paths: &[PathBuf]) -> String {
    let names: Vec<String> = paths
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    names.join("`, `")
}

/// Returns file names for these names. The file names differ even on systems that ignore the case
/// of letters. Characters that are not permitted in file names are replaced, and the index of the
/// name (1-based) is appended.
///
/// ```
/// let stems = pfaff_report::file_stems(["arm", "a/b", "Arm"].into_iter());
/// assert_eq!(stems, ["arm", "a_b.2", "Arm.3"]);
/// ```
#[must_use]
pub fn file_stems<'n>(names: impl Iterator<Item = &'n str>) -> Vec<String> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_. ".contains(c);
    let mut known: Vec<String> = Vec::new();
    let stem = |(k, name): (usize, &str)| {
        let plain = name.replace(|c| !is_plain(c), "_");
        let has_edges = plain.trim_matches(['.', ' ']) == plain;
        let folded = plain.to_lowercase();
        let stem = if plain == name && has_edges && !known.contains(&folded) {
            plain
        } else {
            format!("{}.{}", plain.trim_matches(['.', ' ']), k + 1)
        };
        known.push(folded);
        stem
    };
    names.enumerate().map(stem).collect()
}

/// A directory for results.
#[derive(Clone, Debug)]
pub struct OutputDirectory {
    path: PathBuf,
    parts: Parts,
    unfinished: FailurePolicy,
    written: Arc<Mutex<WrittenFiles>>,
    /// The path of this directory relative to the directory for which `written` was created.
    inner: PathBuf,
    /// Whether files that were not written by pfaff may be replaced.
    is_forced: bool,
    /// Excludes other processes until the last clone of the directory is dropped.
    _lock: Option<Arc<File>>,
    /// The directories that were created for the output directory.
    made: Arc<NewDirectories>,
    /// Whether a file could not be written. In this case, unfinished files are not removed.
    has_failed: Arc<AtomicBool>,
}

/// Files that a single file may replace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replaces {
    /// No file.
    Nothing,
    /// Files that were written by pfaff.
    Ours,
    /// Every file.
    Files,
}

/// Names of unfinished files.
#[derive(Clone, Copy, Debug)]
enum Parts {
    /// `<name>.part`. The next run replaces an unfinished file of an earlier run.
    Plain,
    /// Names that only this process uses.
    Own,
}

/// Treatment of unfinished files after a failure or at the end of the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FailurePolicy {
    /// The complete lines remain in the file.
    Kept,
    Removed,
}

/// The files that this process has written into a directory.
#[derive(Debug, Default)]
struct WrittenFiles {
    /// Files that were started, with their names.
    begun: Vec<(OsString, Weak<Mutex<Content>>)>,
    /// Names of files that were written in one step.
    finished: Vec<OsString>,
}

impl WrittenFiles {
    /// The names of files that this process writes or has written.
    fn names(&self) -> Vec<&str> {
        let begun = self.begun.iter().map(|(name, _)| name);
        let names = self.finished.iter().chain(begun);
        names.filter_map(|name| name.to_str()).collect()
    }

    fn has(&self, name: &str) -> bool {
        self.names().contains(&name)
    }
}

/// Time to wait for the end of a write operation when a run must end immediately.
const PATIENCE: Duration = Duration::from_millis(100);

/// Time between two attempts.
const PAUSE: Duration = Duration::from_millis(5);

impl OutputDirectory {
    /// Opens a directory, and creates it if it does not exist. A new directory that contains no
    /// file is removed when the last clone of this value is dropped.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the directory cannot be created, for example because a file has
    ///   its name.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let made = NewDirectories::all_of(&path)
            .map_err(FileError::refused("make the directory", &path))?;
        Ok(Self {
            made: Arc::new(made),
            path,
            parts: Parts::Plain,
            unfinished: FailurePolicy::Kept,
            written: Arc::default(),
            inner: PathBuf::new(),
            is_forced: false,
            _lock: None,
            has_failed: Arc::default(),
        })
    }

    /// Excludes all other processes from the directory, until this value and its clones are dropped
    /// or the process ends for any reason. If the file system does not support locks, no process is
    /// excluded.
    ///
    /// # Errors
    /// - [`FileError::Busy`]: another process uses the directory.
    pub fn exclusive(self) -> Result<Self, FileError> {
        let lock = lock::of(&self.path, File::try_lock)?;
        Ok(Self {
            _lock: lock.map(Arc::new),
            ..self
        })
    }

    /// Opens the directory in which a single file will be written. The directory must exist.
    ///
    /// # Errors
    /// - [`FileError::Exists`], [`FileError::Foreign`]: the existing file must not be replaced.
    /// - [`FileError::NoFile`]: the path is a directory, a device, a pipe or a link. A link is
    ///   neither replaced nor followed, because only the user can decide whether the link or its
    ///   target is meant.
    /// - [`FileError::Refused`]: the directory does not exist.
    pub fn around(file: &Path, replaces: Replaces) -> Result<Self, FileError> {
        let path = file.to_owned();
        let is_there = fs::symlink_metadata(file).is_ok();
        match replaces {
            _ if is_there && !ours::is_plain(file) => return Err(FileError::NoFile { path }),
            Replaces::Nothing if is_there => return Err(FileError::Exists { path }),
            Replaces::Ours if !is_ours(file) => {
                return Err(FileError::Foreign { paths: vec![path] });
            }
            _ => {}
        }
        let parent = file.parent().unwrap_or(Path::new(""));
        let parent = if parent.as_os_str().is_empty() {
            Path::new(".")
        } else {
            parent
        };
        if !parent.is_dir() {
            let source = io::Error::new(ErrorKind::NotFound, "its directory does not exist");
            return Err(FileError::refused(MAKE, file)(source));
        }
        Ok(Self::create(parent)?.with_own_parts().whole())
    }

    /// Unfinished files are then removed even after a failure. Use this for files that are only
    /// useful if they are complete.
    #[must_use]
    pub fn whole(mut self) -> Self {
        self.unfinished = FailurePolicy::Removed;
        self
    }

    /// Allows several processes to write the same files at the same time. Unfinished files then
    /// have separate names, and the file that is finished last remains.
    #[must_use]
    pub fn with_own_parts(mut self) -> Self {
        self.parts = Parts::Own;
        self
    }

    /// Works like [`Self::exclusive`], but processes that share the directory do not exclude each
    /// other; see [`Self::with_own_parts`].
    ///
    /// # Errors
    /// Returns the same errors as [`Self::exclusive`].
    pub fn shared(self) -> Result<Self, FileError> {
        let lock = lock::of(&self.path, File::try_lock_shared)?;
        Ok(Self {
            _lock: lock.map(Arc::new),
            ..self.with_own_parts()
        })
    }

    /// Permits the replacement of files that were not written by pfaff. [`Self::check_ours`] then
    /// returns no error.
    #[must_use]
    pub fn forced(mut self) -> Self {
        self.is_forced = true;
        self
    }

    /// Opens a subdirectory, and creates it if it does not exist. [`Self::abandon`] ends the
    /// writing in both directories together.
    ///
    /// # Errors
    /// - [`FileError::Name`]: the name is empty or contains a directory.
    /// - [`FileError::Refused`]: the directory cannot be created.
    pub fn within(&self, name: &str) -> Result<Self, FileError> {
        self.check_name(name.as_ref())?;
        let path = self.path.join(name);
        let made = NewDirectories::all_of(&path)
            .map_err(FileError::refused("make the directory", &path))?;
        Ok(Self {
            made: Arc::new(made),
            inner: self.inner.join(name),
            path,
            ..self.clone()
        })
    }

    /// Path of the directory.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Checks that all files with names of this family were written by pfaff. If the directory is
    /// [`Self::forced`], there is no check.
    ///
    /// # Errors
    /// - [`FileError::Foreign`]
    pub fn check_ours(&self, family: Family) -> Result<(), FileError> {
        if self.is_forced {
            return Ok(());
        }
        let names = self.names().into_iter().filter(|name| family.has(name));
        let paths = names.map(|name| self.path.join(name));
        let paths: Vec<PathBuf> = paths.filter(|path| !is_ours(path)).collect();
        if paths.is_empty() {
            Ok(())
        } else {
            Err(FileError::Foreign { paths })
        }
    }

    /// The names of all items in the directory, in alphabetical order.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.collect();
        names.sort_unstable();
        names
    }

    /// Returns the names of files in the directory that were written by pfaff and do not belong to
    /// this family.
    #[must_use]
    pub fn others(&self, family: Family) -> Vec<String> {
        let mut names = self.names();
        names.retain(|name| !family.has(name) && is_marked(&self.path.join(name)));
        names
    }

    /// Starts a file. An older file with the same name is kept until the new file is finished.
    ///
    /// # Errors
    /// - [`FileError::Name`]: the name is empty or contains a directory.
    /// - [`FileError::Refused`]: the file cannot be created.
    pub fn file(&self, name: impl AsRef<OsStr>) -> Result<OutputFile, FileError> {
        let name = name.as_ref();
        let mut written = self.written();
        let file = self.begin(name)?;
        let content = Arc::downgrade(&file.content);
        written.begun.push((self.inner.join(name).into(), content));
        Ok(file)
    }

    /// Starts a temporary file. [`OutputFile::written`] reads the content of the file. The file is
    /// removed when it is dropped.
    ///
    /// # Errors
    /// Returns the same errors as [`OutputDirectory::file`].
    pub fn scratch(&self, name: &str) -> Result<OutputFile, FileError> {
        self.begin(name.as_ref())
    }

    /// Writes a complete file.
    ///
    /// # Errors
    /// Returns the same errors as [`OutputDirectory::file`] and [`OutputFile::finish`].
    pub fn write(&self, name: &str, content: &[u8]) -> Result<PathBuf, FileError> {
        let mut written = self.written();
        let path = self.put(name, content)?;
        written.finished.push(self.inner.join(name).into());
        Ok(path)
    }

    fn put(&self, name: &str, content: &[u8]) -> Result<PathBuf, FileError> {
        let mut file = self.begin(name.as_ref())?;
        file.put(content)?;
        file.finish()
    }

    /// Finishes these files, and removes other files of this family that belong to an earlier
    /// result; see [`Self::keep`]. All files are written before the first file is renamed, so that
    /// the earlier result remains if the disk is full.
    ///
    /// # Errors
    /// Returns the same errors as [`OutputFile::finish`] and [`Self::keep`].
    pub fn finish(&self, family: Family, files: Vec<OutputFile>) -> Result<Vec<String>, FileError> {
        for file in &files {
            file.flushed()?;
        }
        let mut names = Vec::with_capacity(files.len());
        for file in files {
            let path = file.finish()?;
            let name = path.file_name().and_then(OsStr::to_str);
            names.extend(name.map(str::to_owned));
        }
        self.keep(family, &names)
    }

    /// Removes the files of this family that are not in `files`, including unfinished files with
    /// the extension `.part`. These files belong to an earlier result and could be mistaken for a
    /// part of the new result. A file that was not written by pfaff is not removed. Returns the
    /// names of the removed files.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: a file cannot be removed.
    pub fn keep(
        &self,
        family: Family,
        files: &[impl AsRef<str>],
    ) -> Result<Vec<String>, FileError> {
        let mut removed = Vec::new();
        for name in self.names() {
            let (whole, is_part) = match name.strip_suffix(".part") {
                Some(whole) => (whole, true),
                None => (name.as_str(), false),
            };
            let path = self.path.join(&name);
            let is_kept = !is_part && files.iter().any(|file| file.as_ref() == whole);
            if is_kept
                || !family.has(whole)
                || !(is_part && ours::is_plain(&path) || is_marked(&path))
            {
                continue;
            }
            match fs::remove_file(&path) {
                Err(e) if e.kind() != ErrorKind::NotFound => {
                    return Err(FileError::refused("remove", &path)(e));
                }
                _ => removed.push(name),
            }
        }
        Ok(removed)
    }

    /// Ends all writing because the process will end. Open tables are truncated after the last
    /// complete line and get their final names. No file can be written afterwards. Returns false if
    /// no file had been started.
    pub fn abandon(&self) -> bool {
        self.abandon_with(|_| ())
    }

    /// Works like [`Self::abandon`]. In addition, the file `name` is written with this content,
    /// unless it has already been written. Files of the family that this process has not written
    /// are removed.
    pub fn abandon_as(&self, name: &str, content: &[u8], family: Family) -> bool {
        self.abandon_with(|written| {
            // The process ends even if this fails.
            if !written.has(name) {
                let _ = self.put(name, content);
            }
            let mut kept = written.names();
            kept.push(name);
            let _ = self.keep(family, &kept);
        })
    }

    fn abandon_with(&self, last: impl FnOnce(&WrittenFiles)) -> bool {
        let Some(written) = patiently(&self.written) else {
            return false;
        };
        if written.begun.is_empty() && written.finished.is_empty() {
            self.made.remove_empty();
            return false;
        }
        for (_, content) in &written.begun {
            let open = content.upgrade();
            if let Some(mut open) = open.as_deref().and_then(patiently) {
                open.abandon();
            }
        }
        last(&written);
        self.made.remove_empty();
        // Threads that write are blocked here until the process ends.
        mem::forget(written);
        true
    }

    fn written(&self) -> MutexGuard<'_, WrittenFiles> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns an error unless this is the name of a file in the directory.
    fn check_name(&self, name: &OsStr) -> Result<(), FileError> {
        let mut parts = Path::new(name).components();
        let plain = matches!(
            (parts.next(), parts.next()),
            (Some(Component::Normal(part)), None) if part == name
        );
        if plain {
            return Ok(());
        }
        Err(FileError::Name {
            name: name.to_string_lossy().into_owned(),
            directory: self.path.clone(),
        })
    }

    /// Creates the file with the extension `.part`.
    fn begin(&self, name: &OsStr) -> Result<OutputFile, FileError> {
        self.check_name(name)?;
        let path = self.path.join(name);
        let part = match self.parts {
            Parts::Plain => {
                let mut part = path.clone().into_os_string();
                part.push(".part");
                part.into()
            }
            Parts::Own => own_part(&path),
        };
        let file = new_file(&part).map_err(FileError::refused(MAKE, &part))?;
        Ok(OutputFile {
            content: Arc::new(Mutex::new(Content {
                buffer: Ok(BufWriter::new(file)),
                part,
                path,
                unfinished: self.unfinished,
                has_failed: Arc::clone(&self.has_failed),
            })),
        })
    }
}

/// Creates a file. An existing item with this name, including a link, is removed first. The file is
/// also readable, so that the last complete line can be found.
fn new_file(path: &Path) -> io::Result<File> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => return Err(e),
        _ => {}
    }
    let mut options = File::options();
    options.read(true).write(true).create_new(true).open(path)
}

/// Returns a name for an unfinished file. The name is different for each process and thread on
/// every machine.
pub(crate) fn own_part(path: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}-{count}.part", process::Process::own().name()));
    path.with_file_name(name)
}

/// Locks a mutex, if it becomes free within a short time.
fn patiently<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    let mut waited = Duration::ZERO;
    loop {
        match mutex.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(e)) => return Some(e.into_inner()),
            Err(TryLockError::WouldBlock) if waited >= PATIENCE => return None,
            Err(TryLockError::WouldBlock) => {
                sleep(PAUSE);
                waited += PAUSE;
            }
        }
    }
}

/// A file that is being written, with a buffer. Errors of write operations contain the path of the
/// file. The file is removed if this value is dropped before the file is finished.
#[derive(Debug)]
pub struct OutputFile {
    content: Arc<Mutex<Content>>,
}

/// The buffer of a file and its names.
#[derive(Debug)]
struct Content {
    /// The buffer, or the first error of the operating system. After an error no data are written,
    /// because the file would have a gap.
    buffer: Result<BufWriter<File>, io::Error>,
    part: PathBuf,
    path: PathBuf,
    unfinished: FailurePolicy,
    /// The flag `has_failed` of the directory.
    has_failed: Arc<AtomicBool>,
}

impl OutputFile {
    /// Writes the buffer and gives the file its final name.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the file could not be written completely and is still named
    ///   `.part`, or it could not be renamed.
    pub fn finish(self) -> Result<PathBuf, FileError> {
        self.flushed()?;
        self.content().rename()
    }

    /// Writes all of these bytes.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the bytes could not be written completely.
    pub fn put(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        let mut content = self.content();
        let put = content.with(|buffer| buffer.write_all(bytes));
        put.map_err(FileError::refused("write", &content.part))
    }

    fn flushed(&self) -> Result<(), FileError> {
        let mut content = self.content();
        let flushed = content.with(Write::flush);
        flushed.map_err(FileError::refused("write", &content.part))
    }

    /// Works like [`Self::finish`], for a run that stopped early. The written part gets the final
    /// name. If a write failed, the file ends after the last complete line. The summary of the run
    /// states that it is partial.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the end is missing, or the file could not be renamed.
    pub fn finish_partial(self) -> Result<PathBuf, FileError> {
        let mut content = self.content();
        let flushed = content.with(Write::flush);
        let flushed = flushed.map_err(FileError::refused("write the end of", &content.path));
        let renamed = content.rename();
        flushed.and(renamed)
    }

    /// Reads the content written so far.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the content could not be written completely, or cannot be read.
    pub fn written(&mut self) -> Result<File, FileError> {
        self.flushed()?;
        let part = self.part();
        File::open(&part).map_err(FileError::refused("read", &part))
    }

    /// Waits until the content written so far is on the disk, and not only in memory of the
    /// operating system.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the content could not be written completely.
    pub fn sync(&mut self) -> Result<(), FileError> {
        let mut content = self.content();
        let synced = content.with(|buffer| {
            buffer.flush()?;
            buffer.get_ref().sync_data()
        });
        synced.map_err(FileError::refused("write", &content.part))
    }

    fn part(&self) -> PathBuf {
        self.content().part.clone()
    }

    fn content(&self) -> MutexGuard<'_, Content> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Content {
    /// An unfinished file that is dropped is removed. After a failure or a panic it is not removed
    /// if a part of it is useful.
    fn drop(&mut self) {
        let fails = self.has_failed.load(Ordering::Relaxed) || std::thread::panicking();
        if fails && self.unfinished == FailurePolicy::Kept && self.with(Write::flush).is_ok() {
            self.close(ErrorKind::BrokenPipe.into());
        }
        self.remove();
    }
}

impl Content {
    /// Removes the file, if it is not finished.
    fn remove(&mut self) {
        let gone = Err(ErrorKind::BrokenPipe.into());
        let is_open = mem::replace(&mut self.buffer, gone).map(BufWriter::into_parts);
        if is_open.is_ok() || self.unfinished == FailurePolicy::Removed {
            drop(is_open);
            // A file that cannot be removed is still named `.part`.
            let _ = fs::remove_file(&self.part);
        }
    }

    fn rename(&mut self) -> Result<PathBuf, FileError> {
        // The file is closed before renaming, because some systems do not rename open files. A
        // failed flush is not repeated.
        let buffer = mem::replace(&mut self.buffer, Err(ErrorKind::BrokenPipe.into()));
        drop(buffer.map(BufWriter::into_parts));
        let renamed = fs::rename(&self.part, &self.path);
        let renamed = renamed.inspect_err(|_| self.has_failed.store(true, Ordering::Relaxed));
        renamed.map_err(FileError::refused("rename to", &self.path))?;
        Ok(self.path.clone())
    }

    /// Gives the file with its complete lines the final name, if the file is still being written
    /// and a part of the file is useful.
    fn abandon(&mut self) {
        if self.unfinished == FailurePolicy::Removed {
            self.remove();
        } else if self.with(Write::flush).is_ok() {
            self.close(ErrorKind::BrokenPipe.into());
            // If this fails, the file is still named `.part`, which is sufficient.
            let _ = fs::rename(&self.part, &self.path);
        }
    }

    /// Applies `action` to the buffer. After the first error, no more data are written.
    fn with<T>(
        &mut self,
        action: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
    ) -> io::Result<T> {
        let buffer = match &mut self.buffer {
            Ok(buffer) => buffer,
            Err(e) => return Err(again(e)),
        };
        let done = action(buffer);
        if let Err(e) = &done
            // Callers try interrupted writes again.
            && e.kind() != ErrorKind::Interrupted
        {
            self.has_failed.store(true, Ordering::Relaxed);
            self.close(again(e));
        }
        done
    }

    /// Removes the incomplete line after a failed write operation. Afterwards, no more data are
    /// written.
    fn close(&mut self, refusal: io::Error) {
        if let Ok(buffer) = mem::replace(&mut self.buffer, Err(refusal)) {
            let (mut file, _) = buffer.into_parts();
            // If this fails too, the file is still named `.part`, which is sufficient.
            let _ = end_of_last_line(&mut file).and_then(|end| file.set_len(end));
        }
    }

    fn named(&self, source: io::Error) -> io::Error {
        match source.kind() {
            ErrorKind::Interrupted => source,
            kind => io::Error::new(kind, FileError::refused("write", &self.part)(source)),
        }
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut content = self.content();
        let written = content.with(|buffer| buffer.write(bytes));
        written.map_err(|e| content.named(e))
    }

    fn flush(&mut self) -> io::Result<()> {
        let mut content = self.content();
        let flushed = content.with(Write::flush);
        flushed.map_err(|e| content.named(e))
    }
}

/// A copy of the error.
fn again(e: &io::Error) -> io::Error {
    let code = e.raw_os_error();
    code.map_or_else(|| e.kind().into(), io::Error::from_raw_os_error)
}

/// Position after the last complete line of a file.
fn end_of_last_line(file: &mut File) -> io::Result<u64> {
    let mut block = [0; 4096];
    let mut end = file.seek(SeekFrom::End(0))?;
    while end > 0 {
        let begin = end.saturating_sub(block.len() as u64);
        let block = &mut block[..(end - begin) as usize];
        file.seek(SeekFrom::Start(begin))?;
        file.read_exact(block)?;
        if let Some(k) = block.iter().rposition(|b| *b == b'\n') {
            return Ok(begin + k as u64 + 1);
        }
        end = begin;
    }
    Ok(0)
}
