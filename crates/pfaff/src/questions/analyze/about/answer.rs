//! Verdicts on moments about a point.

use serde::Serialize;

use crate::documents::analysis::ComponentDocument;

/// The verdict on a moment about a point.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MomentAboutDocument {
    /// The point (m), ground axes.
    pub about: Vec<f64>,
    /// Verdicts on the components of the moment.
    pub components: Vec<ComponentDocument>,
}
