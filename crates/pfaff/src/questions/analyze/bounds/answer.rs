//! Bounds of reactions and their assumptions.

use std::fmt;

use model::Layout;
use model::reaction::ConstraintGroup;
use report::ByName;
use serde::Serialize;
use solvability::{ComplianceRange, ElasticBounds, ElasticLoad};

use crate::elasticity::assumption;

/// The assumptions of the bounds, and the extent of the search.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BoundsDocument {
    /// The assumptions under which the bounds are valid.
    pub assumption: String,
    /// Joints and drives that do not give way, if requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rigid: Vec<String>,
    /// The largest ratio of compliances to the nominal ones, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// The points (m) about which the moments of joints give way, for joints whose moments are not
    /// unique.
    pub centres: ByName<Vec<f64>>,
    /// Number of sets of load components that can be zero together.
    pub eliminations: u64,
    /// Whether all sets were examined. Otherwise some numbers have a range that is reached in place
    /// of bounds.
    pub complete: bool,
    /// Joints and drives without bounds, with the reason.
    pub without: ByName<String>,
    /// Reason why there are no bounds at this configuration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// The smallest and the largest value of a number for joints of any stiffness.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BoundsOfNumber {
    /// The smallest value (N, N·m).
    pub lowest: f64,
    /// The largest value (N, N·m).
    pub highest: f64,
    /// The loads whose joints give way at the smallest value.
    pub at_lowest: Vec<ElasticLoadDocument>,
    /// The loads whose joints give way at the largest value.
    pub at_highest: Vec<ElasticLoadDocument>,
    /// Whether the smallest and the largest value are reached in the limit of some stiffness.
    /// Otherwise the true range may end earlier.
    pub reached: [bool; 2],
}

/// The range of a number for joints of any stiffness: bounds, or a range that is reached.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RangeDocument {
    /// Bounds for joints of any stiffness, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<BoundsOfNumber>,
    /// A range whose values some compliances give, if there are too many sets to examine all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reached_at_least: Option<[f64; 2]>,
}

/// The force or the moment of a joint or drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ElasticLoadDocument {
    /// The joint or drive.
    pub joint: String,
    /// `force` or `moment`.
    pub group: &'static str,
}

/// Upper bounds of the magnitudes of a load for joints of any stiffness.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MagnitudeDocument {
    /// Largest magnitude of the force (N); `null` if the joint has no force.
    pub force: Option<f64>,
    /// Largest magnitude of the moment about the reference point (N·m); `null` if the joint has no
    /// moment.
    pub moment: Option<f64>,
}

impl BoundsDocument {
    /// States the assumptions for these joints and drives. The reactions of these joints and drives
    /// are not unique.
    pub(super) fn new(
        open: &[&ConstraintGroup],
        has_tolerance: bool,
        within: Option<&ComplianceRange>,
    ) -> Self {
        Self {
            assumption: assumption(open, has_tolerance, within),
            rigid: Vec::new(),
            within: within.map(|range| range.factor),
            centres: ByName(Vec::new()),
            eliminations: 0,
            complete: true,
            without: ByName(Vec::new()),
            reason: None,
        }
    }
}

impl RangeDocument {
    /// Builds the document of the range of a number.
    pub(super) fn new(range: &ElasticBounds, layout: &Layout) -> Self {
        if range.complete {
            Self {
                bounds: Some(BoundsOfNumber::new(range, layout)),
                reached_at_least: None,
            }
        } else {
            Self {
                bounds: None,
                reached_at_least: Some([range.lowest, range.highest]),
            }
        }
    }
}

impl BoundsOfNumber {
    fn new(bounds: &ElasticBounds, layout: &Layout) -> Self {
        let loads = |loads: &[ElasticLoad]| {
            let load = |load: &ElasticLoad| ElasticLoadDocument {
                joint: layout.groups[load.reaction.0].name.clone(),
                group: if load.is_moment { "moment" } else { "force" },
            };
            loads.iter().map(load).collect()
        };
        Self {
            lowest: bounds.lowest,
            highest: bounds.highest,
            at_lowest: loads(&bounds.at_lowest),
            at_highest: loads(&bounds.at_highest),
            reached: bounds.reached,
        }
    }
}

impl fmt::Display for ElasticLoadDocument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.group, self.joint)
    }
}
