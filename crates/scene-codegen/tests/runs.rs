//! Runs on generated code for every scene: the motion equals that of the interpreter, also if the
//! run switches between them.

use std::ops::ControlFlow;
use std::sync::Arc;

use dynamics::{Method, MotionOptions, Plan, Prepared, Summary, Wanted, simulate};
use pfaff::model::Registry;
use pfaff::{AssembledScene, Overrides};
use scene_codegen::{Subject, Tape};

/// Two runs with this tolerance …
const RTOL: f64 = 1e-10;

/// … may differ by this fraction of the largest coordinate or velocity: in stiff cranks no error
/// decays during the run.
const SAME: f64 = 1e-6;

fn run(prepared: &Prepared, options: &MotionOptions) -> (Vec<Vec<f64>>, Summary) {
    let mut rows = Vec::new();
    let summary = simulate(prepared, options, |row| {
        rows.push([row.q, row.v].concat());
        Ok(ControlFlow::Continue(()))
    });
    (rows, summary.unwrap_or_else(|failure| panic!("{failure}")))
}

#[test]
fn runs_on_code_are_those_of_the_interpreter_on_every_scene() {
    for case in suite::all().filter(|case| case.name != "a01-pendulum-2000s") {
        let study = AssembledScene::read(case.name, case.scene, &Registry::standard())
            .and_then(|b| b.prepare(&Overrides::default()))
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
        let own = study.options.expect("the scene has a run");
        let options = MotionOptions {
            rtol: RTOL,
            atol: 0.01 * RTOL,
            ..own
        };
        let tape = Tape::of(&Subject::of_run(&study.prepared, &options).expect("runs"));
        let tape = tape.unwrap_or_else(|e| panic!("{}: {e}", case.name));
        let (expected, interpreted) = run(&study.prepared, &options);
        let coded = study
            .prepared
            .with_code(Arc::new(tape))
            .expect("its own code");
        let plan = Plan::new(&coded, &options, &Wanted::default()).expect("plans");
        let is_stiff = interpreted.method == Method::Radau5;
        assert_eq!(plan.code.value, !is_stiff, "{}", case.name);
        let (found, _) = run(&coded, &options);
        assert_eq!(found.len(), expected.len(), "{}", case.name);
        let n = found[0].len() / 2;
        for part in [0..n, n..2 * n] {
            let largest = |rows: &[Vec<f64>]| {
                let values = rows.iter().flat_map(|row| &row[part.clone()]);
                values.fold(0.0, |a: f64, x| a.max(x.abs()))
            };
            let pairs = found.iter().zip(&expected);
            let difference = |(a, b): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| a - b).collect()
            };
            let differences: Vec<Vec<f64>> = pairs.map(difference).collect();
            let by = largest(&differences) / largest(&expected);
            assert!(by < SAME, "{}: {by:e}", case.name);
        }
    }
}

/// The turning cranks without the third one.
fn two_turning_cranks(three: &str) -> String {
    let blocks = three.split("\n\n");
    blocks
        .filter(|b| !b.contains("crank-3"))
        .collect::<Vec<_>>()
        .join("\n\n")
}

/// Where the cranks are in line, branches of the motion meet. The run leaves the code before these
/// points, at another place for every tolerance; the interpreter, alone or after the code, passes
/// all of them and stays on the branch of parallel cranks.
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
        let overrides = Overrides {
            drop: drop.clone(),
            t_end: Some(3.0),
            ..Overrides::default()
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
