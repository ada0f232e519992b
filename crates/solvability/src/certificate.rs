//! The rank of a mechanism, as certain as it can be had: decided in double-double, at a configuration polished in double-double,
//! for data known to the rounding with which a scene stores them.
//!
//! Not for motion: a run decides in `f64`, where a nearly redundant mechanism cannot be integrated anyway.

use linalg::{
    DdMatrix, Matrix, NEARLY_REDUNDANT, NEARLY_SINGULAR, NearlyRedundant, RankDecision,
    certify_within,
};
use model::start::scene_size;
use model::{Known, Mechanism, Scratch, System};

use crate::mechanism::{AnalysisError, dimensionless, evaluated, promising_holonomic, uncertainty};
use crate::state::check_configuration;

/// Rows up to which a rank is certified: the work grows with their cube.
pub(crate) const ROWS_MAX: usize = 600;

/// C of a mechanism without dimensions, with what its entries are known to.
pub(crate) struct Rows {
    time: f64,
    size: f64,
    c: Entries,
    /// Entry by entry.
    uncertainty: Matrix,
}

enum Entries {
    /// At a configuration polished in double-double.
    Extended(DdMatrix),
    /// Where double-double is no help: too many rows, or kept rows dependent to the last digit of `f64`.
    Double(Matrix),
}

impl Rows {
    /// C at the pose of the scratch, in `f64`; q are its coordinates.
    pub(crate) fn in_double(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> Self {
        let size = scene_size(mechanism, q);
        Self {
            time: s.t,
            size,
            c: Entries::Double(dimensionless(mechanism, s, size)),
            uncertainty: uncertainty(mechanism, s, q, size),
        }
    }

    /// C at the configuration q, which satisfies the constraints to `f64`.
    pub(crate) fn new(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        known: Known,
    ) -> Result<Self, AnalysisError> {
        check_configuration(mechanism, t, q)?;
        let mut s = evaluated(mechanism, t, q);
        if mechanism.layout().rows() > ROWS_MAX {
            return Ok(Self::in_double(mechanism, &s, q));
        }
        let kept = promising_holonomic(mechanism, &s, q)?;
        let Ok(polished) = mechanism.polish(t, q, &kept) else {
            return Ok(Self::in_double(mechanism, &s, q));
        };
        // What is left of Φ is what the data leave open; the rounding of q in f64 is gone.
        for (phi, polished) in s.phi.iter_mut().zip(&polished.phi) {
            *phi = polished.to_f64();
        }
        let size = scene_size(mechanism, q);
        Ok(Self {
            time: t,
            size,
            c: Entries::Extended(polished.c.scaled(&mechanism.dimension_scaling(size))),
            uncertainty: mechanism
                .dimension_scaling(size)
                .apply(&mechanism.uncertainty(&s, q, size, known)),
        })
    }

    /// Size of the mechanism (m).
    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// C rounded to `f64`.
    pub(crate) fn matrix(&self) -> Matrix {
        match &self.c {
            Entries::Extended(c) => c.hi(),
            Entries::Double(c) => c.clone(),
        }
    }

    /// Rank, kept rows and evidence of all rows.
    pub(crate) fn decide(&self) -> Result<RankDecision, AnalysisError> {
        let decision = match &self.c {
            Entries::Extended(c) => certify_within(c, &self.uncertainty),
            Entries::Double(c) => linalg::decide(c, &self.uncertainty),
        };
        decision.map_err(|source| AnalysisError::Rank {
            time: self.time,
            source,
        })
    }

    /// Whether the kept rows nearly depend on each other as bodies feel it, at the pose of the scratch; equilibration may scale the only
    /// misaligned entry of a column up to size one.
    pub(crate) fn nearly_redundant(
        &self,
        mechanism: &Mechanism,
        s: &Scratch,
        decision: &RankDecision,
    ) -> Option<NearlyRedundant> {
        if !decision.is_decided() {
            return None;
        }
        let physical = weakest_as_felt(mechanism, s, (self.size, &self.matrix()), decision)
            .filter(|weakest| weakest.sigma < NEARLY_REDUNDANT);
        // Below the resolution of `f64` the certificate knows better.
        let certified = decision.nearly_redundant().cloned();
        [physical, certified]
            .into_iter()
            .flatten()
            .min_by(|a, b| a.sigma.total_cmp(&b.sigma))
    }

    /// Some of the rows.
    pub(crate) fn select(&self, rows: &[usize]) -> Self {
        Self {
            time: self.time,
            size: self.size,
            c: match &self.c {
                Entries::Extended(c) => Entries::Extended(c.select_rows(rows)),
                Entries::Double(c) => Entries::Double(c.select_rows(rows)),
            },
            uncertainty: self.uncertainty.select_rows(rows),
        }
    }
}

/// The combination of kept rows that comes closest to zero as bodies feel it, at the pose of the scratch, where C without dimensions is that of a
/// mechanism of this size: rows with largest entry 1, rotations measured by the arms of their bodies.
fn weakest_as_felt(
    mechanism: &Mechanism,
    s: &Scratch,
    (size, c): (f64, &Matrix),
    decision: &RankDecision,
) -> Option<NearlyRedundant> {
    let felt = mechanism.felt_scaling(s, size).apply(c);
    let mut kept = felt.select_rows(&decision.kept);
    for i in 0..kept.nrows() {
        let largest = kept.row(i).iter().fold(0.0_f64, |a, c| a.max(c.abs()));
        if largest > 0.0 {
            kept.row_mut(i).iter_mut().for_each(|c| *c /= largest);
        }
    }
    let weakest = linalg::weakest_combination(&kept)?;
    let mut direction = vec![0.0; decision.rank + decision.redundancy];
    for (&row, weight) in decision.kept.iter().zip(weakest.weights) {
        direction[row] = weight;
    }
    Some(NearlyRedundant {
        sigma: weakest.sigma,
        direction,
    })
}

/// Kept rows that cannot be told from dependent ones in `f64` as bodies feel them, at the pose of the scratch, where C has been evaluated
/// at coordinates q. The rank may be decided nevertheless: equilibration scales up a column whose only entries are the misalignment. It is that of the
/// data as read, but velocities on these rows are known to the rounding of the state divided by σ only. Allocates.
#[must_use]
pub fn inseparable(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    decision: &RankDecision,
) -> Option<NearlyRedundant> {
    let size = scene_size(mechanism, q);
    let c = dimensionless(mechanism, s, size);
    weakest_as_felt(mechanism, s, (size, &c), decision)
        .filter(|weakest| weakest.sigma < NEARLY_SINGULAR)
}

/// Decides the rank of C at time t and coordinates q, which satisfy the constraints, in double-double where that is possible
/// (up to 600 rows); the evidence then has a certificate. Allocates.
///
/// # Errors
/// - [`AnalysisError::State`]: t or q is not finite, or q has not n_q entries.
/// - [`AnalysisError::Rank`]: C is not finite.
pub fn certify(mechanism: &Mechanism, t: f64, q: &[f64]) -> Result<RankDecision, AnalysisError> {
    Rows::new(mechanism, t, q, Known::AsStored)?.decide()
}
