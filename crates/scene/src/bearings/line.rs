//! Computes the line of action of two wheels that rotate about axes of one carrier, from the pitch
//! point and the pressure angle.

use std::fmt;

use joints::space3::{Direction, cross, dot};
use model::words::quantity;

use crate::limits::MEETING;

/// A line fixed in the carrier: a point, and a unit vector along the line.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    pub(super) point: [f64; 3],
    pub(super) along: [f64; 3],
}

/// Position of an axis relative to another axis.
pub(super) struct Offset {
    /// Distance of the point of the second axis from the first axis (m).
    pub(super) distance: f64,
    /// Sine of the angle between both axes.
    pub(super) sine: f64,
    /// Whether the axes point in opposite directions.
    pub(super) is_reversed: bool,
}

/// Prints the larger part of the offset, as words that stand between the names of both axes.
impl fmt::Display for Offset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.sine < MEETING {
            write!(f, "is {} away from", quantity(self.distance, "m"))
        } else {
            write!(
                f,
                "is inclined by {} to",
                quantity(self.sine.min(1.0).asin(), "rad")
            )
        }
    }
}

impl Axis {
    /// Returns the offset of another axis from this axis.
    pub(super) fn offset(&self, other: &Self) -> Offset {
        let apart = minus(other.point, self.point);
        Offset {
            distance: length(cross(apart, self.along)),
            sine: length(cross(self.along, other.along)),
            is_reversed: dot(self.along, other.along) < 0.0,
        }
    }

    /// Returns whether a force along a line through a point has a moment about the axis.
    pub(super) fn has_lever(&self, line: [f64; 3], at: [f64; 3]) -> bool {
        let line = Direction::new(line).map(Direction::xyz);
        // A line of length zero is rejected when the definition is built.
        line.is_none_or(|line| {
            let moment = cross(minus(at, self.point), line);
            dot(moment, self.along).abs() > MEETING * length(moment)
        })
    }
}

/// The unit normal N of the plane of both axes, and the direction g of the line along which the
/// wheels roll on each other.
struct Roll {
    normal: [f64; 3],
    along: [f64; 3],
}

/// The line of action is `cos α·N + sin α·(N × g)`; α is the pressure angle.
///
/// If the axes a₁ and a₂ are parallel, g = a₁ and N = a₁ × c, where c is the direction of the
/// centre line from the first axis to the second; then `N × g = c`. If the axes meet in an apex, g
/// points from the apex to the pitch point, and N is parallel to a₁ × a₂.
///
/// # Errors
/// Returns the reason if such a line does not exist.
pub(super) fn of_action(
    axes: [Axis; 2],
    pitch: [f64; 3],
    pressure_angle: f64,
) -> Result<[f64; 3], &'static str> {
    let [first, second] = axes;
    let across = cross(first.along, second.along);
    let Roll { normal, along } = if length(across) < MEETING {
        parallel(axes, pitch)?
    } else {
        meeting(axes, across, pitch)?
    };
    if pressure_angle == 0.0 {
        return Ok(normal);
    }
    let (sin, cos) = pressure_angle.sin_cos();
    let towards = cross(normal, along);
    Ok([0, 1, 2].map(|k| cos * normal[k] + sin * towards[k]))
}

fn parallel([first, second]: [Axis; 2], pitch: [f64; 3]) -> Result<Roll, &'static str> {
    let apart = minus(second.point, first.point);
    let centres = moved(apart, -dot(apart, first.along), first.along);
    let size = length(apart).max(length(minus(pitch, first.point)));
    let normal = Direction::new(cross(first.along, centres));
    match normal.filter(|_| length(centres) > MEETING * size) {
        Some(normal) => Ok(Roll {
            normal: normal.xyz(),
            along: first.along,
        }),
        None => Err("the wheels turn about one line"),
    }
}

/// `across` is a₁ × a₂.
fn meeting(
    [first, second]: [Axis; 2],
    across: [f64; 3],
    pitch: [f64; 3],
) -> Result<Roll, &'static str> {
    let apart = minus(second.point, first.point);
    let to_apex = dot(cross(apart, second.along), across) / dot(across, across);
    let apex = moved(first.point, to_apex, first.along);
    let roll = minus(pitch, apex);
    let size = [apart, minus(second.point, apex), roll].map(length);
    let least = MEETING * size.into_iter().fold(0.0, f64::max);
    let Some(normal) = Direction::new(across).map(Direction::xyz) else {
        return Err("an axis has no direction");
    };
    if dot(normal, apart).abs() > least {
        return Err("the axes of the wheels neither meet nor are parallel");
    }
    if dot(normal, roll).abs() > least {
        return Err("the pitch point does not lie in the plane of both axes");
    }
    match Direction::new(roll).filter(|_| length(roll) > least) {
        Some(roll) => Ok(Roll {
            normal,
            along: roll.xyz(),
        }),
        None => Err("the axes of the wheels meet in the pitch point"),
    }
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

/// a + s·b
fn moved(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + s * b[k])
}

pub(super) fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}
