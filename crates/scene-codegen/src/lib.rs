#![doc = include_str!("../README.md")]

mod eliminate;
mod equations;
mod error;
mod frame;
mod functions;
mod module;
mod sampled;
mod script;
mod subject;
mod support;
mod tape;
mod time;

pub use error::CodeError;
pub use module::{Choices, Module, generate};
pub use script::to_out_dir;
pub use subject::{State, Subject};
pub use tape::Tape;

use std::path::Path;

use pfaff::{AssembledScene, Overrides};

/// The module of a scene file: made for the run that the scene asks for, or for its start if it
/// asks for none. Rows `drop`, from 0, are dropped instead of those that the scene drops.
///
/// # Errors
/// If the file cannot be read, the scene is wrong or its run stops, or there is no code for it.
pub fn scene(path: &Path, drop: Option<&[usize]>, choices: &Choices) -> Result<Module, CodeError> {
    let text = std::fs::read_to_string(path).map_err(|source| CodeError::File {
        path: path.display().to_string(),
        source,
    })?;
    scene_text(&path.display().to_string(), &text, drop, choices)
}

/// The same from the text of a scene; `name` is the file's name in messages.
///
/// # Errors
/// As [`scene`].
pub fn scene_text(
    name: &str,
    text: &str,
    drop: Option<&[usize]>,
    choices: &Choices,
) -> Result<Module, CodeError> {
    let overrides = Overrides {
        drop: drop.map(<[usize]>::to_vec),
        ..Overrides::default()
    };
    let study =
        AssembledScene::read(name, text, &pfaff::model::Registry::planar())?.prepare(&overrides)?;
    let subject = match &study.options {
        Some(options) => Subject::of_run(&study.prepared, options)?,
        None => Subject::at_start(&study.prepared),
    };
    generate(&subject, choices)
}

#[cfg(test)]
mod tests;
