//! Three runs that eliminate the two redundant rows in different ways, and a run on generated code
//! with automatically chosen rows.

use std::ops::ControlFlow;
use std::sync::Arc;

use pfaff::dynamics::code::SharedCode;
use pfaff::dynamics::{MotionOptions, RowChoice, Summary};
use pfaff::model::{Reaction, Registry};
use pfaff::{RunOptions, Study, StudyError};
use robot_trolley::generated::automatic;

/// The scene that is built in.
const SCENE: &str = include_str!("../robot-trolley.toml");

/// The published variants: rows to delete, counted from 1.
pub(crate) const DELETED: [[usize; 2]; 3] = [[6, 21], [18, 21], [19, 21]];

/// Tolerance of the runs. Differences between runs are compared with this tolerance.
pub(crate) const TOLERANCE: f64 = 1e-11;

/// Time between compared instants (s).
const OUTPUT_STEP: f64 = 0.05;

/// One run.
pub(crate) struct Variant {
    /// Rows deleted, from 1.
    pub(crate) deleted: [usize; 2],
    pub(crate) rows: Vec<Instant>,
    pub(crate) summary: Summary,
}

/// The mechanism at one instant.
pub(crate) struct Instant {
    pub(crate) t: f64,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    /// Reactions of all joints and drives in the order of their rows.
    pub(crate) reactions: Vec<Reaction>,
}

/// Reads the scene and drops the given rows.
pub(crate) fn read(overrides: &RunOptions) -> Result<Study, StudyError> {
    Study::read(
        "robot-trolley.toml",
        SCENE,
        &Registry::standard(),
        overrides,
    )
}

/// Runs all variants.
pub(crate) fn run() -> Result<Vec<Variant>, Box<dyn std::error::Error>> {
    DELETED.iter().map(|&deleted| run_one(deleted)).collect()
}

fn run_one(deleted: [usize; 2]) -> Result<Variant, Box<dyn std::error::Error>> {
    let drop = deleted.map(|row| row - 1).to_vec();
    let study = read(&RunOptions {
        drop: Some(drop.clone()),
        ..RunOptions::default()
    })?;
    run_study(&study, deleted, RowChoice::Drop(drop))
}

/// Computes the motion on generated code, and returns it with the dropped rows (1-based).
pub(crate) fn generated() -> Result<Variant, Box<dyn std::error::Error>> {
    let mut study = read(&RunOptions::default())?;
    let code: Arc<SharedCode> = Arc::new(automatic::Code);
    study.prepared = study.prepared.with_code(code)?;
    let deleted = match study.prepared.decision.dropped[..] {
        [a, b] => [a + 1, b + 1],
        ref other => return Err(format!("two rows are redundant, not {other:?}").into()),
    };
    run_study(&study, deleted, RowChoice::Automatic)
}

fn run_study(
    study: &Study,
    deleted: [usize; 2],
    rows_choice: RowChoice,
) -> Result<Variant, Box<dyn std::error::Error>> {
    let base = study.options.clone().ok_or(pfaff::StudyError::NoEnd)?;
    let options = MotionOptions {
        rtol: TOLERANCE,
        atol: TOLERANCE,
        output_step: OUTPUT_STEP,
        rows: rows_choice,
        ..base
    };
    let mut rows = Vec::new();
    let summary = study
        .run(&options, |sample| {
            let reactions = sample.reactions()?.as_chosen().to_vec();
            rows.push(Instant {
                t: sample.t,
                q: sample.q.to_vec(),
                v: sample.v.to_vec(),
                reactions,
            });
            Ok(ControlFlow::Continue(()))
        })
        .map_err(|f| f.error)?;
    Ok(Variant {
        deleted,
        rows,
        summary,
    })
}

/// Largest difference of coordinates and velocities between two runs.
pub(crate) fn motion_difference(a: &Variant, b: &Variant) -> f64 {
    let states = a.rows.iter().zip(&b.rows).flat_map(|(x, y)| {
        let positions = x.q.iter().zip(&y.q);
        positions.chain(x.v.iter().zip(&y.v)).map(|(x, y)| x - y)
    });
    largest(states)
}

/// Largest difference of a reaction's components between two runs.
pub(crate) fn reaction_difference(a: &Variant, b: &Variant, joint: usize) -> f64 {
    let parts = a.rows.iter().zip(&b.rows).flat_map(|(x, y)| {
        let (r, s) = (&x.reactions[joint], &y.reactions[joint]);
        [
            r.force[0] - s.force[0],
            r.force[1] - s.force[1],
            r.torque[2] - s.torque[2],
        ]
    });
    largest(parts)
}

fn largest(x: impl Iterator<Item = f64>) -> f64 {
    x.fold(0.0, |a: f64, x| a.max(x.abs()))
}
