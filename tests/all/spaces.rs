//! A second description of planar bodies, by the coordinates (x, y, cos φ, sin φ), with n_q = 4 and
//! n_v = 3. Starts, verdicts and motions must equal those of bodies with an angle. Code that
//! confuses velocities with coordinates fails here.

use std::ops::ControlFlow;

use dynamics::{EventKind, Method, MotionOptions, PreparedMechanism, RowChoice, prepare, simulate};
use model::space::{difference, norm};
use model::start::CorrectionLimit;
use model::{Bodies, BodyRef, Description, Mechanism, Registry, StartOptions, System};
use solvability::{ReactionVerdict, analyse};
use tests::cranks::cranks;

/// Builds a mechanism in both spaces, the ordinary one first.
fn both(d: &Description, start: &StartOptions) -> [PreparedMechanism; 2] {
    let built = || Mechanism::build(d).expect("a mechanism");
    [built(), built().on_unit_circle()].map(|mechanism| {
        let (n_q, n_v) = (mechanism.layout().n_q, mechanism.layout().n_v);
        assert!(n_q == n_v || 3 * n_q == 4 * n_v, "{n_q} {n_v}");
        prepare(mechanism, start, &RowChoice::Automatic).expect("a start")
    })
}

/// Scenes of the suite, and the duration of their runs: runs that pass many singular configurations
/// stop before the first one that rounding would decide.
const SCENES: [(&str, f64); 9] = [
    ("robot-trolley", 4.0),
    ("three-cranks", 2.0),
    // The singular configuration is reached at 0.714 s.
    ("n-four-bar", 0.7),
    ("andrews", 0.03),
    ("a01-pendulum", 10.0),
    ("sleigh", 5.0),
    ("knife-edge", 1.0),
    ("rolling-disk", 1.0),
    ("stiff-spring-pendulum", 1.0),
];

fn scene(name: &str) -> scene::Scene {
    let text = suite::find(name).expect("a case").scene;
    scene::read(name, text, &Registry::standard()).expect("a scene")
}

/// Returns the difference of poses: lengths relative to the size, angles by sine and cosine.
fn apart(a: &Bodies, b: &Bodies, size: f64) -> f64 {
    let of_body = |body: usize| {
        let place = norm(&difference(a.origin(body), b.origin(body))) / size;
        place.max(norm(&difference(a.axes(body)[0], b.axes(body)[0])))
    };
    (0..a.len()).map(of_body).fold(0.0, f64::max)
}

/// Rows of output of a run: time, poses, velocities.
type Rows = Vec<(f64, Bodies, Vec<f64>)>;

/// Returns a run, and time and kind of its singular configurations and exchanges of rows.
fn run(p: &PreparedMechanism, options: &MotionOptions) -> (Rows, Vec<(f64, EventKind)>) {
    let mut rows = Rows::new();
    let done = simulate(p, options, |row| {
        rows.push((
            row.t,
            Bodies::at(p.mechanism.space(), row.q),
            row.v.to_vec(),
        ));
        Ok(ControlFlow::Continue(()))
    });
    let (name, space) = (p.mechanism.name(), p.mechanism.space());
    let summary = done.unwrap_or_else(|e| panic!("{name}, {space:?}, {:?}: {e}", options.method));
    let events = summary.events.iter().map(|e| (e.time, e.kind));
    (rows, events.collect())
}

/// Compares both runs: the largest difference of poses, and of velocities relative to the largest.
fn gaps(two: &[PreparedMechanism; 2], options: &MotionOptions) -> (f64, f64) {
    let [(plain, _), (circle, _)] = [&two[0], &two[1]].map(|p| run(p, options));
    let size = two[0].assembly.size;
    assert_eq!(plain.len(), circle.len());
    let fastest = plain
        .iter()
        .flat_map(|row| &row.2)
        .fold(0.0, |a: f64, v| a.max(v.abs()));
    let mut gaps = (0.0_f64, 0.0_f64);
    for (a, b) in plain.iter().zip(&circle) {
        assert_eq!(a.0, b.0);
        gaps.0 = gaps.0.max(apart(&a.1, &b.1, size));
        let velocities = a.2.iter().zip(&b.2).map(|(a, b)| (a - b).abs());
        gaps.1 = velocities.fold(gaps.1, |gap, d| gap.max(d / fastest.max(1.0)));
    }
    gaps
}

#[test]
fn starts_and_verdicts_are_the_same() {
    for (name, _) in SCENES {
        let scene = scene(name);
        let two = both(
            scene.description.plane().expect("a planar scene"),
            &scene.start,
        );
        let size = two[0].assembly.size;
        let [a, b] = [&two[0], &two[1]].map(|p| Bodies::at(p.mechanism.space(), &p.q));
        assert!(
            apart(&a, &b, size) < 1e-14,
            "{name}: {:e}",
            apart(&a, &b, size)
        );
        assert_eq!(two[0].decision.kept, two[1].decision.kept, "{name}");
        assert_eq!(
            two[0].position_decision.kept, two[1].position_decision.kept,
            "{name}"
        );
        let [a, b] =
            [&two[0], &two[1]].map(|p| analyse(&p.mechanism, 0.0, &p.q).expect("a verdict"));
        assert_eq!(a.decision.rank, b.decision.rank, "{name}");
        for (a, b) in a.reactions.iter().zip(&b.reactions) {
            let of = |r: &ReactionVerdict| {
                let components = r.components.iter().map(|c| c.judgement.verdict.clone());
                (r.wrench.verdict.clone(), components.collect::<Vec<_>>())
            };
            assert_eq!(of(a), of(b), "{name}, {}", a.name);
        }
    }
}

#[test]
fn the_motion_is_the_same_by_every_way_through_it() {
    for (name, t_end) in SCENES {
        let scene = scene(name);
        let two = both(
            scene.description.plane().expect("a planar scene"),
            &scene.start,
        );
        let ways = [
            (Method::Dop853, 1e-13),
            (Method::Dopri5, 1e-10),
            (Method::Radau5, 1e-9),
        ];
        for (method, rtol) in ways {
            let options = MotionOptions {
                rtol,
                atol: rtol,
                method,
                // Rows between the ends of steps are dense output with projection.
                output_step: t_end / 37.0,
                ..MotionOptions::to(t_end)
            };
            let (poses, velocities) = gaps(&two, &options);
            let bound = 2e3 * rtol;
            assert!(
                poses < bound && velocities < bound,
                "{name} by {method:?}: poses {poses:e}, velocities {velocities:e}"
            );
        }
    }
}

/// A parallelogram that passes its singular configuration reports it at the same time, up to
/// rounding.
#[test]
fn passages_are_told_at_the_same_time() {
    let mut d = cranks(&[0.0, 1.0], 0.5, -0.5);
    d.bodies[0].angular_velocity = Some(1.0);
    let start = StartOptions {
        correction: CorrectionLimit::Any,
        ..StartOptions::default()
    };
    let two = both(&d, &start);
    let options = MotionOptions {
        rtol: 1e-10,
        atol: 1e-10,
        ..MotionOptions::to(1.0)
    };
    let [(_, plain), (_, circle)] = [&two[0], &two[1]].map(|p| run(p, &options));
    assert!(!plain.is_empty(), "the flat pose is passed");
    assert_eq!(plain.len(), circle.len());
    for ((a, of_a), (b, of_b)) in plain.iter().zip(&circle) {
        assert_eq!(of_a, of_b);
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
}

/// A start off the constraints is assembled to the same pose, also if the correction rotates bodies
/// by radians.
#[test]
fn a_start_far_beside_the_constraints_is_corrected_alike() {
    let mut d = cranks(&[0.0, 1.0, 2.5], 0.5, 0.4);
    for (k, body) in d.bodies.iter_mut().enumerate() {
        body.angle += 0.3 * (k as f64 + 1.0).sin();
        body.position[0] += 0.1 * (k as f64).cos();
    }
    d.joints.push(model::Joint::new(
        "held",
        &[BodyRef::Ground, BodyRef::Body(0)],
        joints::Angle::new(),
    ));
    let start = StartOptions {
        correction: CorrectionLimit::Any,
        ..StartOptions::default()
    };
    let two = both(&d, &start);
    let [a, b] = [&two[0], &two[1]].map(|p| Bodies::at(p.mechanism.space(), &p.q));
    assert!(apart(&a, &b, 1.0) < 1e-13, "{:e}", apart(&a, &b, 1.0));
}
