//! Mechanisms in ordinary configurations, with extreme masses and lengths.

use model::{Body, BodyRef, Description, Function};

use crate::mechanisms::cranks::cranks;
use crate::mechanisms::robot::robot;
use crate::mechanisms::{revolute, rod};

const GRAVITY: [f64; 2] = [0.0, -9.81];

/// Powers of ten by which masses differ.
const MASSES: [i32; 8] = [6, -6, 9, -9, 12, -12, 24, -24];

/// Powers of ten by which lengths differ.
const LENGTHS: [i32; 6] = [6, -6, 9, -9, 12, -12];

const LINKS: usize = 6;

/// A mechanism at its initial state.
pub(super) struct Scene {
    pub(super) name: String,
    /// Name of the extreme quantity: the power of ten of the masses or of the lengths.
    pub(super) varied: &'static str,
    /// Value of the extreme quantity.
    pub(super) value: f64,
    pub(super) description: Description,
    /// The expected words of the error message, if the rounding of the data to 53 bits already
    /// makes the mechanism undetermined; otherwise `None`.
    pub(super) limit: Option<&'static str>,
}

impl Scene {
    fn new(what: &str, varied: &'static str, power: i32, description: Description) -> Self {
        Self {
            name: format!("{what}, 1e{power}"),
            varied,
            value: f64::from(power),
            description,
            limit: None,
        }
    }
}

/// Returns all scenes.
pub(super) fn scenes() -> Vec<Scene> {
    let mut scenes = Vec::new();
    for power in MASSES {
        let scene =
            |what: &str, d: Description| Scene::new(what, "power of ten of masses", power, d);
        scenes.extend(chains_of_masses(power).map(|(what, d)| scene(what, d)));
        scenes.extend(loops(power).map(|(what, d)| scene(what, d)));
        scenes.extend(robots(power).map(|(what, d)| scene(what, d)));
    }
    for power in LENGTHS {
        let scene =
            |what: &str, d: Description| Scene::new(what, "power of ten of lengths", power, d);
        scenes.extend(chains_of_lengths(power).map(|(what, d)| scene(what, d)));
    }
    // Positions at a distance of 1e12 m are accurate to a tenth of a millimetre, which is not
    // accurate enough for pins one metre apart.
    let is_blurred = |scene: &&mut Scene| {
        [
            "chain of alternating lengths, 1e12",
            "chain of mixed lengths and masses, 1e12",
        ]
        .contains(&scene.name.as_str())
    };
    for scene in scenes.iter_mut().filter(is_blurred) {
        scene.limit = Some("the rank of the start is undecided");
    }
    let massless = turned_robot(|body| {
        if body.name.contains("knuckle") {
            0.0
        } else {
            1.0
        }
    });
    scenes.push(Scene {
        name: "robot with massless forks".to_owned(),
        varied: "power of ten of masses",
        value: 0.0,
        description: massless,
        limit: None,
    });
    scenes
}

/// Returns a chain of rods that hangs from the origin, with general angles and rates.
fn chain(mass: impl Fn(usize) -> f64, length: impl Fn(usize) -> f64) -> Description {
    let mut bodies: Vec<Body> = Vec::new();
    let mut joints = Vec::new();
    let (mut at, mut velocity) = ([0.0; 2], [0.0; 2]);
    for k in 0..LINKS {
        let (angle, rate) = (-1.3 + 0.43 * k as f64, 0.7 - 0.37 * k as f64);
        let arm = [length(k) * angle.cos(), length(k) * angle.sin()];
        let end = [at[0] + arm[0], at[1] + arm[1]];
        let of_end = [velocity[0] - rate * arm[1], velocity[1] + rate * arm[0]];
        bodies.push(Body {
            velocity: Some([
                0.5 * (velocity[0] + of_end[0]),
                0.5 * (velocity[1] + of_end[1]),
            ]),
            angular_velocity: Some(rate),
            ..rod(&format!("link {}", k + 1), mass(k), at, end)
        });
        let before = k.checked_sub(1).map_or(BodyRef::Ground, BodyRef::Body);
        joints.push((format!("pin {}", k + 1), [before, BodyRef::Body(k)], at));
        (at, velocity) = (end, of_end);
    }
    let joints = joints
        .iter()
        .map(|(name, pair, at)| revolute(name, &bodies, *pair, *at));
    Description {
        name: "chain".into(),
        gravity: GRAVITY,
        joints: joints.collect(),
        bodies,
        ..Description::default()
    }
}

fn power_of_ten(power: f64) -> f64 {
    10_f64.powf(power)
}

/// Returns a function for a mass or length that grows from 1 to 10^power along the chain.
fn growing(power: i32) -> impl Fn(usize) -> f64 {
    move |k| power_of_ten(f64::from(power) * k as f64 / (LINKS - 1) as f64)
}

fn alternating(power: i32) -> impl Fn(usize) -> f64 {
    move |k| {
        if k % 2 == 1 {
            power_of_ten(f64::from(power))
        } else {
            1.0
        }
    }
}

fn only(link: usize, power: i32) -> impl Fn(usize) -> f64 {
    move |k| {
        if k == link {
            power_of_ten(f64::from(power))
        } else {
            1.0
        }
    }
}

fn ordinary(_: usize) -> f64 {
    1.0
}

fn chains_of_masses(power: i32) -> [(&'static str, Description); 4] {
    [
        (
            "chain of alternating masses",
            chain(alternating(power), ordinary),
        ),
        ("chain of growing masses", chain(growing(power), ordinary)),
        (
            "chain with another first mass",
            chain(only(0, power), ordinary),
        ),
        (
            "chain with another last mass",
            chain(only(LINKS - 1, power), ordinary),
        ),
    ]
}

fn chains_of_lengths(power: i32) -> [(&'static str, Description); 4] {
    let all = power_of_ten(f64::from(power));
    [
        ("chain of another length", chain(ordinary, move |_| all)),
        (
            "chain of alternating lengths",
            chain(ordinary, alternating(power)),
        ),
        ("chain of mixed lengths", chain(ordinary, growing(power))),
        (
            "chain of mixed lengths and masses",
            chain(growing(power), alternating(power)),
        ),
    ]
}

/// Returns closed loops with one body of a different mass.
fn loops(power: i32) -> [(&'static str, Description); 5] {
    let by = power_of_ten(f64::from(power));
    let heavier = |mut d: Description, body: usize| {
        d.bodies[body].mass *= by;
        d.bodies[body].inertia *= by;
        d.bodies[0].angular_velocity = Some(0.8);
        d.gravity = GRAVITY;
        d
    };
    let (two, three) = (
        || cranks(&[0.0, 2.0], 1.0, 0.7),
        || cranks(&[0.0, 1.0, 2.5], 1.0, 0.7),
    );
    [
        ("parallelogram with another crank", heavier(two(), 0)),
        ("parallelogram with another coupler", heavier(two(), 2)),
        ("three cranks, another middle one", heavier(three(), 1)),
        (
            "three cranks, another coupler of three",
            heavier(three(), 3),
        ),
        ("four-bar with another coupler", heavier(four_bar(), 1)),
    ]
}

/// Returns a crank, a coupler and a rocker of unequal lengths.
fn four_bar() -> Description {
    let points = [[0.0, 0.0], [0.6, 0.8], [3.5, 2.1], [4.0, 0.0]];
    let names = ["crank", "coupler", "rocker"];
    let bodies: Vec<Body> = (0..3)
        .map(|k| rod(names[k], 1.0 + k as f64, points[k], points[k + 1]))
        .collect();
    let body = |k: Option<usize>| k.filter(|&k| k < 3).map_or(BodyRef::Ground, BodyRef::Body);
    let joints = (0..4_usize).map(|k| {
        let pair = [body(k.checked_sub(1)), body(Some(k))];
        revolute(&format!("pin {}", k + 1), &bodies, pair, points[k])
    });
    Description {
        name: "four-bar".into(),
        joints: joints.collect(),
        bodies,
        ..Description::default()
    }
}

fn robots(power: i32) -> [(&'static str, Description); 3] {
    let by = power_of_ten(f64::from(power));
    let robot = |which: fn(&str) -> bool| {
        turned_robot(move |body| if which(&body.name) { by } else { 1.0 })
    };
    [
        (
            "robot with another front fork",
            robot(|name| name == "front-knuckle"),
        ),
        (
            "robot with two other forks",
            robot(|name| name.contains("knuckle")),
        ),
        (
            "robot with another trolley",
            robot(|name| name == "trolley"),
        ),
    ]
}

/// Returns the robot, rotated relative to the axes of the ground. The trolley is at an angle, the
/// steering rotates, and each mass is multiplied by the factor `by`.
fn turned_robot(by: impl Fn(&Body) -> f64) -> Description {
    let steering = Function::constant_rate(0.05).expect("a finite rate");
    let mut d = robot(steering);
    let (sin, cos) = 0.4_f64.sin_cos();
    let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    for body in &mut d.bodies {
        let factor = by(body);
        body.mass *= factor;
        body.inertia *= factor;
        body.position = turn(body.position);
        body.velocity = body.velocity.map(turn);
        body.angle += 0.4;
    }
    // The trolley is perpendicular to the robot, so it rotates while the robot pulls it.
    let hitch = turn([-0.4, 0.0]);
    let arm = 0.35_f64;
    let angle = 0.4 + 0.3;
    if let Some(trolley) = d.bodies.iter_mut().find(|body| body.name == "trolley") {
        trolley.angle = angle;
        trolley.position = [hitch[0] - arm * angle.cos(), hitch[1] - arm * angle.sin()];
    }
    d
}
