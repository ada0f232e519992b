//! Rotation vectors for axes that joints in space keep parallel, for configurations that violate
//! these joints.
//!
//! The rows of a joint are products of directions. The equations `u·w' = v·w' = 0` are satisfied
//! for w' = w and for w' = −w, and three conditions of this kind have four orientations as
//! solutions. During the assembly, the rotation vector of the remaining rotation replaces these
//! products. The rotation vector is zero only if the axes have the described directions. Near this
//! orientation it is equal to the products.

use std::f64::consts::PI;
use std::ops::Range;

use crate::element::PlacedConstraint;
use crate::system::Scratch;

/// Below this value, the angle is used instead of its sine, because the next term of the series is
/// negligible.
const SERIES: f64 = 1e-4;

/// The rows of one joint that keep axes parallel.
pub(super) struct Parallel {
    /// The rows. There are two rows if the bodies may rotate about the axis, and otherwise three.
    pub(super) rows: Range<usize>,
    /// The remaining angle (rad), 0 to π.
    pub(super) angle: f64,
    /// For each row, the residual (rad) in which the rotation vector replaces the products of
    /// directions. The second value is the derivative of the residual with respect to the angular
    /// velocity of the second body relative to the first, in ground axes.
    pub(super) each: [(f64, [f64; 3]); 3],
}

impl Parallel {
    /// Returns the rows of a joint at the configuration in the work space, or `None` if the joint
    /// does not keep axes parallel.
    pub(super) fn of(joint: &PlacedConstraint, s: &Scratch) -> Option<Self> {
        let [own, other] = joint.parallel_axes(&s.slots)?;
        let names = joint.spec().rows;
        let at = names.iter().position(|row| row.name == "axis_u")?;
        let first = joint.rows.row(at);
        let is_turn_kept = names.get(at + 2).is_some_and(|row| row.name == "turn");
        let (count, (angle, each)) = if is_turn_kept {
            (3, whole_rotation(own, other))
        } else {
            (2, swing(own, other[2]))
        };
        Some(Self {
            rows: first..first + count,
            angle,
            each,
        })
    }

    /// Returns whether the axes have the described direction. The rows of the joint must be
    /// satisfied.
    pub(super) fn is_as_described(&self) -> bool {
        self.angle < 0.5 * PI
    }
}

type Residuals = (f64, [(f64, [f64; 3]); 3]);

/// Returns the components `α/sin α·(u·w', v·w')` of a rotation vector along v and −u. The rotation
/// is the smallest rotation of w to `other`.
fn swing([u, v, w]: [[f64; 3]; 3], other: [f64; 3]) -> Residuals {
    let (along_u, along_v, cos) = (dot(u, other), dot(v, other), dot(w, other));
    let sin = along_u.hypot(along_v);
    let angle = sin.atan2(cos);
    if sin < SERIES && cos < 0.0 {
        // If the angle is half a revolution, any perpendicular direction may be the axis.
        let back = u.map(|x| -x);
        return (angle, [(angle, v), (0.0, back), (0.0, [0.0; 3])]);
    }
    // The factor f = α/sin α, and its derivative with respect to cos α.
    let factor = if sin > 0.0 { angle / sin } else { 1.0 };
    let slope = if sin < SERIES {
        -1.0 / 3.0
    } else {
        (cos * factor - 1.0) / (sin * sin)
    };
    let turning = cross(other, w);
    let row = |along: f64, direction: [f64; 3]| {
        let own = cross(other, direction);
        let gradient = [0, 1, 2].map(|k| factor * own[k] + slope * along * turning[k]);
        (factor * along, gradient)
    };
    (angle, [row(along_u, u), row(along_v, v), (0.0, [0.0; 3])])
}

/// Returns the components along v, −u and w of a rotation vector θ. The rotation transforms these
/// axes to `other`. With ω in these axes, `θ̇ = ω − ½·θ×ω + β·θ×(θ×ω)`, `β = (1 − ½θ·cot ½θ)/θ²`.
fn whole_rotation(own: [[f64; 3]; 3], other: [[f64; 3]; 3]) -> Residuals {
    let [w, e @ ..] = quaternion(own.map(|a| other.map(|b| dot(a, b))));
    let half = norm(e).atan2(w);
    let (angle, length) = (2.0 * half, norm(e));
    let theta = if length > 0.0 {
        e.map(|x| angle * x / length)
    } else {
        [0.0; 3]
    };
    let square = angle * angle;
    let beta = if square < SERIES * SERIES {
        1.0 / 12.0
    } else {
        (1.0 - half / half.tan()) / square
    };
    // Row k of the matrix is the derivative of θ_k with respect to ω, in ground axes.
    let gradient = |k: usize| {
        let unit = [0, 1, 2].map(|l| if l == k { 1.0 } else { 0.0 });
        // (θ×)ᵀ = −θ×
        let once = cross(theta, unit);
        let twice = cross(theta, once);
        let own_axes = [0, 1, 2].map(|l| unit[l] + 0.5 * once[l] + beta * twice[l]);
        [0, 1, 2].map(|x| (0..3).map(|l| own_axes[l] * own[l][x]).sum())
    };
    let minus = |(r, g): (f64, [f64; 3])| (-r, g.map(|x| -x));
    let [u, v, w] = [0, 1, 2].map(|k| (theta[k], gradient(k)));
    (angle, [v, minus(u), w])
}

/// Returns the unit quaternion with w ≥ 0 of a rotation matrix (by rows). The quaternion is
/// computed from its largest component.
fn quaternion(r: [[f64; 3]; 3]) -> [f64; 4] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = r;
    // Row k is 4·e_k·e, where e is the quaternion.
    let rows = [
        [1.0 + xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, 1.0 + xx - yy - zz, xy + yx, xz + zx],
        [xz - zx, xy + yx, 1.0 - xx + yy - zz, yz + zy],
        [yx - xy, xz + zx, yz + zy, 1.0 - xx - yy + zz],
    ];
    let largest = (1..4).fold(0, |a, k| if rows[k][k] > rows[a][a] { k } else { a });
    let row = rows[largest];
    let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
    row.map(|x| x / length.copysign(row[0]))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    joints::space3::dot(a, b)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    joints::space3::cross(a, b)
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Unit, Vector3};

    use super::*;

    /// Step and error bound of difference quotients.
    const STEP: f64 = 1e-6;
    const AGREES: f64 = 1e-7;

    fn axes(r: &Rotation3<f64>) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|k| r.matrix().column(k).into_owned().into())
    }

    /// Rotations of several sizes about several axes, and rotations of the first body.
    fn cases() -> impl Iterator<Item = (Rotation3<f64>, Vector3<f64>)> {
        let own = Rotation3::from_scaled_axis(Vector3::new(0.7, -1.1, 0.4));
        let directions = [[1.0, 0.2, -0.3], [-0.4, 0.9, 1.3], [0.1, -1.0, 0.2]];
        [1e-6, 0.1, 1.0, 2.0, 3.0]
            .into_iter()
            .flat_map(move |angle| {
                directions.into_iter().map(move |d| {
                    let direction = Unit::new_normalize(Vector3::from(d));
                    (own, angle * direction.into_inner())
                })
            })
    }

    /// Compares with the rotation vector of `nalgebra`, and with its difference quotients.
    #[test]
    fn a_whole_rotation_is_told_by_its_vector() {
        for (own, turn) in cases() {
            let at = |more: Vector3<f64>| {
                let other =
                    Rotation3::from_scaled_axis(more) * own * Rotation3::from_scaled_axis(turn);
                whole_rotation(axes(&own), axes(&other))
            };
            let (angle, each) = at(Vector3::zeros());
            assert!((angle - turn.norm()).abs() < 1e-14, "{angle}");
            let expected = [turn[1], -turn[0], turn[2]];
            for (k, (found, gradient)) in each.into_iter().enumerate() {
                assert!((found - expected[k]).abs() < 1e-13, "{k}: {found}");
                for x in 0..3 {
                    let step = Vector3::ith(x, STEP);
                    let slope = (at(step).1[k].0 - at(-step).1[k].0) / (2.0 * STEP);
                    assert!((slope - gradient[x]).abs() < AGREES, "{turn}, {k}, {x}");
                }
            }
        }
    }

    /// Compares the remaining angle of two axes with difference quotients; a rotation about the
    /// axis has no effect.
    #[test]
    fn a_swing_is_told_by_the_angle_of_the_axes() {
        for (own, turn) in cases() {
            let across = Vector3::new(turn[0], turn[1], 0.0);
            let at = |more: Vector3<f64>| {
                let other = Rotation3::from_scaled_axis(more)
                    * own
                    * Rotation3::from_scaled_axis(across)
                    * Rotation3::from_scaled_axis(Vector3::new(0.0, 0.0, 0.8));
                swing(axes(&own), axes(&other)[2])
            };
            let (angle, each) = at(Vector3::zeros());
            assert!((angle - across.norm()).abs() < 1e-9, "{angle}");
            let expected = [across[1], -across[0]];
            for (k, expected) in expected.into_iter().enumerate() {
                let (found, gradient) = each[k];
                assert!((found - expected).abs() < 1e-9, "{k}: {found}");
                for x in 0..3 {
                    let step = Vector3::ith(x, STEP);
                    let slope = (at(step).1[k].0 - at(-step).1[k].0) / (2.0 * STEP);
                    assert!((slope - gradient[x]).abs() < AGREES, "{turn}, {k}, {x}");
                }
            }
        }
    }

    /// A rotation by half a revolution of an axis or of a body does not count as aligned.
    #[test]
    fn half_a_turn_is_no_zero() {
        let own = Rotation3::from_scaled_axis(Vector3::new(0.3, 0.2, 0.1));
        for k in 0..3 {
            let half = own * Rotation3::from_scaled_axis(Vector3::ith(k, PI));
            let (angle, each) = whole_rotation(axes(&own), axes(&half));
            assert!((angle - PI).abs() < 1e-7);
            assert!((norm(each.map(|(r, _)| r)) - PI).abs() < 1e-7);
        }
        let [u, v, w] = axes(&own);
        let (angle, each) = swing([u, v, w], w.map(|x| -x));
        assert!((angle - PI).abs() < 1e-7 && (each[0].0 - PI).abs() < 1e-7);
    }
}
