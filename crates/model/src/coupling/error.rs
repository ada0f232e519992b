//! Errors of couplings.

/// Error in the joint coordinates or coefficients of a coupling.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CouplingError {
    /// The drive of a joint coordinate does not have exactly one row between two bodies.
    #[error(
        "`{definition}` has {rows} rows and {slots} bodies: a coupling accepts only measures with one separate row between two bodies, such as the angle of a revolute joint or the \
         displacement of a slider"
    )]
    Measure {
        /// The definition of the drive.
        definition: &'static str,
        /// Number of rows of the drive.
        rows: usize,
        /// Number of bodies of the drive.
        slots: usize,
    },
    /// The list of coefficients is empty, or a coefficient is not finite.
    #[error(
        "the ratio and the coefficients of a coupling must be finite, and not all of them zero"
    )]
    Coefficients,
}
