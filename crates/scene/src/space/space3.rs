//! Scenes in space.

use joints::space3::Pose;
use joints::{Argument, Space3};
use model::start::KeepLevel;
use model::{AnyDescription, Definitions, FramePose, Registry, SpatialBody, SpatialDescription};
use serde_json::json;

use super::{BodyCoordinate, SceneSpace};
use crate::dimension::Dimension;
use crate::key::Key;

const GRAVITY: Key = Key::triple("gravity")
    .expecting("an acceleration [gx, gy, gz]")
    .unit(Dimension::ACCELERATION)
    .doc("Acceleration of free bodies [gx, gy, gz]")
    .or(|| json!([0.0, 0.0, 0.0]));

impl SceneSpace for Space3 {
    const NAME: &'static str = "spatial";
    const VECTOR: &'static str = "[x, y, z]";
    const POINT: &'static str = "a point [x, y, z]";
    const GLOBAL_POINT: &'static str = "a global point [x, y, z]";
    const BY_BODY: &'static str = "a table { body = [x, y, z], … }";
    const GRAVITY: Key = GRAVITY;
    const COORDINATES: &'static [BodyCoordinate] = &[
        BodyCoordinate::new("x", 0..1, KeepLevel::Position),
        BodyCoordinate::new("y", 1..2, KeepLevel::Position),
        BodyCoordinate::new("z", 2..3, KeepLevel::Position),
        BodyCoordinate::new("rotation", 3..6, KeepLevel::Position),
        BodyCoordinate::new("vx", 0..1, KeepLevel::Velocity),
        BodyCoordinate::new("vy", 1..2, KeepLevel::Velocity),
        BodyCoordinate::new("vz", 2..3, KeepLevel::Velocity),
        BodyCoordinate::new("wx", 3..4, KeepLevel::Velocity),
        BodyCoordinate::new("wy", 4..5, KeepLevel::Velocity),
        BodyCoordinate::new("wz", 5..6, KeepLevel::Velocity),
        BodyCoordinate::new("omega", 3..6, KeepLevel::Velocity),
    ];

    const CARRIES: bool = true;

    fn described(d: SpatialDescription) -> AnyDescription {
        d.into()
    }

    fn definitions(registry: &Registry) -> &Definitions<Self> {
        registry.space()
    }

    fn from_centre(body: &SpatialBody, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| point[k] - body.centre[k])
    }

    fn to_global(body: &SpatialBody, point: [f64; 3]) -> [f64; 3] {
        body.pose().to_global(point)
    }

    fn moved(body: &SpatialBody, frame: &FramePose) -> SpatialBody {
        let mut moved = body.clone();
        if let &FramePose::Space3 {
            position,
            orientation,
        } = frame
        {
            (moved.position, moved.orientation) = (position, orientation);
        }
        moved
    }

    fn mass(body: &SpatialBody) -> f64 {
        body.mass
    }

    fn carried(
        direction: [f64; 3],
        from: Option<&SpatialBody>,
        to: Option<&SpatialBody>,
    ) -> [f64; 3] {
        const GROUND: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
        let [from, to] = [from, to].map(|body| body.map_or(GROUND, |body| body.orientation));
        // If the axes are equal, the direction is returned without a transformation, because a
        // transformation would add rounding errors.
        if from == to {
            return direction;
        }
        let [from, to] = [from, to].map(|e| Pose::new([0.0; 3], e));
        to.to_local(from.to_global(direction))
    }

    fn of_numbers(numbers: &[f64]) -> Option<[f64; 3]> {
        numbers.try_into().ok()
    }

    fn argument(vector: [f64; 3]) -> Argument {
        Argument::Triple(vector)
    }
}
