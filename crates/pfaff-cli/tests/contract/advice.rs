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

/// Chebyshev's linkage on an exact line has one freedom of first order, and cannot move.
#[test]
fn a_mechanism_locked_at_second_order_is_warned_of() {
    let d = analysis("chebyshev", &[]);
    assert_eq!(d["mobility"], 1);
    let sentence = "mobility 1 at first order, but this mechanism cannot move";
    let warnings = d["warnings"].as_array().expect("an array");
    assert!(
        warnings
            .iter()
            .any(|w| w.as_str().is_some_and(|w| w.starts_with(sentence))),
        "{warnings:?}"
    );
    contains(&words("chebyshev", &[]), &[sentence]);
    // What moves is not locked.
    assert_eq!(analysis("four-bar", &[])["warnings"], json!([]));
}

/// A truck going straight is compared with poses in which it is jackknifed: its edges do not hold on the way there.
#[test]
fn a_singular_configuration_says_what_it_was_compared_with() {
    let d = analysis("truck", &[]);
    let warning = d["warnings"][0].as_str().expect("a warning");
    contains(
        warning,
        &[
            "redundancy 2 and its verdicts hold at this singular configuration only",
            "poses that the joints allow, with knife edges and other conditions on velocities left free",
        ],
    );
    contains(
        &words("truck", &[]),
        &["ONLY HERE", "`--along` tells whether"],
    );
}

/// Two guides of one carriage: deleting single rows does not help, and deleting a whole guide has to be allowed.
#[test]
fn what_only_whole_joints_make_unique_is_said() {
    let text = words("carriage", &[]);
    contains(
        &text,
        &[
            r#"- rear: nothing that leaves each joint a row; for whole joints, `--make-unique "rear" --allow whole`"#,
        ],
    );
    let whole = words("carriage", &["--make-unique", "rear", "--allow", "whole"]);
    contains(&whole, &["delete `front`"]);
}

/// 12 N·m at the input, 0.01, 0.04 and 0.9 kg·m² at the speeds 1, −½ and ⅙.
#[test]
fn sums_have_numbers() {
    let reduced = 0.01 + 2.0 * 0.04 / 4.0 + 0.9 / 36.0;
    let on_output = 0.9 * (12.0 / reduced / 6.0);
    let text = words("gear-train", &["--combine", "out-1 + out-2"]);
    contains(&text, &["T about (0, 0.12)"]);
    let d = analysis(
        "gear-train",
        &["--combine", "out-1 + out-2", "--choose", "minimum-norm"],
    );
    let [sum, wrench] = d["groups"].as_array().expect("an array").as_slice() else {
        panic!("{d:#}");
    };
    assert_eq!(sum["values"][0]["name"], "sum");
    assert_eq!(wrench["about"], json!([0.0, 0.12]));
    let names: Vec<&Value> = (0..3).map(|k| &wrench["values"][k]["name"]).collect();
    assert_eq!(names, ["Fx", "Fy", "T"]);
    // The first body of a mesh is the layshaft, which turns three times as fast as the output.
    let torque = |v: &Value| v["value"].as_f64().expect("a number");
    for value in [
        &sum["values"][0],
        &wrench["values"][2],
        &d["choices"][0]["groups"][1]["components"][2],
    ] {
        assert!(
            (torque(value).abs() - on_output / 3.0).abs() < 1e-12,
            "{value}, {on_output}"
        );
    }
}

/// A number is only shown where every solution has it, or with a choice.
#[test]
fn a_sum_that_is_not_unique_has_a_number_by_choice_only() {
    let sum = ["--combine", "out-1.T - out-2.T"];
    let d = analysis("gear-train", &sum);
    assert_eq!(d["groups"][1]["values"], Value::Null, "{d:#}");
    let d = analysis(
        "gear-train",
        &[&sum[..], &["--choose", "minimum-norm"]].concat(),
    );
    let chosen = &d["choices"][0]["groups"][1]["components"][0];
    // Both meshes are alike.
    assert_eq!(chosen["value"], 0.0);
    assert!(chosen["choice"].is_string());
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

/// An edge has no force along itself: that this is unique is no finding, and an instant at which it comes about is none.
#[test]
fn directions_without_any_force_are_no_findings() {
    let d = analysis("car", &["--along"]);
    for reaction in d["reactions"].as_array().expect("an array") {
        assert_eq!(reaction["unique_directions"], json!([]), "{reaction:#}");
    }
    assert_eq!(d["along"]["passages"], json!([]));
    // Perpendicular to the crank there is a force, and it is unique.
    let d = analysis("three-cranks", &[]);
    assert_eq!(
        d["reactions"][0]["unique_directions"][0]
            .as_array()
            .map(Vec::len),
        Some(2)
    );
}

/// Both cells of an inversor are alike at the start: exactly there, not 5 microseconds later.
#[test]
fn an_instant_at_the_start_is_the_start() {
    let d = analysis("peaucellier", &["--along"]);
    let passage = &d["along"]["passages"][0];
    assert_eq!(passage["time"], 0.0);
    contains(
        passage["text"].as_str().expect("a text"),
        &["at t = 0 s other"],
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
