//! Types of joints with their positions, in the axes of the ground.

use super::ratio::Ratio;
use super::vector::Vector;

/// The type and position of a joint. The point `from` is on the first body, and the point `at` is
/// on the second body. Directions have any length except 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Both bodies share a point.
    Spherical {
        /// The point.
        at: Vector,
    },
    /// Both bodies share a point and an axis.
    Revolute {
        /// The point.
        at: Vector,
        /// The axis.
        axis: Vector,
    },
    /// Both bodies share a point, and two of their axes are perpendicular.
    Universal {
        /// The point.
        at: Vector,
        /// The axis in the first body.
        first: Vector,
        /// The axis in the second body.
        second: Vector,
    },
    /// A slider of the second body on a line of the first body, without relative rotation.
    Translational {
        /// A point of the line on the first body.
        from: Vector,
        /// The slider.
        at: Vector,
        /// The line.
        axis: Vector,
    },
    /// A slider of the second body on a line of the first body, free to rotate about the line.
    Cylindrical {
        /// A point of the line on the first body.
        from: Vector,
        /// The slider.
        at: Vector,
        /// The line.
        axis: Vector,
    },
    /// A point of the second body remains in a plane of the first body, and the normals of both
    /// bodies are parallel.
    Planar {
        /// A point of the plane on the first body.
        from: Vector,
        /// The point of the second body.
        at: Vector,
        /// The normal.
        normal: Vector,
    },
    /// A rigid connection.
    Fixed {
        /// The reference point.
        at: Vector,
    },
    /// A point of the second body is on a line of the first body.
    PointOnLine {
        /// A point of the line.
        from: Vector,
        /// The point of the second body.
        at: Vector,
        /// The line.
        axis: Vector,
    },
    /// A point of the second body is in a plane of the first body.
    PointOnPlane {
        /// A point of the plane.
        from: Vector,
        /// The point of the second body.
        at: Vector,
        /// The normal.
        normal: Vector,
    },
    /// A common axis direction of both bodies.
    Parallel {
        /// The axis.
        axis: Vector,
    },
    /// Two axes that remain perpendicular.
    Perpendicular {
        /// The axis in the first body.
        first: Vector,
        /// The axis in the second body.
        second: Vector,
    },
    /// The relative orientation is constant.
    Orientation,
    /// A massless rod with spherical ends.
    Distance {
        /// The end on the first body.
        from: Vector,
        /// The end on the second body.
        at: Vector,
    },
    /// A knife edge: the velocity of a point of the first body along a direction is zero.
    KnifeEdge {
        /// The point.
        at: Vector,
        /// The direction.
        normal: Vector,
    },
    /// A wheel, the first body, that rolls without slip on a plane of the ground.
    Wheel {
        /// The centre of the wheel.
        centre: Vector,
        /// The axis of the wheel.
        axis: Vector,
        /// The point of contact.
        contact: Vector,
        /// The normal of the plane, on the side of the wheel.
        normal: Vector,
    },
}

impl Kind {
    /// Returns the value of `type`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Spherical { .. } => "spherical",
            Self::Revolute { .. } => "revolute",
            Self::Universal { .. } => "universal",
            Self::Translational { .. } => "translational",
            Self::Cylindrical { .. } => "cylindrical",
            Self::Planar { .. } => "planar",
            Self::Fixed { .. } => "fixed",
            Self::PointOnLine { .. } => "point-on-line",
            Self::PointOnPlane { .. } => "point-on-plane",
            Self::Parallel { .. } => "parallel",
            Self::Perpendicular { .. } => "perpendicular",
            Self::Orientation => "orientation",
            Self::Distance { .. } => "distance",
            Self::KnifeEdge { .. } => "knife-edge",
            Self::Wheel { .. } => "wheel",
        }
    }

    /// Whether the joint always connects one body to the ground, so that the key `body` is written.
    #[must_use]
    pub fn has_one_body(&self) -> bool {
        matches!(self, Self::KnifeEdge { .. } | Self::Wheel { .. })
    }

    /// Returns the reference point of the reaction on the first body. Returns `None` if the joint
    /// transmits only couples, which are the same about every point.
    #[must_use]
    pub fn place(&self) -> Option<&Vector> {
        match self {
            Self::Spherical { at }
            | Self::Revolute { at, .. }
            | Self::Universal { at, .. }
            | Self::Fixed { at }
            | Self::KnifeEdge { at, .. } => Some(at),
            Self::Translational { from, .. }
            | Self::Cylindrical { from, .. }
            | Self::Planar { from, .. }
            | Self::PointOnLine { from, .. }
            | Self::PointOnPlane { from, .. }
            | Self::Distance { from, .. } => Some(from),
            Self::Wheel { contact, .. } => Some(contact),
            Self::Parallel { .. } | Self::Perpendicular { .. } | Self::Orientation => None,
        }
    }

    /// Returns the same joint after its points and directions are mapped.
    #[must_use]
    pub fn mapped(
        &self,
        point: &dyn Fn(&Vector) -> Vector,
        direction: &dyn Fn(&Vector) -> Vector,
    ) -> Self {
        let mut image = self.clone();
        let (points, directions): (Vec<&mut Vector>, Vec<&mut Vector>) = match &mut image {
            Self::Spherical { at } | Self::Fixed { at } => (vec![at], vec![]),
            Self::Revolute { at, axis } => (vec![at], vec![axis]),
            Self::Universal { at, first, second } => (vec![at], vec![first, second]),
            Self::Translational { from, at, axis }
            | Self::Cylindrical { from, at, axis }
            | Self::PointOnLine { from, at, axis } => (vec![from, at], vec![axis]),
            Self::Planar { from, at, normal } | Self::PointOnPlane { from, at, normal } => {
                (vec![from, at], vec![normal])
            }
            Self::Parallel { axis } => (vec![], vec![axis]),
            Self::Perpendicular { first, second } => (vec![], vec![first, second]),
            Self::Orientation => (vec![], vec![]),
            Self::Distance { from, at } => (vec![from, at], vec![]),
            Self::KnifeEdge { at, normal } => (vec![at], vec![normal]),
            Self::Wheel {
                centre,
                axis,
                contact,
                normal,
            } => (vec![centre, contact], vec![axis, normal]),
        };
        for p in points {
            *p = point(p);
        }
        for d in directions {
            *d = direction(d);
        }
        image
    }

    /// Returns the same joint with its bodies exchanged. Returns `None` if the joint cannot be
    /// written with exchanged bodies.
    #[must_use]
    pub fn swapped(&self) -> Option<Self> {
        let mut image = self.clone();
        match &mut image {
            Self::Spherical { .. }
            | Self::Revolute { .. }
            | Self::Fixed { .. }
            | Self::Parallel { .. }
            | Self::Orientation => {}
            Self::Translational { from, at, .. }
            | Self::Cylindrical { from, at, .. }
            | Self::Planar { from, at, .. }
            | Self::Distance { from, at } => std::mem::swap(from, at),
            Self::Universal { first, second, .. } | Self::Perpendicular { first, second } => {
                std::mem::swap(first, second);
            }
            Self::PointOnLine { .. }
            | Self::PointOnPlane { .. }
            | Self::KnifeEdge { .. }
            | Self::Wheel { .. } => return None,
        }
        Some(image)
    }

    /// Whether the joint is exactly satisfied as drawn.
    #[must_use]
    pub fn holds(&self) -> bool {
        match self {
            Self::Spherical { .. } | Self::Fixed { .. } | Self::Orientation => true,
            Self::Revolute { axis, .. } | Self::Parallel { axis } => !axis.is_zero(),
            Self::Universal { first, second, .. } | Self::Perpendicular { first, second } => {
                !first.is_zero() && !second.is_zero() && first.dot(second).is_zero()
            }
            Self::Translational { from, at, axis }
            | Self::Cylindrical { from, at, axis }
            | Self::PointOnLine { from, at, axis } => !axis.is_zero() && (at - from).is_along(axis),
            Self::Planar { from, at, normal } | Self::PointOnPlane { from, at, normal } => {
                !normal.is_zero() && (at - from).dot(normal).is_zero()
            }
            Self::Distance { from, at } => from != at,
            Self::KnifeEdge { normal, .. } => !normal.is_zero(),
            Self::Wheel {
                centre,
                axis,
                contact,
                normal,
            } => {
                // The vector from the centre to the lowest point is perpendicular to the axis, and
                // is the steepest direction in the plane of the circle.
                let spoke = contact - centre;
                let down = -&normal.across(axis);
                !down.is_zero()
                    && spoke.is_along(&down)
                    && Ratio::zero().is_below(&spoke.dot(&down))
            }
        }
    }
}
