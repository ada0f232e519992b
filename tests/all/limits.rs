//! Each crate has one table of the values that its authors chose. For each value it states the
//! unit, the effect of a wrong value, and the test that then fails. `none, work only` means that no
//! test can fail, because only time or memory change; `none` means that the test is not written
//! yet.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Crates whose constants are in a table, `limits.rs`, and the required entries of the table.
const TABLES: [(&str, &str); 6] = [
    ("dynamics", include_str!("../reference/limits-dynamics.txt")),
    ("import", include_str!("../reference/limits-import.txt")),
    ("linalg", include_str!("../reference/limits-linalg.txt")),
    ("rank", include_str!("../reference/limits-rank.txt")),
    ("rotation", include_str!("../reference/limits-rotation.txt")),
    (
        "solvability",
        include_str!("../reference/limits-solvability.txt"),
    ),
];

/// Crates in which some constants are in a table and others are defined where they are used.
const PARTIAL_TABLES: [(&str, &str); 1] =
    [("scene", include_str!("../reference/limits-scene.txt"))];

/// Constants that are not chosen and are defined where they are used: facts of the plane and of
/// `f64`, coefficients of algorithms, special indices.
const FACTS: [(&str, &[&str]); 14] = [
    ("dynamics/src/linearise/coordinate.rs", &["BODY"]),
    ("linalg/src/double_double.rs", &["FACTOR", "EPSILON"]),
    (
        "linalg/src/double_double/trigonometry.rs",
        &["HALVINGS", "TERMS", "LARGEST"],
    ),
    ("linalg/src/powers.rs", &["STEP", "BIAS", "TO_NORMAL"]),
    ("linalg/src/schur/tiles.rs", &["$n", "SIDE"]),
    ("linalg/src/sparse/order/buckets.rs", &["NONE"]),
    ("rank/src/decision/modular.rs", &["FRACTION"]),
    ("rank/src/sparse/front.rs", &["OUTSIDE"]),
    ("rank/src/sparse/random.rs", &["DENSITY", "GOLDEN", "HALF"]),
    ("rank/src/sparse/smallest.rs", &["STREAM"]),
    ("rank/src/sparse/symbolic.rs", &["NUMBER", "ENTRY"]),
    ("rank/src/structure/graph.rs", &["NEW"]),
    ("solvability/src/generic/walker.rs", &["GOLDEN"]),
    ("solvability/src/sensitivity/instant.rs", &["GOLDEN_ANGLE"]),
];

/// This text replaces the name of a test if other values give the same results.
const WORK_ONLY: &str = "none, work only";

/// Largest number of constants without a test. A new constant needs a test.
const UNPINNED_MOST: usize = 20;

const NUMBERS: [&str; 9] = [
    "f64",
    "f32",
    "usize",
    "u64",
    "u32",
    "u8",
    "i64",
    "i32",
    "RangeInclusive<f64>",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ lies in the root")
}

/// Rust files below a folder.
fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("readable").flatten() {
        let path = entry.path();
        match path.is_dir() {
            true if !path.ends_with("target") => sources(&path, out),
            false if path.extension().is_some_and(|e| e == "rs") => out.push(path),
            _ => {}
        }
    }
}

/// A constant with the comment above it.
struct Limit {
    name: String,
    value: String,
    comment: String,
}

/// Returns the numeric constants of a text, up to its tests.
fn limits(text: &str) -> Vec<Limit> {
    let mut found = Vec::new();
    let mut comment = String::new();
    for line in text.lines().take_while(|l| *l != "mod tests {") {
        let line = line.trim();
        if let Some(words) = line.strip_prefix("///") {
            comment.push_str(words);
            continue;
        }
        let said = std::mem::take(&mut comment);
        let visible = line
            .strip_prefix("pub(crate) ")
            .or(line.strip_prefix("pub "));
        let item = visible.unwrap_or(line).strip_prefix("const ");
        let item = item.filter(|item| !item.starts_with("fn "));
        let Some((name, rest)) = item.and_then(|item| item.split_once(": ")) else {
            continue;
        };
        let (ty, value) = rest.split_once(" = ").expect("a value on the same line");
        if NUMBERS.contains(&ty) {
            found.push(Limit {
                name: name.to_owned(),
                value: value.trim_end_matches(';').to_owned(),
                comment: said,
            });
        }
    }
    found
}

/// Returns the text of a comment after a word, up to the end of the sentence.
fn said<'c>(limit: &'c Limit, word: &str) -> Option<&'c str> {
    let rest = limit.comment.split_once(word)?.1;
    Some(
        rest.split_once(". ")
            .map_or(rest, |(said, _)| said)
            .trim_end_matches('.'),
    )
}

#[test]
fn numbers_stand_in_the_table_of_their_crate() {
    let crates = root().join("crates");
    for (name, _) in TABLES {
        let mut all = Vec::new();
        sources(&crates.join(name).join("src"), &mut all);
        for path in all {
            let file = path.strip_prefix(&crates).expect("below").display();
            let file = file.to_string();
            if file.ends_with("src/limits.rs") || file.contains("tests") {
                continue;
            }
            let facts = FACTS.iter().find(|(of, _)| *of == file);
            let facts = facts.map_or(&[][..], |(_, names)| *names);
            let text = fs::read_to_string(&path).expect("readable");
            let mut names: Vec<String> = limits(&text).into_iter().map(|l| l.name).collect();
            names.retain(|name| !facts.contains(&name.as_str()));
            assert!(
                names.is_empty(),
                "{file} holds {names:?}: move them to {name}/src/limits.rs"
            );
        }
    }
}

#[test]
fn every_limit_has_its_unit_its_reason_and_a_test_that_exists() {
    let mut all = Vec::new();
    sources(root(), &mut all);
    let mut tests = BTreeSet::new();
    for path in all {
        let text = fs::read_to_string(path).expect("readable");
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            if line.trim() == "#[test]"
                && let Some(function) = lines.next().and_then(|l| l.trim().strip_prefix("fn "))
            {
                tests.insert(function.split('(').next().unwrap_or_default().to_owned());
            }
        }
    }
    let mut unpinned = Vec::new();
    for (name, expected) in TABLES.into_iter().chain(PARTIAL_TABLES) {
        let mut table = String::new();
        let path = root().join(format!("crates/{name}/src/limits.rs"));
        for limit in limits(&fs::read_to_string(path).expect("readable")) {
            let constant = &limit.name;
            let unit = said(&limit, "Unit: ").unwrap_or_else(|| panic!("{constant}: no unit"));
            assert!(
                limit.comment.contains("Too small") && limit.comment.contains("oo large"),
                "{constant}: what breaks if it is too small, and if it is too large?"
            );
            let test = said(&limit, "Test: ").unwrap_or_else(|| panic!("{constant}: no test"));
            let test = test.trim_matches('`');
            assert!(
                ["none", WORK_ONLY].contains(&test) || tests.contains(test),
                "{constant}: there is no test `{test}`"
            );
            if test == "none" {
                unpinned.push(constant.clone());
            }
            let value = &limit.value;
            table.push_str(&format!("{constant} = {value} ({unit}), {test}\n"));
        }
        assert!(
            table == expected,
            "the limits of `{name}` have changed; if they should, this is tests/reference/limits-{name}.txt:\n{table}"
        );
    }
    assert!(
        unpinned.len() <= UNPINNED_MOST,
        "{} limits have no test, more than {UNPINNED_MOST}: {unpinned:?}",
        unpinned.len()
    );
}
