//! What can be wrong with the operations of a law.

/// Largest number of values on the stack of a law: expressions are not nested as deeply.
pub(super) const DEEPEST: usize = 64;

/// Error in the operations of a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// An operation finds too few numbers, or several are left at the end.
    #[error("the operations of a law leave {left} numbers, need 1")]
    Incomplete {
        /// How many are left.
        left: usize,
    },
    /// Too many numbers on the stack.
    #[error("a law is nested deeper than {DEEPEST}")]
    Deep,
    /// A law acts on one row with few bodies.
    #[error(
        "`{definition}` has {rows} rows and {slots} bodies; a law needs 1 row and at most {most} bodies"
    )]
    Rows {
        /// The definition of the drive.
        definition: &'static str,
        /// Number of its rows.
        rows: usize,
        /// Number of its bodies.
        slots: usize,
        /// Largest number of bodies.
        most: usize,
    },
    /// The arguments of the joint do not fit.
    #[error(transparent)]
    Argument(#[from] joints::ArgumentError),
}
