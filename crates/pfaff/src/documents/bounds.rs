//! Bounds of reactions over a run, for elastic joints.

use serde::Serialize;

use super::Gap;

/// The assumptions of the bounds of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RunBoundsDocument {
    /// The assumptions under which the bounds are valid.
    pub assumption: String,
    /// Joints and drives that do not give way, if requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rigid: Vec<String>,
    /// The largest ratio of compliances to the nominal ones, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// Rows at which some reactions have no bounds. The largest and smallest values over the run do
    /// not cover these rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<Gap>,
}

/// An extreme value over a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ExtremeDocument {
    /// The value (N, N·m).
    pub value: f64,
    /// The first time at which the value occurs (s).
    pub time: f64,
}

/// The smallest lower bound and the largest upper bound of a number over a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RangeOfRunDocument {
    /// The smallest value.
    pub lowest: ExtremeDocument,
    /// The largest value.
    pub highest: ExtremeDocument,
}

/// The largest magnitudes of a load over a run, or upper bounds of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MagnitudeOfRunDocument {
    /// Largest magnitude of the force (N); `null` if there is no force.
    pub force: Option<ExtremeDocument>,
    /// Largest magnitude of the moment about the reference point (N·m); `null` if there is no
    /// moment.
    pub moment: Option<ExtremeDocument>,
}

impl ExtremeDocument {
    /// An extreme value at a time (s).
    pub(crate) fn new(value: f64, time: f64) -> Self {
        Self { value, time }
    }
}

impl MagnitudeOfRunDocument {
    /// The largest magnitudes of the force and of the moment.
    pub(crate) fn new(force: Option<ExtremeDocument>, moment: Option<ExtremeDocument>) -> Self {
        Self { force, moment }
    }
}

impl RangeOfRunDocument {
    /// The range of a number that has these bounds at one time (s).
    pub(crate) fn at(time: f64, [lowest, highest]: [f64; 2]) -> Self {
        Self {
            lowest: ExtremeDocument::new(lowest, time),
            highest: ExtremeDocument::new(highest, time),
        }
    }

    /// Adds the bounds at another time.
    pub(crate) fn include(&mut self, other: Self) {
        if other.lowest.value < self.lowest.value {
            self.lowest = other.lowest;
        }
        if other.highest.value > self.highest.value {
            self.highest = other.highest;
        }
    }
}
