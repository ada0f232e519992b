//! Tests the table with the methods of pfaff and the reference methods.

use std::time::Duration;

use lab::comparators::{Fault, run_within};
use lab::work_precision::{of_case, ways};
use pfaff::StudyError;
use pfaff::work_precision::{ComparisonPlan, Rival};

use super::{Folder, lab, stderr, stdout};

/// Computes cases of the suite by every method. All runs reach the end, and their errors correspond
/// to their tolerances.
#[test]
fn cases_are_compared_by_every_way() {
    for name in ["sleigh", "three-cranks"] {
        compare(name);
    }
}

fn compare(name: &str) {
    let subject = of_case(suite::find(name).expect("a case")).expect("builds");
    let plan = ComparisonPlan {
        tolerances: vec![1e-5, 1e-8],
        repetitions: 1,
        seconds: 0.0,
        budget: 10.0,
        ..ComparisonPlan::standard()
    };
    let ways = ways();
    let rivals: Vec<&dyn Rival> = ways.iter().map(|way| way as &dyn Rival).collect();
    let compared = subject.compare::<StudyError>(&plan, &rivals, &|| false, |_| Ok(()));
    let rows = compared.expect("compared").scene.rows;
    assert_eq!(rows.len(), 2 * (plan.curves.len() + ways.len()));
    for row in &rows {
        assert_eq!(row.status, "done", "{row:?}");
        if row.curve.stabilisation == "none" {
            continue; // Without stabilisation the drift is not tested.
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

/// A time limit of zero is exceeded at once.
#[test]
fn what_takes_too_long_is_given_up() {
    let subject = of_case(suite::find("sleigh").expect("a case")).expect("builds");
    let way = ways()[0];
    let made = run_within(subject.prepared(), way, 1e-8, &[1.0], Duration::ZERO);
    assert!(matches!(made, Err(Fault::TooLong { .. })), "{made:?}");
}

#[test]
fn a_case_of_the_suite_is_compared_with_its_reference() {
    let folder = Folder::new("work-precision-case");
    let arguments = [
        "work-precision",
        "sleigh",
        "--quick",
        "--out",
        folder.text(),
    ];
    let output = lab(&arguments);
    let table = folder.read("work_precision.csv");
    let rows = table.lines().skip(1);
    let rows: Vec<Vec<&str>> = rows.map(|line| line.split(',').collect()).collect();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(
        stdout(&output).contains("reference accurate to 3e-16"),
        "{}",
        stdout(&output)
    );
    // Columns 2 and 4 are method and tolerance, columns 5 and 6 are errors, and column 15 is the
    // status.
    let row = |method: &str, tolerance: &str| {
        let found = rows.iter().find(|r| r[2] == method && r[4] == tolerance);
        found.unwrap_or_else(|| panic!("{method} at {tolerance}: {rows:?}"))
    };
    for (tolerance, bound) in [("0.0001", 1e-3), ("1e-10", 1e-8)] {
        let dop853 = row("dop853", tolerance);
        assert_eq!(dop853[15], "done");
        let error: f64 = dop853[6].parse().expect("a number");
        assert!(error > 1e-16 && error < bound, "{tolerance}: {error:e}");
    }
    // This row belongs to a reference method in the same table.
    let gbs = row("gbs", "1e-10");
    let error: f64 = gbs[6].parse().expect("a number");
    assert!(error > 1e-16 && error < 1e-8, "{error:e}");
    for name in ["work_precision.svg", "report.html"] {
        assert!(folder.read(name).contains("Chaplygin sleigh"), "{name}");
    }
    assert!(!folder.0.join("work_precision.csv.part").exists());
}

#[test]
fn a_case_that_there_is_not_is_refused_with_those_there_are() {
    let folder = Folder::new("work-precision-unknown");
    let output = lab(&["work-precision", "sleih", "--out", folder.text()]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let said = stderr(&output);
    assert!(said.contains("no file or case `sleih`"), "{said}");
    assert!(said.contains("robot-trolley, three-cranks"), "{said}");
    assert!(said.contains("did you mean `sleigh`?"), "{said}");
    assert!(!folder.0.exists());
}
