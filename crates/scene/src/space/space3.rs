//! Scenes in space.

use joints::space3::Pose;
use joints::{Argument, Space3};
use model::start::KeepLevel;
use model::{AnyDescription, Definitions, Registry, SpatialBody, SpatialDescription};
use serde_json::json;

use super::{SceneSpace, orientation};
use crate::dimension::Dimension;
use crate::field::Field;
use crate::findings::Findings;
use crate::key::{Interval, Key, Takes};
use crate::marker;
use crate::mistake::Mistake;
use crate::start::Kept;
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
    .doc("Origin [x, y, z] of the body's frame at the start: its centre of mass, unless `centre` says otherwise")
    .or(|| json!([0.0, 0.0, 0.0]));
const VELOCITY: Key = Key::triple("velocity").unit(Dimension::VELOCITY).doc(
    "Velocity [vx, vy, vz] of the origin of the body's frame at the start, ground axes; it follows from what is given and driven, with the least kinetic energy, where it is left out",
);
const ANGULAR_VELOCITY: Key = Key::triple("angular_velocity")
    .unit(Dimension::ANGULAR_VELOCITY)
    .doc("Angular velocity [wx, wy, wz] at the start, ground axes; it follows in the same way where it is left out");
const TOLERANCE: Key = tolerance::length(
    "What points and directions in the body's frame are known to; that of the scene where it is not given",
);
const GRAVITY: Key = Key::triple("gravity")
    .expecting("an acceleration [gx, gy, gz]")
    .unit(Dimension::ACCELERATION)
    .doc("Acceleration of free bodies [gx, gy, gz]")
    .or(|| json!([0.0, 0.0, 0.0]));

impl SceneSpace for Space3 {
    const NAME: &'static str = "spatial";
    const VECTOR: &'static str = "[x, y, z]";
    const POINT: &'static str = "a point [x, y, z]";
    const GLOBAL_POINT: &'static str = "a global point [x, y, z]";
    const BY_BODY: &'static str = "a table { body = [x, y, z], … }";
    const GRAVITY: Key = GRAVITY;
    const BODY_KEYS: &'static [Key] = &[
        MASS,
        INERTIA,
        CENTRE,
        POSITION,
        orientation::ORIENTATION,
        VELOCITY,
        ANGULAR_VELOCITY,
        TOLERANCE,
    ];
    const MARKER_KEYS: &'static [Key] = &marker::SPACE_KEYS;
    const KEPT: &'static [Kept] = &[
        Kept::new("x", 0..1, KeepLevel::Position),
        Kept::new("y", 1..2, KeepLevel::Position),
        Kept::new("z", 2..3, KeepLevel::Position),
        Kept::new("rotation", 3..6, KeepLevel::Position),
        Kept::new("vx", 0..1, KeepLevel::Velocity),
        Kept::new("vy", 1..2, KeepLevel::Velocity),
        Kept::new("vz", 2..3, KeepLevel::Velocity),
        Kept::new("omega", 3..6, KeepLevel::Velocity),
    ];

    const CARRIES: bool = true;

    fn described(d: SpatialDescription) -> AnyDescription {
        d.into()
    }

    fn definitions(registry: &Registry) -> &Definitions<Self> {
        registry.space()
    }

    fn read_body(table: &mut Table, name: &str, findings: &mut Findings) -> SpatialBody {
        let mass = table.required(&MASS, findings);
        let mass = mass.and_then(|field| field.number(MASS.unit, findings));
        let inertia = table.required(&INERTIA, findings);
        let inertia = inertia.and_then(|field| tensor(&field, findings));
        let orientation = table.optional(&orientation::ORIENTATION);
        let orientation = orientation.and_then(|field| orientation::read(&field, findings));
        let mut vector = |key: &Key| {
            table
                .optional(key)
                .and_then(|field| field.vector::<Self>(key.expected, key.unit, findings))
        };
        SpatialBody {
            centre: vector(&CENTRE).unwrap_or_default(),
            position: vector(&POSITION).unwrap_or_default(),
            orientation: orientation.unwrap_or([1.0, 0.0, 0.0, 0.0]),
            velocity: vector(&VELOCITY),
            angular_velocity: vector(&ANGULAR_VELOCITY),
            tolerance: tolerance::read(table, &TOLERANCE, findings),
            ..SpatialBody::new(name, mass.unwrap_or_default(), inertia.unwrap_or_default())
        }
    }

    fn from_centre(body: &SpatialBody, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| point[k] - body.centre[k])
    }

    fn to_global(body: &SpatialBody, point: [f64; 3]) -> [f64; 3] {
        body.pose().to_global(point)
    }

    fn carried(
        direction: [f64; 3],
        from: Option<&SpatialBody>,
        to: Option<&SpatialBody>,
    ) -> [f64; 3] {
        const GROUND: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
        let [from, to] = [from, to].map(|body| body.map_or(GROUND, |body| body.orientation));
        // Then nothing is rounded.
        if from == to {
            return direction;
        }
        let [from, to] = [from, to].map(|e| Pose::new([0.0; 3], e));
        to.to_local(from.to_global(direction))
    }

    fn of_numbers(numbers: &[f64]) -> Option<[f64; 3]> {
        numbers.try_into().ok()
    }

    fn argument(vector: [f64; 3]) -> Argument {
        Argument::Triple(vector)
    }
}

/// Three moments, or a symmetric matrix.
fn tensor(field: &Field, findings: &mut Findings) -> Option<[[f64; 3]; 3]> {
    let items = field.items(INERTIA.expected, findings)?;
    if items.iter().any(|row| row.value.get_ref().is_array()) {
        return matrix(field, INERTIA.expected, INERTIA.unit, findings);
    }
    let [x, y, z] = field.vector::<Space3>(INERTIA.expected, INERTIA.unit, findings)?;
    for (moment, item) in [x, y, z].iter().zip(&items) {
        if *moment < 0.0 {
            findings.error(
                Mistake::OutOfRange,
                item.span(),
                format!("{}: `{}` has the moment {moment}", field.subject, field.key),
                "may not be negative",
            );
            return None;
        }
    }
    Some([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
}

/// Three rows of three numbers.
pub(super) fn matrix(
    field: &Field,
    expected: &str,
    of: Dimension,
    findings: &mut Findings,
) -> Option<[[f64; 3]; 3]> {
    let rows = field.items(expected, findings)?;
    if rows.len() != 3 {
        field.miscount(expected, rows.len(), 3, findings);
        return None;
    }
    let rows = crate::field::all(&rows, |row| {
        row.vector::<Space3>("a row of three numbers", of, findings)
    });
    rows?.try_into().ok()
}
