//! Three robots of usual size: a biped with four closed loops in its legs, a humanoid of 45 bodies,
//! and an arm of seven axes with a gripper of two linkages. Every joint has a damper, every motor
//! has an armature. Prints the time of one second of motion by each method without reactions, and
//! the difference from a run with a much smaller tolerance.
//!
//! `cargo run --release -p lab --example robots -- [RTOL]`
//!
//! The biped and the humanoid fall freely with an initial rotation. The arm falls from a bent pose.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::time::Instant;

use pfaff::dynamics::Method;
use pfaff::model::Registry;
use pfaff::{RunOptions, Study};

/// End time (s).
const T_END: f64 = 1.0;

/// Relative tolerance of the runs, unless it is given, and of the reference.
const RTOL: f64 = 1e-6;
const REFERENCE: f64 = 1e-11;

/// Runs of each method; the fastest counts.
const RUNS: usize = 3;

type Point = [f64; 3];

/// The first point of a link, and the axis of the joint at this point.
type Link = (Point, Point);

/// A scene text that grows by bodies and joints.
struct Robot {
    bodies: String,
    joints: String,
    forces: String,
    /// Angular velocity of all bodies about the origin (rad/s).
    omega: Point,
}

/// A joint of a robot with a damper (N·m·s/rad) and an armature (kg·m²).
struct Axis {
    at: Point,
    axis: Point,
    damping: f64,
    armature: f64,
}

impl Axis {
    /// A driven joint.
    fn motor(at: Point, axis: Point) -> Self {
        let (damping, armature) = (1.0, 0.05);
        Self {
            at,
            axis,
            damping,
            armature,
        }
    }

    /// A joint of light parts, without motor.
    fn light(at: Point, axis: Point) -> Self {
        Self {
            damping: 0.1,
            ..Self::hinge(at, axis)
        }
    }

    /// A joint without motor.
    fn hinge(at: Point, axis: Point) -> Self {
        let (damping, armature) = (1.0, 0.0);
        Self {
            at,
            axis,
            damping,
            armature,
        }
    }
}

impl Robot {
    fn new(omega: Point) -> Self {
        Self {
            bodies: String::new(),
            joints: String::new(),
            forces: String::new(),
            omega,
        }
    }

    /// Adds a body between two points: a rod of this mass (kg) with the radius 0.04 m.
    fn body(&mut self, name: &str, mass: f64, [from, to]: [Point; 2]) {
        let centre: Point = std::array::from_fn(|i| 0.5 * (from[i] + to[i]));
        let along: Point = std::array::from_fn(|i| to[i] - from[i]);
        let square = along.iter().map(|x| x * x).sum::<f64>();
        let inertia = |i: usize, j: usize| {
            let round = if i == j { 0.04 * 0.04 / 4.0 } else { 0.0 };
            let diagonal = if i == j { square } else { 0.0 };
            mass * (round + (diagonal - along[i] * along[j]) / 12.0)
        };
        let rows: [Point; 3] = std::array::from_fn(|i| std::array::from_fn(|j| inertia(i, j)));
        let [w, r] = [self.omega, centre];
        let velocity = [
            w[1] * r[2] - w[2] * r[1],
            w[2] * r[0] - w[0] * r[2],
            w[0] * r[1] - w[1] * r[0],
        ];
        let _ = writeln!(
            self.bodies,
            "  {{ name = \"{name}\", mass = {mass:?}, inertia = {rows:?}, position = {centre:?}, \
             velocity = {velocity:?}, angular_velocity = {w:?} }},"
        );
    }

    fn revolute(&mut self, name: &str, bodies: [&str; 2], with: Axis) {
        let Axis {
            at,
            axis,
            damping,
            armature,
        } = with;
        let _ = writeln!(
            self.joints,
            "  {{ name = \"{name}\", type = \"revolute\", bodies = {bodies:?}, at = {at:?}, \
             axis = {axis:?}, armature = {armature:?} }},"
        );
        self.torsion(name, 0.0, damping);
    }

    fn torsion(&mut self, joint: &str, stiffness: f64, damping: f64) {
        let _ = writeln!(
            self.forces,
            "  {{ name = \"spring of {joint}, {stiffness:?}\", type = \"torsion-spring-damper\", \
             joint = \"{joint}\", stiffness = {stiffness:?}, damping = {damping:?} }},"
        );
    }

    fn ball(&mut self, name: &str, bodies: [&str; 2], at: Point) {
        let _ = writeln!(
            self.joints,
            "  {{ name = \"{name}\", type = \"spherical\", bodies = {bodies:?}, at = {at:?} }},"
        );
    }

    /// Adds a chain of links behind a body. The first point is the first joint, and each link ends
    /// at the next point.
    fn chain(
        &mut self,
        [name, base]: [&str; 2],
        mass: f64,
        links: &[Link],
        end: Point,
        joint: fn(Point, Point) -> Axis,
    ) {
        let mut before = base.to_owned();
        for (k, &(at, axis)) in links.iter().enumerate() {
            let own = format!("{name} {k}");
            let to = links.get(k + 1).map_or(end, |next| next.0);
            let mass = mass / (1.0 + 0.3 * k as f64);
            // A link without length is a cross of a joint of several axes.
            let from = if to == at { at.map(|x| x - 0.02) } else { at };
            self.body(&own, mass, [from, to]);
            self.revolute(&format!("{own} axis"), [&before, &own], joint(at, axis));
            before = own;
        }
    }

    fn scene(&self, name: &str) -> String {
        let Self {
            bodies,
            joints,
            forces,
            ..
        } = self;
        format!(
            "scene = {{ name = \"{name}\", space = \"spatial\", gravity = [0.0, 0.0, -9.81], \
             tolerance = 1e-7 }}\nbody = [\n{bodies}]\njoint = [\n{joints}]\nforce = [\n{forces}]\n\
             output = {{ reactions = false, report = false }}\n"
        )
    }
}

const X: Point = [1.0, 0.0, 0.0];
const Y: Point = [0.0, 1.0, 0.0];
const Z: Point = [0.0, 0.0, 1.0];

/// A biped of 19 bodies. In each leg, a rod from thigh to tarsus and a rod from crank to foot close
/// loops, and a spring is in the shin.
fn biped() -> String {
    let mut r = Robot::new([0.4, 0.8, 0.3]);
    r.body("pelvis", 10.0, [[0.0, -0.1, 1.0], [0.0, 0.1, 1.0]]);
    for (side, y) in [("left", 0.13), ("right", -0.13)] {
        let n = |part: &str| format!("{side} {part}");
        let p = |x: f64, z: f64| [x, y, z];
        let hip = p(0.02, 0.95);
        for (part, mass, ends) in [
            ("roll", 1.8, [p(0.02, 1.0), p(0.02, 0.97)]),
            ("yaw", 1.2, [p(0.02, 0.97), hip]),
            ("thigh", 5.5, [hip, p(0.12, 0.60)]),
            ("shin", 0.6, [p(0.12, 0.60), p(0.18, 0.52)]),
            ("tarsus", 0.8, [p(0.18, 0.52), p(-0.12, 0.14)]),
            ("rod", 0.2, [p(0.02, 0.93), p(0.10, 0.40)]),
            ("crank", 0.1, [p(-0.02, 0.27), p(0.03, 0.25)]),
            ("plantar", 0.1, [p(0.03, 0.25), p(-0.06, 0.13)]),
            ("foot", 0.15, [p(-0.12, 0.14), p(0.0, 0.02)]),
        ] {
            r.body(&n(part), mass, ends);
        }
        let joint = |r: &mut Robot, name: &str, first: &str, second: &str, with: Axis| {
            let first = if first == "pelvis" {
                first.to_owned()
            } else {
                n(first)
            };
            r.revolute(&n(name), [&first, &n(second)], with);
        };
        joint(
            &mut r,
            "hip roll",
            "pelvis",
            "roll",
            Axis::motor(p(0.02, 1.0), X),
        );
        joint(
            &mut r,
            "hip yaw",
            "roll",
            "yaw",
            Axis::motor(p(0.02, 0.97), Z),
        );
        joint(&mut r, "hip pitch", "yaw", "thigh", Axis::motor(hip, Y));
        joint(
            &mut r,
            "knee",
            "thigh",
            "shin",
            Axis::motor(p(0.12, 0.60), Y),
        );
        joint(
            &mut r,
            "spring",
            "shin",
            "tarsus",
            Axis::hinge(p(0.18, 0.52), Y),
        );
        r.torsion(&n("spring"), 1500.0, 0.0);
        joint(
            &mut r,
            "toe motor",
            "tarsus",
            "crank",
            Axis::motor(p(-0.02, 0.27), Y),
        );
        joint(
            &mut r,
            "ankle",
            "tarsus",
            "foot",
            Axis::hinge(p(-0.12, 0.14), Y),
        );
        for (name, first, second, at) in [
            ("rod top", "thigh", "rod", p(0.02, 0.93)),
            ("rod end", "rod", "tarsus", p(0.10, 0.40)),
            ("plantar top", "crank", "plantar", p(0.03, 0.25)),
            ("plantar end", "plantar", "foot", p(-0.06, 0.13)),
        ] {
            r.ball(&n(name), [&n(first), &n(second)], at);
        }
    }
    r.scene("biped")
}

/// A humanoid of 45 bodies without loops, with 50 free motions.
fn humanoid() -> String {
    let mut r = Robot::new([0.3, 0.6, 0.5]);
    r.body("pelvis", 8.0, [[0.0, -0.1, 1.0], [0.0, 0.1, 1.0]]);
    let at = |z: f64| [0.0, 0.0, z];
    let spine = [(at(1.05), Z), (at(1.15), X), (at(1.25), Y)];
    r.chain(["spine", "pelvis"], 7.0, &spine, at(1.5), Axis::motor);
    r.chain(
        ["neck", "spine 2"],
        1.5,
        &[(at(1.5), Z), (at(1.55), Y), (at(1.6), X)],
        at(1.75),
        Axis::motor,
    );
    for (side, y) in [("left", 1.0), ("right", -1.0)] {
        let p = |x: f64, lateral: f64, z: f64| [x, y * lateral, z];
        let leg = [
            (p(0.0, 0.12, 0.98), Z),
            (p(0.0, 0.12, 0.95), X),
            (p(0.0, 0.12, 0.92), Y),
            (p(0.05, 0.12, 0.52), Y),
            (p(0.0, 0.12, 0.10), Y),
            (p(0.0, 0.12, 0.07), X),
        ];
        r.chain(
            [&format!("{side} leg"), "pelvis"],
            4.0,
            &leg,
            p(0.12, 0.12, 0.02),
            Axis::motor,
        );
        let arm = [
            (p(0.0, 0.20, 1.45), Y),
            (p(0.0, 0.24, 1.45), X),
            (p(0.0, 0.25, 1.38), Z),
            (p(0.02, 0.26, 1.18), Y),
            (p(0.10, 0.27, 1.02), Z),
            (p(0.15, 0.27, 0.95), X),
            (p(0.16, 0.27, 0.93), Y),
        ];
        r.chain(
            [&format!("{side} arm"), "spine 2"],
            2.0,
            &arm,
            p(0.18, 0.27, 0.88),
            Axis::motor,
        );
        for (k, shift) in [0.0, 0.02, 0.04].into_iter().enumerate() {
            let finger = [
                (p(0.18, 0.27 + shift, 0.88), Y),
                (p(0.19, 0.27 + shift, 0.85), Y),
            ];
            let name = format!("{side} finger {k}");
            r.chain(
                [&name, &format!("{side} arm 6")],
                0.05,
                &finger,
                p(0.20, 0.27 + shift, 0.81),
                Axis::light,
            );
        }
    }
    r.scene("humanoid")
}

/// An arm of seven axes with a gripper of two parallelograms that move equally.
fn arm() -> String {
    let mut r = Robot::new([0.0; 3]);
    let at = |x: f64, z: f64| [x, 0.0, z];
    let links = [
        (at(0.0, 0.25), Z),
        (at(0.0, 0.35), Y),
        (at(0.05, 0.65), Z),
        (at(0.10, 0.68), Y),
        (at(0.35, 0.75), X),
        (at(0.40, 0.74), Y),
        (at(0.45, 0.70), Z),
    ];
    r.chain(["link", "ground"], 2.4, &links, at(0.45, 0.60), Axis::motor);
    for (side, y) in [("left", 1.0), ("right", -1.0)] {
        let n = |part: &str| format!("{side} {part}");
        let p = |lateral: f64, z: f64| [0.45, y * lateral, z];
        for (part, ends) in [
            ("driver", [p(0.035, 0.56), p(0.07, 0.52)]),
            ("finger", [p(0.07, 0.52), p(0.055, 0.46)]),
            ("follower", [p(0.02, 0.545), p(0.055, 0.505)]),
        ] {
            r.body(&n(part), 0.05, ends);
        }
        let with = Axis {
            damping: 0.1,
            armature: 0.005,
            ..Axis::motor(p(0.035, 0.56), X)
        };
        r.revolute(&n("drive"), ["link 6", &n("driver")], with);
        let tip = Axis::light(p(0.07, 0.52), X);
        r.revolute(&n("tip"), [&n("driver"), &n("finger")], tip);
        let back = Axis::light(p(0.02, 0.545), X);
        r.revolute(&n("back"), ["link 6", &n("follower")], back);
        r.ball(&n("close"), [&n("finger"), &n("follower")], p(0.055, 0.505));
    }
    let _ = writeln!(
        r.joints,
        "  {{ name = \"equal\", type = \"coupling\", measures = [\"left drive.angle\", \
         \"right drive.angle\"], ratio = -1.0 }},"
    );
    r.scene("arm")
}

/// A run of one second: processor time (s), evaluations and the final coordinates.
struct Ended {
    seconds: f64,
    method: &'static str,
    evaluations: u64,
    q: Vec<f64>,
}

fn run(text: &str, method: Method, rtol: f64) -> Result<Ended, Box<dyn Error>> {
    let overrides = RunOptions {
        rtol: Some(rtol),
        atol: Some(rtol),
        t_end: Some(T_END),
        method: Some(method),
        ..RunOptions::default()
    };
    let study = Study::read("robot", text, &Registry::standard(), &overrides)?;
    let mut options = study.options.clone().ok_or("no end")?;
    options.output_step = T_END;
    let mut q = Vec::new();
    let clock = Instant::now();
    let ended = pfaff::dynamics::simulate(&study.prepared, &options, |row| {
        q = row.q.to_vec();
        Ok(ControlFlow::Continue(()))
    })?;
    Ok(Ended {
        seconds: clock.elapsed().as_secs_f64(),
        method: ended.method.name(),
        evaluations: ended.evaluations,
        q,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let rtol = std::env::args()
        .nth(1)
        .map_or(Ok(RTOL), |rtol| rtol.parse())?;
    println!("robot     bodies  rank  mobility  method  seconds  evaluations  difference");
    for (name, text) in [("biped", biped()), ("humanoid", humanoid()), ("arm", arm())] {
        let study = Study::read(name, &text, &Registry::standard(), &RunOptions::default())
            .map_err(|e| format!("{name}: {e}\n{text}"))?;
        let (bodies, rank) = (
            study.prepared.mechanism.bodies().len(),
            study.prepared.decision.rank,
        );
        let reference = run(&text, Method::Dop853, REFERENCE)?;
        for method in [Method::Auto, Method::Dop853, Method::Radau5] {
            let mut best = run(&text, method, rtol)?;
            for _ in 1..RUNS {
                let again = run(&text, method, rtol)?;
                best.seconds = best.seconds.min(again.seconds);
            }
            let difference = best.q.iter().zip(&reference.q);
            let difference = difference.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            println!(
                "{name:9} {bodies:6} {rank:5} {:9}  {:6} {:8.3} {:12} {difference:11.1e}",
                6 * bodies - rank,
                best.method,
                best.seconds,
                best.evaluations
            );
        }
    }
    Ok(())
}
