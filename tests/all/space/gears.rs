//! Compares gear meshes between wheels on a carrier with closed forms: ranks and verdicts of
//! differentials and planetary gears, their motion over hundreds of revolutions, and the tooth
//! force.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions, Summary};
use joints::space3::{Pose, cross, dot};
use model::{Mechanism, Reaction, Registry, System};
use pfaff::{ConfigurationAnalysis, RunOptions, Study};
use solvability::Verdict;

use super::verdicts::Motion;
use crate::freedoms::are_a_basis;

pub(super) fn study(text: &str) -> Study {
    let study = Study::read(
        "gears.toml",
        text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    study.unwrap_or_else(|e| panic!("{text}\n{e}"))
}

/// The end of a run: state, reactions in the order of the groups, and recorded values.
pub(super) struct End {
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) reactions: Vec<Reaction>,
    pub(super) summary: Summary,
}

impl End {
    pub(super) fn of(study: &Study, t_end: f64) -> Self {
        let options = MotionOptions {
            rtol: 1e-10,
            atol: 1e-10,
            method: Method::Dop853,
            output_step: t_end,
            ..MotionOptions::to(t_end)
        };
        let (mut q, mut v, mut reactions) = (Vec::new(), Vec::new(), Vec::new());
        let summary = study.run(&options, |sample| {
            (q, v) = (sample.q.to_vec(), sample.v.to_vec());
            reactions = sample.reactions()?.as_chosen().to_vec();
            Ok(ControlFlow::Continue(()))
        });
        let summary = summary.unwrap_or_else(|e| panic!("{}", e.error));
        Self {
            q,
            v,
            reactions,
            summary,
        }
    }

    pub(super) fn pose(&self, body: usize) -> Pose {
        let q = &self.q[7 * body..];
        Pose::new([q[0], q[1], q[2]], [q[3], q[4], q[5], q[6]])
    }

    /// Returns the angular velocity in the axes of a body.
    pub(super) fn omega(&self, body: usize) -> [f64; 3] {
        [3, 4, 5].map(|k| self.v[6 * body + k])
    }
}

#[track_caller]
pub(super) fn close(found: f64, expected: f64, bound: f64) {
    assert!((found - expected).abs() <= bound, "{found}, not {expected}");
}

/// Returns rows, rank, redundancy and mobility.
pub(super) fn counts(configuration: &ConfigurationAnalysis) -> [usize; 4] {
    let found = &configuration.analysis;
    let rows = found.holonomic_rows + found.nonholonomic_rows;
    let rank = found.decision.rank;
    [rows, rank, rows - rank, found.mobility()]
}

fn is_unique(configuration: &ConfigurationAnalysis, combination: &str) -> bool {
    let groups = configuration.groups(&[combination.to_owned()]);
    let groups = groups.unwrap_or_else(|e| panic!("{combination}: {e}"));
    let (_, group) = groups.last().expect("one group");
    assert!(!matches!(
        group.judgement.verdict,
        Verdict::Undecided { .. }
    ));
    group.judgement.verdict == Verdict::Unique
}

// A bevel differential. Its case turns about x; both side gears turn about x on the case, and
// planet k turns about u_k across x. The pitch radii of side gears and planets are:
const SIDE: f64 = 0.06;
const PLANET: f64 = 0.04;

/// Returns the direction of the axis of planet k of n.
fn spoke(k: usize, n: usize) -> [f64; 3] {
    let (sin, cos) = (0.3 + TAU * k as f64 / n as f64).sin_cos();
    [0.0, cos, sin]
}

/// Returns the differential with n planets, moved as a whole; all bodies have the axes of this
/// motion. The bodies are case, left, right, and the planets.
fn differential(n: usize, Motion(pose): Motion, quaternion: [f64; 4], rates: [f64; 2]) -> String {
    let point = |p: [f64; 3]| format!("{:?}", pose.to_global(p));
    let vector = |d: [f64; 3]| format!("{:?}", pose.direction_to_global(d));
    let [case, side] = rates;
    let body = |name: &str, mass: f64, inertia: [f64; 3], at: [f64; 3], omega: [f64; 3]| {
        let velocity = cross([case, 0.0, 0.0], at);
        format!(
            "[[body]]\nname = \"{name}\"\nmass = {mass}\ninertia = {inertia:?}\nposition = {}\n\
             orientation = {{ quaternion = {quaternion:?} }}\nvelocity = {}\nangular_velocity = {}\n",
            point(at),
            vector(velocity),
            vector(omega),
        )
    };
    let mut text = "[scene]\nname = \"differential\"\nspace = \"spatial\"\n".to_owned();
    text += &body("case", 2.0, [0.02, 0.03, 0.03], [0.0; 3], [case, 0.0, 0.0]);
    for (name, x, omega) in [("left", -0.04, case + side), ("right", 0.04, case - side)] {
        text += &body(
            name,
            0.5,
            [1e-3, 8e-4, 8e-4],
            [x, 0.0, 0.0],
            [omega, 0.0, 0.0],
        );
    }
    for k in 0..n {
        let u = spoke(k, n);
        let spin = side * SIDE / PLANET;
        let omega = [case, spin * u[1], spin * u[2]];
        text += &body(
            &format!("planet-{k}"),
            0.2,
            [1e-4; 3],
            u.map(|x| SIDE * x),
            omega,
        );
    }
    let mut revolute = |name: &str, bodies: [&str; 2], at: [f64; 3], axis: [f64; 3]| {
        write!(
            text,
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = {bodies:?}\nat = {}\naxis = {axis:?}\n",
            point(at)
        )
    };
    let x = [1.0, 0.0, 0.0];
    let mut all = vec![
        revolute("case-bearing", ["case", "ground"], [0.0; 3], x),
        revolute("left-bearing", ["case", "left"], [-0.04, 0.0, 0.0], x),
        // A bearing may list the carrier last.
        revolute("right-bearing", ["right", "case"], [0.04, 0.0, 0.0], x),
    ];
    for k in 0..n {
        let u = spoke(k, n);
        let planet = format!("planet-{k}");
        let pin = format!("pin-{k}");
        all.push(revolute(&pin, ["case", &planet], u.map(|x| 0.05 * x), u));
    }
    assert!(all.into_iter().all(|written| written.is_ok()));
    for k in 0..n {
        for (side, along) in [("left", -PLANET), ("right", PLANET)] {
            let u = spoke(k, n);
            let at = point([along, SIDE * u[1], SIDE * u[2]]);
            text += &format!(
                "[[joint]]\nname = \"{side}-{k}\"\ntype = \"mesh\"\nbearings = [\"{side}-bearing\", \"pin-{k}\"]\nat = {at}\n"
            );
        }
    }
    text
}

/// Returns the motions of `Motion::all` with their quaternions.
fn motions() -> [(Motion, [f64; 4]); 3] {
    let quaternions = [
        [1.0, 0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0, 1.0],
        [0.9, 0.3, -0.2, 0.5],
    ];
    let mut motions = Motion::all().into_iter().zip(quaternions);
    [(); 3].map(|()| motions.next().expect("three"))
}

/// Returns the torque of all teeth on one side gear, divided by its radius: Σ F_k·(x × u_k).
fn torque(side: &str, n: usize, Motion(pose): Motion) -> String {
    let mut text = String::new();
    for k in 0..n {
        let along = pose.direction_to_global(cross([1.0, 0.0, 0.0], spoke(k, n)));
        for (axis, c) in ["Fx", "Fy", "Fz"].into_iter().zip(along) {
            let sign = if c < 0.0 { '-' } else { '+' };
            write!(text, " {sign} {:?}*{side}-{k}.{axis}", c.abs()).expect("a text");
        }
    }
    text.trim_start_matches(" +").trim_start().to_owned()
}

/// The bearings form a tree: all redundancies belong to gear meshes, n − 1 for n planets. The
/// meshes share their load, and the torque of all of them on a side gear is determined.
#[test]
fn a_bevel_differential_has_one_planet_that_is_needed() {
    for (motion, quaternion) in motions() {
        for n in 1..=3 {
            let study = study(&differential(n, motion, quaternion, [0.0; 2]));
            let found = study.analyse(0.0, None).expect("a start");
            assert!(found.analysis.decision.is_decided());
            let rows = 5 * (n + 3) + 2 * n;
            assert_eq!(counts(&found), [rows, rows + 1 - n, n - 1, 2], "{n}");
            for reaction in &found.analysis.reactions {
                let bears_planets_or_sides = reaction.name != "case-bearing";
                let verdict = &reaction.wrench.verdict;
                let expected = n == 1 || !bears_planets_or_sides;
                assert_eq!(
                    *verdict == Verdict::Unique,
                    expected,
                    "{n}: {}",
                    reaction.name
                );
            }
            for side in ["left", "right"] {
                assert!(is_unique(&found, &torque(side, n, motion)), "{n}: {side}");
                let one = torque(side, n, motion).split(&format!("{side}-1")).count();
                assert_eq!(one > 1, n > 1);
            }
        }
    }
}

/// A torque on the case turns both side gears equally: the case has their mean rate, and their
/// difference remains. After 240 revolutions the ratio is still exact.
#[test]
fn the_case_of_a_differential_turns_with_the_mean_rate_of_its_side_gears() {
    let (case, side, torque, t) = (3.0, 22.0, 0.02, 60.0);
    let (motion, quaternion) = motions().into_iter().next_back().expect("three");
    let n = 3;
    let mut text = differential(n, motion, quaternion, [case, side]);
    let along = motion.0.direction_to_global([torque, 0.0, 0.0]);
    text += &format!(
        "[[force]]\nname = \"load\"\ntype = \"torque\"\nbody = \"case\"\ntorque = {along:?}\n"
    );
    let end = End::of(&study(&text), t);
    let planets = n as f64 * (1e-4 + 0.2 * SIDE * SIDE);
    let alpha = torque / (0.02 + 2.0 * 1e-3 + planets);
    let rate = case + alpha * t;
    let [found, left, right] = [0, 1, 2].map(|body| end.omega(body)[0]);
    close(found, 0.5 * (left + right), 1e-10 * rate);
    close(found, rate, 1e-7 * rate);
    close(left, rate + side, 1e-7 * rate);
    close(right, rate - side, 1e-7 * rate);
    // Computes unwrapped angles of the wheels relative to the case.
    let spin = side * SIDE / PLANET;
    let (turned, spun) = (side * t, spin * t);
    assert!(turned > 200.0 * TAU && spun > 300.0 * TAU);
    let counted = &end.q[7 * (n + 3)..];
    assert_eq!(counted.len(), 4 * n);
    for angles in counted.chunks(4) {
        for (found, expected) in angles.iter().zip([turned, spun, -turned, spun]) {
            close(*found, expected, 1e-5);
        }
    }
    assert!(
        end.summary.max_position_residual < 1e-11,
        "{:?}",
        end.summary
    );
}

/// Computes the row of a gear mesh for all bodies: n·(v_1(P) − v_2(P)).
pub(super) fn row_of_teeth(
    end: &End,
    [first, second]: [usize; 2],
    pitch: [f64; 3],
    line: [f64; 3],
    v: &[f64],
) -> f64 {
    let at = |body: usize| {
        let (pose, v) = (end.pose(body), &v[6 * body..]);
        let omega = pose.direction_to_global([v[3], v[4], v[5]]);
        let turned = cross(omega, [0, 1, 2].map(|k| pitch[k] - pose.r[k]));
        dot(line, [0, 1, 2].map(|k| v[k] + turned[k]))
    };
    at(first) - at(second)
}

/// Returns pseudo-random values between −1 and 1, one for each velocity.
pub(super) fn velocities(n: usize, seed: usize) -> Vec<f64> {
    let number = |k: usize| (12.9898 * (k * 7 + 1) as f64 + 78.233 * (seed + 1) as f64).sin();
    (0..n).map(number).collect()
}

/// Returns C·v for a row at the end of a run.
pub(super) fn row_of(mechanism: &Mechanism, end: &End, name: &str, v: &[f64]) -> f64 {
    let mut s = mechanism.scratch();
    mechanism.pose(end.summary.t, &end.q, &mut s);
    mechanism.c(&mut s);
    let group = mechanism.layout().groups.iter().find(|g| g.name == name);
    let row = group.expect("a joint").rows.iter().next().expect("a row");
    let mut entries = vec![0.0; v.len()];
    mechanism.layout().scatter_row(&s, row, &mut entries);
    entries.iter().zip(v).map(|(c, v)| c * v).sum()
}

/// The test is far from the start, for velocities that no bearing allows.
#[test]
fn the_row_of_teeth_is_that_of_the_pitch_point() {
    let (motion, quaternion) = motions().into_iter().next_back().expect("three");
    let study = study(&differential(2, motion, quaternion, [3.0, 22.0]));
    let end = End::of(&study, 7.3);
    let mechanism = &study.prepared.mechanism;
    let case = end.pose(0);
    let mut compared = 0;
    for k in 0..2 {
        for (body, side, along) in [(1, "left", -PLANET), (2, "right", PLANET)] {
            let u = spoke(k, 2);
            let pitch = case.to_global([along, SIDE * u[1], SIDE * u[2]]);
            let line = case.direction_to_global(cross([1.0, 0.0, 0.0], u));
            for seed in 0..20 {
                let v = velocities(end.v.len(), seed);
                let found = row_of(mechanism, &end, &format!("{side}-{k}"), &v);
                let expected = row_of_teeth(&end, [body, 3 + k], pitch, line, &v);
                close(found, expected, 1e-12);
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 80);
}

/// Spur gears of radii 0.02 and 0.05 turn on the ground; the pinion makes 203 revolutions under
/// load. The force acts along the line of action, which is inclined towards the wheel.
#[test]
fn a_train_keeps_its_ratio_and_its_teeth_press_along_the_line_of_action() {
    let (load, t, rate) = (-2.0, 32.0, 40.0);
    let text = format!(
        r#"
scene = {{ name = "train", space = "spatial" }}
body = [
    {{ name = "pinion", mass = 0.2, inertia = [1e-4, 1e-4, 1.5e-4], position = [0, 0, 0.1] }},
    {{ name = "wheel", mass = 0.9, inertia = [1e-3, 1e-3, 1.5e-3], position = [0.07, 0, 0.1] }},
]
joint = [
    {{ name = "A", type = "revolute", bodies = ["ground", "pinion"], at = [0, 0, 0], axis = [0, 0, 1] }},
    {{ name = "B", type = "revolute", bodies = ["ground", "wheel"], at = [0.07, 0, 0.2], axis = [0, 0, 1] }},
    {{ name = "teeth", type = "mesh", bearings = ["A", "B"], at = [0.02, 0, 0.1], pressure_angle = {alpha} }},
]
drive = [{{ name = "motor", joint = "A", type = "angle", motion = {{ type = "constant-rate", rate = {rate} }} }}]
force = [{{ name = "load", type = "torque", body = "wheel", torque = [0, 0, {load}] }}]
"#,
        alpha = 20.0_f64.to_radians(),
    );
    let study = study(&text);
    assert_eq!(
        counts(&study.analyse(0.0, None).expect("a start")),
        [12, 12, 0, 0]
    );
    let end = End::of(&study, t);
    assert!(rate * t > 203.0 * TAU);
    close(end.omega(1)[2], -0.4 * rate, 1e-10);
    let half = 0.5 * -0.4 * rate * t;
    let q = &end.q[7 + 3..14];
    close(q[3] * half.cos() - q[0] * half.sin(), 0.0, 1e-9);
    assert!(end.summary.max_position_residual < 1e-12);
    // The expected force is the load over the radius of the base circle, on the pinion; there is no
    // moment about the pitch point.
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    let force = -load / (0.05 * cos);
    let teeth = end.reactions[2];
    for (found, expected) in teeth.force.into_iter().zip([sin, cos, 0.0]) {
        close(found, force * expected, 1e-9);
    }
    assert!(teeth.torque.iter().all(|x| x.abs() < 1e-10), "{teeth:?}");
    close(
        end.reactions[3].component.expect("a drive"),
        0.02 * 0.05_f64.recip() * -load,
        1e-9,
    );
}

/// A helical wheel that is shifted along its axis rotates: n·(v_1(P) − v_2(P)) = 0 with a line of
/// action inclined by β is r_1·ω_1 + r_2·ω_2 = tan β·ẋ_2. The row is exact if the wheel is
/// displaced.
#[test]
fn a_helical_wheel_turns_as_it_slides() {
    let beta = 0.5_f64;
    let (sin, cos) = beta.sin_cos();
    let text = format!(
        r#"
scene = {{ name = "helical", space = "spatial" }}
body = [
    {{ name = "pinion", mass = 0.2, inertia = [1e-4, 1e-4, 1.5e-4], position = [0, 0, 0] }},
    {{ name = "wheel", mass = 0.9, inertia = [1e-3, 1e-3, 1.5e-3], position = [0.07, 0, 0] }},
]
joint = [
    {{ name = "A", type = "revolute", bodies = ["ground", "pinion"], at = [0, 0, 0], axis = [0, 0, 1] }},
    {{ name = "B", type = "cylindrical", bodies = ["ground", "wheel"], at = [0.07, 0, 0], axis = [0, 0, 1] }},
    {{ name = "teeth", type = "mesh", bearings = ["A", "B"], at = [0.02, 0, 0], line = [0, {cos}, {sin}], frame = "global" }},
]
drive = [
    {{ name = "motor", joint = "A", type = "angle", motion = {{ type = "constant-rate", rate = 5.0 }} }},
    {{ name = "shift", joint = "B", type = "displacement", motion = {{ type = "constant-rate", rate = 0.03 }} }},
]
"#
    );
    let study = study(&text);
    let t = 3.0;
    let end = End::of(&study, t);
    let expected = (beta.tan() * 0.03 * t - 0.02 * 5.0 * t) / 0.05;
    let counted = end.q[7 * 2 + 1];
    close(counted, expected, 1e-9);
    close(end.pose(1).r[2], 0.09, 1e-11);
    for seed in 0..20 {
        let v = velocities(end.v.len(), seed);
        let found = row_of(&study.prepared.mechanism, &end, "teeth", &v);
        let line = [0.0, cos, sin];
        close(
            found,
            row_of_teeth(&end, [0, 1], [0.02, 0.0, 0.0], line, &v),
            1e-12,
        );
    }
}

/// The test uses `examples/planetary-gear.toml` in space, with gear meshes at its pitch circles.
/// Its verdicts and its acceleration are the same as in the plane.
#[test]
fn a_planetary_gear_has_the_answers_of_the_plane() {
    let places = [
        [1.0, 0.0],
        [-0.5, 0.75_f64.sqrt()],
        [-0.5, -0.75_f64.sqrt()],
    ];
    let mut text = r#"
[scene]
name = "planetary-gear"
space = "spatial"
[[body]]
name = "sun"
mass = 0.5
inertia = [1.2e-4, 1.2e-4, 2.25e-4]
[[body]]
name = "carrier"
mass = 0.8
inertia = [5e-4, 5e-4, 1e-3]
[[joint]]
name = "carrier-bearing"
type = "revolute"
bodies = ["ground", "carrier"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "sun-bearing"
type = "revolute"
bodies = ["ground", "sun"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[force]]
name = "motor"
type = "torque"
body = "sun"
torque = [0, 0, 1.5]
[[force]]
name = "load"
type = "torque"
body = "carrier"
torque = [0, 0, -4.2]
"#
    .to_owned();
    for (k, [x, y]) in places.into_iter().enumerate() {
        let at = |r: f64| format!("[{:?}, {:?}, 0]", r * x, r * y);
        write!(
            text,
            "[[body]]\nname = \"planet-{k}\"\nmass = 0.15\ninertia = [1e-5, 1e-5, 1.6875e-5]\nposition = {pin}\n\
             [[joint]]\nname = \"pin-{k}\"\ntype = \"revolute\"\nbodies = [\"carrier\", \"planet-{k}\"]\nat = {pin}\naxis = [0, 0, 1]\n\
             [[joint]]\nname = \"sun-{k}\"\ntype = \"mesh\"\nbearings = [\"sun-bearing\", \"pin-{k}\"]\nat = {inner}\n\
             [[joint]]\nname = \"ring-{k}\"\ntype = \"mesh\"\nbearings = [\"pin-{k}\", \"carrier-bearing\"]\npoint = {outer}\n",
            pin = at(0.045),
            inner = at(0.03),
            outer = at(0.06),
        )
        .expect("a text");
    }
    let study = study(&text);
    let found = study.analyse(0.0, None).expect("a start");
    // In the plane there are 16 rows of rank 14; here each of the five bearings has three more
    // rows.
    assert_eq!(counts(&found), [31, 29, 2, 1]);
    for reaction in &found.analysis.reactions {
        let is_mesh = reaction.name.starts_with("sun-") || reaction.name.starts_with("ring-");
        if is_mesh && reaction.name != "sun-bearing" {
            assert_eq!(
                reaction.wrench.verdict,
                Verdict::NotUnique,
                "{}",
                reaction.name
            );
        }
    }
    // The expression is the torque of the sun on all planets.
    assert!(is_unique(&found, &{
        let mut sum = String::new();
        for (k, [x, y]) in places.into_iter().enumerate() {
            let sign = |c: f64| if c < 0.0 { '-' } else { '+' };
            write!(sum, " {} {:?}*sun-{k}.Fy", sign(x), x.abs()).expect("a text");
            write!(sum, " {} {:?}*sun-{k}.Fx", sign(-y), y.abs()).expect("a text");
        }
        sum.trim_start_matches(" + ").to_owned()
    }));
    // The reference is Willis' equation, as in `tests/all/examples/fixed.rs` for the plane.
    let reduced = 2.25e-4 + 1e-3 / 9.0 + 3.0 * (0.15 * 0.045 * 0.045 / 9.0 + 1.6875e-5);
    let alpha = (1.5 - 4.2 / 3.0) / reduced;
    let end = End::of(&study, 1.0);
    let rates = [1.0, 1.0 / 3.0, -1.0, -1.0, -1.0];
    for (body, ratio) in rates.into_iter().enumerate() {
        close(end.omega(body)[2], ratio * alpha, 1e-8 * alpha);
    }
}

/// Two wheels on the ground have parallel axes.
const SPUR: &str = r#"
scene = { name = "spur", space = "spatial" }
body = [
  { name = "a", mass = 1.0, inertia = [0.1, 0.1, 0.1], position = [0, 0, 0] },
  { name = "b", mass = 1.0, inertia = [0.1, 0.1, 0.1], position = [0.3, 0, 0] },
]
joint = [
  { name = "A", type = "revolute", bodies = ["ground", "a"], at = [0, 0, 0], axis = [0, 0, 1] },
  { name = "B", type = "revolute", bodies = ["ground", "b"], at = [0.3, 0, 0], axis = [0, 0, 1] },
  { name = "teeth", type = "mesh", bearings = ["A", "B"], at = [0.1, 0, 0] },
]
"#;

#[test]
fn wheels_in_mesh_move_together() {
    assert_eq!(are_a_basis(&study(SPUR), "spur wheels"), 1);
    for n in 1..=3 {
        for (motion, quaternion) in motions() {
            let text = differential(n, motion, quaternion, [0.0; 2]);
            are_a_basis(&study(&text), &format!("{n} planets"));
        }
    }
}
