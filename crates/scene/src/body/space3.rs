//! Bodies in space.

use joints::Space3;
use model::{FramePose, SpatialBody};
use serde_json::json;

use super::{SceneBody, orientation};
use crate::dimension::Dimension;
use crate::field::Field;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::table::Table;
use crate::tolerance;

const MASS: Key = Key::required("mass", "a number ≥ 0", Takes::Number(Interval::NotNegative))
    .unit(Dimension::MASS)
    .doc("Mass");
const INERTIA: Key = Key::required(
    "inertia",
    "moments of inertia [Jxx, Jyy, Jzz], or a symmetric matrix",
    Takes::Tensor,
)
.unit(Dimension::INERTIA)
.doc("Inertia about the centre of mass in the axes of the body: [Jxx, Jyy, Jzz], or the symmetric 3 × 3 matrix; Jxy is its entry, −∫xy dm");
const CENTRE: Key = Key::triple("centre")
    .unit(Dimension::LENGTH)
    .doc("Centre of mass [x, y, z] in the frame of the body; points of joints, `position` and `velocity` belong to the frame")
    .or(|| json!([0.0, 0.0, 0.0]));
const POSITION: Key = Key::triple("position")
    .unit(Dimension::LENGTH)
    .doc("Origin [x, y, z] of the body's frame at the start: its centre of mass, unless `centre` states another point")
    .or(|| json!([0.0, 0.0, 0.0]));
const VELOCITY: Key = Key::triple("velocity").unit(Dimension::VELOCITY).doc(
    "Velocity [vx, vy, vz] of the origin of the body's frame at the start, ground axes; it follows from given velocities and drives, with the least kinetic energy, if it is omitted",
);
const ANGULAR_VELOCITY: Key = Key::triple("angular_velocity")
    .unit(Dimension::ANGULAR_VELOCITY)
    .doc("Angular velocity [wx, wy, wz] at the start, ground axes; it follows in the same way if it is omitted");
const TOLERANCE: Key = tolerance::length(
    "Tolerance of points and directions in the body's frame [default: tolerance of the scene]",
);
const START_KEYS: [Key; 2] = [
    Key::triple("position")
        .unit(Dimension::LENGTH)
        .doc("Origin [x, y, z] of the body's frame at the start"),
    orientation::ORIENTATION
        .doc("Orientation of the body's frame at the start, in any of the ways of `orientation`"),
];

impl SceneBody for Space3 {
    const BODY_KEYS: &'static [Key] = &[
        MASS,
        INERTIA,
        CENTRE,
        POSITION,
        orientation::ORIENTATION,
        Self::START,
        VELOCITY,
        ANGULAR_VELOCITY,
        TOLERANCE,
    ];

    const START: Key = Key::optional(
        "start",
        "a table { position, orientation }",
        Takes::Table(&START_KEYS),
    )
    .doc("Start of the body if it differs from the described position: { position, orientation } of its frame; an omitted value is as described. Points `at`, the positions that `fixed` joints and gears keep, free lengths and the zeros of measures still refer to the described start");

    fn read_start(start: &mut Table, body: &SpatialBody) -> FramePose {
        let [position, orientation] = &START_KEYS;
        let turned = start.of_key(orientation);
        FramePose::Space3 {
            position: start.vector::<Self>(position).unwrap_or(body.position),
            orientation: turned
                .and_then(|field| orientation::read(&field))
                .unwrap_or(body.orientation),
        }
    }

    fn read_body(table: &mut Table, name: &str) -> SpatialBody {
        let mass = table.number(&MASS).unwrap_or_default();
        let inertia = table.of_key(&INERTIA).and_then(|field| tensor(&field));
        let orientation = table.of_key(&orientation::ORIENTATION);
        let orientation = orientation.and_then(|field| orientation::read(&field));
        SpatialBody {
            centre: table.vector::<Self>(&CENTRE).unwrap_or_default(),
            position: table.vector::<Self>(&POSITION).unwrap_or_default(),
            orientation: orientation.unwrap_or([1.0, 0.0, 0.0, 0.0]),
            velocity: table.vector::<Self>(&VELOCITY),
            angular_velocity: table.vector::<Self>(&ANGULAR_VELOCITY),
            tolerance: tolerance::read(table, &TOLERANCE),
            ..SpatialBody::new(name, mass, inertia.unwrap_or_default())
        }
    }
}

/// Reads three principal moments, or a symmetric matrix.
fn tensor(field: &Field) -> Option<[[f64; 3]; 3]> {
    let items = field.items(INERTIA.expected)?;
    if items.iter().any(|row| row.value.get_ref().is_array()) {
        return field.matrix(INERTIA.expected, INERTIA.unit);
    }
    // The value is not read with `vector`, because here a list of another length does not indicate
    // a scene in the plane.
    let moments = field.numbers(3, INERTIA.expected, |_| INERTIA.unit)?;
    let [x, y, z]: [f64; 3] = moments.try_into().ok()?;
    for (moment, item) in [x, y, z].iter().zip(&items) {
        if *moment < 0.0 {
            item.error(
                Mistake::OutOfRange,
                format!(": `{}` has the moment {moment}", field.key),
                "may not be negative",
            );
            return None;
        }
    }
    Some([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
}
