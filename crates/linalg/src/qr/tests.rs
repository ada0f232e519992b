//! Compares factors with products of known matrices, and pivots with norms.
use proptest::prelude::*;

use super::*;

/// Backward error of Householder QR: a small multiple of eps times the size. The value 1e-13 is
/// sufficient for 40×40 matrices.
const BACKWARD: f64 = 1e-13;

fn any_matrix() -> impl Strategy<Value = Matrix> {
    (0..12_usize, 0..12_usize).prop_flat_map(|(m, n)| {
        prop::collection::vec(-1.0..1.0_f64, m * n)
            .prop_map(move |data| Matrix::from_vec(m, n, data).unwrap())
    })
}

/// Kahan's matrix. The length of each column is smaller than the length of the previous column by
/// 1e-12, so that rounding does not change the order of the columns in the pivoting. In exact
/// arithmetic, all remaining columns have equal lengths.
fn kahan(n: usize, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    Matrix::from_fn(n, n, |i, j| {
        s.powi(i as i32)
            * (1.0 - 1e-12 * j as f64)
            * match i.cmp(&j) {
                std::cmp::Ordering::Equal => 1.0,
                std::cmp::Ordering::Less => -c,
                std::cmp::Ordering::Greater => 0.0,
            }
    })
}

proptest! {
    #[test]
    fn product_of_factors_is_the_permuted_matrix(c in any_matrix()) {
        let qr = PivotedQr::of_rows(c.clone());
        let q = qr.q();
        let (n, k) = (qr.dimension(), qr.steps());
        approx::assert_abs_diff_eq!(
            q.transpose().product(&q), Matrix::identity(n), epsilon = BACKWARD);
        let q_thin = qr.q_columns(0..k);
        let back = q_thin.product(&qr.r());
        let permuted = c.select_rows(qr.permutation()).transpose();
        approx::assert_abs_diff_eq!(back, permuted, epsilon = BACKWARD);
    }

    /// The relation `C_D = T·C_K + S`, for rows that are given or chosen by the factorisation.
    #[test]
    fn other_rows_are_combinations_of_a_basis(c in any_matrix(), share in 0.0..1.0_f64) {
        let r = (share * (c.nrows().min(c.ncols()) + 1) as f64) as usize;
        let chosen = RowBasis::most_independent(c.clone(), r);
        let mut first = PivotedQr::of_rows(c.clone()).permutation()[..r].to_vec();
        first.sort_unstable();
        prop_assert_eq!(chosen.kept(), &first[..]);
        let given = RowBasis::of_rows(&c, first.clone());
        let smallest = given.factored().r_diagonal().fold(f64::INFINITY, |a, r| a.min(r.abs()));
        for basis in [chosen, given] {
            let qr = basis.factored();
            let kept = c.select_rows(basis.kept());
            let permuted = kept.select_rows(qr.permutation()).transpose();
            approx::assert_abs_diff_eq!(
                qr.q_columns(0..r).product(&qr.r()), permuted, epsilon = BACKWARD);
            let rest = qr.q_columns(r..qr.dimension());
            let mut t = vec![0.0; r];
            for (j, &row) in basis.dropped().iter().enumerate() {
                basis.coefficients(j, &mut t);
                let known = kept.transpose_times(&t);
                let outside = rest.times(basis.outside(j));
                for ((c, a), b) in c.row(row).iter().zip(known).zip(outside) {
                    prop_assert!((c - (a + b)).abs() <= BACKWARD / smallest.min(1.0));
                }
            }
        }
    }

    #[test]
    fn diagonal_falls_and_dominates_what_remains(c in any_matrix()) {
        let r = PivotedQr::of_rows(c).r();
        for k in 0..r.nrows() {
            for j in k..r.ncols() {
                let remaining = (k..r.nrows()).map(|i| r[(i, j)].powi(2)).sum::<f64>().sqrt();
                prop_assert!(r[(k, k)].abs() >= remaining * (1.0 - 1e-7) - BACKWARD);
            }
        }
    }

    #[test]
    fn triangular_solves_undo_products_with_r(c in any_matrix(), seed in -1.0..1.0_f64) {
        let mut a = c;
        for i in 0..a.nrows().min(a.ncols()) {
            a[(i, i)] += 20.0; // diagonally dominant: R₁₁ is well conditioned
        }
        let qr = PivotedQr::of_rows(a);
        let k = qr.steps();
        let r_11 = Matrix::from_fn(k, k, |i, j| qr.r()[(i, j)]);
        let x: Vec<f64> = (0..k).map(|i| seed + i as f64).collect();
        let mut y = r_11.times(&x);
        qr.solve_r(&mut y);
        let mut z = r_11.transpose_times(&x);
        qr.solve_r_transpose(&mut z);
        for i in 0..k {
            prop_assert!((y[i] - x[i]).abs() < 1e-11);
            prop_assert!((z[i] - x[i]).abs() < 1e-11);
        }
    }
}

#[test]
fn zero_and_empty_matrices() {
    for (m, n) in [(0, 0), (0, 3), (3, 0), (2, 3)] {
        let qr = PivotedQr::of_rows(Matrix::zeros(m, n));
        assert!(qr.r_diagonal().all(|r| r == 0.0));
        assert_eq!(qr.q(), Matrix::identity(n));
    }
}

/// Known defect of pivoted QR, and the reason why ranks are decided by singular values: for Kahan's
/// matrix, the last pivot is far above the smallest singular value.
#[test]
fn last_pivot_of_kahan_hides_the_smallest_singular_value() {
    let k = kahan(90, 1.2);
    let qr = PivotedQr::of_columns(&k);
    let last = qr.r_diagonal().last().unwrap().abs();
    let reference = nalgebra::DMatrix::from_row_slice(90, 90, k.as_slice())
        .singular_values()
        .min();
    assert!(last > 1e3 * reference, "{last:e} against {reference:e}");
}

#[test]
fn graded_columns_downdate_safely() {
    // Columns that agree in all digits except their last digits. Plain downdating would give only
    // noise.
    let c = Matrix::from_fn(6, 8, |i, j| {
        1.0 + if j == i + 1 {
            1e-9 * (i + 1) as f64
        } else {
            0.0
        }
    });
    let qr = PivotedQr::of_rows(c.clone());
    let diagonal: Vec<f64> = qr.r_diagonal().map(f64::abs).collect();
    assert!(
        diagonal.windows(2).all(|w| w[0] >= w[1] * (1.0 - 1e-6)),
        "{diagonal:?}"
    );
    assert!(diagonal[5] > 1e-10, "{diagonal:?}");
}
