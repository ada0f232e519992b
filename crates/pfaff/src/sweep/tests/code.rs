//! Runs on generated code, several at once, compared with each run alone and with the interpreter.

use super::super::job::Keep;
use super::super::make::TOGETHER;
use super::*;

/// A cart has two knife edges, whose longitudinal forces are not unique, and a pendulum.
const CART: &str = r#"
scene = { name = "cart", space = "plane", gravity = [0.0, -9.81] }
body = [
    { name = "cart", mass = 10.0, inertia = 1.0, velocity = [1.0, 0.0], angular_velocity = 0.5 },
    { name = "bob", mass = 2.0, inertia = 0.02, position = [0.7, -0.4] },
]
joint = [
    { name = "left", type = "knife-edge", body = "cart", at = [0.0, 0.5], normal = [0.0, 1.0] },
    { name = "right", type = "knife-edge", body = "cart", at = [0.0, -0.5], normal = [0.0, 1.0] },
    { name = "pivot", type = "revolute", bodies = ["cart", "bob"], at = [0.3, 0.0] },
]
simulate = { t_end = 2.0, output_step = 0.1, rtol = 1e-8, atol = 1e-10 }
"#;

/// A crank turns through both dead centres, with a torsional spring and a function of time.
const SLIDER: &str = r#"
scene = { name = "slider", space = "plane", gravity = [0.0, -9.81] }
body = [
    { name = "crank", mass = 1.0, inertia = 0.01, position = [0.025, 0.0433012702], angle = 1.0471975512, angular_velocity = 20.0 },
    { name = "rod", mass = 0.5, inertia = 0.004, position = [0.1936140661, 0.0433012702], angle = -0.2928427 },
    { name = "slider", mass = 0.8, inertia = 0.001, position = [0.3372281323, 0.0] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["crank", "rod"], at = [0.05, 0.0866025404] },
    { name = "C", type = "revolute", bodies = ["rod", "slider"], at = [0.3372281323, 0.0] },
    { name = "D", type = "translational", bodies = ["ground", "slider"], at = [0.0, 0.0], axis = [1.0, 0.0] },
]
simulate = { t_end = 1.0, output_step = 0.05, rtol = 1e-8, atol = 1e-10 }
"#;

/// A chassis on two wheels is pushed; a wheel without moment of inertia about its axle has no mass
/// if only positions are constrained.
const WHEELS: &str = r#"
scene = { name = "wheels", space = "spatial", gravity = [0.0, 0.0, -9.81] }
body = [
    { name = "chassis", mass = 20.0, inertia = [1.0, 2.0, 3.0], position = [0.0, 0.0, 0.5] },
    { name = "left", mass = 1.0, inertia = [0.025, 0.045, 0.025], position = [0.0, 0.4, 0.3] },
    { name = "right", mass = 1.0, inertia = [0.025, 0.045, 0.025], position = [0.0, -0.4, 0.3] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["chassis", "left"], at = [0.0, 0.4, 0.3], axis = [0.0, 1.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["chassis", "right"], at = [0.0, -0.4, 0.3], axis = [0.0, 1.0, 0.0] },
    { name = "C", type = "wheel", body = "left", point = [0.0, 0.0, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.3 },
    { name = "D", type = "wheel", body = "right", point = [0.0, 0.0, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.3 },
]
force = [{ name = "push", type = "point-force", body = "chassis", point = [0.0, 0.0, 0.0], force = [13.0, 0.0, 0.0] }]
simulate = { t_end = 0.3, output_step = 0.05, rtol = 1e-8, atol = 1e-10 }
"#;

/// A parallelogram of two cranks makes many revolutions: at its singular configurations generated
/// code stops, and is used again behind them.
const CRANKS: &str = r#"
scene = { name = "cranks", space = "plane" }
body = [
    { name = "first", mass = 1.0, inertia = 0.02, position = [0.15, 0.2], angle = 0.927, angular_velocity = 4.0 },
    { name = "second", mass = 1.0, inertia = 0.02, position = [1.15, 0.2], angle = 0.927, angular_velocity = 4.0 },
    { name = "coupler", mass = 2.0, inertia = 0.2, position = [0.8, 0.4] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "first"], at = [0.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["ground", "second"], at = [1.0, 0.0] },
    { name = "C", type = "revolute", bodies = ["first", "coupler"], at = [0.3, 0.4] },
    { name = "D", type = "revolute", bodies = ["second", "coupler"], at = [1.3, 0.4] },
]
simulate = { t_end = 3.0, output_step = 0.1, rtol = 1e-8, atol = 1e-10 }
"#;

const CASES: [(&str, &[&str]); 4] = [
    (
        CART,
        &["body.cart.mass=8:14:10", "body.bob.inertia=0.01:0.05:10"],
    ),
    (
        CART,
        &["simulate.rtol=1e-7,1e-8", "joint.pivot.at[0]=0.1:0.5:50"],
    ),
    (
        SLIDER,
        &["body.rod.mass=0.2:1:10", "scene.gravity[1]=-20:0:10"],
    ),
    (
        WHEELS,
        &["body.right.inertia[1]=0,0.045", "body.left.mass=0.5:2:50"],
    ),
];

/// Returns a row without the column of seconds.
fn cells(row: &SweepRow) -> Vec<u64> {
    let motion = row.motion.as_ref().expect("it moved");
    let numbers = [
        motion.t,
        motion.max_position_residual,
        motion.max_velocity_residual,
        motion.energy_balance,
        motion.start_correction,
        motion.start_velocity_correction,
    ];
    let largest = (0..motion.peaks.len()).flat_map(|k| motion.largest(k));
    let counts = [
        motion.steps,
        motion.rejected,
        motion.evaluations,
        motion.events,
        motion.rank,
        motion.redundancy,
        motion.not_unique.unwrap_or(u64::MAX),
        motion.fragile,
    ];
    let numbers = numbers.into_iter().chain(motion.state.iter().copied());
    let numbers = numbers.chain(largest.flatten()).map(f64::to_bits);
    counts.into_iter().chain(numbers).collect()
}

fn made_together(sweep: &Sweep<'_>) -> Vec<SweepRow> {
    let runs: Vec<u64> = (1..=sweep.runs()).collect();
    let mut rows = Vec::new();
    for group in runs.chunks(TOGETHER) {
        let mut sink = |row: SweepRow| {
            rows.push(row);
            Ok(())
        };
        let made = sweep.make(group, Keep::Rows, &|| false, &mut sink);
        made.unwrap_or_else(|e| panic!("{e}"));
    }
    rows.sort_by_key(|row| row.run);
    rows
}

/// Each run has the same bits as the run alone, whatever other runs are performed at the same time.
#[test]
fn runs_made_together_are_those_made_alone() {
    let registry = Registry::standard();
    for (scene, vary) in CASES {
        let sweep = sweep(&registry, scene, vary);
        let evaluation = sweep.evaluation();
        assert!(evaluation.starts_with("generated code"), "{evaluation}");
        let rows = made_together(&sweep);
        assert_eq!(rows.len() as u64, sweep.runs());
        for row in &rows {
            assert_eq!((row.status, row.error.as_str()), (SweepStatus::Done, ""));
            assert_eq!(cells(row), cells(&sweep.row(row.run)), "run {}", row.run);
        }
    }
}

/// The interpreter derives the same equations independently: rows agree to 1e-9.
#[test]
fn runs_on_code_are_those_of_the_interpreter() {
    let registry = Registry::standard();
    for (scene, vary) in CASES {
        let on_code = sweep(&registry, scene, vary);
        let interpreted = sweep(&registry, scene, vary);
        interpreted
            .code
            .set(Err("for the test".to_owned()))
            .unwrap_or_else(|_| panic!("no run has begun"));
        let rows = made_together(&on_code);
        for (row, other) in rows.iter().zip(made_together(&interpreted)) {
            let (found, expected) = (row.motion.as_ref(), other.motion.as_ref());
            let (found, expected) = (found.expect("moved"), expected.expect("moved"));
            let state = found.state.iter().zip(&expected.state);
            let of = |motion: &SweepMotion| -> Vec<f64> {
                let each = 0..motion.peaks.len();
                each.map(|k| motion.largest(k)[0][0]).collect()
            };
            let (found_forces, expected_forces) = (of(found), of(expected));
            let forces = found_forces.iter().zip(&expected_forces);
            for (a, b) in state.chain(forces) {
                let same = (a - b).abs() <= 1e-9 * b.abs().max(1.0) || a.is_nan() && b.is_nan();
                assert!(same, "run {} of {vary:?}: {a:e} {b:e}", row.run);
            }
            assert_eq!(found.steps, expected.steps, "run {}", row.run);
        }
    }
}

/// If only masses vary, runs use the decisions of the scene without changes: the rows are bitwise
/// the same as with separate decisions. Runs with other joints need separate decisions.
#[test]
fn decisions_are_shared_where_constraints_are_the_same() {
    let registry = Registry::standard();
    for (case, (scene, vary)) in CASES.into_iter().enumerate() {
        let sharing = sweep(&registry, scene, vary);
        let deciding = sweep(&registry, scene, vary);
        for sweep in [&sharing, &deciding] {
            let _ = sweep.code.set(Err("for the test".to_owned()));
        }
        assert!(deciding.described.set(None).is_ok());
        for run in 1..=sharing.runs() {
            let begun = sharing.begin(run).unwrap_or_else(|e| panic!("{e}"));
            let described = sharing.described().expect("it can be analysed");
            let is_shared = described.decides(&begun.study.prepared);
            assert_eq!(is_shared, case != 1, "run {run} of {vary:?}");
            assert_eq!(cells(&sharing.row(run)), cells(&deciding.row(run)));
        }
    }
}

/// At singular configurations runs leave their generated code. The interpreter passes all these
/// configurations, and so do the runs. Their rows describe the motion and not the way in which it
/// was computed.
#[test]
fn runs_that_leave_their_code_end_as_interpreted_ones() {
    let registry = Registry::standard();
    let vary = &["body.coupler.mass=1:3:20", "body.first.mass=0.5:2:5"];
    let on_code = sweep(&registry, CRANKS, vary);
    assert!(on_code.evaluation().starts_with("generated code"));
    let interpreted = sweep(&registry, CRANKS, vary);
    let _ = interpreted.code.set(Err("for the test".to_owned()));
    let rows = made_together(&on_code);
    for (row, other) in rows.iter().zip(made_together(&interpreted)) {
        assert_eq!(
            (row.status, row.error.as_str()),
            (SweepStatus::Done, ""),
            "run {}",
            row.run
        );
        let (found, expected) = (row.motion.as_ref(), other.motion.as_ref());
        let (found, expected) = (found.expect("moved"), expected.expect("moved"));
        assert!(expected.events > 0);
        assert_eq!(found.events, expected.events, "run {}", row.run);
        for (a, b) in found.state.iter().zip(&expected.state) {
            assert!((a - b).abs() <= 1e-6, "run {}: {a:e} {b:e}", row.run);
        }
    }
}
