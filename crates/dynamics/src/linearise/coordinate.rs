//! Coordinates of the frames of bodies: translations and rotations.

use model::words::listed;
use model::{Mechanism, SpaceKind};

use super::error::LineariseError;

/// Number of directions in which the frame of a body moves: three translations and three rotations.
pub(crate) const BODY: usize = 6;

/// A coordinate of the frame of a body, or its velocity.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Coordinate {
    /// Name of the coordinate: `body.x`, or `body.vx`.
    pub name: String,
    /// Unit of the coordinate.
    pub unit: &'static str,
    pub(crate) body: usize,
    /// Index of the direction along the axes of the ground: first three translations, then three
    /// rotations.
    pub(crate) direction: usize,
}

impl Coordinate {
    /// Returns the row in the matrix of all frames.
    pub(crate) fn row(&self) -> usize {
        frame_row(self.body, self.direction)
    }
}

/// Returns the names of the directions of a frame. In the plane only three of them exist.
fn names(space: SpaceKind) -> [[&'static str; 2]; BODY] {
    match space {
        SpaceKind::Space3 => [
            ["x", "vx"],
            ["y", "vy"],
            ["z", "vz"],
            ["rx", "wx"],
            ["ry", "wy"],
            ["rz", "wz"],
        ],
        _ => [
            ["x", "vx"],
            ["y", "vy"],
            ["", ""],
            ["", ""],
            ["", ""],
            ["angle", "omega"],
        ],
    }
}

/// Returns the coordinate for a direction of a body, as a position or as a velocity.
pub(crate) fn coordinate(
    mechanism: &Mechanism,
    body: usize,
    direction: usize,
    is_velocity: bool,
) -> Coordinate {
    let name = names(mechanism.space())[direction][usize::from(is_velocity)];
    let unit = match (direction < 3, is_velocity) {
        (true, false) => "m",
        (true, true) => "m/s",
        (false, false) => "rad",
        (false, true) => "rad/s",
    };
    Coordinate {
        name: format!("{}.{name}", mechanism.bodies()[body].name),
        unit,
        body,
        direction,
    }
}

/// Returns the coordinate with a given name, either of the position or of the velocity.
pub(crate) fn named(
    mechanism: &Mechanism,
    name: &str,
) -> Result<(Coordinate, bool), LineariseError> {
    let refused = |hint: String| LineariseError::Coordinate {
        name: name.to_owned(),
        hint,
    };
    let known = names(mechanism.space());
    let parts = || known.iter().flatten().filter(|part| !part.is_empty());
    let Some((body, part)) = name.rsplit_once('.') else {
        let some = parts().next().copied().unwrap_or_default();
        return Err(refused(format!(
            "need a body and a coordinate, as `body.{some}`"
        )));
    };
    let Some(at) = mechanism.bodies().iter().position(|b| b.name == body) else {
        let bodies: Vec<_> = mechanism.bodies().iter().map(|b| &b.name).collect();
        let bodies = listed(&bodies);
        return Err(refused(format!("there is no body `{body}`, but {bodies}")));
    };
    let found = known
        .iter()
        .position(|own| !part.is_empty() && own.contains(&part));
    let Some(direction) = found else {
        let parts: Vec<_> = parts().collect();
        return Err(refused(format!("a body has {}", listed(&parts))));
    };
    let is_velocity = known[direction][1] == part;
    Ok((
        coordinate(mechanism, at, direction, is_velocity),
        is_velocity,
    ))
}

/// Returns the row of a direction of a body in the matrix of all frames. The first three directions
/// are translations, and the other three are rotations.
pub(crate) fn frame_row(body: usize, direction: usize) -> usize {
    BODY * body + direction
}
