//! `orientation`: a rotation from the axes of a body to the ground axes, given in one of four
//! forms.

use model::words::short;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::dimension::Dimension;
use crate::field::Field;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::list;
use crate::table::Table;
use joints::Space3;
use model::codes::Code;

pub(crate) const ORIENTATION: Key = Key::optional(
    "orientation",
    "a table { quaternion | axis, angle | rpy | matrix }",
    Takes::Orientation,
)
.doc("Orientation of the frame at the start, from its axes to those of the ground: { quaternion = [w, x, y, z] }, { axis, angle }, { rpy = [roll, pitch, yaw] } about the fixed axes x, y and z, or { matrix }; the axes of the ground if it is omitted");

pub(crate) const QUATERNION: Key = Key::optional(
    "quaternion",
    "four numbers [w, x, y, z]",
    Takes::Vector(4, Interval::Any),
)
.doc("Unit quaternion [w, x, y, z]; its sign does not matter");
pub(crate) const AXIS: Key = Key::triple("axis").doc("The axis of the rotation");
pub(crate) const ANGLE: Key = Key::optional("angle", "a number", Takes::Number(Interval::Any))
    .unit(Dimension::ANGLE)
    .doc("The angle of the rotation about `axis`, right-handed");
pub(crate) const RPY: Key = Key::optional(
    "rpy",
    "three angles [roll, pitch, yaw]",
    Takes::Vector(3, Interval::Any),
)
.unit(Dimension::ANGLE)
.doc("Angles about the fixed axes x, then y, then z, as in URDF");
pub(crate) const MATRIX: Key = Key::optional("matrix", MATRIX_EXPECTED, Takes::Tensor)
    .doc("The rotation matrix, row by row: its columns are the axes of the body");

const MATRIX_EXPECTED: &str = "a rotation matrix of three rows";

/// Largest relative difference between a quaternion or a matrix and a rotation. Above this
/// difference there is a warning. Entries with two digits are accurate to 1e-2.
const ROUGH: f64 = 1e-2;

/// Reads an orientation; the result is a quaternion (w, x, y, z) of any length.
pub(crate) fn read(field: &Field) -> Option<[f64; 4]> {
    let mut table = field.table(ORIENTATION.expected)?;
    let given = [&QUATERNION, &AXIS, &RPY, &MATRIX].map(|key| table.optional(key));
    let angle = table.optional(&ANGLE);
    let read = match given {
        [Some(q), None, None, None] => quaternion(&q),
        [None, Some(axis), None, None] => about(&table, &axis, angle.clone()),
        [None, None, Some(rpy), None] => {
            let rpy = rpy.vector::<Space3>(RPY.expected, RPY.unit);
            rpy.map(|[r, p, y]| numbers(UnitQuaternion::from_euler_angles(r, p, y)))
        }
        [None, None, None, Some(m)] => rotation(&m),
        _ => {
            let ways = list(["quaternion", "axis", "rpy", "matrix"]);
            field.findings.error(
                Mistake::Exclusive,
                field.span(),
                format!("{} needs one of the keys {ways}", table.subject),
                "an orientation is written in one way",
            );
            None
        }
    };
    if let Some(angle) = angle.filter(|_| !table.has(AXIS.name)) {
        let subject = &table.subject;
        let message = format!("{subject} has an `angle` without an `axis`");
        field
            .findings
            .error(Mistake::Missing, angle.span(), message, "about which axis?");
    }
    table.close();
    read
}

fn numbers(q: UnitQuaternion<f64>) -> [f64; 4] {
    [q.w, q.i, q.j, q.k]
}

/// Four numbers that are not all zero.
fn quaternion(field: &Field) -> Option<[f64; 4]> {
    let e = field.numbers(4, QUATERNION.expected, |_| Dimension::NONE)?;
    let e: [f64; 4] = e.try_into().ok()?;
    let length = e.iter().fold(0.0_f64, |length, x| length.hypot(*x));
    if length == 0.0 {
        field.error(
            Mistake::NoDirection,
            format!(": `{}` is zero, so it is not an orientation", field.key),
            "no orientation",
        );
        return None;
    }
    warn_of_rough(field, (length - 1.0).abs(), "its length differs from 1 by");
    Some(e)
}

/// A rotation about an axis.
fn about(table: &Table, axis: &Field, angle: Option<Field>) -> Option<[f64; 4]> {
    let [x, y, z] = axis.vector::<Space3>(AXIS.expected, AXIS.unit)?;
    let Some(angle) = angle else {
        let message = format!("{} has an `axis` without an `angle`", table.subject);
        table.findings.error(
            Mistake::Missing,
            axis.span(),
            message,
            "turned by how much?",
        );
        return None;
    };
    let angle = angle.number(ANGLE.unit)?;
    let Some(axis) = joints::space3::Direction::new([x, y, z]) else {
        axis.error(
            Mistake::NoDirection,
            format!(": `{}` has length zero", axis.key),
            "has no direction",
        );
        return None;
    };
    let (sin, cos) = (0.5 * angle).sin_cos();
    let [x, y, z] = axis.xyz().map(|e| sin * e);
    Some([cos, x, y, z])
}

/// The rotation nearest to a matrix: its orthogonal factor.
fn rotation(field: &Field) -> Option<[f64; 4]> {
    let rows = field.matrix(MATRIX_EXPECTED, Dimension::NONE)?;
    let m = Matrix3::from_rows(&rows.map(|row| Vector3::from(row).transpose()));
    let svd = m.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else {
        return None;
    };
    let [largest, least] = [svd.singular_values.max(), svd.singular_values.min()];
    let polar = u * v;
    let fault = if least <= ROUGH * largest {
        "is singular, so it is not an orientation"
    } else if polar.determinant() < 0.0 {
        "is a reflection: no rotation turns a right hand into a left one"
    } else {
        let off = (m - polar).amax();
        warn_of_rough(field, off, "it differs from a rotation by");
        let rotation = Rotation3::from_matrix_unchecked(polar);
        return Some(numbers(UnitQuaternion::from_rotation_matrix(&rotation)));
    };
    field.error(
        const { Code::new(152) },
        format!(": `{}` {fault}", field.key),
        "no orientation",
    );
    None
}

/// Warns about numbers that do not form an exact rotation. The nearest rotation is used.
fn warn_of_rough(field: &Field, off: f64, what: &str) {
    if off > ROUGH {
        field.findings.warning(
            const { Code::new(199) },
            field.span(),
            format!(
                "{}: `{}`: {what} {off}",
                field.subject,
                field.key,
                off = short(off)
            ),
            "not quite a rotation",
            "the nearest rotation is taken: write more digits",
        );
    }
}
