//! Runs with generated code for every scene. The motion must be equal to that of the interpreter,
//! also if the run switches between the two.

use std::ops::ControlFlow;
use std::sync::Arc;

use dynamics::{
    EventKind, Method, MotionOptions, OutputRequest, Plan, PreparedMechanism, Summary, simulate,
};
use model::System;
use pfaff::model::Registry;
use pfaff::{AssembledScene, RunOptions};
use pfaff_scene_codegen::{Subject, Tape};

mod space;

/// Tolerance of the two runs that are compared.
const RTOL: f64 = 1e-10;

/// Largest difference as a fraction of the largest coordinate or velocity; for stiff cranks, errors
/// do not decay during the run.
const SAME: f64 = 1e-6;

/// Largest difference in space.
const SAME_IN_SPACE: f64 = 1e-9;

/// Returns the rows [q; v] of a run, and its summary.
fn run(prepared: &PreparedMechanism, options: &MotionOptions) -> (Vec<Vec<f64>>, Summary) {
    let mut rows = Vec::new();
    let summary = simulate(prepared, options, |row| {
        rows.push([row.q, row.v].concat());
        Ok(ControlFlow::Continue(()))
    });
    (rows, summary.unwrap_or_else(|failure| panic!("{failure}")))
}

#[test]
fn runs_on_code_are_those_of_the_interpreter_on_every_scene() {
    let cases = suite::all().filter(|case| case.name != "a01-pendulum-2000s");
    for case in cases {
        let (_, by) = compare(case.name, case.scene);
        assert!(by < SAME, "{}: {by:e}", case.name);
    }
}

/// The chain swings through configurations at which its pivots are zero; the other scenes do not.
#[test]
fn runs_on_code_are_those_of_the_interpreter_in_space() {
    for (name, text) in space::scenes() {
        let (departures, by) = compare(&name, &text);
        assert!(by < SAME_IN_SPACE, "{name}: {by:e}");
        assert_eq!(departures > 0, name == "chain", "{name}: {departures}");
    }
}

/// Returns how often a run with code switches to the interpreter, and its largest difference from a
/// run with the interpreter.
fn compare(name: &str, text: &str) -> (usize, f64) {
    let study = AssembledScene::read(name, text, &Registry::standard())
        .and_then(|b| b.prepare(&RunOptions::default()))
        .unwrap_or_else(|e| panic!("{name}: {e}"));
    let own = study.options.expect("the scene has a run");
    let options = MotionOptions {
        rtol: RTOL,
        atol: 0.01 * RTOL,
        ..own
    };
    let tape = Tape::of(&Subject::of_run(&study.prepared, &options).expect("runs"));
    let tape = tape.unwrap_or_else(|e| panic!("{name}: {e}"));
    let (expected, interpreted) = run(&study.prepared, &options);
    let coded = study
        .prepared
        .with_code(Arc::new(tape))
        .expect("its own code");
    let plan = Plan::new(&coded, &options, &OutputRequest::default()).expect("plans");
    let is_stiff = interpreted.method == Method::Radau5;
    assert_eq!(plan.code.value, !is_stiff, "{name}");
    let (found, summary) = run(&coded, &options);
    assert_eq!(found.len(), expected.len(), "{name}");
    let mechanism = &coded.mechanism;
    let n_q = mechanism.layout().n_q;
    let (mut sizes, mut by) = ([0.0_f64; 2], [0.0_f64; 2]);
    for (found, expected) in found.iter().zip(&expected) {
        let ((q, v), (q_0, v_0)) = (found.split_at(n_q), expected.split_at(n_q));
        let mut d = vec![0.0; v.len()];
        mechanism.difference(q, q_0, &mut d);
        by[0] = by[0].max(largest(d));
        by[1] = by[1].max(largest(v.iter().zip(v_0).map(|(a, b)| a - b)));
        sizes[0] = sizes[0].max(largest(q_0.iter().copied()));
        sizes[1] = sizes[1].max(largest(v_0.iter().copied()));
    }
    let left = summary
        .events
        .iter()
        .filter(|e| e.kind == EventKind::CodeLeft);
    (left.count(), f64::max(by[0] / sizes[0], by[1] / sizes[1]))
}

fn largest(x: impl IntoIterator<Item = f64>) -> f64 {
    x.into_iter().fold(0.0, |a, x| a.max(x.abs()))
}

/// Returns the scene of the turning cranks without the third crank.
fn two_turning_cranks(three: &str) -> String {
    let blocks = three.split("\n\n");
    blocks
        .filter(|b| !b.contains("crank-3"))
        .collect::<Vec<_>>()
        .join("\n\n")
}

/// At configurations with collinear cranks, branches of the motion meet. The run switches to the
/// interpreter before these configurations; the point of the switch depends on the tolerance. The
/// interpreter, alone or after the code, passes all of these configurations and remains on the
/// branch of parallel cranks.
#[test]
fn passages_do_not_depend_on_tolerances_or_on_who_evaluates() {
    let three = suite::find("turning-cranks").expect("a case").scene;
    let two = two_turning_cranks(three);
    for (scene, drop) in [
        (two.as_str(), None),
        (three, None),
        (three, Some(vec![1])),
        (three, Some(vec![9])),
    ] {
        let overrides = RunOptions {
            drop: drop.clone(),
            t_end: Some(3.0),
            ..RunOptions::default()
        };
        let study = AssembledScene::read("cranks", scene, &Registry::standard())
            .and_then(|b| b.prepare(&overrides))
            .unwrap_or_else(|e| panic!("{e}"));
        let own = study.options.expect("the scene has a run");
        let tape = Tape::of(&Subject::at_start(&study.prepared)).expect("code");
        let coded = study.prepared.clone().with_code(Arc::new(tape));
        let coded = coded.expect("its own code");
        for method in [Method::Dopri5, Method::Tsit5, Method::Dop853] {
            for exponent in 3..=11 {
                let rtol = 10_f64.powi(-exponent);
                let options = MotionOptions {
                    rtol,
                    atol: rtol,
                    method,
                    ..own.clone()
                };
                for prepared in [&study.prepared, &coded] {
                    let (rows, summary) = run(prepared, &options);
                    let what = format!("{drop:?}, {method:?}, rtol {rtol:e}");
                    let last = rows.last().expect("rows");
                    assert!((last[2] - last[5]).abs() < 1e-10, "{what}: {last:?}");
                    assert!(summary.energy_balance < 100.0 * rtol, "{what}: {summary:?}");
                }
            }
        }
    }
}
