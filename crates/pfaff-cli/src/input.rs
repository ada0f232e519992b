//! A scene file from the command line, or standard input.

use std::io;
use std::path::Path;

use pfaff::model::{Registry, Tolerance};
use pfaff::scene::{KeyError, Template, nearest};
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
    /// Takes precedence over the tolerance that the scene states.
    pub(crate) tolerance: Tolerance,
    /// The joints and forces that the scene may use.
    pub(crate) registry: &'r Registry,
}

impl<'r> Source<'r> {
    /// Reads a file, or standard input for `-`, with other numbers in it.
    pub(crate) fn read(
        path: &Path,
        settings: &Settings,
        console: &Console<'r>,
    ) -> Result<Self, Failure> {
        let (name, text) = text_of(path)?;
        Ok(Self {
            name,
            text: with_settings(text, settings)?,
            tolerance: Tolerance::default(),
            registry: console.registry,
        })
    }

    /// The same scene with numbers known to this.
    pub(crate) fn known(self, known: &SceneOptions) -> Self {
        Self {
            tolerance: known.into(),
            ..self
        }
    }

    /// The same as the subject of a question.
    pub(crate) fn start(self, resources: Resources) -> Start<'r> {
        let budget = resources.memory.budget();
        let mut start = Start::new(self.name, self.text, self.registry, budget);
        start.tolerance = self.tolerance;
        start
    }
}

/// The scene of a file, or of standard input for `-`.
///
/// # Errors
/// The file cannot be read.
pub fn start<'r>(path: &Path, console: &Console<'r>) -> Result<Start<'r>, Failure> {
    let source = Source::read(path, &Settings::default(), console)?;
    Ok(source.start(Resources::default()))
}

/// The name in messages and the text of a file, or of standard input for `-`.
pub(crate) fn text_of(path: &Path) -> Result<(String, String), Failure> {
    if path.as_os_str() == "-" {
        let name = "<stdin>".to_owned();
        let text = source::of_stream(&name, io::stdin())?;
        return Ok((name, text));
    }
    Ok(source::of_file(path)?)
}

/// The text of a scene with other numbers in it. One that is not TOML stays as it is: its reader
/// says what is wrong.
fn with_settings(text: String, Settings { list }: &Settings) -> Result<String, Failure> {
    if list.is_empty() {
        return Ok(text);
    }
    let keys: Vec<&str> = list.iter().map(|set| set.key.as_str()).collect();
    let template = match Template::new(&text, &keys) {
        Ok(template) => template,
        Err(KeyError::NotToml) => return Ok(text),
        Err(e) => return Err(Failure::input(format!("--set: {e}")).coded(e.code())),
    };
    let expressions: Vec<&str> = list.iter().map(|set| set.expression.as_str()).collect();
    Ok(template.with_expressions(&expressions))
}

/// A file that cannot be read, with the scene in its directory that was probably meant.
pub fn unreadable(path: &Path, e: &io::Error) -> Failure {
    source::unreadable(path, e).into()
}

/// The error for an unknown name, with the name that was probably meant and the known names.
pub fn unknown(what: &str, name: &str, known: &[&str]) -> Failure {
    let near = nearest(name, known.iter().copied());
    let advice = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    Failure::input(format!(
        "there is no {what} `{name}`; there are: {}{advice}",
        known.join(", ")
    ))
}
