//! Errors if a reaction has no finite value.

use model::ConstraintId;
use model::words::listed;
use serde::Serialize;

/// Reactions of connected bodies that have no finite value, because the loads act along a freedom
/// that second order excludes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NoFiniteReaction {
    /// The joints and drives.
    #[serde(skip)]
    pub reactions: Vec<ConstraintId>,
    /// Rows of C of these joints and drives, from 0, ascending.
    #[serde(skip)]
    pub rows: Vec<usize>,
    /// Description of the freedom as text.
    pub freedom: String,
    /// The loads that act along it: `gravity`, names of forces in backquotes, `inertia`.
    pub loads: Vec<String>,
    /// Whether it is proved that no finite reactions exist; otherwise their existence is undecided.
    /// The field is serialised only if it is false.
    #[serde(skip_serializing_if = "std::clone::Clone::clone")]
    pub decided: bool,
}

impl std::fmt::Display for NoFiniteReaction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (loads, freedom) = (listed(&self.loads), &self.freedom);
        if self.decided {
            write!(
                f,
                "no finite reaction exists: the loads ({loads}) push along a freedom that second order excludes ({freedom})"
            )
        } else {
            write!(
                f,
                "whether finite reactions exist is not decided: the loads ({loads}) push along a freedom that second order restricts ({freedom})"
            )
        }
    }
}
