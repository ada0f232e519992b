//! Bodies in the plane.

use joints::Plane;
use model::{Body, FramePose};
use serde_json::json;

use super::SceneBody;
use crate::dimension::Dimension;
use crate::key::{Interval, Key, Takes};
use crate::table::Table;
use crate::tolerance;

const MASS: Key = number("mass", "a number ≥ 0", Interval::NotNegative)
    .needed()
    .unit(Dimension::MASS)
    .doc("Mass");
const INERTIA: Key = number("inertia", "a number ≥ 0", Interval::NotNegative)
    .needed()
    .unit(Dimension::INERTIA)
    .doc("Moment of inertia about the centre of mass; 0 for a point mass");
const CENTRE: Key = Key::pair("centre")
    .unit(Dimension::LENGTH)
    .doc("Centre of mass [x, y] in the frame of the body; points of joints, `position` and `velocity` belong to the frame")
    .or(|| json!([0.0, 0.0]));
const POSITION: Key = Key::pair("position")
    .unit(Dimension::LENGTH)
    .doc("Origin [x, y] of the body's frame at the start: its centre of mass, unless `centre` states another point")
    .or(|| json!([0.0, 0.0]));
const VELOCITY: Key = Key::pair("velocity").unit(Dimension::VELOCITY).doc(
    "Velocity [vx, vy] of the origin of the body's frame at the start; it follows from given velocities and drives, with the least kinetic energy, if it is omitted",
);
const ANGLE: Key = number("angle", "a number", Interval::Any)
    .unit(Dimension::ANGLE)
    .doc("Angle of the body's frame at the start")
    .or(|| 0.0.into());
const TOLERANCE: Key = tolerance::length(
    "Tolerance of points and directions in the body's frame [default: tolerance of the scene]",
);
const ANGULAR_VELOCITY: Key = number("angular_velocity", "a number", Interval::Any)
    .unit(Dimension::ANGULAR_VELOCITY)
    .doc("Angular velocity at the start; it follows in the same way if it is omitted");
const START_KEYS: [Key; 2] = [
    Key::pair("position")
        .unit(Dimension::LENGTH)
        .doc("Origin [x, y] of the body's frame at the start"),
    number("angle", "a number", Interval::Any)
        .unit(Dimension::ANGLE)
        .doc("Angle of the body's frame at the start"),
];

/// Keys of a body, except its name.
const BODY_KEYS: [Key; 9] = [
    MASS,
    INERTIA,
    CENTRE,
    POSITION,
    ANGLE,
    Plane::START,
    VELOCITY,
    ANGULAR_VELOCITY,
    TOLERANCE,
];

/// Creates the key of a number.
const fn number(name: &'static str, expected: &'static str, range: Interval) -> Key {
    Key::optional(name, expected, Takes::Number(range))
}

impl SceneBody for Plane {
    const BODY_KEYS: &'static [Key] = &BODY_KEYS;
    const START: Key = Key::optional(
        "start",
        "a table { position, angle }",
        Takes::Table(&START_KEYS),
    )
    .doc("Start of the body if it differs from the described position: { position, angle } of its frame; an omitted value is as described. Points `at`, the positions that `fixed` joints and gears keep, free lengths and the zeros of measures still refer to the described start");

    fn read_start(start: &mut Table, body: &Body) -> FramePose {
        let [position, angle] = &START_KEYS;
        FramePose::Plane {
            position: start.vector::<Self>(position).unwrap_or(body.position),
            angle: start.number(angle).unwrap_or(body.angle),
        }
    }

    fn read_body(table: &mut Table, name: &str) -> Body {
        Body {
            name: name.to_owned(),
            mass: table.number(&MASS).unwrap_or_default(),
            inertia: table.number(&INERTIA).unwrap_or_default(),
            centre: table.vector::<Self>(&CENTRE).unwrap_or_default(),
            position: table.vector::<Self>(&POSITION).unwrap_or_default(),
            velocity: table.vector::<Self>(&VELOCITY),
            angle: table.number(&ANGLE).unwrap_or_default(),
            angular_velocity: table.number(&ANGULAR_VELOCITY),
            tolerance: tolerance::read(table, &TOLERANCE),
        }
    }
}
