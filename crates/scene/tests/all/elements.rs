//! Tests every type of joint and force of the scene format; the parameters are checked with the
//! values of the kernels.
//!
//! The bodies are described at (1, 2) rotated by 90° (a), at (3, 2) (b) and at (0, 0) (c). The
//! ground point (1, 4) is (2, 0) in the frame of a and (−2, 2) in the frame of b. Initial values
//! are those of the described configuration. The kernels are then called with all bodies at the
//! origin, so that the results show the coordinates in the body frames directly.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI, SQRT_2};

use joints::{Element, Pose, Twist};
use model::{BodyRef, Description, Joint, Registry};

use crate::{assert_close, read_more};

fn pose(d: &Description, body: BodyRef) -> Pose {
    match body {
        BodyRef::Ground => Pose::GROUND,
        BodyRef::Body(at) => d.bodies[at].pose(),
    }
}

fn joint(text: &str) -> (Description, Joint) {
    let d = read_more(&format!("[[joint]]\nname = \"X\"\n{text}"))
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    let mut joint = d.joints[0].clone();
    let x: Vec<Pose> = joint.bodies.iter().map(|&body| pose(&d, body)).collect();
    joint.element.initialise(&x);
    (d, joint)
}

/// Returns Φ for body frames at the origin with these angles.
fn phi(text: &str, angles: &[f64]) -> Vec<f64> {
    let (_, joint) = joint(text);
    let x: Vec<Pose> = angles.iter().map(|&a| Pose::new(0.0, 0.0, a)).collect();
    assert_eq!(joint.bodies.len(), x.len());
    let element = &joint.element;
    let mut out = vec![f64::NAN; element.spec().rows.len()];
    element.phi(&x, &[], &mut out);
    out
}

/// Returns the block of C with all bodies at the origin.
fn c(element: &dyn Element<f64>) -> Vec<f64> {
    let spec = element.spec();
    let n = 3 * spec.common.slots.len();
    let x = vec![Pose::GROUND; spec.common.slots.len()];
    let mut entries = vec![f64::NAN; spec.c.len()];
    element.c_constant(&mut entries);
    element.c(&x, &[[0.5, 0.0, 0.0]], &mut entries);
    let mut block = vec![0.0; n * spec.rows.len()];
    for (entry, value) in spec.c.iter().zip(entries) {
        block[n * entry.row + 3 * entry.slot + entry.dof] = value;
    }
    block
}

const AB: &str = "bodies = [\"a\", \"b\"]\n";

#[test]
fn revolute() {
    let at = format!("type = \"revolute\"\n{AB}at = [1.0, 4.0]");
    assert_close(&phi(&at, &[0.0; 2]), &[4.0, -2.0]);
    // The same points are given in body frames; the order of the table has no effect, and integers
    // are permitted as numbers.
    let points = format!("type = \"revolute\"\n{AB}points = {{ b = [-2, 2], a = [2, 0] }}");
    assert_close(&phi(&points, &[0.0; 2]), &[4.0, -2.0]);
    let ground = "type = \"revolute\"\nbodies = [\"ground\", \"b\"]\nat = [1.0, 4.0]";
    // The expected value is (1, 4) − (−2, 2).
    assert_close(&phi(ground, &[0.0; 2]), &[3.0, 2.0]);
    let ground = "type = \"revolute\"\nbodies = [\"ground\", \"b\"]\npoints = { ground = [1, 4], b = [0, 0] }";
    assert_close(&phi(ground, &[0.0; 2]), &[1.0, 4.0]);
}

#[test]
fn translational_and_pin_in_slot() {
    // d = (−2, 2) − (2, 0) = (−4, 2); the normal of the axis (0, 1) is (−1, 0); the axis is
    // normalised.
    let place = format!("{AB}at = [1.0, 4.0]\naxis = [0.0, 3.0]");
    let text = format!("type = \"translational\"\n{place}");
    assert_close(&phi(&text, &[0.0; 2]), &[4.0, FRAC_PI_2]);
    let text = format!("type = \"pin-in-slot\"\n{place}");
    assert_close(&phi(&text, &[0.0; 2]), &[4.0]);
}

#[test]
fn fixed_and_angle() {
    let text = format!("type = \"fixed\"\n{AB}at = [1.0, 4.0]");
    assert_close(&phi(&text, &[0.0; 2]), &[4.0, -2.0, FRAC_PI_2]);
    let text = format!("type = \"angle\"\n{AB}");
    assert_close(&phi(&text, &[0.0, 0.25]), &[FRAC_PI_2 + 0.25]);
}

#[test]
fn distance() {
    // L² = 8 between (1, 4) and (3, 2); at the origin d = (−2, 0): (4 − 8)/(2·√8) = −1/√2.
    let text = format!("type = \"distance\"\n{AB}at = [[1.0, 4.0], [3.0, 2.0]]");
    assert_close(&phi(&text, &[0.0; 2]), &[-FRAC_1_SQRT_2]);
    let text = format!("type = \"distance\"\n{AB}points = {{ a = [2.0, 0.0], b = [0.0, 0.0] }}");
    assert_close(&phi(&text, &[0.0; 2]), &[-FRAC_1_SQRT_2]);
}

#[test]
fn gear() {
    // phase = 0 − (−2)·π/2 = π with the ground and with c as the carrier.
    let text = format!("type = \"gear\"\n{AB}ratio = -2.0");
    assert_close(&phi(&text, &[0.1, 0.2, 0.0]), &[0.4 - PI]);
    let text = format!("type = \"gear\"\n{AB}ratio = -2.0\ncarrier = \"c\"");
    assert_close(&phi(&text, &[0.1, 0.2, 0.05]), &[0.25 - PI]);
    let (_, joint) = joint(&text);
    assert_eq!(joint.bodies, [0, 1, 2].map(BodyRef::Body));
}

#[test]
fn rack_and_pinion() {
    // The axis (0, −1) of a is the global x direction: phase = 2 + 0.5·(0 − π/2).
    let text = format!(
        "type = \"rack-and-pinion\"\n{AB}at = [3.0, 2.0]\naxis = [0.0, -1.0]\nradius = 0.5"
    );
    assert_close(&phi(&text, &[0.0; 2]), &[PI / 4.0 - 2.0]);
}

#[test]
fn point_on_line() {
    // The point (2, 0) is compared with the normal (−1, 1)/√2.
    let line = "line = [[0.0, 0.0], [2.0, 2.0]]";
    for place in ["at = [1.0, 4.0]", "point = [2.0, 0.0]"] {
        let text = format!("type = \"point-on-line\"\nbody = \"a\"\n{place}\n{line}");
        assert_close(&phi(&text, &[0.0]), &[-SQRT_2]);
    }
}

#[test]
fn knife_edge() {
    // With n = (0.6, 0.8) and the point (2, 0), the entries are n and n·(0, 2).
    let (_, joint) =
        joint("type = \"knife-edge\"\nbody = \"a\"\nat = [1.0, 4.0]\nnormal = [3.0, 4.0]");
    assert_close(&c(&*joint.element), &[0.6, 0.8, 1.6]);
    assert_eq!(joint.bodies, [BodyRef::Body(0)]);
}

#[test]
fn velocity() {
    let (_, joint) = joint(
        "type = \"velocity\"\nbody = \"a\"\nat = [1.0, 4.0]\ndirection = [0.0, 2.0]\n\
         rate = { type = \"polynomial\", coefficients = [0.5, 3] }",
    );
    assert_close(&c(&*joint.element), &[0.0, 1.0, 2.0]);
    assert_eq!(joint.functions[0].jet(2.0), [6.5, 3.0, 0.0]);
    let mut b = [f64::NAN];
    joint.element.b(&[Pose::GROUND], &[[0.5, 0.0, 0.0]], &mut b);
    assert_close(&b, &[0.5]);
}

#[test]
fn rolling() {
    // The value is d·v of the point (2, 0) of a, minus 0.25·ω of b.
    let text = "type = \"rolling\"\nbodies = [\"a\", \"b\"]\n";
    for place in ["at = [1.0, 4.0]", "points = { a = [2.0, 0.0] }"] {
        let (_, joint) = joint(&format!(
            "{text}{place}\ndirection = [0.0, 1.0]\nradius = 0.25"
        ));
        assert_close(&c(&*joint.element), &[0.0, 1.0, 2.0, 0.0, 0.0, -0.25]);
    }
}

/// A drive has the bodies and the parameters of its joint.
#[test]
fn drives() {
    let text = r#"
[[drive]]
name = "turn"
joint = "R"
type = "angle"
motion = { type = "constant-rate", rate = 2.0 }
[[drive]]
name = "shift"
joint = "T"
type = "displacement"
motion = { type = "harmonic", amplitude = 0.5, omega = 2.0, phase = 0.0, offset = 1.0 }
[[drive]]
name = "pin"
joint = "P"
type = "displacement"
motion = { type = "table", times = [0, 1, 2], values = [0, 3, 6] }
[[drive]]
name = "pin-angle"
joint = "P"
type = "angle"
motion = 0.0
[[joint]]
name = "R"
type = "revolute"
bodies = ["b", "a"]
at = [1.0, 4.0]
[[joint]]
name = "T"
type = "translational"
bodies = ["a", "b"]
at = [1.0, 4.0]
axis = [0.0, 1.0]
[[joint]]
name = "P"
type = "pin-in-slot"
bodies = ["a", "b"]
at = [1.0, 4.0]
axis = [1.0, 0.0]
"#;
    let d = read_more(text)
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    let value = |k: usize| {
        let mut drive = d.drives[k].clone();
        let described: Vec<Pose> = drive.bodies.iter().map(|&b| pose(&d, b)).collect();
        drive.element.initialise(&described);
        let mut out = [f64::NAN];
        drive
            .element
            .phi(&[Pose::GROUND; 2], &[[0.125, 0.0, 0.0]], &mut out);
        out[0]
    };
    // The values are the joint coordinates at the origin minus those in the described configuration
    // minus 0.125. d = (−4, 2) at the origin and 0 in the described configuration.
    assert_close(
        &[value(0), value(1), value(2), value(3)],
        &[
            -FRAC_PI_2 - 0.125,
            2.0 - 0.125,
            -4.0 - 0.125,
            FRAC_PI_2 - 0.125,
        ],
    );
    assert_eq!(d.drives[0].bodies, [BodyRef::Body(1), BodyRef::Body(0)]);
    assert_close(&d.drives[0].motion.jet(0.5), &[1.0, 2.0, 0.0]);
    assert_close(&d.drives[1].motion.jet(0.0), &[1.0, 1.0, 0.0]);
    assert_close(&d.drives[2].motion.jet(1.5), &[4.5, 3.0, 0.0]);
    assert_eq!(d.drives[3].motion.jet(1.0), [0.0; 3]);
}

/// Two drives of one joint coordinate are redundant, which is not an error.
#[test]
fn redundant_drives_are_legal() {
    let joint =
        "[[joint]]\nname = \"R\"\ntype = \"revolute\"\nbodies = [\"a\", \"b\"]\nat = [0, 0]\n";
    let drive = |name| {
        format!("[[drive]]\nname = \"{name}\"\njoint = \"R\"\ntype = \"angle\"\nmotion = 1\n")
    };
    let d = read_more(&format!("{joint}{}{}", drive("one"), drive("two")))
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    assert_eq!(d.drives.len(), 2);
}

/// Returns Q for all bodies at the origin with these twists; functions of time are evaluated at
/// t = 0.
fn q(text: &str, v: &[Twist]) -> Vec<f64> {
    let d = read_more(&format!("[[force]]\nname = \"X\"\n{text}"))
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    let mut force = d.forces[0].clone();
    let described: Vec<Pose> = force.bodies.iter().map(|&b| pose(&d, b)).collect();
    force.element.initialise(&described);
    let f: Vec<_> = force.functions.iter().map(|f| f.jet(0.0)).collect();
    let spec = force.element.spec();
    let x = vec![Pose::GROUND; described.len()];
    let mut entries = vec![f64::NAN; spec.q.len()];
    force.element.q(&x, v, &f, &mut entries);
    let mut out = vec![0.0; 3 * x.len()];
    for (&k, value) in spec.q.iter().zip(entries) {
        out[k] = value;
    }
    out
}

const REST: Twist = Twist {
    x: 0.0,
    y: 0.0,
    omega: 0.0,
};

#[test]
fn spring_damper() {
    // The spring is from (2, 0) of a to (0, 0) of b. Its length is 2 at the origin and √8 in the
    // described configuration. b moves to the left at 1 m/s, so l̇ = 1.
    let v = [REST, Twist { x: -1.0, ..REST }];
    let text = format!(
        "type = \"spring-damper\"\n{AB}at = [[1, 4], [3, 2]]\nstiffness = 10.0\ndamping = 3.0\n"
    );
    // The tension 10·(2 − 0.5) + 3 = 18 pulls a to the left and b to the right, without a lever
    // arm.
    let tension = q(&format!("{text}free_length = 0.5"), &v);
    assert_close(&tension, &[-18.0, 0.0, 0.0, 18.0, 0.0, 0.0]);
    let tension = 10.0 * (2.0 - 8.0_f64.sqrt()) + 3.0;
    assert_close(&q(&text, &v), &[-tension, 0.0, 0.0, tension, 0.0, 0.0]);
}

#[test]
fn torsion_spring_damper() {
    let v = [REST, Twist { omega: 2.0, ..REST }];
    let text = format!("type = \"torsion-spring-damper\"\n{AB}stiffness = 10.0\ndamping = 3.0\n");
    // The torque is −10·(0 − 0.5) − 3·2 = −1.
    let torque = q(&format!("{text}free_angle = 0.5"), &v);
    assert_close(&torque, &[0.0, 0.0, 1.0, 0.0, 0.0, -1.0]);
    // If the free angle is not given, it is the described angle −π/2, and the torque is −10·π/2
    // − 6.
    let torque = -10.0 * FRAC_PI_2 - 6.0;
    assert_close(&q(&text, &v), &[0.0, 0.0, -torque, 0.0, 0.0, torque]);
}

#[test]
fn bushing() {
    // d = (−2, 2) − (2, 0) = (−4, 2), and zero in the described configuration; the angle was −π/2.
    // The force on b is (4·1, −2·10); it acts at (−2, 2).
    let text = format!(
        "type = \"bushing\"\n{AB}at = [1, 4]\nstiffness = [1, 10, 100]\ndamping = [0, 0, 0]"
    );
    let torque = -100.0 * FRAC_PI_2;
    let moment = -2.0 * -20.0 - 2.0 * 4.0;
    let found = q(&text, &[REST, REST]);
    assert_close(
        &found,
        &[-4.0, 20.0, -torque - moment, 4.0, -20.0, torque + moment],
    );
    // The rates of d are computed from the velocity of body b.
    let text = format!(
        "type = \"bushing\"\n{AB}at = [1, 4]\nstiffness = [0, 0, 0]\ndamping = [1, 10, 100]"
    );
    let found = q(
        &text,
        &[
            REST,
            Twist {
                x: 1.0,
                y: 0.0,
                omega: 0.0,
            },
        ],
    );
    assert_close(&found, &[1.0, 0.0, -2.0, -1.0, 0.0, 2.0]);
}

#[test]
fn point_force() {
    let text = "type = \"point-force\"\nbody = \"a\"\nat = [1, 4]\n";
    let components = "force = [3, { type = \"constant-rate\", rate = 2.0 }]\n";
    assert_close(
        &q(&format!("{text}{components}"), &[REST]),
        &[3.0, 0.0, 0.0],
    );
    // The force (0, 4) at (2, 0) has the torque 8 about the origin.
    let text = format!("{text}force = [0, 4]\n");
    assert_close(&q(&text, &[REST]), &[0.0, 4.0, 8.0]);
    for (frame, name) in [
        ("", "PointForce"),
        ("frame = \"global\"", "PointForce"),
        ("frame = \"body\"", "BodyPointForce"),
    ] {
        let d = read_more(&format!("[[force]]\nname = \"X\"\n{text}{frame}"))
            .description
            .plane()
            .expect("a planar scene")
            .clone();
        assert_eq!(d.forces[0].element.spec().common.name, name);
    }
}

#[test]
fn torque() {
    assert_close(
        &q("type = \"torque\"\nbody = \"a\"\ntorque = 5", &[REST]),
        &[0.0, 0.0, 5.0],
    );
    let text =
        format!("type = \"torque\"\n{AB}torque = {{ type = \"steps\", start = 5, steps = [] }}");
    assert_close(&q(&text, &[REST; 2]), &[0.0, 0.0, -5.0, 0.0, 0.0, 5.0]);
}

/// The tests above are complete: the registry contains only the types of the format.
#[test]
fn the_types_are_those_of_the_contract() {
    let registry = Registry::standard();
    let mut joints: Vec<_> = registry
        .plane()
        .constraint_specs()
        .map(|s| s.scene_type)
        .collect();
    joints.sort_unstable();
    // `spin` selects one of the two definitions of `rolling`.
    joints.dedup();
    assert_eq!(
        joints,
        [
            "angle",
            "distance",
            "fixed",
            "gear",
            "knife-edge",
            "mesh",
            "pin-in-slot",
            "point-on-line",
            "rack-and-pinion",
            "revolute",
            "rolling",
            "translational",
            "velocity"
        ]
    );
    let mut forces: Vec<_> = registry
        .plane()
        .force_specs()
        .map(|s| s.scene_type)
        .collect();
    forces.sort_unstable();
    forces.dedup();
    assert_eq!(
        forces,
        [
            "bushing",
            "damper",
            "point-force",
            "spring-damper",
            "torque",
            "torsion-spring-damper",
            "tyre"
        ]
    );
}
