//! The same motion with every elimination of redundant rows, and the drift without projection.
//! Other formulations are compared in `crates/lab`.

use std::ops::ControlFlow;

use dynamics::{
    Method, MotionOptions, PreparedMechanism, RowChoice, Stabilisation, Summary, prepare, simulate,
};
use model::{Description, Mechanism, StartOptions, System};
use serde::Deserialize;
use tests::cranks::cranks;
use tests::largest;
use tests::robot::{robot, steering};

const REFERENCE: &str = include_str!("../reference/robot_trolley.json");

/// Reactions of the robot that the model does not determine.
const NOT_UNIQUE: [&str; 6] = ["B", "C", "W1", "W2", "W3", "W4"];

/// Pairs of rows (from 1) that can be deleted at every configuration of the motion of the robot.
const PAIRS: [[usize; 2]; 9] = [
    [4, 20],
    [4, 21],
    [6, 20],
    [6, 21],
    [18, 20],
    [18, 21],
    [19, 20],
    [19, 21],
    [20, 21],
];

#[derive(Deserialize)]
struct Reference {
    rows: Vec<ReferenceRow>,
}

#[derive(Deserialize)]
struct ReferenceRow {
    t: f64,
    q: Vec<f64>,
    qd: Vec<f64>,
}

/// The output of a run: times, states, and force and torque of every joint and drive.
struct Run {
    t: Vec<f64>,
    q: Vec<Vec<f64>>,
    v: Vec<Vec<f64>>,
    reactions: Vec<Vec<[f64; 3]>>,
    summary: Summary,
}

impl Run {
    fn of(p: &PreparedMechanism, options: &MotionOptions) -> Self {
        let mut run = Self {
            t: Vec::new(),
            q: Vec::new(),
            v: Vec::new(),
            reactions: Vec::new(),
            summary: Summary::default(),
        };
        let summary = simulate(p, options, |sample| {
            run.t.push(sample.t);
            run.q.push(sample.q.to_vec());
            run.v.push(sample.v.to_vec());
            let reactions = sample.reactions()?.as_chosen().to_vec().into_iter();
            let parts = reactions.map(|r| [r.force[0], r.force[1], r.torque[2]]);
            run.reactions.push(parts.collect());
            Ok(ControlFlow::Continue(()))
        });
        run.summary = summary.expect("moves");
        run
    }

    /// The rows at the times of the reference, at every second.
    fn seconds(&self) -> Vec<usize> {
        let whole = |k: &usize| (self.t[*k] - self.t[*k].round()).abs() < 1e-9;
        (0..self.t.len()).filter(whole).collect()
    }

    /// Largest difference of coordinates and velocities at the times of the reference: all except
    /// one are break times, at which steps end.
    fn distance_at_steps(&self, other: &Self) -> f64 {
        let of = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| a - b));
        let at = |k: usize| of(&self.q[k], &other.q[k]).max(of(&self.v[k], &other.v[k]));
        self.seconds().into_iter().map(at).fold(0.0, f64::max)
    }

    /// Largest difference of coordinates and velocities.
    fn distance(&self, other: &Self) -> f64 {
        assert_eq!(self.t, other.t);
        gap(&self.q, &other.q).max(gap(&self.v, &other.v))
    }

    /// Largest difference of the reaction of a joint.
    fn reaction_distance(&self, other: &Self, joint: usize) -> f64 {
        let pairs = self.reactions.iter().zip(&other.reactions);
        let parts = pairs.flat_map(|(a, b)| (0..3).map(move |c| a[joint][c] - b[joint][c]));
        largest(parts)
    }
}

fn gap(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    largest(
        a.iter()
            .flatten()
            .zip(b.iter().flatten())
            .map(|(a, b)| a - b),
    )
}

fn started(d: &Description, rows: &RowChoice) -> PreparedMechanism {
    let mechanism = Mechanism::build(d).expect("builds");
    prepare(mechanism, &StartOptions::default(), rows).expect("starts")
}

/// Three cranks swing under gravity.
fn swinging_cranks() -> Description {
    let mut d = cranks(&[-0.8, 0.0, 0.8], 0.5, -1.0);
    d.gravity = [0.0, -9.81];
    d
}

fn to(t_end: f64, tolerance: f64) -> MotionOptions {
    MotionOptions {
        rtol: tolerance,
        atol: tolerance,
        ..MotionOptions::to(t_end)
    }
}

#[test]
fn the_robot_moves_the_same_by_every_elimination() {
    let reference: Reference = serde_json::from_str(REFERENCE).expect("the reference is JSON");
    let d = robot(steering());
    let automatic = started(&d, &RowChoice::Automatic);
    let kept = Run::of(&automatic, &to(10.0, 1e-10));
    let error = reference.rows.iter().map(|r| {
        let close = |t: &f64| (t - r.t).abs() < 1e-9;
        let at = kept
            .t
            .iter()
            .position(close)
            .expect("a row at each listed time");
        let of = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| a - b));
        of(&kept.q[at], &r.q).max(of(&kept.v[at], &r.qd))
    });
    let error = largest(error);
    assert!(error < 1e-7, "{error:e}");
    let allowed = f64::max(10.0 * error, 1e-11);

    let eliminated = PAIRS.iter().map(|pair| {
        let rows = RowChoice::Drop(pair.iter().map(|row| row - 1).collect());
        let run = Run::of(&started(&d, &rows), &to(10.0, 1e-10));
        (format!("without {pair:?}"), run)
    });
    let groups = &automatic.mechanism.layout().groups;
    for (name, run) in eliminated {
        let motion = kept.distance_at_steps(&run);
        assert!(motion <= allowed, "{name}: {motion:e}, run {error:e}");
        for (k, group) in groups.iter().enumerate() {
            let (d, unique) = (
                kept.reaction_distance(&run, k),
                !NOT_UNIQUE.contains(&group.name.as_str()),
            );
            assert!(!unique || d <= 1e-6, "{name}: {} by {d:e}", group.name);
        }
    }
}

#[test]
fn what_cannot_be_dropped_is_refused_with_the_time() {
    let refusal = |rows: &[usize]| {
        let mechanism = Mechanism::build(&robot(steering())).expect("builds");
        let rows = RowChoice::Drop(rows.iter().map(|row| row - 1).collect());
        match prepare(mechanism, &StartOptions::default(), &rows) {
            Ok(_) => panic!("{rows:?} is refused"),
            Err(error) => error.to_string(),
        }
    };
    for pair in [[3, 20], [5, 21], [18, 19]] {
        let text = refusal(&pair);
        assert!(
            text.starts_with("at t = 0 s these rows cannot be dropped"),
            "{text}"
        );
    }
}

/// Evaluates Φ of an output state.
fn opening(p: &PreparedMechanism, t: f64, q: &[f64]) -> f64 {
    let mut s = p.mechanism.scratch();
    p.mechanism.pose(t, q, &mut s);
    p.mechanism.phi(&mut s);
    largest(s.phi.iter().copied())
}

#[test]
fn without_projection_the_drift_is_told() {
    let d = swinging_cranks();
    let p = started(&d, &RowChoice::Automatic);
    let exact = Run::of(&p, &to(5.0, 1e-12));
    let run = |stabilisation| {
        let options = MotionOptions {
            stabilisation,
            method: Method::Dopri5,
            ..to(5.0, 1e-7)
        };
        let run = Run::of(&p, &options);
        let written = (0..run.t.len()).map(|k| opening(&p, run.t[k], &run.q[k]));
        (largest(written), run)
    };
    let (projected, run_projected) = run(Stabilisation::Projection);
    let (drifted, run_drifted) = run(Stabilisation::None);
    assert!(projected < 1e-14, "{projected:e}");
    assert!(drifted > 1e-9 && drifted < 1e-3, "{drifted:e}");
    for (written, run) in [(projected, &run_projected), (drifted, &run_drifted)] {
        // The summary includes the steps between rows.
        let told = run.summary.max_position_residual;
        assert!(
            told >= written && told <= 10.0 * written.max(1e-15),
            "{told:e} {written:e}"
        );
        let error = run.distance(&exact);
        assert!(error < 1e-3, "{error:e}");
    }
}

/// The robot has drives and knife edges, with break times: drift must not count as a jump of a
/// drive.
#[test]
fn the_robot_drifts_without_impulses() {
    let p = started(&robot(steering()), &RowChoice::Automatic);
    let exact = Run::of(&p, &to(10.0, 1e-10));
    let options = MotionOptions {
        stabilisation: Stabilisation::None,
        ..to(10.0, 1e-6)
    };
    let run = Run::of(&p, &options);
    let summary = &run.summary;
    let residuals = [summary.max_position_residual, summary.max_velocity_residual];
    assert!(
        residuals.iter().all(|r| *r > 1e-10 && *r < 1e-4),
        "{residuals:?}"
    );
    assert!(run.distance(&exact) < 1e-3);
    let is_impulse = |e: &dynamics::Event| e.kind == dynamics::EventKind::Impulse;
    assert!(!summary.events.iter().any(is_impulse));
}
