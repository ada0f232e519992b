//! Scenes in the plane.

use joints::{Argument, Plane};
use model::start::KeepLevel;
use model::{AnyDescription, Body, Definitions, Description, FramePose, Registry};
use serde_json::json;

use super::{BodyCoordinate, SceneSpace};
use crate::dimension::Dimension;
use crate::key::Key;

const GRAVITY: Key = Key::pair("gravity")
    .expecting("an acceleration [gx, gy]")
    .unit(Dimension::ACCELERATION)
    .doc("Acceleration of free bodies [gx, gy]")
    .or(|| json!([0.0, 0.0]));

impl SceneSpace for Plane {
    const NAME: &'static str = "plane";
    const VECTOR: &'static str = "[x, y]";
    const POINT: &'static str = "a point [x, y]";
    const GLOBAL_POINT: &'static str = "a global point [x, y]";
    const BY_BODY: &'static str = "a table { body = [x, y], … }";
    const GRAVITY: Key = GRAVITY;
    const COORDINATES: &'static [BodyCoordinate] = &[
        BodyCoordinate::new("x", 0..1, KeepLevel::Position),
        BodyCoordinate::new("y", 1..2, KeepLevel::Position),
        BodyCoordinate::new("angle", 2..3, KeepLevel::Position),
        BodyCoordinate::new("vx", 0..1, KeepLevel::Velocity),
        BodyCoordinate::new("vy", 1..2, KeepLevel::Velocity),
        BodyCoordinate::new("omega", 2..3, KeepLevel::Velocity),
    ];

    const CARRIES: bool = false;

    fn described(d: Description) -> AnyDescription {
        d.into()
    }

    fn definitions(registry: &Registry) -> &Definitions<Self> {
        registry.plane()
    }

    fn from_centre(body: &Body, point: [f64; 2]) -> [f64; 2] {
        body.from_centre(point)
    }

    fn to_global(body: &Body, point: [f64; 2]) -> [f64; 2] {
        body.pose().to_global(point)
    }

    fn moved(body: &Body, frame: &FramePose) -> Body {
        let mut moved = body.clone();
        if let &FramePose::Plane { position, angle } = frame {
            (moved.position, moved.angle) = (position, angle);
        }
        moved
    }

    fn mass(body: &Body) -> f64 {
        body.mass
    }

    fn carried(direction: [f64; 2], _: Option<&Body>, _: Option<&Body>) -> [f64; 2] {
        direction
    }

    fn of_numbers(numbers: &[f64]) -> Option<[f64; 2]> {
        numbers.try_into().ok()
    }

    fn argument(vector: [f64; 2]) -> Argument {
        Argument::Pair(vector)
    }
}
