//! Every option of `analyze` works for mechanisms of every size, because it analyses only the parts
//! that it needs; the error names a part that is too large.

use serde_json::Value;
use suite::generate::Kind;

use super::{stderr, stdout, with_scene};

fn document(arguments: &[&str], scene: &str) -> Value {
    let output = with_scene(&[&["analyze", "-", "--json"], arguments].concat(), scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).expect("a document")
}

/// Eighty parallelograms in a row, two of three with a third crank. Each parallelogram is a
/// separate part, and the results equal the results for one parallelogram alone.
#[test]
fn options_answer_by_parts() {
    let scene = super::generated(Kind::Parallelograms, 80);
    let asked = document(
        &[
            "--combine",
            "low-0-0.Fx + low-1-0.Fx",
            "--combine",
            "low-0-0 - low-0-0 + low-2-1 - low-2-1",
            "--make-unique",
            "low-4-1",
            "--eliminations",
            "3",
            "--frames",
            "--choose",
            "minimum-norm",
        ],
        &scene,
    );
    assert!(asked["rows"].as_u64() > Some(600));
    assert_eq!(asked["parts"]["number"], 80);
    let verdicts: Vec<&Value> = asked["groups"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|g| &g["verdict"])
        .collect();
    assert_eq!(verdicts, ["not_unique", "unique"]);
    // In one cell any one of ten rows of the other revolutes can be deleted.
    let ways = asked["make_unique"][0]["ways"].as_array().expect("a list");
    assert_eq!(ways.len(), 10);
    let rows_of = |name: &str| {
        let reactions = asked["reactions"].as_array().expect("a list");
        let found = reactions.iter().find(|r| r["name"] == name);
        found.expect("it is there")["rows"].clone()
    };
    let own = rows_of("low-4-1");
    for way in ways {
        let row = &way["rows"][0];
        assert!(!own.as_array().expect("a list").contains(row), "{row}");
    }
    // There are twelve sets for each of more than fifty cells, so there are more combinations than
    // can be counted, and the first sets differ in the last cell.
    let eliminations = &asked["eliminations"];
    assert!(
        eliminations["reason"]
            .as_str()
            .is_some_and(|r| r.contains("parts of the mechanism")),
        "{eliminations}"
    );
    let sets = eliminations["sets"].as_array().expect("a list");
    let p = asked["redundancy"].as_u64().expect("a number") as usize;
    assert_eq!(sets.len(), 3);
    assert!(
        sets.iter()
            .all(|set| set.as_array().is_some_and(|s| s.len() == p))
    );
    // A chosen reaction depends on the choice exactly if its verdict is "not unique".
    let choice = asked["choices"][0]["reactions"].as_array().expect("a list");
    let reactions = asked["reactions"].as_array().expect("a list");
    for (chosen, reaction) in choice.iter().zip(reactions) {
        for component in chosen["components"].as_array().expect("a list") {
            let nature = if component["choice"].is_null() {
                "fact"
            } else {
                "choice"
            };
            assert_eq!(component["nature"], nature, "{}", chosen["name"]);
            let is_open = reaction["verdict"] == "not_unique";
            assert!(is_open || nature == "fact", "{}", chosen["name"]);
        }
    }
    assert!(
        reactions
            .iter()
            .any(|r| r["frames"].as_array().is_some_and(|f| f.len() > 1))
    );
}

#[test]
fn large_motions_are_judged_by_parts() {
    let scene = super::generated(Kind::Parallelograms, 30);
    let moved = document(&["--along", "0.05"], &scene);
    assert!(moved["rows"].as_u64() > Some(250) && moved["parts"]["number"] == 30);
    let generic = &moved["along"]["generic"];
    assert_eq!(generic["redundancy"], moved["redundancy"]);
    assert_eq!(generic["rank"], moved["rank"]);
    assert!(
        moved["along"]["passages"]
            .as_array()
            .is_some_and(Vec::is_empty)
    );
    let later = document(&["--at-time", "0.05"], &scene);
    assert_eq!(later["redundancy"], moved["redundancy"]);
}

#[test]
fn a_part_that_is_too_large_is_named() {
    let scene = super::generated(Kind::Lattice, 12);
    let names = document(&[], &scene);
    let reactions = names["reactions"].as_array().expect("a list");
    let name = reactions[reactions.len() / 2]["name"]
        .as_str()
        .expect("a name");
    let output = with_scene(
        &["analyze", "-", "--combine", &format!("{name}.Fx")],
        &scene,
    );
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    let said = stderr(&output);
    assert!(
        said.contains("are on common cycles with") && said.contains("up to 600 rows"),
        "{said}"
    );
}

/// Rows are counted in the whole mechanism, and the text names a part that an answer omits; every
/// reaction with a unique component has a sensitivity.
#[test]
fn what_is_asked_of_all_parts_is_told_of_all() {
    let scene = super::generated(Kind::Parallelograms, 80);
    let known = document(&[], &scene);
    let reactions = known["reactions"].as_array().expect("a list");
    for r in reactions {
        let components = r["components"].as_array().expect("a list");
        let is_unique = components.iter().any(|c| c["verdict"] == "unique");
        assert_eq!(r["sensitivity"].is_number(), is_unique, "{r}");
    }
    let p = known["redundancy"].as_u64().expect("a number");
    // These are the redundant rows that analyze selects by default: the label at every number is
    // short.
    let dropped = known["dropped_rows"].as_array().expect("a list");
    let dropped: Vec<String> = dropped.iter().map(Value::to_string).collect();
    let chosen = document(
        &["--choose", &format!("drop:{}", dropped.join(","))],
        &scene,
    );
    let label = chosen["choices"][0]["label"].as_str().expect("a label");
    assert!(label.ends_with(&format!("and {} more", p - 3)), "{label}");
    // The number of rows equals the degree of redundancy, but all these rows are in the first
    // parts.
    let many: Vec<String> = (1..=p).map(|row| row.to_string()).collect();
    for (option, asked, expected) in [
        (
            "--drop",
            "6",
            format!("1 row is dropped, but the degree of redundancy is {p}"),
        ),
        (
            "--drop",
            &*many.join(","),
            "what is kept is dependent".to_owned(),
        ),
        (
            "--choose",
            "drop:6",
            format!(
                "must be the redundancy, {p}: `low-1-0`, `top-1-0`, `low-1-1` and 3 more have 1 such rows, but 0 of their rows are listed"
            ),
        ),
        (
            "--choose",
            "compliance:low-0-0=1e-6",
            "among `low-1-0`, `top-1-0`, `low-1-1` and 3 more: the choice does not determine"
                .to_owned(),
        ),
    ] {
        let output = with_scene(&["analyze", "-", option, asked], &scene);
        let said = stderr(&output)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        assert_eq!(output.status.code(), Some(2), "{option} {asked}: {said}");
        assert!(said.contains(&expected), "{option} {asked}: {said}");
    }
}
