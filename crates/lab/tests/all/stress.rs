//! Tests the command `lab stress`: its list of families, its files, its last line, its errors.

use serde_json::Value;

use super::{Folder, lab, stderr, stdout};

/// The documented columns, in their order; future versions may add columns after them.
const COLUMNS: &str =
    "family,case,varied,value,method,formulation,expected,bound,error,judgement,outcome,seconds";

#[test]
fn the_list_names_every_family_with_what_it_asks() {
    let output = lab(&["stress", "--list"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    for name in ["trivial", "massless", "invariance"] {
        assert!(
            stdout(&output).lines().any(|l| l.starts_with(name)),
            "{name}"
        );
    }
}

#[test]
fn a_family_has_its_files_and_ends_with_the_counts() {
    let folder = Folder::new("stress");
    let arguments = [
        "stress",
        "--family",
        "trivial",
        "--family",
        "duplicates",
        "--out",
        folder.text(),
    ];
    let output = lab(&arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let last = stdout(&output).lines().last().map(str::to_owned);
    let text = folder.read("stress.json");
    let document: Value = serde_json::from_str(&text).expect("one document");
    let tally = &document["tally"];
    let line = format!(
        "right {}, refused by name {}, silently wrong 0",
        tally["right"], tally["refused"]
    );
    assert_eq!(last.as_deref(), Some(line.as_str()));
    let table = folder.read("stress.csv");
    assert!(table.starts_with(COLUMNS), "{table}");
    let cases: u64 = ["right", "refused"]
        .map(|k| tally[k].as_u64().unwrap_or(0))
        .iter()
        .sum();
    assert_eq!(table.lines().count() as u64, 1 + cases);
    assert!(folder.read("report.html").contains("Everything passes."));
    assert!(!folder.0.join("stress.csv.part").exists());
}

#[test]
fn an_unknown_family_is_refused_with_those_there_are() {
    let folder = Folder::new("stress-unknown");
    let output = lab(&["stress", "--family", "trivia", "--out", folder.text()]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(
        stderr(&output).contains("there are: trivial, ")
            && stderr(&output).contains("did you mean `trivial`?"),
        "{}",
        stderr(&output)
    );
    assert!(!folder.0.exists());
}
