//! The table and both dense outputs against the order conditions (`trees`).

use super::dense::weights;
use super::tableau::{A, C, D, E3, E5, FREE, STAGES};
use crate::trees::{error_size, violation};

/// Rounding of sums of up to 12 products of size ≤ 50, with weights ≤ 6; in 40 digits the rounded table has defects ≤ 7.2e-16.
const TOLERANCE: f64 = 1e-14;
/// The same for the dense outputs, whose coefficients go up to 530 with a factor of at most 1/16.
const DENSE_TOLERANCE: f64 = 3e-14;

fn padded(weights: &[f64; 12]) -> [f64; STAGES] {
    let mut all = [0.0; STAGES];
    all[..12].copy_from_slice(weights);
    all
}

fn step_weights() -> [f64; STAGES] {
    A[12]
}

fn without(error: &[f64; 12]) -> [f64; STAGES] {
    let (mut b, error) = (step_weights(), padded(error));
    for (b, e) in b.iter_mut().zip(error) {
        *b -= e;
    }
    b
}

fn dense<const R: usize>(rows: &[[f64; STAGES]; R], theta: f64) -> [f64; STAGES] {
    let w = weights(rows, theta);
    let mut b = w.stages;
    for (b, step) in b.iter_mut().zip(step_weights()) {
        *b += w.delta * step;
    }
    b
}

#[test]
fn nodes_are_row_sums() {
    for (row, c) in A.iter().zip(C) {
        assert!((row.iter().sum::<f64>() - c).abs() < TOLERANCE);
    }
}

/// The 200 conditions of order 8.
#[test]
fn step_has_order_eight() {
    for order in 1..=8 {
        let v = violation(&A, &step_weights(), order, 1.0);
        assert!(v < TOLERANCE, "order {order}: {v:e}");
    }
    assert!(violation(&A, &step_weights(), 9, 1.0) > 1e-5);
}

#[test]
fn embedded_solutions_have_order_five_and_three() {
    for (error, claimed) in [(&E5, 5), (&E3, 3)] {
        for order in 1..=claimed {
            let v = violation(&A, &without(error), order, 1.0);
            assert!(v < TOLERANCE, "order {order}: {v:e}");
        }
        assert!(violation(&A, &without(error), claimed + 1, 1.0) > 1e-4);
    }
}

#[test]
fn dense_outputs_have_order_six_and_seven_everywhere() {
    for theta in [0.05, 0.3, 0.5, 0.77, 1.0] {
        for order in 1..=6 {
            let v = violation(&A, &dense(&FREE, theta), order, theta);
            assert!(
                v < DENSE_TOLERANCE,
                "free, θ = {theta}, order {order}: {v:e}"
            );
        }
        for order in 1..=7 {
            let v = violation(&A, &dense(&D, theta), order, theta);
            assert!(v < DENSE_TOLERANCE, "θ = {theta}, order {order}: {v:e}");
        }
    }
    assert!(violation(&A, &dense(&FREE, 0.5), 7, 0.5) > 1e-7);
    assert!(violation(&A, &dense(&D, 0.5), 8, 0.5) > 1e-7);
}

/// The free output loses little more than its order: its error coefficients, largest in the step.
#[test]
fn error_coefficients_of_the_dense_outputs_are_small() {
    let worst = |size: &dyn Fn(f64) -> f64| {
        (1..20)
            .map(|i| size(f64::from(i) / 20.0))
            .fold(0.0, f64::max)
    };
    let free = worst(&|theta| error_size(&A, &dense(&FREE, theta), 7, theta));
    let accurate = worst(&|theta| error_size(&A, &dense(&D, theta), 8, theta));
    assert!(free < 2.4e-5, "{free:e}");
    assert!(accurate < 4.0e-5, "{accurate:e}");
}
