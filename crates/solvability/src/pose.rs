//! The dimensionless constraint matrix of a mechanism at one configuration, the uncertainty of its
//! entries, and its rank in `f64`.

use linalg::Matrix;
use model::start::scene_size;
use model::{ConfigurationAccuracy, Mechanism, Scratch, System};
use rank::{KeptRowsError, RankDecision};

use crate::error::AnalysisError;

/// Returns the dimensionless C, for a mechanism of this size.
pub(crate) fn dimensionless(mechanism: &Mechanism, s: &Scratch, size: f64) -> Matrix {
    mechanism
        .layout()
        .dimension_scaling(size)
        .apply(&mechanism.layout().dense(s))
}

/// Returns the uncertainty in `f64` of the entries of the [`dimensionless`] C.
pub(crate) fn uncertainty(mechanism: &Mechanism, s: &Scratch, size: f64) -> Matrix {
    mechanism.layout().dimension_scaling(size).apply(
        &mechanism
            .scales(s)
            .uncertainty(size, ConfigurationAccuracy::AsStored),
    )
}

/// Returns the velocities with the dimensionless value 1. For translations the velocity is 1 m/s.
/// For rotations it is the rate that moves a point at a distance of the size of the mechanism by
/// about 1 m/s, rounded to a power of two.
pub(crate) fn velocity_units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let scaling = mechanism.layout().dimension_scaling(size);
    scaling.cols.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Decides the rank of C at the configuration of the scratch. Φ and C must have been evaluated in
/// the scratch at coordinates q.
///
/// # Errors
/// Returns an error if C is not finite.
pub fn decide(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RankDecision, AnalysisError> {
    let size = scene_size(mechanism, q);
    rank::decide(
        &dimensionless(mechanism, s, size),
        &uncertainty(mechanism, s, size),
    )
    .map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Works like [`decide`], but only for the holonomic rows. The result shows which rows of Φ
/// constrain the configuration.
///
/// # Errors
/// Returns an error if C is not finite.
pub fn decide_holonomic(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RankDecision, AnalysisError> {
    let (phi_q, known) = holonomic(mechanism, s, q);
    rank::decide(&phi_q, &known).map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Returns holonomic rows that are candidates for the refinement of a configuration.
pub(crate) fn promising_holonomic(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Vec<usize>, AnalysisError> {
    let (phi_q, known) = holonomic(mechanism, s, q);
    rank::promising_rows(&phi_q, &known).map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Returns the dimensionless Φq, and the uncertainty of its entries.
fn holonomic(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> (Matrix, Matrix) {
    let size = scene_size(mechanism, q);
    let rows: Vec<usize> = (0..mechanism.layout().m).collect();
    let phi_q = dimensionless(mechanism, s, size).select_rows(&rows);
    let known = uncertainty(mechanism, s, size).select_rows(&rows);
    (phi_q, known)
}

/// Works like [`decide`], with given redundant rows (`dropped`, from 0). The number of these rows
/// must equal the redundancy, and the other rows must be independent.
///
/// # Errors
/// Returns an error if the given rows do not satisfy these conditions, or if C is not finite.
pub fn decide_dropping(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    dropped: &[usize],
) -> Result<RankDecision, KeptRowsError> {
    let size = scene_size(mechanism, q);
    let c = dimensionless(mechanism, s, size);
    let known = uncertainty(mechanism, s, size);
    rank::decide_dropping(&c, &known, dropped)
}

/// Evaluates Φ and C at a configuration.
pub(crate) fn evaluated(mechanism: &Mechanism, t: f64, q: &[f64]) -> Scratch {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    s
}
