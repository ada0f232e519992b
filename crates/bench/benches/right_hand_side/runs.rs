//! Simulates ten seconds of the robot with a required error. The program first finds the loosest
//! tolerance that achieves this error, because the runs are compared at equal errors and not at
//! equal tolerances. A run has two output rows. They are not written to a file. The measured time
//! does not include the computation of the initial state, but it includes the allocation of the
//! results.

use std::ops::ControlFlow;
use std::sync::Arc;

use dynamics::{MotionOptions, PreparedMechanism, Summary, simulate};
use robot_trolley::generated::automatic;
use suite::{Kind, Quantity};

use crate::Outcome;
use crate::candidates::{Group, Work};
use crate::robot::Robot;

/// Duration of the run (s).
const T_END: f64 = 10.0;

/// Number of tolerances that are tried in each decade.
const PER_DECADE: i32 = 8;
/// Loosest and tightest tolerance (decades).
const DECADES: [i32; 2] = [-4, -13];

/// Returns the runs, in the order of the table. A new method of simulation needs one line in this
/// function.
pub(crate) fn all(robot: &Robot) -> Outcome<Vec<Work<'static>>> {
    let known = end(robot)?;
    let run = |key, name, prepared, error| run(key, name, prepared, error, &known);
    let coded = || robot.prepared.clone().with_code(Arc::new(automatic::Code));
    Ok(vec![
        run("run_1e-6_generated", "generated code", coded()?, 1e-6)?,
        run("run_1e-10_generated", "generated code", coded()?, 1e-10)?,
        run("run_1e-6", "interpreted", robot.prepared.clone(), 1e-6)?,
        run("run_1e-10", "interpreted", robot.prepared.clone(), 1e-10)?,
    ])
}

fn run(
    key: &'static str,
    name: &str,
    prepared: PreparedMechanism,
    wanted: f64,
    known: &[f64],
) -> Outcome<Work<'static>> {
    let found = loosest(&prepared, wanted, known)?;
    let Found {
        options,
        error,
        summary,
    } = found;
    let title = format!(
        "error {wanted:.0e}, {name}: rtol {:.1e}, error {error:.1e}, {} steps, {} evaluations",
        options.rtol, summary.steps, summary.evaluations
    );
    Ok(Work {
        key,
        title,
        group: Group::Run,
        calls: 1,
        lap: Box::new(move || {
            std::hint::black_box(
                simulate(&prepared, &options, |_| Ok(ControlFlow::Continue(()))).is_ok(),
            );
        }),
    })
}

struct Found {
    options: MotionOptions,
    error: f64,
    summary: Summary,
}

/// Finds the loosest tolerance for which this tolerance and all tighter tolerances achieve the
/// required error. The search starts with the tightest tolerance, so that a loose tolerance that
/// achieves the error by chance does not count.
fn loosest(prepared: &PreparedMechanism, wanted: f64, known: &[f64]) -> Outcome<Found> {
    let mut best = None;
    for k in (PER_DECADE * DECADES[1]..=PER_DECADE * DECADES[0])
        .map(|k| f64::from(k) / f64::from(PER_DECADE))
    {
        let rtol = 10.0_f64.powf(k);
        let options = MotionOptions {
            rtol,
            atol: rtol / 100.0,
            output_step: T_END,
            ..MotionOptions::to(T_END)
        };
        let mut end = Vec::new();
        let summary = simulate(prepared, &options, |row| {
            end = [row.q, row.v].concat();
            Ok(ControlFlow::Continue(()))
        })?;
        let error = end
            .iter()
            .zip(known)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        if error > wanted || end.iter().any(|x| !x.is_finite()) {
            break;
        }
        best = Some(Found {
            options,
            error,
            summary,
        });
    }
    best.ok_or_else(|| format!("no tolerance gives an error of {wanted:e}").into())
}

/// Returns q and v at the end, from the reference of the suite.
fn end(robot: &Robot) -> Outcome<Vec<f64>> {
    let case = suite::find("robot-trolley").ok_or("the suite has no robot")?;
    let reference = case.reference();
    let last = reference
        .instants
        .last()
        .filter(|i| i.t == T_END)
        .ok_or("no end in the reference")?;
    let bodies = robot.prepared.mechanism.bodies();
    let mut end = vec![f64::NAN; 6 * bodies.len()];
    for fact in &last.facts {
        let (offset, places) = match fact.quantity.kind() {
            Kind::Position => (0, [Quantity::X, Quantity::Y, Quantity::Angle]),
            Kind::Velocity => (
                3 * bodies.len(),
                [Quantity::Vx, Quantity::Vy, Quantity::Omega],
            ),
            Kind::Acceleration | Kind::Reaction => continue,
        };
        let body = bodies.iter().position(|b| b.name == fact.of);
        let place = places.iter().position(|p| *p == fact.quantity);
        if let (Some(body), Some(place)) = (body, place) {
            end[offset + 3 * body + place] = fact.value;
        }
    }
    if end.iter().all(|x| x.is_finite()) {
        Ok(end)
    } else {
        Err("the reference does not contain all of q and v at the end".into())
    }
}
