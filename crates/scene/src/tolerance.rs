//! `tolerance` and `angle_tolerance`: the uncertainty of the numbers in a scene.

use model::Tolerance;

use crate::dimension::Dimension;
use crate::key::{Interval, Key, Takes};
use crate::table::Table;

/// The key `tolerance` with this description.
pub(crate) const fn length(doc: &'static str) -> Key {
    positive("tolerance").unit(Dimension::LENGTH).doc(doc)
}

/// The key of a joint.
pub(crate) const OF_JOINT: Key = length(
    "Tolerance of the points, directions and numbers of the joint [default: tolerance of its bodies or of the scene]",
);
const OF_SCENE: Key =
    length("Tolerance of points and lengths whose joint or body states none [default: rounding]");
const ANGLE: Key = positive("angle_tolerance")
    .unit(Dimension::ANGLE)
    .doc("Tolerance of directions, angles and ratios [default: `tolerance` divided by the size of the mechanism]");

/// The keys of `[scene]`.
pub(crate) const SCENE_KEYS: [Key; 2] = [OF_SCENE, ANGLE];

const fn positive(name: &'static str) -> Key {
    Key::optional(name, "a number > 0", Takes::Number(Interval::Positive))
}

/// Reads a tolerance, if it is given. The sign is checked when the mechanism is built.
pub(crate) fn read(table: &mut Table, key: &Key) -> Option<f64> {
    let field = table.optional(key)?;
    field.number_expected(key.expected, key.unit)
}

/// Reads the tolerances of `[scene]`.
pub(crate) fn of_scene(table: &mut Table) -> Tolerance {
    Tolerance {
        length: read(table, &OF_SCENE),
        angle: read(table, &ANGLE),
    }
}
