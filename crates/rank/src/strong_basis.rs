//! A row basis with bounded coefficients: `C_D = T·C_K` with `|T_ji| ≤ 2`.
//!
//! Column-pivoted QR selects a good set K of rows, but the coefficients that express the other rows
//! can still grow like 2^r. Exchanging a kept row i with a dropped row j multiplies the volume
//! `√det(C_K·C_Kᵀ)` by `|T_ji|`. Therefore the exchanges terminate if they are made only while an
//! entry exceeds the bound. Only this part of the strong rank-revealing criterion is needed here.
//! The second term of the criterion, `‖R₁₁⁻¹‖·‖R₂₂‖ ≤ σ_{r+1}/σ_r`, is at most 1e-3 for every
//! decided rank and is omitted.
//!
//! The rank itself must already be decided.
//!
//! Source: M. Gu, S. C. Eisenstat, Efficient algorithms for computing a strong rank-revealing QR
//! factorization, SIAM J. Sci. Comput. 17 (1996) 848–869, algorithm 4 with f = 2.

use crate::limits::{COEFFICIENT_BOUND, EXCHANGE_ROUNDS};
use linalg::{Matrix, RowBasis, kernels};

/// A partition of the rows into a basis K and the remaining rows D.
pub(crate) struct Basis {
    /// Kept rows, ascending.
    pub(crate) kept: Vec<usize>,
    /// Dropped rows, ascending.
    pub(crate) dropped: Vec<usize>,
    /// The coefficients T = C_D·C_K⁺, p×r.
    pub(crate) t: Matrix,
    /// Largest `‖row of C_D − T·C_K‖₂`.
    pub(crate) residual: f64,
}

impl Basis {
    /// Expresses all other rows in terms of the kept rows: `Tᵀ = R₁₁⁻¹·R₁₂`.
    pub(crate) fn of(rows: &RowBasis) -> Self {
        let (kept, dropped) = (rows.kept().to_vec(), rows.dropped().to_vec());
        let mut t = Matrix::zeros(dropped.len(), kept.len());
        let mut residual = 0.0_f64;
        for j in 0..dropped.len() {
            rows.coefficients(j, t.row_mut(j));
            residual = residual.max(kernels::norm(rows.outside(j)));
        }
        Self {
            kept,
            dropped,
            t,
            residual,
        }
    }

    /// Creates the basis of all m rows, which are independent.
    pub(crate) fn whole(m: usize) -> Self {
        Self {
            kept: (0..m).collect(),
            dropped: Vec::new(),
            t: Matrix::zeros(0, m),
            residual: 0.0,
        }
    }

    /// Creates the basis from lists in any order. T must be in the order of the lists.
    pub(crate) fn sorted(kept: &[usize], dropped: &[usize], t: &Matrix, residual: f64) -> Self {
        let ascending = |rows: &[usize]| {
            let mut order: Vec<usize> = (0..rows.len()).collect();
            order.sort_unstable_by_key(|&k| rows[k]);
            order
        };
        let (k, d) = (ascending(kept), ascending(dropped));
        Self {
            kept: k.iter().map(|&i| kept[i]).collect(),
            dropped: d.iter().map(|&j| dropped[j]).collect(),
            t: Matrix::from_fn(d.len(), k.len(), |j, i| t[(d[j], k[i])]),
            residual,
        }
    }
}

/// Improves a basis of the rows of `c` by exchanges until `|T_ji| ≤ 2`. The function also returns
/// the factored basis.
pub(crate) fn bounded(c: &Matrix, mut rows: RowBasis) -> (Basis, RowBasis) {
    let mut basis = Basis::of(&rows);
    for _ in 0..EXCHANGE_ROUNDS {
        if basis.t.max_abs() <= COEFFICIENT_BOUND {
            break;
        }
        exchange_all(&mut basis.t, &mut basis.kept, &mut basis.dropped);
        rows = RowBasis::of_rows(c, basis.kept);
        basis = Basis::of(&rows);
    }
    (basis, rows)
}

/// Exchanges rows until `|T_ji| ≤ 2`. T is updated instead of recomputed, and the resulting lists
/// are not ascending.
pub(crate) fn exchange_all(t: &mut Matrix, kept: &mut [usize], dropped: &mut [usize]) {
    let exchanges_max = 10 * (kept.len() + dropped.len());
    for _ in 0..exchanges_max {
        let Some((j, i)) = largest_above_bound(t) else {
            break;
        };
        exchange(t, j, i);
        std::mem::swap(&mut kept[i], &mut dropped[j]);
    }
}

/// Returns all indices in `0..m` that are not in the ascending list `rows`.
pub(crate) fn complement(m: usize, rows: &[usize]) -> Vec<usize> {
    (0..m).filter(|i| rows.binary_search(i).is_err()).collect()
}

fn largest_above_bound(t: &Matrix) -> Option<(usize, usize)> {
    let mut at = None;
    let mut largest = COEFFICIENT_BOUND;
    for j in 0..t.nrows() {
        for (i, t_ji) in t.row(j).iter().enumerate() {
            if t_ji.abs() > largest {
                largest = t_ji.abs();
                at = Some((j, i));
            }
        }
    }
    at
}

/// Updates T after kept row i and dropped row j have been exchanged. The update is one Gauss–Jordan
/// step with pivot T_ji.
fn exchange(t: &mut Matrix, j: usize, i: usize) {
    let pivot = t[(j, i)];
    let mut row_j: Vec<f64> = t.row(j).iter().map(|a| -a / pivot).collect();
    row_j[i] = 1.0 / pivot;
    for s in 0..t.nrows() {
        let t_si = t[(s, i)];
        if s == j || t_si == 0.0 {
            continue;
        }
        t[(s, i)] = 0.0;
        kernels::axpy(t_si, &row_j, t.row_mut(s));
    }
    t.row_mut(j).copy_from_slice(&row_j);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row 0 is a combination of rows 1 and 2 with factor 1/100, so the basis must not contain row
    /// 0.
    #[test]
    fn exchanges_until_the_coefficients_are_bounded() {
        let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [100.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        let rows = RowBasis::of_rows(&c, vec![0, 2]);
        assert_eq!(Basis::of(&rows).t, Matrix::from_rows(&[[100.0, 1.0]]));
        let (good, rows) = bounded(&c, rows);
        assert_eq!(rows.kept(), good.kept);
        assert!(good.t.max_abs() <= COEFFICIENT_BOUND);
        assert_eq!(good.kept, [1, 2]);
        assert!(good.residual < 1e-15);
        // The relation is row 0 = (row 1 − row 2) / 100.
        approx::assert_abs_diff_eq!(good.t, Matrix::from_rows(&[[0.01, -0.01]]), epsilon = 1e-16);
    }

    /// One exchange gives the same T as a new factorisation.
    #[test]
    fn exchange_agrees_with_a_new_factorisation() {
        let c = Matrix::from_rows(&[
            [1.0, 2.0, 0.5],
            [0.0, 1.0, 3.0],
            [1.0, 1.0, -2.0],
            [4.0, -1.0, 1.0],
            [2.0, 2.0, 2.0],
        ]);
        let express = |kept: &[usize]| Basis::of(&RowBasis::of_rows(&c, kept.to_vec())).t;
        let mut t = express(&[0, 1, 3]); // dropped: 2, 4
        exchange(&mut t, 1, 0); // keep 4 instead of 0
        // The new order is kept (4, 1, 3), dropped (2, 0); a basis sorts both lists.
        let fresh = express(&[4, 1, 3]);
        for (j, sorted_j) in [(0, 1), (1, 0)] {
            for (i, sorted_i) in [(0, 2), (1, 0), (2, 1)] {
                approx::assert_abs_diff_eq!(
                    t[(j, i)],
                    fresh[(sorted_j, sorted_i)],
                    epsilon = 1e-13
                );
            }
        }
    }
}
