//! MJCF: the scene elements for each part of a file. Accelerations are compared with MuJoCo by
//! `tests/peers/import`.

use pfaff_import::{FixedLinks, Options};

use super::{first, import_text, imported, options_of, read, refused, text_of, value};

/// Number of bodies, and number of joints and couplings of each file, counted by hand. Intermediate
/// bodies between several joints count as bodies, and bodies without joints are merged.
const FILES: [(&str, [usize; 2]); 9] = [
    ("mjcf/pendulum.xml", [2, 2]),
    ("mjcf/free-and-ball.xml", [3, 2]),
    // The plate has 3 joints, the cross has 2 hinges at right angles, and the wrist has 3 hinges
    // whose axes do not intersect.
    ("mjcf/many-joints.xml", [7, 7]),
    ("mjcf/classes.xml", [3, 3]),
    ("mjcf/four-bar.xml", [3, 4]),
    ("mjcf/couplings.xml", [6, 11]),
    ("mjcf/bounds.xml", [2, 2]),
    ("mjcf/included.xml", [3, 3]),
    // Each body has one or two joints, and the last has three hinges.
    ("mjcf/armatures.xml", [8, 8]),
];

#[test]
fn every_file_is_a_scene() {
    for (file, counts) in FILES {
        let imported = imported(file);
        assert_eq!(imported.counts, counts, "{file}");
        let scene = read(&imported);
        assert!(!scene.name().is_empty(), "{file}");
    }
}

/// Returns the line of a piece of text in a file, from 1.
fn line_of(file: &str, piece: &str) -> usize {
    let text = text_of(file);
    let at = text
        .find(piece)
        .unwrap_or_else(|| panic!("{file}: no {piece}"));
    text[..at].matches('\n').count() + 1
}

#[test]
fn what_is_left_out_is_told_with_its_line() {
    let file = "mjcf/classes.xml";
    let imported = imported(file);
    for (kind, subject, piece) in [
        ("limits of joints", "hip", "<joint name=\"hip\"/>"),
        ("limits of joints", "toe", "<joint name=\"toe\"/>"),
        (
            "friction of joints: accelerations differ while the joints move",
            "knee",
            "<joint name=\"knee\"",
        ),
        ("actuators", "hip motor", "<motor"),
        ("sensors", "<jointpos>", "<jointpos"),
        ("pairs and exclusions of contacts", "<exclude>", "<exclude"),
    ] {
        let line = line_of(file, piece);
        let told = imported
            .omissions
            .iter()
            .any(|o| o.kind == kind && o.subject == subject && o.line == line);
        assert!(
            told,
            "{kind} of {subject} in line {line}: {:#?}",
            imported.omissions
        );
        assert!(
            imported.scene.contains(kind) && imported.scene.contains(&format!("(line {line})"))
        );
    }
    let contacts = imported
        .omissions
        .iter()
        .filter(|o| o.kind == "contacts of geoms");
    assert_eq!(contacts.count(), 5);
}

#[test]
fn numbers_keep_their_digits() {
    let imported = imported("mjcf/four-bar.xml");
    let of = |table, name, key| value(&imported.scene, table, name, key).expect("there");
    assert_eq!(of("body", "crank", "centre"), "[0.15, 0.4, 0.0]");
    assert_eq!(of("body", "coupler", "position"), "[0.3, 0.8, 0.0]");
    assert_eq!(of("body", "coupler", "inertia"), "[0.01, 0.2, 0.2]");
    let points = "{ \"crank\" = [0.3, 0.8, 0.0], \"coupler\" = [0.0, 0.0, 0.0] }";
    assert_eq!(of("joint", "B", "points"), points);
    assert_eq!(of("joint", "C", "type"), "\"spherical\"");
}

/// Angles of springs are measured from the pose of the file, at which a joint has the value `ref`.
#[test]
fn springs_dampers_and_armatures() {
    let imported = imported("mjcf/pendulum.xml");
    let of = |table, name, key| value(&imported.scene, table, name, key);
    assert_eq!(
        of("force", "hinge spring", "free_angle").as_deref(),
        Some("0.3")
    );
    assert_eq!(
        of("force", "hinge spring", "damping").as_deref(),
        Some("0.1")
    );
    // The file has springref −0.1 and ref 0.2.
    let free = of("force", "second hinge spring", "free_angle").expect("a spring");
    assert!((free.parse::<f64>().expect("a number") + 0.3).abs() < 1e-15);
    assert_eq!(of("joint", "hinge", "armature").as_deref(), Some("0.05"));
}

/// A joint of the scene may replace two joints of the file, each with its armature.
#[test]
fn armatures_belong_to_joint_coordinates() {
    let imported = imported("mjcf/armatures.xml");
    assert_eq!(imported.armatures, 10);
    let given: Vec<&str> = { imported.scene.lines() }
        .filter_map(|line| line.strip_prefix("armature = "))
        .collect();
    let expected = [
        "2.5",
        "0.7",
        "{ first = 1.3, second = 0.2 }",
        "0.9",
        "{ displacement = 1.7, angle = 0.05 }",
        "0.1",
        "0.2",
        "0.3",
    ];
    assert_eq!(given, expected);
}

/// A box of 0.2 × 0.4 × 0.1 m with 1000 kg/m³ has the mass 8 kg and Jxx = m·(0.4² + 0.1²)/12 in its
/// own axes.
#[test]
fn masses_come_from_geoms() {
    let text = "<mujoco><worldbody><body name='b'><joint/>\
        <geom type='box' size='0.1 0.2 0.05' pos='1 0 0'/></body></worldbody></mujoco>";
    let done = pfaff_import::import("box.xml", text, &Options::default()).expect("imported");
    let of = |key| value(&done.scene, "body", "b", key).expect("there");
    assert!((of("mass").parse::<f64>().expect("a number") - 8.0).abs() < 1e-12);
    assert_eq!(of("centre"), "[1.0, 0.0, 0.0]");
    let inertia = of("inertia");
    let first = inertia
        .trim_start_matches('[')
        .split(',')
        .next()
        .expect("a number");
    let expected = 8.0 * (0.16 + 0.01) / 12.0;
    assert!(
        (first.parse::<f64>().expect("a number") - expected).abs() < 1e-13,
        "{inertia}"
    );
}

#[test]
fn bounds_of_the_compiler_hold() {
    let imported = imported("mjcf/bounds.xml");
    let of = |name, key| value(&imported.scene, "body", name, key).expect("there");
    assert_eq!(of("light", "mass"), "0.1");
    // The moments 0.002, 0.002, 0.01 violate the triangle inequality, and each is replaced by the
    // mean of the three.
    let inertia = of("light", "inertia");
    let numbers: Vec<f64> = inertia
        .trim_matches(['[', ']'])
        .split(", ")
        .map(|x| x.parse().expect("a number"))
        .collect();
    assert!(
        numbers.iter().all(|x| (x - 0.014 / 3.0).abs() < 1e-15),
        "{inertia}"
    );
    // Only the sphere of group 1 counts, and half of its weight is compensated.
    let mass: f64 = of("hung", "mass").parse().expect("a number");
    let sphere = 4000.0 / 3.0 * std::f64::consts::PI * 1e-3;
    assert!((mass - sphere).abs() < 1e-12);
    let force = value(&imported.scene, "force", "held weight of hung", "force").expect("a force");
    let up = force
        .rsplit_once(", ")
        .expect("three")
        .1
        .trim_end_matches(']');
    assert!((up.parse::<f64>().expect("a number") - 0.5 * 9.81 * sphere).abs() < 1e-12);
}

#[test]
fn couplings_are_ones_of_changes() {
    let imported = imported("mjcf/couplings.xml");
    let of = |name, key| value(&imported.scene, "joint", name, key);
    assert_eq!(of("mesh", "ratio").as_deref(), Some("-0.667"));
    assert_eq!(
        of("mesh", "measures").as_deref(),
        Some("[\"sun.angle\", \"planet.angle\"]")
    );
    assert_eq!(
        of("cam", "coefficients").as_deref(),
        Some("[0.05, 0.02, 0.0]")
    );
    assert_eq!(of("bolt", "active").as_deref(), Some("false"));
    // The lever is described at the position that its coupling to the cam requires, rotated by 0.3
    // rad about z.
    let turned = value(&imported.scene, "body", "lever", "orientation").expect("turned");
    let z = turned
        .trim_end_matches("] }")
        .rsplit_once(", ")
        .expect("four")
        .1;
    assert!((z.parse::<f64>().expect("a number") - 0.15_f64.sin()).abs() < 1e-15);
    assert_eq!(
        value(&imported.scene, "drive", "brake", "motion").as_deref(),
        Some("0")
    );
}

#[test]
fn keyframes_are_starts() {
    let file = "mjcf/pendulum.xml";
    let text = text_of(file);
    let at = |name: &str| {
        let keyframe = Some(name.to_owned());
        pfaff_import::import(
            file,
            &text,
            &Options {
                keyframe,
                ..options_of(file)
            },
        )
    };
    let up = at("up").expect("imported");
    let start = value(&up.scene, "body", "rod", "start").expect("a start");
    // The rod is rotated by 0.4 rad about y.
    let expected = format!(
        "quaternion = [{:?}, 0.0, {:?}, 0.0]",
        0.2_f64.cos(),
        0.2_f64.sin()
    );
    assert!(start.contains(&expected), "{start}");
    assert_eq!(
        value(&up.scene, "body", "rod", "angular_velocity").as_deref(),
        Some("[0.0, 1.5, 0.0]")
    );
    read(&up);
    let (code, _, message) = first(&at("down").expect_err("refused"));
    assert_eq!(code, "P0606");
    assert!(message.contains("`up`"), "{message}");
}

/// Springs act on the unwrapped angle. The initial state of a body does not contain full
/// revolutions, and a coupling cannot store them.
#[test]
fn keyframes_beyond_half_a_turn() {
    let text = |equality: &str| {
        format!(
            "<mujoco><compiler angle='radian'/><worldbody>\
             <body name='a'><joint name='j' stiffness='2' springref='0.5'/><geom size='0.1'/></body>\
             <body name='b'><joint name='k'/><geom size='0.1'/></body>\
             </worldbody>{equality}<keyframe><key name='up' qpos='7 0'/></keyframe></mujoco>"
        )
    };
    let keyframe = Some("up".to_owned());
    let options = Options {
        keyframe,
        ..Options::default()
    };
    let done = pfaff_import::import("turns.xml", &text(""), &options).expect("imported");
    let free = value(&done.scene, "force", "j spring", "free_angle").expect("a spring");
    let expected = 0.5 - std::f64::consts::TAU;
    assert!(
        (free.parse::<f64>().expect("a number") - expected).abs() < 1e-14,
        "{free}"
    );
    let coupled = text("<equality><joint joint1='j' joint2='k'/></equality>");
    let refusal = pfaff_import::import("turns.xml", &coupled, &options).expect_err("refused");
    assert_eq!(first(&refusal).0, "P0608");
}

#[test]
fn fixed_links_are_kept_on_request() {
    let file = "mjcf/classes.xml";
    let options = Options {
        fixed: FixedLinks::Kept,
        ..options_of(file)
    };
    let kept = pfaff_import::import(file, &text_of(file), &options).expect("imported");
    assert_eq!(kept.counts, [4, 4]);
    assert_eq!(
        value(&kept.scene, "joint", "nail", "type").as_deref(),
        Some("\"fixed\"")
    );
    read(&kept);
    // After the merge the toe has the mass of both bodies.
    let merged = imported(file);
    let mass = |scene: &str, body| -> f64 {
        value(scene, "body", body, "mass")
            .expect("there")
            .parse()
            .expect("a number")
    };
    let sum = mass(&kept.scene, "toe") + mass(&kept.scene, "nail");
    assert!((mass(&merged.scene, "toe") - sum).abs() < 1e-15);
}

#[test]
fn faults_have_codes_and_lines() {
    let body = |inner: &str| {
        format!("<mujoco>\n<worldbody>\n<body name='b'>\n{inner}\n</body>\n</worldbody>\n</mujoco>")
    };
    for (text, code, line) in [
        (body("<joint type='screw'/>"), "P0605", 4),
        (body("<joint axis='0 0 0'/>"), "P0610", 4),
        (body("<joint axis='0 1'/>"), "P0605", 4),
        (body("<joint axis='0 1 inf'/>"), "P0605", 4),
        (body("<joint axis='0 1 1e99'/>"), "P0605", 4),
        (body("<joint damping='-1'/>"), "P0610", 4),
        (body("<joint class='nobody'/>"), "P0606", 4),
        (body("<inertial mass='1' pos='0 0 0'/>"), "P0604", 4),
        (
            body("<inertial mass='-1' pos='0 0 0' diaginertia='1 1 1'/>"),
            "P0610",
            4,
        ),
        (body("<geom type='box' size='1 1'/>"), "P0604", 4),
        (body("<geom type='box' size='1 -1 1'/>"), "P0610", 4),
        (body("<geom type='ball' size='1'/>"), "P0605", 4),
        (body("<body quat='0 0 0 0'/>"), "P0610", 4),
        (body("<body euler='0 0 1' quat='1 0 0 0'/>"), "P0605", 4),
        (body("<body name='b'/>"), "P0607", 4),
        (body("<body><freejoint/></body>"), "P0609", 4),
        (body("<joint name='j'/><joint name='j'/>"), "P0607", 4),
        (body("<replicate count='3'/>"), "P0608", 4),
        (body("<site name='s'/><site name='s'/>"), "P0607", 4),
        (
            "<mujoco>\n<equality>\n<connect body1='x' anchor='0 0 0'/></equality></mujoco>".into(),
            "P0606",
            3,
        ),
        (
            "<mujoco><compiler\nangle='gradian'/></mujoco>".into(),
            "P0605",
            2,
        ),
        (
            "<mujoco><compiler\ncoordinate='global'/></mujoco>".into(),
            "P0608",
            2,
        ),
        (
            "<mujoco>\n<option><flag gravity='disable' equality='disable'/></option></mujoco>"
                .into(),
            "P0608",
            2,
        ),
    ] {
        let (found, at, message) = first(&refused(&text));
        assert_eq!((found.as_str(), at), (code, line), "{text}: {message}");
    }
}

/// Elements of a file that a scene cannot contain are reported.
#[test]
fn nothing_is_dropped_in_silence() {
    let text = "<mujoco><option density='1.2' timestep='0.01'><flag contact='disable'/></option>
        <worldbody><body name='b'><plugin/>
        <joint type='ball' damping='1' armature='2'/><geom type='mesh' mesh='m'/>
        </body></worldbody><tendon><spatial name='rope'/><fixed name='belt' stiffness='2'/></tendon>
        <actuator><motor name='m'/><position name='p'/><general name='g'/>
        <general name='a' biastype='affine'/></actuator>
        <equality><flex name='off' active='false'/></equality></mujoco>";
    let done = pfaff_import::import("file.xml", text, &Options::default()).expect("imported");
    for (kind, subject) in [
        ("forces of a medium or field", "density"),
        ("settings of MuJoCo's solver", "timestep"),
        ("settings of MuJoCo's solver", "contact"),
        ("plugins", "<plugin> of `b`"),
        ("tendons", "rope"),
        (
            "tendons with springs, dampers, friction or armatures: accelerations differ",
            "belt",
        ),
        ("constraints that are not active", "off, <flex>"),
        ("actuators", "m"),
        ("actuators", "g"),
        (
            "actuators that also act without a signal: accelerations differ",
            "p",
        ),
        (
            "actuators that also act without a signal: accelerations differ",
            "a",
        ),
        (
            "masses of meshes: the body lacks them, give it an <inertial>",
            "",
        ),
        (
            "dampers of spherical joints: accelerations differ while the joints turn",
            "joint 1 of b",
        ),
        (
            "armatures of spherical joints: accelerations differ",
            "joint 1 of b",
        ),
    ] {
        let told = done
            .omissions
            .iter()
            .any(|o| o.kind == kind && o.subject == subject);
        assert!(told, "{kind}: {subject}: {:#?}", done.omissions);
    }
}

/// A keyframe with wrong numbers is an error only if the scene starts there.
#[test]
fn a_keyframe_that_does_not_fit_matters_only_if_it_is_the_start() {
    let text = text_of("mjcf/pendulum.xml");
    let text = text.replace(
        "</keyframe>",
        "<key name='old' qpos='1 2 3 4 5 6 7'/></keyframe>",
    );
    let done = import_text(&text, &options_of("mjcf/pendulum.xml"));
    let left = |o: &pfaff_import::Omission| (o.kind, o.subject.clone());
    let expected = ("keyframes that do not fit the model", "old".to_owned());
    assert!(
        done.omissions.iter().any(|o| left(o) == expected),
        "{:?}",
        done.omissions
    );
    let options = Options {
        keyframe: Some("old".to_owned()),
        ..options_of("mjcf/pendulum.xml")
    };
    let refusal = pfaff_import::import("file.xml", &text, &options).expect_err("refused");
    assert_eq!(first(&refusal).0, "P0605");
}
