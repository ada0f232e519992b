//! What the format says differently in the plane and in space: keys, vectors, and what bodies are.

mod orientation;
mod plane;
mod space3;

pub(crate) use orientation::{ANGLE, AXIS, MATRIX, QUATERNION, RPY};

use joints::Argument;
use model::{AnyDescription, BodySpace, Definitions, Described, Registry};

use crate::findings::Findings;
use crate::key::Key;
use crate::start::Kept;
use crate::table::Table;

/// The space of a scene.
pub(crate) trait SceneSpace: BodySpace {
    /// Its name in `[scene]`.
    const NAME: &'static str;
    /// A vector, as messages write it.
    const VECTOR: &'static str;
    /// A point.
    const POINT: &'static str;
    /// A point in global coordinates.
    const GLOBAL_POINT: &'static str;
    /// Points, one for each body.
    const BY_BODY: &'static str;
    /// The acceleration of free fall.
    const GRAVITY: Key;
    /// Keys of a body in addition to its name.
    const BODY_KEYS: &'static [Key];
    /// Keys of a marker in addition to its name.
    const MARKER_KEYS: &'static [Key];
    /// What the start may hold of a body.
    const KEPT: &'static [Kept];

    /// Whether directions may be written in the axes of the ground (`frame = "global"`), and those
    /// of a second body are written in the axes of the first one.
    const CARRIES: bool;

    /// The description for programs that take those of both spaces.
    fn described(d: Described<Self>) -> AnyDescription;

    /// The definitions of a registry that belong here.
    fn definitions(registry: &Registry) -> &Definitions<Self>;

    /// Reads one body; numbers that cannot be read are zero.
    fn read_body(table: &mut Table, name: &str, findings: &mut Findings) -> Self::Body;

    /// A point in the frame of a body relative to its centre of mass.
    fn from_centre(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// The inverse of [`BodySpace::to_local`].
    fn to_global(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;

    /// A direction that is written in the axes of a body, or of the ground, in those of another one.
    /// In the plane all directions are written in the axes of their own body.
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
