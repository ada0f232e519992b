//! Why there is no answer, as the command and other programs for people say it: in words, with the
//! lines of a scene at fault, or as one document.

use std::borrow::Cow;

use ariadne::{Color, Config, IndexType, Label, Report, ReportKind, Source};
use model::codes::Code;
use report::documents::RefusalDocument;
use report::write_json;
use scene::{Diagnostic, Severity};
use serde::Serialize;

use crate::error::StudyError;

/// The reason why there is no answer.
#[derive(Clone, Debug)]
pub enum Refusal {
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
}

impl Refusal {
    /// Wrong input; the message states how to correct it.
    #[must_use]
    pub fn input(message: String) -> Self {
        Self::Input(const { Code::new(1) }, message)
    }

    /// A computation that stopped, with the reason.
    #[must_use]
    pub fn stopped(message: String) -> Self {
        Self::Stopped(const { Code::new(9) }, message)
    }

    /// An error of a scene with this name and text, in which its places are.
    ///
    /// ```
    /// use pfaff::Study;
    /// use pfaff::model::Registry;
    /// use pfaff::refusal::Refusal;
    ///
    /// let text = "[scene]\nname = \"stone\"\nspace = \"plane\"\n[[body]]\nname = \"stone\"\nmas = 1.0\ninertia = 1.0\n";
    /// let error = Study::read("stone.toml", text, &Registry::standard(), &Default::default());
    /// let refusal = Refusal::of(("stone.toml", text), error.err().unwrap());
    /// assert!(refusal.words(false).contains("stone.toml:6:1"));
    /// ```
    #[must_use]
    pub fn of((name, text): (&str, &str), error: StudyError) -> Self {
        let code = error.code();
        let refusal = match error {
            StudyError::SingularStart {
                place: Some(diagnostic),
                ..
            } => Self::of((name, text), StudyError::Scene(vec![*diagnostic])),
            StudyError::Scene(diagnostics) => Self::Scene {
                name: name.to_owned(),
                text: text.to_owned(),
                diagnostics,
            },
            other if other.is_input() => Self::input(other.to_string()),
            other => Self::stopped(other.to_string()),
        };
        refusal.coded(code)
    }

    /// The same with another code; those of a scene have codes of their own.
    #[must_use]
    pub fn coded(self, code: Code) -> Self {
        match self {
            Self::Input(_, message) => Self::Input(code, message),
            Self::Stopped(_, message) => Self::Stopped(code, message),
            other @ Self::Scene { .. } => other,
        }
    }

    /// Its code; a scene without errors has none.
    #[must_use]
    pub fn code(&self) -> Option<Code> {
        match self {
            Self::Scene { diagnostics, .. } => diagnostics.first().map(|d| d.code),
            Self::Input(code, _) | Self::Stopped(code, _) => Some(*code),
        }
    }

    /// The errors of the scene, if it is one.
    #[must_use]
    pub fn problems(&self) -> &[Diagnostic] {
        match self {
            Self::Scene { diagnostics, .. } => diagnostics,
            Self::Input(..) | Self::Stopped(..) => &[],
        }
    }

    /// The refusal in words, with colours for a terminal or without.
    #[must_use]
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
        }
    }

    /// The refusal as a document: `error` is one line, `problems` are the wrong places of a scene,
    /// if there are any.
    #[must_use]
    pub fn document(&self) -> RefusalDocument<'_, Diagnostic> {
        let error = match self {
            Self::Scene { diagnostics, .. } => in_one_line(diagnostics),
            Self::Input(_, message) | Self::Stopped(_, message) => message.clone(),
        };
        RefusalDocument {
            ok: false,
            code: self.code(),
            error,
            problems: self.problems(),
        }
    }
}

impl From<import::Refusal> for Refusal {
    /// The refusal of a file of another format.
    fn from(refusal: import::Refusal) -> Self {
        Self::Scene {
            name: refusal.file,
            text: refusal.text,
            diagnostics: refusal.diagnostics,
        }
    }
}

/// A document as text, as the command writes it.
///
/// # Errors
/// If it cannot be written.
pub fn json(document: &impl Serialize) -> Result<String, Refusal> {
    let mut out = Vec::new();
    write_json(&mut out, document).map_err(|e| Refusal::stopped(e.to_string()))?;
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

fn label<'a>(name: &'a str, l: &scene::Label) -> Label<(&'a str, std::ops::Range<usize>)> {
    let label = Label::new((name, l.span.clone()));
    if l.text.is_empty() {
        label
    } else {
        label.with_message(visible(&l.text))
    }
}
