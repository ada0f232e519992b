//! Details of the formats that decide numbers of the scene: the order of sections, defaults, frames
//! of welds, bounds of masses, and springs and couplings of links that the import moves.

use pfaff_import::{ImportedScene, Options};

use super::{body, first, import_text, numbers, read, refused, value};

const PRECISION: f64 = 1e-12;

/// Imports an MJCF file with these sections.
fn mjcf(sections: &str) -> ImportedScene {
    import_text(&format!("<mujoco>{sections}</mujoco>"), &Options::default())
}

/// Imports an MJCF file with these sections, and starts at the keyframe `k`.
fn at_keyframe(sections: &str) -> ImportedScene {
    import_text(&format!("<mujoco>{sections}</mujoco>"), &start())
}

fn start() -> Options {
    Options {
        keyframe: Some("k".to_owned()),
        ..Options::default()
    }
}

/// Requires numbers of a key of a scene.
fn close(done: &ImportedScene, [table, name, key]: [&str; 3], expected: &[f64]) {
    let found = value(&done.scene, table, name, key);
    let found = found.unwrap_or_else(|| panic!("{name}.{key}:\n{}", done.scene));
    let found = match found.split_once("quaternion = ") {
        Some((_, quaternion)) => numbers(quaternion),
        None if found.contains('[') => numbers(&found),
        None => vec![found.parse().expect("a number")],
    };
    let near = |(a, b): (&f64, &f64)| (a - b).abs() < PRECISION;
    let fits = found.len() == expected.len() && found.iter().zip(expected).all(near);
    assert!(fits, "{name}.{key}: {found:?}, expected {expected:?}");
}

/// Requires a text of a key of a scene.
fn is(done: &ImportedScene, [table, name, key]: [&str; 3], expected: &str) {
    let found = value(&done.scene, table, name, key);
    assert_eq!(found.as_deref(), Some(expected), "{}", done.scene);
}

/// The remark that contains these words.
fn remarks(done: &ImportedScene, words: &str) {
    let found = done.remarks.iter().any(|remark| remark.contains(words));
    assert!(found, "{words}: {:?}", done.remarks);
}

const BARS: &str = "<worldbody>\
    <body name='a'><joint name='a' axis='0 0 1'/><geom size='0.1'/></body>\
    <body name='b' pos='2 0 0'><joint name='b' axis='0 0 1'/><geom size='0.1'/></body></worldbody>";

/// The order of sections has no meaning in MJCF. Loop joints belong to the joints of a keyframe.
#[test]
fn keyframes_may_precede_constraints() {
    let key = "<keyframe><key name='k' qpos='0.1 -0.1'/></keyframe>";
    let loops = "<equality><connect body1='a' body2='b' anchor='1 0 0'/></equality>";
    for weld in [loops, &loops.replace("connect", "weld")] {
        let [early, late] =
            [[key, BARS, weld], [BARS, weld, key]].map(|s| at_keyframe(&s.concat()));
        assert_eq!(early.scene, late.scene);
        // Rotation about z by 0.1 rad.
        let (sin, cos) = 0.05_f64.sin_cos();
        assert!(early.scene.contains("start = {"), "{}", early.scene);
        let head = value(&early.scene, "body", "a", "start").expect("a start");
        let (_, turned) = head.split_once("quaternion = ").expect("a quaternion");
        let found = numbers(turned);
        assert!((found[0] - cos).abs() < PRECISION && (found[3] - sin).abs() < PRECISION);
    }
}

/// `relpose` is the position of the anchor point, which is at the origin of the world here.
#[test]
fn the_position_of_a_weld_is_that_of_its_anchor() {
    let weld = |attributes: &str| {
        mjcf(&format!(
            "<worldbody><body name='b' pos='0 1 0'><freejoint/><geom size='0.1'/></body></worldbody>\
             <equality><weld name='w' body1='world' body2='b' {attributes}/></equality>"
        ))
    };
    let done = weld("anchor='0 -1 0' relpose='0 0 0 1 0 0 0'");
    close(&done, ["body", "b", "position"], &[0.0, 1.0, 0.0]);
    close(&done, ["marker", "w first", "point"], &[0.0; 3]);
    close(&done, ["marker", "w second", "point"], &[0.0, -1.0, 0.0]);
    read(&done);
    // Without an anchor, it is the position of the body.
    let done = weld("relpose='0 1 0 1 0 0 0'");
    close(&done, ["marker", "w first", "point"], &[0.0, 1.0, 0.0]);
}

/// A factor of zero removes the rotations of a weld. Other factors only change its softness.
#[test]
fn a_weld_without_torques_is_a_ball_joint() {
    let weld = |attributes: &str| {
        mjcf(&format!(
            "<worldbody><body name='b' pos='1 2 3'><freejoint/><geom size='0.1'/></body></worldbody>\
             <equality><weld name='w' body1='b' body2='world' anchor='1 2 3' {attributes}/></equality>"
        ))
    };
    let done = weld("torquescale='0'");
    is(&done, ["joint", "w", "type"], "\"spherical\"");
    is(
        &done,
        ["joint", "w", "points"],
        "{ \"b\" = [0.0, 0.0, 0.0], \"ground\" = [1.0, 2.0, 3.0] }",
    );
    remarks(&done, "The weld `w` (line 1) has `torquescale=\"0\"`");
    read(&done);
    let done = weld("torquescale='0' relpose='-1 -2 -3 0 1 0 0'");
    is(&done, ["joint", "w", "type"], "\"spherical\"");
    let done = weld("torquescale='0.5'");
    is(&done, ["joint", "w", "type"], "\"fixed\"");
}

/// `inertiafromgeom="true"` replaces the inertia of the file only if geoms have mass.
#[test]
fn an_inertial_remains_without_geoms() {
    let imported = |compiler: &str, geom: &str| {
        mjcf(&format!(
            "<compiler {compiler}/><worldbody><body name='b'><joint axis='1 0 0'/>\
             <inertial pos='0 0.5 0' mass='2' diaginertia='0.1 0.1 0.1'/>{geom}</body></worldbody>"
        ))
    };
    let all = "inertiafromgeom='true'";
    for (compiler, geom, mass) in [
        (all.to_owned(), "", 2.0),
        (all.to_owned(), "<geom size='0.1' mass='0'/>", 2.0),
        (all.to_owned(), "<geom size='0.1' mass='3'/>", 3.0),
        // A geom without a group is in group 0.
        (
            format!("{all} inertiagrouprange='1 2'"),
            "<geom size='0.1' mass='3'/>",
            2.0,
        ),
        (
            format!("{all} inertiagrouprange='1 2'"),
            "<geom size='0.1' mass='3' group='2'/>",
            3.0,
        ),
    ] {
        let done = imported(&compiler, geom);
        close(&done, ["body", "b", "mass"], &[mass]);
    }
    close(
        &imported(all, ""),
        ["body", "b", "centre"],
        &[0.0, 0.5, 0.0],
    );
}

/// MuJoCo 4.0 has `body_ipos = [0, 0.3, 1]` for this body, also within a frame.
#[test]
fn a_body_without_mass_has_its_bounds_at_its_position() {
    let compiler = "<compiler boundmass='0.1' boundinertia='0.01'/>";
    let own = "<body name='b' pos='0 0.3 1'><joint axis='1 0 0'/></body>";
    for around in [own.to_owned(), format!("<frame pos='1 0 0'>{own}</frame>")] {
        let done = mjcf(&format!("{compiler}<worldbody>{around}</worldbody>"));
        close(&done, ["body", "b", "mass"], &[0.1]);
        close(&done, ["body", "b", "centre"], &[0.0, 0.3, 1.0]);
        remarks(&done, "Body `b` (line 1) has only the mass of `boundmass`");
    }
}

/// MuJoCo does not use the position of a body with a mesh, whose mass the import omits.
#[test]
fn a_body_whose_mesh_is_not_read_has_its_bounds_at_its_origin() {
    for geom in ["<geom mesh='m'/>", "<geom type='mesh' mesh='m'/>"] {
        let done = mjcf(&format!(
            "<compiler boundmass='0.1' boundinertia='0.01'/><asset><mesh name='m' file='m.stl'/>\
             </asset><worldbody><body name='b' pos='0 0.3 1'><joint axis='1 0 0'/>{geom}</body>\
             </worldbody>"
        ));
        close(&done, ["body", "b", "mass"], &[0.1]);
        assert!(!done.scene.contains("centre ="), "{}", done.scene);
    }
}

/// The spring −2·q has its free length at q = 0, where the points of the slide coincide. The
/// coupling describes the slide at q = −0.5.
#[test]
fn springs_of_slides_refer_to_coincident_points() {
    let bodies = |loads: &str| {
        format!(
            "<worldbody><body name='a'><joint name='a' axis='0 0 1'/><geom size='0.1'/></body>\
             <body name='b' pos='2 0 0'><joint name='b' type='slide' axis='1 0 0' {loads}/>\
             <geom size='0.1'/></body></worldbody><equality><joint joint1='b' joint2='a' \
             polycoef='-0.5 1 0 0 0'/></equality>"
        )
    };
    let done = mjcf(&bodies("stiffness='2'"));
    close(&done, ["body", "b", "position"], &[1.5, 0.0, 0.0]);
    is(
        &done,
        ["drive", "b spring", "force"],
        "\"-2.0*(measure - 0.0)\"",
    );
    // With `ref`, the coincident points have q = 0.25: the free length 0.75 is a measure of 0.5.
    let done = mjcf(&bodies(
        "stiffness='2' damping='3' ref='0.25' springref='0.75'",
    ));
    is(
        &done,
        ["drive", "b spring", "force"],
        "\"-2.0*(measure - 0.5) - 3.0*rate\"",
    );
}

/// The search for closed loops moves the slide to q = 0.9 or q = −0.1; the spring stays at q = 0.
#[test]
fn springs_of_slides_in_loops_refer_to_coincident_points() {
    let done = mjcf(
        "<worldbody><body name='a'><joint name='a' type='slide' axis='1 0 0' stiffness='10'/>\
         <geom size='0.1' mass='1'/><site name='sa'/></body>\
         <body name='b' pos='0.4 0 0'><joint name='b' axis='0 1 0'/>\
         <geom size='0.1' mass='1' pos='0.5 0 0'/><site name='sb' pos='0.5 0 0'/></body></worldbody>\
         <equality><connect site1='sa' site2='sb'/></equality>",
    );
    let at = numbers(&value(&done.scene, "body", "a", "position").expect("moved"));
    assert!(
        (at[0] - 0.9).abs() < 1e-9 || (at[0] + 0.1).abs() < 1e-9,
        "{at:?}"
    );
    is(
        &done,
        ["drive", "a spring", "force"],
        "\"-10.0*(measure - 0.0)\"",
    );
}

/// The angle of a hinge is zero at the described pose, which the coupling puts at q = −0.5: the
/// spring without load at q = 0 has a free angle of 0.5 rad.
#[test]
fn springs_of_hinges_refer_to_the_described_pose() {
    let done = mjcf(&format!(
        "<compiler angle='radian'/>{}<equality><joint joint1='b' joint2='a' \
         polycoef='-0.5 1 0 0 0'/></equality>",
        BARS.replace("name='b' axis", "name='b' stiffness='2' axis")
    ));
    close(&done, ["force", "b spring", "free_angle"], &[0.5]);
    let (sin, cos) = 0.25_f64.sin_cos();
    close(&done, ["body", "b", "orientation"], &[cos, 0.0, 0.0, -sin]);
}

/// Arm of 1 kg with its centre at x = 0.5, and a fixed tool of 1 kg at x = 1.
#[test]
fn compensated_weights_act_at_their_own_centre() {
    let arm = |own: &str, tool: &str| {
        mjcf(&format!(
            "<worldbody><body name='arm' {own}><joint name='j' axis='0 1 0'/>\
             <geom size='0.1' pos='0.5 0 0' mass='1'/><body name='tool' pos='1 0 0' {tool}>\
             <geom size='0.1' mass='1'/></body></body></worldbody>"
        ))
    };
    let held = "held weight of arm";
    for (own, tool, x, force) in [
        ("", "gravcomp='1'", 1.0, 9.81),
        ("gravcomp='1'", "", 0.5, 9.81),
        // (1·0.5 + 0.5·1)/1.5 = 2/3
        ("gravcomp='1'", "gravcomp='0.5'", 2.0 / 3.0, 1.5 * 9.81),
    ] {
        let done = arm(own, tool);
        close(&done, ["force", held, "point"], &[x, 0.0, 0.0]);
        close(&done, ["force", held, "force"], &[0.0, 0.0, force]);
        read(&done);
    }
    // Opposite weights form a torque, which needs two forces.
    let done = arm("gravcomp='1'", "gravcomp='-1'");
    assert_eq!(done.scene.matches("type = \"point-force\"").count(), 2);
    assert!(!arm("", "").scene.contains("point-force"));
}

const SLIDES: &str = "<worldbody><body name='a'><joint name='a' type='slide' axis='1 0 0'/>\
    <geom size='0.1'/></body><body name='b' pos='0 1 0'><joint name='b' type='slide' axis='1 0 0'/>\
    <geom size='0.1'/></body></worldbody>";

/// b = a − 0.3 and b = −0.1 have the solution a = 0.2.
#[test]
fn two_couplings_of_one_joint_are_solved() {
    let couplings = "<equality><joint joint1='b' joint2='a' polycoef='-0.3 1 0 0 0'/>\
        <joint joint1='b' polycoef='-0.1 0 0 0 0'/></equality>";
    let done = mjcf(&format!("{SLIDES}{couplings}"));
    close(&done, ["body", "a", "position"], &[0.2, 0.0, 0.0]);
    close(&done, ["body", "b", "position"], &[-0.1, 1.0, 0.0]);
    read(&done);
    // b = 0.1 + a² and b = 0.5 + a have solutions with a² − a = 0.4.
    let couplings = "<equality><joint joint1='b' joint2='a' polycoef='0.1 0 1 0 0'/>\
        <joint joint1='b' joint2='a' polycoef='0.5 1 0 0 0'/></equality>";
    let done = mjcf(&format!("{SLIDES}{couplings}"));
    let at = |body| numbers(&value(&done.scene, "body", body, "position").expect("moved"))[0];
    assert!((at("a") * at("a") - at("a") - 0.4).abs() < 1e-9);
    assert!((at("b") - at("a") - 0.5).abs() < 1e-9);
}

#[test]
fn couplings_that_contradict_each_other_are_refused() {
    let text = format!(
        "<mujoco>{SLIDES}<equality><joint name='one' joint1='b' polycoef='0.3 0 0 0 0'/>\
         <joint name='two' joint1='b' polycoef='-0.1 0 0 0 0'/></equality></mujoco>"
    );
    let refusal = refused(&text);
    let (code, _, message) = first(&refusal);
    assert_eq!(code, "P0609");
    // The least-squares solution is 0.1, with errors of 0.2.
    assert!(
        message.contains("`one`") || message.contains("`two`"),
        "{message}"
    );
    assert!(message.contains("0.2 m or rad"), "{message}");
    let help = refusal.diagnostics[0].help.as_deref().unwrap_or_default();
    assert!(help.contains("remove a coupling"), "{help}");
}

/// Capsules use two sizes and spheres one; MuJoCo ignores the others.
#[test]
fn sizes_that_a_shape_does_not_use_have_any_value() {
    for (shape, mass) in [
        (
            "type='sphere' size='0.5 -1 0'",
            4.0 / 3.0 * std::f64::consts::PI * 125.0,
        ),
        (
            "type='cylinder' size='0.5 2 0'",
            std::f64::consts::PI * 1000.0,
        ),
    ] {
        let done = mjcf(&format!(
            "<worldbody><body name='b'><joint/><geom {shape}/></body></worldbody>"
        ));
        let found = value(&done.scene, "body", "b", "mass").expect("a mass");
        let found: f64 = found.parse().expect("a number");
        assert!((found - mass).abs() < 1e-9, "{found}");
    }
    for shape in ["type='capsule' size='0.5 0 1'", "type='box' size='1 1 0'"] {
        let text =
            format!("<mujoco><worldbody><body><joint/><geom {shape}/></body></worldbody></mujoco>");
        assert_eq!(first(&refused(&text)).0, "P0610", "{shape}");
    }
}

/// A box rotated by 90° about z has its moments about x and y exchanged; with the rotation about x
/// of the class instead, those about y and z.
#[test]
fn an_orientation_replaces_every_form_of_the_class() {
    // Moments of the box of 12 kg: 12·(b² + c²)/3.
    let [xx, yy, zz] = [4.0 * 13.0, 4.0 * 10.0, 4.0 * 5.0];
    for (own, expected) in [
        ("", [xx, zz, yy]),
        ("axisangle='0 0 1 90'", [yy, xx, zz]),
        ("quat='1 0 0 1'", [yy, xx, zz]),
        ("euler='0 0 0'", [xx, yy, zz]),
    ] {
        let done = mjcf(&format!(
            "<default><geom euler='90 0 0'/></default><worldbody><body name='b'><joint/>\
             <geom type='box' size='1 2 3' mass='12' {own}/></body></worldbody>"
        ));
        close(&done, ["body", "b", "inertia"], &expected);
    }
}

/// MuJoCo moves the axes of these bodies to their inertial frames, and numbers for these axes are
/// not converted.
#[test]
fn numbers_of_aligned_bodies_are_refused() {
    let model = |compiler: &str, joint: &str, child: &str, more: &str| {
        format!(
            "<mujoco><compiler {compiler}/><worldbody>\n<body name='a' pos='1 2 3'>{joint}\
             <geom size='0.1' pos='0.5 0 0'/>{child}</body></worldbody>\n{more}</mujoco>"
        )
    };
    let key = "<keyframe><key name='k' qpos='0 0 0 1 0 0 0'/></keyframe>";
    let on = "<freejoint align='true'/>";
    for (compiler, joint) in [
        ("", on),
        ("alignfree='true'", "<freejoint/>"),
        ("alignfree='true'", "<freejoint align='auto'/>"),
        ("alignfree='true'", "<joint type='free'/>"),
    ] {
        let text = model(compiler, joint, "", key);
        let done = pfaff_import::import("file.xml", &text, &start());
        let refusal = done.expect_err("refused");
        let (code, line, message) = first(&refusal);
        assert_eq!((code.as_str(), line), ("P0608", 3), "{message}");
        assert!(
            message.contains("`k`") && message.contains("`a`"),
            "{message}"
        );
        // The described pose does not depend on the axes.
        let done = import_text(&text, &Options::default());
        close(&done, ["body", "a", "position"], &[1.0, 2.0, 3.0]);
    }
    let child = "<body><joint/><geom size='0.1'/></body>";
    let more = "<keyframe><key name='k' qpos='0 0 0 1 0 0 0 0'/></keyframe>";
    for text in [
        model("", "<freejoint/>", "", key),
        model("alignfree='true'", "<freejoint align='false'/>", "", key),
        // A body with child bodies is not aligned.
        model("", on, child, more),
    ] {
        import_text(&text, &start());
    }
    for (constraint, refuses) in [
        ("<connect body1='a' anchor='0 0 0'/>", true),
        ("<connect body1='world' body2='a' anchor='0 0 0'/>", false),
        ("<weld body1='a'/>", false),
        ("<weld body1='a' relpose='0 0 0 1 0 0 0'/>", true),
        ("<weld body1='world' body2='a' torquescale='0'/>", true),
    ] {
        let text = model("", on, "", &format!("<equality>{constraint}</equality>"));
        let done = pfaff_import::import("file.xml", &text, &Options::default());
        assert_eq!(done.is_err(), refuses, "{constraint}");
    }
}

/// A rack on a slide and a free bench that are bolted together: the file describes them apart, and
/// the keyframe puts them together. The scene describes them at the keyframe.
#[test]
fn a_keyframe_that_closes_loops_is_described() {
    let done = at_keyframe(
        "<worldbody><body name='rack' pos='0 1 0'>\
         <joint name='rack' type='slide' axis='1 0 0' stiffness='3'/><geom size='0.1'/></body>\
         <body name='bench' pos='4 0 0'><freejoint/><geom size='0.1'/></body></worldbody>\
         <equality><weld name='bolted' body1='rack' body2='bench' relpose='1 0.2 0 1 0 0 1'/>\
         </equality><keyframe><key name='k' qpos='0.5 1.5 1.2 0 1 0 0 1'/></keyframe>",
    );
    close(&done, ["body", "rack", "position"], &[0.5, 1.0, 0.0]);
    close(&done, ["body", "bench", "position"], &[1.5, 1.2, 0.0]);
    let half = 0.5_f64.sqrt();
    close(
        &done,
        ["body", "bench", "orientation"],
        &[half, 0.0, 0.0, half],
    );
    is(
        &done,
        ["drive", "rack spring", "force"],
        "\"-3.0*(measure - 0.0)\"",
    );
    remarks(&done, "The links are described at the keyframe `k`");
    read(&done);
}

/// The orientation is Rx(0.2)·Ry(0.7), although the coupling describes the second hinge at 0.5.
#[test]
fn keyframes_of_coupled_universal_joints() {
    let model = |key: &str| {
        at_keyframe(&format!(
            "<compiler angle='radian'/><worldbody><body name='b'><joint name='x' axis='1 0 0'/>\
             <joint name='y' axis='0 1 0'/><geom size='0.1'/></body></worldbody>\
             <equality><joint joint1='y' joint2='x' polycoef='0.5 1 0 0 0'/></equality>\
             <keyframe><key name='k' {key}/></keyframe>"
        ))
    };
    let done = model("qpos='0.2 0.7' qvel='1 1'");
    let ((sx, cx), (sy, cy)) = (0.1_f64.sin_cos(), 0.35_f64.sin_cos());
    // (cx + sx·i)·(cy + sy·j)
    close(
        &done,
        ["body", "b", "start"],
        &[cx * cy, sx * cy, cx * sy, sx * sy],
    );
    // ω = e_x + Rx(0.2)·e_y
    let spin = [1.0, 0.2_f64.cos(), 0.2_f64.sin()];
    close(&done, ["body", "b", "angular_velocity"], &spin);
    let (sin, cos) = 0.25_f64.sin_cos();
    close(&done, ["body", "b", "orientation"], &[cos, 0.0, sin, 0.0]);
}

/// ROS reads the first of two elements without a message.
#[test]
fn second_elements_of_a_urdf_are_refused() {
    let inertia = "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>";
    let inertial = format!("<inertial><mass value='1'/>{inertia}</inertial>");
    let axis = "<axis xyz='1 0 0'/>";
    let model = |link: &str, joint: &str| {
        format!(
            "<robot name='r'><link name='base'/>\n<link name='a'>{link}</link>\n\
             <joint name='j' type='continuous'><parent link='base'/><child link='a'/>{joint}\
             </joint></robot>"
        )
    };
    import_text(&model(&inertial, axis), &Options::default());
    for (link, joint, kind, line) in [
        (inertial.repeat(2), axis.to_owned(), "<inertial>", 2),
        (
            inertial.replace("<mass value='1'/>", "<mass value='1'/><mass value='2'/>"),
            axis.into(),
            "<mass>",
            2,
        ),
        (inertial.clone(), axis.repeat(2), "<axis>", 3),
        (
            inertial.clone(),
            format!("{axis}<origin/><origin xyz='1 0 0'/>"),
            "<origin>",
            3,
        ),
        (
            inertial.clone(),
            format!("{axis}<child link='base'/>"),
            "<child>",
            3,
        ),
    ] {
        let (code, at, message) = first(&refused(&model(&link, &joint)));
        assert_eq!((code.as_str(), at), ("P0609", line), "{message}");
        assert!(message.contains(&format!("a second `{kind}`")), "{message}");
    }
}

#[test]
fn a_link_with_the_name_of_the_ground_is_refused() {
    let text = "<sdf version='1.9'><model name='m'>\n<link name='world'/>\n\
        <link name='a'/></model></sdf>";
    let refusal = refused(text);
    let (code, line, message) = first(&refusal);
    assert_eq!((code.as_str(), line), ("P0608", 2), "{message}");
    assert!(message.contains("`world`"), "{message}");
}

/// Gazebo uses the first of two elements, and MuJoCo rejects the second.
#[test]
fn second_elements_of_other_formats_are_refused() {
    let sdf = |link: &str, joint: &str| {
        format!(
            "<sdf version='1.9'><model name='m'>\n<link name='a'>{link}</link>\n\
             <joint name='j' type='revolute'><parent>world</parent><child>a</child>\
             <axis><xyz>0 0 1</xyz></axis>{joint}</joint></model></sdf>"
        )
    };
    import_text(&sdf("<inertial/>", ""), &Options::default());
    let inertial = "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
    for (text, kind, line) in [
        (sdf("<inertial/><inertial/>", ""), "<inertial>", 2),
        (
            sdf("<inertial><mass>1</mass><mass>2</mass></inertial>", ""),
            "<mass>",
            2,
        ),
        (
            sdf("<pose>0 0 0 0 0 0</pose><pose>1 0 0 0 0 0</pose>", ""),
            "<pose>",
            2,
        ),
        (sdf("", "<axis><xyz>1 0 0</xyz></axis>"), "<axis>", 3),
        (
            body(&format!("<joint/>{inertial}{inertial}")),
            "<inertial>",
            4,
        ),
    ] {
        let (code, at, message) = first(&refused(&text));
        assert_eq!((code.as_str(), at), ("P0609", line), "{message}");
        assert!(message.contains(&format!("`{kind}`")), "{message}");
    }
}
