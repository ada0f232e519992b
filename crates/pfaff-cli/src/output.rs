//! The form of answers and failures; the console decides where they are written.

use std::ffi::OsString;
use std::path::Path;

use pfaff::model::codes::Code;
use pfaff::refusal;
use pfaff::report::documents::RefusalDocument;
use pfaff::report::{FileError, OutputDirectory};
use serde::Serialize;

pub use pfaff::refusal::{Refusal, visible};

/// The form of an answer.
#[derive(Clone, Copy)]
pub enum Answer {
    /// Words for people.
    Words,
    /// One JSON document for programs, without other output.
    Json,
}

impl Answer {
    /// The form that the words of a command line ask for which cannot be parsed.
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
    /// The computation stopped or was interrupted; its partial results have been written already.
    Incomplete,
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl Failure {
    /// A failure because of wrong input; the message states how to correct it.
    pub fn input(message: String) -> Self {
        Refusal::input(message).into()
    }

    /// A computation that stopped, with the reason.
    pub fn stopped(message: String) -> Self {
        Refusal::stopped(message).into()
    }

    /// The same failure with another code.
    #[must_use]
    pub fn coded(self, code: Code) -> Self {
        match self {
            Self::Refused(refusal) => refusal.coded(code).into(),
            other => other,
        }
    }

    /// Its code, if there is something to report.
    pub fn code(&self) -> Option<Code> {
        match self {
            Self::Refused(refusal) => refusal.code(),
            Self::Closed | Self::Incomplete => None,
        }
    }

    /// The failure in words.
    pub fn words(&self, color: bool) -> String {
        match self {
            Self::Refused(refusal) => refusal.words(color),
            Self::Closed | Self::Incomplete => String::new(),
        }
    }

    /// The failure as a document: `error` is one line, `problems` are the wrong places of a scene,
    /// if there are any.
    ///
    /// # Errors
    /// As [`json`].
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

/// A directory for the results of one command: other processes are excluded from it. Files with
/// these names that pfaff has not written are replaced only with `force`.
///
/// # Errors
/// If it is not a place for results.
pub fn directory(
    path: &Path,
    names: &[impl AsRef<str>],
    force: bool,
) -> Result<OutputDirectory, Failure> {
    let opened = OutputDirectory::create(path).and_then(OutputDirectory::exclusive);
    let directory = opened.map_err(|e| unwritten(&e))?;
    if !force {
        directory.check_ours(names).map_err(|e| unwritten(&e))?;
    }
    Ok(directory)
}

/// A file that was not written: because of its place, or because writing failed.
pub fn unwritten(error: &FileError) -> Failure {
    let failure = if error.is_place() {
        Failure::input(error.to_string())
    } else {
        Failure::stopped(error.to_string())
    };
    failure.coded(error.code())
}

/// A document as text.
///
/// # Errors
/// If it cannot be written.
pub fn json(document: &impl Serialize) -> Result<String, Failure> {
    Ok(refusal::json(document)?)
}

/// A number with its noun, as `1 body` or `7 bodies`.
pub fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// Width of texts for people (characters).
const WIDTH: usize = 100;

/// Breaks a text into lines of at most 100 characters, if its words are short enough; the first
/// line begins with `lead`, the others are indented by its width.
pub fn wrapped(lead: &str, text: &str) -> String {
    let indent = " ".repeat(lead.chars().count());
    let (mut out, mut line) = (String::new(), lead.to_owned());
    let mut is_empty = true;
    for word in text.split_whitespace() {
        let width = line.chars().count() + word.chars().count();
        if !is_empty && width >= WIDTH {
            out.push_str(line.trim_end());
            out.push('\n');
            line.clone_from(&indent);
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    out.push_str(line.trim_end());
    out.push('\n');
    out
}

/// Aligns lines of cells in columns; the first line is the header.
pub fn columns(rows: &[Vec<String>]) -> String {
    let n = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |k: usize| {
        rows.iter()
            .filter_map(|r| r.get(k))
            .map(|c| c.chars().count())
            .max()
    };
    let widths: Vec<usize> = (0..n).map(|k| width(k).unwrap_or(0)).collect();
    let mut out = String::new();
    for row in rows {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, &w)| format!("{cell:<w$}"))
            .collect();
        out.push_str(cells.join("  ").trim_end());
        out.push('\n');
    }
    out
}
