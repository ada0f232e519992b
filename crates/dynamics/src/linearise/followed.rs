//! Cyclic coordinates of a steady motion. The motion does not depend on the values of these
//! coordinates.

use model::Mechanism;

use super::coordinate::{Coordinate, named};
use super::error::LineariseError;

/// The cyclic coordinates, and the angular velocity of the axes that rotate with them.
pub(crate) struct FollowedCoordinates {
    pub(crate) coordinates: Vec<Coordinate>,
    /// Angular velocity of the axes (rad/s).
    pub(crate) turning: [f64; 3],
}

impl FollowedCoordinates {
    pub(crate) fn of(
        mechanism: &Mechanism,
        (q, v): (&[f64], &[f64]),
        names: &[String],
    ) -> Result<Self, LineariseError> {
        let mut found = Self {
            coordinates: Vec::new(),
            turning: [0.0; 3],
        };
        for name in names {
            let (coordinate, _) = named(mechanism, name)?;
            if coordinate.direction >= 3 {
                let axis = coordinate.direction - 3;
                let state = mechanism.frames().body(coordinate.body, q, v);
                found.turning[axis] = state.omega[axis];
            }
            if !found.coordinates.contains(&coordinate) {
                found.coordinates.push(coordinate);
            }
        }
        Ok(found)
    }
}
