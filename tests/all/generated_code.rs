//! Runs on generated code. The code here is not generated but solves the same equations in another
//! way, so that the test can insert faults. For every fault the motion equals that of the
//! interpreter, and the run reports which of them evaluated.

mod elimination;

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use dynamics::{
    CodeMismatch, CodeSpec, EventKind, Method, MotionOptions, NoCode, OutputRequest, Plan,
    PreparedMechanism, RowChoice, SceneCode, Stabilisation, Summary, prepare, simulate,
};
use model::start::CorrectionLimit;
use model::{BodyRef, Description, Drive, Function, Mechanism, StartOptions};
use tests::cranks::cranks;
use tests::robot::{robot, steering};

use elimination::{Elimination, Fault};

fn started(d: &Description) -> PreparedMechanism {
    let options = StartOptions {
        correction: CorrectionLimit::Any,
        ..StartOptions::default()
    };
    prepare(
        Mechanism::build(d).expect("builds"),
        &options,
        &RowChoice::Automatic,
    )
    .expect("starts")
}

fn trolley() -> PreparedMechanism {
    started(&robot(steering()))
}

/// Rows of a run, [q; v; λ] each, and its summary.
fn run(p: &PreparedMechanism, options: &MotionOptions) -> (Vec<Vec<f64>>, Summary) {
    let mut rows = Vec::new();
    let summary = simulate(p, options, |row| {
        let lambda = row.multipliers()?.as_chosen().to_vec();
        rows.push([row.q, row.v, &lambda].concat());
        Ok(ControlFlow::Continue(()))
    })
    .expect("runs to its end");
    (rows, summary)
}

/// Returns the largest difference between two runs.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()))
}

/// Returns (kind, time) of the events that concern the code.
fn told(summary: &Summary) -> Vec<(EventKind, f64)> {
    let of_code = [EventKind::CodeLeft, EventKind::CodeUsed];
    let events = summary.events.iter();
    events
        .filter(|e| of_code.contains(&e.kind))
        .map(|e| (e.kind, e.time))
        .collect()
}

fn tight(t_end: f64) -> MotionOptions {
    MotionOptions {
        rtol: 1e-11,
        atol: 1e-12,
        output_step: 0.25,
        ..MotionOptions::to(t_end)
    }
}

#[test]
fn a_run_on_healthy_code_is_that_of_the_interpreter() {
    let p = trolley();
    let (expected, interpreted) = run(&p, &tight(10.0));
    for method in [Method::Dop853, Method::Tsit5] {
        let options = MotionOptions {
            method,
            ..tight(10.0)
        };
        let coded = p
            .clone()
            .with_code(Elimination::new(&p, Fault::None))
            .expect("its own");
        let (rows, summary) = run(&coded, &options);
        assert!(
            apart(&rows, &expected) < 1e-9,
            "{:e}",
            apart(&rows, &expected)
        );
        assert_eq!(told(&summary), []);
        assert!(summary.max_position_residual < 1e-14, "{summary:?}");
        assert!(summary.energy_balance < 1e-9 && interpreted.energy_balance < 1e-9);
    }
}

/// After the last accepted state before the fault the equations are interpreted, and after some
/// time the code is used again.
#[test]
fn code_that_is_not_sure_is_left_and_comes_back() {
    let p = trolley();
    let (expected, _) = run(&p, &tight(10.0));
    let dropped = p.decision.dropped[0];
    for (fault, reason) in [
        (Fault::Health(0.05), "its pivots have fallen to 0.05"),
        (Fault::Health(-2.0), "its pivots have fallen to -2.00"),
        (Fault::Health(f64::NAN), "its pivots have fallen to NaN"),
        (Fault::NotFinite, "a result of it is not finite"),
        (Fault::DroppedRow(dropped), "the dropped row"),
        (Fault::Correction(1e6), "its corrections leave row"),
    ] {
        let coded = p
            .clone()
            .with_code(Elimination::new(&p, fault))
            .expect("its own at the start");
        let (rows, summary) = run(&coded, &tight(10.0));
        assert!(
            apart(&rows, &expected) < 1e-9,
            "{reason}: {:e}",
            apart(&rows, &expected)
        );
        let told = told(&summary);
        assert_eq!(told.len(), 2, "{reason}: {:?}", summary.events);
        let [(left, t_left), (used, t_used)] = [told[0], told[1]];
        assert_eq!([left, used], [EventKind::CodeLeft, EventKind::CodeUsed]);
        assert!((3.0..=4.1).contains(&t_left), "{reason}: {t_left}");
        // The switch has hysteresis: the code is used again only after it is healthy, so some steps
        // are interpreted.
        assert!(t_used > 4.1 && t_used < 10.0, "{reason}: {t_used}");
        let event = summary
            .events
            .iter()
            .find(|e| e.kind == EventKind::CodeLeft);
        let text = &event.expect("told").text;
        assert!(text.contains(reason), "{text}");
    }
}

/// Cranks with a driven first crank.
fn driven(pivots: &[f64], start: f64, motion: Function) -> PreparedMechanism {
    let mut d = cranks(pivots, 0.5, start);
    d.drives.push(Drive {
        tolerance: None,
        name: "motor".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
        element: Box::new(joints::RevoluteAngleDrive::new([0.0; 2], [0.0; 2])),
        motion,
    });
    started(&d)
}

/// Rates jump just before the run leaves the code, and during interpretation.
#[test]
fn impulses_are_those_of_the_interpreter() {
    let times = [0.0, 4.0, 4.2, 6.0];
    let motion = Function::lines(&times, &[0.0, -0.2, -0.25, 0.1]).expect("a function");
    let p = driven(&[0.0, 1.0, 2.5], -1.3, motion);
    let (expected, interpreted) = run(&p, &tight(6.0));
    for fault in [Fault::None, Fault::Health(0.0)] {
        let coded = p
            .clone()
            .with_code(Elimination::new(&p, fault))
            .expect("its own");
        let (rows, summary) = run(&coded, &tight(6.0));
        assert!(
            apart(&rows, &expected) < 1e-9,
            "{:e}",
            apart(&rows, &expected)
        );
        let impulses = |s: &Summary| {
            let impulses = s.events.iter().filter(|e| e.kind == EventKind::Impulse);
            impulses.map(|e| e.text.clone()).collect::<Vec<_>>()
        };
        assert_eq!(impulses(&summary).len(), 2);
        assert_eq!(impulses(&interpreted).len(), 2);
        assert!(summary.energy_balance < 1e-9, "{}", summary.energy_balance);
        let left = told(&summary).first().map(|(_, t)| *t);
        match fault {
            Fault::None => assert_eq!(left, None),
            _ => assert!(left.is_some_and(|t| (4.0..=4.1).contains(&t)), "{left:?}"),
        }
    }
}

/// A parallelogram is driven through its singular configuration, at which two branches meet: the
/// code cannot pass it.
#[test]
fn singular_configurations_are_passed_by_the_interpreter() {
    let rate = Function::constant_rate(1.0).expect("finite");
    let p = driven(&[0.0, 1.0], -0.5, rate);
    let options = MotionOptions {
        output_step: 0.1,
        ..MotionOptions::to(6.0)
    };
    let (expected, interpreted) = run(&p, &options);
    let coded = p
        .clone()
        .with_code(Elimination::new(&p, Fault::None))
        .expect("its own");
    let (rows, summary) = run(&coded, &options);
    let n = 2 * p.v.len();
    let motion = |rows: &[Vec<f64>]| rows.iter().map(|r| r[..n].to_vec()).collect::<Vec<_>>();
    let by = apart(&motion(&rows), &motion(&expected));
    assert!(by < 1e-6, "{by:e}: {:?}", summary.events);
    let passages = |s: &Summary| -> Vec<f64> {
        let passages = s
            .events
            .iter()
            .filter(|e| e.kind == EventKind::SingularPassage);
        passages.map(|e| e.time).collect()
    };
    let (found, right) = (passages(&summary), passages(&interpreted));
    assert_eq!(found.len(), right.len(), "{:?}", summary.events);
    for (found, right) in found.iter().zip(right) {
        assert!((found - right).abs() < 1e-6, "{found} {right}");
    }
    assert!(
        told(&summary)
            .iter()
            .any(|(kind, _)| *kind == EventKind::CodeLeft)
    );
}

/// The test replaces the mechanism of the run by another one: a call of the interpreter would
/// change the result.
#[test]
fn a_healthy_run_asks_the_interpreter_nothing() {
    let d = |length: f64| {
        let mut d = cranks(&[0.0, 1.0, 2.5], length, -1.3);
        d.gravity = [0.0, -9.81];
        d
    };
    let p = started(&d(0.5));
    let options = MotionOptions {
        output_step: 3.0,
        ..MotionOptions::to(3.0)
    };
    let code = Elimination::new(&p, Fault::None);
    let mut coded = p.clone().with_code(code.clone()).expect("its own");
    let last = |p: &PreparedMechanism| {
        let mut last = Vec::new();
        let summary = simulate(p, &options, |row| {
            last = [row.q, row.v].concat();
            Ok(ControlFlow::Continue(()))
        });
        (last, summary.expect("runs"))
    };
    let (expected, right) = last(&coded);
    assert!(told(&right).is_empty() && right.steps > 10, "{right:?}");
    coded.mechanism = Mechanism::build(&d(0.6)).expect("builds");
    code.evaluations.store(0, Ordering::Relaxed);
    let (found, summary) = last(&coded);
    assert_eq!(found, expected);
    // The count is two at the start, twelve per step, eleven per rejected step, and six more for
    // rows between steps.
    let counted = code.evaluations.load(Ordering::Relaxed) as u64;
    assert_eq!(counted, summary.evaluations);
    assert_eq!(counted, 2 + 12 * summary.steps + 11 * summary.rejected);
}

/// Falling bodies have no equations to solve.
struct Falling(CodeSpec);

impl SceneCode for Falling {
    fn spec(&self) -> &CodeSpec {
        &self.0
    }

    fn acceleration(&self, _t: f64, _q: &[f64], _v: &[f64], a: &mut [f64]) -> f64 {
        for (i, a) in a.iter_mut().enumerate() {
            *a = if i % 3 == 1 { -9.81 } else { 0.0 };
        }
        1.0
    }

    fn multipliers(&self, _t: f64, _q: &[f64], _v: &[f64], _lambda: &mut [f64]) -> f64 {
        1.0
    }

    fn phi(&self, _t: f64, _q: &[f64], _phi: &mut [f64]) {}

    fn velocity_residual(&self, _t: f64, _q: &[f64], _v: &[f64], _out: &mut [f64]) {}

    fn position_correction(&self, _t: f64, _q: &[f64], _phi: &[f64], dq: &mut [f64]) -> f64 {
        dq.fill(0.0);
        1.0
    }

    fn velocity_correction(&self, _t: f64, _q: &[f64], _out: &[f64], dv: &mut [f64]) -> f64 {
        dv.fill(0.0);
        1.0
    }
}

#[test]
fn steps_on_code_allocate_nothing() {
    let body = |i: usize| model::Body {
        name: format!("body {i}"),
        mass: 1.0,
        inertia: 1.0,
        ..model::Body::default()
    };
    let p = started(&Description {
        gravity: [0.0, -9.81],
        bodies: (0..7).map(body).collect(),
        ..Description::default()
    });
    let code = Falling(CodeSpec {
        name: "falling".into(),
        n_q: 21,
        n_v: 21,
        m: 0,
        h: 0,
        kept: Vec::new().into(),
        position_kept: Vec::new().into(),
        break_times: Vec::new().into(),
        operations: "".into(),
    });
    let p = p.with_code(Arc::new(code)).expect("its own");
    let count = |steps: f64| {
        let options = MotionOptions {
            max_step: 1.0 / steps,
            output_step: 1.0,
            ..MotionOptions::to(1.0)
        };
        let mut taken = 0;
        let counted = allocation_counter::measure(|| {
            let run = simulate(&p, &options, |_| Ok(ControlFlow::Continue(())));
            taken = run.expect("falls").steps;
        });
        (taken, counted.count_total)
    };
    let (few, many) = (count(10.0), count(1000.0));
    assert!(few.0 < 20 && many.0 >= 1000, "{few:?} {many:?}");
    assert_eq!(few.1, many.1);
}

#[test]
fn the_plan_says_whether_code_is_used_and_why_not() {
    let p = trolley();
    let coded = p.clone().with_code(Elimination::new(&p, Fault::None));
    let coded = coded.expect("its own");
    let planned = |p: &PreparedMechanism, method| {
        let options = MotionOptions {
            method,
            ..MotionOptions::to(1.0)
        };
        let plan = Plan::new(p, &options, &OutputRequest::default()).expect("a plan");
        (plan.code.value, plan.code.reason, plan.apart.reason)
    };
    let (used, _, apart) = planned(&coded, Method::Auto);
    assert_eq!(
        (used, apart.as_str()),
        (true, "the generated code contains all bodies")
    );
    for (p, method, no_code) in [
        (&p, Method::Auto, NoCode::None),
        (&coded, Method::Radau5, NoCode::Method("radau5")),
    ] {
        let (used, reason, _) = planned(p, method);
        assert_eq!((used, reason), (false, no_code.to_string()));
    }
}

#[test]
fn code_of_another_mechanism_is_refused() {
    let p = trolley();
    let refused = |code: Arc<Elimination>| match p.clone().with_code(code) {
        Err(mismatch) => mismatch,
        Ok(_) => panic!("accepted"),
    };
    let mut light = robot(steering());
    light.bodies[6].inertia *= 1.0 + 1e-6;
    let mismatch = refused(Elimination::new(&started(&light), Fault::None));
    assert!(matches!(mismatch, CodeMismatch::Value { .. }), "{mismatch}");
    let mut slow = robot(steering());
    slow.drives[0].motion = Function::steps(0.0, &[[1.0, 2.5, 0.02]]).expect("a function");
    let mismatch = refused(Elimination::new(&started(&slow), Fault::None));
    assert!(
        matches!(mismatch, CodeMismatch::BreakTimes { .. }),
        "{mismatch}"
    );
    let other_rows = prepare(
        Mechanism::build(&robot(steering())).expect("builds"),
        &StartOptions::default(),
        &RowChoice::Drop(vec![5, 20]),
    )
    .expect("starts");
    let mismatch = refused(Elimination::new(&other_rows, Fault::None));
    assert!(
        matches!(
            mismatch,
            CodeMismatch::Rows {
                level: "velocity",
                ..
            }
        ),
        "{mismatch}"
    );
    let mismatch = refused(Elimination::new(
        &started(&cranks(&[0.0, 1.0], 0.5, 0.4)),
        Fault::None,
    ));
    assert_eq!(
        mismatch.to_string(),
        "the code `elimination` has 9 coordinates, the mechanism 21"
    );
    for (fault, what) in [
        (Fault::Acceleration(1e-7), "acceleration"),
        (Fault::Multipliers(1e-7), "multiplier"),
    ] {
        let mismatch = refused(Elimination::new(&p, fault));
        let CodeMismatch::Value { what: found, .. } = mismatch else {
            panic!("{mismatch}");
        };
        assert_eq!(found, what);
    }
}

#[test]
fn runs_that_code_cannot_serve_say_why() {
    let p = trolley();
    let options = MotionOptions::to(1.0);
    let why = |p: &PreparedMechanism, options: &MotionOptions| p.code_for(options).err();
    assert_eq!(why(&p, &options), Some(NoCode::None));
    let coded = p
        .clone()
        .with_code(Elimination::new(&p, Fault::None))
        .expect("its own");
    assert_eq!(why(&coded, &options), None);
    for (options, reason) in [
        (
            MotionOptions {
                method: Method::Radau5,
                ..options.clone()
            },
            NoCode::Method("radau5"),
        ),
        (
            MotionOptions {
                stabilisation: Stabilisation::None,
                ..options.clone()
            },
            NoCode::Stabilisation("none"),
        ),
    ] {
        assert_eq!(why(&coded, &options), Some(reason));
        assert!(simulate(&coded, &options, |_| Ok(ControlFlow::Continue(()))).is_ok());
    }
}
