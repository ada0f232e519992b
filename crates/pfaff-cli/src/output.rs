//! The form of answers and failures; the console decides where they are written.

use std::borrow::Cow;
use std::ffi::OsString;
use std::path::Path;

use ariadne::{Color, Config, IndexType, Label, Report, ReportKind, Source};
use pfaff::model::codes::Code;
use pfaff::report::documents::RefusalDocument;
use pfaff::report::{FileError, OutputDirectory, write_json};
use pfaff::scene::{Diagnostic, Severity};
use serde::Serialize;

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
    /// The scene contains errors.
    Scene {
        /// The name of the scene in messages.
        name: String,
        /// Its text.
        text: String,
        /// The errors, with places in the text.
        diagnostics: Vec<Diagnostic>,
    },
    /// Another input is wrong.
    Input(Code, String),
    /// The computation stopped.
    Stopped(Code, String),
    /// The reader has closed the output.
    Closed,
    /// The computation stopped or was interrupted; its partial results have been written already.
    Incomplete,
}

impl Failure {
    /// A failure because of wrong input; the message states how to correct it.
    pub fn input(message: String) -> Self {
        Self::Input(const { Code::new(1) }, message)
    }

    /// A computation that stopped, with the reason.
    pub fn stopped(message: String) -> Self {
        Self::Stopped(const { Code::new(9) }, message)
    }

    /// The same failure with another code.
    #[must_use]
    pub fn coded(self, code: Code) -> Self {
        match self {
            Self::Input(_, message) => Self::Input(code, message),
            Self::Stopped(_, message) => Self::Stopped(code, message),
            other => other,
        }
    }

    /// Its code, if there is something to report.
    pub fn code(&self) -> Option<Code> {
        match self {
            Self::Scene { diagnostics, .. } => diagnostics.first().map(|d| d.code),
            Self::Input(code, _) | Self::Stopped(code, _) => Some(*code),
            Self::Closed | Self::Incomplete => None,
        }
    }

    /// The failure in words.
    pub fn words(&self, color: bool) -> String {
        match self {
            Self::Scene {
                name,
                text,
                diagnostics,
            } => render(&visible(name), &visible(text), diagnostics, color),
            Self::Input(code, message) | Self::Stopped(code, message) => {
                format!("error[{code}]: {}\n", visible(message))
            }
            Self::Closed | Self::Incomplete => String::new(),
        }
    }

    /// The failure as a document: `error` is one line, `problems` are the wrong places of a scene,
    /// if there are any.
    ///
    /// # Errors
    /// As [`json`].
    pub fn document(&self) -> Result<String, Self> {
        let (error, problems) = match self {
            Self::Scene { diagnostics, .. } => (in_one_line(diagnostics), diagnostics.as_slice()),
            Self::Input(_, message) | Self::Stopped(_, message) => (message.clone(), [].as_slice()),
            Self::Closed | Self::Incomplete => (String::new(), [].as_slice()),
        };
        json(&RefusalDocument {
            ok: false,
            code: self.code(),
            error,
            problems,
        })
    }
}

/// A directory for the results of one command: other processes are excluded from it. Files with
/// these names that pfaff has not written are replaced only with `force`.
///
/// # Errors
/// If it is not a place for results.
pub fn directory(path: &Path, names: &[&str], force: bool) -> Result<OutputDirectory, Failure> {
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
    let mut out = Vec::new();
    write_json(&mut out, document).map_err(|e| Failure::stopped(e.to_string()))?;
    Ok(String::from_utf8_lossy(&out).into_owned())
}

/// The first problem, and the number of others.
fn in_one_line(diagnostics: &[Diagnostic]) -> String {
    match diagnostics {
        [] => String::new(),
        [only] => only.to_string(),
        [first, more @ ..] => format!("{first} (and {} more)", more.len()),
    }
}

/// A number with its noun, as `1 body` or `7 bodies`.
pub fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// A text without characters that a terminal obeys instead of showing them: control characters and
/// those that change the direction of writing. Each is replaced by one of the same length, so that
/// places in the text stay the same.
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    let is_obeyed = |c: char| {
        (c.is_control() && !matches!(c, '\n' | '\t'))
            || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.chars().any(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let shown = |c: char| match (is_obeyed(c), c.len_utf8()) {
        (false, _) => c,
        (true, 1) if c == '\r' => ' ',
        (true, 1) => '?',
        (true, 2) => '¿',
        (true, _) => '\u{fffd}',
    };
    Cow::Owned(text.chars().map(shown).collect())
}

/// Largest number of problems that are shown; the others are counted.
const SHOWN: usize = 50;

/// Problems of a scene with its lines and carets.
fn render(name: &str, text: &str, diagnostics: &[Diagnostic], color: bool) -> String {
    let mut out = Vec::new();
    // The positions of the lines are computed once for all problems.
    let mut source = (name, Source::from(text));
    for d in &diagnostics[..diagnostics.len().min(SHOWN)] {
        let labels = || std::iter::once(&d.primary).chain(&d.secondary);
        if labels().any(|label| line_around(text, label.span.start).len() > WIDEST) {
            out.extend(narrow(text, d).bytes());
            continue;
        }
        let (word, tint) = match d.severity {
            Severity::Warning => ("warning", Color::Yellow),
            Severity::Note => ("note", Color::Blue),
            _ => ("error", Color::Red),
        };
        let kind = format!("{word}[{}]", d.code);
        let kind = ReportKind::Custom(&kind, tint);
        let config = Config::default()
            .with_color(color)
            .with_index_type(IndexType::Byte);
        let mut report = Report::build(kind, (name, d.primary.span.clone()))
            .with_config(config)
            .with_message(visible(&d.message))
            .with_label(label(name, &d.primary).with_color(tint));
        for other in &d.secondary {
            report = report.with_label(label(name, other).with_color(Color::Blue));
        }
        if let Some(help) = &d.help {
            report = report.with_help(visible(help));
        }
        let written = report.finish().write(&mut source, &mut out);
        if written.is_err() {
            out.extend(format!("{}\n", visible(&d.to_string())).bytes());
        }
    }
    let mut rendered = String::from_utf8_lossy(&out).into_owned();
    if !color {
        rendered = uncoloured(&rendered);
    }
    // If some problems are not listed, the last one states how many.
    let is_listed = diagnostics.iter().all(|d| d.severity != Severity::Note);
    if diagnostics.len() > SHOWN {
        // The last one may be the number of more.
        let (more, listed) = if is_listed {
            ("", diagnostics.len())
        } else {
            ("more than ", diagnostics.len() - 1)
        };
        rendered.push_str(&format!(
            "the first {SHOWN} of {more}{listed} problems in `{name}`; `--json` lists more\n"
        ));
    } else if diagnostics.len() > 1 && is_listed {
        rendered.push_str(&format!("{} problems in `{name}`\n", diagnostics.len()));
    }
    rendered
}

/// A text without codes of colours: kinds with a code of their own are coloured in any case.
fn uncoloured(text: &str) -> String {
    let mut pieces = text.split('\u{1b}');
    let first = pieces.next().unwrap_or_default().to_owned();
    pieces.fold(first, |all, piece| {
        all + piece.split_once('m').map_or(piece, |(_, rest)| rest)
    })
}

/// Length of the longest line (bytes) that is shown completely.
const WIDEST: usize = 2000;

/// Bytes of a longer line that are shown on each side of a place.
const AROUND: usize = 40;

/// The line that contains a place.
fn line_around(text: &str, at: usize) -> &str {
    let at = text.floor_char_boundary(at);
    let (before, after) = text.split_at(at);
    let begin = before.rfind('\n').map_or(0, |k| k + 1);
    let end = after.find('\n').map_or(text.len(), |k| at + k);
    &text[begin..end]
}

/// Shows a problem in a line that is too long to be shown completely.
fn narrow(text: &str, d: &Diagnostic) -> String {
    let mut out = format!("{d}\n");
    for label in std::iter::once(&d.primary).chain(&d.secondary) {
        let begin = text.floor_char_boundary(label.span.start.saturating_sub(AROUND));
        let end = text.ceil_char_boundary(label.span.start.saturating_add(AROUND));
        let excerpt = text.get(begin..end).unwrap_or_default();
        let (line, column) = (label.line, label.column);
        let excerpt = excerpt.escape_debug();
        out.push_str(&format!(
            "  line {line}, column {column}: … {excerpt} …  {}\n",
            label.text
        ));
    }
    if let Some(help) = &d.help {
        out.push_str(&format!("  help: {help}\n"));
    }
    out
}

fn label<'a>(name: &'a str, l: &pfaff::scene::Label) -> Label<(&'a str, std::ops::Range<usize>)> {
    let label = Label::new((name, l.span.clone()));
    if l.text.is_empty() {
        label
    } else {
        label.with_message(visible(&l.text))
    }
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
