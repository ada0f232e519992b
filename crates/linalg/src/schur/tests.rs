//! Compares results with the dense solver, which eliminates without forming S, and with closed
//! forms.

use crate::{KeptRowSaddle, Matrix, SaddleError, SchurSaddle, SchurStructure, SparseMatrix};

/// Pseudo-random values in [−1, 1) that are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() + 1.0) * 0.5 * n as f64) as usize % n
    }
}

/// Creates fewer rows than columns. The rows connect random bodies, each with this number of
/// columns. About one entry in four is missing.
fn random((bodies, width): (usize, usize), numbers: &mut Numbers) -> SparseMatrix {
    let joints = 1 + numbers.below(3 * bodies / 2);
    let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
    for _ in 0..joints {
        let pair = [numbers.below(bodies), numbers.below(bodies)];
        for _ in 0..1 + numbers.below(width - 1) {
            let columns = pair.iter().flat_map(|b| width * b..width * (b + 1));
            let mut entries: Vec<_> = columns.map(|j| (j, numbers.next())).collect();
            entries.retain(|_| numbers.below(4) > 0);
            rows.push(entries);
        }
    }
    rows.truncate(width * bodies - 1);
    SparseMatrix::from_rows(width * bodies, rows).expect("columns of bodies")
}

fn blocks((bodies, width): (usize, usize)) -> Vec<std::ops::Range<usize>> {
    (0..bodies).map(|b| width * b..width * (b + 1)).collect()
}

/// One block of all columns.
fn whole(n: usize) -> Vec<std::ops::Range<usize>> {
    std::iter::once(0..n).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(1e-300, |m: f64, x| m.max(x.abs()));
    a.iter()
        .zip(b)
        .map(|(x, y)| (x - y).abs() / size)
        .fold(0.0, f64::max)
}

#[test]
fn random_mechanisms_move_as_with_the_dense_solver() {
    let mut numbers = Numbers(7);
    let mut compared = [0; 7];
    for k in 0..900 {
        // The number of columns of a body is that of the plane, of space, or another number.
        let width = [3, 6, 2][k % 3];
        let bodies = (1 + numbers.below(12), width);
        let c = random(bodies, &mut numbers);
        let (n, r) = (c.ncols(), c.nrows());
        let mass: Vec<f64> = (0..n).map(|_| 1.5 + numbers.next()).collect();
        let f: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let gamma: Vec<f64> = (0..r).map(|_| numbers.next()).collect();
        let dense: Matrix = c.dense();
        let mut known = KeptRowSaddle::new(n, r).expect("fewer rows than columns");
        if known.factor(|k| dense.row(k), &mass).is_err() || known.pivot_ratio() < 1e-3 {
            continue;
        }
        let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; r]);
        known
            .solve(&f, &gamma, &mut a, &mut lambda)
            .expect("solved");
        let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &blocks(bodies)));
        saddle.factor(&c, &mass).expect("independent rows");
        let (mut found, mut multipliers) = (vec![0.0; n], vec![0.0; r]);
        saddle
            .solve(&c, &f, &gamma, &mut found, &mut multipliers)
            .expect("solved");
        assert!(largest_difference(&found, &a) < 1e-11, "{found:?} {a:?}");
        assert!(largest_difference(&multipliers, &lambda) < 1e-9);
        let mut again = vec![0.0; r];
        saddle.multipliers(&c, &f, &a, &mut again).expect("solved");
        assert!(largest_difference(&again, &lambda) < 1e-8);
        compared[width] += 1;
    }
    let compared = [2, 3, 6].map(|width| compared[width]);
    assert!(compared.iter().all(|&n| n > 100), "{compared:?}");
}

#[test]
fn a_hanging_chain_of_point_masses_pulls_with_its_weight() {
    // Row k keeps the vertical distance of masses k − 1 and k; mass 0 is connected to the ground.
    let n = 5000;
    let row =
        |k: usize| (k.saturating_sub(1)..=k).map(move |j| (j, if j == k { 1.0 } else { -1.0 }));
    let c = SparseMatrix::from_rows(n, (0..n).map(row)).expect("columns below n");
    let blocks: Vec<_> = (0..n).map(|j| j..j + 1).collect();
    let structure = SchurStructure::new(&c, &blocks);
    // S is tridiagonal, so there is no fill in any order.
    assert!(structure.n_entries() < 5 * n, "{}", structure.n_entries());
    let mut saddle = SchurSaddle::new(structure);
    saddle.factor(&c, &vec![2.0; n]).expect("independent rows");
    let (mut a, mut lambda) = (vec![1.0; n], vec![0.0; n]);
    saddle
        .solve(&c, &vec![-20.0; n], &vec![0.0; n], &mut a, &mut lambda)
        .expect("solved");
    for (k, lambda) in lambda.iter().enumerate() {
        let weight = -20.0 * (n - k) as f64;
        assert!((lambda - weight).abs() < 1e-9 * weight.abs());
    }
    assert!(a.iter().all(|a| a.abs() < 1e-9));
}

#[test]
fn a_dependent_row_is_left_out_or_refused() {
    let c = SparseMatrix::from_rows(2, [[(0, 1.0), (1, 0.0)], [(0, 1.0), (1, 1e-9)]])
        .expect("two columns");
    let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &whole(2)));
    assert!(matches!(
        saddle.factor(&c, &[1.0, 1.0]),
        Err(SaddleError::RankLost { .. })
    ));
    assert_eq!(
        saddle.solve(&c, &[0.0; 2], &[0.0; 2], &mut [0.0; 2], &mut [0.0; 2]),
        Err(SaddleError::NotFactored)
    );
    saddle.factor_above(1e-6, &c, &[1.0, 1.0]).expect("finite");
    assert_eq!(saddle.n_left_out(), 1);
    let (mut a, mut lambda) = ([0.0; 2], [0.0; 2]);
    saddle
        .solve(&c, &[3.0, 5.0], &[2.0, 2.0], &mut a, &mut lambda)
        .expect("solved");
    assert_eq!(a, [2.0, 5.0]);
    assert!(saddle.uses(0) != saddle.uses(1));
}

/// Two rows that are always nearly parallel hide two other rows that become nearly parallel. The
/// comparison of a row with its own earlier share detects the other rows.
#[test]
fn what_is_left_of_a_row_is_compared_with_itself() {
    let rows = |apart: f64| {
        let rows = [
            [(0, 1.0), (1, 0.0)],
            [(0, 1.0), (1, 1e-3)],
            [(2, 1.0), (3, 0.0)],
            [(2, 1.0), (3, apart)],
        ];
        SparseMatrix::from_rows(4, rows).expect("columns below 4")
    };
    let (mass, c) = ([1.0; 4], rows(1.0));
    let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &[0..2, 2..4]));
    saddle.factor(&c, &mass).expect("independent");
    let first = saddle.pivot_ratio();
    assert!((first - 1e-3).abs() < 1e-8, "{first}");
    saddle.keep_shares();
    // The independent share of the last row, initially 0.707, is compared with 0.4.
    for (apart, expected) in [(1.0, 1e-3), (0.1, 0.25e-3), (0.01, 0.25e-4)] {
        saddle.factor(&rows(apart), &mass).expect("independent");
        let found = saddle.pivot_ratio();
        assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    }
}

#[test]
fn nothing_to_hold_is_free() {
    let c = SparseMatrix::from_rows(2, std::iter::empty::<[(usize, f64); 0]>()).expect("no rows");
    let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &[]));
    saddle.factor(&c, &[2.0, 4.0]).expect("nothing to factor");
    let mut a = [0.0; 2];
    saddle
        .solve(&c, &[2.0, 2.0], &[], &mut a, &mut [])
        .expect("solved");
    assert_eq!((a, saddle.pivot_ratio()), ([1.0, 0.5], f64::INFINITY));
}

#[test]
fn bad_numbers_are_refused() {
    let c = SparseMatrix::from_rows(2, [[(0, f64::NAN), (1, 1.0)]]).expect("two columns");
    let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &whole(2)));
    assert!(matches!(
        saddle.factor(&c, &[1.0; 2]),
        Err(SaddleError::NonFinite {
            argument: "C",
            index: 0,
            ..
        })
    ));
    assert!(matches!(
        saddle.factor(&c, &[1.0, 0.0]),
        Err(SaddleError::ZeroMass { index: 1, .. })
    ));
    assert!(matches!(
        saddle.factor(&c, &[1.0, -1.0]),
        Err(SaddleError::NegativeMass { index: 1, .. })
    ));
    assert!(matches!(
        saddle.factor(&c, &[1.0]),
        Err(SaddleError::Length {
            argument: "mass",
            ..
        })
    ));
    let c = SparseMatrix::from_rows(2, [[(0, 1.0), (1, 1.0)]]).expect("two columns");
    saddle.factor(&c, &[1.0; 2]).expect("one row");
    let solved = saddle.solve(&c, &[f64::NAN, 0.0], &[0.0], &mut [0.0; 2], &mut [0.0]);
    assert!(matches!(
        solved,
        Err(SaddleError::NonFinite {
            argument: "f",
            index: 0,
            ..
        })
    ));
    // The independent share of the rows is zero.
    let mut a = [0.0; 2];
    saddle
        .solve(&c, &[3.0, 1.0], &[0.0], &mut a, &mut [0.0])
        .expect("solved");
    assert_eq!(a, [1.0, -1.0]);
}

/// With unit masses, the remaining fraction of the second row of a pair is the sine of the angle
/// between the two rows.
#[test]
fn a_row_of_which_little_is_left_is_lost() {
    for (sine, is_lost) in [(0.7e-7, true), (1.5e-7, false)] {
        let c = SparseMatrix::from_rows(2, [[(0, 1.0), (1, 0.0)], [(0, 1.0), (1, sine)]]);
        let c = c.expect("two rows");
        let one_body = std::slice::from_ref(&(0..2));
        let mut saddle = SchurSaddle::new(SchurStructure::new(&c, one_body));
        let factored = saddle.factor(&c, &[1.0; 2]);
        assert_eq!(factored.is_err(), is_lost, "{sine}");
    }
}

/// Solves with a row that is `share` times the factored row, and with rows whose initial residual
/// is `miss` times their terms. After each correction, 1 − share² of the previous residual remains.
fn solved_by_factors_of_another_row(share: f64, miss: f64) -> Result<(), SaddleError> {
    let row = |x: f64| SparseMatrix::from_rows(2, [[(0, x), (1, -x)]]).expect("two columns");
    let mut saddle = SchurSaddle::new(SchurStructure::new(&row(1.0), &whole(2)));
    saddle.factor(&row(1.0), &[1.0; 2])?;
    // Both masses have the same load, and one mass has a small additional load.
    let f = [1.0 + 2.0 * miss, 1.0];
    saddle.solve(&row(share), &f, &[0.0], &mut [0.0; 2], &mut [0.0])
}

#[test]
fn corrections_go_on_while_they_halve_what_is_left() {
    for (left, expected) in [(0.45, 4), (0.55, 2)] {
        let found = solved_by_factors_of_another_row(f64::sqrt(1.0 - left), 0.1);
        assert!(
            matches!(found, Err(SaddleError::Unrefined { rounds, .. }) if rounds == expected),
            "{left}: {found:?}"
        );
    }
}

#[test]
fn what_corrections_leave_is_refused_from_a_billionth_on() {
    // Two corrections. After each correction, 0.6 of the residual remains.
    for (left, is_poor) in [(0.7e-9, false), (1.4e-9, true)] {
        let found = solved_by_factors_of_another_row(0.4_f64.sqrt(), left / 0.36);
        assert_eq!(found.is_err(), is_poor, "{left}: {found:?}");
    }
}

/// After each correction, a thousandth of the previous residual remains: 1e-11, then 1e-14 of the
/// terms.
#[test]
fn a_correction_leaves_rounding_of_all_terms() {
    let row = |x: f64| SparseMatrix::from_rows(2, [[(0, x), (1, -x)]]).expect("two columns");
    let mut saddle = SchurSaddle::new(SchurStructure::new(&row(1.0), &whole(2)));
    saddle.factor(&row(1.0), &[1.0; 2]).expect("one row");
    let (mut a, miss) = ([0.0; 2], 1e-8);
    let other = row((1.0 - 1e-3_f64).sqrt());
    saddle
        .solve(&other, &[1.0 + 2.0 * miss, 1.0], &[0.0], &mut a, &mut [0.0])
        .expect("solved");
    assert!((a[0] - a[1]).abs() < 5e-14, "{a:?}");
}
