#![doc = include_str!("../README.md")]

mod assembled;
mod axes;
mod eliminate;
mod equations;
mod error;
mod frame;
mod functions;
mod inputs;
#[cfg(feature = "modules")]
mod module;
mod parameters;
mod sampled;
#[cfg(feature = "modules")]
mod script;
mod subject;
#[cfg(feature = "modules")]
mod support;
mod tape;
#[cfg(feature = "modules")]
mod time;

pub use error::{CodeError, NotAnInput};
#[cfg(feature = "modules")]
pub use module::{Choices, Module, generate};
#[cfg(feature = "modules")]
pub use script::to_out_dir;
pub use subject::{State, Subject};
pub use tape::{LANES, Tape, TapeCall};

#[cfg(feature = "modules")]
use std::path::Path;

use model::Registry;

use assembled::{SceneText, prepared};

/// Generates the module of a scene file for the run that the scene requests. If the scene requests
/// no run, the module is generated for the initial state. The rows `drop` (0-based) are treated as
/// dependent and replace the rows that the scene states.
///
/// # Errors
/// Returns an error if the file cannot be read, the scene contains errors, its run stops, or no
/// code can be generated for it.
#[cfg(feature = "modules")]
pub fn scene(
    path: &Path,
    registry: &Registry,
    drop: Option<&[usize]>,
    choices: &Choices,
) -> Result<Module, CodeError> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|source| CodeError::File {
        path: name.clone(),
        source,
    })?;
    scene_text(&name, &text, registry, drop, choices)
}

/// Works like [`scene()`], but with the text of a scene; `name` is the name of the file in
/// messages, and `registry` contains the joints and forces that are permitted in the scene.
///
/// # Errors
/// Returns the same errors as [`scene()`].
#[cfg(feature = "modules")]
pub fn scene_text(
    name: &str,
    text: &str,
    registry: &Registry,
    drop: Option<&[usize]>,
    choices: &Choices,
) -> Result<Module, CodeError> {
    let scene = SceneText {
        name,
        text,
        registry,
        drop,
    };
    with_subject(&scene, &choices.inputs, |subject| {
        module::of_subject(subject, choices)
    })
}

/// The code of a scene as a list of operations, with the same content as the module of
/// [`scene_text`].
///
/// # Errors
/// Returns the same errors as [`scene_text`].
pub fn scene_tape(
    name: &str,
    text: &str,
    registry: &Registry,
    inputs: &[String],
) -> Result<Tape, CodeError> {
    let scene = SceneText {
        name,
        text,
        registry,
        drop: None,
    };
    with_subject(&scene, inputs, Tape::of)
}

/// Calls a function with the subject of a scene. The subject contains the states of the run that
/// the scene requests, or the initial state if there is no run. The numbers of these keys are
/// inputs of the subject.
fn with_subject<R>(
    scene: &SceneText<'_>,
    inputs: &[String],
    then: impl FnOnce(&Subject<'_>) -> Result<R, CodeError>,
) -> Result<R, CodeError> {
    let (prepared, options) = prepared(scene)?;
    let subject = match &options {
        Some(options) => Subject::of_run(&prepared, options)?,
        None => Subject::at_start(&prepared),
    };
    if inputs.is_empty() {
        return then(&subject);
    }
    then(&inputs::vary(scene, inputs, subject)?)
}

#[cfg(test)]
mod tests;
