//! Tests format 2 with expressions, parameters and units; every error has a position inside the
//! text.

use std::f64::consts::{FRAC_PI_6, PI};

use joints::{Pose, Twist};
use model::BodyRef;
use pfaff_scene::{Diagnostic, Scene};
use proptest::prelude::*;

use super::read;

/// A crank with parameters, in millimetres and degrees.
const CRANK: &str = r#"[scene]
name = "crank"
space = "plane"
format = 2
units = { length = "mm", angle = "deg" }
gravity = [0, -9810]

[parameters]
L = 300.1
phi = 30
m1 = "L/100 * 250 g/(1 mm) * 1 mm"
tip = "25 mm + L"
spring = "2 N/mm"

[[body]]
name = "crank"
mass = "m1/(L/100)"
inertia = "2e4"
position = ["L*cos(phi)", "L*sin(phi)"]
angle = "phi"
angular_velocity = "1 rad/s + 90 deg/s"
tolerance = 0.1

[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "crank"]
at = [0.0, 0.0]

[[drive]]
name = "D"
joint = "A"
type = "angle"
motion = { type = "steps", steps = [{ from = 0, to = "500 ms", by = "phi/2" }] }

[[force]]
name = "S"
type = "spring-damper"
bodies = ["ground", "crank"]
points = { ground = [0, "tip"], crank = ["-tip", "0 m"] }
stiffness = "spring"
damping = 0.5

[simulate]
t_end = "2 s"
"#;

fn crank() -> Scene {
    read(CRANK).unwrap_or_else(|problems| panic!("{problems:#?}"))
}

/// The expected numbers were derived by hand, in metres and radians.
#[test]
fn numbers_mean_what_their_units_say() {
    let scene = crank();
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let d = scene.description.plane().expect("a planar scene").clone();
    let body = &d.bodies[0];
    let near = |found: f64, expected: f64| {
        let bound = 2.0 * f64::EPSILON * expected.abs();
        assert!((found - expected).abs() <= bound, "{found} {expected}");
    };
    assert_eq!(d.gravity, [0.0, -9.81]);
    assert_eq!(body.mass, 0.25);
    assert_eq!(body.inertia, 0.02);
    near(body.position[0], 0.259_894_223_675_71); // 0.3001·√3/2
    near(body.position[1], 0.150_05);
    near(body.angle, FRAC_PI_6);
    near(
        body.angular_velocity.expect("given"),
        2.570_796_326_794_896_6,
    );
    assert_eq!(body.tolerance, Some(1e-4));
    assert_eq!(d.joints[0].bodies, [BodyRef::Ground, BodyRef::Body(0)]);
    let [half_way, ..] = d.drives[0].motion.jet(0.25);
    near(half_way, 0.130_899_693_899_574_73); // half of 15°
    assert_eq!(scene.simulate.expect("a run").t_end, 2.0);
}

/// The same scene in metres and radians, with numbers only, in the old format.
#[test]
fn a_scene_in_millimetres_is_that_in_metres() {
    let replaced = [
        (
            "format = 2\nunits = { length = \"mm\", angle = \"deg\" }\n",
            "",
        ),
        ("-9810", "-9.81"),
        ("\"m1/(L/100)\"", "0.25"),
        ("\"2e4\"", "0.02"),
        (
            "[\"L*cos(phi)\", \"L*sin(phi)\"]",
            "[0.25989422367571, 0.15005]",
        ),
        ("angle = \"phi\"", "angle = 0.5235987755982989"),
        ("\"1 rad/s + 90 deg/s\"", "2.5707963267948966"),
        ("tolerance = 0.1", "tolerance = 1e-4"),
        (
            "\"500 ms\", by = \"phi/2\"",
            "0.5, by = 0.26179938779914946",
        ),
        (
            "[0, \"tip\"], crank = [\"-tip\", \"0 m\"]",
            "[0, 0.3251], crank = [-0.3251, 0]",
        ),
        ("\"spring\"", "2000"),
        ("damping = 0.5", "damping = 500"),
        ("\"2 s\"", "2"),
    ];
    let mut text = CRANK.to_owned();
    let parameters =
        text.find("[parameters]").expect("there")..text.find("[[body]]").expect("there");
    text.replace_range(parameters, "");
    for (from, to) in replaced {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let (new, old) = (
        crank(),
        read(&text).unwrap_or_else(|p| panic!("{text}\n{p:#?}")),
    );
    let show = |scene: &Scene| {
        let d = scene.description.plane().expect("a planar scene").clone();
        let x = [Pose::GROUND, Pose::new(0.3, -0.2, 0.7)];
        let v = [
            Twist::zero(),
            Twist {
                x: 1.0,
                y: 2.0,
                omega: 3.0,
            },
        ];
        let (mut phi, mut q) = ([f64::NAN; 2], [f64::NAN; 6]);
        d.joints[0].element.phi(&x, &[], &mut phi);
        let spring = &d.forces[0].element;
        spring.q(&x, &v, &[], &mut q[..spring.spec().q.len()]);
        let motion = &d.drives[0].motion;
        format!(
            "{:?} {phi:?} {q:?} {motion:?} {:?}",
            d.bodies, scene.simulate
        )
    };
    assert_eq!(show(&new), show(&old));
}

/// Returns for a problem the marked text, the message, and the text of the mark with the advice.
fn said(text: &str, problem: &Diagnostic) -> [String; 3] {
    let marked = text[problem.primary.span.clone()].to_owned();
    let help = problem.help.clone().unwrap_or_default();
    let advice = format!("{} | {help}", problem.primary.text);
    [marked, problem.message.clone(), advice]
}

#[test]
fn every_fault_has_its_place_inside_of_the_text() {
    for (from, to, expected) in [
        (
            "\"L*cos(phi)\"",
            "\"L*cos(phy)\"",
            [
                "phy",
                "body `crank`: `position`: there is no parameter `phy`",
                "did you mean `phi`? | ",
            ],
        ),
        (
            "\"L*cos(phi)\"",
            "\"L*cosinus(phi)\"",
            [
                "cosinus",
                "body `crank`: `position`: there is no function `cosinus`",
                "no such function | the parameters are `L`, `m1`, `phi`, `spring`, `tip`",
            ],
        ),
        (
            "angle = \"phi\"",
            "angle = \"pi/6\"",
            [
                "pi/6",
                "body `crank`: `angle`: a number with `pi` is an angle here, but angles without a unit are not in radians",
                "needs its unit | write `*rad` behind it, or write the angle in the unit that `units` states",
            ],
        ),
        (
            "\"L*cos(phi)\"",
            "\"L*cos(pi/3)\"",
            [
                "pi/3",
                "body `crank`: `position`: a number with `pi` is an angle here, but angles without a unit are not in radians",
                "needs its unit | write `*rad` behind it, or write the angle in the unit that `units` states",
            ],
        ),
        (
            "angle = \"phi\"",
            "angle = \"25 mm\"",
            [
                "25 mm",
                "body `crank`: `angle`: found a length (m), need an angle (rad)",
                "another unit is needed | its units are `deg`, `rad`",
            ],
        ),
        (
            "inertia = \"2e4\"",
            "inertia = \"2 kg*m\"",
            [
                "2 kg*m",
                "body `crank`: `inertia`: found a quantity (kg·m), need a moment of inertia (kg·m²)",
                "another unit is needed | write its unit, as `2 kg·m²`",
            ],
        ),
        (
            "\"L*sin(phi)\"",
            "\"L/(phi - 30)\"",
            [
                "(phi - 30)",
                "body `crank`: `position`: division by zero",
                "is zero | ",
            ],
        ),
        (
            "by = \"phi/2\"",
            "by = \"phi/2 m\"",
            [
                "phi/2 m",
                "drive `D`: `motion`: `steps`: `by`: found a quantity (1/m), need an angle (rad)",
                "another unit is needed | its units are `deg`, `rad`",
            ],
        ),
        (
            "t_end = \"2 s\"",
            "t_end = \"2 s + 1 deg\"",
            [
                "2 s + 1 deg",
                "`[simulate]`: `t_end`: a time (s) and an angle (rad) have no sum, difference or order",
                "units that do not fit | write both with units of one kind",
            ],
        ),
        (
            "t_end = \"2 s\"",
            "t_end = '''2 s (1'''",
            [
                "(",
                "`[simulate]`: `t_end`: a bracket is never closed",
                "opens here | write `)` where its content ends",
            ],
        ),
        (
            "stiffness = \"spring\"",
            "stiffness = \"-spring\"",
            [
                "\"-spring\"",
                "force `S`: `stiffness` is -2000, need a number ≥ 0",
                "may not be negative | ",
            ],
        ),
        (
            "tip = \"25 mm + L\"",
            "tip = \"25 mm + 2 L\"",
            [
                "L",
                "`[parameters]`: `tip`: an operator is missing before `L`",
                "write an operator before this | to multiply, write `*L`",
            ],
        ),
        (
            "tip = \"25 mm + L\"",
            "tip = [1, 2]",
            [
                "[1, 2]",
                "`[parameters]`: `tip` must be a number or an expression, found a list of 2 values",
                "expected a number or an expression | ",
            ],
        ),
        (
            "L = 300.1",
            "L = 300.1\nsin = 9.81\ng = \"sin + 2*sin\"",
            [
                "sin",
                "the parameter `sin` has the same name as a function",
                "choose another name | for example `sin_1`",
            ],
        ),
        (
            "L = 300.1",
            "L = 300.1\n\"2L\" = 1",
            [
                "\"2L\"",
                "the parameter \"2L\" has a name that expressions cannot contain",
                "choose another name | names have letters, digits and `_`, and begin with no digit",
            ],
        ),
        (
            "spring = \"2 N/mm\"",
            "spring = \"2*spring\"",
            [
                "spring",
                "the parameter `spring` depends on itself",
                "closes the circle | give one of them a value without the others",
            ],
        ),
        (
            "phi = 30",
            "phi = \"psi/2\"\npsi = \"phi*2\"",
            [
                "psi",
                "the parameters `phi` → `psi` → `phi` depend on each other",
                "closes the circle | give one of them a value without the others",
            ],
        ),
        (
            "length = \"mm\"",
            "length = \"inch\"",
            [
                "\"inch\"",
                "`[scene]`: `units`: `length` must be a unit of length, found `inch`",
                "no such unit | did you mean `in`?",
            ],
        ),
        (
            "format = 2",
            "format = 3",
            [
                "3",
                "`[scene]`: `format` is 3, need 1 or 2",
                "no such format | ",
            ],
        ),
    ] {
        assert!(CRANK.contains(from), "{from}");
        let text = CRANK.replacen(from, to, 1);
        let problems = read(&text).expect_err(to);
        let found: Vec<_> = problems.iter().map(|p| said(&text, p)).collect();
        assert_eq!(found.len(), 1, "{to}: {found:#?}");
        let [marked, message, advice] = &found[0];
        assert_eq!([marked.as_str(), message, advice], expected, "{to}");
    }
}

/// A name that is refused is one error, however often expressions contain it.
#[test]
fn a_refused_name_is_one_error() {
    for (name, used) in [
        ("2L", "2L"),
        ("a-b", "a-b"),
        ("k%", "k%"),
        ("end-", "end-"),
        ("sin", "sin"),
        ("pi", "pi"),
        ("L M", "L M"),
    ] {
        let uses: Vec<String> = (0..30)
            .map(|k| format!("x{k} = \"{k} + 3*{used}\"\ny{k} = \"{used} - L\"\n"))
            .collect();
        let parameters = format!("L = 300.1\n\"{name}\" = 2\n{}", uses.concat());
        let text = CRANK.replacen("L = 300.1\n", &parameters, 1).replacen(
            "damping = 0.5",
            &format!("damping = \"{used}*2\""),
            1,
        );
        let problems = read(&text).expect_err(name);
        let marked: Vec<&str> = problems
            .iter()
            .map(|p| text[p.primary.span.clone()].trim_matches('"'))
            .collect();
        assert_eq!(marked, [name], "{problems:#?}");
    }
    // Other errors of the same expression remain.
    let text = CRANK
        .replacen("L = 300.1\n", "L = 300.1\n\"2L\" = 2\n", 1)
        .replacen("damping = 0.5", "damping = \"zeta + 0*2L\"", 1)
        .replacen("\"2e4\"", "\"eta + 2 L\"", 1);
    let problems = read(&text).expect_err("three errors");
    let marked: Vec<&str> = problems
        .iter()
        .map(|p| &text[p.primary.span.clone()])
        .collect();
    assert_eq!(marked, ["\"2L\"", "eta", "L", "zeta"]);
}

/// The numbers were computed by hand: m·g = 2·9.5 N, and so on.
#[test]
fn symbols_of_textbooks_are_parameters() {
    let text = CRANK
        .replacen(
            "L = 300.1\n",
            "L = 300.1\nm = \"2 kg\"\ng = \"9.5 m/s^2\"\nN = \"m*g\"\ns = \"N/(1 kN)\"\n",
            1,
        )
        .replacen("mass = \"m1/(L/100)\"", "mass = \"m + 500 g\"", 1)
        .replacen("t_end = \"2 s\"", "t_end = \"s*1000 s + N/(1 N)*1 s\"", 1);
    let scene = read(&text).unwrap_or_else(|p| panic!("{p:#?}"));
    let d = scene.description.plane().expect("a planar scene").clone();
    assert_eq!(d.bodies[0].mass, 2.5);
    assert_eq!(scene.simulate.expect("a run").t_end, 38.0);
}

/// Both characters for the prefix micro are accepted as the unit of the scene.
#[test]
fn lengths_may_be_in_micrometres() {
    for micro in ['\u{b5}', '\u{3bc}'] {
        let units = format!("length = \"{micro}m\"");
        let text = CRANK.replacen("length = \"mm\"", &units, 1);
        let text = text.replacen("-9810", "-9.81e6", 1);
        let scene = read(&text).unwrap_or_else(|p| panic!("{p:#?}"));
        let d = scene.description.plane().expect("a planar scene").clone();
        assert_eq!(d.bodies[0].inertia, 2e-8);
        assert_eq!(scene.units.length, "\u{b5}m");
    }
}

/// The value with two derivatives of the motion of the crank, whose units are mm and deg.
fn motion_of(text: &str) -> impl Fn(f64) -> [f64; 3] {
    let motion = format!("motion = \"{text}\"");
    let text = CRANK.replacen(STEPS, &motion, 1);
    let scene = read(&text).unwrap_or_else(|p| panic!("{text}\n{p:#?}"));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let d = scene.description.plane().expect("a planar scene").clone();
    move |t| d.drives[0].motion.jet(t)
}

const STEPS: &str =
    "motion = { type = \"steps\", steps = [{ from = 0, to = \"500 ms\", by = \"phi/2\" }] }";

/// Expressions of the time, with closed forms that were derived by hand. Numbers without a unit are
/// in degrees here, so that `6*t` in a sine is 6 deg/s·t.
#[test]
fn functions_of_time_may_be_expressions() {
    let degree = PI / 180.0;
    for t in [0.0_f64, 0.3, 1.7] {
        let (sin, cos) = (6.0 * t).sin_cos();
        let (slow, slower) = (6.0 * degree * t).sin_cos();
        let w = 6.0 * degree;
        let (up, down) = (PI * t).sin_cos();
        let wave = [90.0 * up, 90.0 * PI * down, -90.0 * PI * PI * up].map(|x| x * degree);
        for (text, expected) in [
            ("30*t", [30.0 * t, 30.0, 0.0].map(|x| x * degree)),
            ("30 deg/s*t", [30.0 * t, 30.0, 0.0].map(|x| x * degree)),
            (
                "2 + 4*t^3",
                [2.0 + 4.0 * t.powi(3), 12.0 * t * t, 24.0 * t].map(|x| x * degree),
            ),
            (
                "phi*sin(6 rad/s*t)",
                [30.0 * sin, 180.0 * cos, -1080.0 * sin].map(|x| x * degree),
            ),
            ("sin(pi*t*rad)*90", wave),
            ("sin(2*pi*rad*t/2)*90", wave),
            ("sin(6*t)*1 rad", [slow, w * slower, -w * w * slow]),
            (
                "sin(6*t)",
                [slow, w * slower, -w * w * slow].map(|x| x * degree),
            ),
        ] {
            let found = motion_of(text)(t);
            for (found, expected) in found.iter().zip(expected) {
                let bound = 1e-14 * expected.abs().max(1.0);
                assert!(
                    (found - expected).abs() <= bound,
                    "{text}: {found} {expected}"
                );
            }
        }
    }
}

/// Each error of an expression of the time is at its position, and states the correction.
#[test]
fn faults_of_functions_of_time_have_their_places() {
    for (motion, expected) in [
        (
            "phi*sin(t)",
            [
                "t",
                "found a time (s), need an angle (rad)",
                "another unit is needed | its units are `deg`, `rad`",
            ],
        ),
        (
            "sin(2*pi*t)*90",
            [
                "2*pi*t",
                "a number with `pi` is an angle here, but angles without a unit are not in radians",
                "needs its unit | write `*rad` behind it, or write the angle in the unit that `units` states",
            ],
        ),
        (
            "pi*t",
            [
                "pi*t",
                "a number with `pi` is an angle here, but angles without a unit are not in radians",
                "needs its unit | write `*rad` behind it, or write the angle in the unit that `units` states",
            ],
        ),
        (
            "exp(t)*1 deg",
            [
                "t",
                "found a time (s), need a number without a unit",
                "another unit is needed | divide it by its unit, as `/(1 s)`",
            ],
        ),
        (
            "2*t + zeta",
            [
                "zeta",
                "there is no parameter `zeta`",
                "no such parameter | the variables are `t`, the parameters are `L`, `m1`, `phi`, `spring`, `tip`",
            ],
        ),
        (
            "abs(2*t - 1)",
            [
                "\"abs(2*t - 1)\"",
                "`motion` prescribes a motion, so it cannot contain `abs`, `min`, `max` or `atan2` of the time",
                "has kinks or jumps | write a function of time of the type `steps` or `linear-table`",
            ],
        ),
        (
            "(2*t)^1.5*1",
            [
                "\"(2*t)^1.5*1\"",
                "`motion` has no second derivative at t = 0 s",
                "not a number at the start | write an expression that is defined from the start to the end of the run",
            ],
        ),
        (
            "sqrt(2*t)",
            [
                "\"sqrt(2*t)\"",
                "`motion` has no rate at t = 0 s",
                "not a number at the start | write an expression that is defined from the start to the end of the run",
            ],
        ),
        (
            "log(2*t)",
            [
                "\"log(2*t)\"",
                "`motion` has no value at t = 0 s",
                "not a number at the start | write an expression that is defined from the start to the end of the run",
            ],
        ),
    ] {
        let text = CRANK.replacen(STEPS, &format!("motion = \"{motion}\""), 1);
        let problems = read(&text).expect_err(motion);
        let found: Vec<_> = problems.iter().map(|p| said(&text, p)).collect();
        assert_eq!(found.len(), 1, "{motion}: {found:#?}");
        let [marked, message, advice] = &found[0];
        let message = message.rsplit(": ").next().unwrap_or_default();
        assert_eq!([marked.as_str(), message, advice], expected, "{motion}");
    }
    // The run ends at 2 s. The first of its hundredths without a value is reported.
    for (motion, what) in [
        ("log(1.43 - t/(1 s))", "`motion` has no value at t = 1.44 s"),
        ("sqrt(1.5 - t/(1 s))", "`motion` has no rate at t = 1.5 s"),
        (
            "(1.5 - t/(1 s))^1.5",
            "`motion` has no second derivative at t = 1.5 s",
        ),
    ] {
        let text = CRANK.replacen(STEPS, &format!("motion = \"{motion}\""), 1);
        let problems = read(&text).expect_err(motion);
        let found: Vec<_> = problems.iter().map(|p| said(&text, p)).collect();
        let expected = [
            format!("\"{motion}\""),
            format!("drive `D`: {what}"),
            "must be defined during the whole run | ".to_owned(),
        ];
        assert_eq!(found, [expected]);
        let shorter = text.replacen("t_end = \"2 s\"", "t_end = \"1.4 s\"", 1);
        read(&shorter).unwrap_or_else(|p| panic!("{motion}: {p:#?}"));
    }
    // A load needs only a value, so that kinks and infinite rates are permitted.
    for load in ["sqrt(2*t)", "abs(sin(300*t))", "max(1 - 2*t, 0)"] {
        let push = format!(
            "{CRANK}\n[[force]]\nname = \"F\"\ntype = \"point-force\"\nbody = \"crank\"\npoint = [0, 0]\nforce = [\"{load}\", 0]\n"
        );
        read(&push).unwrap_or_else(|p| panic!("{load}: {p:#?}"));
    }
    // In format 1, the message states the text to add.
    let old = "[scene]\nname = \"a\"\nspace = \"plane\"\n[[body]]\nname = \"a\"\nmass = 1\ninertia = 1\n[[force]]\nname = \"T\"\ntype = \"torque\"\nbody = \"a\"\ntorque = \"2*t\"\n";
    let problems = read(old).expect_err("format 1");
    let help = problems[0].help.as_deref().unwrap_or_default();
    assert!(help.ends_with("`format = 2` in `[scene]`"), "{help}");
}

/// The time is `t` in laws and functions of time. A parameter with this name is one error, however
/// often it is used there, and is permitted in other values.
#[test]
fn a_parameter_is_not_the_time() {
    let named = CRANK.replacen("L = 300.1\n", "L = 300.1\nt = 4\n", 1);
    let thick = named.replacen("damping = 0.5", "damping = \"t/8\"", 1);
    read(&thick).unwrap_or_else(|p| panic!("{p:#?}"));
    let torques: Vec<String> = (0..30)
        .map(|k| {
            format!(
                "\n[[force]]\nname = \"T{k}\"\ntype = \"torque\"\nbody = \"crank\"\ntorque = \"2*t + t^2\"\n"
            )
        })
        .collect();
    let text = format!("{thick}{}", torques.concat());
    let problems = read(&text).expect_err("two meanings");
    let found: Vec<_> = problems.iter().map(|p| said(&text, p)).collect();
    let expected = [
        "t",
        "`t` is a parameter and the time",
        "two meanings | give the parameter another name",
    ];
    assert_eq!(found, [expected.map(str::to_owned)]);
    assert_eq!(problems[0].primary.line, 10);
    // The advice was followed.
    let renamed = text
        .replacen("\nt = 4\n", "\nt_1 = 4\n", 1)
        .replacen("t/8", "t_1/8", 1);
    read(&renamed.replace(" + t^2", "")).unwrap_or_else(|p| panic!("{p:#?}"));
}

#[test]
fn all_faults_are_told_at_once() {
    let text = CRANK
        .replacen("\"L*cos(phi)\", \"L*sin(phi)\"", "\"a + b\", \"1 s\"", 1)
        .replacen("phi = 30", "phi = \"30 deg + zeta\"", 1)
        .replacen("\"2 s\"", "\"2 kg\"", 1);
    let problems = read(&text).expect_err("four faults");
    let marked: Vec<&str> = problems
        .iter()
        .map(|p| &text[p.primary.span.clone()])
        .collect();
    // Uses of the invalid `phi` are consequences and not reported.
    assert_eq!(marked, ["zeta", "a", "b", "1 s", "2 kg"]);
}

/// Parameters may be in any order and of any number; the depth of the stack does not depend on
/// their number.
#[test]
fn thousands_of_parameters_follow_each_other() {
    let n = 20_000;
    let mut chain = String::from("[parameters]\np0 = 1e-4\n");
    for k in (1..=n).rev() {
        chain += &format!("p{k} = \"p{} + p0\"\n", k - 1);
    }
    let text = CRANK.replacen("[parameters]\n", &chain, 1);
    let text = text.replacen("mass = \"m1/(L/100)\"", &format!("mass = \"p{n}\""), 1);
    let scene = read(&text).unwrap_or_else(|p| panic!("{:#?}", p[0]));
    assert_eq!(
        scene.description.plane().expect("a planar scene").bodies[0].mass,
        2.0001
    );
    // A cycle of all parameters is one problem.
    let text = text.replacen("p0 = 1e-4", &format!("p0 = \"p{n}\""), 1);
    let problems = read(&text).expect_err("a circle");
    assert_eq!(problems.len(), 1, "{:#?}", problems[1]);
    let message = &problems[0].message;
    assert!(message.starts_with("the parameters `p"), "{message}");
    assert!(message.ends_with("depend on each other"), "{message}");
}

/// A text that is written with escapes is marked as a whole.
#[test]
fn escapes_do_not_shift_places() {
    let text = CRANK.replacen("t_end = \"2 s\"", "t_end = \"2\\u0020kg\"", 1);
    let problems = read(&text).expect_err("a mass");
    assert_eq!(&text[problems[0].primary.span.clone()], "\"2\\u0020kg\"");
}

/// Without `format = 2` expressions are not available, and the message states the text to add.
#[test]
fn the_old_format_computes_nothing() {
    let text = CRANK.replacen("format = 2\n", "", 1);
    let problems = read(&text).expect_err("format 1");
    let found: Vec<_> = problems.iter().map(|p| said(&text, p)).collect();
    let expected = [
        [
            "{ length = \"mm\", angle = \"deg\" }",
            "`units` needs the format 2",
            "not in format 1 | add `format = 2` to `[scene]`",
        ],
        [
            "[parameters]",
            "`[parameters]` needs the format 2",
            "not in format 1 | add `format = 2` to `[scene]`",
        ],
    ];
    assert_eq!(found, expected);
    let plain = "[scene]\nname = \"a\"\nspace = \"plane\"\n[[body]]\nname = \"a\"\nmass = \"2*3\"\ninertia = 1\n";
    let problems = read(plain).expect_err("a text");
    assert_eq!(
        said(plain, &problems[0]),
        [
            "\"2*3\"",
            "body `a`: `mass` must be a number, found the text \"2*3\"",
            "expected a number | texts are computed with `format = 2` in `[scene]`",
        ]
    );
}

#[test]
fn what_is_probably_not_meant_is_a_warning() {
    for (from, to, marked, message) in [
        (
            "\"L*cos(phi)\"",
            "\"L*(1 - cos(1e-4*phi))\"",
            "\"L*(1 - cos(1e-4*phi))\"",
            "body `crank`: `position` is a small difference of larger numbers: it is accurate to 2e-7 of its value",
        ),
        (
            "motion = { type = \"steps\", steps = [{ from = 0, to = \"500 ms\", by = \"phi/2\" }] }",
            "motion = \"phi\"",
            "\"phi\"",
            "drive `D`: `motion = \"phi\"` is constant, and a drive follows f(t) − f(0), so the measure is held at its initial value",
        ),
    ] {
        assert!(CRANK.contains(from), "{from}");
        let text = CRANK.replacen(from, to, 1);
        let scene = read(&text).unwrap_or_else(|p| panic!("{p:#?}"));
        let found: Vec<_> = scene
            .warnings
            .iter()
            .map(|w| (&text[w.primary.span.clone()], &*w.message))
            .collect();
        assert_eq!(found, [(marked, message)]);
    }
}

proptest! {
    /// For any text, reading ends without a panic, and positions are inside the file.
    #[test]
    fn no_text_panics(text in expression(), other in expression()) {
        let quoted = |text: &str| toml::Value::from(text).to_string();
        let scene = CRANK
            .replacen("\"L*cos(phi)\"", &quoted(&text), 1)
            .replacen("\"25 mm + L\"", &quoted(&other), 1)
            .replacen("phi = 30\n", "phi = 30\nN = 2\nmm = \"3 mm\"\n", 1)
            .replacen(STEPS, &format!("motion = {}", quoted(&text)), 1);
        if let Err(problems) = read(&scene) {
            prop_assert!(!problems.is_empty());
            for p in problems {
                prop_assert!(scene.get(p.primary.span.clone()).is_some(), "{p}");
            }
        }
    }
}

fn expression() -> impl Strategy<Value = String> {
    let words = prop::sample::select(vec![
        "1", "0", "2.5", "1e308", "1e-320", "1e999", "L", "tip", "m1", "x", "mm", "deg", "N", "s",
        "t", "2*t", "abs(", "min", "pi", "+", "-", "*", "/", "^", "(", ")", ",", "sin(", "acos(",
        "atan2(", "sqrt(", "min(", "exp(", "log(", " ", "_", "²", "°", "é", "\n", "\"", "\u{0}",
    ]);
    prop_oneof![
        prop::collection::vec(words, 0..24).prop_map(|words| words.concat()),
        "\\PC{0,20}",
    ]
}
