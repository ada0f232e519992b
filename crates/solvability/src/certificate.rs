//! The rank of a mechanism, as certain as it can be had: decided in double-double, at a configuration polished in double-double,
//! for data known to the rounding with which a scene stores them.
//!
//! Not for motion: a run decides in `f64`, where a nearly redundant mechanism cannot be integrated anyway.

use linalg::{DdMatrix, Matrix, NEARLY_REDUNDANT, NearlyRedundant, RankDecision, certify_within};
use model::start::scene_size;
use model::{Known, Mechanism, Scratch, System};

use crate::mechanism::{AnalysisError, decide_holonomic, dimensionless, evaluated, uncertainty};
use crate::state::check_configuration;

/// Rows up to which a rank is certified: the work grows with their cube.
const ROWS_MAX: usize = 600;

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
        let kept = decide_holonomic(mechanism, &s, q)?.kept;
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
        let felt = mechanism.felt_scaling(s, self.size).apply(&self.matrix());
        let mut kept = felt.select_rows(&decision.kept);
        for i in 0..kept.nrows() {
            let largest = kept.row(i).iter().fold(0.0_f64, |a, c| a.max(c.abs()));
            if largest > 0.0 {
                kept.row_mut(i).iter_mut().for_each(|c| *c /= largest);
            }
        }
        let weakest =
            linalg::weakest_combination(&kept).filter(|weakest| weakest.sigma < NEARLY_REDUNDANT);
        let whole = |w: linalg::WeakestCombination| {
            let mut direction = vec![0.0; decision.rank + decision.redundancy];
            for (&row, weight) in decision.kept.iter().zip(w.weights) {
                direction[row] = weight;
            }
            NearlyRedundant {
                sigma: w.sigma,
                direction,
            }
        };
        let physical = weakest.map(whole);
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

/// Decides the rank of C at time t and coordinates q, which satisfy the constraints, in double-double where that is possible
/// (up to 600 rows); the evidence then has a certificate. Allocates.
///
/// # Errors
/// - [`AnalysisError::State`]: t or q is not finite, or q has not n_q entries.
/// - [`AnalysisError::Rank`]: C is not finite.
pub fn certify(mechanism: &Mechanism, t: f64, q: &[f64]) -> Result<RankDecision, AnalysisError> {
    Rows::new(mechanism, t, q, Known::AsStored)?.decide()
}
