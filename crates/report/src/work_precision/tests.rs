//! Tests of table, figure and page of a small comparison.

use super::*;
use crate::figures;

fn curve(
    method: &'static str,
    formulation: &'static str,
    stabilisation: &'static str,
) -> CurveName {
    CurveName {
        formulation,
        method,
        stabilisation,
    }
}

fn row(curve: CurveName, tolerance: f64, seconds: f64, status: &str) -> WorkPrecisionRow {
    WorkPrecisionRow {
        scene: "pendulum".to_owned(),
        curve,
        tolerance,
        errors: [tolerance, 2.0 * tolerance, f64::NAN, f64::NAN],
        constraint_residual: 1e-16,
        evaluations: 120,
        projections: 10,
        factorisations: 140,
        steps: 10,
        seconds,
        status: status.to_owned(),
        rejected: 1,
        repetitions: 3,
        energy_error: 1e-9,
        error_state: 0.5 * tolerance,
        reference_limit: 3e-16,
    }
}

fn document() -> WorkPrecisionDocument {
    let kept = curve("dop853", "kept-rows", "projection");
    let rows = vec![
        row(kept.clone(), 1e-3, 1e-4, "done"),
        row(kept.clone(), 1e-6, 3e-4, "done"),
        row(
            curve("radau5", "kept-rows", "projection"),
            1e-3,
            f64::NAN,
            "stopped: <because>",
        ),
        row(
            curve("dop853", "null-space", "projection"),
            1e-3,
            2e-4,
            "done",
        ),
    ];
    let place = Place {
        curve: kept,
        seconds: 1e-4,
        evaluations: 120.0,
    };
    WorkPrecisionDocument {
        provenance: Provenance {
            machine: "one & only".to_owned(),
            versions: "0.1.0".to_owned(),
            date: "2026-01-01".to_owned(),
            command: "pfaff work-precision".to_owned(),
        },
        partial: false,
        summary: vec!["dop853 wins".to_owned()],
        scenes: vec![WorkPrecisionScene {
            name: "pendulum".to_owned(),
            title: "Pendulum".to_owned(),
            automatic: "dop853",
            reference: ReferenceDocument {
                source: "closed form".to_owned(),
                limits: [3e-16, 3e-16, f64::NAN, f64::NAN],
                agreement: String::new(),
            },
            summary: Vec::new(),
            ranking: vec![RankingLine {
                error: 1e-3,
                places: vec![place],
            }],
            rows,
        }],
    }
}

#[test]
fn the_table_has_the_promised_columns_and_every_row_when_it_comes() {
    let mut out = Vec::new();
    let document = document();
    let rows = &document.scenes[0].rows;
    let mut table = WorkPrecisionTable::new(&mut out).expect("a vector takes everything");
    table.row(&rows[0]).expect("a row");
    table.row(&rows[2]).expect("a row");
    drop(table);
    let text = String::from_utf8(out).expect("UTF-8");
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with(
        "scene,formulation,method,stabilisation,tolerance,error_position,error_velocity,error_acceleration,error_reaction,\
         constraint_residual,evaluations,projections,factorisations,steps,seconds,status,"
    ));
    assert_eq!(
        lines[1],
        "pendulum,kept-rows,dop853,projection,0.001,0.001,0.002,NaN,NaN,1e-16,120,10,140,10,0.0001,done,1,3,1e-9,0.0005,3e-16"
    );
    let columns = lines[0].split(',').count();
    assert!(
        lines[1..].iter().all(|l| l.split(',').count() == columns),
        "{lines:?}"
    );
    assert!(
        lines[2].contains(",NaN,stopped: <because>,"),
        "{}",
        lines[2]
    );
}

#[test]
fn the_page_needs_nothing_else_and_escapes_what_it_is_told() {
    let document = document();
    let figure = figures::work_precision(&document.scenes);
    let page = work_precision_page(&document, &figure);
    for piece in [
        "one &amp; only",
        "stopped: &lt;because&gt;",
        "<svg",
        "dop853 wins",
        "100 µs, 120",
        "prefers-color-scheme: dark",
    ] {
        assert!(page.contains(piece), "{piece}");
    }
    assert!(!page.contains("<script") && !page.contains("href=\"http") && !page.contains("src="));
    for tag in ["table", "tr", "details", "ul", "div", "svg"] {
        let opened =
            page.matches(&format!("<{tag}>")).count() + page.matches(&format!("<{tag} ")).count();
        assert_eq!(opened, page.matches(&format!("</{tag}>")).count(), "{tag}");
    }
}

#[test]
fn the_figure_has_a_point_for_every_finished_run_and_none_for_others() {
    let document = document();
    let svg = figures::work_precision(&document.scenes);
    // There are three runs of dop853. Two runs are drawn in all three panels, and the run with
    // another formulation is drawn only in the last panel. The legends have four samples, including
    // radau5.
    assert_eq!(svg.matches("<polygon").count(), 2 * 3 + 1 + 4);
    assert!(svg.contains("1 of 4 runs did not reach the end"));
    assert!(svg.contains("dop853: formulations and stabilisations"));
    assert!(figures::work_precision(&[]).starts_with("<svg"));
}

#[test]
fn times_have_three_digits() {
    let said = [1.234, 0.0123456, 4.56e-4, 7.8e-7].map(crate::page::duration);
    assert_eq!(said, ["1.23 s", "12.3 ms", "456 µs", "0.78 µs"]);
}
