//! Checks the table and both dense outputs with the order conditions (`trees`).

use super::dense::weights;
use super::tableau::{A, C, D, E3, E5, FREE, STAGES, STEP_STAGES};
use crate::trees::{error_size, violation};

/// Bound on the rounding error of sums of up to 12 products of size ≤ 50, with weights ≤ 6. The
/// defects of the rounded table, computed with 40 digits, are ≤ 7.2e-16.
const TOLERANCE: f64 = 1e-14;
/// The same bound for the dense outputs, whose coefficients of up to 2690 are multiplied by at most
/// 1/256.
const DENSE_TOLERANCE: f64 = 3e-14;

fn padded<const S: usize>(weights: &[f64; S]) -> [f64; STAGES] {
    let mut all = [0.0; STAGES];
    all[..S].copy_from_slice(weights);
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

fn dense<const R: usize, const S: usize>(rows: &[[f64; S]; R], theta: f64) -> [f64; STAGES] {
    let w = weights(rows, theta);
    let mut b = padded(&w.stages);
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

/// The step satisfies the 200 conditions of order 8.
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
fn dense_outputs_have_order_six_and_eight_everywhere() {
    for theta in [0.05, 0.3, 0.5, 0.77, 1.0] {
        let (free, accurate) = (dense(&FREE, theta), dense(&D, theta));
        for order in 1..=6 {
            let v = violation(&A, &free, order, theta);
            assert!(
                v < DENSE_TOLERANCE,
                "free, θ = {theta}, order {order}: {v:e}"
            );
        }
        for order in 1..=8 {
            let v = violation(&A, &accurate, order, theta);
            assert!(v < DENSE_TOLERANCE, "θ = {theta}, order {order}: {v:e}");
        }
    }
    assert!(violation(&A, &dense(&FREE, 0.5), 7, 0.5) > 1e-7);
    assert!(violation(&A, &dense(&D, 0.5), 9, 0.5) > 1e-7);
}

/// Returns the largest norm of the error coefficients of one order over the step.
fn largest_error<const R: usize, const S: usize>(rows: &[[f64; S]; R], order: i32) -> f64 {
    (1..=100)
        .map(|i| f64::from(i) / 100.0)
        .map(|theta| error_size(&A, &dense(rows, theta), order, theta))
        .fold(0.0, f64::max)
}

/// The error of the dense output without extra evaluations is not much larger than its order
/// implies.
#[test]
fn error_coefficients_of_the_free_output_are_small() {
    let free = largest_error(&FREE, 7);
    assert!(free < 2.4e-5, "{free:e}");
}

/// Within the step, the error coefficients do not exceed the error coefficients at the end of the
/// step.
#[test]
fn accurate_output_is_as_accurate_as_the_step() {
    let at_end = error_size(&A, &step_weights(), 9, 1.0);
    let largest = largest_error(&D, 9);
    assert!(
        largest <= at_end * (1.0 + 1e-9),
        "{largest:e}, step {at_end:e}"
    );
}

/// Rounding is not amplified. The test computes sums of the weights of the accurate output (12.907
/// at the end of the step) and of the stages of this output.
#[test]
fn weights_of_the_accurate_output_are_small() {
    let size = |b: &[f64; STAGES]| b.iter().map(|b| b.abs()).sum::<f64>();
    let largest = (1..=100)
        .map(|i| size(&dense(&D, f64::from(i) / 100.0)))
        .fold(0.0, f64::max);
    assert!(largest < 12.92, "{largest}");
    for row in &A[STEP_STAGES..] {
        assert!(size(row) < 8.0, "{}", size(row));
    }
}
