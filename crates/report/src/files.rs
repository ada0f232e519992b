//! Files of an output directory. Each is written beside its place as `<name>.part` and renamed when it is finished: a
//! file with its own name is always a whole one. What is abandoned keeps the name `.part` and what was written so far.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};

/// Why a file cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system refused.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Refused {
        /// What was tried.
        action: &'static str,
        /// On which path.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// A name that is no plain file name would leave the directory.
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
    /// Opens a directory, and makes it where there is none.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: it cannot be made, for instance because a file has its name.
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

    /// Begins a file; an older one of the same name stays until this one is finished.
    ///
    /// # Errors
    /// - [`FileError::Name`]: the name is empty or has a directory in it.
    /// - [`FileError::Refused`]: the file cannot be made.
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
        let file = File::create(&part).map_err(FileError::refused("make", &part))?;
        Ok(OutputFile {
            buffer: BufWriter::new(file),
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
        file.buffer
            .write_all(content)
            .map_err(FileError::refused("write", &file.part))?;
        file.finish()
    }
}

/// A file that is being written, buffered. Errors of writing name its path.
#[derive(Debug)]
pub struct OutputFile {
    buffer: BufWriter<File>,
    part: PathBuf,
    path: PathBuf,
}

impl OutputFile {
    /// Writes what is buffered and gives the file its name.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: not everything could be written, and the file stays `.part`; or it could not be renamed.
    pub fn finish(mut self) -> Result<PathBuf, FileError> {
        let flushed = self.buffer.flush();
        flushed.map_err(FileError::refused("write", &self.part))?;
        self.rename()
    }

    /// The same for a run that stopped early: what reached the disk gets its name, even if the rest could not be
    /// written. The summary of the run says that it is partial.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: the end is missing, or the file could not be renamed.
    pub fn finish_partial(mut self) -> Result<PathBuf, FileError> {
        let flushed = self.buffer.flush();
        let flushed = flushed.map_err(FileError::refused("write the end of", &self.path));
        let renamed = self.rename();
        flushed.and(renamed)
    }

    /// Waits until what was written so far is on the disk, not only with the operating system.
    ///
    /// # Errors
    /// - [`FileError::Refused`]: not everything could be written.
    pub fn sync(&mut self) -> Result<(), FileError> {
        let synced = self
            .buffer
            .flush()
            .and_then(|()| self.buffer.get_ref().sync_data());
        synced.map_err(FileError::refused("write", &self.part))
    }

    fn rename(self) -> Result<PathBuf, FileError> {
        let Self { buffer, part, path } = self;
        // Closed first: some systems do not rename open files. What could not be flushed is not tried again.
        drop(buffer.into_parts());
        fs::rename(&part, &path).map_err(FileError::refused("rename to", &path))?;
        Ok(path)
    }

    fn named(&self, source: io::Error) -> io::Error {
        let kind = source.kind();
        io::Error::new(kind, FileError::refused("write", &self.part)(source))
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.write(bytes).map_err(|e| match e.kind() {
            // Callers try again.
            io::ErrorKind::Interrupted => e,
            _ => self.named(e),
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.buffer.flush().map_err(|e| self.named(e))
    }
}
