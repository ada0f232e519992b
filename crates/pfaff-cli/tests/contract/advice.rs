//! What `pfaff analyze` says beside verdicts: what they hold for, what to ask next, and the numbers of sums.

use serde_json::{Value, json};

use super::analyze::{contains, document};
use super::{pfaff, stderr, stdout, with_scene};

fn example(name: &str) -> String {
    format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

fn analysis(name: &str, more: &[&str]) -> Value {
    let file = example(name);
    document(&pfaff(&[&["analyze", "--json", &file], more].concat()))
}

fn words(name: &str, more: &[&str]) -> String {
    let file = example(name);
    // Without the breaks of lines.
    let text = stdout(&pfaff(&[&["analyze", &file], more].concat()));
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Nothing turns the carriage, so the torques of the smallest reactions are zero, not rounding.
#[test]
fn what_is_zero_is_printed_as_zero() {
    let d = analysis("carriage", &["--choose", "minimum-norm"]);
    for k in 0..2 {
        assert_eq!(
            d["choices"][0]["reactions"][k]["components"][2]["value"],
            0.0
        );
    }
    contains(
        &words("carriage", &["--choose", "drop:2,4"]),
        &["choice 1: no reaction in the rows 2 (`rear`, angle), 4 (`front`, angle)"],
    );
}

#[test]
fn who_does_not_say_how_long_is_told_how() {
    let scene = super::bad_input::PENDULUM;
    let scene = scene.split("[simulate]").next().unwrap_or(scene);
    let output = with_scene(&["analyze", "-", "--along"], scene);
    contains(
        &stderr(&output),
        &["no `[simulate]`", "`--t-end`", "after `--along`"],
    );
}
