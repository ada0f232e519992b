//! Compares with the dense decision, and with matrices of known rank.

use super::*;
use crate::{CoefficientReading, decide, orthonormal};
use linalg::{Matrix, singular_values};

/// Pseudo-random numbers for planted cases (Numerical Recipes, 3rd ed., section 7.1.3: 64-bit
/// xorshift).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn number(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Creates groups of one to three rows on one to three bodies, followed by rows that are
/// combinations or copies of these rows.
fn planted(dice: &mut Dice) -> (Matrix, Vec<Range<usize>>, Vec<Range<usize>>) {
    let bodies = 1 + dice.below(7);
    let n = 3 * bodies;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut groups = Vec::new();
    for _ in 0..1 + dice.below(bodies + 1) {
        let touched: Vec<usize> = (0..1 + dice.below(3)).map(|_| dice.below(bodies)).collect();
        let first = rows.len();
        for _ in 0..1 + dice.below(3) {
            let mut row = vec![0.0; n];
            for body in &touched {
                row[3 * body..3 * body + 3].fill_with(|| dice.number());
            }
            rows.push(row);
        }
        groups.push(first..rows.len());
    }
    for _ in 0..dice.below(4) {
        let mut row = vec![0.0; n];
        for _ in 0..1 + dice.below(3) {
            let (of, weight) = (dice.below(rows.len()), dice.number());
            row.iter_mut()
                .zip(&rows[of])
                .for_each(|(a, b)| *a += weight * b);
        }
        groups.push(rows.len()..rows.len() + 1);
        rows.push(row);
    }
    let c = Matrix::from_fn(rows.len(), n, |i, j| rows[i][j]);
    (c, groups, (0..bodies).map(|b| 3 * b..3 * b + 3).collect())
}

fn sparse(c: &Matrix, blocks: &[Range<usize>]) -> SparseRank {
    decide_sparse(&SparseMatrix::from_dense(c), 0.0, blocks, Sketch::default()).expect("finite")
}

fn rank_of(a: &Matrix) -> usize {
    let sigma = singular_values(a);
    sigma.iter().filter(|&&sigma| sigma > 1e-9).count()
}

#[test]
fn planted_matrices_read_as_by_the_dense_code() {
    let mut dice = Dice(0x1234_5678_9abc_def1);
    let (mut undecided, mut redundant) = (0, 0);
    for case in 0..400 {
        let (c, groups, blocks) = planted(&mut dice);
        let dense = decide(&c, crate::Accuracy::Rounding).expect("finite");
        let found = sparse(&c, &blocks);
        if !found.is_decided() || !dense.is_decided() {
            undecided += 1;
            continue;
        }
        redundant += usize::from(dense.redundancy > 0);
        assert_eq!(found.rank, dense.rank, "{case}");
        assert_eq!(found.scaling, dense.scaling, "{case}");
        // The lower bound is close to the true value.
        let kept = found.scaling.apply(&c).select_rows(&found.kept);
        let sigma = singular_values(&kept)
            .last()
            .copied()
            .unwrap_or(f64::INFINITY);
        let e = found.evidence;
        assert!(
            e.sigma_r <= sigma && e.sigma_r > 0.2 * sigma.min(1e300),
            "{case}: {e:?} {sigma}"
        );
        assert!(
            e.backward_error >= 0.0 && e.backward_error <= e.tolerance,
            "{case}: {e:?}"
        );
        assert_eq!(kept.nrows(), found.rank, "{case}");

        let z = orthonormal(&dense);
        for i in 0..c.nrows() {
            let margin = linalg::kernels::norm(z.row(i));
            let reading = found.read_row(i);
            if margin > 1e-9 {
                assert_eq!(
                    reading,
                    CoefficientReading::NonZero,
                    "{case}: {i} {margin:e}"
                );
            } else {
                assert_eq!(reading, CoefficientReading::Zero, "{case}: {i} {margin:e}");
            }
        }
        // The left null space of each group is the same. The ranks of the groups are equal, and the
        // ranks of combined groups are equal, too.
        for group in groups {
            let rows: Vec<usize> = group.collect();
            let (z_j, w_j) = (z.select_rows(&rows), found.sketch.select_rows(&rows));
            let both = Matrix::from_fn(rows.len(), z.ncols() + w_j.ncols(), |i, j| {
                match j.checked_sub(z.ncols()) {
                    Some(j) => w_j[(i, j)],
                    None => z_j[(i, j)],
                }
            });
            let ranks = [&z_j, &w_j, &both].map(rank_of);
            assert_eq!(ranks, [ranks[0]; 3], "{case}: rows {rows:?}");
        }
    }
    assert!(undecided <= 4, "{undecided} undecided");
    assert!(redundant > 100, "{redundant} redundant");
}

/// A row with a change of 1e-17 … 1, and columns in units of 1e±8. The result may be undecided
/// where the dense code decides, but it must not contradict the dense code.
#[test]
fn nearly_dependent_rows_are_never_misread() {
    let mut dice = Dice(0x0fed_cba9_8765_4321);
    let mut decided = 0;
    for case in 0..1000 {
        let (mut c, _, blocks) = planted(&mut dice);
        let change = 10f64.powf(-17.0 * dice.number().abs());
        let units: Vec<f64> = (0..c.ncols())
            .map(|_| 10f64.powi(dice.below(17) as i32 - 8))
            .collect();
        let last = c.nrows() - 1;
        for j in 0..c.ncols() {
            if c[(last, j)] != 0.0 {
                c[(last, j)] += change * dice.number();
            }
            if case % 2 == 0 {
                (0..c.nrows()).for_each(|i| c[(i, j)] *= units[j]);
            }
        }
        let dense = decide(&c, crate::Accuracy::Rounding).expect("finite");
        let found = sparse(&c, &blocks);
        if !found.is_decided() {
            continue;
        }
        decided += 1;
        assert!(dense.is_decided(), "{case}: {:?}", dense.status);
        assert_eq!(found.rank, dense.rank, "{case}");
        let z = orthonormal(&dense);
        for i in 0..c.nrows() {
            let margin = linalg::kernels::norm(z.row(i));
            let expected = dense.read_coefficient(margin, dense.row_noise(i));
            let contradiction = matches!(
                (expected, found.read_row(i)),
                (CoefficientReading::Zero, CoefficientReading::NonZero)
                    | (CoefficientReading::NonZero, CoefficientReading::Zero)
            );
            assert!(
                !contradiction,
                "{case}: row {i}, {margin:e}: {:?}",
                found.evidence
            );
        }
    }
    assert!(decided > 700, "{decided} decided");
}

#[test]
fn trivial_matrices() {
    let body = std::slice::from_ref(&(0..3));
    // (matrix, rank)
    for (c, rank) in [
        (Matrix::zeros(0, 0), 0),
        (Matrix::zeros(0, 3), 0),
        (Matrix::zeros(3, 0), 0),
        (Matrix::zeros(2, 3), 0),
        (Matrix::from_rows(&[[0.0, 1e-9, 0.0]]), 1),
        (Matrix::identity(3), 3),
        (
            Matrix::from_rows(&[[1.0, 2.0, 3.0], [0.0; 3], [2.0, 4.0, 6.0]]),
            1,
        ),
    ] {
        let found = sparse(&c, body);
        assert!(found.is_decided(), "{c:?}: {:?}", found.status);
        assert_eq!((found.rank, found.redundancy), (rank, c.nrows() - rank));
        assert_eq!(found.kept.len(), rank);
        assert_eq!(found.sketch.nrows(), c.nrows());
    }
    let last = sparse(
        &Matrix::from_rows(&[[1.0, 2.0, 3.0], [0.0; 3], [2.0, 4.0, 6.0]]),
        body,
    );
    // The row of zeros is dependent by itself, so its margin is one, estimated from eight numbers
    // of variance one.
    assert!((0.3..2.0).contains(&last.margin(1)), "{}", last.margin(1));
    assert!(last.margin(0) > 0.1 && last.margin(2) > 0.1);
}

#[test]
fn columns_and_rows_without_entries_do_not_count() {
    // Blocks outside the matrix, an empty list of blocks, and blocks without columns.
    let c = Matrix::from_rows(&[
        [0.0, 1.0, 0.0, 2.0, 0.0],
        [0.0; 5],
        [0.0, 2.0, 0.0, 4.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0],
    ]);
    let cases: [&[Range<usize>]; 3] = [&[], &[2..2, 0..2, 1..5], &[4..9, 0..2]];
    for blocks in cases {
        let found = sparse(&c, blocks);
        assert!(found.is_decided(), "{blocks:?}: {:?}", found.status);
        assert_eq!((found.rank, found.redundancy), (2, 2), "{blocks:?}");
        assert!(found.kept.contains(&3) && !found.kept.contains(&1));
        assert_eq!(found.read_row(3), CoefficientReading::Zero);
    }
}

/// The triangle of W. Kahan has ones on the diagonal and −c above it. No column is small, but σ_n
/// decreases like (1 + c)^−n.
#[test]
fn kahan_is_undecided_or_right() {
    let mut undecided = 0;
    for n in [10, 30, 60, 90, 150] {
        for c in [0.1, 0.3, 0.6, 0.95] {
            let kahan = Matrix::from_fn(n, n, |i, j| match j.cmp(&i) {
                std::cmp::Ordering::Less => 0.0,
                std::cmp::Ordering::Equal => 1.0,
                std::cmp::Ordering::Greater => -c,
            });
            for width in [1, 3, n] {
                let blocks: Vec<_> = (0..n).step_by(width).map(|j| j..j + width).collect();
                for matrix in [&kahan, &kahan.transpose()] {
                    let dense = decide(matrix, crate::Accuracy::Rounding).expect("finite");
                    let found = sparse(matrix, &blocks);
                    undecided += usize::from(!found.is_decided());
                    if found.is_decided() {
                        assert!(dense.is_decided(), "{n} {c} {width}: {:?}", dense.status);
                        assert_eq!(found.rank, dense.rank, "{n} {c} {width}");
                    }
                }
            }
        }
    }
    assert!(undecided > 0);
}

#[test]
fn a_singular_value_between_is_undecided() {
    // Two rows at an angle of δ have the singular values √2 and δ/√2.
    let status = |delta: f64| {
        let c = Matrix::from_rows(&[[1.0, 0.0], [1.0, delta]]);
        let c = SparseMatrix::from_dense(&c);
        // A row with the same columns determines the scale of the second one.
        let rows = [
            c.entries(0).collect(),
            c.entries(1).collect(),
            vec![(1, 1.0), (2, 1.0)],
        ];
        let c = SparseMatrix::from_rows(3, rows).expect("columns");
        decide_sparse(&c, 0.0, std::slice::from_ref(&(0..3)), Sketch::default()).expect("finite")
    };
    for (delta, decided) in [(1e-5, true), (1e-9, false), (1e-12, false)] {
        let found = status(delta);
        assert_eq!(found.is_decided(), decided, "{delta:e}: {found:?}");
    }
    assert_eq!(status(1e-17).rank, 2);
    assert!(status(1e-17).is_decided());
    assert!(status(1e-9).kept.len() >= 2);
}

#[test]
fn uncertainty_raises_the_tolerance() {
    let c = Matrix::from_rows(&[[1.0, 1.0, 0.0], [1.0, 1.0 + 1e-9, 0.0], [0.0, 1.0, 1.0]]);
    let c = SparseMatrix::from_dense(&c);
    let decide = |uncertainty| decide_sparse(&c, uncertainty, &[0..1, 1..3], Sketch::default());
    assert!(!decide(0.0).expect("finite").is_decided());
    let known = decide(1e-9).expect("finite");
    assert!(known.is_decided() && known.rank == 2, "{known:?}");
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let error = decide(bad).unwrap_err();
        assert!(error.to_string().starts_with("uncertainty is"), "{error}");
    }
    // The whole matrix is within the uncertainty.
    assert!(!decide(10.0).expect("finite").is_decided());
}

#[test]
fn bad_input_is_named() {
    let rows = [vec![(0, 1.0)], vec![(1, f64::NAN)]];
    let c = SparseMatrix::from_rows(2, rows).expect("columns");
    let error = decide_sparse(&c, 0.0, &[], Sketch::default()).unwrap_err();
    assert!(error.to_string().contains("row 1, column 1"), "{error}");

    let pattern =
        SparsePattern::new(&SparseMatrix::from_dense(&Matrix::identity(2)), &[]).expect("small");
    let other = SparseMatrix::from_rows(2, [vec![(0, 1.0)], vec![(0, 1.0)]]).expect("columns");
    let error = pattern.decide(&other, 0.0, Sketch::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "entry in row 1, column 0, where the pattern has none"
    );
    let none = SparseMatrix::from_dense(&Matrix::zeros(2, 2));
    let pattern = SparsePattern::new(&none, &[]).expect("small");
    let error = pattern.decide(&other, 0.0, Sketch::default()).unwrap_err();
    assert!(error.to_string().starts_with("entry in row 0, column 0"));
    let wide = SparseMatrix::from_dense(&Matrix::zeros(2, 3));
    let error = pattern.decide(&wide, 0.0, Sketch::default()).unwrap_err();
    assert_eq!(error.to_string(), "matrix of 2×3 for a pattern of 2×2");
}

#[test]
fn what_would_take_hours_is_refused() {
    // A row on 20 000 bodies connects each body to every other body.
    let c = SparseMatrix::from_rows(60_000, [(0..60_000).map(|j| (j, 1.0))]).expect("columns");
    let bodies: Vec<_> = (0..20_000).map(|b| 3 * b..3 * b + 3).collect();
    let error = decide_sparse(&c, 0.0, &bodies, Sketch::default()).unwrap_err();
    assert!(matches!(error, SparseRankError::TooDense { .. }), "{error}");
}

#[test]
fn a_pattern_serves_other_values() {
    let mut dice = Dice(99);
    for _ in 0..20 {
        let (c, _, blocks) = planted(&mut dice);
        let c = SparseMatrix::from_dense(&c);
        let pattern = SparsePattern::new(&c, &blocks).expect("small");
        let other = c.map(|i, j, value| value * (1.0 + 0.3 * ((i * 7 + j) as f64).sin()));
        assert_eq!(
            pattern.decide(&other, 0.0, Sketch::default()),
            decide_sparse(&other, 0.0, &blocks, Sketch::default())
        );
    }
}

#[test]
fn more_combinations_than_a_batch() {
    let c = Matrix::from_fn(12, 3, |i, j| ((3 * i + j) as f64).sin());
    let wanted = Sketch {
        columns: 19,
        seed: 5,
    };
    let c = SparseMatrix::from_dense(&c);
    let found = decide_sparse(&c, 0.0, &[], wanted).expect("finite");
    // The functions sin(3i + j) of j span two dimensions: sin 3i and cos 3i.
    assert_eq!((found.rank, found.redundancy), (2, 10));
    assert_eq!((found.sketch.ncols(), rank_of(&found.sketch)), (19, 10));
}
