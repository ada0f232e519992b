//! Errors if the rows requested by the user cannot be treated as redundant. Messages count rows
//! from 1, as users do.

use model::RowLabel;
use model::codes::Code;
use model::words::short;
use rank::KeptRowsError;

/// Reason why requested rows cannot be treated as redundant.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DropError {
    /// No row is redundant.
    #[error("no row can be dropped: the degree of redundancy is 0, and all rows are needed")]
    NotRedundant,
    /// The number of rows differs from the degree of redundancy.
    #[error("{} dropped, but the degree of redundancy is {redundancy}: drop exactly {redundancy}", rows_are(*.dropped))]
    Count {
        /// Number of requested rows.
        dropped: usize,
        /// Degree of redundancy p.
        redundancy: usize,
    },
    /// A row does not exist.
    #[error("row {} cannot be dropped: rows are 1 to {rows}", row + 1)]
    OutOfRange {
        /// The row, from 0.
        row: usize,
        /// Number of rows.
        rows: usize,
    },
    /// A row is listed twice.
    #[error("row {row} is listed twice")]
    Twice {
        /// The row.
        row: RowLabel,
    },
    /// The remaining rows are dependent.
    #[error(
        "at t = 0 s these rows cannot be dropped: what is kept is dependent (smallest singular value \
         {smallest_singular_value}, need {required}). `pfaff analyze` lists the dependent sets; drop one row of each", smallest_singular_value = short(*smallest_singular_value), required = short(*required))]
    Dependent {
        /// Smallest singular value of the remaining rows, with rows and columns scaled.
        smallest_singular_value: f64,
        /// The smallest value allowed.
        required: f64,
    },
    /// The constraint matrix at the start cannot be analysed.
    #[error(transparent)]
    Kept(KeptRowsError),
}

impl DropError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NotRedundant { .. }
            | Self::Count { .. }
            | Self::OutOfRange { .. }
            | Self::Twice { .. }
            | Self::Dependent { .. }
            | Self::Kept { .. } => const { Code::new(403) },
        }
    }
}

fn rows_are(n: usize) -> String {
    match n {
        1 => "1 row is".to_owned(),
        n => format!("{n} rows are"),
    }
}

impl DropError {
    pub(crate) fn new(error: KeptRowsError, labels: &[RowLabel], redundancy: usize) -> Self {
        match error {
            KeptRowsError::WrongCount { .. } if redundancy == 0 => Self::NotRedundant,
            KeptRowsError::WrongCount { dropped, .. } => Self::Count {
                dropped,
                redundancy,
            },
            KeptRowsError::RowOutOfRange { row, rows } => Self::OutOfRange { row, rows },
            KeptRowsError::Duplicate { row } => match labels.get(row) {
                Some(label) => Self::Twice { row: label.clone() },
                None => Self::Kept(error),
            },
            KeptRowsError::Dependent {
                smallest_singular_value,
                required,
            } => Self::Dependent {
                smallest_singular_value,
                required,
            },
            other => Self::Kept(other),
        }
    }
}
