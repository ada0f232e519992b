//! Differences of the format between plane and space: vectors, names, and bodies.

mod plane;
mod space3;

use std::ops::Range;

use joints::{Argument, Plane, Space, Space3};
use model::start::KeepLevel;
use model::{AnyDescription, BodySpace, Definitions, MechanismDescription, Registry};

use crate::key::Key;

/// The name of the space other than `here` for which the flag is true.
fn other(here: &str, holds: [(&'static str, bool); 2]) -> Option<&'static str> {
    let mut others = holds.into_iter().filter(|(name, _)| *name != here);
    others.find_map(|(name, holds)| holds.then_some(name))
}

/// The other space whose vectors have this number of components.
pub(crate) fn of_length(here: &str, length: usize) -> Option<&'static str> {
    let has = [(Plane::NAME, Plane::DIM), (Space3::NAME, Space3::DIM)];
    other(here, has.map(|(name, dim)| (name, dim == length)))
}

/// The other space that has this type of joints or forces.
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

/// A coordinate of a body that the start may keep, with its name.
pub(crate) struct BodyCoordinate {
    pub(crate) name: &'static str,
    /// Degrees of freedom of the body.
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
    /// A vector, as written in messages.
    const VECTOR: &'static str;
    /// A point, as written in messages.
    const POINT: &'static str;
    /// A point in global coordinates, as written in messages.
    const GLOBAL_POINT: &'static str;
    /// Points, one for each body, as written in messages.
    const BY_BODY: &'static str;
    /// The key for the acceleration of free fall.
    const GRAVITY: Key;
    /// Coordinates of a body that the start may keep.
    const COORDINATES: &'static [BodyCoordinate];

    /// Whether directions may be written in the axes of the ground (`frame = "global"`), and
    /// whether directions of a second body are written in the axes of the first one.
    const CARRIES: bool;

    /// The description for programs that accept both spaces.
    fn described(d: MechanismDescription<Self>) -> AnyDescription;

    /// The definitions of a registry that belong to this space.
    fn definitions(registry: &Registry) -> &Definitions<Self>;

    /// A point in the frame of a body relative to its centre of mass.
    fn from_centre(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// The inverse of [`BodySpace::to_local`].
    fn to_global(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// Converts a direction from the axes of a body, or of the ground, to the axes of another body.
    /// In the plane each direction is written in the axes of its own body.
    fn carried(
        direction: Self::Vector<f64>,
        from: Option<&Self::Body>,
        to: Option<&Self::Body>,
    ) -> Self::Vector<f64>;

    /// The vector with these components.
    fn of_numbers(numbers: &[f64]) -> Option<Self::Vector<f64>>;

    /// A point or a direction as the argument of a definition.
    fn argument(vector: Self::Vector<f64>) -> Argument;

    /// An axis, with a vector across it if one is given, as the argument of a definition.
    fn axis(axis: Self::Vector<f64>, across: Option<Self::Vector<f64>>) -> Argument {
        Argument::Axis(Self::point(axis), across.map(Self::point))
    }
}
