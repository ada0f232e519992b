//! Errors of choices among non-unique reactions.

use linalg::SaddleError;
use model::codes::Code;
use model::words::short;
use model::{ForceWithoutDerivatives, RowLabel};
use rank::{Doubt, KeptRowsError};

use crate::groups::RequestError;

/// Reason why a distribution cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChoiceError {
    /// The rank is undecided, so the choices are not determined.
    #[error("the rank is undecided, so no choice can be computed: {0}")]
    Undecided(Doubt),
    /// An argument is invalid.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// The equations cannot be solved on the kept rows.
    #[error(transparent)]
    Saddle(#[from] SaddleError),
    /// Derivatives of forces are required, but a force calls an external function.
    #[error(transparent)]
    Called(#[from] ForceWithoutDerivatives),
    /// Redundant rows require different accelerations, so no reactions exist.
    #[error(
        "row {} requires an acceleration that differs by {by} from the acceleration of the kept rows (rounding error: {allowed}): no reactions satisfy both",
        row + 1, by = short(*by), allowed = short(*allowed))]
    Contradiction {
        /// The dropped row, from 0.
        row: usize,
        /// Difference of the accelerations.
        by: f64,
        /// Largest difference that rounding can cause.
        allowed: f64,
    },
    /// A weight or compliance is negative or not a number.
    #[error("a weight is {value}, need a finite number ≥ 0", value = short(*value))]
    Weight {
        /// The weight.
        value: f64,
    },
    /// A misfit is not a finite number.
    #[error("a misfit is {value}, need a finite number", value = short(*value))]
    Misfit {
        /// The value.
        value: f64,
    },
    /// A misfit causes a load through rows that slip.
    #[error(
        "the misfit of `{misfit}` loads `{slipping}`, which slips: its load does not last, and no preload is computed"
    )]
    Slips {
        /// The joint or drive that does not fit.
        misfit: String,
        /// The joint that slips.
        slipping: String,
    },
    /// A weight of a norm is not positive.
    #[error("the norm has the weight {value}, need a finite number > 0", value = short(*value))]
    NormWeight {
        /// The weight.
        value: f64,
    },
    /// Several rigid supports share a load, and the choice does not determine their shares.
    #[error(
        "the choice does not determine all loads ({free} missing): rigid joints (compliance zero) share loads; give a compliance to at least one more of these joints"
    )]
    Indeterminate {
        /// Number of directions that are not determined.
        free: usize,
    },
    /// The wrench on the first body does not determine all reactions of the joint.
    #[error(
        "the reaction of `{reaction}` on its first body does not determine those on its other bodies, which are not unique"
    )]
    Hidden {
        /// The joint or drive.
        reaction: String,
    },
    /// An error in one part of the mechanism.
    #[error("among {joints}: {source}")]
    InPart {
        /// First joints and drives of the part.
        joints: String,
        /// Cause.
        source: Box<ChoiceError>,
    },
    /// The number of listed rows differs from the redundancy of one part of the mechanism.
    #[error(
        "the number of rows without reaction must be the redundancy, {redundancy}: {joints} have {own} such rows, but {listed} of their rows {} listed",
        if *listed == 1 { "is" } else { "are" }
    )]
    Count {
        /// Redundancy of the whole mechanism.
        redundancy: usize,
        /// The first joints and drives of the part.
        joints: String,
        /// Redundancy of the part.
        own: usize,
        /// Number of listed rows of the part.
        listed: usize,
    },
    /// The reactions in these rows cannot be zero.
    #[error(
        "no solution has zero reactions in {} {}: {}",
        row_word(rows),
        list(rows),
        cause(unique, source)
    )]
    Rows {
        /// The requested rows that exist.
        rows: Vec<RowLabel>,
        /// The requested rows whose multiplier is unique.
        unique: Vec<RowLabel>,
        /// Cause; rows are counted from 0 here.
        source: KeptRowsError,
    },
}

impl ChoiceError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Request(e) => e.code(),
            Self::Called(_) => const { Code::new(427) },
            Self::Undecided { .. }
            | Self::Saddle { .. }
            | Self::Contradiction { .. }
            | Self::Weight { .. }
            | Self::Misfit { .. }
            | Self::Slips { .. }
            | Self::NormWeight { .. }
            | Self::Indeterminate { .. }
            | Self::Hidden { .. }
            | Self::InPart { .. }
            | Self::Count { .. }
            | Self::Rows { .. } => const { Code::new(312) },
        }
    }
}

pub(super) fn list(rows: &[RowLabel]) -> String {
    let names: Vec<String> = rows.iter().map(RowLabel::to_string).collect();
    names.join(", ")
}

pub(super) fn row_word(rows: &[RowLabel]) -> &'static str {
    match rows {
        [_] => "row",
        _ => "the rows",
    }
}

fn cause(unique: &[RowLabel], source: &KeptRowsError) -> String {
    match unique {
        [] => source.to_string(),
        [row] => format!("that of {row} is unique"),
        rows => format!("those of {} are unique", list(rows)),
    }
}
