//! SDF: the scene elements for each part of a file, digits, and axes that are nearly parallel.

use pfaff_import::{Axes, ImportedScene, Options};

use super::{first, import_text, imported, numbers, options_of, read, refused, text_of, value};

/// Number of bodies, and number of joints and couplings, counted by hand.
const FILES: [(&str, [usize; 2]); 9] = [
    ("sdf/four-bar.sdf", [3, 4]),
    ("sdf/tilted.sdf", [3, 4]),
    ("sdf/rounded.sdf", [3, 4]),
    // The base is fixed to the world.
    ("sdf/frames.sdf", [1, 1]),
    // The oblique joint has a body between its axes; f is fixed to e.
    ("sdf/many-types.sdf", [6, 6]),
    ("sdf/old.sdf", [1, 1]),
    ("sdf/follows.sdf", [2, 3]),
    ("sdf/bare.sdf", [1, 1]),
    // The wall is static, and the leaf has an inner model with one link.
    ("sdf/models.sdf", [3, 3]),
];

#[test]
fn every_file_is_a_scene() {
    for (file, counts) in FILES {
        let imported = imported(file);
        assert_eq!(
            (imported.format, imported.counts),
            ("SDF", counts),
            "{file}"
        );
        read(&imported);
    }
}

#[test]
fn loops_springs_and_limits() {
    let done = imported("sdf/four-bar.sdf");
    // Limits of 1e16 do not count as limits.
    assert!(done.omissions.is_empty(), "{:?}", done.omissions);
    let of = |key| value(&done.scene, "force", "A spring", key).expect("there");
    assert_eq!(
        (of("stiffness").as_str(), of("damping").as_str()),
        ("3.0", "0.1")
    );
    assert_eq!(of("free_angle"), "0.2");
    let many = imported("sdf/many-types.sdf");
    assert_eq!(many.omissions.len(), 1);
    assert_eq!(many.omissions[0].subject, "slide");
    assert_eq!(
        value(&many.scene, "joint", "thread", "pitch").as_deref(),
        Some("0.01")
    );
    assert_eq!(
        value(&many.scene, "joint", "cross", "type").as_deref(),
        Some("\"universal\"")
    );
    let last = value(&many.scene, "joint", "oblique second axis", "axis");
    assert_eq!(last.as_deref(), Some("[0.0, 0.6, 0.8]"));
}

/// The model is at z = 1 and rotated by 90° about z, so the x-axis of the model is the y-axis of
/// the ground.
#[test]
fn frames_are_relative_to_each_other() {
    let done = imported("sdf/frames.sdf");
    let at = numbers(&value(&done.scene, "body", "arm", "position").expect("there"));
    for (found, expected) in at.iter().zip([0.0, 0.9, 1.15]) {
        assert!((found - expected).abs() < 1e-15, "{at:?}");
    }
    let axis = numbers(&value(&done.scene, "joint", "elbow", "axis").expect("there"));
    assert!((axis[1] - 1.0).abs() < 1e-15, "{axis:?}");
    assert!(done.scene.contains("gravity = [0.0, 0.0, -1.62]"));
    assert_eq!(done.omissions[0].kind, "plugins");
    // Before version 1.5 an axis was written in the axes of the model.
    let old = imported("sdf/old.sdf");
    let axis = numbers(&value(&old.scene, "joint", "hinge", "axis").expect("there"));
    assert!((axis[0] - 1.0).abs() < 1e-15, "{axis:?}");
}

#[test]
fn joints_that_follow_others() {
    let done = imported("sdf/follows.sdf");
    assert_eq!(
        value(&done.scene, "joint", "b follows a", "ratio").as_deref(),
        Some("2.0")
    );
    // The expected angle is 2·(0 − 0.1) + 0.5 = 0.3 rad.
    let turned = value(&done.scene, "body", "b", "orientation").expect("turned");
    let q = numbers(turned.split_once("quaternion = ").expect("four").1);
    assert!((q[3] - 0.15_f64.sin()).abs() < 1e-15, "{turned}");
    let held = numbers(&value(&done.scene, "force", "held weight of b", "force").expect("held"));
    assert!((held[2] - 1.5 * 9.81).abs() < 1e-14);
}

#[test]
fn assumptions_of_the_format_are_told() {
    let done = imported("sdf/bare.sdf");
    assert!(
        done.remarks.iter().any(|r| r.contains("has no inertia")),
        "{:?}",
        done.remarks
    );
    assert!(done.remarks.iter().any(|r| r.contains("no gravity")));
    assert_eq!(done.omissions[0].kind, "contacts of links");
}

/// A parent frame names only a link, so a joint far from the frame is probably not intended.
#[test]
fn a_joint_far_from_its_parent_frame_is_told() {
    let text = |child: &str| {
        format!(
            "<sdf version='1.7'><model name='m'><link name='base'/><link name='arm'>{child}</link>\
             <frame name='end' attached_to='base'><pose>2 0 0 0 0 0</pose></frame>\
             <joint name='fix' type='fixed'><parent>world</parent><child>base</child></joint>\
             <joint name='hinge' type='revolute'><parent>end</parent><child>arm</child>\
             <axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"
        )
    };
    let told = |child: &str| {
        let remarks = import_text(&text(child), &Options::default()).remarks;
        remarks
            .iter()
            .any(|r| r.contains("`hinge` is 2 m away from its parent frame `end`"))
    };
    assert!(told(""));
    assert!(!told("<pose>2 0 0 0 0 0</pose>"));
}

fn with_axes(file: &str, axes: Axes) -> ImportedScene {
    let options = Options {
        axes,
        ..options_of(file)
    };
    pfaff_import::import(file, &text_of(file), &options).expect("imported")
}

#[test]
fn digits_give_the_tolerance() {
    // Lengths have four decimals, and angles have four decimals.
    let done = imported("sdf/rounded.sdf");
    assert!(
        done.scene
            .contains("\ntolerance = 5e-5\nangle_tolerance = 5e-5\n"),
        "{}",
        done.scene
    );
    // One decimal gives no information, and sixteen decimals are rounding.
    for file in ["sdf/four-bar.sdf", "sdf/old.sdf"] {
        assert!(!imported(file).scene.contains("\ntolerance ="), "{file}");
    }
}

#[test]
fn tilted_axes_are_told() {
    let told = |done: &ImportedScene, name: &str, off: &str, end: &str| {
        let found = done.remarks.iter().any(|r| {
            r.starts_with(&format!("The axis of `{name}` is tilted by {off}")) && r.ends_with(end)
        });
        assert!(found, "{name} {off} {end}: {:#?}", done.remarks);
    };
    let tilted = with_axes("sdf/tilted.sdf", Axes::Snapped);
    // A tilt of 0.1 rad is intended and is not changed.
    told(&tilted, "C", "0.1 rad", "`A`, `B`, `D` of its loop.");
    assert_eq!(
        tilted
            .remarks
            .iter()
            .filter(|r| r.contains("tilted"))
            .count(),
        1
    );
    let rounded = with_axes("sdf/rounded.sdf", Axes::Told);
    told(&rounded, "B", "3.7 µrad", "(--snap makes it parallel).");
    told(&rounded, "C", "0.8 mrad", "(--snap makes it parallel).");
    told(&rounded, "D", "0.8 mrad", "(--snap makes it parallel).");
    let snapped = with_axes("sdf/rounded.sdf", Axes::Snapped);
    told(&snapped, "D", "0.8 mrad", "it is made parallel.");
    assert_eq!(
        value(&snapped.scene, "joint", "D", "axis").as_deref(),
        Some("[0.0, 0.0, 1.0]")
    );
    read(&snapped);
}

#[test]
fn faults_have_codes_and_lines() {
    let model = |inner: &str| {
        format!(
            "<sdf version='1.6'><model name='m'><link name='a'/><link name='b'/>\n{inner}\n</model></sdf>"
        )
    };
    let joint = |kind: &str, inner: &str| {
        model(&format!(
            "<joint name='j' type='{kind}'><parent>a</parent><child>b</child>\n{inner}</joint>"
        ))
    };
    for (text, code, line) in [
        ("<sdf/>".to_owned(), "P0609", 1),
        ("<sdf><model/></sdf>".into(), "P0609", 1),
        (model("<link name='a'/>"), "P0607", 2),
        (model("<joint type='ball'/>"), "P0604", 2),
        (
            model("<joint name='j' type='ball'><parent>a</parent></joint>"),
            "P0604",
            2,
        ),
        (
            model("<joint name='j' type='ball'><parent>a</parent><child>c</child></joint>"),
            "P0606",
            2,
        ),
        (
            model("<joint name='j' type='ball'><parent>a</parent><child>a</child></joint>"),
            "P0609",
            2,
        ),
        (joint("gearbox", ""), "P0608", 2),
        (joint("hook", ""), "P0605", 2),
        (
            joint("revolute", "<axis><xyz>0 0 0</xyz></axis>"),
            "P0610",
            3,
        ),
        (joint("universal", ""), "P0604", 2),
        (joint("screw", ""), "P0604", 2),
        (model("<include/>"), "P0604", 2),
        (model("<model/>"), "P0604", 2),
        (model("<static>true</static>"), "P0609", 1),
        (
            model("<frame name='f'><pose relative_to='g'/></frame>"),
            "P0606",
            1,
        ),
        (
            model("<frame name='f'><pose relative_to='f'/></frame>"),
            "P0609",
            1,
        ),
        (
            model("<link name='c'><pose>0 0 0</pose></link>"),
            "P0605",
            2,
        ),
        (
            model("<link name='c'><inertial auto='true'/></link>"),
            "P0608",
            2,
        ),
        (
            model("<link name='c'><inertial><mass>-1</mass></inertial></link>"),
            "P0610",
            2,
        ),
    ] {
        let (found, at, message) = first(&refused(&text));
        assert_eq!((found.as_str(), at), (code, line), "{text}: {message}");
    }
}
