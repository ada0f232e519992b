//! Mistakes in files: names that the format does not define, macros, angles in another unit,
//! constraints that are not imported, files of loop closures.

use pfaff_import::{Base, Options};

use super::{
    about_y, body, first, import_text as import, imported, numbers, options_of, read, refused,
    text_of, value,
};

/// Returns the text of a URDF file with one hinge, with replaced parts.
fn arm(changes: &[(&str, &str)]) -> String {
    let mut text = "<robot name='r'>\n<link name='base'/>\n<link name='arm'><inertial>\n\
        <origin xyz='0.1 0 0'/><mass value='1'/>\n\
        <inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>\n\
        <joint name='hinge' type='revolute'><parent link='base'/><child link='arm'/>\n\
        <axis xyz='0 1 0'/><origin xyz='0 0 1' rpy='0 0.1 0'/>\n\
        <dynamics damping='2'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>\n\
        </robot>"
        .to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    text
}

fn link(inner: &str) -> String {
    format!(
        "<sdf version='1.7'>\n<model name='m'>\n<link name='a'>\n<inertial><mass>1</mass></inertial>\n\
         </link>\n<joint name='j' type='revolute'><parent>world</parent><child>a</child>\n{inner}\n\
         </joint></model></sdf>"
    )
}

/// A misspelt attribute would give a wrong mass, axis or damper.
#[test]
fn names_that_no_format_knows_are_refused() {
    for (text, line, wrong, near) in [
        (body("<geom size='0.1' desnity='20'/>"), 4, "desnity", "`density`"),
        (body("<geom size='0.1' Mass='3'/>"), 4, "Mass", "`mass`"),
        (body("<geom size='0.1' euller='0 0 3'/>"), 4, "euller", "`euler`"),
        (body("<joint stifness='3'/>"), 4, "stifness", "`stiffness`"),
        (body("<inertail mass='3'/>"), 4, "<inertail>", "`<inertial>`"),
        (
            "<mujoco>\n<default>\n<geom densty='20'/></default></mujoco>".into(),
            3,
            "densty",
            "`density`",
        ),
        (
            "<mujoco>\n<default><default class='a'>\n<joint dampng='3'/></default></default></mujoco>"
                .into(),
            3,
            "dampng",
            "`damping`",
        ),
        ("<mujoco>\n<option gravty='0 0 0'/></mujoco>".into(), 2, "gravty", "`gravity`"),
        ("<mujoco>\n<compiler angel='radian'/></mujoco>".into(), 2, "angel", "`angle`"),
        (
            "<mujoco>\n<equality>\n<joint joint1='j' polycof='1'/></equality></mujoco>".into(),
            3,
            "polycof",
            "`polycoef`",
        ),
        (
            "<mujoco>\n<option><flag gravty='disable'/></option></mujoco>".into(),
            2,
            "gravty",
            "`gravity`",
        ),
        (arm(&[("<origin xyz='0.1", "<orign xyz='0.1")]), 4, "<orign>", "`<origin>`"),
        (arm(&[("rpy=", "rpi=")]), 7, "rpi", "`rpy`"),
        (arm(&[("damping=", "dampng=")]), 8, "dampng", "`damping`"),
        (arm(&[("<axis", "<axes")]), 7, "<axes>", "`<axis>`"),
        (arm(&[("<link name='base'/>", "<lnk name='base'/>")]), 2, "<lnk>", "`<link>`"),
        (link("<axis><xzy>0 1 0</xzy></axis>"), 7, "<xzy>", "`<xyz>`"),
        (
            link("<axis><dynamics><dampng>1</dampng></dynamics></axis>"),
            7,
            "<dampng>",
            "`<damping>`",
        ),
        (
            link("").replace("<mass>1</mass>", "<mas>1</mas>"),
            4,
            "<mas>",
            "`<mass>`",
        ),
        (body("<body frob='1'/>"), 4, "frob", "`childclass`"),
    ] {
        let refusal = refused(&text);
        let (code, at, message) = first(&refusal);
        assert_eq!((code.as_str(), at), ("P0614", line), "{text}: {message}");
        assert!(message.contains(&format!("`{wrong}`")), "{message}");
        let help = refusal.diagnostics[0].help.as_deref().unwrap_or_default();
        assert!(help.contains(near), "{help}");
        assert_eq!(refusal.diagnostics.len(), 1, "{text}");
    }
    // All errors of one file are reported, and long names and lists are shortened.
    let long = "n".repeat(500);
    let refusal = refused(&body(&format!("<geom {long}='1' sise='1'/><joint q='1'/>")));
    assert_eq!(refusal.diagnostics.len(), 3);
    assert!(refusal.diagnostics[0].message.len() < 100);
    let help = refusal.diagnostics[0].help.as_deref().expect("a list");
    assert_eq!(help.matches('`').count(), 2 * 16, "{help}");
}

/// An element that clearly does not belong to the format is omitted and reported. An unknown
/// element that may change supported content is rejected.
#[test]
fn extensions_are_told() {
    let text = arm(&[
        ("<robot", "<robot xmlns:d='http://d' version='1.0'"),
        (
            "<link name='arm'>",
            "<link name='arm' d:role='arm'><d:colour/>",
        ),
        (
            "</robot>",
            "<planning_groups/><gazebo/><ros2_control name='c'/></robot>",
        ),
        ("damping='2'", "damping='2' mu_coulomb='0.1'"),
    ]);
    let done = import(&text, &Options::default());
    let told: Vec<(&str, &str)> = done
        .omissions
        .iter()
        .map(|o| (o.kind, o.subject.as_str()))
        .collect();
    let extension = "extensions that are not read";
    for expected in [
        (extension, "role of <link>"),
        (extension, "<d:colour> of `arm`"),
        (extension, "<planning_groups> of `r`"),
        (extension, "mu_coulomb of <dynamics>"),
        ("actuators", "<ros2_control> `c`"),
    ] {
        assert!(told.contains(&expected), "{expected:?}: {told:?}");
    }
    let text = arm(&[
        ("<robot", "<robot xmlns:d='http://d'"),
        ("</robot>", "<d:joint/></robot>"),
    ]);
    let (code, line, message) = first(&refused(&text));
    assert_eq!((code.as_str(), line), ("P0608", 9), "{message}");
    // A name space that applies to all elements is not an extension.
    let text = arm(&[("<robot", "<robot xmlns='http://d'")]);
    assert_eq!(import(&text, &Options::default()).counts, [1, 1]);
}

/// Only the macro is reported, and not its consequences.
#[test]
fn macros_are_refused() {
    let text = arm(&[
        (
            "<robot",
            "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'",
        ),
        (
            "<link name='base'/>",
            "<link name='base'/><xacro:property name='L' value='1'/>",
        ),
    ]);
    let told = |text: &str, code, line| {
        let refusal = refused(text);
        assert_eq!(refusal.diagnostics.len(), 1, "{:?}", refusal.diagnostics);
        let (found, at, message) = first(&refusal);
        assert_eq!((found.as_str(), at), (code, line), "{message}");
        let help = refusal.diagnostics[0].help.as_deref().unwrap_or_default();
        assert!(help.contains("xacro"), "{help}");
    };
    told(&text, "P0608", 2);
    told(&arm(&[("0 0 1", "${L} 0 0")]), "P0605", 7);
}

#[test]
fn cycles_are_named() {
    let text = "<robot><link name='a'/><link name='b'/><link name='c'/>\n\
        <joint name='i' type='fixed'><parent link='b'/><child link='c'/></joint>\n\
        <joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>\n\
        <joint name='k' type='continuous'><parent link='b'/><child link='a'/></joint></robot>";
    let (code, line, message) = first(&refused(text));
    assert_eq!((code.as_str(), line), ("P0609", 3), "{message}");
    assert!(message.starts_with("`j`, `k` form a cycle"), "{message}");
}

/// The number 90 is a quarter turn in degrees and 14 revolutions in rad; 1.5708 is a quarter turn
/// in rad.
#[test]
fn angles_in_another_unit_are_told() {
    let told = |text: &str, words: &str| {
        let done = import(text, &Options::default());
        done.remarks.iter().any(|remark| remark.contains(words))
    };
    let degrees = "Does this file use degrees?";
    assert!(told(&arm(&[("0 0.1 0", "0 90 0")]), degrees));
    assert!(!told(&arm(&[]), degrees));
    let pose = "<pose>0 0 0 0 0 90</pose><axis><xyz>0 0 1</xyz></axis>";
    assert!(told(&link(pose), degrees));
    assert!(!told(
        &link(&pose.replace("<pose>", "<pose degrees='true'>")),
        degrees
    ));
    let radians = "Does this file use radians?";
    let hinged = |attributes: &str| body(&format!("<joint {attributes}/><geom size='0.1'/>"));
    assert!(told(&hinged("range='-1.57 1.57'"), radians));
    assert!(told(&hinged("springref='0.785'"), radians));
    assert!(!told(&hinged("range='-30 45.5'"), radians));
    let turned = hinged("").replace("name='b'", "name='b' euler='0 1.5708 0'");
    assert!(told(&turned, radians));
    let says = turned.replace("<mujoco>", "<mujoco><compiler angle='radian'/>");
    assert!(!told(&says, radians));
}

/// Unsupported constraints that remove degrees of freedom are rejected at their positions, unless
/// they are inactive.
#[test]
fn constraints_that_are_not_read_are_refused() {
    let joints = "<joint name='j'/><joint name='k' pos='1 0 0'/><joint name='l' pos='2 0 0'/>\
        <geom size='0.1'/>";
    let tendons = "<tendon><fixed name='t'><joint joint='j' coef='1'/><joint joint='k' coef='1'/>\
        <joint joint='l' coef='1'/></fixed><spatial name='rope'/></tendon>";
    for kind in [
        "tendon tendon1='t'",
        "tendon tendon1='rope'",
        "flex flex='f'",
        "distance",
    ] {
        let text = format!(
            "{}{tendons}\n<equality>\n<{kind}/></equality></mujoco>",
            body(joints).trim_end_matches("</mujoco>")
        );
        let (code, line, message) = first(&refused(&text));
        assert_eq!((code.as_str(), line), ("P0608", 9), "{message}");
        if !kind.starts_with("tendon") {
            let off = text.replace("/></equality>", " active='false'/></equality>");
            let done = import(&off, &Options::default());
            assert_eq!(done.omissions.last().map(|o| o.line), Some(9));
            assert!(!done.remarks.iter().any(|r| r.contains("exact here")));
        }
    }
}

/// The file has fixed tendons of two joints: 0.5·j − k = 0.1 is j = 0.2 + 2·k, and 2·k = 0.1 −
/// 3·(−l)² is k = 0.05 − 1.5·l².
#[test]
fn constraints_of_fixed_tendons_are_couplings() {
    let hinged = |name: &str| {
        format!(
            "<body name='of {name}'><joint name='{name}' axis='0 1 0'/><geom size='0.1'/></body>"
        )
    };
    let bodies: String = ["j", "k", "l"].map(hinged).concat();
    let text = |equality: &str| {
        format!(
            "<mujoco><compiler angle='radian'/><worldbody>{bodies}</worldbody><tendon>\
             <fixed name='jk'><joint joint='j' coef='0.5'/><joint joint='k' coef='-1'/></fixed>\
             <fixed name='k'><joint joint='k' coef='2'/><joint joint='j' coef='0'/></fixed>\
             <fixed name='l'><joint joint='l' coef='-1'/></fixed>\
             </tendon><equality>{equality}</equality></mujoco>"
        )
    };
    let both = text("<tendon name='c' tendon1='jk' polycoef='0.1'/>");
    let done = import(&both, &Options::default());
    let of = |key| value(&done.scene, "joint", "c", key);
    assert_eq!(of("ratio").as_deref(), Some("2.0"));
    assert_eq!(
        of("measures").as_deref(),
        Some("[\"k.angle\", \"j.angle\"]")
    );
    assert!((about_y(&done.scene, "of j") - 0.2).abs() < 1e-15);
    read(&done);
    let each = text("<tendon name='c' tendon1='k' tendon2='l' polycoef='0.1 0 -3'/>");
    let done = import(&each, &Options::default());
    let of = |key| value(&done.scene, "joint", "c", key).expect("there");
    assert_eq!(numbers(&of("coefficients")), [-1.5, 0.0, 0.0]);
    assert!((about_y(&done.scene, "of k") - 0.05).abs() < 1e-15);
    let held = text("<tendon name='c' tendon1='l'/>");
    let done = import(&held, &Options::default());
    assert_eq!(
        value(&done.scene, "drive", "c", "joint").as_deref(),
        Some("\"l\"")
    );
    for (wrong, code) in [
        ("tendon1='x'", "P0606"),
        ("tendon2='l'", "P0604"),
        ("tendon1='l' tendon2='l'", "P0609"),
    ] {
        let text = text(&format!("<tendon {wrong}/>"));
        assert_eq!(first(&refused(&text)).0, code, "{wrong}");
    }
    let misspelt = text("").replacen("coef=", "coeff=", 1);
    assert_eq!(first(&refused(&misspelt)).0, "P0614");
}

#[test]
fn a_free_base_is_one_of_urdf() {
    let options = Options {
        base: Base::Free,
        ..Options::default()
    };
    let text = body("<joint/><geom size='0.1'/>");
    let refusal = pfaff_import::import("file.xml", &text, &options).expect_err("refused");
    assert_eq!(first(&refusal).0, "P0608");
    let alone = arm(&[
        ("type='revolute'", "type='fixed'"),
        ("<dynamics damping='2'/>", ""),
    ]);
    let refusal = refused(&alone);
    assert_eq!(first(&refusal).0, "P0609");
    let help = refusal.diagnostics[0].help.as_deref().unwrap_or_default();
    assert!(help.contains("--base free"), "{help}");
}

#[test]
fn a_file_without_gravity_has_that_of_the_earth() {
    for text in [arm(&[]), link(""), body("<joint/><geom size='0.1'/>")] {
        let done = import(&text, &Options::default());
        assert!(
            done.scene.contains("\ngravity = [0.0, 0.0, -9.81]\n"),
            "{}",
            done.scene
        );
    }
}

/// The quaternion of URDF 1.2 is half a turn about z.
#[test]
fn a_quaternion_of_a_urdf_is_read() {
    let text = arm(&[("rpy='0 0.1 0'", "quat_xyzw='0 0 1 0'")]);
    let done = import(&text, &Options::default());
    let turned = value(&done.scene, "body", "arm", "orientation").expect("turned");
    assert_eq!(turned, "{ quaternion = [0.0, 0.0, 0.0, 1.0] }");
}

/// Messages about a file of loop closures state the required text.
#[test]
fn a_yaml_of_loops_says_what_it_lacks() {
    let file = "urdf/triangle.urdf";
    let pair = "closed_loop: [['tip of three', 'tip of four']]\n";
    for (yaml, line, words) in [
        (
            "closed_loop: [a, b]\ntype: [3d]\n",
            1,
            "entry 1 is `a`, not a pair",
        ),
        (
            "loops:\n  - links: [a, b]\n",
            1,
            "key `closed_loop` is missing",
        ),
        ("", 1, "key `closed_loop` is missing"),
        (&format!("{pair}type: 6d\n"), 2, "write `[6d]`"),
        (pair, 1, "key `type` is missing"),
        (&format!("{pair}types: [6d]\n"), 2, "did you mean `type`?"),
        (
            &format!("{pair}type: [3d]\n{pair}"),
            3,
            "key `closed_loop` is already defined in line 1",
        ),
        (
            &format!("{pair}type: [3d]\njoint_name: [A]\njoint_type: [REVOLUTE]\n"),
            4,
            "`REVOLUTE` is not a joint type here: use `SPHERICAL`, or `UJOINT_XY`",
        ),
    ] {
        let options = Options {
            loops: Some(("l.yaml".into(), yaml.into())),
            ..options_of(file)
        };
        let refusal = pfaff_import::import(file, &text_of(file), &options).expect_err("refused");
        let (code, at, message) = first(&refusal);
        assert_eq!((code.as_str(), at), ("P0612", line), "{yaml}: {message}");
        assert!(message.contains(words), "{message}");
    }
}

/// A pose in which a coordinate is requested twice is rejected.
#[test]
fn a_pose_names_a_coordinate_once() {
    let file = "urdf/triangle.urdf";
    let joint = {
        let text = text_of(file);
        let named = text.split("<joint name=\"").nth(1).expect("a joint");
        named.split('"').next().expect("a name").to_owned()
    };
    let options = Options {
        pose: vec![(joint.clone(), 0.1), (joint.clone(), 0.2)],
        ..options_of(file)
    };
    let refusal = pfaff_import::import(file, &text_of(file), &options).expect_err("refused");
    let (_, _, message) = first(&refusal);
    assert!(
        message.contains(&format!("`{joint}` is requested at 0.2")),
        "{message}"
    );
}

/// All files of this folder contain only names that their formats define.
#[test]
fn files_without_mistakes_have_no_extensions() {
    for file in [
        "mjcf/classes.xml",
        "urdf/gripper.urdf",
        "sdf/many-types.sdf",
    ] {
        let done = imported(file);
        let told = done
            .omissions
            .iter()
            .any(|o| o.kind.starts_with("extensions"));
        assert!(!told, "{file}: {:?}", done.omissions);
    }
}
