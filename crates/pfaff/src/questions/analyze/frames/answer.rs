//! Verdicts in other frames.

use model::Frame;
use serde::Serialize;
use solvability::FrameVerdict;

use crate::documents::analysis::ComponentDocument;

/// The verdicts of a reaction in one frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrameDocument {
    /// `global`, `first_body`, `joint` or `edge`.
    pub frame: &'static str,
    /// Unit vectors of the axes, in global components.
    pub axes: Vec<Vec<f64>>,
    /// Verdicts on the components along the axes, and on the torque.
    pub components: Vec<ComponentDocument>,
}

impl From<&FrameVerdict> for FrameDocument {
    fn from(found: &FrameVerdict) -> Self {
        let frame = match found.frame {
            Frame::Global => "global",
            Frame::FirstBody => "first_body",
            Frame::Joint => "joint",
            Frame::Edge => "edge",
        };
        Self {
            frame,
            axes: found
                .axes
                .iter()
                .map(|axis| axis[..found.axes.len()].to_vec())
                .collect(),
            components: found.components.iter().map(Into::into).collect(),
        }
    }
}
