//! Rolling circles of bodies: pitch circles, and wheels on the ground.

use model::space::{cross, difference, norm};
use model::{ConstraintId, SpaceKind};
use serde::Serialize;

use super::{DrawingModel, Point, Probe, Stage, index};
use crate::channel::FewDigits;
use crate::figures::geometry::Pitch;
use crate::figures::projection::unit;

/// A circle is fixed to a body if, in the frame of the body, radius, centre and axis change by at
/// most this fraction of the size of the picture. Contacts are accurate to the tolerance of a run.
const ROUND: f64 = 1e-6;

/// Number of corners of the polygon by which a circle is drawn.
const CORNERS: usize = 72;

/// A rolling circle of a body.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnWheel {
    pub(crate) b: isize,
    /// Centre in the frame of the body (m).
    pub(crate) p: Point,
    /// In space: direction normal to the circle, in the axes of the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    axis: Option<Point>,
    /// Radius (m).
    r: FewDigits,
}

impl DrawingModel {
    /// A circle as a polygon.
    pub(crate) fn wheel(&self, wheel: &DrawnWheel) -> Vec<[f64; 2]> {
        let axis = wheel.axis.map_or([0.0, 0.0, 1.0], Point::at);
        let other = if axis[0].abs() < 0.9 {
            [1.0, 0.0, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        };
        let first = unit(cross(axis, other)).unwrap_or(other);
        let (second, centre, r) = (cross(axis, first), wheel.p.at(), wheel.r.0);
        let corner = |k: usize| {
            let (sin, cos) = (k as f64 * std::f64::consts::TAU / CORNERS as f64).sin_cos();
            let at = [0, 1, 2].map(|k| centre[k] + r * (cos * first[k] + sin * second[k]));
            self.view.flat(match usize::try_from(wheel.b) {
                Ok(k) => self.poses.to_global(k, at),
                Err(_) => at,
            })
        };
        (0..CORNERS).map(corner).collect()
    }
}

impl Stage<'_> {
    /// Circles of a joint that do not change between the tested frames.
    pub(super) fn wheels(&self, id: ConstraintId, probes: &[Probe], size: f64) -> Vec<DrawnWheel> {
        let space = self.mechanism.space();
        let Some(first) = probes.first() else {
            return Vec::new();
        };
        let is_same = |wheel: &Pitch, k: usize| {
            probes.iter().all(|probe| {
                probe.sites[id.0].pitch.get(k).is_some_and(|other| {
                    (other.radius - wheel.radius).abs() <= ROUND * size
                        && norm(&difference(other.centre, wheel.centre)) <= ROUND * size
                        && norm(&cross(other.axis, wheel.axis)) <= ROUND
                })
            })
        };
        let wheels = first.sites[id.0].pitch.iter().enumerate();
        let same = wheels.filter(|(k, wheel)| is_same(wheel, *k));
        same.map(|(_, wheel)| DrawnWheel {
            b: index(wheel.body),
            p: Point::new(space, self.told(wheel.body, wheel.centre)),
            axis: (space == SpaceKind::Space3)
                .then(|| Point::new(space, self.told(wheel.body, wheel.axis))),
            r: FewDigits(wheel.radius),
        })
        .collect()
    }
}
