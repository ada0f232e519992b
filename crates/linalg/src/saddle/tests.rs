//! The reference is LU of the full saddle matrix in nalgebra. Results for massless bodies are
//! calculated manually.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use super::*;

/// Allowed forward error per unit of condition number. It is a small multiple of eps for orders up
/// to 24.
const FORWARD: f64 = 1e-14;

fn saddle_matrix(c: &DMatrix<f64>, mass: &[f64]) -> DMatrix<f64> {
    let (r, n) = c.shape();
    let mut a = DMatrix::zeros(n + r, n + r);
    a.view_mut((0, 0), (n, n))
        .copy_from(&DMatrix::from_diagonal(&DVector::from_column_slice(mass)));
    a.view_mut((n, 0), (r, n)).copy_from(c);
    a.view_mut((0, n), (n, r)).copy_from(&c.transpose());
    a
}

proptest! {
    #[test]
    fn agrees_with_the_full_saddle(
        n in 1..13_usize, r in 0..13_usize,
        data in prop::collection::vec(-1.0..1.0_f64, 144),
        mass in prop::collection::vec(prop_oneof![1 => Just(0.0), 5 => 0.1..10.0_f64], 12),
        rhs in prop::collection::vec(-1.0..1.0_f64, 24),
    ) {
        let r = r.min(n);
        let (mass, f, gamma) = (&mass[..n], &rhs[..n], &rhs[12..12 + r]);
        let c = DMatrix::from_row_slice(r, n, &data[..r * n]);
        let full = saddle_matrix(&c, mass);
        let sigma = full.singular_values();
        let condition = sigma.max() / sigma.min();
        let mut saddle = KeptRowSaddle::new(n, r).unwrap();
        let factored = saddle.factor(|k| &data[k * n..(k + 1) * n], mass);
        if condition.is_nan() || condition > 1e12 {
            // For random matrices with too many massless coordinates or dependent rows, an error or
            // an inaccurate result is allowed. The condition is NaN for a matrix of zeros.
            return Ok(());
        }
        prop_assert!(factored.is_ok(), "{:?} at condition {:e}", factored, condition);
        let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; r]);
        let b = DVector::from_iterator(n + r, f.iter().chain(gamma).copied());
        let x = full.lu().solve(&b).unwrap();
        saddle.solve(f, gamma, &mut a, &mut lambda).unwrap();
        let scale = 1.0 + x.amax();
        for (l, found) in a.iter().chain(&lambda).enumerate() {
            prop_assert!((found - x[l]).abs() <= FORWARD * condition.max(10.0) * scale,
                "{} is {} not {} at condition {:e}", l, found, x[l], condition);
        }
    }

    /// A projection (f = 0) with the same factors moves along M⁻¹·Cᵀ onto the rows.
    #[test]
    fn same_factors_serve_a_projection(phi in -1.0..1.0_f64) {
        let c = [3.0, 4.0];
        let mut saddle = KeptRowSaddle::new(2, 1).unwrap();
        saddle.factor(|_| &c, &[1.0, 2.0]).unwrap();
        let (mut dq, mut lambda) = ([0.0; 2], [0.0]);
        saddle.solve(&[1.0, 5.0], &[0.3], &mut dq, &mut lambda).unwrap();
        saddle.solve(&[0.0; 2], &[-phi], &mut dq, &mut lambda).unwrap();
        // C·M⁻¹·Cᵀ = 9 + 8 = 17.
        prop_assert!((dq[0] + phi * 3.0 / 17.0).abs() < 1e-15);
        prop_assert!((dq[1] + phi * 2.0 / 17.0).abs() < 1e-15);
        prop_assert!((lambda[0] - phi / 17.0).abs() < 1e-15);
    }
}

#[test]
fn masses_over_24_decades_on_one_rod() {
    // Two carts of masses 1 and 1e24 (and 1e-24) are tied to each other: a = F/(m₀ + m₁).
    let c = [1.0, -1.0];
    for heavy in [1e24, 1e-24, 0.0] {
        let mut saddle = KeptRowSaddle::new(2, 1).unwrap();
        saddle.factor(|_| &c, &[1.0, heavy]).unwrap();
        let (mut a, mut lambda) = ([0.0; 2], [0.0]);
        saddle
            .solve(&[1.0, 0.0], &[0.0], &mut a, &mut lambda)
            .unwrap();
        let expected = 1.0 / (1.0 + heavy);
        assert!((a[0] / expected - 1.0).abs() < 1e-15 && a[0] == a[1]);
    }
}

#[test]
fn massless_motion_is_named() {
    // For masses (1, 0, 0) on the plane x + y + z = 0, the motion (0, 1, −1) moves no mass.
    let c = [1.0, 1.0, 1.0];
    let mut saddle = KeptRowSaddle::new(3, 1).unwrap();
    let error = saddle.factor(|_| &c, &[1.0, 0.0, 0.0]).unwrap_err();
    let SaddleError::MasslessMotion { motion, .. } = &error else {
        panic!("{error}");
    };
    assert!(
        motion[0].abs() < 1e-15 && (motion[1] + motion[2]).abs() < 1e-15,
        "{motion:?}"
    );
    assert_eq!(motion.iter().fold(0.0_f64, |a, b| a.max(b.abs())), 1.0);
    assert!(error.to_string().contains("massless motion ["), "{error}");
    // After the failure there is no factorisation.
    let refused = saddle.solve(&[0.0; 3], &[0.0], &mut [0.0; 3], &mut [0.0]);
    assert_eq!(refused, Err(SaddleError::NotFactored));
}

/// The null vector is exactly (0, t, −s). Only the first coordinate has a mass. Rounding puts about
/// 1e-17 into the first entry of the null vector, and this value does not count as a mass.
#[test]
fn rounding_of_the_null_vector_gives_no_mass() {
    let (s, t) = (0.3, 0.7);
    for step in 1..60 {
        let (sin, cos) = (0.05 * f64::from(step)).sin_cos();
        let rows = [[cos, -sin * s, -sin * t], [sin, cos * s, cos * t]];
        let mut saddle = KeptRowSaddle::new(3, 2).unwrap();
        let error = saddle.factor(|k| &rows[k], &[1.0, 0.0, 0.0]).unwrap_err();
        assert!(
            matches!(error, SaddleError::MasslessMotion { .. }),
            "{error}"
        );
    }
}

#[test]
fn all_massless_and_all_constrained() {
    let mut saddle = KeptRowSaddle::new(2, 0).unwrap();
    let error = saddle.factor(|_| &[], &[0.0, 0.0]).unwrap_err();
    assert!(
        matches!(error, SaddleError::MasslessMotion { ref motion, .. } if motion == &[1.0, 0.0])
    );
    // There is no free motion, so masses have no effect.
    let rows = Matrix2::ROWS;
    let mut saddle = KeptRowSaddle::new(2, 2).unwrap();
    saddle.factor(|k| &rows[k], &[0.0, 0.0]).unwrap();
    let (mut a, mut lambda) = ([0.0; 2], [0.0; 2]);
    saddle
        .solve(&[1.0, 1.0], &[2.0, 6.0], &mut a, &mut lambda)
        .unwrap();
    assert_eq!((a, lambda), ([2.0, 2.0], [0.5, 0.5]));
    // An empty problem is legal.
    let mut empty = KeptRowSaddle::new(0, 0).unwrap();
    empty.factor(|_| &[], &[]).unwrap();
    empty.solve(&[], &[], &mut [], &mut []).unwrap();
}

/// The rows x = 2, x + 2y = 6.
struct Matrix2;

impl Matrix2 {
    const ROWS: [[f64; 2]; 2] = [[1.0, 0.0], [1.0, 2.0]];
}

#[test]
fn lost_rank_is_named_and_the_pivot_ratio_warns() {
    let factor = |epsilon: f64| {
        let rows = [[1.0, 1.0, 0.0], [1.0, 1.0 + epsilon, 0.0]];
        let mut saddle = KeptRowSaddle::new(3, 2).unwrap();
        saddle
            .factor(|k| &rows[k], &[1.0, 1.0, 1.0])
            .map(|()| saddle.pivot_ratio())
    };
    assert!((factor(1.0).unwrap() - 0.5).abs() < 1e-15);
    assert!((factor(1e-6).unwrap() / 1e-6 - 1.0).abs() < 1e-5);
    let error = factor(0.0).unwrap_err();
    assert!(matches!(error, SaddleError::RankLost { row: 1, .. }));
    assert!(
        error
            .to_string()
            .starts_with("kept row 1 depends on the rows before it: pivot 0.000e0")
    );
}

#[test]
fn bad_input_is_named() {
    assert_eq!(
        KeptRowSaddle::new(2, 3).unwrap_err().to_string(),
        "3 independent rows in 2 coordinates are impossible: keep at most 2"
    );
    let mut saddle = KeptRowSaddle::new(2, 1).unwrap();
    let message = |saddle: &mut KeptRowSaddle, c: [f64; 2], mass: &[f64]| {
        let c: &'static [f64] = Vec::from(c).leak();
        saddle.factor(|_| c, mass).unwrap_err().to_string()
    };
    assert_eq!(
        message(&mut saddle, [1.0, f64::NAN], &[1.0, 1.0]),
        "C contains the value NaN at 1, need finite numbers"
    );
    assert_eq!(
        message(&mut saddle, [1.0, 1.0], &[1.0]),
        "mass has 1 entries, need 2"
    );
    assert_eq!(
        message(&mut saddle, [1.0, 1.0], &[1.0, -2.0]),
        "mass 1 is -2.000e0, need a number that is not negative"
    );
    saddle.factor(|_| &[1.0, 1.0], &[1.0, 1.0]).unwrap();
    let infinite = saddle.solve(&[0.0, f64::INFINITY], &[0.0], &mut [0.0; 2], &mut [0.0]);
    assert_eq!(
        infinite.unwrap_err().to_string(),
        "f contains the value inf at 1, need finite numbers"
    );
}

#[test]
fn masses_are_graded_from_their_spread_on() {
    let cases = [
        ([1.0, 1.0, 0.99e6], false),
        ([1.0, 1.0, 1.01e6], true),
        ([0.0, 1.0, 0.99e3], false),
        ([0.0, 1.0, 1.01e3], true),
    ];
    for (mass, expected) in cases {
        let mut saddle = KeptRowSaddle::new(3, 1).unwrap();
        saddle.factor(|_| &[1.0, 0.5, 0.5], &mass).unwrap();
        assert_eq!(saddle.is_graded(), expected, "{mass:?}");
    }
}

/// The light coordinate is the pivot if its entry is more than a tenth of the largest.
#[test]
fn graded_masses_choose_among_the_large_entries() {
    for (entry, solved_for) in [(0.09, 0), (0.11, 1)] {
        let mut saddle = KeptRowSaddle::new(2, 1).unwrap();
        let row = [1.0, entry];
        saddle.factor(|_| &row, &[1e7, 1.0]).unwrap();
        assert_eq!(saddle.solved_for(), [solved_for]);
    }
}

/// Exactly `left` of the second row remains after the elimination.
#[test]
fn a_pivot_of_a_few_roundings_is_no_pivot() {
    for (roundings, is_lost) in [(15.0, true), (17.0, false)] {
        let left = roundings * f64::EPSILON;
        let rows = [[1.0, 0.0], [1.0, left]];
        let mut saddle = KeptRowSaddle::new(2, 2).unwrap();
        let factored = saddle.factor(|k| &rows[k], &[1.0; 2]);
        assert_eq!(factored.is_err(), is_lost, "{roundings}");
    }
}

/// If two rows depend on each other at an instant, there is one more free motion. Above a limit,
/// the null space is not computed.
#[test]
fn many_free_motions_stop_a_factorisation() {
    let rows = [[1.0, 0.0, 0.0], [1.0, 1e-9, 0.0]];
    let mut saddle = KeptRowSaddle::new(3, 2).expect("fewer rows");
    let refused = saddle.factor_up_to(1, 1e-6, |k| &rows[k], &[1.0; 3]);
    assert_eq!(refused, Err(SaddleError::ManyFree { free: 2 }));
    let solved = saddle.motion(&[0.0; 3], &[0.0; 2], &mut [0.0; 3]);
    assert_eq!(solved, Err(SaddleError::NotFactored));
    // The next factorisation is independent of the previous one.
    let rows = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    saddle
        .factor_up_to(1, 1e-6, |k| &rows[k], &[1.0; 3])
        .expect("independent");
    let mut x = [0.0; 3];
    saddle
        .motion(&[0.0, 0.0, 5.0], &[2.0, 7.0], &mut x)
        .expect("factored");
    assert_eq!(x, [2.0, 5.0, 5.0]);
}
