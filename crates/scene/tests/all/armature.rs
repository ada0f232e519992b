//! Tests the key `armature` of joints: values, units, errors with their positions, and inactive
//! joints.

use model::{AnyDescription, Armature, BodyRef};
use pfaff_scene::Diagnostic;

use crate::{BODIES, read, read_more};

/// A joint of this type between a and b, with more keys.
fn joint(kind: &str, more: &str) -> String {
    format!("[[joint]]\nname = \"X\"\ntype = \"{kind}\"\nbodies = [\"a\", \"b\"]\n{more}\n")
}

fn armatures(text: &str) -> Vec<Armature> {
    match read_more(text).description {
        AnyDescription::Plane(d) => d.armatures,
        AnyDescription::Space3(_) => panic!("a planar scene"),
    }
}

/// The coordinate and the inertia of each armature.
fn found(text: &str) -> Vec<(&'static str, f64)> {
    let all = armatures(text);
    for armature in &all {
        assert_eq!(armature.joint, "X");
        assert_eq!(armature.bodies, [BodyRef::Body(0), BodyRef::Body(1)]);
    }
    let of = |armature: &Armature| (armature.element.spec().common.scene_type, armature.inertia);
    all.iter().map(of).collect()
}

#[test]
fn each_coordinate_may_have_an_armature() {
    let pin = |value: &str| {
        found(&joint(
            "revolute",
            &format!("at = [0, 0]\narmature = {value}"),
        ))
    };
    assert_eq!(pin("0.25"), [("angle", 0.25)]);
    assert_eq!(pin("0"), [("angle", 0.0)]);
    let slide = joint("translational", "at = [0, 0]\naxis = [1, 0]\narmature = 3");
    assert_eq!(found(&slide), [("displacement", 3.0)]);
    let slot = |value: &str| {
        let more = format!("at = [0, 0]\naxis = [1, 0]\narmature = {value}");
        found(&joint("pin-in-slot", &more))
    };
    let both = [("displacement", 2.0), ("angle", 0.5)];
    assert_eq!(slot("{ angle = 0.5, displacement = 2.0 }"), both);
    assert_eq!(slot("{ angle = 0.5 }"), both[1..]);
    assert_eq!(found(&joint("revolute", "at = [0, 0]")), []);
}

/// With lengths in mm, a bare number of an angle is in kg·mm².
#[test]
fn bare_numbers_have_the_units_of_the_scene() {
    let in_mm = |kind: &str, more: &str| {
        let scene = BODIES.replacen(
            "[scene]\n",
            "[scene]\nformat = 2\nunits = { length = \"mm\" }\n",
            1,
        );
        let text = format!("{scene}{}", joint(kind, &format!("at = [0, 0]\n{more}")));
        match read(&text).expect("a scene").description {
            AnyDescription::Plane(d) => d.armatures[0].inertia,
            AnyDescription::Space3(_) => panic!("a planar scene"),
        }
    };
    let close = |found: f64, expected: f64| (found - expected).abs() < 1e-15;
    assert!(close(in_mm("revolute", "armature = 20000"), 0.02));
    assert!(close(in_mm("revolute", "armature = \"0.02 kg*m^2\""), 0.02));
    assert!(close(
        in_mm("translational", "axis = [1, 0]\narmature = 3"),
        3.0
    ));
}

fn errors(text: &str) -> Vec<Diagnostic> {
    read(&format!("{BODIES}{text}")).expect_err("an error")
}

#[test]
fn errors_have_positions_and_advice() {
    let of = |kind: &str, more: &str, words: &str| {
        let text = joint(kind, more);
        let all = errors(&text);
        let [error] = &all[..] else {
            panic!("one error: {all:?}");
        };
        let value = more.split("armature = ").nth(1).expect("a value");
        let at = BODIES.len() + text.find(value).expect("there");
        assert_eq!(error.primary.span, at..at + value.len(), "{error:?}");
        assert!(error.message.contains(words), "{error:?}");
        error.help.clone().unwrap_or_default()
    };
    let at = |value: &str| format!("at = [0, 0]\narmature = {value}");
    of(
        "revolute",
        &at("-1.5"),
        "`armature` is -1.5, need a number ≥ 0",
    );
    of("revolute", &at("nan"), "`armature` is NaN");
    of("revolute", &at("inf"), "`armature` is inf");
    of("revolute", &at("1e70"), "need a finite number up to");
    of("revolute", &at("\"heavy\""), "must be a number ≥ 0");
    let help = of(
        "revolute",
        &at("{ angle = 1 }"),
        "because the joint has one coordinate",
    );
    assert_eq!(help, "write `armature = …`");
    of(
        "fixed",
        &at("1.5"),
        "no joint coordinate that can have an armature",
    );
    let apart = "at = [[0, 0], [1, 0]]\narmature = 1.5";
    of(
        "distance",
        apart,
        "no joint coordinate that can have an armature",
    );
    let slot = "at = [0, 0]\naxis = [1, 0]\narmature = 1";
    let all = errors(&joint("pin-in-slot", slot));
    let help = all[0].help.clone().expect("advice");
    assert_eq!(
        help,
        "write `armature = { displacement = … }`; its joint coordinates are `displacement`, `angle`"
    );
    let slot = "at = [0, 0]\naxis = [1, 0]\narmature = { lenght = 1 }";
    let all = errors(&joint("pin-in-slot", slot));
    assert!(all[0].message.contains("no key `lenght`"), "{all:?}");
}

#[test]
fn an_inactive_joint_has_no_armature() {
    let text = joint("revolute", "at = [0, 0]\narmature = 1\nactive = false");
    assert_eq!(found(&text), []);
}
