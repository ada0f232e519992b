//! Tests tolerances in a file and in the description, and the positions of errors in them.

use model::{BuildError, Mechanism, Tolerance, ToleranceScope};

use crate::{BODIES, read, read_more};

/// Body a has a pin with a motor.
const DRIVEN: &str = r#"[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "a"]
at = [0.0, 0.0]
tolerance = 2e-5

[[joint]]
name = "B"
type = "revolute"
bodies = ["ground", "b"]
at = [0.0, 0.0]

[[drive]]
name = "D"
joint = "A"
type = "angle"
motion = 0.0

[[drive]]
name = "E"
joint = "B"
type = "angle"
motion = 0.0
"#;

fn with(head: &str, body: &str) -> String {
    let scene = BODIES.replacen("[scene]\n", &format!("[scene]\n{head}"), 1);
    scene.replacen("name = \"b\"\n", &format!("name = \"b\"\n{body}"), 1) + DRIVEN
}

#[test]
fn what_is_stated_is_read() {
    let text = with(
        "tolerance = 1e-4\nangle_tolerance = 1e-6\n",
        "tolerance = 1\n",
    );
    let d = read(&text)
        .expect("a scene")
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    let expected = Tolerance {
        length: Some(1e-4),
        angle: Some(1e-6),
    };
    assert_eq!(d.tolerance, expected);
    let bodies: Vec<_> = d.bodies.iter().map(|b| b.tolerance).collect();
    assert_eq!(bodies, [None, Some(1.0), None]);
    let joints: Vec<_> = d.joints.iter().map(|j| j.tolerance).collect();
    assert_eq!(joints, [Some(2e-5), None]);
    // A drive has the tolerance of its joint.
    let drives: Vec<_> = d.drives.iter().map(|x| x.tolerance).collect();
    assert_eq!(drives, joints);
    assert_eq!(
        Mechanism::build(&d).expect("a mechanism").tolerance(),
        expected
    );
}

#[test]
fn each_may_be_stated_alone() {
    assert_eq!(
        read_more("")
            .description
            .plane()
            .expect("a planar scene")
            .tolerance,
        Tolerance::default()
    );
    for (head, length, angle) in [
        ("tolerance = 1e-4\n", Some(1e-4), None),
        ("angle_tolerance = 1e-6\n", None, Some(1e-6)),
    ] {
        let found = read(&with(head, ""))
            .expect("a scene")
            .description
            .plane()
            .expect("a planar scene")
            .clone();
        assert_eq!(found.tolerance, Tolerance { length, angle }, "{head}");
    }
}

#[test]
fn every_wrong_one_has_its_place() {
    let text = with(
        "tolerance = 0\nangle_tolerance = -1.0\n",
        "tolerance = -2.0\n",
    )
    .replace("tolerance = 2e-5", "tolerance = -3.0");
    let problems = read(&text).expect_err("three faults");
    let told: Vec<String> = problems
        .iter()
        .map(|p| format!("{}: {}", &text[p.primary.span.clone()], p.message))
        .collect();
    // In each table, the first invalid tolerance is reported; for the drive of the joint, it is not
    // reported again.
    assert_eq!(
        told,
        [
            "0: the scene: tolerance is 0.0, need a finite number > 0 up to 1e60",
            "-2.0: body `b`: tolerance is -2.0, need a finite number > 0 up to 1e60",
            "-3.0: joint `A`: tolerance is -3.0, need a finite number > 0 up to 1e60",
        ]
    );
    let text = with("angle_tolerance = -1.0\n", "");
    let problems = read(&text).expect_err("one fault");
    assert_eq!(&text[problems[0].primary.span.clone()], "-1.0");
}

/// A program may change a scene after reading.
#[test]
fn a_tolerance_that_became_wrong_is_found_in_the_text() {
    let mut scene = read(&with("tolerance = 1e-4\n", "")).expect("a scene");
    scene
        .description
        .plane_mut()
        .expect("a planar scene")
        .drives[0]
        .tolerance = Some(f64::NAN);
    scene
        .description
        .plane_mut()
        .expect("a planar scene")
        .tolerance
        .length = Some(f64::INFINITY);
    let errors = Mechanism::build(&scene.description).err().expect("two");
    let marked = |error: &BuildError| {
        let d = scene.locate_build(error).expect("a place");
        scene.text().expect("it was read")[d.primary.span].to_owned()
    };
    assert_eq!(marked(&errors[0]), "1e-4");
    assert_eq!(marked(&errors[1]), "\"A\"");
    let of = ToleranceScope::Drive("D".into());
    assert!(
        matches!(&errors[1], BuildError::Tolerance { of: found, .. } if *found == of),
        "{errors:?}"
    );
}
