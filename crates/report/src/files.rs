//! Files of an output directory. Each is written next to its final place as `<name>.part` and
//! renamed when it is finished: a file with its final name is always complete. An abandoned file
//! keeps the name `.part` and what has been written so far. If writing fails, it is cut off after
//! the last complete line; an older file with the final name stays unchanged.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::mem;
use std::path::{Component, Path, PathBuf};

/// Reason why a file cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system reported an error.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Refused {
        /// The operation that failed.
        action: &'static str,
        /// Its path.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A name that is not a plain file name would leave the directory.
    #[error("`{name}` is not the name of a file inside `{}`: leave out directories", directory.display())]
    Name {
        /// The name.
        name: String,
        /// The directory.
        directory: PathBuf,
    },
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
}

/// A directory for results.
#[derive(Clone, Debug)]
pub struct OutputDirectory {
    path: PathBuf,
}

impl OutputDirectory {
    /// Opens a directory, and creates it if there is none.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: it cannot be created, for instance because a file has its name.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        fs::create_dir_all(&path).map_err(FileError::refused("make the directory", &path))?;
        Ok(Self { path })
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Begins a file; an older file with the same name is kept until this one is finished.
    ///
    /// # Errors
    /// - [`FileError::Name`]: the name is empty or has a directory in it.
    /// - [`FileError::Refused`]: the file cannot be created.
    pub fn file(&self, name: &str) -> Result<OutputFile, FileError> {
        let mut parts = Path::new(name).components();
        let plain = matches!(
            (parts.next(), parts.next()),
            (Some(Component::Normal(part)), None) if part == name
        );
        if !plain {
            return Err(FileError::Name {
                name: name.to_owned(),
                directory: self.path.clone(),
            });
        }
        let part = self.path.join(format!("{name}.part"));
        let mut options = File::options();
        // Readable as well, to find the last complete line.
        let options = options.read(true).write(true).create(true).truncate(true);
        let file = options
            .open(&part)
            .map_err(FileError::refused("make", &part))?;
        Ok(OutputFile {
            buffer: Ok(BufWriter::new(file)),
            part,
            path: self.path.join(name),
        })
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// As [`OutputDirectory::file`] and [`OutputFile::finish`].
    pub fn write(&self, name: &str, content: &[u8]) -> Result<PathBuf, FileError> {
        let mut file = self.file(name)?;
        let written = file.with(|buffer| buffer.write_all(content));
        written.map_err(FileError::refused("write", &file.part))?;
        file.finish()
    }
}

/// A file that is being written, buffered. Errors of writing name its path.
#[derive(Debug)]
pub struct OutputFile {
    /// The first error of the operating system, if any: later writes would leave a gap.
    buffer: Result<BufWriter<File>, io::Error>,
    part: PathBuf,
    path: PathBuf,
}

impl OutputFile {
    /// Writes the buffer and gives the file its final name.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: not everything could be written, and the file keeps the name
    ///   `.part`; or it could not be renamed.
    pub fn finish(mut self) -> Result<PathBuf, FileError> {
        let flushed = self.with(Write::flush);
        flushed.map_err(FileError::refused("write", &self.part))?;
        self.rename()
    }

    /// Like [`Self::finish`], for a run that stopped early: the part that has been written gets the
    /// final name, up to the last complete line if the rest could not be written. The summary of
    /// the run says that it is partial.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the end is missing, or the file could not be renamed.
    pub fn finish_partial(mut self) -> Result<PathBuf, FileError> {
        let flushed = self.with(Write::flush);
        let flushed = flushed.map_err(FileError::refused("write the end of", &self.path));
        let renamed = self.rename();
        flushed.and(renamed)
    }

    /// Waits until everything written so far is on the disk, not only passed to the operating
    /// system.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: not everything could be written.
    pub fn sync(&mut self) -> Result<(), FileError> {
        let synced = self.with(|buffer| {
            buffer.flush()?;
            buffer.get_ref().sync_data()
        });
        synced.map_err(FileError::refused("write", &self.part))
    }

    fn rename(self) -> Result<PathBuf, FileError> {
        let Self { buffer, part, path } = self;
        // Closed before renaming, because some systems do not rename open files. A failed flush is
        // not tried again.
        drop(buffer.map(BufWriter::into_parts));
        fs::rename(&part, &path).map_err(FileError::refused("rename to", &path))?;
        Ok(path)
    }

    /// Applies `f` to the buffer; after the first error nothing is written any more.
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
            self.close(again(e));
        }
        done
    }

    /// Cuts off the incomplete line that a failed write has left, and writes no more.
    fn close(&mut self, refusal: io::Error) {
        if let Ok(buffer) = mem::replace(&mut self.buffer, Err(refusal)) {
            let (mut file, _) = buffer.into_parts();
            // If this fails too, the name `.part` is sufficient.
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
        let written = self.with(|buffer| buffer.write(bytes));
        written.map_err(|e| self.named(e))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.with(Write::flush);
        flushed.map_err(|e| self.named(e))
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
