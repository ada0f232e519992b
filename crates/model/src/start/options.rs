//! Options for the computation of the initial state.

use super::error::StartError;
use crate::body::FramePose;
use crate::mechanism::Mechanism;
use crate::space::SpaceKind;

/// Options for the computation of the initial state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartOptions {
    /// Coordinates and velocities that exactly keep their described values. A kept velocity that is
    /// not given is zero.
    pub keep: Vec<Coordinate>,
    /// Whether larger corrections are accepted. Without this option, positions are corrected by at
    /// most a thousandth of the size of the scene. Given velocities are corrected by at most a
    /// thousandth of the largest velocity coupled with them.
    pub correction: CorrectionLimit,
    /// Initial poses of bodies that do not start at the pose given in their definition. Reference
    /// points, initial values and the zeros of joint coordinates are still computed from the pose
    /// in the definition.
    pub poses: Vec<StartPose>,
    /// The state at which the mechanism starts, in place of `poses` and of given velocities.
    /// Reference points and initial values are computed as for `poses`.
    pub state: Option<State>,
}

/// Coordinates and velocities at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Coordinates, n_q values.
    pub q: Vec<f64>,
    /// Velocities, n_v values.
    pub v: Vec<f64>,
}

/// The initial pose of a body that does not start at the pose given in its definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPose {
    /// Index of the body in the list.
    pub body: usize,
    /// Pose of the body frame.
    pub frame: FramePose,
}

/// Limit for corrections of the initial state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CorrectionLimit {
    /// Positions may be corrected by up to a thousandth of the size of the scene, and angles by up
    /// to a thousandth of a radian. Given velocities may be corrected by up to a thousandth of the
    /// largest velocity.
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
    /// Index of the velocity component: in the plane 0 for x, 1 for y, 2 for the angle; in space 0
    /// to 2 for x, y and z, then the rotations. Single components of an angular velocity refer to
    /// ground axes. For positions, the components of a rotation cannot be kept separately.
    pub dof: usize,
    /// Position or velocity.
    pub level: KeepLevel,
}

/// Position or velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepLevel {
    /// Position: `x`, `y` or `angle`; in space `x`, `y`, `z` or `rotation`.
    Position,
    /// Velocity: `vx`, `vy` or `omega`; in space `vx`, `vy`, `vz`, `wx`, `wy`, `wz`, or `omega` for
    /// the last three velocities.
    Velocity,
}

/// Returns the columns that are kept for positions or for velocities.
pub(super) fn kept_columns(
    mechanism: &Mechanism,
    options: &StartOptions,
    level: KeepLevel,
) -> Result<Vec<usize>, StartError> {
    let (space, bodies) = (mechanism.space(), mechanism.bodies().len());
    let kept = || options.keep.iter().filter(|c| c.level == level);
    kept()
        .map(|&Coordinate { body, dof, .. }| {
            if body >= bodies || dof >= space.n_v() {
                return Err(StartError::NoCoordinate { body, dof, bodies });
            }
            let described = &mechanism.bodies()[body];
            let turns = |dof: usize| dof >= space.n_translations();
            let is_kept = |rotation: usize| {
                let turn = (body, space.n_translations() + rotation);
                kept().any(|c| (c.body, c.dof) == turn)
            };
            let is_turn_kept = || (0..space.n_rotations()).all(is_kept);
            let is_open = match level {
                KeepLevel::Position => false,
                KeepLevel::Velocity => !described.has_velocity(),
            };
            if !turns(dof) && !described.is_centred() && (is_open || !is_turn_kept()) {
                let rotation = match (level, space) {
                    (KeepLevel::Velocity, _) => "omega",
                    (KeepLevel::Position, SpaceKind::Space3) => "rotation",
                    (KeepLevel::Position, _) => "angle",
                };
                return Err(StartError::KeptOrigin {
                    body: described.name.clone(),
                    level,
                    rotation,
                });
            }
            Ok(space.n_v() * body + dof)
        })
        .collect()
}
