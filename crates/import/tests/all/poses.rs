//! Requested poses, axes that are made parallel before loops are closed, keyframes, and the names
//! of coordinates.

use pfaff_import::{Axes, Options};

use super::{about_y, body, first, import_text as import, options_of, pose, read, text_of, value};

/// A parallelogram with sides 1 and 0.5 closes at every angle; a joint outside the loop follows its
/// crank.
fn follower() -> (String, Options) {
    let text = text_of("urdf/parallelogram.urdf").replace(
        "</robot>",
        "<link name='hand'><inertial><mass value='1'/>\
         <inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
         <joint name='F' type='continuous'><parent link='frame'/><child link='hand'/>\
         <axis xyz='0 1 0'/><mimic joint='A' multiplier='-2'/></joint></robot>",
    );
    let yaml = "urdf/parallelogram.yaml";
    let loops = Some((yaml.to_owned(), text_of(yaml)));
    let options = Options {
        loops,
        ..Options::default()
    };
    (text, options)
}

/// The requested values of a pose are used if the loops can be closed with them, and dependent
/// joints follow.
#[test]
fn values_of_a_pose_are_held() {
    let (text, options) = follower();
    for values in [
        vec![("A", 0.4)],
        vec![("A", 0.4), ("B", 0.4), ("C", -0.4)],
        vec![("F", -0.8)],
    ] {
        let options = Options {
            pose: pose(&values),
            ..options.clone()
        };
        let done = import(&text, &options);
        assert!(
            (about_y(&done.scene, "left") - 0.4).abs() < 1e-12,
            "{values:?}"
        );
        assert!(
            (about_y(&done.scene, "hand") + 0.8).abs() < 1e-12,
            "{values:?}"
        );
        assert!(
            !done.remarks.iter().any(|r| r.contains("requested")),
            "{:?}",
            done.remarks
        );
        read(&done);
    }
}

/// A triangle with sides 3, 4 and 5 closes only at acos(0.6).
#[test]
fn values_that_cannot_be_held_are_told() {
    let file = "urdf/triangle.urdf";
    let at = |angle: f64| {
        let options = Options {
            loops: Some(("l.yaml".into(), text_of("urdf/triangle.yaml"))),
            pose: pose(&[("A", angle)]),
            ..options_of(file)
        };
        import(&text_of(file), &options).remarks
    };
    let moved = "`A`: requested 0.5 rad, found 0.9273 rad";
    let remarks = at(0.5);
    assert!(remarks.iter().any(|r| r.contains(moved)), "{remarks:?}");
    let exact = at(0.6_f64.acos());
    assert!(!exact.iter().any(|r| r.contains("asked")), "{exact:?}");
    // The angle 40° is 0.69813 rad.
    let degrees = at(40.0);
    let words = ["40° are 0.69813 rad", "requested 40 rad"];
    for words in words {
        assert!(degrees.iter().any(|r| r.contains(words)), "{degrees:?}");
    }
}

/// A parallelogram whose crank axis is rotated by 1.57 rad instead of π/2 does not close. After the
/// axes are made parallel, the loop closes.
#[test]
fn axes_are_snapped_before_loops_are_closed() {
    let inertial = "<inertial><origin xyz='0.1 0 0'/><mass value='1'/>\
        <inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial>";
    let hinge = |name, parent, child, origin, axis| {
        format!(
            "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/>\
             <origin {origin}/><axis xyz='{axis}'/></joint>"
        )
    };
    let fixed = |link, parent, x| {
        format!(
            "<link name='{link}'/><joint name='to {link}' type='fixed'><parent link='{parent}'/>\
             <child link='{link}'/><origin xyz='{x} 0 0'/></joint>"
        )
    };
    let links: String = ["crank", "coupler", "rocker"]
        .map(|name| format!("<link name='{name}'>{inertial}</link>"))
        .concat();
    let text = [
        "<robot name='four-bar'><link name='frame'/>",
        &links,
        &hinge("A", "frame", "crank", "rpy='1.57 0 0'", "0 0 1"),
        &hinge("B", "crank", "coupler", "xyz='0.2 0 0'", "0 0 1"),
        &hinge("D", "frame", "rocker", "xyz='0.3 0 0'", "0 -1 0"),
        &fixed("end of coupler", "coupler", 0.3),
        &fixed("end of rocker", "rocker", 0.25),
        "</robot>",
    ]
    .concat();
    let yaml = "closed_loop: [[end of coupler, end of rocker]]\ntype: [3d]\n";
    let options = |axes| Options {
        loops: Some(("l.yaml".into(), yaml.into())),
        pose: pose(&[("A", -1.0), ("B", 1.0)]),
        axes,
        ..Options::default()
    };
    let done = import(&text, &options(Axes::Snapped));
    let words = "The axis of `D` is tilted by 0.8 mrad against `A`, `B` of its loop; it is made";
    assert!(
        done.remarks.iter().any(|r| r.starts_with(words)),
        "{:?}",
        done.remarks
    );
    read(&done);
    assert!(
        !done.scene.contains("\nangle_tolerance = "),
        "{}",
        done.scene
    );
    // Otherwise the scene has a tolerance that covers the gap near the requested pose.
    let told = import(&text, &options(Axes::Told));
    let has = |words: &str| told.remarks.iter().any(|r| r.contains(words));
    assert!(
        has("found from the guess") && has("do not close exactly"),
        "{:?}",
        told.remarks
    );
    assert!(
        has("`D` is tilted by 0.8 mrad") && has("--snap"),
        "{:?}",
        told.remarks
    );
    assert!(
        told.scene.contains("\nangle_tolerance = 0.00"),
        "{}",
        told.scene
    );
    read(&told);
    // A tilt of 9 mrad is not a rounded digit.
    let tilted = text.replace("1.57 0 0", "1.58 0 0");
    let refusal = pfaff_import::import("file.urdf", &tilted, &options(Axes::Told));
    let refusal = refusal.expect_err("refused");
    assert_eq!(first(&refusal).0, "P0613");
    let help = refusal.diagnostics[0].help.as_deref().unwrap_or_default();
    assert!(help.contains("--pose"), "{help}");
}

/// The end of a rod of 1 m moves by 2·sin(0.1) m for a rotation of 0.2 rad.
#[test]
fn a_keyframe_that_opens_a_loop_is_told() {
    let text = "<mujoco><compiler angle='radian'/><worldbody>\n\
        <body name='a'><joint name='j' axis='0 1 0'/><geom size='0.1'/>\
        <site name='tip' pos='1 0 0'/></body><site name='nail' pos='1 0 0'/>\n\
        </worldbody><equality><connect name='pin' site1='tip' site2='nail'/></equality>\n\
        <keyframe><key name='shut' qpos='0'/>\n<key name='open' qpos='0.2'/></keyframe></mujoco>";
    let at = |keyframe: &str| {
        let options = Options {
            keyframe: Some(keyframe.to_owned()),
            ..Options::default()
        };
        import(text, &options).remarks
    };
    assert!(!at("shut").iter().any(|r| r.contains("open")));
    let words = format!(
        "`open` (line 5) leaves loops open, `pin` by {:.4} m",
        2.0 * 0.1_f64.sin()
    );
    let remarks = at("open");
    assert!(
        remarks.iter().any(|r| r.contains(&words)),
        "{words}: {remarks:?}"
    );
}

/// The names of two hinges that were merged to one joint do not change.
#[test]
fn parts_of_a_joint_have_their_own_names() {
    let text = body(
        "<joint name='roll' axis='1 0 0' armature='0.1' stiffness='2'/>\
         <joint name='pitch' axis='0 1 0' armature='0.2' stiffness='3'/><geom size='0.1'/>",
    );
    let options = Options {
        pose: pose(&[("pitch", 0.3)]),
        ..Options::default()
    };
    let done = import(&text, &options);
    assert_eq!((done.counts, done.armatures), ([1, 1], 2));
    let of = |table, name, key| value(&done.scene, table, name, key);
    assert_eq!(
        of("force", "pitch spring", "stiffness").as_deref(),
        Some("3.0")
    );
    assert!(
        done.scene
            .contains("armature = { first = 0.1, second = 0.2 }")
    );
    assert!((about_y(&done.scene, "b") - 0.3).abs() < 1e-15);
    assert_eq!(done.scene.matches("[[body]]").count(), 1);
    assert_eq!(done.scene.matches("[[joint]]").count(), 1);
}

#[test]
fn a_pose_and_a_keyframe_are_two_starts() {
    let file = "mjcf/pendulum.xml";
    let options = Options {
        keyframe: Some("up".into()),
        pose: pose(&[("hinge", 0.1)]),
        ..options_of(file)
    };
    let refusal = pfaff_import::import(file, &text_of(file), &options).expect_err("refused");
    assert_eq!(first(&refusal).0, "P0605");
}

/// A chain of 401 hinges has an end that must move by 1 m.
#[test]
fn many_coordinates_are_not_tried() {
    let mut text = "<robot name='chain'><link name='l0'/>".to_owned();
    for k in 1..=401 {
        text += &format!(
            "<link name='l{k}'/><joint name='j{k}' type='continuous'><parent link='l{}'/>\
             <child link='l{k}'/><origin xyz='1 0 0'/><axis xyz='0 1 0'/></joint>",
            k - 1
        );
    }
    let yaml = "closed_loop: [[l401, l0]]\ntype: [3d]\n";
    let options = Options {
        loops: Some(("l.yaml".into(), yaml.into())),
        ..Options::default()
    };
    let done = import(&(text + "</robot>"), &options);
    let told = done
        .remarks
        .iter()
        .any(|r| r.contains("401 coordinates are more than are tried"));
    assert!(told, "{:?}", done.remarks);
}
