//! Converts the text of a scene to a mechanism with its independent rows.

use dynamics::{MotionError, MotionOptions, PreparedMechanism, RowChoice, prepare};
use model::Registry;

use crate::error::CodeError;

/// The text of a scene with its name, the registry of joints, and the rows to treat as dependent.
/// These rows replace the rows that the scene states.
pub(crate) struct SceneText<'a> {
    pub(crate) name: &'a str,
    pub(crate) text: &'a str,
    pub(crate) registry: &'a Registry,
    pub(crate) drop: Option<&'a [usize]>,
}

/// Returns the mechanism of a scene with its independent rows, and the run that the scene requests.
pub(crate) fn prepared(
    scene: &SceneText<'_>,
) -> Result<(PreparedMechanism, Option<MotionOptions>), CodeError> {
    let &SceneText {
        name,
        text,
        registry,
        drop,
    } = scene;
    let read = ::scene::read_and_build(name, text, registry);
    let (scene, mechanism) = read.map_err(CodeError::Scene)?;
    let located = |e: MotionError| match scene.locate_motion(&e) {
        Some(place) => CodeError::Scene(vec![place]),
        None => e.into(),
    };
    let mut options = scene.simulate.clone();
    let rows = match (drop, &options) {
        (Some(drop), _) => RowChoice::Drop(drop.to_vec()),
        (None, Some(options)) => options.rows.clone(),
        (None, None) => RowChoice::Automatic,
    };
    if let Some(options) = &mut options {
        options.rows.clone_from(&rows);
        options.check().map_err(located)?;
    }
    let prepared = prepare(mechanism, &scene.start, &rows).map_err(located)?;
    Ok((prepared, options))
}
