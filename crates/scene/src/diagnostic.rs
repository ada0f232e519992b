//! What is wrong with a file, as data. Rendering with colours and source lines is the command's
//! business.

use std::fmt;
use std::ops::Range;

use serde::Serialize;

use crate::text::SourceText;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Severity {
    /// The scene cannot be used.
    Error,
    /// The scene can be used, but is probably not what was meant.
    Warning,
    /// No problem of its own: how many more there are.
    Note,
}

/// A marked part of the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Label {
    /// Bytes of the text.
    pub span: Range<usize>,
    /// Line of its beginning, from 1.
    pub line: usize,
    /// Column of its beginning, from 1, in characters.
    pub column: usize,
    /// What to say about it.
    pub text: String,
}

/// One problem with its places.
///
/// `Display` writes it in one line, `file:line:column: error: message`, as compilers do.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// Name of the file.
    pub file: String,
    /// What was found and what was expected.
    pub message: String,
    /// The place at fault.
    pub primary: Label,
    /// Other places that matter, for example the first use of a name.
    pub secondary: Vec<Label>,
    /// What to do, where known.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error with one place.
    #[must_use]
    pub fn error(
        source: &SourceText,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Self {
        Self {
            severity: Severity::Error,
            file: source.name().to_owned(),
            message: message.into(),
            primary: source.label(span, label),
            secondary: Vec::new(),
            help: None,
        }
    }

    /// The same with one more place.
    #[must_use]
    pub fn and(mut self, label: Label) -> Self {
        self.secondary.push(label);
        self
    }

    /// The same with advice, if there is any.
    #[must_use]
    pub fn help(mut self, help: impl Into<Option<String>>) -> Self {
        self.help = help.into();
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            primary: Label { line, column, .. },
            message,
            ..
        } = self;
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        write!(f, "{file}:{line}:{column}: {severity}: {message}")
    }
}

impl std::error::Error for Diagnostic {}
