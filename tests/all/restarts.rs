//! Starts at other states of the same scene. They use the rank decision of the first start where it
//! remains valid. The reference is a start without another start.

use std::ops::ControlFlow;

use dynamics::{MotionError, MotionOptions, PreparedMechanism, RowChoice, prepare};
use joints::Revolute;
use model::start::State;
use model::{Body, BodyRef, Description, Mechanism, Registry, StartOptions};
use pfaff::{RunOptions, Study};

/// Starts at a state without another start.
fn anew(
    first: &PreparedMechanism,
    t: f64,
    q: &[f64],
    v: &[f64],
) -> Result<PreparedMechanism, MotionError> {
    let start = StartOptions {
        keep: Vec::new(),
        state: Some(State {
            q: q.to_vec(),
            v: v.to_vec(),
        }),
        ..first.start.clone()
    };
    prepare(
        first.mechanism.clone().starting_at(t),
        &start,
        &first.choice,
    )
}

/// Returns the ranks and the number of redundant rows, or the error.
fn told(start: &Result<PreparedMechanism, MotionError>) -> Result<[usize; 4], String> {
    let start = start.as_ref().map_err(ToString::to_string)?;
    let [all, positions] = [&start.decision, &start.position_decision];
    Ok([
        all.rank,
        all.dropped.len(),
        positions.rank,
        positions.dropped.len(),
    ])
}

/// At states of the motions of all examples, both starts find the same ranks, coordinates and
/// velocities, or the same error.
#[test]
fn a_start_at_a_state_decides_as_a_first_start_does() {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples");
    let registry = Registry::standard();
    let mut compared = 0;
    for file in std::fs::read_dir(examples).expect("a folder") {
        let path = file.expect("a file").path();
        if path.extension().is_none_or(|end| end != "toml") {
            continue;
        }
        let name = path.display().to_string();
        let text = std::fs::read_to_string(&path).expect("a text");
        let Ok(study) = Study::read(&name, &text, &registry, &RunOptions::default()) else {
            continue;
        };
        let Some(options) = &study.options else {
            continue;
        };
        let options = MotionOptions {
            output_step: options.t_end / 6.0,
            ..options.clone()
        };
        let mut states = Vec::new();
        let _ = study.run(&options, |row| {
            states.push((row.t, row.q.to_vec(), row.v.to_vec()));
            Ok(ControlFlow::Continue(()))
        });
        for (t, q, v) in &states {
            let both = [study.prepared.at(*t, q, v), anew(&study.prepared, *t, q, v)];
            assert_eq!(told(&both[0]), told(&both[1]), "{name} at {t} s");
            if let [Ok(a), Ok(b)] = &both {
                assert_eq!((&a.q, &a.v), (&b.q, &b.v), "{name} at {t} s");
                compared += 1;
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

/// A parallelogram with cranks of 1 m at an angle. The coupler keeps its direction. If all bars
/// are in line, the rows along the line are dependent, so the rank is 7 in place of 8.
#[test]
fn a_flat_parallelogram_is_singular_at_every_start() {
    let mut d = Description::new("parallelogram");
    let bodies = ["left", "coupler", "right"].map(|name| d.body(Body::new(name, 1.0, 0.1)));
    let poses = |angle: f64| -> Vec<f64> {
        let (s, c) = angle.sin_cos();
        vec![
            0.5 * c,
            0.5 * s,
            angle,
            c + 1.0,
            s,
            0.0,
            2.0 + 0.5 * c,
            0.5 * s,
            angle,
        ]
    };
    for (k, body) in d.bodies.iter_mut().enumerate() {
        let q = poses(0.7);
        (body.position, body.angle) = ([q[3 * k], q[3 * k + 1]], q[3 * k + 2]);
    }
    let [left, coupler, right] = bodies;
    for (name, pair, s_i, s_j) in [
        ("A", [BodyRef::Ground, left], [0.0, 0.0], [-0.5, 0.0]),
        ("B", [left, coupler], [0.5, 0.0], [-1.0, 0.0]),
        ("C", [coupler, right], [1.0, 0.0], [0.5, 0.0]),
        ("D", [BodyRef::Ground, right], [2.0, 0.0], [-0.5, 0.0]),
    ] {
        d.joint(name, &pair, Revolute { s_i, s_j });
    }
    let mechanism = Mechanism::build(&d).expect("a parallelogram");
    let first = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic);
    let first = first.expect("starts");
    let at = |start: &PreparedMechanism, angle: f64| {
        start
            .at(0.0, &poses(angle), &[0.0; 9])
            .expect("a configuration")
    };
    let [flat, steep] = [0.0, 1.9].map(|angle| at(&first, angle));
    let first_flat = anew(&first, 0.0, &poses(0.0), &[0.0; 9]).expect("starts");
    for (start, rank) in [
        (&first, 8),
        (&flat, 7),
        (&steep, 8),
        (&first_flat, 7),
        (&at(&first_flat, 1.9), 8),
        (&at(&flat, 1.9), 8),
        (&at(&steep, 0.0), 7),
    ] {
        let ranks = [start.decision.rank, start.position_decision.rank];
        assert_eq!(ranks, [rank; 2]);
    }
    // The decision is not carried to or from a singular configuration, nor to the rows of bars that
    // are in line within 1e-4 rad.
    for (start, angle, expected) in [
        (&first, 1.9, true),
        (&first, 1e-4, false),
        (&first, 0.0, false),
        (&first_flat, 1.9, false),
    ] {
        let decided = start.decided.as_ref().expect("a decision");
        let there = decided.carried(&start.mechanism, 0.0, &poses(angle));
        assert_eq!(there.is_some(), expected, "{angle}");
    }
    // Starts in between have no influence.
    for between in [&flat, &steep, &at(&flat, 1.9)] {
        assert_eq!(at(between, 0.4).decision, at(&first, 0.4).decision);
    }
}
