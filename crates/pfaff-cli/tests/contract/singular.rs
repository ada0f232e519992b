//! Tests `pfaff analyze` at singular starts.

use super::analyze::{contains, document};
use super::{Folder, stderr, stdout, with_scene};

/// Cranks of length 0.5 at these pivots are all in one line, turn at 1 rad/s, and have one coupler.
pub(crate) fn flat_cranks(pivots: &[f64]) -> String {
    let bodies = pivots.iter().enumerate().map(|(k, x)| {
        let middle = x + 0.25;
        format!(
            r#"{{ name = "crank {k}", mass = 1.0, inertia = 0.1, position = [{middle}, 0.0], velocity = [0.0, 0.25], angular_velocity = 1.0 }},"#
        )
    });
    let joints = pivots.iter().enumerate().map(|(k, x)| {
        let tip = x + 0.5;
        format!(
            r#"{{ name = "pivot {k}", type = "revolute", bodies = ["ground", "crank {k}"], at = [{x}, 0.0] }},
               {{ name = "tip {k}", type = "revolute", bodies = ["crank {k}", "coupler"], at = [{tip}, 0.0] }},"#
        )
    });
    format!(
        r#"scene = {{ name = "flat", space = "plane" }}
        body = [ {} {{ name = "coupler", mass = 1.0, inertia = 0.1, position = [1.0, 0.0], velocity = [0.0, 0.5] }} ]
        joint = [ {} ]"#,
        bodies.collect::<String>(),
        joints.collect::<String>()
    )
}

/// Two horizontal cranks may continue in parallel or antiparallel; a third one excludes the latter
/// at second order.
#[test]
fn a_singular_start_says_how_the_motion_goes_on() {
    for (pivots, kind, piece) in [
        (
            &[0.0, 1.0][..],
            "bifurcation",
            "another branch is compatible",
        ),
        (
            &[0.0, 1.0, 1.7],
            "unique",
            "the motion stays unique (second order)",
        ),
    ] {
        let scene = flat_cranks(pivots);
        let text = stdout(&with_scene(&["analyze", "-"], &scene));
        contains(&text, &["SINGULAR", piece]);
        let d = document(&with_scene(&["analyze", "-", "--json"], &scene));
        assert_eq!(d["continuation"]["kind"], kind, "{d:#}");
        assert_eq!(d["evidence"]["permanent"], false);
    }
}

/// The horizontal cranks of the catalogue with a turning drive: the verdict at the start does not
/// require velocities with which the mechanism can leave the start.
#[test]
fn a_start_that_cannot_be_left_is_judged_and_warned_of() {
    let drive = r#"
        drive = [{ name = "motor", joint = "pivot 0", type = "angle", motion = { type = "constant-rate", rate = 1.0 } }]"#;
    let scene = flat_cranks(&[0.0, 1.0]) + drive;
    let still = scene
        .replace(
            "velocity = [0.0, 0.25], angular_velocity = 1.0",
            "angle = 0.0",
        )
        .replace(", velocity = [0.0, 0.5]", "");
    let output = with_scene(&["analyze", "-", "--json"], &still);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let d = document(&output);
    assert_eq!((&d["rank"], &d["redundancy"]), (&8.into(), &1.into()));
    let warning = d["warnings"][0].as_str().expect("a warning");
    assert!(
        warning.starts_with("no motion has these initial velocities"),
        "{warning}"
    );
    let output = with_scene(&["check", "-"], &still);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    contains(
        &stdout(&output),
        &["warning: no motion has these initial velocities"],
    );
    let output = with_scene(
        &["simulate", "-", "--t-end", "1", "--out", "unused"],
        &still,
    );
    assert_eq!(output.status.code(), Some(2), "{output:?}");
}

/// Two edges of one cart have normals or positions that differ by less than a rounding error: one
/// is redundant, and the cart moves as with equal edges.
#[test]
fn edges_that_differ_by_a_rounding_are_judged_and_named() {
    for (motion, point, normal) in [
        ("velocity = [1.0, 0.0]", "[0.0, -0.5]", "[1e-17, 1.0]"),
        ("velocity = [1.0, 0.0]", "[0.0, 0.5]", "[1e-17, 1.0]"),
        ("angular_velocity = 0.5", "[0.0, 0.5]", "[1e-17, 1.0]"),
        ("angular_velocity = 0.5", "[1e-17, -0.5]", "[0.0, 1.0]"),
    ] {
        let scene = format!(
            r#"scene = {{ name = "cart", space = "plane" }}
            body = [{{ name = "cart", mass = 10.0, inertia = 1.0, {motion} }}]
            joint = [
                {{ name = "left", type = "knife-edge", body = "cart", point = [0.0, 0.5], normal = [0.0, 1.0] }},
                {{ name = "right", type = "knife-edge", body = "cart", point = {point}, normal = {normal} }},
            ]"#
        );
        let output = with_scene(&["analyze", "-"], &scene);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        contains(
            &stdout(&output),
            &["rank at least 1 proved", "rounding", "left, right"],
        );
        let output = with_scene(&["check", "-"], &scene);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
}

/// A slider-crank is at its dead centre: no velocity of the slider determines the rate of the crank
/// there. A single drive cannot contradict another one.
#[test]
fn a_drive_at_a_dead_centre_is_told_that_the_configuration_is_singular() {
    let scene = |motion: &str| {
        format!(
            r#"scene = {{ name = "dead centre", space = "plane" }}
            body = [
                {{ name = "crank", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] }},
                {{ name = "rod", mass = 1.0, inertia = 0.1, position = [2.0, 0.0] }},
                {{ name = "slider", mass = 1.0, inertia = 0.1, position = [3.0, 0.0] }},
            ]
            joint = [
                {{ name = "A", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] }},
                {{ name = "B", type = "revolute", bodies = ["crank", "rod"], at = [1.0, 0.0] }},
                {{ name = "C", type = "revolute", bodies = ["rod", "slider"], at = [3.0, 0.0] }},
                {{ name = "D", type = "translational", bodies = ["ground", "slider"], at = [3.0, 0.0], axis = [1.0, 0.0] }},
            ]
            drive = [{{ name = "motor", joint = "D", type = "displacement", motion = {{ {motion} }} }}]
            simulate = {{ t_end = 1.0 }}"#
        )
    };
    let folder = Folder::new("dead-centre");
    let out = folder.0.to_str().expect("UTF-8");
    for (motion, code, reason) in [
        (
            r#"type = "constant-rate", rate = -1.0"#,
            2,
            "the mechanism is locked, or in a singular configuration",
        ),
        (
            r#"type = "polynomial", coefficients = [0.0, 0.0, -1.0]"#,
            2,
            "the mechanism is locked, or in a singular configuration",
        ),
        // The error is detected only after the slider has moved.
        (
            r#"type = "polynomial", coefficients = [0.0, 0.0, 0.0, -1.0]"#,
            1,
            "which is a singular configuration (its degree of redundancy is 1, elsewhere 0)",
        ),
    ] {
        let output = with_scene(&["simulate", "-", "--out", out], &scene(motion));
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert!(said.contains(reason), "{said}");
        assert!(!said.contains("drives"), "{said}");
    }
}
