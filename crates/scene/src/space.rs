//! The differences between the plane and space in the format: vectors, names, and bodies.

mod plane;
mod space3;

use std::ops::Range;

use joints::{Argument, Plane, Space, Space3};
use model::start::KeepLevel;
use model::{AnyDescription, BodySpace, Definitions, FramePose, MechanismDescription, Registry};

use crate::key::Key;

/// Returns the name of the space other than `here` for which the flag in `holds` is true.
fn other(here: &str, holds: [(&'static str, bool); 2]) -> Option<&'static str> {
    let mut others = holds.into_iter().filter(|(name, _)| *name != here);
    others.find_map(|(name, holds)| holds.then_some(name))
}

/// Returns the name of a space other than `here` whose vectors have this number of components.
pub(crate) fn of_length(here: &str, length: usize) -> Option<&'static str> {
    let has = [(Plane::NAME, Plane::DIM), (Space3::NAME, Space3::DIM)];
    other(here, has.map(|(name, dim)| (name, dim == length)))
}

/// Returns the name of a space other than `here` that has this type of joints or forces.
pub(crate) fn of_type(here: &str, registry: &Registry, name: &str) -> Option<&'static str> {
    fn has<S: SceneSpace>(registry: &Registry, name: &str) -> (&'static str, bool) {
        let of = S::definitions(registry);
        let mut specs = of.constraint_specs().chain(of.force_specs());
        (S::NAME, specs.any(|spec| spec.scene_type == name))
    }
    other(
        here,
        [has::<Plane>(registry, name), has::<Space3>(registry, name)],
    )
}

/// A coordinate of a body that may be listed in `keep`, with its name.
pub(crate) struct BodyCoordinate {
    pub(crate) name: &'static str,
    /// The indices of the velocity components that belong to the coordinate.
    pub(crate) dofs: Range<usize>,
    pub(crate) level: KeepLevel,
}

impl BodyCoordinate {
    pub(crate) const fn new(name: &'static str, dofs: Range<usize>, level: KeepLevel) -> Self {
        Self { name, dofs, level }
    }
}

/// The space of a scene.
pub(crate) trait SceneSpace: BodySpace {
    /// Name of the space in `[scene]`.
    const NAME: &'static str;
    /// The word for a vector in messages.
    const VECTOR: &'static str;
    /// The word for a point in messages.
    const POINT: &'static str;
    /// The words for a point in ground coordinates in messages.
    const GLOBAL_POINT: &'static str;
    /// The words for points, one for each body, in messages.
    const BY_BODY: &'static str;
    /// The key for the acceleration due to gravity.
    const GRAVITY: Key;
    /// Coordinates of a body that may be listed in `keep`.
    const COORDINATES: &'static [BodyCoordinate];

    /// Whether directions may be given in ground axes (`frame = "global"`), and whether directions
    /// on the second body are given in the axes of the first body.
    const CARRIES: bool;

    /// Converts the description to the type for programs that accept both spaces.
    fn described(d: MechanismDescription<Self>) -> AnyDescription;

    /// The definitions of a registry that belong to this space.
    fn definitions(registry: &Registry) -> &Definitions<Self>;

    /// Converts a point of a body frame to a point relative to the centre of mass.
    fn from_centre(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// The inverse of [`BodySpace::to_local`].
    fn to_global(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// Returns the body with its frame in another pose.
    fn moved(body: &Self::Body, frame: &FramePose) -> Self::Body;

    /// Returns the mass of a body (kg).
    fn mass(body: &Self::Body) -> f64;

    /// Transforms a direction from the axes of a body, or of the ground, to the axes of another
    /// body. In the plane the direction does not change, because each direction is given in the
    /// axes of its own body.
    fn carried(
        direction: Self::Vector<f64>,
        from: Option<&Self::Body>,
        to: Option<&Self::Body>,
    ) -> Self::Vector<f64>;

    /// Returns the vector with these components; `None` if their number is wrong.
    fn of_numbers(numbers: &[f64]) -> Option<Self::Vector<f64>>;

    /// Converts a point or a direction to an argument of a definition.
    fn argument(vector: Self::Vector<f64>) -> Argument;

    /// Converts an axis, and the direction perpendicular to it if one is given, to an argument of a
    /// definition.
    fn axis(axis: Self::Vector<f64>, across: Option<Self::Vector<f64>>) -> Argument {
        Argument::Axis(Self::point(axis), across.map(Self::point))
    }
}
