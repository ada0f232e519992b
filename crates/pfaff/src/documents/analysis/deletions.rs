//! Rows that may be deleted: admissible sets of rows, and the smallest sets that make a reaction
//! unique.

use serde::Serialize;
use solvability::{DeletableRows, EliminationError, Proposals};

use crate::documents::from_one;

/// Sets of rows that can be deleted without a change of motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EliminationsDocument {
    /// Number of sets; `None` if they could not be counted.
    pub count: Option<u128>,
    /// Reason why they could not be counted or listed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The first sets, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sets: Option<Vec<Vec<usize>>>,
}

/// The smallest deletions that make a reaction unique.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MakeUniqueDocument {
    /// Name of the joint or drive.
    pub reaction: String,
    /// Kind of allowed deletions: `sensible`, `sensible, whole` if deletions must include whole
    /// joints, `whole` or `rows`.
    pub allowed: &'static str,
    /// Each set of deletions is sufficient by itself, and none of its rows can be omitted; if no
    /// deletion is needed, the list contains one set without rows.
    pub ways: Vec<WayDocument>,
    /// Whether all sets of that size are listed.
    pub complete: bool,
    /// Reason why the deletions could not be determined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// One way to make a reaction unique.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WayDocument {
    /// Rows to delete.
    pub rows: Vec<usize>,
    /// Description.
    pub text: String,
}

impl EliminationsDocument {
    /// Stores the number of sets, and the first sets if they are requested (rows 0-based).
    #[must_use]
    pub fn new(
        count: Result<u128, EliminationError>,
        sets: Option<Result<Vec<Vec<usize>>, EliminationError>>,
    ) -> Self {
        let mut reason = count.as_ref().err().map(ToString::to_string);
        let sets = match sets {
            Some(Ok(sets)) => Some(sets.iter().map(|set| from_one(set)).collect()),
            Some(Err(e)) => {
                reason.get_or_insert_with(|| e.to_string());
                None
            }
            None => None,
        };
        Self {
            count: count.ok(),
            reason,
            sets,
        }
    }
}

impl MakeUniqueDocument {
    /// The deletions that make this reaction unique.
    #[must_use]
    pub fn new(
        reaction: &str,
        allowed: &DeletableRows,
        found: Result<Proposals, EliminationError>,
    ) -> Self {
        let is_whole = found.as_ref().is_ok_and(|found| found.whole);
        let allowed = match allowed {
            DeletableRows::Sensible if is_whole => "sensible, whole",
            DeletableRows::Sensible => "sensible",
            DeletableRows::Whole => "whole",
            DeletableRows::Rows(_) => "rows",
        };
        let (ways, complete, reason) = match found {
            Ok(found) => (found.ways, found.complete, None),
            Err(e) => (Vec::new(), false, Some(e.to_string())),
        };
        let way = |way: solvability::make_unique::Proposal| WayDocument {
            rows: from_one(&way.rows),
            text: way.text,
        };
        Self {
            reaction: reaction.to_owned(),
            allowed,
            ways: ways.into_iter().map(way).collect(),
            complete,
            reason,
        }
    }
}
