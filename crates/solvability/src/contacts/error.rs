//! Reasons why the permitted loads are not known.

use std::sync::Arc;

use crate::choices::ChoiceError;
use crate::groups::RequestError;
use crate::polyhedra::Unclear;
use crate::value::NoFiniteReaction;

/// Reason why the loads that contacts permit are not known.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PermittedError {
    /// The rank is undecided.
    #[error("the rank is undecided")]
    Rank,
    /// It is undecided whether a number is unique.
    #[error("the verdict on the load of `{0}` is undecided")]
    Verdict(String),
    /// A load is too close to a limit of a contact.
    #[error("a load is so close to the limit of a contact that its side is undecided")]
    Unclear,
    /// No finite reactions exist.
    #[error("no finite reaction exists")]
    NoFinite(Arc<NoFiniteReaction>),
    /// The accelerations after contacts have opened are not determined.
    #[error("the accelerations are not determined: {0}")]
    Accelerations(String),
    /// The request is invalid.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// The equations have no solution.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
}

impl From<Unclear> for PermittedError {
    fn from(_: Unclear) -> Self {
        Self::Unclear
    }
}
