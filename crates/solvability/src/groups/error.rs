//! Errors in a request about reactions.

use crate::matrices::QueryError;
use model::codes::Code;
use model::{ConstraintId, Mechanism, System};

/// Reason why a request is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RequestError {
    /// A joint or drive that does not exist.
    #[error("there is no joint or drive {id}; the mechanism has {reactions}, counted from 0")]
    UnknownReaction {
        /// Number of the joint or drive, from 0.
        id: usize,
        /// Number of reactions.
        reactions: usize,
    },
    /// A component that the reaction does not have.
    #[error("the reaction of `{reaction}` has no component `{component}`; it has {available}")]
    UnknownComponent {
        /// The joint or drive.
        reaction: String,
        /// Name of the requested component.
        component: String,
        /// Names of the components of the reaction.
        available: String,
    },
    /// A body that does not exist.
    #[error("there is no body {body}; the mechanism has {bodies}, counted from 0")]
    UnknownBody {
        /// Number of the body, from 0.
        body: usize,
        /// Number of bodies.
        bodies: usize,
    },
    /// A row that does not exist.
    #[error("there is no row {row}; the matrix has {rows}, counted from 0")]
    UnknownRow {
        /// Number of the row, from 0.
        row: usize,
        /// Number of rows.
        rows: usize,
    },
    /// Too many rows are on common cycles.
    #[error(
        "{joints} are on common cycles with {rows} rows in total; this question is possible up to {most} rows. Other parts of the mechanism can be analysed"
    )]
    Large {
        /// The first joints and drives of the part.
        joints: String,
        /// Number of rows of the part.
        rows: usize,
        /// Largest permitted number of rows.
        most: usize,
    },
    /// The solvability belongs to another constraint matrix.
    #[error(transparent)]
    Query(#[from] QueryError),
    /// An empty group.
    #[error("a group needs at least one {of}")]
    Empty {
        /// The kind of elements that the group should contain.
        of: &'static str,
    },
    /// A value is NaN or infinite.
    #[error("{argument} contains {value} at {index}, need finite numbers")]
    NotFinite {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the entry.
        index: usize,
        /// The value.
        value: f64,
    },
    /// An argument has the wrong length.
    #[error("{argument} has {found} entries, need {expected}")]
    Length {
        /// Name of the argument.
        argument: &'static str,
        /// Length of the argument.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
}

impl RequestError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::UnknownReaction { .. }
            | Self::UnknownComponent { .. }
            | Self::UnknownBody { .. }
            | Self::UnknownRow { .. } => const { Code::new(310) },
            Self::Large { .. } => const { Code::new(303) },
            Self::Query(_) => const { Code::new(302) },
            Self::Empty { .. } | Self::NotFinite { .. } | Self::Length { .. } => {
                const { Code::new(311) }
            }
        }
    }
}

/// Returns the error for a joint or drive that does not exist. If the joint or drive exists,
/// returns the error for a component that it does not have.
pub(crate) fn unknown_component(
    mechanism: &Mechanism,
    id: ConstraintId,
    name: &str,
) -> RequestError {
    let groups = &mechanism.layout().groups;
    let Some(group) = groups.get(id.0) else {
        return RequestError::UnknownReaction {
            id: id.0,
            reactions: groups.len(),
        };
    };
    let named = group.spec.component.map(|name| format!(", `{name}`"));
    RequestError::UnknownComponent {
        reaction: group.name.clone(),
        component: name.to_owned(),
        available: format!(
            "`{}`{}",
            mechanism.space().components().join("`, `"),
            named.unwrap_or_default()
        ),
    }
}

/// Checks the length of an argument, and checks that its entries are finite.
pub(crate) fn check(
    argument: &'static str,
    x: &[f64],
    expected: usize,
) -> Result<(), RequestError> {
    if x.len() != expected {
        return Err(RequestError::Length {
            argument,
            found: x.len(),
            expected,
        });
    }
    check_finite(argument, x)
}

/// Checks that all entries are finite.
pub(crate) fn check_finite(argument: &'static str, x: &[f64]) -> Result<(), RequestError> {
    match x.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(RequestError::NotFinite {
            argument,
            index,
            value: x[index],
        }),
        None => Ok(()),
    }
}
