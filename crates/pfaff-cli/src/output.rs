//! The form of answers and failures. The console writes them.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use pfaff::documents::RefusalDocument;
use pfaff::model::codes::Code;
use pfaff::question::{INTERRUPTED, NOTHING_WRITTEN};
use pfaff::refusal;
use pfaff::report::{Family, FileError, OutputDirectory, OutputFile, PngError, Replaces};
use serde::Serialize;

use crate::interrupt::Interrupt;

pub use pfaff::refusal::{Refusal, visible};
pub use pfaff::words::{count, wrapped};

/// The form of an answer.
#[derive(Clone, Copy)]
pub enum Answer {
    /// Text for a reader.
    Words,
    /// One JSON document for programs, without other output.
    Json,
}

impl Answer {
    /// Returns the form of the answer that an invalid command line requests.
    pub fn asked_by(words: &[OsString]) -> Self {
        let mut options = words.iter().take_while(|word| *word != "--");
        if options.any(|word| word == "--json") {
            Self::Json
        } else {
            Self::Words
        }
    }
}

/// The result of a command.
pub type Outcome = Result<(), Failure>;

/// The reason why a command did not finish.
pub enum Failure {
    /// There is no answer.
    Refused(Refusal),
    /// The reader has closed the output.
    Closed,
    /// The computation stopped or was interrupted. Its partial results have already been written.
    Incomplete,
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Refusal::from(error).into()
    }
}

impl From<PngError> for Failure {
    fn from(error: PngError) -> Self {
        Refusal::from(error).into()
    }
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl Failure {
    /// Creates a failure because of invalid input. The message states how to correct the input.
    pub fn input(message: String) -> Self {
        Refusal::input(message).into()
    }

    /// Creates a failure of a computation that stopped, with the reason.
    pub fn stopped(message: String) -> Self {
        Refusal::stopped(message).into()
    }

    /// Returns the same failure with another code.
    #[must_use]
    pub fn coded(self, code: Code) -> Self {
        match self {
            Self::Refused(refusal) => refusal.coded(code).into(),
            other => other,
        }
    }

    /// Returns the code of the failure, if there is an error to report.
    pub fn code(&self) -> Option<Code> {
        match self {
            Self::Refused(refusal) => refusal.code(),
            Self::Closed | Self::Incomplete => None,
        }
    }

    /// Returns the failure as text.
    pub fn words(&self, color: bool) -> String {
        match self {
            Self::Refused(refusal) => refusal.words(color),
            Self::Closed | Self::Incomplete => String::new(),
        }
    }

    /// Returns the failure as a document: `error` is one line; `problems` contains the positions of
    /// errors in a scene, if there are any.
    ///
    /// # Errors
    /// Returns the errors of [`json`].
    pub fn document(&self) -> Result<String, Self> {
        match self {
            Self::Refused(refusal) => json(&refusal.document()),
            Self::Closed | Self::Incomplete => json(&RefusalDocument {
                ok: false,
                code: None,
                error: String::new(),
                problems: &[(); 0],
            }),
        }
    }
}

/// The files of an answer. All files receive their final names together. If a request to stop comes
/// earlier, no file remains.
pub(crate) struct Files {
    directory: OutputDirectory,
    family: Family,
    files: Vec<OutputFile>,
    interrupt: Interrupt,
}

impl Files {
    pub(crate) fn of(directory: &OutputDirectory, family: Family) -> Result<Self, Failure> {
        let directory = directory.clone().whole();
        let ended = directory.clone();
        let interrupt = Interrupt::listen_with(move || {
            ended.abandon();
            NOTHING_WRITTEN.to_owned()
        })?;
        Ok(Self {
            directory,
            family,
            files: Vec::new(),
            interrupt,
        })
    }

    /// Writes a file under a temporary name in its directory.
    pub(crate) fn put(&mut self, name: impl AsRef<OsStr>, content: &[u8]) -> Result<(), FileError> {
        let mut file = self.directory.file(name)?;
        file.put(content)?;
        self.files.push(file);
        Ok(())
    }

    /// Gives all files their final names, and removes the files of an earlier answer. Returns a
    /// text about the files of other commands in the directory.
    pub(crate) fn finish(self) -> Result<String, Failure> {
        if self.interrupt.is_asked() {
            return Err(Failure::stopped(NOTHING_WRITTEN.to_owned()).coded(INTERRUPTED));
        }
        let finished = self.directory.finish(self.family, self.files);
        finished?;
        Ok(beside(&self.directory, self.family))
    }
}

/// Which existing files a scene may replace.
pub(crate) fn replaces(force: bool) -> Replaces {
    if force {
        Replaces::Files
    } else {
        Replaces::Nothing
    }
}

/// The family of a file that is the only file of its command.
const SINGLE: Family = Family(&[]);

/// Writes a single file under a temporary name in its directory, and renames it.
pub(crate) fn write_file(path: &Path, content: &[u8], replaces: Replaces) -> Outcome {
    let around = OutputDirectory::around(path, replaces)?;
    let mut files = Files::of(&around, SINGLE)?;
    files.put(path.file_name().unwrap_or_default(), content)?;
    files.finish().map(drop)
}

/// Returns a sentence about the files of other commands in a directory. The text is empty if there
/// are no such files.
pub(crate) fn beside(directory: &OutputDirectory, family: Family) -> String {
    if family == SINGLE {
        return String::new();
    }
    let others = directory.others(family);
    if others.is_empty() {
        return String::new();
    }
    let named = others.iter().map(|name| format!("`{name}`"));
    let named: Vec<String> = named.collect();
    wrapped(
        "",
        &format!(
            "the directory also contains files of other commands: {}",
            named.join(", ")
        ),
    )
}

/// Returns a document as text.
///
/// # Errors
/// Returns an error if the document cannot be written.
pub fn json(document: &impl Serialize) -> Result<String, Failure> {
    Ok(refusal::json(document)?)
}
