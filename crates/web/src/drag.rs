//! The text of a scene whose body starts in another pose, for bodies that a user drags.

use pfaff::model::FramePose;
use pfaff::question::Control;
use pfaff::refusal::Refusal;
use serde::Deserialize;

use crate::ask::{Source, start};

/// The wanted pose of a body. What is absent does not change.
#[derive(Deserialize)]
pub(crate) struct Pose {
    /// Position of the frame of the body (m).
    position: Option<Vec<f64>>,
    /// Angle of the body in the plane (rad).
    angle: Option<f64>,
    /// Unit quaternion of the body in space.
    orientation: Option<[f64; 4]>,
}

/// Returns the text of the scene whose bodies are at rest, with a body as close to the pose as the
/// joints allow.
pub(crate) fn placed(source: &Source, body: &str, pose: &Pose) -> Result<String, Refusal> {
    let start = start(source);
    let mut assembled = start.assembled(&Control::quiet())?;
    let bodies = assembled.mechanism.bodies();
    let found = bodies.iter().position(|own| own.name == body);
    let found = found.ok_or_else(|| {
        let names: Vec<&str> = bodies.iter().map(|own| own.name.as_str()).collect();
        pfaff::source::unknown("body", body, &names)
    })?;
    let frames = assembled.dragged(found, |frame| pose.of(frame));
    let frames = frames.map_err(|e| start.refusal(e))?;
    let frames: Vec<FramePose> = frames.into_iter().map(rounded).collect();
    let text = pfaff::scene::posed(&assembled.scene, &frames);
    text.map_err(|e| Refusal::input(e.to_string()).coded(e.code()))
}

/// Digits after the point of a number that is written (m, rad). The start corrects what is lost.
const DIGITS: i32 = 12;

/// Returns the frame without the noise of rounding.
fn rounded(frame: FramePose) -> FramePose {
    let scale = 10_f64.powi(DIGITS);
    // The sum removes the sign of zero.
    let round = |x: f64| (x * scale).round() / scale + 0.0;
    match frame {
        FramePose::Plane { position, angle } => FramePose::Plane {
            position: position.map(round),
            angle: round(angle),
        },
        FramePose::Space3 {
            position,
            orientation,
        } => FramePose::Space3 {
            position: position.map(round),
            orientation: orientation.map(round),
        },
    }
}

impl Pose {
    /// Returns the frame with the coordinates of this pose.
    fn of(&self, frame: FramePose) -> FramePose {
        let moved = |old: &[f64], k: usize| {
            let new = self.position.as_ref().and_then(|new| new.get(k));
            new.copied().unwrap_or(old[k])
        };
        match frame {
            FramePose::Plane { position, angle } => FramePose::Plane {
                position: std::array::from_fn(|k| moved(&position, k)),
                angle: self.angle.unwrap_or(angle),
            },
            FramePose::Space3 {
                position,
                orientation,
            } => FramePose::Space3 {
                position: std::array::from_fn(|k| moved(&position, k)),
                orientation: self.orientation.unwrap_or(orientation),
            },
        }
    }
}
