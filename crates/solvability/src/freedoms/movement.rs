//! Describes the velocities of one body as a rotation, a translation or a screw.

use crate::limits::VISIBLE;
use model::SpaceKind;
use model::space::{cross, difference, dot, norm};

/// Velocities of one body, in ground axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twist {
    /// Velocity of the centre of mass (m/s).
    pub(super) velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub(super) omega: [f64; 3],
}

/// A line about which a body rotates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// A point of the line (m).
    pub(super) point: [f64; 3],
    /// Direction of the line, a unit vector.
    pub(super) along: [f64; 3],
}

/// Movement of a body at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) enum Movement {
    /// Rotation about a line.
    Turn(Line),
    /// Rotation about a line and translation along it by a pitch (m per revolution).
    Screw(Line, f64),
    /// Translation along a unit vector.
    Slide([f64; 3]),
}

impl Twist {
    /// Creates a twist from velocities in the order of [`SpaceKind::velocities`], in ground axes.
    pub(super) fn new(space: SpaceKind, v: &[f64]) -> Self {
        let mut twist = Self {
            velocity: [0.0; 3],
            omega: [0.0; 3],
        };
        space
            .forces()
            .for_each(|k| twist.velocity[space.axis_of(k)] = v[k]);
        space
            .torques()
            .for_each(|k| twist.omega[space.axis_of(k)] = v[k]);
        twist
    }

    /// Returns the components, in the order of [`Twist::new`].
    pub(super) fn components(self, space: SpaceKind) -> Vec<f64> {
        let velocities = space.forces().map(|k| self.velocity[space.axis_of(k)]);
        let turns = space.torques().map(|k| self.omega[space.axis_of(k)]);
        velocities.chain(turns).collect()
    }

    /// Returns the twist with the velocity of another point, at this arm.
    pub(super) fn carried(self, arm: [f64; 3]) -> Self {
        let turned = cross(self.omega, arm);
        Self {
            velocity: std::array::from_fn(|k| self.velocity[k] + turned[k]),
            omega: self.omega,
        }
    }

    pub(super) fn less(self, other: Self) -> Self {
        Self {
            velocity: difference(self.velocity, other.velocity),
            omega: difference(self.omega, other.omega),
        }
    }

    /// Returns the larger of two speeds (m/s): that of the centre of mass, and that of a point at
    /// this distance from the axis.
    pub(super) fn speed(self, size: f64) -> f64 {
        norm(&self.velocity).max(norm(&self.omega) * size)
    }

    /// Returns the movement of a body with this centre of mass in a mechanism of this size. A
    /// rotation about a line whose distance is at least 1/[`VISIBLE`] sizes is a translation. An
    /// advance below [`VISIBLE`] times the fastest velocity counts as zero.
    pub(super) fn movement(self, centre: [f64; 3], size: f64) -> Movement {
        let Self { velocity, omega } = self;
        let (speed, rate) = (norm(&velocity), norm(&omega));
        if rate * size <= VISIBLE * speed {
            return Movement::Slide(velocity.map(|x| x / speed));
        }
        let along = omega.map(|x| x / rate);
        let arm = cross(along, velocity.map(|x| x / rate));
        let line = Line {
            point: std::array::from_fn(|k| centre[k] + arm[k]),
            along,
        };
        let advance = dot(along, velocity);
        if advance.abs() <= VISIBLE * self.speed(size) {
            return Movement::Turn(line);
        }
        Movement::Screw(line, std::f64::consts::TAU * advance / rate)
    }
}

impl Line {
    /// Returns the point of the line that is nearest to the origin of the ground.
    pub(super) fn nearest_to_origin(self) -> [f64; 3] {
        let along = dot(self.along, self.point);
        std::array::from_fn(|k| self.point[k] - along * self.along[k])
    }
}
