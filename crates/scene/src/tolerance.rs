//! `tolerance` and `angle_tolerance`: the uncertainty of the numbers of a scene.

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
    "What the points, directions and numbers of the joint are known to; that of its bodies, or of the scene, where it is not given",
);
const OF_SCENE: Key = length(
    "What points and lengths are known to where their joint or body says nothing; their rounding where it is not given",
);
const ANGLE: Key = positive("angle_tolerance")
    .unit(Dimension::ANGLE)
    .doc("What directions, angles and ratios are known to; `tolerance` divided by the size of the mechanism where it is not given");

/// The keys of `[scene]`.
pub(crate) const SCENE_KEYS: [Key; 2] = [OF_SCENE, ANGLE];

const fn positive(name: &'static str) -> Key {
    Key::optional(name, "a number > 0", Takes::Number(Interval::Positive))
}

/// Reads a tolerance, if it is given. Its sign is checked with the mechanism.
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
