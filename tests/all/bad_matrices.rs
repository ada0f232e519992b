//! Invalid input by a user gives errors with names or correct results, and never a panic.

use exact::Exact;
use linalg::Matrix;
use rank::RankError;
use solvability::{QueryError, Solvability, Verdict};
use tests::numbers::Numbers;

use crate::plain::Plain;

const SEED: u64 = 5;

/// Computes the verdicts in both ways: for data with an uncertainty, and for exact data.
fn both(c: &Matrix) -> [Result<(), RankError>; 2] {
    [
        Solvability::of(c, rank::Accuracy::Rounding).map(|_| ()),
        Solvability::of_exact(c).map(|_| ()),
    ]
}

#[test]
fn entries_that_are_no_numbers_are_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (i, k) in [(0, 0), (2, 1), (1, 3)] {
            let mut c = Matrix::from_fn(3, 4, |i, k| (i + 2 * k) as f64);
            c[(i, k)] = bad;
            for result in both(&c) {
                let error = result.expect_err("no number");
                let RankError::NonFinite { row, col, value } = error else {
                    panic!("{error}");
                };
                assert_eq!((row, col, value.to_bits()), (i, k, bad.to_bits()));
            }
        }
    }
}

#[test]
fn residuals_that_are_none_are_named() {
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        let error = Solvability::of(&Matrix::identity(2), rank::Accuracy::Absolute(bad))
            .expect_err("no residual");
        assert!(matches!(error, RankError::Uncertainty { .. }), "{error}");
    }
}

/// Rows of zeros carry no force: their multipliers are not unique, but their reaction is unique. In
/// a matrix without columns all rows are rows of zeros.
#[test]
fn empty_rows_and_columns() {
    for (m, n) in [(0, 0), (0, 4), (4, 0), (1, 1), (3, 2), (2, 5)] {
        let s = Plain::of(&Matrix::zeros(m, n));
        assert_eq!((s.decision().rank, s.decision().redundancy), (0, m));
        for i in 0..m {
            assert_eq!(s.row(i).verdict, Verdict::NotUnique);
            assert_eq!(s.group(&[i]).verdict, Verdict::Unique);
        }
        assert_eq!(s.combination(&vec![0.0; m]).verdict, Verdict::Unique);
    }
    // The matrix has one nonzero row and one nonzero column among empty ones.
    let s = Plain::of_rows(&[vec![0.0; 3], vec![0.0, 5.0, 0.0], vec![0.0; 3]]);
    assert_eq!(s.decision().rank, 1);
    let found = [0, 1, 2].map(|i| s.row(i).verdict.is_unique());
    assert_eq!(found, [false, true, false]);
}

/// The matrix has a hundred rows with two columns: any three rows are dependent.
#[test]
fn many_more_rows_than_columns() {
    let rows: Vec<Vec<f64>> = (0..100).map(|i| vec![1.0, f64::from(i)]).collect();
    let s = Plain::of_rows(&rows);
    assert_eq!((s.decision().rank, s.decision().redundancy), (2, 98));
    assert!((0..100).all(|i| s.row(i).verdict == Verdict::NotUnique));
    assert_eq!(
        s.group(&(0..100).collect::<Vec<_>>()).verdict,
        Verdict::Unique
    );
    assert_eq!(s.combination(&[1.0; 100]).verdict, Verdict::Unique);
}

/// A group without rows has no reaction that could be free; groups may overlap, and each is
/// analysed separately; a repeated row counts once.
#[test]
fn empty_and_overlapping_groups() {
    let rows = [[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|r| r.to_vec());
    let s = Plain::of_rows(&rows);
    let exact = Exact::of(&rows);
    let groups: [&[usize]; 6] = [&[], &[0, 1], &[2, 1], &[2, 0, 1], &[2], &[0]];
    for group in groups {
        let unique = exact.freedom(group) == 0;
        assert_eq!(s.group(group).verdict.is_unique(), unique, "{group:?}");
        let unique = exact.multiplier_freedom(group) == 0;
        assert_eq!(
            s.multipliers(group).verdict.is_unique(),
            unique,
            "{group:?}"
        );
    }
    assert_eq!(s.group(&[0, 1, 1, 0]).verdict, Verdict::Unique);
    assert_eq!(s.unique_directions(&[]), 0);
}

#[test]
fn questions_that_cannot_be_answered_are_named() {
    let c = Matrix::identity(2);
    for s in [
        Solvability::of(&c, rank::Accuracy::Rounding),
        Solvability::of_exact(&c),
    ] {
        let s = s.expect("C is finite");
        let missing = QueryError::RowOutOfRange { row: 2, rows: 2 };
        assert_eq!(s.row(2), Err(missing.clone()));
        assert_eq!(s.group([0, 2]), Err(missing.clone()));
        assert_eq!(s.multipliers([2, 0]), Err(missing.clone()));
        assert_eq!(s.b_x([2]), Err(missing.clone()));
        let map = Matrix::identity(1);
        assert_eq!(s.component(&map, 0, [2]), Err(missing.clone()));
        assert_eq!(s.unique_directions(&map, [2]), Err(missing));
        assert!(matches!(
            s.component(&map, 1, [0]),
            Err(QueryError::ComponentOutOfRange { .. })
        ));
        assert!(matches!(
            s.component(&map, 0, [0, 1]),
            Err(QueryError::Length { .. })
        ));
        assert!(matches!(
            s.unique_directions(&map, [0, 1]),
            Err(QueryError::Length { .. })
        ));
        for l in [vec![], vec![1.0], vec![1.0; 3]] {
            assert!(matches!(s.combination(&l), Err(QueryError::Length { .. })));
        }
        for bad in [f64::NAN, f64::INFINITY] {
            let found = s.combination(&[1.0, bad]);
            assert!(matches!(found, Err(QueryError::NonFinite { index: 1, .. })));
        }
        let bad = Matrix::from_rows(&[[f64::NAN]]);
        assert!(s.component(&bad, 0, [0]).is_err());
        assert!(s.unique_directions(&bad, [0]).is_err());
    }
}

/// Arbitrary bits give either an error, or the rank of exact arithmetic.
#[test]
fn arbitrary_bits() {
    let mut numbers = Numbers::new(SEED);
    for _ in 0..300 {
        let (m, n) = (numbers.below(6), numbers.below(6));
        let mut entry = || match numbers.below(8) {
            0..4 => 0.0,
            4 => f64::from_bits(numbers.bits() & ((1 << 54) - 1)),
            5 => -f64::MAX,
            6 => f64::from_bits(1),
            _ => f64::from_bits(numbers.bits()),
        };
        let rows: Vec<Vec<f64>> = (0..m).map(|_| (0..n).map(|_| entry()).collect()).collect();
        let c = Matrix::from_fn(m, n, |i, k| rows[i][k]);
        if rows.iter().flatten().any(|x| !x.is_finite()) {
            assert!(both(&c).iter().all(Result::is_err));
            continue;
        }
        assert!(both(&c).iter().all(Result::is_ok));
        assert_eq!(
            Plain::of(&c).decision().rank,
            Exact::of(&rows).rank(),
            "{rows:?}"
        );
    }
}
