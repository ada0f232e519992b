//! The origin of an answer: the machine, the program and its command line, and the time.

use std::ffi::OsStr;
use std::path::PathBuf;

use pfaff::report::Provenance;
use pfaff::work_precision::provenance::{date, machine};

/// Returns the machine, versions, date and command of the results.
#[must_use]
pub fn provenance() -> Provenance {
    Provenance {
        machine: machine(),
        versions: format!(
            "pfaff {}, {}",
            env!("CARGO_PKG_VERSION"),
            env!("PFAFF_COMPILER")
        ),
        date: date(),
        command: command(),
    }
}

/// Returns the command line without the directory of the program.
fn command() -> String {
    let mut arguments = std::env::args_os();
    let program = arguments.next().map(PathBuf::from).unwrap_or_default();
    let program = program.file_stem().map(OsStr::to_os_string);
    let words = program.into_iter().chain(arguments);
    let words: Vec<String> = words.map(|a| quoted(&a.to_string_lossy())).collect();
    words.join(" ")
}

/// Quotes a word of a command line in the syntax of a shell.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
