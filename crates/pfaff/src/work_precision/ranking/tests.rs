//! Rankings of fictitious runs.

use super::*;

const LIMIT: f64 = 1e-15;

fn run(method: &'static str, tolerance: f64, error: f64, seconds: f64) -> WorkPrecisionRow {
    let finished = seconds.is_finite();
    WorkPrecisionRow {
        scene: "made up".to_owned(),
        curve: CurveName {
            formulation: "kept-rows",
            method,
            stabilisation: "projection",
        },
        tolerance,
        errors: [error, error, f64::NAN, f64::NAN],
        constraint_residual: 0.0,
        evaluations: (1e6 * seconds) as u64,
        projections: 0,
        factorisations: 0,
        steps: 1,
        seconds,
        status: if finished { "done" } else { "stopped" }.to_owned(),
        rejected: 0,
        repetitions: 3,
        energy_error: 0.0,
        error_state: error,
        reference_limit: LIMIT,
    }
}

/// Returns the time of a method at an error.
fn seconds(rows: &[WorkPrecisionRow], method: &str, error: f64) -> Option<f64> {
    let lines = ranking(rows, LIMIT);
    let line = lines.iter().find(|line| line.error == error)?;
    let place = line.places.iter().find(|p| p.curve.method == method)?;
    Some(place.seconds)
}

#[test]
fn between_two_runs_the_time_is_straight_in_logarithms() {
    // A hundredth of the error takes ten times the time, so a tenth takes √10 times the time.
    let rows = [run("a", 1e-4, 1e-4, 1e-3), run("a", 1e-6, 1e-6, 1e-2)];
    let at = seconds(&rows, "a", 1e-5).expect("reached");
    assert!((at - 1e-3 * 10_f64.sqrt()).abs() < 1e-12, "{at}");
    // A looser error takes the time of the loosest run. A tighter error is not reached.
    assert_eq!(seconds(&rows, "a", 1e-3), Some(1e-3));
    assert_eq!(seconds(&rows, "a", 1e-7), None);
}

#[test]
fn luck_is_not_accuracy() {
    // The method is accurate at 1e-4, follows another branch at 1e-6, and is accurate again at
    // 1e-8.
    let rows = [
        run("a", 1e-4, 1e-6, 1e-3),
        run("a", 1e-6, 1.0, 2e-3),
        run("a", 1e-8, 1e-8, 4e-3),
    ];
    let at = seconds(&rows, "a", 1e-6).expect("reached");
    assert!(at > 2e-3, "{at}");
}

#[test]
fn a_run_that_failed_reaches_nothing() {
    let rows = [
        run("a", 1e-4, f64::NAN, f64::NAN),
        run("a", 1e-6, 1e-6, 4e-3),
    ];
    assert_eq!(seconds(&rows, "a", 1e-4), Some(4e-3));
    assert!(ranking(&rows[..1], LIMIT).is_empty());
}

#[test]
fn what_the_reference_does_not_resolve_is_not_told() {
    let rows = [run("a", 1e-12, 1e-14, 1e-3)];
    let errors: Vec<f64> = ranking(&rows, 1e-9).iter().map(|line| line.error).collect();
    assert_eq!(errors.last(), Some(&1e-8));
    assert!(ranking(&rows, f64::NAN).is_empty());
}

#[test]
fn winners_are_told_for_ranges() {
    let mut rows = Vec::new();
    for k in 3..=12 {
        let tolerance = 10_f64.powi(-k);
        // The second method is faster down to 1e-6. Its run at 1e-6 is abandoned.
        rows.push(run("steady", tolerance, tolerance, 1e-3 * f64::from(k)));
        if k <= 6 {
            rows.push(run("quick", tolerance, tolerance, 5e-4 * f64::from(k)));
        }
    }
    let words = words(&ranking(&rows, LIMIT), &rows);
    assert_eq!(
        words,
        [
            "For errors of 1e-3 … 1e-6, quick is the fastest method. The second-fastest method (at the smallest error: steady) takes 2.0 times as long.",
            "For errors of 1e-7 … 1e-12, steady is the fastest method, and no other method reaches the smallest error.",
        ]
    );
}
