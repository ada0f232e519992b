//! What can be wrong with a coupling.

/// Error in the measures or numbers of a coupling.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CouplingError {
    /// A measure whose drive has other rows than one of its own between two bodies.
    #[error(
        "`{definition}` has {rows} rows and {slots} bodies: a coupling takes measures that have one \
         row of their own between two bodies, such as the angle of a revolute joint or the \
         displacement of a slider"
    )]
    Measure {
        /// The definition of the drive.
        definition: &'static str,
        /// Number of its rows.
        rows: usize,
        /// Number of its bodies.
        slots: usize,
    },
    /// No coefficient, or one that is not finite.
    #[error("the ratio of a coupling and its coefficients are finite numbers, not all zero")]
    Coefficients,
}
