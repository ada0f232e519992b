//! Messages must name the correct cause, and their advice must be correct.

use super::{Folder, stderr, stdout, with_scene};

/// Joins all lines, because lines may be wrapped at any blank.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A four-bar with a crank of 0.6 m, a coupler of 0.7 m, a rocker of 0.5 m and a base of 1 m. The
/// crank rotates at 1 rad/s from this angle on.
fn four_bar(angle: f64) -> String {
    let b = [0.6 * angle.cos(), 0.6 * angle.sin()];
    // C is on the circles about B and D, above the line from B to D.
    let [dx, dy] = [1.0 - b[0], -b[1]];
    let d = dx.hypot(dy);
    let along = (0.49 - 0.25 + d * d) / (2.0 * d);
    let across = (0.49 - along * along).sqrt();
    let c = [
        b[0] + (along * dx - across * dy) / d,
        b[1] + (along * dy + across * dx) / d,
    ];
    let bar = |name: &str, from: [f64; 2], to: [f64; 2]| {
        let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        let angle = (to[1] - from[1]).atan2(to[0] - from[0]);
        format!(
            "{{ name = \"{name}\", mass = 1.0, inertia = 0.05, position = {middle:?}, angle = {angle:?} }},\n"
        )
    };
    format!(
        r#"
scene = {{ name = "toggle", space = "plane" }}
body = [
{}{}{}]
joint = [
    {{ name = "A", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] }},
    {{ name = "B", type = "revolute", bodies = ["crank", "coupler"], at = {b:?} }},
    {{ name = "C", type = "revolute", bodies = ["coupler", "rocker"], at = {c:?} }},
    {{ name = "D", type = "revolute", bodies = ["ground", "rocker"], at = [1.0, 0.0] }},
]
drive = [{{ name = "motor", joint = "A", type = "angle", motion = {{ type = "constant-rate", rate = 1.0 }} }}]
simulate = {{ t_end = 3.0 }}
"#,
        bar("crank", [0.0; 2], b),
        bar("coupler", b, c),
        bar("rocker", [1.0, 0.0], c),
    )
}

/// Coupler and rocker are in line at cos θ = (0.36 + 1 − 1.44)/1.2, which is 93.8°.
#[test]
fn a_drive_at_a_toggle_is_told_how_far_it_turns() {
    let farthest = (-0.08_f64 / 1.2).acos();
    let folder = Folder::new("toggle");
    for method in ["dop853", "tsit5", "radau5"] {
        let arguments = [
            "simulate",
            "-",
            "--method",
            method,
            "--force",
            "--out",
            folder.text(),
        ];
        let output = with_scene(&arguments, &four_bar(1.0));
        let said = flat(&stderr(&output));
        assert_eq!(output.status.code(), Some(1), "{said}");
        let cause = "P0428]: at t = 0.637512 s drive `motor` cannot turn `A` beyond 93.8°: there is no configuration";
        assert!(said.contains(cause), "{method}: {said}");
    }
    assert!(
        (farthest.to_degrees() - 93.8).abs() < 0.05 && (farthest - 1.0 - 0.637512).abs() < 1e-6
    );
    // The advice is correct: a run that ends earlier is complete.
    let arguments = [
        "simulate",
        "-",
        "--t-end",
        "0.63",
        "--force",
        "--out",
        folder.text(),
    ];
    let output = with_scene(&arguments, &four_bar(1.0));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

/// The advised tolerance assembles the leaf of `tests/wrong/start-misses-by-little.toml`.
#[test]
fn a_tolerance_that_is_advised_for_a_small_miss_does() {
    let scene = include_str!("../wrong/start-misses-by-little.toml");
    let refused = flat(&stderr(&with_scene(&["check", "-"], scene)));
    let advised = refused
        .split("`--tolerance ")
        .nth(1)
        .expect("it is advised");
    let advised = advised.split('`').next().expect("a number");
    let length: f64 = advised.parse().expect("a length");
    assert!((1e-4..=1e-2).contains(&length), "{refused}");
    let output = with_scene(&["check", "-", "--tolerance", advised], scene);
    let said = flat(&stdout(&output));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // Two pins on one body in the plane: one of four rows is redundant.
    assert!(
        said.contains("mobility 0") && refused.contains("redundancy 1 and mobility 0"),
        "{refused}"
    );
    // A large violation is an error for any accuracy of the data.
    let wrong = scene.replace("-0.5002", "-0.9");
    assert!(!stderr(&with_scene(&["check", "-"], &wrong)).contains("--tolerance"));
}

/// Two collinear bars between two pins: the search for an equilibrium ends there, and the lengths
/// are consistent.
#[test]
fn a_search_that_ends_at_a_singular_place_does_not_blame_the_parts() {
    let scene = r#"
scene = { name = "flat truss", space = "plane", gravity = [0.0, -9.81] }
body = [
    { name = "left", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] },
    { name = "right", mass = 1.0, inertia = 0.1, position = [1.5, 0.0] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "left"], at = [0.0, 0.0] },
    { name = "middle", type = "revolute", bodies = ["left", "right"], at = [1.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["ground", "right"], at = [2.0, 0.0] },
]
"#;
    let output = with_scene(&["equilibrium", "-"], scene);
    let said = flat(&stderr(&output));
    assert!(!said.contains("cannot be assembled:"), "{said}");
}
