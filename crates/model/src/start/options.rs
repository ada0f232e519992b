//! Options of a start.

use super::error::StartError;
use crate::mechanism::{Mechanism, N_BODY};

/// Options of a start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartOptions {
    /// Coordinates and velocities that keep their described values exactly; a velocity that is not
    /// given stays zero.
    pub keep: Vec<Coordinate>,
    /// Whether a correction by more than a thousandth of the size of the scene is accepted, or a
    /// correction of given velocities by more than a thousandth of the fastest ones coupled with
    /// them.
    pub correction: CorrectionLimit,
}

/// Limit of the corrections of a start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CorrectionLimit {
    /// Corrections up to a thousandth of the scene's size, and a thousandth of a radian; given
    /// velocities up to a thousandth of the fastest.
    #[default]
    Small,
    /// Corrections of any size.
    Any,
}

/// One coordinate or velocity of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// Index of the body in the list.
    pub body: usize,
    /// 0 for x, 1 for y, 2 for the angle.
    pub dof: usize,
    /// Position or velocity.
    pub level: KeepLevel,
}

/// Position or velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepLevel {
    /// `x`, `y` or `angle`
    Position,
    /// `vx`, `vy` or `omega`
    Velocity,
}

/// Columns that are kept at a level.
pub(super) fn kept_columns(
    mechanism: &Mechanism,
    options: &StartOptions,
    level: KeepLevel,
) -> Result<Vec<usize>, StartError> {
    let bodies = mechanism.bodies().len();
    let kept = || options.keep.iter().filter(|c| c.level == level);
    kept()
        .map(|&Coordinate { body, dof, .. }| {
            if body >= bodies || dof >= N_BODY {
                return Err(StartError::NoCoordinate { body, dof, bodies });
            }
            let described = &mechanism.bodies()[body];
            let turns = |c: &Coordinate| (c.body, c.dof) == (body, 2);
            let is_open = match level {
                KeepLevel::Position => false,
                KeepLevel::Velocity => described.velocity.is_none(),
            };
            if dof < 2 && !described.is_centred() && (is_open || !kept().any(turns)) {
                let body = described.name.clone();
                return Err(StartError::KeptOrigin { body, level });
            }
            Ok(N_BODY * body + dof)
        })
        .collect()
}
