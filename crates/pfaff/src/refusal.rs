//! The reason why there is no answer, in the form in which the command and other programs report
//! it. The form is a document, or a text that contains the lines of the scene with the error.

#[cfg(feature = "messages")]
mod render;

use std::borrow::Cow;

use crate::documents::RefusalDocument;
use model::codes::Code;
use report::{FileError, PngError, TableError, write_json};
use scene::Diagnostic;
use serde::Serialize;

use crate::error::StudyError;
use crate::sweep::SweepError;

/// The reason why there is no answer.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// The scene contains errors.
    Scene {
        /// The name of the scene in messages.
        name: String,
        /// Text of the scene.
        text: String,
        /// The errors, with their positions in the text.
        diagnostics: Vec<Diagnostic>,
    },
    /// Another input is wrong.
    Input(Code, String),
    /// The computation stopped.
    Stopped(Code, String),
}

impl Refusal {
    /// Creates a refusal of wrong input. The message states how to correct the input.
    #[must_use]
    pub fn input(message: String) -> Self {
        Self::Input(const { Code::new(1) }, message)
    }

    /// Creates a refusal for a computation that stopped, with the reason.
    #[must_use]
    pub fn stopped(message: String) -> Self {
        Self::Stopped(const { Code::new(9) }, message)
    }

    /// Converts an error of a scene with this name and this text. The positions of the error refer
    /// to the text.
    ///
    /// ```
    /// use pfaff::Study;
    /// use pfaff::model::Registry;
    /// use pfaff::refusal::Refusal;
    ///
    /// let text = "[scene]\nname = \"stone\"\nspace = \"plane\"\n[[body]]\nname = \"stone\"\nmas = 1.0\ninertia = 1.0\n";
    /// let error = Study::read("stone.toml", text, &Registry::standard(), &Default::default());
    /// let refusal = Refusal::of(("stone.toml", text), error.err().unwrap());
    /// assert!(refusal.document().error.contains("stone.toml:6:1"), "{:?}", refusal.document().error);
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

    /// Returns the same refusal with another code. Errors of a scene keep their own codes.
    #[must_use]
    pub fn coded(self, code: Code) -> Self {
        match self {
            Self::Input(_, message) => Self::Input(code, message),
            Self::Stopped(_, message) => Self::Stopped(code, message),
            other @ Self::Scene { .. } => other,
        }
    }

    /// Returns the code of the refusal. A refused scene without errors has no code.
    #[must_use]
    pub fn code(&self) -> Option<Code> {
        match self {
            Self::Scene { diagnostics, .. } => diagnostics.first().map(|d| d.code),
            Self::Input(code, _) | Self::Stopped(code, _) => Some(*code),
        }
    }

    /// Returns the errors of the scene, if the refusal is about a scene.
    #[must_use]
    pub fn problems(&self) -> &[Diagnostic] {
        match self {
            Self::Scene { diagnostics, .. } => diagnostics,
            Self::Input(..) | Self::Stopped(..) => &[],
        }
    }

    /// Returns the refusal as text, with colours for a terminal or without colours.
    #[cfg(feature = "messages")]
    #[must_use]
    pub fn words(&self, color: bool) -> String {
        match self {
            Self::Scene {
                name,
                text,
                diagnostics,
            } => render::render(&visible(name), &visible(text), diagnostics, color),
            Self::Input(code, message) | Self::Stopped(code, message) => {
                format!("error[{code}]: {}\n", visible(message))
            }
        }
    }

    /// Returns the refusal as a document. `error` is one line. `problems` contains the positions of
    /// errors in a scene, if there are any.
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
    /// Converts the refusal of a file of another format.
    fn from(refusal: import::Refusal) -> Self {
        Self::Scene {
            name: refusal.file,
            text: refusal.text,
            diagnostics: refusal.diagnostics,
        }
    }
}

impl From<FileError> for Refusal {
    /// Converts the error of a file that was not written. The cause is the path, or a failed write
    /// operation.
    fn from(error: FileError) -> Self {
        let refusal = if error.is_place() {
            Self::input(error.to_string())
        } else {
            Self::stopped(error.to_string())
        };
        refusal.coded(error.code())
    }
}

impl From<TableError> for Refusal {
    fn from(error: TableError) -> Self {
        Self::stopped(error.to_string()).coded(error.code())
    }
}

impl From<PngError> for Refusal {
    fn from(error: PngError) -> Self {
        match error {
            PngError::Figure { .. } | PngError::Packing { .. } => Self::stopped(error.to_string()),
            _ => Self::input(error.to_string()),
        }
    }
}

impl From<SweepError> for Refusal {
    fn from(error: SweepError) -> Self {
        let refusal = if error.is_input() {
            Self::input(error.to_string())
        } else {
            Self::stopped(error.to_string())
        };
        refusal.coded(error.code())
    }
}

/// Returns a document as text, in the form in which the command writes it.
///
/// # Errors
/// Returns an error if the document cannot be written.
pub fn json(document: &impl Serialize) -> Result<String, Refusal> {
    let mut out = Vec::new();
    write_json(&mut out, document).map_err(|e| Refusal::stopped(e.to_string()))?;
    Ok(String::from_utf8_lossy(&out).into_owned())
}

/// Returns the first problem, and the number of the other problems.
fn in_one_line(diagnostics: &[Diagnostic]) -> String {
    match diagnostics {
        [] => String::new(),
        [only] => only.to_string(),
        [first, more @ ..] => format!("{first} (and {} more)", more.len()),
    }
}

/// Returns a text without characters that a terminal interprets and does not show. These are
/// control characters and characters that change the direction of writing. Each of these characters
/// is replaced by a character of the same length, so that positions in the text remain valid.
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
