//! Cylinders, laws, dampers, teeth and tyres: motions and forces against closed forms.

use std::ops::ControlFlow;

use dynamics::{MotionOptions, Summary};
use model::{Reaction, Registry};
use pfaff::{Overrides, Study};

/// Time, coordinates, velocities and reactions of one row.
struct Row {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    reactions: Vec<Reaction>,
}

fn study(text: &str) -> Study {
    let study = Study::read(
        "test.toml",
        text,
        &Registry::planar(),
        &Overrides::default(),
    );
    study.unwrap_or_else(|e| panic!("{e}"))
}

fn run(study: &Study, options: &MotionOptions) -> (Vec<Row>, Summary) {
    let mut rows = Vec::new();
    let summary = study.run(options, |sample| {
        rows.push(Row {
            t: sample.t,
            q: sample.q.to_vec(),
            v: sample.v.to_vec(),
            reactions: sample.reactions()?,
        });
        Ok(ControlFlow::Continue(()))
    });
    (rows, summary.unwrap_or_else(|e| panic!("{}", e.error)))
}

fn options(t_end: f64) -> MotionOptions {
    MotionOptions {
        rtol: 1e-10,
        atol: 1e-12,
        ..MotionOptions::to(t_end)
    }
}

/// Distance of two numbers, relative to the size of such numbers.
fn close(found: f64, expected: f64, size: f64, what: &str) {
    let off = (found - expected).abs() / size;
    assert!(off < 1e-8, "{what}: {found}, expected {expected}");
}

/// A boom on a pin at O, raised by a cylinder from A = (1, 0) to B, 2 m from O on the boom; its
/// mass centre is 3 m from O. The cosine rule: ℓ² = a² + b² − 2ab·cos θ.
const BOOM: &str = r#"
scene = { name = "boom", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "boom", mass = 40.0, inertia = 5.0, position = [0.0, 3.0], angle = 0.0 }]
drive = [{ name = "pump", joint = "cylinder", type = "length", motion = { type = "polynomial", coefficients = [0.3, 0.1, -0.02] } }]
joint = [
    { name = "pin", type = "revolute", bodies = ["ground", "boom"], at = [0, 0] },
    { name = "cylinder", type = "distance", bodies = ["ground", "boom"], at = [[1, 0], [0, 2]] },
]
"#;

#[test]
fn a_boom_follows_its_cylinder_and_the_cylinder_carries_it() {
    let study = study(BOOM);
    let found = study.analyse(0.0, None).expect("analysed").analysis;
    assert_eq!(found.mobility(), 0);
    let names: Vec<&str> = found.reactions.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["pin", "pump"]);
    let (rows, summary) = run(&study, &options(2.0));
    let (a, b, mass, inertia, arm) = (1.0_f64, 2.0_f64, 40.0, 5.0 + 40.0 * 9.0, 3.0);
    let start = 5.0_f64.sqrt();
    for row in rows {
        let t = row.t;
        // A drive follows f(t) − f(0).
        let [l, l_t, l_tt] = [start + 0.1 * t - 0.02 * t * t, 0.1 - 0.04 * t, -0.04];
        let cos = (a * a + b * b - l * l) / (2.0 * a * b);
        let (theta, ab_sin) = (cos.acos(), a * b * (1.0 - cos * cos).sqrt());
        let omega = l * l_t / ab_sin;
        let alpha = (l_t * l_t + l * l_tt - a * b * cos * omega * omega) / ab_sin;
        close(row.q[2], theta - std::f64::consts::FRAC_PI_2, 1.0, "angle");
        close(row.v[2], omega, 1.0, "angular velocity");
        // The push times its lever l_t/omega = ab·sin θ/l carries weight and inertia; tension is
        // positive.
        let push = (inertia * alpha + mass * 9.81 * arm * cos) * l / ab_sin;
        let drive = row.reactions[1].component.expect("a drive has one");
        close(drive, -push, 1e3, "force of the cylinder");
        let [fx, fy] = row.reactions[1].force;
        close(fx.hypot(fy), push.abs(), 1e3, "the same as a reaction");
        close(row.reactions[1].torque, 0.0, 1e3, "no torque about its end");
    }
    assert!(summary.energy_balance < 1e-8, "{}", summary.energy_balance);
}

#[test]
fn without_its_drive_the_cylinder_is_free() {
    let study = study(BOOM);
    let analysed = study.analyse(0.0, None).expect("analysed");
    let freedoms = analysed.freedoms().expect("freedoms");
    let without = freedoms.without_drives.expect("has a drive");
    assert_eq!((without.ranks.rank, without.mobility), (2, 1));
}

/// A cylinder that cannot become as short as asked for is named with its drive.
#[test]
fn a_cylinder_that_cannot_get_shorter_is_named() {
    let text = BOOM.replace("[0.3, 0.1, -0.02]", "[0.0, -1.0]");
    // ℓ ≥ b − a = 1 is reached at t = √5 − 1.
    let study = study(&text);
    let failure = study.run(&options(2.0), |_| Ok(ControlFlow::Continue(())));
    let error = failure.expect_err("stops").error.to_string();
    assert!(error.contains("pump") || error.contains("1.23"), "{error}");
}
