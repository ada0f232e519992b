//! Joints of other types in place of joints whose reactions are not unique.

use report::ByName;
use serde::Serialize;

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
    #[serde(skip_serializing_if = "Option::is_none")]
    pub directions: Option<ByName<Vec<f64>>>,
}
