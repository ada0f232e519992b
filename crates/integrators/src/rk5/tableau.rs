//! The coefficients of a pair of order 5(4) with seven stages.

/// The coefficients of a pair.
pub trait Tableau {
    /// Nodes of the stages 2 to 7; row sums of `A`.
    const C: [f64; 6];
    /// Rows of coefficients for the arguments of stages 2 to 7. The last row also gives the new
    /// state.
    const A: [[f64; 6]; 6];
    /// Weights of the estimated error, which is the solution of order 5 minus the solution of order
    /// 4.
    const E: [f64; 7];
    /// Weights of the quartic term of the dense output of order 4, see `dense`.
    const D: [f64; 7];
}
