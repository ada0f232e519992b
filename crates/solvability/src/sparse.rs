//! Decisions on the rows of a large mechanism with sparse matrices.

use std::ops::Range;

use linalg::{Matrix, SparseMatrix, equilibrate_sparse};
use model::start::scene_size;
use model::{ConfigurationAccuracy, Mechanism, Scratch, System};
use rank::{Sketch, SparseRank, SparseRankError, decide_sparse};

use crate::error::AnalysisError;
use crate::limits::SPARE_COMBINATIONS;
use crate::matrices::{self, Basis};

/// A sparse decision on rows of C, and the decided rows.
pub(crate) struct SparseDecision {
    /// Dimensionless rows.
    c: SparseMatrix,
    pub(crate) found: SparseRank,
}

/// Returns rank and kept rows of some rows of C (ascending) at the configuration of the scratch. Φ
/// and C must have been evaluated in the scratch at coordinates q.
///
/// # Errors
/// Returns an error if C is not finite, or too dense for a sparse decision.
pub(crate) fn decide_some(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    rows: impl Iterator<Item = usize> + Clone,
) -> Result<SparseRank, AnalysisError> {
    SparseDecision::of(mechanism, s, q, rows).map(|decided| decided.found)
}

impl SparseDecision {
    pub(crate) fn of(
        mechanism: &Mechanism,
        s: &Scratch,
        q: &[f64],
        rows: impl Iterator<Item = usize> + Clone,
    ) -> Result<Self, AnalysisError> {
        let (layout, size) = (mechanism.layout(), scene_size(mechanism, q));
        let dimensions = mechanism.layout().dimension_scaling(size);
        let unit = |j: usize| f64::from(dimensions.cols[j]).exp2();
        let c = rows_of(mechanism, s, rows.clone(), unit);
        let scaling = equilibrate_sparse(&c);
        let known = mechanism
            .scales(s)
            .uncertainty_of_entries(size, ConfigurationAccuracy::AsStored);
        let pattern = &layout.pattern;
        let mut largest = 0.0_f64;
        for (own, i) in rows.clone().enumerate() {
            for k in pattern.start[i]..pattern.start[i + 1] {
                let j = pattern.column[k];
                let exponent = scaling.rows[own] + scaling.cols[j];
                largest = largest.max(known[k] * unit(j) * f64::from(exponent).exp2());
            }
        }
        let found = decide_sparse(&c, largest, &blocks(mechanism), sketch_of(mechanism)).map_err(
            |source| match source {
                SparseRankError::Rank(source) => AnalysisError::Rank { time: s.t, source },
                source => AnalysisError::Large {
                    time: s.t,
                    rows: rows.count(),
                    source,
                },
            },
        )?;
        Ok(Self { c, found })
    }

    /// Returns the basis for verdicts on a group of the decided rows. The basis uses only these
    /// rows.
    pub(crate) fn basis(&self, own: &[usize]) -> Basis {
        let of_rows = own.iter().flat_map(|&i| self.c.row(i).0);
        let mut columns: Vec<usize> = of_rows.copied().collect();
        let entries = columns.len();
        columns.sort_unstable();
        columns.dedup();
        let scaling = &self.found.scaling;
        let mut c = Matrix::zeros(own.len(), columns.len());
        for (k, &i) in own.iter().enumerate() {
            let (at, values) = self.c.row(i);
            for (j, value) in at.iter().zip(values) {
                if let Ok(l) = columns.binary_search(j) {
                    let factor = f64::from(scaling.rows[i] + scaling.cols[*j]).exp2();
                    c[(k, l)] = value * factor;
                }
            }
        }
        Basis {
            c,
            z: self.found.sketch.select_rows(own),
            known: self.known(own, entries),
            exact: None,
        }
    }

    /// Returns the accuracy of results from these rows. `entries` is the number of entries of the
    /// rows.
    pub(crate) fn known(&self, own: &[usize], entries: usize) -> matrices::RowAccuracy {
        let (e, noise) = (&self.found.evidence, self.found.noise());
        let row_factor = own.iter().map(|&i| self.found.scaling.row_factor(i));
        matrices::RowAccuracy {
            status: self.found.status,
            row_factor: row_factor.collect(),
            row_noise: vec![noise; own.len()],
            row_rounding: Vec::new(),
            tolerance: noise,
            spread: e.uncertainty * (entries as f64).sqrt(),
            uncertainty: e.uncertainty,
            row_turn: None,
            readings: self.found.readings(),
        }
    }
}

/// Returns rows of C at the configuration of the scratch, with columns in the given units.
pub(crate) fn rows_of(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: impl IntoIterator<Item = usize>,
    unit: impl Fn(usize) -> f64,
) -> SparseMatrix {
    let layout = mechanism.layout();
    let row = |i: usize| layout.row(s, i).map(|(j, c)| (j, c * unit(j)));
    // The columns of a sparsity pattern are always below n_v.
    SparseMatrix::from_rows(layout.n_v, rows.into_iter().map(row))
        .unwrap_or_else(|e| unreachable!("columns of a pattern: {e}"))
}

/// Returns the columns of each body.
pub(crate) fn blocks(mechanism: &Mechanism) -> Vec<Range<usize>> {
    let bodies = 0..mechanism.bodies().len();
    bodies.map(|b| mechanism.layout().columns(b)).collect()
}

/// Returns a sketch with enough combinations for the joint with most rows, and a few more so that a
/// random failure is improbable.
pub(crate) fn sketch_of(mechanism: &Mechanism) -> Sketch {
    let groups = mechanism.layout().groups.iter();
    let most = groups.map(|group| group.rows.len()).max().unwrap_or(0);
    let default = Sketch::default();
    Sketch {
        columns: default.columns.max(most + SPARE_COMBINATIONS),
        ..default
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use joints::space3::{Axes, Fixed};
    use linalg::PivotedQr;
    use model::{BodyRef, SpatialBody, SpatialDescription};

    /// The rank of six rows is determined from as many random combinations as the mechanism uses.
    /// The smallest pivot of two thousand such trials is far above the smallest pivot of nearly
    /// square matrices. The smallest singular value of a nearly square matrix is below δ with a
    /// probability of about δ to the power of one more than the number of spare columns (A.
    /// Edelman, SIAM J. Matrix Anal. Appl. 9 (1988) 543–560).
    #[test]
    fn random_combinations_show_the_rank_of_the_largest_joint() {
        let mut d = SpatialDescription::new("plate");
        let tensor = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let plate = d.body(SpatialBody::new("plate", 1.0, tensor));
        let axes = Axes::new([0.0, 0.0, 1.0], None).expect("a direction");
        let weld = Fixed {
            s_i: [0.0; 3],
            s_j: [0.0; 3],
            axes,
            axes_j: axes,
        };
        d.joint("weld", &[BodyRef::Ground, plate], weld);
        let mechanism = Mechanism::build(&d).expect("builds");
        let rows = mechanism.layout().rows();
        let combinations = sketch_of(&mechanism).columns;
        let mut state = 1_u64;
        // Approximates a normal variable by the sum of twelve uniform numbers.
        let mut normal = || {
            let mut sum = -6.0;
            for _ in 0..12 {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                sum += (state >> 11) as f64 / (1_u64 << 53) as f64;
            }
            sum
        };
        let mut least = f64::INFINITY;
        for _ in 0..2000 {
            let random = Matrix::from_fn(rows, combinations, |_, _| normal());
            let pivots = PivotedQr::of_rows(random);
            least = pivots.r_diagonal().map(f64::abs).fold(least, f64::min);
        }
        assert!(rows == 6 && least > 0.1, "{rows} rows: {least}");
    }
}
