//! Tests with closed forms, and with products that a factorisation must reproduce.

use super::*;
use crate::sparse::reflectors::Lanes;
use crate::sparse::smallest::smallest_singular_value;
use linalg::{Matrix, singular_values};

/// Rows on neighbouring bodies of a ring. The last two rows of each body are sums of other rows.
fn ring(bodies: usize) -> Matrix {
    Matrix::from_fn(4 * bodies, 3 * bodies, |i, j| {
        let (body, row) = (i / 4, i % 4);
        let entry = |row: usize| ((7 * body + 5 * row + 3) as f64 * (1.3 + j as f64)).sin();
        match (j / 3 + bodies - body) % bodies {
            0 | 1 if row < 3 => entry(row),
            0 | 1 => entry(0) - 2.0 * entry(1),
            _ => 0.0,
        }
    })
}

const TOLERANCES: Tolerances = Tolerances {
    dead: 1e-12,
    rest: 1e-12,
};

fn factors(c: &Matrix, wanted: KeptFactor) -> SparseQr {
    let blocks: Vec<_> = (0..c.ncols()).step_by(3).map(|j| j..j + 3).collect();
    let c = SparseMatrix::from_dense(c);
    Symbolic::new(&c, &blocks)
        .expect("small")
        .factor(&c, TOLERANCES, wanted)
        .expect("its own pattern")
}

#[test]
fn r_has_the_gram_matrix_of_c() {
    for bodies in [2, 3, 5, 9, 30] {
        let c = ring(bodies);
        let qr = factors(&c, KeptFactor::R);
        let mut r = Matrix::zeros(qr.rank, c.ncols());
        for i in 0..qr.rank {
            for (j, value) in qr.r.entries(i) {
                r[(i, j)] = value;
            }
        }
        let expected = c.transpose().product(&c);
        approx::assert_abs_diff_eq!(r.transpose().product(&r), expected, epsilon = 1e-13);
        let rank = singular_values(&c).iter().filter(|&&s| s > 1e-10).count();
        assert_eq!(qr.rank, rank, "{bodies}");
        assert_eq!(qr.is_live.iter().filter(|live| **live).count(), rank);
    }
}

#[test]
fn q_is_orthogonal_and_its_last_columns_annihilate_c() {
    let c = ring(7);
    let qr = factors(&c, KeptFactor::Q);
    let m = c.nrows();
    let columns: Vec<Vec<f64>> = (0..m)
        .map(|k| {
            let mut x: Vec<Lanes> = vec![[0.0; 8]; m];
            x[k][3] = 1.0;
            qr.q.apply(&mut x);
            x.iter().map(|x| x[3]).collect()
        })
        .collect();
    let q = Matrix::from_fn(m, m, |i, k| columns[k][i]);
    approx::assert_abs_diff_eq!(
        q.transpose().product(&q),
        Matrix::identity(m),
        epsilon = 1e-14
    );
    let qtc = q.transpose().product(&c);
    for k in (0..m).filter(|&k| !qr.is_live[k]) {
        assert!(linalg::kernels::max_abs(qtc.row(k)) < 1e-14, "{k}");
    }
}

#[test]
fn the_smallest_singular_value_is_bounded_from_below() {
    for bodies in [2, 4, 20] {
        // Three independent rows for each body except the last bodies. The matrix has full row
        // rank.
        let all = ring(bodies);
        let rows: Vec<usize> = (0..all.nrows()).filter(|i| i % 4 != 3).collect();
        let c = all.select_rows(&rows);
        let qr = factors(&c.transpose(), KeptFactor::R);
        let sigma = singular_values(&c).last().copied().expect("rows");
        let bound = smallest_singular_value(&qr.r, c.nrows(), 3);
        assert!(bound <= sigma && bound > 0.2 * sigma, "{bound} {sigma}");
    }
}

#[test]
fn what_is_dropped_is_told() {
    let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [1.0, 3e-14, 0.0], [0.0, 0.0, 1.0]]);
    let qr = factors(&c, KeptFactor::R);
    assert_eq!(qr.rank, 2);
    // The remaining norm of the small entry below the first row: 3e-14/√2.
    let expected = 3e-14 / 2f64.sqrt();
    assert!(
        (qr.dropped / expected - 1.0).abs() < 1e-2,
        "{:e}",
        qr.dropped
    );
}
