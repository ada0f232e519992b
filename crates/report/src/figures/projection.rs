//! The initial view of a mechanism: the projection from points of its space to the plane of the
//! picture.
//!
//! The plane is seen along z. Space is seen from a distant viewpoint at the front right and above.
//! Gravity points downwards; without gravity, z points upwards. Figures use this view. The script
//! of a page starts with this view and rotates it.

use model::{Mechanism, SpaceKind};
use serde::ser::{Serialize, SerializeMap, Serializer};

use crate::channel::FewDigits;

/// Azimuth of the view, 60° to the right of the front, and elevation, 30° (rad). The components of
/// the direction of sight are then irrational, so that corners with rational coordinates do not
/// hide each other.
const TURNED: f64 = -std::f64::consts::FRAC_PI_3;
const RAISED: f64 = std::f64::consts::FRAC_PI_6;

/// A parallel projection. It contains two orthogonal unit vectors, which point to the right and
/// upwards in the picture, and the upward direction in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Projection {
    right: [f64; 3],
    up: [f64; 3],
    above: [f64; 3],
}

impl Projection {
    /// The plane, seen along z.
    const PLANE: Self = Self {
        right: [1.0, 0.0, 0.0],
        up: [0.0, 1.0, 0.0],
        above: [0.0, 1.0, 0.0],
    };

    /// The view of a mechanism.
    pub(crate) fn of(mechanism: &Mechanism) -> Self {
        if mechanism.space() != SpaceKind::Space3 {
            return Self::PLANE;
        }
        let mut weight = [0.0; 3];
        for force in mechanism.weight().chunks_exact(mechanism.space().n_v()) {
            for (sum, w) in weight.iter_mut().zip(force) {
                *sum += w;
            }
        }
        Self::with_above(unit(weight.map(|w| -w)).unwrap_or([0.0, 0.0, 1.0]))
    }

    /// The view of space with this unit vector upwards.
    fn with_above(above: [f64; 3]) -> Self {
        // In the front view, the first ground axis that is not vertical points from left to right.
        let first = if above[0].abs() < 0.9 { 0 } else { 1 };
        let level: [f64; 3] = std::array::from_fn(|k| {
            let axis = if k == first { 1.0 } else { 0.0 };
            axis - above[first] * above[k]
        });
        let across = unit(level).unwrap_or([1.0, 0.0, 0.0]);
        let back = model::space::cross(above, across);
        let ((st, ct), (sr, cr)) = (TURNED.sin_cos(), RAISED.sin_cos());
        Self {
            right: std::array::from_fn(|k| ct * back[k] - st * across[k]),
            up: std::array::from_fn(|k| cr * above[k] - sr * (ct * across[k] + st * back[k])),
            above,
        }
    }

    /// A point or a direction in the picture.
    pub(crate) fn flat(&self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        if self.is_plane() {
            return [x, y];
        }
        [self.right, self.up].map(|[a, b, c]| a * x + b * y + c * z)
    }

    /// Whether the picture shows a planar mechanism, without a projection.
    pub(crate) fn is_plane(&self) -> bool {
        *self == Self::PLANE
    }
}

/// Scripts read the projection, because they rotate the view.
impl Serialize for Projection {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(3))?;
        for (name, direction) in [
            ("right", self.right),
            ("up", self.up),
            ("above", self.above),
        ] {
            map.serialize_entry(name, &direction.map(FewDigits))?;
        }
        map.end()
    }
}

/// A vector scaled to length one; `None` if its length is zero.
pub(super) fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = model::space::norm(&v);
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-15
    }

    #[test]
    fn the_plane_is_seen_along_z() {
        assert_eq!(Projection::PLANE.flat([1.5, -2.0, 7.0]), [1.5, -2.0]);
    }

    /// Azimuth −60° and elevation 30°: sines and cosines are ½ and ½√3.
    #[test]
    fn axes_of_the_ground_are_where_the_view_puts_them() {
        let (half, root) = (0.5, 0.75_f64.sqrt());
        let view = Projection::with_above([0.0, 0.0, 1.0]);
        let [x, y, z] = [[root, -half * half], [half, half * root], [0.0, root]];
        assert!(near(view.flat([1.0, 0.0, 0.0]), x));
        assert!(near(view.flat([0.0, 1.0, 0.0]), y));
        assert!(near(view.flat([0.0, 0.0, 1.0]), z));
        // If y points upwards, −z points to the back.
        let view = Projection::with_above([0.0, 1.0, 0.0]);
        assert!(near(view.flat([1.0, 0.0, 0.0]), x));
        assert!(near(view.flat([0.0, 1.0, 0.0]), z));
        assert!(near(view.flat([0.0, 0.0, -1.0]), y));
    }

    /// For any upward direction, the picture preserves lengths perpendicular to the line of sight
    /// and shows `above` vertically.
    #[test]
    fn every_view_is_orthogonal_and_upright() {
        for above in [[1.0, 2.0, 2.0], [-9.0, 1.0, 0.5], [0.0, -1.0, 0.0]] {
            let above = unit(above).expect("a direction");
            let view = Projection::with_above(above);
            let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
            assert!((dot(view.right, view.right) - 1.0).abs() < 1e-15);
            assert!((dot(view.up, view.up) - 1.0).abs() < 1e-15);
            assert!(dot(view.right, view.up).abs() < 1e-15);
            assert!(near(view.flat(above), [0.0, 0.75_f64.sqrt()]));
        }
    }
}
