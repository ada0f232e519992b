//! Tests additional texts of `pfaff analyze`: the configurations to which verdicts apply, hints for
//! further commands, and the values of sums.

use serde_json::{Value, json};

use super::analyze::{contains, document};
use super::{Folder, pfaff, stderr, stdout, with_scene};

fn example(name: &str) -> String {
    format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

fn analysis(name: &str, more: &[&str]) -> Value {
    let file = example(name);
    document(&pfaff(&[&["analyze", "--json", &file], more].concat()))
}

fn words(name: &str, more: &[&str]) -> String {
    let file = example(name);
    // Compares without line breaks.
    let text = stdout(&pfaff(&[&["analyze", &file], more].concat()));
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Chebyshev's linkage on an exact line has one degree of freedom to first order, but cannot move.
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
    contains(
        &words("chebyshev", &[]),
        &[sentence, "at first order: it cannot move"],
    );
    // A mechanism that moves is not locked.
    assert_eq!(analysis("four-bar", &[])["warnings"], json!([]));
}

/// A door on two hinges has no degree of freedom; a four-bar can move, and a drive moves a crank.
#[test]
fn what_cannot_move_is_told_so() {
    for (name, cannot_move) in [
        ("door", true),
        ("truss", true),
        ("chebyshev", true),
        ("four-bar", false),
        ("gear-train", false),
        ("five-bar", false),
    ] {
        let d = analysis(name, &[]);
        assert_eq!(d["cannot_move"], cannot_move, "{name}");
        let said = words(name, &[]).contains("it cannot move");
        assert_eq!(said, cannot_move, "{name}");
        // There is no text about a search if no configuration could be found.
        assert!(
            !words(name, &[]).contains("no other configuration was reached"),
            "{name}"
        );
    }
}

/// A wheel is on a rack, and a second wheel meshes with it.
fn rack_and_gear(bearings: &str) -> String {
    format!(
        r#"
scene = {{ name = "rack", space = "plane" }}
body = [
    {{ name = "rack", mass = 2.0, inertia = 1.0 }},
    {{ name = "pinion", mass = 3.0, inertia = 0.25, position = [1.0, 0.5] }},
    {{ name = "wheel", mass = 3.0, inertia = 0.25, position = [1.0, 1.5] }},
]
joint = [
    {{ name = "teeth", type = "rack-and-pinion", bodies = ["rack", "pinion"], at = [1.0, 0.5], axis = [1.0, 0.0], radius = 0.5 }},
    {{ name = "mesh", type = "gear", bodies = ["pinion", "wheel"], ratio = -1.0 }},
    {{ name = "back", type = "gear", bodies = ["wheel", "pinion"], ratio = -1.0 }},
    {bearings}
]
"#
    )
}

/// The note appears once for all joints of a type, and only if the reader may look for a force in
/// another joint.
#[test]
fn what_a_reaction_leaves_out_is_noted() {
    let held = rack_and_gear(
        r#"
    { name = "guide", type = "translational", bodies = ["ground", "rack"], at = [0.0, 0.0], axis = [1.0, 0.0] },
    { name = "lower", type = "revolute", bodies = ["ground", "pinion"], at = [1.0, 0.5] },
    { name = "upper", type = "revolute", bodies = ["ground", "wheel"], at = [1.0, 1.5] },
"#,
    );
    let of =
        |scene: &str| document(&with_scene(&["analyze", "--json", "-"], scene))["notes"].clone();
    let notes = of(&held);
    assert_eq!(notes.as_array().map(Vec::len), Some(2), "{notes:#}");
    assert_eq!(notes[0]["joints"], json!(["teeth"]));
    assert_eq!(notes[1]["joints"], json!(["mesh", "back"]));
    let text = |k: usize| notes[k]["text"].as_str().expect("a text").to_owned();
    assert!(text(0).starts_with("`teeth`: the reaction of a rack and its pinion is the force"));
    assert!(text(1).starts_with(
        "`mesh`, `back`: the reaction of a gear is a couple, without the force of teeth or belt"
    ));
    contains(
        &stdout(&with_scene(&["analyze", "-"], &held)),
        &[&format!("note: {}", text(0)), &format!("note: {}", text(1))],
    );
    // The cases are bodies without other forces, and scenes without gears.
    assert_eq!(of(&rack_and_gear("")), json!([]));
    assert_eq!(analysis("four-bar", &[])["notes"], json!([]));
}

/// A constant as `motion` is accepted, with a note that the drive then keeps the joint coordinate
/// constant; the syntax that the note recommends is accepted without a note.
#[test]
fn a_constant_motion_is_said_to_hold_the_measure() {
    let scene = |motion: &str| {
        format!(
            r#"
scene = {{ name = "crank", space = "plane" }}
body = [{{ name = "crank", mass = 1.0, inertia = 1.0 }}]
joint = [{{ name = "pivot", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] }}]

[[drive]]
name = "motor"
joint = "pivot"
type = "angle"
{motion}
"#
        )
    };
    let check = |motion: &str| document(&with_scene(&["check", "--json", "-"], &scene(motion)));
    for (motion, value) in [("motion = 0.3", "0.3"), ("motion = -2", "-2")] {
        let warnings = check(motion)["warnings"].clone();
        let warning = warnings[0].as_str().expect("a warning");
        assert_eq!(warnings.as_array().map(Vec::len), Some(1), "{warnings:#}");
        contains(
            warning,
            &[&format!(
                "line 10: drive `motor`: `motion = {value}` is constant, and a drive follows f(t) − f(0), so the measure is held at \
                 its initial value"
            )],
        );
        for (command, head) in [("check", "warning[P0191]"), ("analyze", "warning")] {
            let said = stdout(&with_scene(&[command, "-"], &scene(motion)));
            contains(&said, &[&format!("{head}: {warning}")]);
        }
        let advised: Vec<&str> = warning
            .split('`')
            .filter(|x| x.starts_with("motion = "))
            .collect();
        assert_eq!(
            advised.len(),
            4,
            "what was written, a stroke, a speed, none: {advised:?}"
        );
        assert_eq!(
            advised[1..3],
            [
                format!(
                    "motion = {{ type = \"steps\", steps = [{{ from = 0, to = 1, by = {value} }}] }}"
                ),
                format!("motion = {{ type = \"constant-rate\", rate = {value} }}"),
            ]
        );
        for advised in &advised[1..] {
            let checked = check(advised);
            assert_eq!(checked["ok"], true, "{checked:#}");
            assert_eq!(checked["warnings"], json!([]), "{checked:#}");
        }
    }
}

/// A truck that moves straight is compared with configurations in which it is jackknifed: the
/// constraints of its edges are not enforced between these configurations.
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
        &["SINGULAR", "`--along` shows whether"],
    );
}

/// Two guides belong to one carriage: deletions of single rows have no effect, only the deletion of
/// a whole guide has. As pins in slots, both guides are needed.
#[test]
fn what_only_whole_joints_make_unique_is_said() {
    let text = words("carriage", &[]);
    contains(
        &text,
        &[
            "make each of `rear` and `front` a pin on a line (`pin-in-slot`): all reactions are unique",
        ],
    );
    let whole = words("carriage", &["--make-unique", "rear", "--allow", "whole"]);
    contains(&whole, &["delete `front`"]);
}

/// The input has 12 N·m; the moments of inertia 0.01, 0.04 and 0.9 kg·m² have the relative speeds
/// 1, −½ and ⅙.
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

/// A value is shown only if it is the same in every solution, or for a chosen solution.
#[test]
fn a_sum_that_is_not_unique_has_a_number_by_choice_only() {
    let sum = ["--combine", "out-1.T - out-2.T"];
    let d = analysis("gear-train", &sum);
    let open = &d["groups"][1]["values"][0];
    assert_eq!(
        (&open["value"], &open["verdict"]),
        (&Value::Null, &"not_unique".into()),
        "{d:#}"
    );
    assert!(open["choice"].is_null(), "{open}");
    let d = analysis(
        "gear-train",
        &[&sum[..], &["--choose", "minimum-norm"]].concat(),
    );
    let chosen = &d["choices"][0]["groups"][1]["components"][0];
    // Both meshes are equal.
    assert_eq!(chosen["value"], 0.0);
    assert!(chosen["choice"].is_string());
}

/// No load turns the carriage, so the torques of the minimum-norm reactions are exactly zero,
/// without rounding errors.
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

/// An edge has no force along itself: the uniqueness of this zero component is not reported. An
/// instant at which it becomes zero is not a singular configuration.
#[test]
fn directions_without_any_force_are_no_findings() {
    let d = analysis("car", &["--along"]);
    for reaction in d["reactions"].as_array().expect("an array") {
        assert_eq!(reaction["unique_directions"], json!([]), "{reaction:#}");
    }
    assert_eq!(d["along"]["passages"], json!([]));
    // Perpendicular to the crank the force is not zero, and it is unique.
    let d = analysis("three-cranks", &[]);
    assert_eq!(
        d["reactions"][0]["unique_directions"][0]
            .as_array()
            .map(Vec::len),
        Some(2)
    );
}

/// Both cells of an inversor are aligned exactly at the start, not 5 microseconds later.
#[test]
fn an_instant_at_the_start_is_the_start() {
    let d = analysis("peaucellier", &["--along"]);
    assert_eq!(d["along"]["passages"], json!([]));
    let start = json!({ "time": 0.0, "name": "Q", "component": "Fy", "verdict": "unique" });
    assert_eq!(d["along"]["special"], json!([start]));
    contains(
        &words("peaucellier", &["--along"]),
        &["only at the instant t = 0 s: unique: Q.Fy"],
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

/// Returns the scene without the entries that a message recommends to omit.
fn without(scene: &str, message: &str) -> String {
    let (_, advice) = message.split_once("omit ").expect("an advice");
    let (advice, _) = advice.split_once(", so that ").expect("its end");
    let mut text = scene.to_owned();
    for item in advice.replace(" and ", ", ").split(", ") {
        let names: Vec<&str> = item.split('`').collect();
        text = match names.as_slice() {
            ["", entry, " in ", "keep", ""] => {
                let forms = ["\"*\", ", ", \"*\"", "\"*\""].map(|form| form.replace('*', entry));
                let form = forms.iter().find(|form| text.contains(*form));
                text.replace(form.expect("the entry"), "")
            }
            ["", key, " of body ", body, ""] => {
                let at = text
                    .find(&format!("[[body]]\nname = \"{body}\""))
                    .expect("the body");
                let (before, after) = text.split_at(at);
                let (own, rest) =
                    after.split_at(after[1..].find("[[").map_or(after.len(), |k| k + 1));
                let lines = own
                    .lines()
                    .filter(|line| !line.starts_with(&format!("{key} =")));
                format!("{before}{}\n{rest}", lines.collect::<Vec<_>>().join("\n"))
            }
            other => panic!("{other:?} in {message}"),
        };
    }
    text
}

/// The advice in messages is correct: without the entries that it recommends to omit, and with the
/// proposed correction, each separately, every command accepts the scene.
#[test]
fn the_advice_on_velocities_works() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/wrong");
    let read =
        |name: &str| std::fs::read_to_string(format!("{folder}/{name}.toml")).expect("a scene");
    let bar = |k: usize, [x, y]: [f64; 2], velocity: &str| {
        format!(
            "[[body]]\nname = \"bar {k}\"\nmass = 1.0\ninertia = 0.1\nposition = [{x:?}, {y:?}]\n{velocity}\n"
        )
    };
    let pin = |k: usize, [x, y]: [f64; 2], bodies: &str| {
        format!(
            "[[joint]]\nname = \"pin {k}\"\ntype = \"revolute\"\nbodies = [{bodies}]\nat = [{x:?}, {y:?}]\n"
        )
    };
    // A four-bar has velocities of all its bars, which contradict each other.
    let chain = format!(
        "[scene]\nname = \"chain\"\nspace = \"plane\"\n{}{}{}{}{}{}{}",
        bar(
            0,
            [0.5, 0.5],
            "velocity = [0.3, 0.1]\nangular_velocity = 0.7"
        ),
        bar(
            1,
            [1.5, 1.0],
            "velocity = [0.0, 0.2]\nangular_velocity = -0.4"
        ),
        bar(
            2,
            [2.5, 0.5],
            "velocity = [-0.1, 0.0]\nangular_velocity = 0.0"
        ),
        pin(0, [0.0, 0.0], "\"ground\", \"bar 0\""),
        pin(1, [1.0, 1.0], "\"bar 0\", \"bar 1\""),
        pin(2, [2.0, 1.0], "\"bar 1\", \"bar 2\""),
        pin(3, [3.0, 0.0], "\"bar 2\", \"ground\"")
    );
    let chain_kept = format!("{chain}\n[start]\nkeep = [\"bar 1.vy\", \"bar 1.omega\"]\n");
    for scene in [
        read("start-velocity-of-what-is-locked"),
        read("start-velocity-against-drive"),
        read("start-keep-against-pivot"),
        chain,
        chain_kept,
    ] {
        let output = with_scene(&["check", "-"], &scene);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        let mut mended = vec![without(&scene, &message)];
        if message.contains("allow_correction = true") {
            mended.push(format!("{scene}\n[start]\nallow_correction = true\n"));
        }
        for text in mended {
            let folder = Folder::new("velocity-advice");
            let out = folder.0.to_str().expect("UTF-8").to_owned();
            for command in [
                &["check", "-"][..],
                &["analyze", "-"],
                &["simulate", "-", "--t-end", "0.01", "--out", &out],
            ] {
                let output = with_scene(command, &text);
                assert_eq!(output.status.code(), Some(0), "{text}\n{}", stderr(&output));
            }
        }
    }
}

/// If a user types the word of another program for a command or option, our word is suggested.
#[test]
fn what_others_call_it_is_suggested() {
    for (words, expected) in [
        (&["run", "scene.toml"][..], "'simulate'"),
        (&["simulate", "scene.toml", "-o", "run"], "'--out'"),
        (&["simulate", "scene.toml", "--dt", "0.1"], "'--max-step'"),
    ] {
        let output = pfaff(words);
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        let said = stderr(&output);
        assert!(said.contains(expected), "{words:?}: {said}");
    }
    // If there is no such option, no option is suggested.
    let said = stderr(&pfaff(&["check", "scene.toml", "-o", "run"]));
    assert!(!said.contains("--out"), "{said}");
}
