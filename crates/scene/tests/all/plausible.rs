//! Tests warnings about numbers that are probably wrong. Each warning has the correct position, a
//! similar plausible number has no warning, and no scene of the repository has a warning.

use std::fs;
use std::path::{Path, PathBuf};

use pfaff_scene::Severity;

use super::read;

/// A crank of 0.2 m and a rod of 0.6 m, as in textbooks.
const CRANK: &str = r#"[scene]
name = "slider-crank"
space = "plane"
gravity = [0.0, -9.81]

[[body]]
name = "crank"
mass = 1.0
inertia = 0.003333
angle = 0.0

[[body]]
name = "rod"
mass = 3.0
inertia = 0.09
position = [0.4, 0.0]

[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "crank"]
at = [-0.1, 0.0]

[[joint]]
name = "B"
type = "revolute"
bodies = ["crank", "rod"]
at = [0.1, 0.0]

[[joint]]
name = "S"
type = "pin-in-slot"
bodies = ["ground", "rod"]
points = { ground = [0.0, 0.0], rod = [0.3, 0.0] }
axis = [1.0, 0.0]

[simulate]
t_end = 2.0
"#;

/// Returns the codes of the warnings, each with the marked text.
fn warned(text: &str) -> Vec<(String, String)> {
    let scene = read(text).unwrap_or_else(|problems| panic!("{text}\n{problems:#?}"));
    let warnings = scene.warnings.iter();
    warnings
        .map(|w| {
            assert_eq!(w.severity, Severity::Warning);
            (w.code.to_string(), text[w.primary.span.clone()].to_owned())
        })
        .collect()
}

/// Returns the scene with one part replaced.
fn with(from: &str, to: &str) -> String {
    assert!(CRANK.contains(from), "{from}");
    CRANK.replacen(from, to, 1)
}

/// A part of the scene, its replacement, and the code and the marked text of the warning, if there
/// is one.
type Case = (
    &'static str,
    &'static str,
    Option<(&'static str, &'static str)>,
);

#[track_caller]
fn check(cases: &[Case]) {
    assert_eq!(warned(CRANK), []);
    for (from, to, expected) in cases {
        let text = with(from, to);
        let expected = expected.map(|(code, mark)| (code.to_owned(), mark.to_owned()));
        assert_eq!(warned(&text), Vec::from_iter(expected), "{to}");
    }
}

#[test]
fn round_angles_beyond_a_turn_look_like_degrees() {
    let degrees = |mark| Some(("P0192", mark));
    const ANGLE: &str = "angle = 0.0";
    check(&[
        (ANGLE, "angle = 45", degrees("45")),
        (ANGLE, "angle = -360.0", degrees("-360.0")),
        (ANGLE, "angle = 10", degrees("10")),
        // These numbers are not multiples of five, are within one revolution in radians, or exceed
        // one revolution in degrees.
        (ANGLE, "angle = 45.3", None),
        (ANGLE, "angle = 12.566370614359172", None),
        (ANGLE, "angle = 5", None),
        (ANGLE, "angle = 365", None),
        // There is no warning about an angular velocity.
        (ANGLE, "angular_velocity = 90", None),
    ]);
    let drive = |motion: &str| {
        format!(
            "{CRANK}\n[[drive]]\nname = \"D\"\njoint = \"A\"\ntype = \"angle\"\nmotion = {motion}\n"
        )
    };
    let table = |values: &str| {
        let times = "type = \"table\", times = [0, 1, 2]";
        warned(&drive(&format!("{{ {times}, values = {values} }}")))
    };
    // The numbers of a list are checked together.
    assert_eq!(
        table("[0, 45, 90]"),
        [("P0192".to_owned(), "45".to_owned())]
    );
    assert_eq!(table("[0, 45, 91.5]"), []);
    // Only the first of the coefficients of 1, t and t² is an angle.
    let polynomial = drive("{ type = \"polynomial\", coefficients = [0, 90, 45] }");
    assert_eq!(warned(&polynomial), []);
}

#[test]
fn units_say_what_an_angle_is() {
    let computed = with("space", "format = 2\nspace");
    let angle = |text: &str| warned(&computed.replacen("angle = 0.0", text, 1));
    assert_eq!(angle("angle = 45").len(), 1);
    assert_eq!(angle("angle = \"9*5\"").len(), 1);
    for meant in ["\"45 deg\"", "\"45 rad\"", "\"15*pi\"", "\"2*45 deg\""] {
        assert_eq!(angle(&format!("angle = {meant}")), [], "{meant}");
    }
    let degrees = "units = { angle = \"deg\" }\nspace";
    let text = with("space", &format!("format = 2\n{degrees}"));
    assert_eq!(warned(&text.replacen("angle = 0.0", "angle = 45", 1)), []);
    // The advice contains the correct text.
    let scene = read(&computed.replacen("angle = 0.0", "angle = 45.0", 1)).expect("a scene");
    let help = scene.warnings[0].help.as_deref().expect("advice");
    assert_eq!(
        help,
        "write `\"45 deg\"`, or `\"45 rad\"` for radians; if it is meant, `silence = [\"P0192\"]` in `[scene]`"
    );
    assert_eq!(
        scene.warnings[0].message,
        "body `crank`: `angle` is 45 rad, which is 7.16197 turns: it looks like degrees"
    );
}

#[test]
fn gravity_is_that_of_a_planet() {
    let gravity = |mark| Some(("P0193", mark));
    const G: &str = "[0.0, -9.81]";
    check(&[
        (G, "[0.0, -9810.0]", gravity("[0.0, -9810.0]")),
        (G, "[9.81e3, 0.0]", gravity("[9.81e3, 0.0]")),
        (G, "[0, -981]", gravity("[0, -981]")),
        (G, "[0, -386.1]", gravity("[0, -386.1]")),
        (G, "[0, -60]", gravity("[0, -60]")),
        // The gravities are those of Jupiter, about twice Jupiter and the Moon, a thousandth of
        // that of the Earth, and zero.
        (G, "[0, -24.79]", None),
        (G, "[0, -49]", None),
        (G, "[0, -1.62]", None),
        (G, "[0, -0.00981]", None),
        (G, "[0, 0]", None),
    ]);
    let said = |text: &str| {
        let scene = read(text).unwrap_or_else(|problems| panic!("{problems:#?}"));
        let [warning] = &scene.warnings[..] else {
            panic!("{:#?}", scene.warnings)
        };
        let help = warning.help.clone().unwrap_or_default();
        let advice = help.split(';').next().unwrap_or_default().to_owned();
        (warning.message.clone(), advice)
    };
    assert_eq!(
        said(&with(G, "[0, -386.1]")),
        (
            "`[scene]`: `gravity` is 386.1 m/s², 39.3712 times that of the Earth: it looks like in/s²".to_owned(),
            "write `gravity = [0, -9.80694]`".to_owned()
        )
    );
    // The same numbers in a scene with lengths in millimetres.
    let scene = |gravity: &str| {
        format!(
            "[scene]\nname = \"mm\"\nspace = \"plane\"\nformat = 2\nunits = {{ length = \"mm\" }}\ngravity = {gravity}\n\n[[body]]\nname = \"a\"\nmass = 1\ninertia = 1\n"
        )
    };
    assert_eq!(warned(&scene("[0, -9810]")), []);
    assert_eq!(warned(&scene("[0, \"-9.81 m/s^2\"]")), []);
    let advice = "write `gravity = [0, -9810]`";
    let (message, help) = said(&scene("[0, -9.81]"));
    assert_eq!(help, advice);
    assert!(
        message.ends_with("numbers without a unit are in mm/s² here"),
        "{message}"
    );
    assert_eq!(said(&scene("[0, \"-9810 m/s^2\"]")).1, advice);
}

#[test]
fn inertia_fits_mass_and_size() {
    let inertia = |mark| Some(("P0194", mark));
    const ROD: &str = "inertia = 0.09";
    check(&[
        // The number is in kg·cm² or in kg·mm², but is read as kg·m².
        (ROD, "inertia = 900.0", inertia("900.0")),
        (ROD, "inertia = 9e4", inertia("9e4")),
        // The radius of gyration is slightly more, and slightly less, than 20 times the arm of 0.3
        // m.
        (ROD, "inertia = 108.1", inertia("108.1")),
        (ROD, "inertia = 107.9", None),
        // The radius of gyration is slightly less, and slightly more, than a thousandth of the arm;
        // the last two cases are a point mass and a body without mass.
        (ROD, "inertia = 2.6e-7", inertia("2.6e-7")),
        (ROD, "inertia = 2.8e-7", None),
        (ROD, "inertia = 0.0", None),
        ("mass = 3.0", "mass = 0.0", None),
        // The mass is given in tonnes.
        ("mass = 3.0", "mass = 0.001", inertia("0.09")),
    ]);
    // The only point of the rotor is near its centre of mass, so the points do not define a size.
    let rotor = "[scene]\nname = \"rotor\"\nspace = \"plane\"\n\n[[body]]\nname = \"rotor\"\nmass = 8.0\ninertia = 0.09\n\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"rotor\"]\nat = [1e-5, 0.0]\n";
    assert_eq!(warned(rotor), []);
    let marked =
        format!("{rotor}\n[[marker]]\nname = \"M\"\nbody = \"rotor\"\npoint = [0.0, 0.0]\n");
    assert_eq!(warned(&marked), []);
}

/// A wheel at the end of an arm; all its points are at its centre of mass.
#[test]
fn a_wheel_has_no_arm_and_is_of_some_material() {
    let scene = |inertia: &str| {
        format!(
            "[scene]\nname = \"mm\"\nspace = \"plane\"\nformat = 2\nunits = {{ length = \"mm\" }}\n\n[[body]]\nname = \"arm\"\nmass = 3\ninertia = 9e4\n\n[[body]]\nname = \"wheel\"\nmass = 22\ninertia = {inertia}\nposition = [300, 0]\n\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"arm\"]\nat = [-300, 0]\n\n[[joint]]\nname = \"B\"\ntype = \"revolute\"\nbodies = [\"arm\", \"wheel\"]\nat = [300, 0]\n"
        )
    };
    // A wheel of 22 kg with a radius of gyration of 0.22 m has 1.1 kg·m²; the last value is small
    // enough for a point mass.
    for meant in ["1.1e6", "\"1.1 kg*m^2\"", "0", "220"] {
        assert_eq!(warned(&scene(meant)), [], "{meant}");
    }
    // If 1.1 is read as kg·mm², the radius of gyration is 0.22 mm. A ball with this inertia has the
    // density 22/(4/3·π·(0.2236e-3·√2.5)³) kg/m³.
    let found = read(&scene("1.1")).expect("a scene");
    let [warning] = &found.warnings[..] else {
        panic!("{:#?}", found.warnings)
    };
    let radius = (1.1e-6_f64 / 22.0).sqrt();
    let ball = radius * 2.5_f64.sqrt();
    let density = 22.0 / (4.0 / 3.0 * std::f64::consts::PI * ball.powi(3));
    let density = model::words::rounded(density);
    assert_eq!(
        warning.message,
        format!(
            "body `wheel`: with its mass of 22 kg the inertia has a radius of gyration of {:.4} mm, as a ball of {density} kg/m³ has",
            1e3 * radius
        )
    );
}

#[test]
fn units_do_not_change_what_is_plausible() {
    // The rod in a scene with millimetres: 90 kg·mm² would be 0.00009 kg·m².
    let scene = |inertia: &str| {
        format!(
            "[scene]\nname = \"mm\"\nspace = \"plane\"\nformat = 2\nunits = {{ length = \"mm\" }}\n\n[[body]]\nname = \"rod\"\nmass = 3\ninertia = {inertia}\n\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"rod\"]\nat = [\"-30 cm\", 0]\n\n[[joint]]\nname = \"B\"\ntype = \"pin-in-slot\"\nbodies = [\"ground\", \"rod\"]\npoints = {{ ground = [0, 0], rod = [300, 0] }}\naxis = [1, 0]\n"
        )
    };
    for meant in ["9e4", "\"0.09 kg*m^2\"", "\"900 kg*cm^2\""] {
        assert_eq!(warned(&scene(meant)), [], "{meant}");
    }
    // The value was meant in kg·m².
    let found = read(&scene("0.09")).expect("a scene");
    let [warning] = &found.warnings[..] else {
        panic!("{:#?}", found.warnings)
    };
    assert_eq!(
        warning.message,
        "body `rod`: with its mass of 3 kg the inertia has a radius of gyration of 0.1732 mm, and points of the body are up to 0.3 m from its centre of mass"
    );
    let help = warning.help.as_deref().unwrap_or_default();
    assert!(
        help.contains("in kg·mm²: a rod twice as long has 90000 kg·mm²;"),
        "{help}"
    );
}

#[test]
fn a_measure_within_one_body_never_changes() {
    let warned = |markers: &str| {
        let marker = |name: &str, body: &str| {
            format!("\n[[marker]]\nname = \"{name}\"\nbody = \"{body}\"\npoint = [0.0, 0.1]\n")
        };
        let places = [
            marker("P", "rod"),
            marker("Q", "rod"),
            marker("R", "crank"),
            marker("W", "ground"),
        ];
        let text = format!(
            "{CRANK}{}\n[[measure]]\nname = \"m\"\ntype = \"angle\"\nmarkers = {markers}\n",
            places.concat()
        );
        warned(&text)
    };
    for constant in ["[\"P\", \"Q\"]", "[\"ground\", \"W\"]", "[\"W\"]"] {
        assert_eq!(
            warned(constant),
            [("P0198".to_owned(), constant.to_owned())]
        );
    }
    for moving in ["[\"P\", \"R\"]", "[\"P\"]", "[\"W\", \"Q\"]"] {
        assert_eq!(warned(moving), [], "{moving}");
    }
}

#[test]
fn bodies_without_joints_beside_others_are_told() {
    let weight = "[[body]]\nname = \"weight\"\nmass = 1.0\ninertia = 0.0\nposition = [0.0, -1.0]\n";
    let text = format!("{CRANK}\n{weight}");
    let told = || vec![("P0195".to_owned(), "\"weight\"".to_owned())];
    assert_eq!(warned(&text), told());
    // A force does not constrain the body, but a joint does, even if it is inactive.
    let spring = "\n[[force]]\nname = \"F\"\ntype = \"spring-damper\"\nbodies = [\"ground\", \"weight\"]\nat = [[0.0, 0.0], [0.0, -1.0]]\nstiffness = 1.0\ndamping = 0.0\n";
    assert_eq!(warned(&format!("{text}{spring}")), told());
    let joint = "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"weight\"]\nat = [0.0, 0.0]\n";
    assert_eq!(warned(&format!("{text}{joint}")), []);
    assert_eq!(warned(&format!("{text}{joint}active = false\n")), []);
    // In a scene without joints, bodies without a joint are intended.
    let free = format!("[scene]\nname = \"free\"\nspace = \"plane\"\n\n{weight}{spring}");
    assert_eq!(warned(&free), []);
    let messages = |text: &str| {
        let scene = read(text).expect("a scene");
        scene.warnings[0].message.clone()
    };
    assert_eq!(
        messages(&text),
        "no joint supports body `weight`: it moves freely"
    );
    assert_eq!(
        messages(&format!("{text}{spring}")),
        "no joint supports body `weight`: it moves under one force"
    );
}

#[test]
fn a_joint_a_hundred_sizes_away_is_told() {
    let far = |mark| Some(("P0196", mark));
    const AT: &str = "points = { ground = [0.0, 0.0], rod = [0.3, 0.0] }";
    // The arms are 0.1, 0.1 and 0.3, and the radii of gyration are 0.058 and 0.173. With a larger
    // fourth arm, the upper median is 0.173.
    const MM: &str = "{ ground = [0.0, 0.0], rod = [300.0, 0.0] }";
    const OUT: &str = "{ ground = [0.0, 0.0], rod = [17.4, 0.0] }";
    check(&[
        (
            AT,
            "points = { ground = [0.0, 0.0], rod = [300.0, 0.0] }",
            far(MM),
        ),
        (
            AT,
            "points = { ground = [0.0, 0.0], rod = [17.4, 0.0] }",
            far(OUT),
        ),
        (
            AT,
            "points = { ground = [0.0, 0.0], rod = [17.2, 0.0] }",
            None,
        ),
        // Points on the ground do not define a size.
        (
            AT,
            "points = { ground = [9e5, 0.0], rod = [0.3, 0.0] }",
            None,
        ),
    ]);
    let scene = read(&with(AT, &format!("points = {MM}"))).expect("a scene");
    assert_eq!(
        scene.warnings[0].message,
        "joint `S` is 300 m from the centre of mass of body `rod`, 1732.05 times the size of this mechanism, 0.1732 m"
    );
    // Far from the origin, the distances between the points are the same.
    let moved = "position = [1000000.4, 0.0]";
    let text = with("position = [0.4, 0.0]", moved);
    let text = text.replacen("angle = 0.0", "position = [1e6, 0.0]", 1);
    let text = text.replacen("at = [-0.1, 0.0]", "at = [999999.9, 0.0]", 1);
    let text = text.replacen("at = [0.1, 0.0]", "at = [1000000.1, 0.0]", 1);
    assert_eq!(warned(&text), []);
}

#[test]
fn rows_lie_within_the_run() {
    let step = |mark| Some(("P0197", mark));
    const END: &str = "t_end = 2.0";
    check(&[
        (END, "t_end = 2.0\noutput_step = 2.5", step("2.5")),
        (END, "t_end = 2.0\noutput_step = 2.0", None),
        (END, "t_end = 0.0\noutput_step = 2.0", None),
    ]);
}

/// The weight of both bodies is (1 + 3)·9.81 N = 39.24 N.
#[test]
fn a_force_of_a_hundred_weights_is_reported() {
    let push = |name: &str, force: &str| {
        format!(
            "\n[[force]]\nname = \"{name}\"\ntype = \"point-force\"\nbody = \"rod\"\npoint = [0.0, 0.0]\nforce = {force}\n"
        )
    };
    let of = |force: &str| warned(&format!("{CRANK}{}", push("F", force)));
    for heavy in [
        "[3925.0, 0.0]",
        "[-2775.0, 2775.0]", // 3924.4 N, and each component alone is below the limit
        "[0.0, { type = \"steps\", steps = [{ from = 0.5, to = 0.9, by = 4e3 }, { from = 0.9, to = 1.0, by = -4e3 }] }]",
        "[0.0, { type = \"harmonic\", amplitude = 4100.0, omega = 6.283185307179586 }]",
        "[{ type = \"constant-rate\", rate = 2e3 }, 0.0]",
        "[{ type = \"table\", times = [0, 0.501, 2], values = [0, 4e3, 0] }, 0.0]",
    ] {
        assert_eq!(of(heavy), [("P0188".to_owned(), heavy.to_owned())]);
    }
    for light in [
        "[3923.0, 0.0]",
        "[-2774.0, 2774.0]",
        "[{ type = \"constant-rate\", rate = 1.9e3 }, 0.0]",
        "[0.0, { type = \"harmonic\", amplitude = 3900.0, omega = 6.283185307179586 }]",
    ] {
        assert_eq!(of(light), [], "{light}");
    }
    // Torques have no weight to be compared with, and without gravity no force has one.
    let torque = "\n[[force]]\nname = \"T\"\ntype = \"torque\"\nbody = \"rod\"\ntorque = 1e9\n";
    assert_eq!(warned(&format!("{CRANK}{torque}")), []);
    let floating = with("gravity = [0.0, -9.81]", "");
    let heavy = push("F", "[1e9, 0.0]");
    assert_eq!(warned(&format!("{floating}{heavy}")), []);
    assert_eq!(warned(&format!("{CRANK}{heavy}active = false\n")), []);
    // Many forces are one warning, and its advice and its code end it.
    let many: Vec<String> = (0..20)
        .map(|k| push(&format!("F{k}"), "[5e6, 0.0]"))
        .collect();
    let text = format!("{CRANK}{}", many.concat());
    let scene = read(&text).expect("a scene");
    let [warning] = &scene.warnings[..] else {
        panic!("{:#?}", scene.warnings)
    };
    assert_eq!(
        warning.message,
        "force `F0` reaches 5000000 N, 127421 times the weight of the mechanism, 39.24 N (and 19 more like this)"
    );
    assert_eq!(
        warning.help.as_deref(),
        Some(
            "write the force in N, or the masses in kg: numbers without a unit are in these units; if it is meant, `silence = [\"P0188\"]` in `[scene]`"
        )
    );
    let computed = text.replacen("space", "format = 2\nspace", 1);
    assert_eq!(warned(&computed.replace("5e6", "\"0.5 kN\"")), []);
    let silent = text.replacen("space", "silence = [\"P0188\"]\nspace", 1);
    assert_eq!(warned(&silent), []);
}

/// The ends of the spring are 0.6 m apart: (−0.2, 0) and (0.4, 0).
#[test]
fn a_spring_of_ten_free_lengths_is_reported() {
    let spring = |name: &str, free: &str| {
        format!(
            "\n[[force]]\nname = \"{name}\"\ntype = \"spring-damper\"\nbodies = [\"ground\", \"rod\"]\nat = [[-0.2, 0.0], [0.4, 0.0]]\nstiffness = 100.0\ndamping = 0.0\n{free}\n"
        )
    };
    let of = |free: &str| warned(&format!("{CRANK}{}", spring("K", free)));
    assert_eq!(
        of("free_length = 0.0599"),
        [("P0189".to_owned(), "0.0599".to_owned())]
    );
    for meant in [
        "",
        "free_length = 0.0601",
        "free_length = 0.0",
        "free_length = 600.0",
        "free_length = 1e-9\nactive = false",
    ] {
        assert_eq!(of(meant), [], "{meant}");
    }
    // Many springs are one warning. The advice was followed: without the key there is no warning.
    let free = "free_length = 6e-4";
    let many: Vec<String> = (0..20).map(|k| spring(&format!("K{k}"), free)).collect();
    let text = format!("{CRANK}{}", many.concat());
    let scene = read(&text).expect("a scene");
    let [warning] = &scene.warnings[..] else {
        panic!("{:#?}", scene.warnings)
    };
    assert_eq!(
        warning.message,
        "force `K0`: `free_length` is 0.6 mm, but at the start its ends are 0.6 m apart, 1000 times as far (and 19 more like this)"
    );
    assert_eq!(
        warning.help.as_deref(),
        Some(
            "numbers without a unit are in m: correct `free_length`, or leave it out for the length at the start; if it is meant, `silence = [\"P0189\"]` in `[scene]`"
        )
    );
    assert_eq!(warned(&text.replace(free, "")), []);
    // At the start, the rod is closer to the ground than in its described pose, or farther away.
    let starting = |x: f64, free: &str| {
        let rod = with(
            "position = [0.4, 0.0]",
            &format!("position = [0.4, 0.0]\nstart = {{ position = [{x:?}, 0.0] }}"),
        );
        warned(&format!("{rod}{}", spring("K", free))).len()
    };
    assert_eq!(starting(-0.1, "free_length = 0.0599"), 0);
    assert_eq!(starting(0.5, "free_length = 0.0601"), 1);
    // In space, and in a scene in millimetres.
    let space = "[scene]\nname = \"s\"\nspace = \"spatial\"\nformat = 2\nunits = { length = \"mm\" }\n\n[[body]]\nname = \"a\"\nmass = 1\ninertia = [9e3, 9e3, 9e3]\nposition = [0, 0, 300]\n\n[[force]]\nname = \"S\"\ntype = \"spring-damper\"\nbodies = [\"ground\", \"a\"]\nat = [[0, 0, 0], [0, 0, 300]]\nstiffness = 1\ndamping = 0\nfree_length = \"25 µm\"\n";
    assert_eq!(
        warned(space),
        [("P0189".to_owned(), "\"25 µm\"".to_owned())]
    );
    assert_eq!(warned(&space.replace("25 µm", "31 mm")), []);
}

/// Finds the files below a folder whose names have this ending.
/// A planet between a sun in the housing and a ring that is the housing.
const PLANET: &str = r#"
scene = { name = "planet", space = "plane" }
body = [
    { name = "sun", mass = 1.0, inertia = 0.01 },
    { name = "arm", mass = 1.0, inertia = 0.1 },
    { name = "planet", mass = 1.0, inertia = 0.01, position = [0.2, 0.0] },
]
joint = [
    { name = "input", type = "revolute", bodies = ["ground", "sun"], at = [0.0, 0.0] },
    { name = "output", type = "revolute", bodies = ["ground", "arm"], at = [0.0, 0.0] },
    { name = "pin", type = "revolute", bodies = ["planet", "arm"], at = [0.2, 0.0] },
    { name = "inner", type = "mesh", bodies = ["sun", "planet"], carrier = "arm", at = [[0.0, 0.0], [0.2, 0.0]], ratio = -1.0 },
    { name = "outer", type = "mesh", bodies = ["planet", "ground"], carrier = "arm", at = [[0.2, 0.0], [0.0, 0.0]], ratio = 0.3333 },
]
"#;

#[test]
fn the_carrier_of_a_mesh_is_where_its_wheels_turn() {
    assert_eq!(warned(PLANET), []);
    let ground = PLANET.replacen("carrier = \"arm\", ", "", 1);
    let expected = [("P0187".to_owned(), "[\"sun\", \"planet\"]".to_owned())];
    assert_eq!(warned(&ground), expected);
    let scene = read(&ground).expect("a scene");
    assert_eq!(
        scene.warnings[0].message,
        "mesh `inner` measures the angles of its wheels from `ground`, but `planet` turns on `arm`"
    );
    // The planet does not turn on the sun either.
    let sun = PLANET.replacen(
        "carrier = \"arm\", at = [[0.2",
        "carrier = \"sun\", at = [[0.2",
        1,
    );
    assert_eq!(warned(&sun), [("P0187".to_owned(), "\"sun\"".to_owned())]);
    // A centre that no pin holds may move.
    let free = ground.replacen(
        "name = \"pin\", type = \"revolute\"",
        "name = \"pin\", type = \"fixed\"",
        1,
    );
    assert_eq!(warned(&free), []);
}

fn files(folder: &Path, end: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, end, found);
        } else if path.extension().is_some_and(|e| e == end) {
            found.push(path);
        }
    }
}

/// Reads all scenes in files and in pages: examples and templates, and the scenes of the suite and
/// of the tests. The implausible scenes of `crates/lab/found` are excluded, because they were found
/// by programs.
#[test]
fn no_scene_of_the_repository_has_a_warning() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut texts: Vec<(PathBuf, String)> = Vec::new();
    for folder in [
        "examples",
        "docs",
        "crates/suite",
        "crates/robot-trolley",
        "crates/pfaff-cli",
    ] {
        for end in ["toml", "md"] {
            let mut found = Vec::new();
            files(&root.join(folder), end, &mut found);
            found.sort();
            for path in found {
                let text = fs::read_to_string(&path).unwrap_or_default();
                let blocks: Vec<String> = match end {
                    // The first line of a code block contains its language.
                    "md" => {
                        let blocks = text.split("```").skip(1).step_by(2);
                        let inside = blocks.filter_map(|block| block.split_once('\n'));
                        inside.map(|(_, block)| block.to_owned()).collect()
                    }
                    _ => vec![text],
                };
                texts.extend(blocks.into_iter().map(|block| (path.clone(), block)));
            }
        }
    }
    let mut n_read = 0;
    for (path, text) in texts {
        // The page of error codes contains a scene for each code.
        if path.ends_with("docs/book/errors.md") {
            continue;
        }
        let Ok(scene) = read(&text) else { continue };
        n_read += 1;
        assert_eq!(scene.warnings, [], "{}", path.display());
    }
    // The scenes include at least the 20 examples, 13 of the suite, the robot, and some in pages.
    assert!(n_read >= 60, "{n_read}");
}
