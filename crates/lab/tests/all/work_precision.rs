//! One table with the product and the comparators.

use std::time::Duration;

use lab::comparators::{Fault, run_within};
use lab::work_precision::ways;
use pfaff::work_precision::{Plan, Subject};

/// Cases of the suite by every way: all reach the end, and their errors are those of their
/// tolerances.
#[test]
fn cases_are_compared_by_every_way() {
    for name in ["sleigh", "three-cranks"] {
        compare(name);
    }
}

fn compare(name: &str) {
    let subject = Subject::of_case(suite::find(name).expect("a case")).expect("builds");
    let plan = Plan {
        tolerances: vec![1e-5, 1e-8],
        repetitions: 1,
        seconds: 0.0,
        budget: 10.0,
        ..Plan::standard()
    };
    let rows = lab::work_precision(&subject, &plan).expect("compared");
    assert_eq!(rows.len(), plan.runs() + 2 * ways().len());
    for row in &rows {
        assert_eq!(row.status, "done", "{row:?}");
        if row.curve.stabilisation == "none" {
            continue; // How far it drifts is its own affair.
        }
        let error = row.errors[0].max(row.errors[1]);
        let bound = match row.curve.method {
            "generalized-alpha" => 300.0 * row.tolerance.powf(2.0 / 3.0),
            _ => 300.0 * row.tolerance,
        };
        assert!(error > 0.0 && error < bound, "{error:e}: {row:?}");
        assert!(row.errors[2].is_finite() && row.seconds > 0.0, "{row:?}");
    }
    let named = |name: &str| rows.iter().filter(|r| r.curve.formulation == name).count();
    assert_eq!(named("minimum-norm"), 2);
}

/// A budget of no time is over at once.
#[test]
fn what_takes_too_long_is_given_up() {
    let subject = Subject::of_case(suite::find("sleigh").expect("a case")).expect("builds");
    let way = ways()[0];
    let made = run_within(subject.prepared(), way, 1e-8, &[1.0], Duration::ZERO);
    assert!(matches!(made, Err(Fault::TooLong { .. })), "{made:?}");
}
