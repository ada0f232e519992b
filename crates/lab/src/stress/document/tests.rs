//! Tests the contents of table, document and page.

use super::*;
use crate::stress::{StressTable, extremes, stress_page};

fn row(case: &str, error: f64, judgement: Judgement) -> StressRow {
    StressRow {
        family: "masses",
        case: case.into(),
        varied: Some(("mass ratio", 1e-6)),
        method: "auto".into(),
        formulation: "kept-rows".into(),
        expected: "off by at most 1.0e-13: closed form".into(),
        bound: 1e-13,
        error,
        outcome: "<odd> text".into(),
        judgement,
        seconds: 0.25,
    }
}

fn document() -> StressDocument {
    let rows = vec![
        row("chain", 2e-14, Judgement::Right),
        row("loop", f64::NAN, Judgement::Limit),
        row("robot", 0.5, Judgement::SilentlyWrong),
    ];
    let tally = Tally::of(rows.iter().map(|r| r.judgement));
    StressDocument {
        provenance: Provenance {
            machine: "one".into(),
            versions: "0".into(),
            date: "today".into(),
            command: "pfaff stress".into(),
        },
        partial: false,
        tally,
        families: vec![StressFamily {
            name: "masses",
            about: "masses far apart",
            tally,
            rows,
        }],
    }
}

#[test]
fn the_page_shows_what_does_not_pass_first_and_the_worst_of_it_before_the_rest() {
    let document = document();
    let page = stress_page(&document, &extremes(&document.families));
    let place = |text: &str| {
        page.find(text)
            .unwrap_or_else(|| panic!("no `{text}` in\n{page}"))
    };
    assert!(place("right 1, refused by name 1, silently wrong 1") < place("What does not pass"));
    assert!(place("silently wrong</td>") < place("though there is an answer</td>"));
    assert!(place("What does not pass") < place("masses: error against mass ratio"));
    assert!(page.contains("&lt;odd&gt; text") && !page.contains("<odd>"));
    assert!(page.contains("wrong 5.0e-1") && page.contains(">2.0e-14</span>"));
}

#[test]
fn a_table_has_a_line_for_each_case() {
    let mut table = StressTable::new(Vec::new()).expect("a vector");
    for row in &document().families[0].rows {
        table.row(row).expect("a vector");
    }
    let text = String::from_utf8(table.finish().expect("a vector")).expect("text");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 4);
    assert_eq!(
        lines[2],
        "masses,loop,mass ratio,1e-6,auto,kept-rows,off by at most 1.0e-13: closed form,1e-13,NaN,\
         \"refused, though there is an answer\",<odd> text,0.25"
    );
}

/// Points outside the range of the axis are drawn at the edge. A case that ends with an error
/// message has no point.
#[test]
fn a_figure_has_a_point_for_each_worst_answer() {
    let mut family = document().families.remove(0);
    let figure = extremes(std::slice::from_ref(&family));
    // There is one marker in the legend, and one marker for the two answers at 1e-6, because only
    // the larger error is drawn.
    assert_eq!(figure.matches("<polygon").count(), 2);
    family.rows.clear();
    assert_eq!(extremes(&[family]), "");
}
