//! Tests the solvers of the saddle equations that use all rows. They are compared with the solver
//! for independent rows, for constructed combinations of rows, and with results found by hand.

use lab::comparators::{Fault, MinimumNorm, NullSpace, Proximal, Saddle, Solver, Tuning};
use linalg::{KeptRowSaddle, Matrix, singular_values};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn solve(
    solver: &mut dyn Solver,
    c: &Matrix,
    mass: &[f64],
    force: &[f64],
    gamma: &[f64],
) -> Result<[Vec<f64>; 2], Fault> {
    let (mut a, mut lambda) = (vec![0.0; c.ncols()], vec![0.0; c.nrows()]);
    let at = Saddle {
        c,
        mass,
        force,
        gamma,
    };
    solver.solve(&at, &mut a, &mut lambda)?;
    Ok([a, lambda])
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

proptest! {
    // The cases have a fixed seed, because the error bounds are only estimates from masses and
    // condition numbers.
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(20130909),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// For r random rows and p combinations of these rows, all solvers return the accelerations for
    /// the r rows, and the constraint forces agree. The λ of minimum norm is perpendicular to the
    /// constructed dependencies.
    #[test]
    fn all_rows_agree_with_independent_ones(
        n in 2..12_usize, r in 1..10_usize, p in 0..4_usize,
        data in prop::collection::vec(-1.0..1.0_f64, 220),
        mass in prop::collection::vec(0.1..10.0_f64, 12),
        f in prop::collection::vec(-1.0..1.0_f64, 12),
    ) {
        let r = r.min(n);
        let (mass, f) = (&mass[..n], &f[..n]);
        let independent = Matrix::from_fn(r, n, |i, j| data[12 * i + j]);
        let share = |i: usize, j: usize| data[150 + 12 * i + j];
        let shares = Matrix::from_fn(r + p, r, |i, j| match i.checked_sub(r) {
            None => f64::from(u8::from(i == j)),
            Some(i) => share(i, j),
        });
        let c = shares.product(&independent);
        let gamma = shares.times(&data[200..200 + r]);
        let sigma = singular_values(&c);
        if sigma[r - 1] < 1e-2 {
            return Ok(());
        }
        let mut kept = KeptRowSaddle::new(n, r).unwrap();
        kept.factor(|k| c.row(k), mass).unwrap();
        let (mut expected, mut of_kept) = (vec![0.0; n], vec![0.0; r]);
        kept.solve(f, &gamma[..r], &mut expected, &mut of_kept).unwrap();
        let size = 1.0 + expected.iter().chain(&of_kept).fold(0.0, |a: f64, x| a.max(x.abs()));
        let total = independent.transpose_times(&of_kept);
        let solvers: [(Box<dyn Solver>, f64); 3] = [
            (Box::new(NullSpace::new(r)), 1e-10),
            (Box::new(MinimumNorm::new(r)), 1e-10),
            (Box::new(Proximal::new(&c, mass, r, 1e-12).unwrap()), 1e-9),
        ];
        for (k, (mut solver, bound)) in solvers.into_iter().enumerate() {
            let [a, lambda] = solve(&mut *solver, &c, mass, f, &gamma).unwrap();
            let allowed = bound * size * size;
            prop_assert!(distance(&a, &expected) < allowed, "solver {k}: {a:?} {expected:?}");
            let found = c.transpose_times(&lambda);
            prop_assert!(distance(&found, &total) < 100.0 * allowed, "solver {k}");
            if k == 1 {
                for i in 0..p {
                    let along: f64 = (0..r).map(|j| share(i, j) * lambda[j]).sum::<f64>() - lambda[r + i];
                    prop_assert!(along.abs() < 100.0 * allowed, "combination {i}: {along:e}");
                }
            }
        }
    }
}

/// Returns three rows for a unit mass, one of which is redundant: x = 0, 2·x = 0 and z = 0.
fn twice(delta: f64) -> Matrix {
    Matrix::from_rows(&[[1.0, 0.0, 0.0], [2.0, delta, 0.0], [0.0, 0.0, 1.0]])
}

/// If the constraints are violated by δ, a redundant row has an independent component of size δ. If
/// the row is treated as independent, the acceleration along this component has an error of order
/// one. With the fixed rank, all errors are of order δ.
#[test]
fn noise_off_the_constraints_stays_noise() {
    let gamma = [1.0, 2.0 + 1e-6, 0.5];
    for delta in [0.0, 1e-14, 1e-9, 1e-6, 1e-4] {
        for solver in [
            &mut NullSpace::new(2) as &mut dyn Solver,
            &mut MinimumNorm::new(2),
        ] {
            let [a, _] = solve(solver, &twice(delta), &[1.0; 3], &[0.0, 3.0, 0.0], &gamma).unwrap();
            for (x, expected) in a.iter().zip([1.0, 3.0, 0.5]) {
                assert!(
                    (x - expected).abs() < 4.0 * delta + 2e-6,
                    "{delta:e}: {a:?}"
                );
            }
        }
    }
}

#[test]
fn massless_bodies_and_motions() {
    // The coordinates x, y, z with masses (1, 0, 0) are rigidly connected.
    let mass = [1.0, 0.0, 0.0];
    let tied = Matrix::from_rows(&[[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [1.0, 0.0, -1.0]]);
    let mut least = MinimumNorm::new(2);
    let [a, lambda] = solve(&mut least, &tied, &mass, &[0.0, 0.0, 2.0], &[0.0; 3]).unwrap();
    for x in a {
        assert!((x - 2.0).abs() < 1e-14, "{x}");
    }
    // The solutions are λ = (l₁ + s, l₂ + s, −s) with l = (−2, −2). The norm is minimal for s =
    // 4/3.
    for (l, expected) in lambda.iter().zip([-2.0 / 3.0, -2.0 / 3.0, -4.0 / 3.0]) {
        assert!((l - expected).abs() < 1e-14, "{lambda:?}");
    }
    let refused = solve(&mut MinimumNorm::new(3), &tied, &mass, &[0.0; 3], &[0.0; 3]);
    assert_eq!(refused, Err(Fault::RankLost { rank: 3 }));
    // With the row x = 0 alone, the motion in y moves no mass.
    let loose = Matrix::from_rows(&[[1.0, 0.0]]);
    let refused = solve(
        &mut MinimumNorm::new(1),
        &loose,
        &[1.0, 0.0],
        &[0.0; 2],
        &[0.0],
    );
    assert_eq!(refused, Err(Fault::Massless));
}

/// With one coordinate of mass 1 and one row of length σ, the iterate is
/// `(1 − (μ/(μ + σ²))^k)·γ/σ`.
#[test]
fn the_response_of_one_direction() {
    let (sigma, mu) = (0.3, 0.05);
    let c = Matrix::from_rows(&[[sigma]]);
    for iterations in 1..12 {
        let mut solver = Proximal::with_tuning(Tuning { mu, iterations }, vec![1.0]);
        let [a, _] = solve(&mut solver, &c, &[1.0], &[0.0], &[1.0]).unwrap();
        let response = (1.0 - (mu / (mu + sigma * sigma)).powi(iterations as i32)) / sigma;
        assert!(
            (a[0] - response).abs() < 1e-14 * response,
            "{iterations}: {}",
            a[0]
        );
    }
}

/// One direction has a small singular value, σ_r² = 4e-3, and a redundant row has a residual δ, as
/// at a stage of an integrator. The rule for μ gives an error of order δ. A small μ with few
/// iterations is equally accurate if the constraints are satisfied, but here it gives accelerations
/// of order one.
#[test]
fn off_the_constraints_the_rule_beats_a_small_mu() {
    let weak = 0.09;
    let c = |delta: f64| {
        Matrix::from_rows(&[[1.0, 0.0, 0.0], [1.0, weak, 0.0], [1.0, 0.5 * weak, delta]])
    };
    let (mass, f, delta) = ([1.0; 3], [0.0, 0.0, 1.0], 1e-4);
    let exact = [0.2, 0.1 / weak, 1.0];
    let gamma = [0.2, 0.3, 0.25];
    let mut by_rule = Proximal::new(&c(0.0), &mass, 2, 1e-8).unwrap();
    let tuning = by_rule.tuning();
    assert!(
        (1e-4..1e-3).contains(&tuning.mu) && tuning.iterations == 8,
        "{tuning:?}"
    );
    let small = Tuning {
        mu: 1e-8,
        iterations: 3,
    };
    // The diagonal of C·M⁻¹·Cᵀ is nearly one.
    let mut by_habit = Proximal::with_tuning(small, vec![1.0; 3]);
    let error = |solver: &mut Proximal, delta: f64| {
        let [a, _] = solve(solver, &c(delta), &mass, &f, &gamma).unwrap();
        distance(&a, &exact)
    };
    for solver in [&mut by_rule, &mut by_habit] {
        let on_constraints = error(solver, 0.0);
        assert!(on_constraints < 1e-7, "{on_constraints:e}");
    }
    let (rule, habit) = (error(&mut by_rule, delta), error(&mut by_habit, delta));
    assert!(rule < 10.0 * delta, "{rule:e}");
    assert!(habit > 1e3 * rule, "{habit:e} {rule:e}");
}
