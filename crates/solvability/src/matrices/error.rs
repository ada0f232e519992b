//! Questions that have no answer.

/// A question that cannot be answered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QueryError {
    /// A row that does not exist.
    #[error("row {row} does not exist, rows are 0..{rows}")]
    RowOutOfRange {
        /// The row asked for.
        row: usize,
        /// Rows of the matrix.
        rows: usize,
    },
    /// Coefficients that do not fit the rows.
    #[error("{found} coefficients for {expected} rows")]
    Length {
        /// Coefficients given.
        found: usize,
        /// Rows they are for.
        expected: usize,
    },
    /// A component that the map does not have.
    #[error("component {component} does not exist, the map has {components}")]
    ComponentOutOfRange {
        /// The component asked for.
        component: usize,
        /// Rows of the map.
        components: usize,
    },
    /// A coefficient that is no number.
    #[error("coefficient {index} is {value}, need a finite number")]
    NonFinite {
        /// Which one.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The rank of the matrix is undecided.
    #[error("rank undecided: {0}")]
    Rank(rank::Doubt),
    /// The number of unique directions is.
    #[error(
        "unique directions: a margin of {margin:.3e} lies between {tolerance:.3e} (rounding) and {required:.3e} (certainly not zero)"
    )]
    Directions {
        /// The margin in doubt.
        margin: f64,
        /// Rounding and uncertainty reach up to here.
        tolerance: f64,
        /// Above this it would certainly not be zero.
        required: f64,
    },
}
