//! Tests `pfaff tolerance`: texts, documents, files, seeds and threads.

use serde_json::Value;

use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

const CRANKS: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../examples/three-cranks.toml"
);
const SLIDER: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../examples/slider-crank.toml"
);

fn said(arguments: &[&str]) -> String {
    let output = pfaff(&[&["tolerance"], arguments].concat());
    assert_eq!(
        (output.status.code(), &*stderr(&output)),
        (Some(0), ""),
        "{arguments:?}"
    );
    stdout(&output)
}

/// Joins all lines, because lines may be wrapped at any blank.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_pin_that_is_off_has_a_range_in_a_sentence() {
    let set = "joint.pivot-3.at[0]=0.5004";
    let text = flat(&said(&[CRANKS, "--set", set, "--tolerance", "1e-6"]));
    for words in [
        "uniform errors within ± 1 µm",
        "as described: rank 12 of 12 rows, redundancy 0, mobility 0",
        "the rank without tolerance is the same in all samples",
        "unique, FRAGILE |F| ",
        "within ± 1 µm `pivot-2` carries ",
        "(88.21 kN as described)",
        "largest displacement: body bar, up to ",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    // Near the tolerance at which the rank changes, both interpretations are reported.
    let text = flat(&said(&[CRANKS, "--set", set, "--tolerance", "1e-4"]));
    for words in [
        "as described the rank is undecided: with data accurate to 1.0e-4 m the rank is 11 or 12",
        "samples are assembled with rank 11",
        "`pivot-2` is undecided; rigid and without play, data within ± 0.1 mm alone would decide it",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

#[test]
fn files_are_the_same_for_a_seed_on_any_number_of_threads() {
    let folder = Folder::new("tolerance-samples");
    let made = |name: &str, more: &[&str]| {
        let out = folder.0.join(name);
        let out = out.to_str().expect("UTF-8");
        let arguments = [SLIDER, "--tolerance", "1e-4", "--runs", "60", "--out", out];
        let text = said(&[&arguments, more].concat());
        assert!(
            ["tolerance.csv", "tolerance.json", "tolerance.html"]
                .iter()
                .all(|name| text.contains(name))
        );
        let file = |file: &str| folder.read(&format!("{name}/{file}"));
        [
            file("tolerance.csv"),
            file("tolerance.json"),
            file("tolerance.html"),
        ]
    };
    let one = made("one", &["--threads", "1"]);
    let two = made("two", &["--threads", "2"]);
    let other = made("other", &["--seed", "2"]);
    assert_eq!(one[..2], two[..2]);
    assert_ne!(one[0], other[0]);
    // The table has one row for each sample, and each row has as many cells as columns.
    let lines: Vec<&str> = one[0].lines().collect();
    assert_eq!(lines.len(), 61);
    let head: Vec<&str> = lines[0].split(',').collect();
    assert_eq!(
        head[..5],
        ["sample", "status", "rank", "redundancy", "mobility"]
    );
    for name in [
        "shaft.verdict",
        "shaft.F",
        "motor.drive",
        "crown.x",
        "travel",
    ] {
        assert!(head.contains(&name), "{name}: {head:?}");
    }
    assert!(
        lines
            .iter()
            .all(|line| line.split(',').count() == head.len())
    );
    assert!(lines[1].starts_with("1,done,9,0,0,unique,"), "{}", lines[1]);
    // The document contains the values of the table.
    let d: Value = serde_json::from_str(&one[1]).expect("JSON");
    assert_eq!(
        (&d["format"], &d["samples"], &d["assembled"]),
        (&2.into(), &60.into(), &60.into())
    );
    let column = head
        .iter()
        .position(|name| *name == "travel")
        .expect("it is there");
    let values = lines[1..]
        .iter()
        .filter_map(|line| line.split(',').nth(column));
    let values: Vec<f64> = values.filter_map(|cell| cell.parse().ok()).collect();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(
        d["measures"]["travel"]["range"]["least"].as_f64(),
        Some(least)
    );
    // The page loads no external resource and has no scripts.
    let page = &one[2];
    assert!(page.contains("default-src 'none'") && page.contains("<svg"));
    for word in ["<script", "http:", "https:", "src="] {
        let found = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!found.contains(word), "{word}");
    }
    // A second call replaces its own files.
    assert_eq!(made("one", &["--threads", "1"])[0], one[0]);
}

#[test]
fn a_robot_keeps_its_unique_reactions_and_gets_no_others() {
    let d: Value = serde_json::from_str(&said(&[
        ROBOT,
        "--tolerance",
        "1e-4",
        "--runs",
        "50",
        "--json",
    ]))
    .expect("one document");
    assert_eq!(d["described"]["rank"], 20);
    assert_eq!((&d["samples"], &d["partial"]), (&50.into(), &false.into()));
    for reaction in d["reactions"].as_array().expect("a list") {
        let name = reaction["name"].as_str().expect("a name");
        let is_unique = !["B", "C", "W1", "W2", "W3", "W4"].contains(&name);
        let expected = if is_unique { "unique" } else { "not_unique" };
        assert_eq!(reaction["verdict"], expected, "{name}");
        let reading = &reaction["values"][0]["reading"];
        if is_unique {
            // With slightly misaligned wheels, some reactions depend on how the wheels share loads.
            let reason = reaction["values"][0]["reason"].as_str().unwrap_or_default();
            assert!(
                reading == "kept_rows" || reason.contains("share loads"),
                "{name}"
            );
        } else {
            assert_ne!(reading, "kept_rows", "{name}");
        }
    }
    let relative: Vec<f64> = (d["reactions"].as_array().expect("a list").iter())
        .filter_map(|r| r["relative"].as_f64())
        .collect();
    assert!(relative.is_sorted_by(|a, b| a >= b), "{relative:?}");
}

#[test]
fn nothing_that_varies_is_refused_with_what_to_write() {
    let output = pfaff(&["tolerance", CRANKS]);
    assert_eq!(output.status.code(), Some(2));
    let text = stderr(&output);
    assert!(
        text.contains("P0510") && text.contains("--tolerance 1e-4"),
        "{text}"
    );
    let output = pfaff(&[
        "tolerance",
        CRANKS,
        "--tolerance",
        "1e-4",
        "--runs",
        "100001",
    ]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("need 1 to 100000"));
}

/// A boom on a pin is supported by two equal parallel cylinders. Their load sharing depends on the
/// choice, and so does the lateral force of a slightly misaligned cylinder. The arm beyond them is
/// not affected.
#[test]
fn ranges_of_a_choice_are_not_given() {
    let scene = r#"
scene = { name = "boom", space = "spatial", gravity = [0.0, -9.81, 0.0] }
body = [
    { name = "boom", mass = 1000.0, inertia = [100.0, 900.0, 900.0], position = [1.0, 1.0, 0.0] },
    { name = "arm", mass = 500.0, inertia = [50.0, 300.0, 300.0], position = [3.0, 2.0, 0.0] },
]
joint = [
    { name = "pin", type = "revolute", bodies = ["ground", "boom"], at = [0.0, 0.0, 0.0], axis = [0, 0, 1] },
    { name = "elbow", type = "fixed", bodies = ["boom", "arm"], at = [2.0, 2.0, 0.0] },
    { name = "left", type = "distance", bodies = ["ground", "boom"], at = [[1.0, -0.5, 0.4], [1.5, 1.0, 0.4]] },
    { name = "right", type = "distance", bodies = ["ground", "boom"], at = [[1.0, -0.5, -0.4], [1.5, 1.0, -0.4]] },
]
"#;
    let arguments = ["tolerance", "-", "--tolerance", "1e-3", "--runs", "40"];
    let output = with_scene(&[&arguments[..], &["--json"]].concat(), scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let d: Value = serde_json::from_str(&stdout(&output)).expect("one document");
    let value = |reaction: &str, name: &str| {
        let all = d["reactions"].as_array().expect("a list").iter();
        let mut of_joint = all.filter(|r| r["name"] == reaction);
        let values = &of_joint.next().expect("the joint")["values"];
        let mut own = values
            .as_array()
            .expect("a list")
            .iter()
            .filter(|v| v["name"] == name);
        own.next().unwrap_or_else(|| panic!("{values:#}")).clone()
    };
    // By symmetry no cylinder has a larger share, along any axis.
    for component in ["|F|", "Fx", "Fy", "Fz"] {
        for cylinder in ["left", "right"] {
            let found = value(cylinder, component);
            assert_eq!(
                found["range"],
                Value::Null,
                "{cylinder} {component}: {found:#}"
            );
            assert_eq!(
                found["verdict"], "not_unique",
                "{cylinder} {component}: {found:#}"
            );
        }
    }
    // With the data given in the scene, no force acts along z; with a misalignment, a cylinder
    // takes a share of such a force.
    assert_eq!(value("left", "Fz")["unique"], true);
    let reason = &value("left", "Fz")["reason"];
    assert!(
        reason.as_str().is_some_and(|r| r.contains("share loads")),
        "{reason}"
    );
    // The reaction carries the weight of the arm: the elbow only rotates with the pose.
    let weight = value("elbow", "Fy");
    assert_eq!(weight["verdict"], "unique");
    let [least, greatest] =
        ["least", "greatest"].map(|end| weight["range"][end].as_f64().expect("a number"));
    assert!(
        least <= greatest && (least.abs() - 4905.0).abs() < 5.0 && (greatest - least) < 5.0,
        "{weight:#}"
    );
    let text = flat(&stdout(&with_scene(&arguments, scene)));
    assert!(
        text.contains("no range, because not unique in any sample: `left`, `right`"),
        "{text}"
    );
}
