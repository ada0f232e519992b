//! Determines which rows certainly belong to a dependency if the data have a stated tolerance.
//!
//! Let `row s = Σ t_k·row k` be a dependency over independent rows K that contain all of its other
//! rows. The dependency has one coefficient for each row of K, which is zero for rows outside the
//! dependency. At constant rank, the coefficient changes with the data by `δt_k = zᵀ·δC·C_K⁺·e_k`,
//! where z is the dependency itself. If such a change makes a coefficient zero, or a zero
//! coefficient different from zero, it is undecided which rows depend on each other.

use linalg::{Matrix, PivotedQr};
use model::System;
use rank::{Circuit, CoefficientReading, RankDecision};

use super::pose::{Candidate, Pose, most_independent_of};
use super::share::Question;

/// A dependency expressed by independent rows that contain its other rows.
struct Fundamental {
    /// Independent rows, ascending. The number of these rows is the rank.
    kept: Vec<usize>,
    /// Coefficients of these rows.
    t: Vec<f64>,
    /// The dependency `e_s − Σ t_k·e_k`, one value for each row.
    z: Vec<f64>,
    /// Transposed pseudoinverse `(C_K⁺)ᵀ`.
    inverse: Matrix,
}

impl Fundamental {
    /// Factors a dependency of the scaled C. Returns `None` if its rows, except the row with the
    /// largest coefficient, are not independent in `f64`.
    fn new(scaled: &Matrix, decision: &RankDecision, circuit: &Circuit) -> Option<Self> {
        let rank = decision.rank;
        let size = |(&row, z): (&usize, &f64)| (z / decision.scaling.row_factor(row)).abs();
        let sizes: Vec<f64> = circuit
            .rows
            .iter()
            .zip(&circuit.coefficients)
            .map(size)
            .collect();
        let at = (0..sizes.len()).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b]))?;
        let mut kept = circuit.rows.clone();
        let largest = kept.remove(at);
        if kept.len() > rank {
            return None;
        }
        let more = rank - kept.len();
        let others = most_independent_of(scaled, &kept).into_iter();
        kept.extend(others.filter(|&row| row != largest).take(more));
        if kept.len() < rank {
            return None;
        }
        kept.sort_unstable();
        let qr = PivotedQr::of_rows(scaled.select_rows(&kept));
        if qr.r_diagonal().any(|r| r == 0.0) {
            return None;
        }
        let inverse = qr.transposed_pseudo_inverse();
        let t = inverse.times(scaled.row(largest));
        let mut z = vec![0.0; scaled.nrows()];
        z[largest] = 1.0;
        for (&row, t) in kept.iter().zip(&t) {
            z[row] = -t;
        }
        Some(Self {
            kept,
            t,
            z,
            inverse,
        })
    }
}

impl Question<'_> {
    /// Returns the rows of dependencies that are undecided because of a stated tolerance,
    /// ascending.
    pub(crate) fn open_rows(&self, scaled: &Matrix, decision: &RankDecision) -> Vec<usize> {
        if decision.redundancy == 0 || !decision.is_decided() {
            return Vec::new();
        }
        let dimensions = self.mechanism.layout().dimension_scaling(self.size);
        let candidate = Candidate::of_rank(scaled, decision.rank);
        let matrices = (scaled, &dimensions, &decision.scaling);
        let pose = Pose::new(self.mechanism, self.s, self.places, matrices, candidate);
        let blocks = self.mechanism.data().blocks(self.s);
        let is_open = |circuit: &Circuit| {
            let Some(of) = Fundamental::new(scaled, decision, circuit) else {
                return true;
            };
            (0..of.kept.len()).any(|k| {
                let gradient = pose.gradient_between(&of.z, of.inverse.row(k)).data;
                let changes = blocks.iter().map(|b| b.change(&gradient, b.known_to()));
                let rounding = decision
                    .row_rounding(of.kept[k])
                    .max(rank::COEFFICIENT_ROUNDING);
                let known = changes.sum::<f64>().max(rounding);
                let reading = decision.read_coefficient(of.t[k].abs(), known);
                let right = if circuit.rows.contains(&of.kept[k]) {
                    CoefficientReading::NonZero
                } else {
                    CoefficientReading::Zero
                };
                reading != right
            })
        };
        let open = rank::short_circuits(decision).into_iter().filter(is_open);
        let mut rows: Vec<usize> = open.flat_map(|circuit| circuit.rows).collect();
        rows.sort_unstable();
        rows.dedup();
        rows
    }
}
