//! The constraint matrix of a mechanism at one configuration, without dimensions, what its entries
//! are known to, and its rank in `f64`.

use linalg::Matrix;
use model::start::scene_size;
use model::{Known, Mechanism, Scratch, System};
use rank::{KeptRowsError, RankDecision};

use crate::error::AnalysisError;

/// Components of a planar reaction that are forces; the torque follows.
pub(crate) const TRANSLATIONS: usize = 2;

/// Columns of C that a planar body has: two translations and its rotation.
pub(crate) const COLUMNS: usize = 3;

/// C without dimensions, for a mechanism of this size.
pub(crate) fn dimensionless(mechanism: &Mechanism, s: &Scratch, size: f64) -> Matrix {
    mechanism
        .layout()
        .dimension_scaling(size)
        .apply(&mechanism.layout().dense(s))
}

/// What the entries of [`dimensionless`] C are known to in `f64`.
pub(crate) fn uncertainty(mechanism: &Mechanism, s: &Scratch, size: f64) -> Matrix {
    mechanism
        .layout()
        .dimension_scaling(size)
        .apply(&mechanism.scales(s).uncertainty(size, Known::AsStored))
}

/// The velocities that are one without dimensions: 1 m/s for translations, and for rotations what
/// moves a point at the size of the mechanism by about as much, a power of two.
pub(crate) fn velocity_units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let scaling = mechanism.layout().dimension_scaling(size);
    scaling.cols.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Decides the rank of C at the pose of the scratch, where Φ and C have been evaluated at
/// coordinates q.
///
/// # Errors
/// If C is not finite.
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

/// The same for the holonomic rows alone: which rows of Φ hold the configuration.
///
/// # Errors
/// If C is not finite.
pub fn decide_holonomic(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RankDecision, AnalysisError> {
    let (phi_q, known) = holonomic(mechanism, s, q);
    rank::decide(&phi_q, &known).map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Holonomic rows on which a configuration may be polished.
pub(crate) fn promising_holonomic(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Vec<usize>, AnalysisError> {
    let (phi_q, known) = holonomic(mechanism, s, q);
    rank::promising_rows(&phi_q, &known).map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Φq without dimensions, and what its entries are known to.
fn holonomic(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> (Matrix, Matrix) {
    let size = scene_size(mechanism, q);
    let rows: Vec<usize> = (0..mechanism.layout().m).collect();
    let phi_q = dimensionless(mechanism, s, size).select_rows(&rows);
    let known = uncertainty(mechanism, s, size).select_rows(&rows);
    (phi_q, known)
}

/// The same with the dropped rows given (from 0): they must be as many as the redundancy, and the
/// others independent.
///
/// # Errors
/// If they are not, or C is not finite.
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

/// Φ and C at a configuration.
pub(crate) fn evaluated(mechanism: &Mechanism, t: f64, q: &[f64]) -> Scratch {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    s
}
