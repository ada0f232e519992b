//! URDF: the scene elements for each part of a file, loops, and poses at which they are closed.

use pfaff_import::{Base, ImportedScene, Options, Refusal};

use super::{first, import_text, imported, numbers, options_of, read, refused, text_of, value};

/// Number of bodies, and number of joints and couplings, counted by hand. The root is fixed to the
/// ground and merged, and links that fixed joints connect are also merged.
const FILES: [(&str, [usize; 2]); 8] = [
    ("urdf/arm.urdf", [2, 2]),
    ("urdf/gripper.urdf", [3, 5]),
    ("urdf/four-bar.urdf", [3, 4]),
    ("urdf/triangle.urdf", [2, 2]),
    ("urdf/parallelogram.urdf", [4, 4]),
    ("urdf/universal.urdf", [3, 3]),
    ("urdf/floating.urdf", [2, 1]),
    ("urdf/chain.urdf", [1, 1]),
];

#[test]
fn every_file_is_a_scene() {
    for (file, counts) in FILES {
        let imported = imported(file);
        assert_eq!(
            (imported.format, imported.counts),
            ("URDF", counts),
            "{file}"
        );
        read(&imported);
    }
}

fn with_loops(name: &str, pose: &[(&str, f64)]) -> Result<ImportedScene, Box<Refusal>> {
    let file = format!("urdf/{name}.urdf");
    let yaml = format!("urdf/{name}.yaml");
    let options = Options {
        loops: Some((yaml.clone(), text_of(&yaml))),
        pose: pose
            .iter()
            .map(|(name, q)| ((*name).to_owned(), *q))
            .collect(),
        ..options_of(&file)
    };
    pfaff_import::import(&file, &text_of(&file), &options)
}

#[test]
fn what_is_left_out_is_told() {
    let imported = imported("urdf/arm.urdf");
    let told: Vec<(&str, &str)> = imported
        .omissions
        .iter()
        .map(|o| (o.kind, o.subject.as_str()))
        .collect();
    let expected = [
        ("contacts of links", "upper"),
        ("limits of joints", "shoulder"),
        (
            "friction of joints: accelerations differ while the joints move",
            "shoulder",
        ),
        ("actuators", "drive of the shoulder"),
    ];
    assert_eq!(told, expected);
    assert_eq!(
        value(&imported.scene, "force", "shoulder spring", "damping").as_deref(),
        Some("0.3")
    );
}

#[test]
fn the_base_is_fixed_or_free() {
    let file = "urdf/arm.urdf";
    let options = Options {
        base: Base::Free,
        ..options_of(file)
    };
    let free = pfaff_import::import(file, &text_of(file), &options).expect("imported");
    assert_eq!(free.counts, [3, 2]);
    assert!(free.remarks.iter().any(|r| r.contains("`base` is free")));
    assert!(
        imported(file)
            .remarks
            .iter()
            .any(|r| r.contains("--base free"))
    );
}

#[test]
fn joints_that_follow_others() {
    let imported = imported("urdf/gripper.urdf");
    let of = |name, key| value(&imported.scene, "joint", name, key).expect("there");
    assert_eq!(of("thumb follows left", "ratio"), "-20.0");
    assert_eq!(
        of("thumb follows left", "measures"),
        "[\"left.displacement\", \"thumb.angle\"]"
    );
    // The offset moves the right finger by 0.01 m along −y, because the finger is rotated by π.
    let at = numbers(&value(&imported.scene, "body", "right", "position").expect("there"));
    assert!((at[1] + 0.06).abs() < 1e-15, "{at:?}");
}

#[test]
fn loops_in_gazebo_are_closed() {
    let imported = imported("urdf/four-bar.urdf");
    let of = |key| value(&imported.scene, "joint", "C", key).expect("there");
    assert_eq!(of("bodies"), "[\"coupler\", \"rocker\"]");
    let points = of("points");
    // C is at (1.5, 1.1), and the coupler begins at (0.3, 0.8).
    let coupler = numbers(points.split("\"rocker\"").next().expect("first"));
    assert!(
        (coupler[0] - 1.2).abs() < 1e-15 && (coupler[1] - 0.3).abs() < 1e-15,
        "{points}"
    );
}

/// A triangle with sides 3, 4 and 5 has a right angle, at the corner (1.8, ±2.4).
#[test]
fn loops_are_closed_from_a_guess() {
    let angle = |imported: &ImportedScene, body| {
        let turned = value(&imported.scene, "body", body, "orientation").expect("turned");
        let (_, q) = turned.split_once("quaternion = ").expect("a quaternion");
        let q = numbers(q);
        2.0 * q[3].atan2(q[0])
    };
    let turn = 0.6_f64.acos();
    // If all coordinates are zero, the sides are in one line, and the first search fails from this
    // pose.
    for (pose, sign) in [
        (vec![], None),
        (vec![("A", 0.5)], Some(1.0)),
        (vec![("A", -0.5), ("B", 0.1)], Some(-1.0)),
    ] {
        let found = with_loops("triangle", &pose).unwrap_or_else(|e| panic!("{:?}", e.diagnostics));
        read(&found);
        let three = angle(&found, "three");
        let sign = sign.unwrap_or(three.signum());
        assert!((three - sign * turn).abs() < 1e-10, "{pose:?}: {three}");
        let four = angle(&found, "four");
        assert!(
            (four + sign * 0.8_f64.acos()).abs() < 1e-10,
            "{pose:?}: {four}"
        );
        assert!(found.remarks.iter().any(|r| r.contains("loops are closed")));
    }
    // A pose that is assembled is not changed.
    let flat = with_loops("parallelogram", &[]).expect("imported");
    assert!(!flat.remarks.iter().any(|r| r.contains("loops are closed")));
    read(&flat);
}

#[test]
fn loops_that_cannot_close_are_refused() {
    // The side is 8 m instead of 5 m: 3 + 4 < 8.
    let text = text_of("urdf/triangle.urdf").replace("\"5 0 0\"", "\"8 0 0\"");
    let options = Options {
        loops: Some(("loops.yaml".into(), text_of("urdf/triangle.yaml"))),
        ..Options::default()
    };
    let refusal = pfaff_import::import("far.urdf", &text, &options).expect_err("refused");
    let (code, _, message) = first(&refusal);
    assert_eq!(code, "P0613");
    assert!(
        message.contains("`tip of three to tip of four`"),
        "{message}"
    );
    // Sides 3 and 4 have a total length of 7. With a third side of 7.0003 the gap is 4e-5 of the
    // size, which may be a rounding error. With 7.01 the gap is 1e-3.
    let far = |base: &str| {
        let text = text_of("urdf/triangle.urdf").replace("\"5 0 0\"", &format!("\"{base} 0 0\""));
        pfaff_import::import("far.urdf", &text, &options)
    };
    let rounded = far("7.0003").expect("imported");
    let told = rounded
        .remarks
        .iter()
        .any(|r| r.contains("The best pose leaves"));
    assert!(told, "{:?}", rounded.remarks);
    assert_eq!(first(&far("7.01").expect_err("refused")).0, "P0613");
    let (code, _, message) = first(&with_loops("triangle", &[("Q", 1.0)]).expect_err("refused"));
    assert_eq!(code, "P0606", "{message}");
}

#[test]
fn joints_of_a_yaml() {
    let imported = with_loops("universal", &[]).expect("imported");
    let of = |name, key| value(&imported.scene, "joint", name, key).expect("there");
    assert_eq!(of("hook", "type"), "\"universal\"");
    assert_eq!(of("socket", "type"), "\"spherical\"");
    // The second axis is the y-axis of the joint: rpy (0.1, 0.2, 0.3) in the first link.
    let cross = numbers(&of("hook", "cross"));
    let (r, p, y) = (0.1_f64, 0.2_f64, 0.3_f64);
    let expected = [
        y.cos() * p.sin() * r.sin() - y.sin() * r.cos(),
        y.sin() * p.sin() * r.sin() + y.cos() * r.cos(),
        p.cos() * r.sin(),
    ];
    for k in 0..3 {
        assert!(
            (cross[k] - expected[k]).abs() < 1e-15,
            "{cross:?} {expected:?}"
        );
    }
}

#[test]
fn faults_of_a_yaml_have_places() {
    let file = "urdf/triangle.urdf";
    for (yaml, line) in [
        ("closed_loop: [[a, b]]\ntype: [3d]\n", 1),
        (
            "closed_loop: [['tip of three', 'tip of four']]\ntype: [4d]\n",
            2,
        ),
        (
            "closed_loop: [['tip of three', 'tip of four']]\ntype: []\n",
            1,
        ),
        ("# x\nclosed_loop: [['tip of three'", 2),
        ("closed_loop:\n [[[[[[[[[a]]]]]]]]]\ntype: [3d]\n", 2),
        ("closed_loop: 5\n", 1),
        ("joint_name: [A]\njoint_type: [HINGE]\n", 2),
        ("joint_name: [Z]\njoint_type: [SPHERICAL]\n", 1),
        ("nonsense\n", 1),
    ] {
        let options = Options {
            loops: Some(("l.yaml".into(), yaml.into())),
            ..options_of(file)
        };
        let refusal = pfaff_import::import(file, &text_of(file), &options).expect_err("refused");
        let (code, at, message) = first(&refusal);
        assert_eq!(
            (code.as_str(), at, refusal.file.as_str()),
            ("P0612", line, "l.yaml"),
            "{yaml}: {message}"
        );
    }
    let options = Options {
        loops: Some(("l.yaml".into(), String::new())),
        ..Options::default()
    };
    let refusal = pfaff_import::import(
        "m.xml",
        "<mujoco><worldbody><body/></worldbody></mujoco>",
        &options,
    );
    assert_eq!(first(&refusal.expect_err("refused")).0, "P0612");
}

#[test]
fn faults_have_codes_and_lines() {
    let link = "<link name='a'/><link name='b'/>";
    let joint = |inner: &str| {
        format!("<robot>{link}\n<joint name='j' type='revolute'>\n{inner}</joint></robot>")
    };
    let ends = "<parent link='a'/><child link='b'/>";
    for (text, code, line) in [
        ("<robot/>".to_owned(), "P0609", 1),
        (format!("<robot>{link}</robot>"), "P0609", 1),
        ("<robot><link name='a'/></robot>".into(), "P0609", 1),
        ("<robot>\n<link/></robot>".into(), "P0604", 2),
        (
            "<robot><link name='a'/>\n<link name='a'/></robot>".into(),
            "P0607",
            2,
        ),
        (joint("<parent link='a'/>"), "P0604", 2),
        (joint("<parent link='a'/><child link='c'/>"), "P0606", 3),
        (joint(&format!("{ends}<axis xyz='0 0 0'/>")), "P0610", 3),
        (joint(&format!("{ends}<origin xyz='0 0'/>")), "P0605", 3),
        (
            joint(&format!("{ends}<dynamics damping='-1'/>")),
            "P0610",
            3,
        ),
        (joint(&format!("{ends}<mimic joint='j'/>")), "P0609", 3),
        (joint(&format!("{ends}<mimic joint='k'/>")), "P0606", 3),
        (joint(ends).replace("revolute", "bolt"), "P0605", 2),
        (joint("<parent link='a'/><child link='a'/>"), "P0609", 2),
        (
            "<robot>\n<link name='a'><inertial><mass value='1'/></inertial></link></robot>".into(),
            "P0604",
            2,
        ),
    ] {
        let (found, at, message) = first(&refused(&text));
        assert_eq!((found.as_str(), at), (code, line), "{text}: {message}");
    }
}

/// A closure that fails by a rounded digit is covered by the tolerance of the scene.
#[test]
fn loops_that_nearly_close_have_a_tolerance() {
    let options = Options {
        loops: Some(("loops.yaml".into(), text_of("urdf/triangle.yaml"))),
        ..Options::default()
    };
    let far = |base: &str| {
        let text = text_of("urdf/triangle.urdf").replace("\"5 0 0\"", &format!("\"{base} 0 0\""));
        let done = pfaff_import::import("far.urdf", &text, &options).expect("imported");
        let of = |key: &str| -> Option<f64> {
            let line = done.scene.lines().find_map(|line| line.strip_prefix(key));
            line.map(|value| value.parse().expect("a number"))
        };
        (of("tolerance = "), of("angle_tolerance = "))
    };
    assert_eq!(far("6"), (None, None));
    // The bars of 3 m and 4 m are stretched; the gap of 0.3 mm or 3 mm is left.
    for (base, gap) in [("7.0003", 3e-4), ("7.003", 3e-3)] {
        let (length, angle) = far(base);
        let length = length.expect("a tolerance");
        assert!(
            (2.9 * gap..=6.0 * gap).contains(&length),
            "{base}: {length}"
        );
        assert!(angle.is_some_and(|angle| angle < length), "{angle:?}");
        let digits = format!("{length:e}");
        assert_eq!(digits.split('e').next().map(str::len), Some(1), "{digits}");
    }
}

/// The joint does not move, so there is nothing to follow.
#[test]
fn a_fixed_joint_that_follows_another_one_is_a_note() {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' \
             ixy='0' ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let text = format!(
        "<robot name='m'><link name='base'/>{}{}<joint name='A' type='continuous'>\
         <parent link='base'/><child link='a'/></joint><joint name='B' type='fixed'>\
         <parent link='a'/><child link='b'/><mimic joint='A'/></joint></robot>",
        link("a"),
        link("b"),
    );
    let done = import_text(&text, &Options::default());
    assert_eq!(done.counts, [1, 1]);
    let note = "Joint `B` is fixed, so it does not follow `A`.";
    assert!(
        done.remarks.iter().any(|remark| remark == note),
        "{:?}",
        done.remarks
    );
}
