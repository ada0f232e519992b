//! Compares the motion of robots on wheels, seen from above, with closed forms: the spin of a
//! `rolling` joint is absolute or relative to the carrier.

use std::fmt::Write as _;
use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions};
use model::Registry;
use pfaff::{RunOptions, Study};

/// Radius of the wheels (m).
const RADIUS: f64 = 0.04;

/// The error of the integration over some seconds at a tolerance of 1e-12 (m, rad).
const OFF: f64 = 1e-9;

/// A wheel of a robot: its position on the deck, its direction of rolling, and the rate of its
/// motor (rad/s).
struct Wheel {
    at: [f64; 2],
    direction: [f64; 2],
    rate: f64,
}

impl Wheel {
    /// Returns the wheel whose motor moves the deck with the velocity `v` and the rate `omega`, in
    /// the axes of the deck. The spin of the wheel is relative to the deck.
    fn for_motion(at: [f64; 2], direction: [f64; 2], v: [f64; 2], omega: f64) -> Self {
        let at_wheel = [v[0] - omega * at[1], v[1] + omega * at[0]];
        let length = direction[0].hypot(direction[1]);
        let along = (direction[0] * at_wheel[0] + direction[1] * at_wheel[1]) / length;
        Self {
            at,
            direction,
            rate: along / RADIUS,
        }
    }
}

/// Returns a deck on wheels with motors, and further joints.
fn robot(wheels: &[Wheel], spin: &str, joints: &str) -> String {
    let mut text = "scene = { name = \"robot\", space = \"plane\" }\n\
         [[body]]\nname = \"deck\"\nmass = 12.0\ninertia = 0.4\n"
        .to_owned();
    for (
        k,
        Wheel {
            at,
            direction,
            rate,
        },
    ) in wheels.iter().enumerate()
    {
        write!(
            text,
            "[[body]]\nname = \"wheel {k}\"\nmass = 0.5\ninertia = 0.002\nposition = {at:?}\n\
             [[joint]]\nname = \"axle {k}\"\ntype = \"revolute\"\nbodies = [\"deck\", \"wheel {k}\"]\nat = {at:?}\n\
             [[joint]]\nname = \"roll {k}\"\ntype = \"rolling\"\nbodies = [\"deck\", \"wheel {k}\"]\nat = {at:?}\n\
             direction = {direction:?}\nradius = {RADIUS}\n{spin}\n\
             [[drive]]\nname = \"motor {k}\"\njoint = \"axle {k}\"\ntype = \"angle\"\n\
             motion = {{ type = \"constant-rate\", rate = {rate:?} }}\n"
        )
        .expect("a text");
    }
    text + joints
}

/// Runs the robot and returns the pose of the deck at the end.
fn end(text: &str, t_end: f64) -> [f64; 3] {
    let study = Study::read(
        "robot.toml",
        text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    let study = study.unwrap_or_else(|e| panic!("{text}\n{e}"));
    let options = MotionOptions {
        rtol: 1e-12,
        atol: 1e-12,
        method: Method::Dop853,
        output_step: t_end,
        ..MotionOptions::to(t_end)
    };
    let mut pose = [0.0; 3];
    let summary = study.run(&options, |sample| {
        pose.copy_from_slice(&sample.q[..3]);
        Ok(ControlFlow::Continue(()))
    });
    summary.unwrap_or_else(|e| panic!("{}", e.error));
    pose
}

/// Returns the pose after the time `t` with the constant velocity `v` in the axes of the deck and
/// the rate `omega`: the deck moves on a circle.
fn on_a_circle([vx, vy]: [f64; 2], omega: f64, t: f64) -> [f64; 3] {
    let angle = omega * t;
    if omega == 0.0 {
        return [vx * t, vy * t, 0.0];
    }
    let (sin, versine) = (angle.sin(), 1.0 - angle.cos());
    [
        (vx * sin - vy * versine) / omega,
        (vx * versine + vy * sin) / omega,
        angle,
    ]
}

#[track_caller]
fn close(found: [f64; 3], expected: [f64; 3]) {
    let off = found.iter().zip(expected).map(|(x, y)| (x - y).abs());
    assert!(
        off.fold(0.0, f64::max) <= OFF,
        "{found:?}, not {expected:?}"
    );
}

/// Four mecanum wheels at (±a, ±b) roll along (1, ∓1). Motors that turn the left wheels backwards
/// and the right wheels forwards at the rate Ω turn the deck on the spot at √2·r·Ω/(a + b).
#[test]
fn a_mecanum_deck_turns_on_the_spot() {
    let (a, b, omega, t) = (0.25, 0.2, 1.3, 4.0);
    let motions = [([0.0, 0.0], omega), ([0.3, -0.2], omega), ([0.3, 0.4], 0.0)];
    for (v, omega) in motions {
        let corners = [[a, b], [a, -b], [-a, b], [-a, -b]];
        let wheels = corners.map(|at| {
            let across = if at[0] * at[1] > 0.0 { -1.0 } else { 1.0 };
            Wheel::for_motion(at, [1.0, across], v, omega)
        });
        if v == [0.0, 0.0] {
            let rate = omega * (a + b) / (2.0_f64.sqrt() * RADIUS);
            for (wheel, expected) in wheels.iter().zip([-rate, rate, -rate, rate]) {
                assert!((wheel.rate - expected).abs() < 1e-12 * rate);
            }
        }
        let text = robot(&wheels, "spin = \"relative\"", "");
        close(end(&text, t), on_a_circle(v, omega, t));
    }
}

/// Two wheels at (0, ±b) with the rates Ω_l and Ω_r relative to the deck: ω = r·(Ω_r − Ω_l)/(2b)
/// and v = r·(Ω_l + Ω_r)/2. If the spin is absolute, it is Ω + ω, which adds r·ω to v.
#[test]
fn two_wheels_move_a_deck_on_a_circle() {
    let (b, left, right, t) = (0.15, 3.0, 8.0, 5.0);
    let omega = RADIUS * (right - left) / (2.0 * b);
    let v = 0.5 * RADIUS * (left + right);
    let wheels = [(b, left), (-b, right)].map(|(y, rate)| Wheel {
        at: [0.0, y],
        direction: [1.0, 0.0],
        rate,
    });
    let edge = "[[joint]]\nname = \"edge\"\ntype = \"knife-edge\"\nbody = \"deck\"\nat = [0, 0]\nnormal = [0, 1]\n";
    let spins = [
        ("spin = \"relative\"", v),
        ("spin = \"absolute\"", v + RADIUS * omega),
        ("", v + RADIUS * omega),
    ];
    for (spin, v) in spins {
        let text = robot(&wheels, spin, edge);
        close(end(&text, t), on_a_circle([v, 0.0], omega, t));
    }
}
