//! Writes the files that are derived from the list of questions: the JSON schema of each answer,
//! the methods of the Python package, and the tables of options in the book.
//! `cargo xtask questions` runs it; with `--check` it compares the existing files.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod book;
mod option;
mod python;
mod question;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs};

use question::questions;

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the paths, relative to the root, and the texts of all files that are derived from the
/// list.
fn files() -> Result<Vec<(String, String)>, String> {
    let questions = questions();
    let mut files = Vec::new();
    for question in &questions {
        let folder = question.name.replace('-', "_");
        let path = format!("crates/pfaff/src/questions/{folder}/answer.schema.json");
        let text = serde_json::to_string_pretty(&question.answer).map_err(|e| e.to_string())?;
        files.push((path, text + "\n"));
    }
    files.push((python::PATH.to_owned(), python::module(&questions)));
    let book = fs::read_to_string(root().join(book::PATH));
    let book = book.map_err(|e| format!("{}: {e}", book::PATH))?;
    files.push((book::PATH.to_owned(), book::with_tables(&book, &questions)?));
    Ok(files)
}

/// Writes the files.
fn write() -> Result<String, String> {
    let files = files()?;
    for (path, text) in &files {
        fs::write(root().join(path), text).map_err(|e| format!("{path}: {e}"))?;
    }
    Ok(format!("{} files written", files.len()))
}

/// Compares the files.
fn check() -> Result<String, String> {
    let files = files()?;
    for (path, text) in &files {
        let found = fs::read_to_string(root().join(path)).map_err(|e| format!("{path}: {e}"))?;
        let found = found.replace("\r\n", "\n");
        if found != *text {
            let same = found.lines().zip(text.lines()).take_while(|(a, b)| a == b);
            let line = same.count() + 1;
            return Err(format!(
                "{path}:{line}: differs from the list of questions; `cargo xtask questions` writes the file again"
            ));
        }
    }
    Ok(format!(
        "{} files follow from the list of questions",
        files.len()
    ))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let outcome = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => write(),
        ["--check"] => check(),
        _ => Err("usage: cargo xtask questions [--check]".to_owned()),
    };
    match outcome {
        Ok(done) => {
            println!("{done}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn everything_follows_from_the_list_of_questions() {
        if let Err(message) = super::check() {
            panic!("{message}");
        }
    }
}
