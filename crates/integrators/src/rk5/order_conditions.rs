//! Checks both tables and their dense outputs with the order conditions (`trees`).

use super::dense::{NODE_A, NODE_B, quartic_weights, quintic_weights};
use super::{Dopri5, Tableau, Tsit5};
use crate::trees::{error_size, violation};

/// Number of stages, including the two extra evaluations.
const STAGES: usize = 9;
/// Bound on the rounding error of sums of up to 9 products of size ≤ 50.
const TOLERANCE: f64 = 1e-13;

type Weights = [f64; STAGES];

fn step_weights<T: Tableau>() -> Weights {
    let mut b = [0.0; STAGES];
    b[..6].copy_from_slice(&T::A[5]);
    b
}

fn quartic<T: Tableau>(theta: f64) -> Weights {
    let w = quartic_weights(theta);
    let mut b = step_weights::<T>().map(|b| w.delta * b);
    for (b, d) in b.iter_mut().zip(T::D) {
        *b += w.d * d;
    }
    b[0] += w.f0;
    b[6] += w.f1;
    b
}

fn quintic<T: Tableau>(theta: f64) -> Weights {
    let w = quintic_weights(theta);
    let mut b = step_weights::<T>().map(|b| w.delta * b);
    b[0] += w.f0;
    b[6] += w.f1;
    b[7] += w.f_a;
    b[8] += w.f_b;
    b
}

fn stage_matrix<T: Tableau>() -> [Weights; STAGES] {
    let mut a = [[0.0; STAGES]; STAGES];
    for (row, from) in a[1..7].iter_mut().zip(T::A) {
        row[..6].copy_from_slice(&from);
    }
    a[7] = quartic::<T>(NODE_A);
    a[8] = quartic::<T>(NODE_B);
    a
}

fn check_step<T: Tableau>(tolerance: f64) {
    let (a, b) = (stage_matrix::<T>(), step_weights::<T>());
    for (row, c) in T::A.iter().zip(T::C) {
        assert!((row.iter().sum::<f64>() - c).abs() < tolerance);
    }
    let mut embedded = b;
    for (b, e) in embedded.iter_mut().zip(T::E) {
        *b -= e;
    }
    for order in 1..=5 {
        let v = violation(&a, &b, order, 1.0);
        assert!(v < tolerance, "order {order}: {v:e}");
    }
    for order in 1..=4 {
        let v = violation(&a, &embedded, order, 1.0);
        assert!(v < tolerance, "embedded, order {order}: {v:e}");
    }
    assert!(violation(&a, &b, 6, 1.0) > 1e-4);
    assert!(violation(&a, &embedded, 5, 1.0) > 1e-4);
}

#[test]
fn steps_have_order_five_and_the_embedded_solutions_four() {
    check_step::<Dopri5>(TOLERANCE);
    check_step::<Tsit5>(TOLERANCE);
}

fn check_dense<T: Tableau>() {
    let a = stage_matrix::<T>();
    for theta in [0.05, 0.3, 0.5, 0.77, 1.0] {
        for order in 1..=4 {
            assert!(violation(&a, &quartic::<T>(theta), order, theta) < TOLERANCE);
        }
        for order in 1..=5 {
            assert!(violation(&a, &quintic::<T>(theta), order, theta) < TOLERANCE);
        }
    }
    assert!(violation(&a, &quartic::<T>(0.5), 5, 0.5) > 1e-5);
}

#[test]
fn dense_outputs_have_order_four_and_five_everywhere() {
    check_dense::<Dopri5>();
    check_dense::<Tsit5>();
}

/// Returns the largest error coefficients of the quintic within the step, relative to the error
/// coefficients at the end of the step.
fn quintic_over_step<T: Tableau>() -> f64 {
    let a = stage_matrix::<T>();
    let at_end = error_size(&a, &quintic::<T>(1.0), 6, 1.0);
    assert!((at_end - error_size(&a, &step_weights::<T>(), 6, 1.0)).abs() < TOLERANCE);
    (1..=100)
        .map(|i| f64::from(i) / 100.0)
        .map(|theta| error_size(&a, &quintic::<T>(theta), 6, theta) / at_end)
        .fold(0.0, f64::max)
}

#[test]
fn quintics_are_as_accurate_as_the_steps() {
    assert!(quintic_over_step::<Dopri5>() <= 1.0 + 1e-12);
    assert!(quintic_over_step::<Tsit5>() <= 1.73);
}
