//! Joints of other types in place of joints whose reactions are not unique.

use model::SpaceKind;
use model::words::rounded;
use serde::Serialize;

use crate::words::{grouped, marked};

/// Joints of other types that make all reactions of some joints unique. The motion does not change.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RemedyDocument {
    /// The joints and drives whose reactions become unique.
    pub reactions: Vec<String>,
    /// The joints to replace.
    pub replace: Vec<ReplacedJointDocument>,
    /// Whether the mechanism with these joints was analysed, with these results.
    pub verified: bool,
    /// Description.
    pub text: String,
}

/// A joint of another type.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ReplacedJointDocument {
    /// Name of the joint.
    pub joint: String,
    /// Its type in the scene.
    pub from: &'static str,
    /// The new type.
    pub to: &'static str,
    /// Keys of directions with their vectors, in the frame of the first body; absent if the keys of
    /// the scene are kept.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<DirectionDocument>,
    /// Number of force components and of moment components of the new joint.
    #[serde(skip)]
    pub(super) loads: [usize; 2],
}

/// A direction of a joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DirectionDocument {
    /// The key in the scene.
    pub key: &'static str,
    /// The vector.
    pub vector: Vec<f64>,
}

impl ReplacedJointDocument {
    /// Describes the new joint. Its kind follows from its loads.
    fn joint(&self, space: SpaceKind) -> String {
        let kind = match (space, self.loads) {
            (SpaceKind::Space3, [3, 0]) => "a ball joint",
            (SpaceKind::Space3, [2, 0]) => "a ball on a line",
            (SpaceKind::Space3, [1, 0]) => "a ball on a plane",
            (SpaceKind::Space3, [2, 2]) => "a joint that turns and slides",
            (SpaceKind::Plane, [2, 0]) => "a hinge",
            (SpaceKind::Plane, [1, 0]) => "a pin on a line",
            _ => "a joint",
        };
        let directions = self.directions.iter().map(|direction| {
            let vector: Vec<String> = direction.vector.iter().map(|x| rounded(*x)).collect();
            format!(", {} = [{}]", direction.key, vector.join(", "))
        });
        let directions: String = directions.collect();
        format!("{kind} (`{}`{directions})", self.to)
    }

    /// Describes replacements; equal ones are described together.
    pub(super) fn text(all: &[Self], space: SpaceKind) -> String {
        let kinds = grouped(all.iter().map(|x| (x.joint(space), x.joint.as_str())));
        let kinds = kinds.into_iter().map(|(kind, names)| match names.len() {
            1 => format!("{} {kind}", and(&names)),
            _ => format!("each of {} {kind}", and(&names)),
        });
        format!("make {}", kinds.collect::<Vec<_>>().join("; "))
    }
}

/// Lists names in grave accents, such as `` `A`, `B` and `C` ``.
pub(super) fn and(names: &[impl AsRef<str>]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => {
            format!("{} and `{}`", marked(first), last.as_ref())
        }
        names => marked(names),
    }
}
