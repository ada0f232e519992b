//! Reads a scene file from the command line, or from standard input.

use std::io;
use std::path::Path;

use pfaff::model::{Registry, Tolerance};
use pfaff::scene::{KeyError, Setting};
use pfaff::source;
use pfaff::start::Start;

use crate::args::{SceneOptions, Settings};
use crate::console::Console;
use crate::output::Failure;
use crate::resources::Resources;

pub use pfaff::source::LARGEST;

/// The text of a scene, its name in messages, and the tolerances of the command line.
#[derive(Clone)]
pub(crate) struct Source<'r> {
    pub(crate) name: String,
    pub(crate) text: String,
    /// The load case whose values the text contains.
    case: Option<String>,
    /// Tolerance that takes precedence over the tolerance that the scene states.
    pub(crate) tolerance: Tolerance,
    /// The joints and forces that the scene may use.
    pub(crate) registry: &'r Registry,
}

impl<'r> Source<'r> {
    /// Reads a file, or standard input for `-`, and replaces values in the text.
    pub(crate) fn read(
        path: &Path,
        settings: &Settings,
        console: &Console<'r>,
    ) -> Result<Self, Failure> {
        let (name, text) = text_of(path)?;
        Ok(Self {
            name,
            text: with_settings(text, settings, console.registry)?,
            case: settings.case.clone(),
            tolerance: Tolerance::default(),
            registry: console.registry,
        })
    }

    /// Returns the same scene with this accuracy of its data.
    pub(crate) fn known(self, known: &SceneOptions) -> Self {
        Self {
            tolerance: known.into(),
            ..self
        }
    }

    /// Converts the scene to the subject of a question.
    pub(crate) fn start(self, resources: Resources) -> Start<'r> {
        let budget = resources.memory.budget();
        let mut start = Start::new(self.name, self.text, self.registry, budget);
        (start.tolerance, start.case) = (self.tolerance, self.case);
        start
    }
}

/// Reads the scene of a file, or of standard input for `-`.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub fn start<'r>(path: &Path, console: &Console<'r>) -> Result<Start<'r>, Failure> {
    let source = Source::read(path, &Settings::default(), console)?;
    Ok(source.start(Resources::default()))
}

/// Returns the name in messages and the text of a file, or of standard input for `-`.
pub(crate) fn text_of(path: &Path) -> Result<(String, String), Failure> {
    if path.as_os_str() == "-" {
        let name = "<stdin>".to_owned();
        let text = source::of_stream(&name, io::stdin())?;
        return Ok((name, text));
    }
    Ok(source::of_file(path)?)
}

/// Returns the text of a scene in which values are replaced, first by the values of the load case,
/// then by these values. A text that is not a scene remains unchanged, because the reader of scenes
/// reports the errors of the text.
fn with_settings(
    text: String,
    Settings { list, case }: &Settings,
    registry: &Registry,
) -> Result<String, Failure> {
    let text = match case {
        Some(case) => source::with_case(text, case, registry)?,
        None => text,
    };
    match Setting::replaced(&text, list) {
        Ok(replaced) => Ok(replaced),
        Err(KeyError::NotToml) => Ok(text),
        Err(e) => Err(Failure::input(format!("--set: {e}")).coded(e.code())),
    }
}

/// Builds the error for a file that cannot be read. The error suggests a scene in the same
/// directory with a similar name.
pub fn unreadable(path: &Path, e: &io::Error) -> Failure {
    source::unreadable(path, e).into()
}

/// Builds the error for an unknown name, with the most similar known name and a list of the known
/// names.
pub fn unknown(what: &str, name: &str, known: &[&str]) -> Failure {
    source::unknown(what, name, known).into()
}
