//! Errors of requests to a matrix.

use model::words::short;

/// Reason why a request is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QueryError {
    /// A row does not exist.
    #[error("row {row} does not exist, rows are 0..{rows}")]
    RowOutOfRange {
        /// The requested row.
        row: usize,
        /// Number of rows of the matrix.
        rows: usize,
    },
    /// The number of coefficients differs from the number of rows.
    #[error("{found} coefficients for {expected} rows")]
    Length {
        /// Number of coefficients.
        found: usize,
        /// Number of rows.
        expected: usize,
    },
    /// A component does not exist.
    #[error("component {component} does not exist, the map has {components}")]
    ComponentOutOfRange {
        /// The requested component.
        component: usize,
        /// Number of rows of the map.
        components: usize,
    },
    /// A coefficient is not a finite number.
    #[error("coefficient {index} is {value}, need a finite number")]
    NonFinite {
        /// Index of the coefficient.
        index: usize,
        /// Value of the coefficient.
        value: f64,
    },
    /// The rank of the matrix is undecided.
    #[error("rank undecided: {0}")]
    Rank(rank::Doubt),
    /// The number of unique directions is undecided.
    #[error(
        "unique directions: a margin of {margin} lies between {tolerance} (rounding) and {required} (certainly not zero)", margin = short(*margin), tolerance = short(*tolerance), required = short(*required))]
    Directions {
        /// The margin that is undecided.
        margin: f64,
        /// Largest margin that rounding and uncertainty can cause.
        tolerance: f64,
        /// Smallest margin that is certainly not zero.
        required: f64,
    },
}
