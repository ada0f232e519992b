//! Prints the problems of a scene with its lines and carets.

use ariadne::{Color, Config, IndexType, Label, Report, ReportKind, Source};
use scene::{Diagnostic, Severity};

use super::visible;

/// Largest number of problems that are shown. Further problems are counted.
const SHOWN: usize = 50;

/// Prints the problems of a scene with its lines and carets.
pub(super) fn render(name: &str, text: &str, diagnostics: &[Diagnostic], color: bool) -> String {
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
    // If some problems are not listed, the last problem states their number.
    let is_listed = diagnostics.iter().all(|d| d.severity != Severity::Note);
    if diagnostics.len() > SHOWN {
        // The last problem may be only the number of unlisted problems.
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

/// Removes colour codes from a text, because the library always colours some kinds of text.
fn uncoloured(text: &str) -> String {
    let mut pieces = text.split('\u{1b}');
    let first = pieces.next().unwrap_or_default().to_owned();
    pieces.fold(first, |all, piece| {
        all + piece.split_once('m').map_or(piece, |(_, rest)| rest)
    })
}

/// Length of the longest line (bytes) that is shown completely.
const WIDEST: usize = 2000;

/// Bytes of a longer line that are shown on each side of a position.
const AROUND: usize = 40;

/// Returns the line that contains a position.
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
