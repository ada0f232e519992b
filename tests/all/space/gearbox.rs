//! A planetary gearbox as it is built: sun, ring and carrier turn in the housing, the planets turn
//! on the carrier. Compares counts, speeds and tooth forces with values computed by hand, in the
//! plane and in space.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use joints::space3::cross;
use model::System;

use super::gears::{End, close, counts, row_of, row_of_teeth, study, velocities};

/// Pitch radii of sun, planets and ring (m): 30, 15 and 60 teeth of module 2 mm.
const SUN: f64 = 0.03;
const PLANET: f64 = 0.015;
const RING: f64 = SUN + 2.0 * PLANET;

/// Distance of a planet from the sun (m).
const ARM: f64 = SUN + PLANET;

/// Mass of a planet (kg).
const MASS: f64 = 0.15;

/// Pressure angle of all teeth (rad); negative for the ring, whose teeth press inwards.
const PRESSURE_ANGLE: f64 = 0.35;

/// The ring of a gearbox.
#[derive(Clone, Copy, PartialEq)]
enum Ring {
    /// The housing has the teeth of the ring.
    Housing,
    /// The ring is a body that turns in the housing.
    Turning,
}

/// How the key `carrier` of the meshes is written.
const WRITTEN: [&str; 2] = ["", "carrier = \"carrier\"\n"];

/// Returns the angle of planet k of n.
fn place(k: usize, n: usize) -> [f64; 2] {
    let (sin, cos) = (TAU * k as f64 / n as f64).sin_cos();
    [cos, sin]
}

/// The bearings in the housing of a gearbox in space, each with its bodies and its axis.
struct Housing {
    sun: &'static str,
    carrier: &'static str,
}

const USUAL: Housing = Housing {
    sun: "type = \"revolute\"\nbodies = [\"ground\", \"sun\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n",
    carrier: "type = \"revolute\"\nbodies = [\"ground\", \"carrier\"]\nat = [0, 0, 0.1]\naxis = [0, 0, 1]\n",
};

/// Returns a gearbox in space with n planets. The bodies are sun, carrier, the planets, and the
/// ring if it turns.
fn in_space(n: usize, ring: Ring, housing: &Housing, carrier: &str) -> String {
    let body = |name: &str, mass: f64, axial: f64, [x, y]: [f64; 2]| {
        let across = 0.6 * axial;
        format!(
            "[[body]]\nname = \"{name}\"\nmass = {mass}\ninertia = [{across:?}, {across:?}, {axial:?}]\nposition = [{x:?}, {y:?}, 0]\n"
        )
    };
    let mut text = "[scene]\nname = \"gearbox\"\nspace = \"spatial\"\n".to_owned();
    text += &body("sun", 0.5, 2.25e-4, [0.0; 2]);
    text += &body("carrier", 0.8, 1e-3, [0.0; 2]);
    for k in 0..n {
        let pin = place(k, n).map(|x| ARM * x);
        text += &body(&format!("planet-{k}"), MASS, 1.7e-5, pin);
    }
    let mut own = "carrier-bearing";
    text += &format!("[[joint]]\nname = \"sun-bearing\"\n{}", housing.sun);
    text += &format!("[[joint]]\nname = \"carrier-bearing\"\n{}", housing.carrier);
    if ring == Ring::Turning {
        own = "ring-bearing";
        text += &body("ring", 1.2, 4e-3, [0.0; 2]);
        text += "[[joint]]\nname = \"ring-bearing\"\ntype = \"revolute\"\nbodies = [\"ring\", \"ground\"]\nat = [0, 0, -0.2]\naxis = [0, 0, 1]\n";
    }
    for k in 0..n {
        let at = |r: f64| place(k, n).map(|x| r * x);
        let ([px, py], [ix, iy], [ox, oy]) = (at(ARM), at(SUN), at(RING));
        write!(
            text,
            "[[joint]]\nname = \"pin-{k}\"\ntype = \"revolute\"\nbodies = [\"carrier\", \"planet-{k}\"]\nat = [{px:?}, {py:?}, 0]\naxis = [0, 0, 1]\n\
             [[joint]]\nname = \"sun-{k}\"\ntype = \"mesh\"\nbearings = [\"sun-bearing\", \"pin-{k}\"]\nat = [{ix:?}, {iy:?}, 0]\npressure_angle = {PRESSURE_ANGLE}\n{carrier}\
             [[joint]]\nname = \"ring-{k}\"\ntype = \"mesh\"\nbearings = [\"pin-{k}\", \"{own}\"]\nat = [{ox:?}, {oy:?}, 0]\npressure_angle = -{PRESSURE_ANGLE}\n{carrier}"
        )
        .expect("a text");
    }
    text
}

/// Returns the same gearbox in the plane.
fn in_plane(n: usize, ring: Ring) -> String {
    let body = |name: &str, mass: f64, inertia: f64, at: [f64; 2]| {
        format!(
            "[[body]]\nname = \"{name}\"\nmass = {mass}\ninertia = {inertia:?}\nposition = {at:?}\n"
        )
    };
    let pin = |name: &str, on: &str, body: &str, at: [f64; 2]| {
        format!(
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = [\"{on}\", \"{body}\"]\nat = {at:?}\n"
        )
    };
    let mut text = "[scene]\nname = \"gearbox\"\nspace = \"plane\"\n".to_owned();
    text += &body("sun", 0.5, 2.25e-4, [0.0; 2]);
    text += &body("carrier", 0.8, 1e-3, [0.0; 2]);
    for k in 0..n {
        let at = place(k, n).map(|x| ARM * x);
        text += &body(&format!("planet-{k}"), MASS, 1.7e-5, at);
    }
    text += &pin("sun-bearing", "ground", "sun", [0.0; 2]);
    text += &pin("carrier-bearing", "ground", "carrier", [0.0; 2]);
    let mut own = "ground";
    if ring == Ring::Turning {
        own = "ring";
        text += &body("ring", 1.2, 4e-3, [0.0; 2]);
        text += &pin("ring-bearing", "ground", "ring", [0.0; 2]);
    }
    for k in 0..n {
        let planet = format!("planet-{k}");
        let at = place(k, n).map(|x| ARM * x);
        text += &pin(&format!("pin-{k}"), "carrier", &planet, at);
        write!(
            text,
            "[[joint]]\nname = \"sun-{k}\"\ntype = \"mesh\"\nbodies = [\"sun\", \"{planet}\"]\ncarrier = \"carrier\"\nat = [[0, 0], {at:?}]\nratio = {:?}\npressure_angle = {PRESSURE_ANGLE}\n\
             [[joint]]\nname = \"ring-{k}\"\ntype = \"mesh\"\nbodies = [\"{planet}\", \"{own}\"]\ncarrier = \"carrier\"\nat = [{at:?}, [0, 0]]\nratio = {:?}\npressure_angle = -{PRESSURE_ANGLE}\n",
            -SUN / PLANET,
            PLANET / RING,
        )
        .expect("a text");
    }
    text
}

/// Returns a motor that turns a body in the housing at a constant rate.
fn motor(of: &str, rate: f64) -> String {
    format!(
        "[[drive]]\nname = \"{of}-motor\"\njoint = \"{of}-bearing\"\ntype = \"angle\"\nmotion = {{ type = \"constant-rate\", rate = {rate:?} }}\n"
    )
}

/// Sun, carrier and each planet have one angle in their bearings, and the ring too if it turns; the
/// bearings form a tree, so their rows are independent. One planet couples sun, carrier, ring and
/// itself by two rows. Each further planet adds one angle and two rows, of which one is redundant.
/// With n planets the redundancy is n − 1. The mobility is 1, or 2 if the ring turns.
#[test]
fn the_redundancy_of_a_gearbox_is_that_of_its_planets() {
    for n in 1..=4 {
        for (ring, bodies, mobility) in [(Ring::Housing, n + 2, 1), (Ring::Turning, n + 3, 2)] {
            let plane = counts(
                &study(&in_plane(n, ring))
                    .analyse(0.0, None)
                    .expect("a start"),
            );
            assert_eq!(
                plane,
                [2 * bodies + 2 * n, 3 * bodies - mobility, n - 1, mobility]
            );
            for carrier in WRITTEN {
                let text = in_space(n, ring, &USUAL, carrier);
                let space = counts(&study(&text).analyse(0.0, None).expect("a start"));
                assert_eq!(
                    space,
                    [5 * bodies + 2 * n, 6 * bodies - mobility, n - 1, mobility]
                );
            }
        }
    }
}

/// A second bearing closes a loop of coaxial joints: its five rows are all redundant. Such bearings
/// are a second bearing of the sun in the housing, and one between the carrier and the sun. The
/// planet then turns on the carrier in two bearings.
#[test]
fn a_second_bearing_adds_five_redundant_rows() {
    let second = [
        ("[\"ground\", \"sun\"]", [0.0; 2]),
        ("[\"carrier\", \"ground\"]", [0.0; 2]),
        ("[\"carrier\", \"planet-0\"]", [ARM, 0.0]),
    ];
    for (bodies, [x, y]) in second {
        let text = in_space(4, Ring::Housing, &USUAL, WRITTEN[0])
            + &format!(
                "[[joint]]\nname = \"second\"\ntype = \"revolute\"\nbodies = {bodies}\nat = [{x:?}, {y:?}, 0.3]\naxis = [0, 0, 1]\n"
            );
        let found = counts(&study(&text).analyse(0.0, None).expect("a start"));
        assert_eq!(found, [43, 35, 8, 1], "{bodies}");
    }
}

/// Willis: (ω_sun − ω_carrier)·z_sun = −(ω_ring − ω_carrier)·z_ring, and the planets have the speed
/// of the sun at the pitch point. After 200 revolutions of the sun the ratios are those of the
/// first one.
#[test]
fn the_speeds_of_a_gearbox_are_those_of_willis() {
    let (sun, t, n) = (40.0, 32.0, 4);
    assert!(sun * t > 200.0 * TAU);
    for (ring, rate) in [(Ring::Housing, 0.0), (Ring::Turning, -7.0)] {
        let carrier = (SUN * sun + RING * rate) / (SUN + RING);
        let planet = carrier - (sun - carrier) * SUN / PLANET;
        let mut motors = motor("sun", sun);
        if ring == Ring::Turning {
            // The ring is the first body of its bearing.
            motors += &motor("ring", -rate);
        }
        let space = End::of(
            &study(&(in_space(n, ring, &USUAL, WRITTEN[0]) + &motors)),
            t,
        );
        let of_space = |body: usize| space.omega(body)[2];
        motors = motor("sun", sun);
        if ring == Ring::Turning {
            motors += &motor("ring", rate);
        }
        let plane = End::of(&study(&(in_plane(n, ring) + &motors)), t);
        let of_plane = |body: usize| plane.v[3 * body + 2];
        for body in 0..n + 2 {
            let expected = match body {
                0 => sun,
                1 => carrier,
                _ => planet,
            };
            close(of_space(body), expected, 1e-12 * sun);
            close(of_plane(body), expected, 1e-12 * sun);
            let q = &space.q[7 * body + 3..];
            let half = 0.5 * expected * t;
            close(q[3] * half.cos() - q[0] * half.sin(), 0.0, 1e-9);
            close(plane.q[3 * body + 2], expected * t, 1e-9 * sun * t);
        }
        for end in [&space, &plane] {
            assert!(
                end.summary.max_position_residual < 1e-12,
                "{:?}",
                end.summary
            );
        }
    }
}

/// At constant speed the virtual work is T·ω_sun − L·ω_carrier = 0, so the motor of the sun has the
/// torque T = L·z_sun/(z_sun + z_ring). The teeth of the sun press on one planet with T/(r_sun·cos
/// α), and those of the ring with the same force, because both have the lever arm of the planet.
/// The pin carries both along the track, and towards the axis the centripetal force of the planet;
/// the radial forces of both meshes cancel.
#[test]
fn the_teeth_of_one_planet_press_as_the_torques_require() {
    let (load, sun, t) = (4.2, 40.0, 5.0);
    let carrier = sun * SUN / (SUN + RING);
    let torque = load * SUN / (SUN + RING);
    let (sin, cos) = PRESSURE_ANGLE.sin_cos();
    let force = torque / (SUN * cos);
    let mut text = in_space(1, Ring::Housing, &USUAL, WRITTEN[0]) + &motor("sun", sun);
    text += &format!(
        "[[force]]\nname = \"load\"\ntype = \"torque\"\nbody = \"carrier\"\ntorque = [0, 0, {:?}]\n",
        -load
    );
    let study = study(&text);
    let end = End::of(&study, t);
    let pose = end.pose(1);
    let names = study.prepared.mechanism.layout().groups.iter();
    let names: Vec<_> = names.map(|group| group.name.clone()).collect();
    let reaction = |name: &str| {
        let at = names.iter().position(|own| own == name).expect(name);
        end.reactions[at]
    };
    // Radial, along the track, and axial, in the axes of the carrier.
    let turned = |force: [f64; 3]| pose.direction_to_local(force);
    let check = |name: &str, expected: [f64; 3]| {
        for (found, expected) in turned(reaction(name).force).into_iter().zip(expected) {
            close(found, expected, 1e-8 * force);
        }
    };
    // The first wheel of the first mesh is the sun, that of the second one the planet.
    check("sun-0", [-force * sin, -force * cos, 0.0]);
    check("ring-0", [-force * sin, force * cos, 0.0]);
    // The pin acts on the carrier.
    let centripetal = MASS * ARM * carrier * carrier;
    check("pin-0", [centripetal, 2.0 * force * cos, 0.0]);
    for name in ["sun-0", "ring-0"] {
        assert!(reaction(name).torque.iter().all(|x| x.abs() < 1e-10));
    }
    // The motor acts on the housing.
    close(
        reaction("sun-motor").component.expect("a drive"),
        -torque,
        1e-8,
    );
}

/// The carrier is borne on the shaft of the sun, the axes of both bearings are opposite, and both
/// shafts may slide. Each mesh then has the row n·(v_1(P) − v_2(P)) for all velocities, also where
/// sun and carrier have slid apart.
#[test]
fn the_row_of_a_mesh_does_not_depend_on_who_bears_the_carrier() {
    let housing = Housing {
        sun: "type = \"cylindrical\"\nbodies = [\"ground\", \"sun\"]\nat = [0, 0, 0]\naxis = [0, 0, -1]\n",
        carrier: "type = \"cylindrical\"\nbodies = [\"carrier\", \"sun\"]\nat = [0, 0, 0.1]\naxis = [0, 0, 1]\n",
    };
    // With the shaft as a further body, sun and carrier both turn on it.
    let shaft = Housing {
        sun: "type = \"cylindrical\"\nbodies = [\"sun\", \"ground\"]\nat = [0, 0, 0]\naxis = [0, 0, -1]\n",
        carrier: "type = \"cylindrical\"\nbodies = [\"ground\", \"carrier\"]\nat = [0, 0, 0.1]\naxis = [0, 0, 1]\n",
    };
    let shifts = "[[drive]]\nname = \"shift\"\njoint = \"carrier-bearing\"\ntype = \"displacement\"\nmotion = { type = \"constant-rate\", rate = 0.01 }\n";
    for (housing, bearing) in [(&housing, "carrier-bearing"), (&shaft, "sun-bearing")] {
        let mut text = in_space(2, Ring::Housing, housing, WRITTEN[1]);
        text = text.replace("\"sun-bearing\", \"pin", &format!("\"{bearing}\", \"pin"));
        // The ring is the housing, which the sun connects with the carrier.
        text = text.replace(
            "\"carrier-bearing\"]",
            if bearing == "sun-bearing" {
                "\"carrier-bearing\"]"
            } else {
                "\"sun-bearing\"]"
            },
        );
        text += shifts;
        text +=
            "[[force]]\nname = \"push\"\ntype = \"torque\"\nbody = \"sun\"\ntorque = [0, 0, 0.3]\n";
        let study = study(&text);
        let end = End::of(&study, 3.0);
        let pose = end.pose(1);
        let turned = pose.direction_to_global([1.0, 0.0, 0.0]);
        assert!(turned[0] < 0.9, "the carrier turns: {turned:?}");
        close((pose.r[2] - end.pose(0).r[2]).abs(), 0.03, 1e-9);
        let (sin, cos) = PRESSURE_ANGLE.sin_cos();
        for k in 0..2 {
            let [x, y] = place(k, 2);
            let pitch = pose.to_global([SUN * x, SUN * y, 0.0]);
            let out = pose.direction_to_global([x, y, 0.0]);
            let along = pose.direction_to_global(cross([0.0, 0.0, 1.0], [x, y, 0.0]));
            // The sense of the line depends on the sense of the axis of the sun on the carrier.
            for seed in 0..10 {
                let v = velocities(end.v.len(), seed);
                let found = row_of(&study.prepared.mechanism, &end, &format!("sun-{k}"), &v);
                let rows = [1.0, -1.0].map(|sense| {
                    let line = [0, 1, 2].map(|c| sense * cos * along[c] + sin * out[c]);
                    row_of_teeth(&end, [0, 2 + k], pitch, line, &v)
                });
                let off = rows.map(|row| (found - row).abs());
                assert!(off[0].min(off[1]) < 1e-12, "{found}, not {rows:?}");
            }
        }
    }
}
