//! Compares generated code with the interpreter, which solves the same equations with another order
//! of elimination.

use dynamics::KeptRowMotion;
use linalg::KeptRowSaddle;
use model::System;
use pfaff::solvability::ChosenValues;
use pfaff::{AssembledScene, RunOptions, Study};
use symbolic::Symbol;

use crate::equations::Source;
use crate::frame::may_be_seen_from;
use crate::functions::{Function, Functions};
use crate::subject::{State, Subject};

mod space;

/// Largest relative difference between two eliminations in `f64`.
const SAME: f64 = 1e-13;

/// Number of states per scene; for the robot it is 1000.
const STATES: usize = 40;

pub(crate) const ROBOT: &str = include_str!("../../robot-trolley/robot-trolley.toml");

/// Two bodies in space that are connected by a spring and have no constraints.
const FREE: &str = r#"
scene = { name = "free", space = "plane", gravity = [0.0, -1.0] }
body = [
    { name = "a", mass = 1.0, inertia = 0.2, angular_velocity = 2.0 },
    { name = "b", mass = 2.0, inertia = 0.1, position = [1.0, 0.5], velocity = [0.0, 1.0] },
]
force = [{ name = "s", type = "spring-damper", bodies = ["a", "b"], points = { a = [0.2, 0.1], b = [0.0, 0.3] }, stiffness = 30.0, damping = 0.5 }]
simulate = { t_end = 2.0 }
"#;

/// A crank without a degree of freedom; the table of its drive has a kink in the rate.
const DRIVEN: &str = r#"
scene = { name = "driven", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "crank", mass = 1.0, inertia = 0.2, position = [0.5, 0.0] }]
joint = [{ name = "A", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] }]
drive = [{ name = "D", joint = "A", type = "angle", motion = { type = "table", times = [0.0, 1.0, 2.5], values = [0.0, 0.7, -0.4] } }]
force = [{ name = "T", type = "torque", body = "crank", torque = { type = "harmonic", amplitude = 2.0, omega = 3.0, phase = 0.1, offset = 0.5 } }]
simulate = { t_end = 2.0 }
"#;

/// A bead that slides along a line on the ground while it rotates.
const BEAD: &str = r#"
scene = { name = "bead", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "bead", mass = 1.0, inertia = 0.2, angular_velocity = 1.0 }]
joint = [{ name = "L", type = "point-on-line", body = "bead", at = [0.0, 0.0], line = [[0.0, 0.0], [1.0, 1.0]] }]
simulate = { t_end = 2.0 }
"#;

pub(crate) fn scenes() -> Vec<(String, String)> {
    let mut scenes: Vec<(String, String)> = suite::all()
        // The other scene contains the same mechanism with a shorter run.
        .filter(|case| case.name != "a01-pendulum-2000s")
        .map(|case| (case.name.to_owned(), case.scene.to_owned()))
        .collect();
    scenes.push(("free".into(), FREE.into()));
    scenes.push(("driven".into(), DRIVEN.into()));
    scenes.push(("bead".into(), BEAD.into()));
    scenes
}

pub(crate) fn study(name: &str, text: &str) -> Study {
    AssembledScene::read(name, text, &model::Registry::standard())
        .and_then(|b| b.prepare(&RunOptions::default()))
        .unwrap_or_else(|e| panic!("{name}: {e}"))
}

pub(crate) fn subject<'a>(study: &'a Study, name: &str) -> Subject<'a> {
    let options = study.options.as_ref().expect("the scene has a run");
    Subject::of_run(&study.prepared, options).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Returns the results and the health of a function of a module at a state; `extra` contains the
/// other inputs.
fn run(
    functions: &Functions,
    subject: &Subject<'_>,
    name: &str,
    state: &State,
    extra: impl Fn(Source) -> f64,
) -> (Vec<f64>, f64) {
    let f: &Function = functions
        .list
        .iter()
        .find(|f| f.signature.name == name)
        .expect("every module has it");
    let input = |s: Symbol| match functions.equations.sources[s.index()] {
        Source::Mechanism(input) => subject.input(input, state),
        other => extra(other),
    };
    let mut values = f.program.run(input);
    let shares = values.split_off(f.n_out);
    (values, shares.into_iter().fold(f64::INFINITY, f64::min))
}

/// Returns states near the motion; every second one violates the constraints.
fn states(study: &Study, subject: &Subject<'_>, n: usize) -> Vec<State> {
    let mut motion = KeptRowMotion::new(&study.prepared).expect("moves");
    let (mechanism, size) = (&study.prepared.mechanism, study.prepared.assembly.size);
    let mut found = Vec::new();
    let mut seed = 0.5_f64;
    let mut random = || {
        seed = (seed * 12.9898 + 78.233).sin() * 43758.5453;
        seed -= seed.floor();
        2.0 * seed - 1.0
    };
    for k in 0..4 * n {
        let State { t, mut q, mut v } = subject.states[k % subject.states.len()].clone();
        let away: Vec<f64> = (0..v.len())
            .map(|j| 0.02 * random() * mechanism.space().unit(j, size))
            .collect();
        mechanism.displace(&mut q, &away);
        for (j, v) in v.iter_mut().enumerate() {
            *v += random() * mechanism.space().unit(j, size);
        }
        let is_off = k % 2 == 1;
        if found.len() < n && (is_off || motion.project(t, &mut q, &mut v).is_ok()) {
            found.push(State { t, q, v });
        }
    }
    found
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a, x| a.max(x.abs()))
}

/// Returns the largest relative difference of accelerations and multipliers. States at which one of
/// the methods is near a singular configuration are not compared.
fn compare(name: &str, text: &str, n: usize) -> (usize, f64) {
    let study = study(name, text);
    let subject = subject(&study, name);
    let functions = Functions::new(&subject).unwrap_or_else(|e| panic!("{name}: {e}"));
    let mechanism = &study.prepared.mechanism;
    let layout = mechanism.layout();
    let mut motion = KeptRowMotion::new(&study.prepared).expect("moves");
    let (mut compared, mut worst) = (0, 0.0_f64);
    for state in states(&study, &subject, n) {
        let (t, q, v) = (state.t, &state.q, &state.v);
        let none = |_| 0.0;
        let (a, health) = run(&functions, &subject, "acceleration", &state, none);
        let mut expected = vec![0.0; layout.n_v];
        if health < 0.1 || motion.acceleration(t, q, v, &mut expected).is_err() {
            continue;
        }
        compared += 1;
        // The terms that cancel in an acceleration have the size of squared velocities and of
        // accelerations due to forces.
        let size = largest(&expected).max(largest(v).powi(2)).max(1e-3);
        let differences = a.iter().zip(&expected).map(|(a, e)| (a - e).abs() / size);
        let apart = differences.fold(0.0, f64::max);
        let (lambda, _) = run(&functions, &subject, "multipliers", &state, none);
        let mut expected = ChosenValues::new(vec![0.0; layout.rows()], Vec::new());
        motion.multipliers(t, q, v, &mut expected).expect("solves");
        let expected = expected.as_chosen();
        let size = largest(expected).max(largest(mechanism.mass()) * size);
        let differences = lambda
            .iter()
            .zip(expected)
            .map(|(a, e)| (a - e).abs() / size);
        let apart = differences.fold(apart, f64::max);
        worst = worst.max(apart);

        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        mechanism.b(&mut s);
        let (phi, _) = run(&functions, &subject, "phi", &state, none);
        let (residual, _) = run(&functions, &subject, "velocity_residual", &state, none);
        for i in 0..layout.rows() {
            let expected = layout.velocity_residual(&s, i, v);
            assert!(
                (residual[i] - expected).abs() < 1e-12 * (1.0 + largest(v)),
                "{name}"
            );
            if i < layout.m {
                assert!(
                    (phi[i] - s.phi[i]).abs() < 1e-13 * (1.0 + largest(q)),
                    "{name}"
                );
            }
        }
    }
    (compared, worst)
}

#[test]
fn code_equals_the_interpreter_on_every_scene() {
    for (name, text) in scenes() {
        let (compared, worst) = compare(&name, &text, STATES);
        assert!(compared >= STATES / 4, "{name}: {compared} states");
        assert!(worst < 100.0 * SAME, "{name}: {worst:e}");
    }
}

#[test]
fn code_equals_the_interpreter_at_a_thousand_states_of_the_robot() {
    let (compared, worst) = compare("robot-trolley", ROBOT, 1000);
    assert!(compared >= 900);
    assert!(worst < SAME, "{worst:e}");
}

/// Compares corrections with the solution of a saddle-point system.
fn corrections_are_exact(name: &str, text: &str) {
    let study = study(name, text);
    let subject = subject(&study, name);
    let functions = Functions::new(&subject).unwrap_or_else(|e| panic!("{name}: {e}"));
    let mechanism = &study.prepared.mechanism;
    let layout = mechanism.layout();
    let rhs = |i: usize| 1e-3 * (1.0 + i as f64).sin();
    let extra = |source| match source {
        Source::Rhs(i) => rhs(i),
        _ => 0.0,
    };
    for state in states(&study, &subject, 5) {
        let mut s = mechanism.scratch();
        mechanism.pose(state.t, &state.q, &mut s);
        mechanism.c(&mut s);
        let dense = layout.dense(&s);
        let levels = [
            (
                "position_correction",
                &study.prepared.position_decision.kept,
            ),
            ("velocity_correction", &study.prepared.decision.kept),
        ];
        for (level, kept) in levels {
            let (d, health) = run(&functions, &subject, level, &state, extra);
            if health < 0.3 {
                continue;
            }
            let mut saddle = KeptRowSaddle::new(layout.n_v, kept.len()).expect("sizes");
            saddle
                .factor_above(0.0, |k| dense.row(kept[k]), mechanism.mass())
                .expect("independent");
            let missing: Vec<f64> = kept.iter().map(|&i| -rhs(i)).collect();
            let mut expected = vec![0.0; layout.n_v];
            let mut lambda = vec![0.0; kept.len()];
            let zero = vec![0.0; layout.n_v];
            saddle
                .solve(&zero, &missing, &mut expected, &mut lambda)
                .expect("solves");
            for (d, e) in d.iter().zip(&expected) {
                let size = largest(&expected).max(1e-12);
                assert!((d - e).abs() < 1e-10 * size, "{name} {level}: {d} {e}");
            }
        }
    }
}

#[test]
fn corrections_are_those_of_a_saddle_solve() {
    for (name, text) in scenes() {
        corrections_are_exact(&name, &text);
    }
}

/// Tests the number of operations for the robot; a change that needs more operations must update
/// this test.
#[test]
fn the_robot_needs_no_more_operations_than_it_did() {
    let study = study("robot-trolley", ROBOT);
    let functions = Functions::new(&subject(&study, "robot-trolley")).expect("code");
    for (name, most) in [
        ("acceleration", 668),
        ("multipliers", 818),
        ("phi", 102),
        ("velocity_residual", 158),
        ("position_correction", 571),
        ("velocity_correction", 621),
    ] {
        let f = functions.list.iter().find(|f| f.signature.name == name);
        let counts = f.expect("every module has it").program.counts();
        assert!(
            counts.total() <= most,
            "{name}: {} > {most}",
            counts.total()
        );
    }
}

/// The equations of a vehicle do not depend on its orientation: in the frames of its bodies, a
/// rotation by any angle does not change the pivots.
#[test]
fn it_does_not_matter_which_way_a_vehicle_points() {
    let study = study("robot-trolley", ROBOT);
    let subject = subject(&study, "robot-trolley");
    let functions = Functions::new(&subject).expect("code");
    let State { t, q, v } = subject.states[20].clone();
    let healths = [0.0, 0.5, 1.6, 3.0, 4.7].map(|turn: f64| {
        let (sin, cos) = turn.sin_cos();
        let turned = |x: &[f64], by: f64| -> Vec<f64> {
            let bodies = x.chunks_exact(3);
            let body = |b: &[f64]| [cos * b[0] - sin * b[1], sin * b[0] + cos * b[1], b[2] + by];
            bodies.flat_map(body).collect()
        };
        let (q, v) = (turned(&q, turn), turned(&v, 0.0));
        let state = State { t, q, v };
        run(&functions, &subject, "acceleration", &state, |_| 0.0).1
    });
    for health in healths {
        assert!((health - healths[0]).abs() < 1e-9, "{healths:?}");
    }
    // The equations of pins on the ground are the same in every frame. The equations of a line on
    // the ground differ.
    let pinned = self::study("driven", DRIVEN);
    assert!(may_be_seen_from(&Subject::at_start(&pinned.prepared), 2));
    let bead = self::study("bead", BEAD);
    assert!(!may_be_seen_from(&Subject::at_start(&bead.prepared), 2));
}
