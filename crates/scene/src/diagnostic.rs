//! Problems of a file, as data. The command prints them with colours and source lines.

use std::fmt;
use std::ops::Range;

use model::codes::Code;
use serde::Serialize;

use crate::text::SourceText;

/// Severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Severity {
    /// The program cannot use the scene.
    Error,
    /// The scene is valid, but it is probably not what the author intended.
    Warning,
    /// A message about other problems: it gives the number of problems that are not listed.
    Note,
}

/// A marked part of the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Label {
    /// Range in the text (bytes).
    pub span: Range<usize>,
    /// Line of the start (1-based).
    pub line: usize,
    /// Column of the start in characters (1-based).
    pub column: usize,
    /// Text shown at the mark.
    pub text: String,
}

/// One problem with its positions in the text.
///
/// `Display` writes the problem in one line, `file:line:column: error: message`, which is the usual
/// format of compilers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Diagnostic {
    /// Severity of the problem.
    pub severity: Severity,
    /// Code of the problem.
    pub code: Code,
    /// Name of the file.
    pub file: String,
    /// The error, with the actual and the expected entry.
    pub message: String,
    /// Position of the error.
    pub primary: Label,
    /// Other relevant positions, for example the first use of a name.
    pub secondary: Vec<Label>,
    /// Advice, if any.
    pub help: Option<String>,
}

impl Diagnostic {
    /// Creates an error with one position.
    #[must_use]
    pub fn error(
        code: impl Into<Code>,
        source: &SourceText,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Self {
        Self {
            severity: Severity::Error,
            code: code.into(),
            file: source.name().to_owned(),
            message: message.into(),
            primary: source.label(span, label),
            secondary: Vec::new(),
            help: None,
        }
    }

    /// Returns the problem as one sentence with its line and advice, for reports that do not
    /// contain the text of the scene.
    #[must_use]
    pub fn sentence(&self) -> String {
        let help = self.help.as_ref().map(|help| format!("; {help}"));
        let (line, help) = (self.primary.line, help.unwrap_or_default());
        format!("line {line}: {}{help}", self.message)
    }

    /// Adds another position.
    #[must_use]
    pub fn and(mut self, label: Label) -> Self {
        self.secondary.push(label);
        self
    }

    /// Adds advice, if there is any.
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
