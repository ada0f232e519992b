//! Tests modules whose inputs are numbers in their scenes. For any values of the inputs, a module
//! gives the results of the interpreter for the scene with these values. It rejects a scene that
//! differs in another number.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use dynamics::code::SharedCode;
use dynamics::{CodeMismatch, KeptRowMotion, PreparedMechanism, SceneCode, simulate};
use linalg::KeptRowSaddle;
use model::{Registry, System};
use pfaff::solvability::ChosenValues;
use pfaff::{AssembledScene, RunOptions, Study};
use pfaff_scene_codegen::{Choices, CodeError, NotAnInput, State, Subject, scene_tape, scene_text};
use scene::Template;

#[rustfmt::skip]
#[path = "generated/four_bar.rs"]
mod four_bar;

#[rustfmt::skip]
#[path = "generated/arm.rs"]
mod arm;

const FOUR_BAR: &str = include_str!("inputs/four-bar.toml");
const ARM: &str = include_str!("inputs/arm.toml");

const KEYS_OF_FOUR_BAR: [&str; 8] = [
    "body.coupler.mass",
    "body.crank.inertia",
    "scene.gravity[1]",
    "joint.B.at",
    "force.spring.stiffness",
    "force.spring.damping",
    "force.spring.points.coupler[0]",
    "force.motor.torque.amplitude",
];

const KEYS_OF_ARM: [&str; 10] = [
    "Jxx",
    "Jxy",
    "Jyz",
    "body.arm.mass",
    "scene.gravity",
    "joint.elbow.at",
    "joint.shoulder.axis[0]",
    "force.spring.stiffness",
    "force.push.force[1]",
    "drive.motor.motion.amplitude",
];

/// Number of states for each of the mechanisms with different inputs.
const STATES: usize = 1000;

/// Largest difference between two solutions of the same equations, as a fraction of the terms that
/// cancel in the results.
const SAME: f64 = 1e-13;

/// Relative changes of the inputs; they are assigned to the keys in turn.
const SHARES: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [0.13, -0.08, 0.11],
    [-0.15, 0.1, 0.07],
    [0.3, 0.17, -0.12],
];

/// Returns the numbers in the scene for the keys of a list.
fn numbers(keys: &[&str], text: &str) -> Vec<String> {
    let opened = |key: &&str| match Template::new(text, &[key]) {
        Ok(_) => vec![(*key).to_owned()],
        Err(scene::KeyError::NotANumber { parts, .. }) => parts,
        Err(e) => panic!("{e}"),
    };
    keys.iter().flat_map(opened).collect()
}

/// Returns the scene with other values of these keys.
fn changed(text: &str, keys: &[&str], shares: [f64; 3]) -> String {
    let keys = numbers(keys, text);
    let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
    let template = Template::new(text, &keys).expect("keys of numbers");
    let shares: Vec<f64> = (0..keys.len()).map(|k| shares[k % 3]).collect();
    template.changed_by(&shares).expect("numbers")
}

fn study(text: &str) -> Study {
    AssembledScene::read("scene.toml", text, &Registry::standard())
        .and_then(|b| b.prepare(&RunOptions::default()))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// Returns the scene with the independent rows of the code, which may differ from the default rows
/// of the scene.
fn on_rows_of(code: &dyn SceneCode, mut study: Study) -> Study {
    let spec = code.spec();
    let moved = study.prepared.on_rows(&spec.kept, &spec.position_kept);
    study.prepared = moved.expect("independent rows");
    study
}

/// Returns the code with the values of a mechanism.
fn of(code: &dyn SceneCode, prepared: &PreparedMechanism) -> Arc<SharedCode> {
    let inputs = code.inputs().expect("it takes numbers");
    let values = inputs.of("code", &prepared.mechanism).expect("its numbers");
    code.with_inputs(&values).expect("as many")
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a, x| a.max(x.abs()))
}

/// Returns states near the motion; every second one violates the constraints.
fn states(study: &Study) -> Vec<State> {
    let options = study.options.as_ref().expect("a run");
    let subject = Subject::of_run(&study.prepared, options).expect("runs");
    let (mechanism, size) = (&study.prepared.mechanism, study.prepared.assembly.size);
    let mut motion = KeptRowMotion::new(&study.prepared).expect("moves");
    let mut seed = 0.5_f64;
    let mut random = || {
        seed = (seed * 12.9898 + 78.233).sin() * 43758.5453;
        seed -= seed.floor();
        2.0 * seed - 1.0
    };
    let mut found = Vec::new();
    for k in 0.. {
        let State { t, mut q, mut v } = subject.states[k % subject.states.len()].clone();
        let unit = |j: usize| mechanism.space().unit(j, size);
        let away: Vec<f64> = (0..v.len()).map(|j| 0.02 * random() * unit(j)).collect();
        mechanism.displace(&mut q, &away);
        for (j, v) in v.iter_mut().enumerate() {
            *v += random() * unit(j);
        }
        if k % 2 == 1 || motion.project(t, &mut q, &mut v).is_ok() {
            found.push(State { t, q, v });
        }
        if found.len() == STATES {
            break;
        }
    }
    found
}

/// Compares all functions of the code with the interpreter of a mechanism.
fn compare(what: &str, code: &dyn SceneCode, study: &Study) {
    let prepared = &study.prepared;
    let mechanism = &prepared.mechanism;
    let layout = mechanism.layout();
    let (n, rows) = (layout.n_v, layout.rows());
    let mut motion = KeptRowMotion::new(prepared).expect("moves");
    let mut s = mechanism.scratch();
    let apart = |found: &[f64], expected: &[f64], size: f64, name: &str| {
        for (found, expected) in found.iter().zip(expected) {
            let by = (found - expected).abs() / size;
            assert!(by < SAME, "{what}, {name}: {found} {expected}, {by:e}");
        }
    };
    let (mut a, mut expected) = (vec![0.0; n], vec![0.0; n]);
    let mut lambda = vec![0.0; rows];
    let mut expected_lambda = ChosenValues::new(vec![0.0; rows], Vec::new());
    let (mut phi, mut residual) = (vec![0.0; layout.m], vec![0.0; rows]);
    let mut compared = 0;
    for State { t, q, v } in states(study) {
        mechanism.pose(t, &q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        mechanism.b(&mut s);
        code.phi(t, &q, &mut phi);
        apart(&phi, &s.phi, 1.0 + largest(&q), "Φ");
        code.velocity_residual(t, &q, &v, &mut residual);
        let of_rows: Vec<f64> = (0..rows)
            .map(|i| layout.velocity_residual(&s, i, &v))
            .collect();
        apart(&residual, &of_rows, 1.0 + largest(&v), "C·v − b");

        let health = code.acceleration(t, &q, &v, &mut a);
        if health < 0.3 || motion.acceleration(t, &q, &v, &mut expected).is_err() {
            continue;
        }
        compared += 1;
        let size = largest(&expected).max(largest(&v).powi(2)).max(1.0);
        apart(&a, &expected, size, "acceleration");
        code.multipliers(t, &q, &v, &mut lambda);
        motion
            .multipliers(t, &q, &v, &mut expected_lambda)
            .expect("solves");
        let expected_lambda = expected_lambda.as_chosen();
        let size = largest(expected_lambda).max(largest(mechanism.mass()) * size);
        apart(&lambda, expected_lambda, size, "multipliers");

        let rhs: Vec<f64> = (0..rows).map(|i| (1.0 + i as f64).sin()).collect();
        let dense = layout.dense(&s);
        for (kept, is_position) in [
            (&prepared.position_decision.kept, true),
            (&prepared.decision.kept, false),
        ] {
            let mut d = vec![0.0; n];
            if is_position {
                code.position_correction(t, &q, &rhs[..layout.m], &mut d);
            } else {
                code.velocity_correction(t, &q, &rhs, &mut d);
            }
            let mut saddle = KeptRowSaddle::new(n, kept.len()).expect("sizes");
            saddle
                .factor_above(0.0, |k| dense.row(kept[k]), mechanism.mass())
                .expect("independent");
            let missing: Vec<f64> = kept.iter().map(|&i| -rhs[i]).collect();
            let (mut expected, mut unused) = (vec![0.0; n], vec![0.0; kept.len()]);
            saddle
                .solve(&vec![0.0; n], &missing, &mut expected, &mut unused)
                .expect("solves");
            apart(
                &d,
                &expected,
                10.0 * largest(&expected).max(1.0),
                "correction",
            );
        }
    }
    assert!(compared > STATES / 2, "{what}: {compared} states");
}

#[test]
fn a_module_with_inputs_is_the_interpreter_of_every_scene_with_other_numbers_in_the_plane() {
    let code = four_bar::Code(four_bar::DESCRIBED);
    for shares in SHARES {
        let study = study(&changed(FOUR_BAR, &KEYS_OF_FOUR_BAR, shares));
        let study = on_rows_of(&code, study);
        let own = of(&code, &study.prepared);
        compare(&format!("{shares:?}"), &*own, &study);
    }
}

#[test]
fn a_module_with_inputs_is_the_interpreter_of_every_scene_with_other_numbers_in_space() {
    let code = arm::Code(arm::DESCRIBED);
    for shares in SHARES {
        let study = study(&changed(ARM, &KEYS_OF_ARM, shares));
        let study = on_rows_of(&code, study);
        let own = of(&code, &study.prepared);
        compare(&format!("{shares:?}"), &*own, &study);
        // The principal axes must be those of the mechanism.
        let inputs = code.inputs().expect("numbers");
        let values = inputs
            .of("arm", &study.prepared.mechanism)
            .expect("its own");
        let axes = arm::principal_axes(values.as_slice().try_into().expect("as many"));
        for (found, body) in axes.iter().zip(study.prepared.mechanism.bodies()) {
            let principal = body.principal.as_ref();
            let expected = principal.map_or([1.0, 0.0, 0.0, 0.0], |own| own.quaternion());
            assert_eq!(*found, expected, "{}", body.name);
        }
    }
}

/// A run takes the values of the inputs from its mechanism automatically.
#[test]
fn runs_take_the_numbers_of_their_scenes() {
    let ends = |prepared: &PreparedMechanism, study: &Study| {
        let mut last = Vec::new();
        let options = study.options.as_ref().expect("a run");
        let summary = simulate(prepared, options, |row| {
            last = [row.q, row.v].concat();
            Ok(ControlFlow::Continue(()))
        });
        assert_eq!(summary.expect("runs").events.len(), 0);
        last
    };
    for shares in SHARES {
        let cases: [(&str, &[&str], Arc<SharedCode>); 2] = [
            (
                FOUR_BAR,
                &KEYS_OF_FOUR_BAR,
                Arc::new(four_bar::Code(four_bar::DESCRIBED)),
            ),
            (ARM, &KEYS_OF_ARM, Arc::new(arm::Code(arm::DESCRIBED))),
        ];
        for (text, keys, code) in cases {
            let study = study(&changed(text, keys, shares));
            let coded = study.prepared.clone().with_code(code);
            let coded = coded.unwrap_or_else(|e| panic!("{shares:?}: {e}"));
            let (found, expected) = (ends(&coded, &study), ends(&study.prepared, &study));
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-7, "{found} {expected}");
            }
        }
    }
}

/// The independent rows may depend on any number. If the user has not specified rows, the rows of
/// the code are used; rows that the user specified do not change.
#[test]
fn rows_that_nobody_chose_are_those_of_the_code() {
    let code = || -> Arc<SharedCode> { Arc::new(arm::Code(arm::DESCRIBED)) };
    let text = ARM.replace("Jxx = 0.1", "Jxx = 0.118");
    let alone = study(&text).prepared;
    assert_ne!(alone.decision.kept, arm::KEPT);
    let coded = alone.with_code(code()).expect("its own");
    assert_eq!(coded.decision.kept, arm::KEPT);
    let chosen = text.replace("t_end = 0.4", "t_end = 0.4\ndrop = [1, 7, 8, 9]");
    let refused = study(&chosen).prepared.with_code(code()).err();
    assert!(
        matches!(refused, Some(CodeMismatch::Rows { .. })),
        "{refused:?}"
    );
}

/// Far from the described values, the code is either correct or rejected because of its pivots.
#[test]
fn far_values_are_served_or_refused() {
    let code = four_bar::Code(four_bar::DESCRIBED);
    let [mut served, mut refused] = [0, 0];
    for (from, to) in [
        ("mass = 2.0", "mass = 0.02"),
        ("mass = 2.0", "mass = 200.0"),
        ("inertia = 0.0075", "inertia = 3.0"),
        ("stiffness = 40.0", "stiffness = 40000.0"),
        ("at = [0.0, 0.3]", "at = [0.0, 0.1]"),
        ("at = [0.0, 0.3]", "at = [0.0, 0.02]"),
        ("at = [0.0, 0.3]", "at = [0.35, 0.4]"),
        ("at = [0.0, 0.3]", "at = [0.0, -0.3]"),
        ("at = [0.0, 0.3]", "at = [-3.0, 0.1]"),
        ("at = [0.0, 0.3]", "at = [0.79, 0.89]"),
        ("at = [0.0, 0.3]", "at = [1.2, 1.0]"),
        ("at = [0.0, 0.3]", "at = [0.9, 1.4]"),
    ] {
        let study = study(&FOUR_BAR.replace(from, to));
        match study.prepared.clone().with_code(Arc::new(code)) {
            Ok(_) => {
                served += 1;
                compare(to, &*of(&code, &study.prepared), &study);
            }
            Err(CodeMismatch::Unhealthy { .. }) => refused += 1,
            Err(other) => panic!("{to}: {other}"),
        }
    }
    assert!(
        served >= 9 && refused >= 1,
        "{served} served, {refused} refused"
    );
}

/// The inputs are whole tensors of inertia, in bodies whose frames are not along principal axes.
#[test]
fn tensors_of_inertia_are_inputs() {
    let text = include_str!("space/tumbling.toml");
    let keys = ["body.a.inertia", "body.b.mass", "force.t.torque[1].phase"];
    let names: Vec<String> = keys.iter().map(|key| (*key).to_owned()).collect();
    let tape = scene_tape("tumbling.toml", text, &Registry::standard(), &names);
    let tape = tape.unwrap_or_else(|e| panic!("{e}"));
    let other = text
        .replace(
            "[[0.3, 0.05, -0.04], [0.05, 0.25, 0.03], [-0.04, 0.03, 0.2]]",
            "[[0.4, -0.02, 0.01], [-0.02, 0.3, 0.05], [0.01, 0.05, 0.35]]",
        )
        .replace("mass = 2.0", "mass = 2.7")
        .replace("phase = 0.1", "phase = 0.7");
    let study = study(&other);
    compare("tumbling", &*of(&tape, &study.prepared), &study);
}

/// The inputs are parameters of functions of time of every kind; break times are constants of the
/// module.
#[test]
fn functions_of_time_have_their_coefficients_as_inputs() {
    let text = r#"
[scene]
name = "pushed"
space = "plane"
[[body]]
name = "a"
mass = 1.0
inertia = 0.2
[[joint]]
name = "pin"
type = "revolute"
bodies = ["ground", "a"]
at = [0.3, -0.2]
[[body]]
name = "b"
mass = 2.0
inertia = 0.1
position = [1.0, 0.0]
[[joint]]
name = "hinge"
type = "revolute"
bodies = ["ground", "b"]
at = [1.0, 0.5]
[[drive]]
name = "turn"
joint = "hinge"
type = "angle"
motion = { type = "table", times = [0.0, 0.4, 1.0], values = [0.1, 0.3, -0.2] }
[[force]]
name = "steps"
type = "torque"
body = "a"
torque = { type = "steps", start = 0.5, steps = [{ from = 0.1, to = 0.3, by = 0.7 }] }
[[force]]
name = "push"
type = "point-force"
body = "a"
point = [0.1, 0.2]
force = [{ type = "polynomial", coefficients = [0.5, -0.3, 0.8] }, { type = "linear-table", times = [0.0, 0.2, 0.5], values = [1.0, -0.5, 0.3] }]
[simulate]
t_end = 0.5
"#;
    let keys = [
        "drive.turn.motion.values",
        "force.steps.torque.start",
        "force.steps.torque.steps[0].by",
        "force.push.force[0].coefficients",
        "force.push.force[1].values[1]",
    ];
    let names: Vec<String> = keys.iter().map(|key| (*key).to_owned()).collect();
    let tape = scene_tape("pushed.toml", text, &Registry::standard(), &names);
    let tape = tape.unwrap_or_else(|e| panic!("{e}"));
    for shares in SHARES {
        let study = study(&changed(text, &keys, shares));
        compare("pushed", &*of(&tape, &study.prepared), &study);
    }
}

/// Several states are evaluated at once, each with its own values of the inputs.
#[test]
fn lanes_have_numbers_of_their_own() {
    let states = states(&study(FOUR_BAR));
    let (mut t, mut q, mut v) = (
        [0.0; 4],
        [[0.0; 4]; four_bar::N_Q],
        [[0.0; 4]; four_bar::N_V],
    );
    let mut p = [[0.0; 4]; four_bar::N_P];
    let mut each = [four_bar::DESCRIBED; 4];
    for l in 0..4 {
        t[l] = states[l].t;
        (0..four_bar::N_Q).for_each(|k| q[k][l] = states[l].q[k]);
        (0..four_bar::N_V).for_each(|k| v[k][l] = states[l].v[k]);
        for k in 0..four_bar::N_P {
            each[l][k] *= 1.0 + 0.02 * (l as f64);
            p[k][l] = each[l][k];
        }
    }
    let mut a = [[0.0; 4]; four_bar::N_V];
    let health = four_bar::acceleration_of(&t, &q, &v, &p, &mut a);
    for l in 0..4 {
        let mut one = [0.0; four_bar::N_V];
        let (q, v) = (&states[l].q, &states[l].v);
        let (q, v) = (q.as_slice().try_into(), v.as_slice().try_into());
        let own =
            four_bar::acceleration(t[l], q.expect("n_q"), v.expect("n_v"), &each[l], &mut one);
        assert_eq!(own, health[l]);
        (0..four_bar::N_V).for_each(|k| assert_eq!(a[k][l], one[k]));
    }
}

#[test]
fn a_list_of_operations_takes_the_same_numbers_as_a_module() {
    for (text, keys) in [(FOUR_BAR, &KEYS_OF_FOUR_BAR[..]), (ARM, &KEYS_OF_ARM[..])] {
        let names: Vec<String> = keys.iter().map(|key| (*key).to_owned()).collect();
        let tape = scene_tape("scene.toml", text, &Registry::standard(), &names);
        let tape = Arc::new(tape.unwrap_or_else(|e| panic!("{e}")));
        let study = study(&changed(text, keys, SHARES[1]));
        let study = on_rows_of(&*tape, study);
        let own = of(&*tape, &study.prepared);
        compare("tape", &*own, &study);
        study.prepared.with_code(tape).expect("its own");
    }
}

/// A number that is not an input is a constant of the code. A scene with another value is rejected,
/// and the error names a value that differs.
#[test]
fn a_scene_that_differs_in_another_number_is_refused() {
    let code = || -> Arc<SharedCode> { Arc::new(four_bar::Code(four_bar::DESCRIBED)) };
    for (from, to) in [
        ("mass = 1.8", "mass = 1.9"),
        (
            "points = { ground = [-0.2, 0.9]",
            "points = { ground = [-0.2, 0.95]",
        ),
        ("omega = 5.0", "omega = 5.5"),
    ] {
        let other = FOUR_BAR.replace(from, to);
        assert_ne!(other, FOUR_BAR);
        let refused = study(&other).prepared.with_code(code()).err();
        assert!(
            matches!(refused, Some(CodeMismatch::Value { .. })),
            "{to}: {refused:?}"
        );
    }
    let lame = FOUR_BAR.replace(
        "type = \"harmonic\", amplitude = 0.8, omega = 5.0, phase = 0.2, offset = 0.1",
        "type = \"polynomial\", coefficients = [0.8]",
    );
    let refused = study(&lame).prepared.with_code(code()).err();
    assert!(
        matches!(refused, Some(CodeMismatch::Shape { .. })),
        "{refused:?}"
    );
}

/// Two springs with the same stiffness have one input, until a scene gives one of them another
/// stiffness.
#[test]
fn numbers_that_are_one_input_may_not_differ_in_a_mechanism() {
    let text = r#"
scene = { name = "twins", space = "plane", format = 2 }
parameters = { k = 30.0 }
body = [{ name = "a", mass = 1.0, inertia = 0.2, angular_velocity = 1.0 }]
force = [
    { name = "first", type = "spring-damper", bodies = ["ground", "a"], points = { ground = [-1.0, 0.0], a = [-0.1, 0.0] }, stiffness = "k", damping = 0.0, free_length = 0.5 },
    { name = "second", type = "spring-damper", bodies = ["ground", "a"], points = { ground = [1.0, 0.3], a = [0.1, 0.0] }, stiffness = "k", damping = 0.0, free_length = 0.5 },
]
simulate = { t_end = 0.5 }
"#;
    let tape = |keys: &[&str]| {
        let keys: Vec<String> = keys.iter().map(|key| (*key).to_owned()).collect();
        Arc::new(scene_tape("twins.toml", text, &Registry::standard(), &keys).expect("code"))
    };
    let softer = || study(&text.replace("k = 30.0", "k = 20.0")).prepared;
    let uneven = || study(&text.replacen("stiffness = \"k\"", "stiffness = \"2*k\"", 1)).prepared;
    let one = tape(&["k"]);
    assert_eq!(one.inputs().expect("one").list.len(), 1);
    softer().with_code(one.clone()).expect("its own");
    match uneven().with_code(one).err() {
        Some(CodeMismatch::Parts { input, values, .. }) => {
            assert_eq!(input, "number of `first` (k)");
            assert_eq!(values, [60.0, 30.0]);
        }
        other => panic!("{other:?}"),
    }
    // The scene is changed as the message advises.
    let two = tape(&["force.first.stiffness", "force.second.stiffness"]);
    uneven().with_code(two).expect("its own");
}

/// A number that cannot be an input is rejected with its key, and the advice in the message is
/// correct.
#[test]
fn what_is_no_number_of_the_equations_is_refused_by_name() {
    let refused = |text: &str, key: &str| {
        let choices = Choices {
            inputs: vec![key.to_owned()],
            ..Choices::default()
        };
        let module = scene_text("scene.toml", text, &Registry::standard(), None, &choices);
        module.err().unwrap_or_else(|| panic!("{key} is an input"))
    };
    let why = |text: &str, key: &str| match refused(text, key) {
        CodeError::Input(NotAnInput::OfKey { key: named, why }) => {
            assert_eq!(named, key);
            *why
        }
        other => panic!("{key}: {other}"),
    };
    assert_eq!(why(FOUR_BAR, "simulate.t_end"), NotAnInput::Nothing);
    assert_eq!(
        why(FOUR_BAR, "body.crank.angular_velocity"),
        NotAnInput::Nothing
    );
    let steps = FOUR_BAR.replace(
        "type = \"harmonic\", amplitude = 0.8, omega = 5.0, phase = 0.2, offset = 0.1",
        "type = \"steps\", start = 0.0, steps = [{ from = 0.1, to = 0.3, by = 0.5 }]",
    );
    let key = "force.motor.torque.steps[0].to";
    assert_eq!(why(&steps, key), NotAnInput::BreakTimes);
    let switched = FOUR_BAR.replace("damping = 0.3", "damping = 0.3\nactive = true");
    assert_eq!(why(&switched, "force.spring.active"), NotAnInput::Switch);
    let round = ARM.replace(
        "inertia = [0.2, 0.25, 0.1]",
        "inertia = [[0.2, \"k\", 0.0], [\"k\", 0.25, 0.0], [0.0, 0.0, 0.1]]",
    );
    let round = round.replace("Jxx = 0.1", "Jxx = 0.1\nk = 0.0");
    assert_eq!(why(&round, "k"), NotAnInput::Structure);
    let unknown = refused(FOUR_BAR, "body.crunk.mass").to_string();
    assert!(unknown.ends_with("did you mean `crank`?"), "{unknown}");
    let misspelt = refused(FOUR_BAR, "body.crank.mas").to_string();
    assert!(
        misspelt.contains("body `crank` has no key `mas`"),
        "{misspelt}"
    );
    // As the message advises, the tensor is described with products of inertia and can then be an
    // input.
    let described = round.replace("k = 0.0", "k = 0.01");
    let choices = Choices {
        inputs: vec!["k".to_owned()],
        ..Choices::default()
    };
    scene_text(
        "arm.toml",
        &described,
        &Registry::standard(),
        None,
        &choices,
    )
    .expect("an input");
}

/// The modules in the repository must be equal to those generated from their scenes.
#[test]
fn the_checked_in_modules_with_inputs_agree_with_their_scenes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for (name, out, text, keys) in [
        ("four-bar", "four_bar", FOUR_BAR, &KEYS_OF_FOUR_BAR[..]),
        ("arm", "arm", ARM, &KEYS_OF_ARM[..]),
    ] {
        let scene = format!("crates/scene-codegen/tests/inputs/{name}.toml");
        let out = format!("crates/scene-codegen/tests/generated/{out}.rs");
        let choices = Choices {
            dynamics: Some("dynamics".into()),
            inputs: keys.iter().map(|key| (*key).to_owned()).collect(),
            ..Choices::default()
        };
        let registry = Registry::standard();
        let module = scene_text(&scene, text, &registry, None, &choices);
        let command = format!(
            "`cargo xtask codegen --scene {scene} --out {out} --dynamics dynamics --inputs {}`",
            keys.join(",")
        );
        let found = std::fs::read_to_string(root.join(&out)).unwrap_or_default();
        let module = module.unwrap_or_else(|e| panic!("{e}"));
        assert!(
            found == module.as_file(&command),
            "{out} is stale: run {command}"
        );
    }
}
