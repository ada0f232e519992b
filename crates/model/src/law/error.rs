//! Errors in the operations of a force law.

/// Largest number of values on the stack of a law. The nesting of expressions in scenes has a lower
/// limit, so scenes never reach this limit.
pub(super) const DEEPEST: usize = 64;

/// Error in the operations of a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// An operation has too few operands, or several values remain at the end.
    #[error("the operations of a law return {left} numbers, need 1")]
    Incomplete {
        /// Number of remaining values.
        left: usize,
    },
    /// The stack contains too many values.
    #[error("a law is nested deeper than {DEEPEST}")]
    Deep,
    /// A function of time contains a joint coordinate or its rate.
    #[error("a function of time must not depend on a joint coordinate or its rate")]
    Variable,
    /// A force law requires a drive with one row and at most `most` bodies.
    #[error(
        "`{definition}` has {rows} rows and {slots} bodies; a law needs 1 row and at most {most} bodies"
    )]
    Rows {
        /// The definition of the drive.
        definition: &'static str,
        /// Number of rows of the drive.
        rows: usize,
        /// Number of bodies of the drive.
        slots: usize,
        /// Largest number of bodies.
        most: usize,
    },
    /// The arguments of the joint are invalid.
    #[error(transparent)]
    Argument(#[from] joints::ArgumentError),
}
