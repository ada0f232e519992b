//! Compares motions and forces of cylinders, laws, dampers, gear teeth and tyres with closed forms.

use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions, Summary};
use model::{Reaction, Registry, System};
use pfaff::{RunOptions, Study};

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
        &Registry::standard(),
        &RunOptions::default(),
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
            reactions: sample.reactions()?.as_chosen().to_vec(),
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

/// Compares two values; `size` is the usual size of such values.
fn close(found: f64, expected: f64, size: f64, what: &str) {
    let off = (found - expected).abs() / size;
    assert!(off < 1e-8, "{what}: {found}, expected {expected}");
}

/// A boom on a pin at O is raised by a cylinder from A = (1, 0) to B. The point B is on the boom, 2
/// m from O; the mass centre is 3 m from O. The cosine rule gives ℓ² = a² + b² − 2ab·cos θ.
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
        // A drive prescribes f(t) − f(0).
        let [l, l_t, l_tt] = [start + 0.1 * t - 0.02 * t * t, 0.1 - 0.04 * t, -0.04];
        let cos = (a * a + b * b - l * l) / (2.0 * a * b);
        let (theta, ab_sin) = (cos.acos(), a * b * (1.0 - cos * cos).sqrt());
        let omega = l * l_t / ab_sin;
        let alpha = (l_t * l_t + l * l_tt - a * b * cos * omega * omega) / ab_sin;
        close(row.q[2], theta - std::f64::consts::FRAC_PI_2, 1.0, "angle");
        close(row.v[2], omega, 1.0, "angular velocity");
        // The pushing force times its lever arm l_t/omega = ab·sin θ/l balances weight and inertia;
        // tension is positive.
        let push = (inertia * alpha + mass * 9.81 * arm * cos) * l / ab_sin;
        let drive = row.reactions[1].component.expect("a drive has one");
        close(drive, -push, 1e3, "force of the cylinder");
        let [fx, fy, _] = row.reactions[1].force;
        close(fx.hypot(fy), push.abs(), 1e3, "the same as a reaction");
        close(
            row.reactions[1].torque[2],
            0.0,
            1e3,
            "no torque about its end",
        );
    }
    assert!(summary.energy_balance < 1e-8, "{}", summary.energy_balance);
}

#[test]
fn without_its_drive_the_cylinder_is_free() {
    let study = study(BOOM);
    let analysed = study.analyse(0.0, None).expect("analysed");
    let freedoms = analysed.freedoms().expect("freedoms");
    let without = freedoms.without_drives.as_ref().expect("has a drive");
    assert_eq!((without.ranks.rank, without.mobility), (2, 1));
}

/// The error for a cylinder that cannot become as short as prescribed names the cylinder with its
/// drive.
#[test]
fn a_cylinder_that_cannot_get_shorter_is_named() {
    let text = BOOM.replace("[0.3, 0.1, -0.02]", "[0.0, -1.0]");
    // ℓ ≥ b − a = 1 is reached at t = √5 − 1.
    let study = study(&text);
    let failure = study.run(&options(2.0), |_| Ok(ControlFlow::Continue(())));
    let error = failure.expect_err("stops").error.to_string();
    assert!(error.contains("pump") || error.contains("1.23"), "{error}");
}

/// A motor with the torque a − b·rate acts on a wheel: ω = (a/b)·(1 − exp(−b·t/J)).
const MOTOR: &str = r#"
scene = { name = "motor", space = "plane" }
body = [{ name = "wheel", mass = 1.0, inertia = 0.4 }]
joint = [{ name = "shaft", type = "revolute", bodies = ["ground", "wheel"], at = [0, 0] }]
drive = [{ name = "motor", joint = "shaft", type = "angle", torque = "20 - 0.5*rate" }]
"#;

#[test]
fn a_motor_runs_up_exponentially() {
    let study = study(MOTOR);
    let mechanism = &study.prepared.mechanism;
    let mut s = mechanism.scratch();
    assert_eq!(mechanism.layout().rows(), 2);
    for method in [Method::Dop853, Method::Radau5] {
        let options = MotionOptions {
            method,
            ..options(3.0)
        };
        let (rows, summary) = run(&study, &options);
        for row in rows {
            let omega = 40.0 * (1.0 - (-0.5 * row.t / 0.4).exp());
            close(row.v[2], omega, 40.0, "angular velocity");
            mechanism.pose(row.t, &row.q, &mut s);
            mechanism.twist(&row.v, &mut s);
            let laws: Vec<f64> = mechanism.applied_forces().of_laws(&mut s).collect();
            close(laws[0], 20.0 - 0.5 * omega, 20.0, "torque");
        }
        // Radau IIA integrates the work less accurately than the motion.
        let bound = if method == Method::Radau5 { 1e-5 } else { 1e-8 };
        assert!(summary.energy_balance < bound, "{}", summary.energy_balance);
    }
}

/// A force law of a length, with the parameters of a spring-damper, gives the force of the
/// spring-damper, also in millimetres.
#[test]
fn a_law_of_a_length_is_a_spring_damper() {
    let head = r#"
scene = { name = "spring", space = "plane", gravity = [0.0, -9.81], format = 2 }
body = [{ name = "bob", mass = 2.0, inertia = 0.1, position = [0.5, -1.0] }]
"#;
    let spring = format!(
        "{head}force = [{{ name = \"spring\", type = \"spring-damper\", bodies = [\"ground\", \"bob\"], at = [[0, 0], [0.5, -1]],
         stiffness = 200, damping = 3, free_length = 0.9 }}]"
    );
    let by_law = |law: &str| {
        format!(
            "{head}parameters = {{ k = \"200 N/m\" }}
joint = [{{ name = \"strut\", type = \"distance\", bodies = [\"ground\", \"bob\"], at = [[0, 0], [0.5, -1]] }}]
drive = [{{ name = \"law\", joint = \"strut\", type = \"length\", force = \"{law}\" }}]"
        )
    };
    let reference = run(&study(&spring), &options(2.0)).0;
    let millimetres = by_law("-k*(measure - 900) - 3e-3*rate")
        .replace("format = 2", "format = 2, units = { length = \"mm\" }")
        .replace("-9.81", "\"-9.81 m/s^2\"")
        .replace("[0.5, -1.0]", "[500, -1000]")
        .replace("[0.5, -1]", "[500, -1000]")
        .replace("0.1,", "1e5,");
    let metres = by_law("-k*(measure - 0.9) - 3*rate");
    for text in [metres, millimetres] {
        let text = text.replace("\"-9.81 m/s^2\"", "\"-9.81*m/s^2\"");
        let rows = run(&study(&text), &options(2.0)).0;
        assert_eq!(rows.len(), reference.len());
        for (row, reference) in rows.iter().zip(&reference) {
            for (found, expected) in row.q.iter().zip(&reference.q) {
                close(*found, *expected, 1.0, "coordinate");
            }
        }
    }
}

/// Expressions of the time in every place of a function of time, compared with closed forms: the
/// motion of a drive and its torque, a rotor under a torque, a stone under a force, and a belt with
/// a prescribed velocity and its reaction.
#[test]
fn expressions_of_the_time_move_as_their_closed_forms() {
    let text = r#"
scene = { name = "functions", space = "plane", format = 2 }
parameters = { m = 2, s = 0.3, w = "2 rad/s" }
body = [
    { name = "driven", mass = 1.0, inertia = 0.4 },
    { name = "rotor", mass = 1.0, inertia = 0.5, position = [1, 0] },
    { name = "stone", mass = "m", inertia = 1.0, position = [2, 0], velocity = [0, 0] },
    { name = "belt", mass = "m", inertia = 1.0, position = [3, 0] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "driven"], at = [0, 0] },
    { name = "B", type = "revolute", bodies = ["ground", "rotor"], at = [1, 0] },
    { name = "V", type = "velocity", body = "belt", point = [0, 0], direction = [0, 1], rate = "s*exp(-t/(2 s))" },
]
drive = [{ name = "D", joint = "A", type = "angle", motion = "s*sin(w*t)^2" }]
force = [
    { name = "T", type = "torque", body = "rotor", torque = "20*cos(5*t)" },
    { name = "F", type = "point-force", body = "stone", point = [0, 0], force = ["m*abs(1 N - 2 N/s*t)", "8*t^3"] },
]
"#;
    let study = study(text);
    for method in [Method::Dop853, Method::Radau5] {
        let options = MotionOptions {
            method,
            ..options(1.0)
        };
        let (rows, _) = run(&study, &options);
        for row in rows {
            let t = row.t;
            let [driven, rotor, stone, belt] = [0, 3, 6, 9];
            // 0.3·sin²2t = 0.15·(1 − cos 4t)
            close(
                row.q[driven + 2],
                0.15 * (1.0 - (4.0 * t).cos()),
                0.3,
                "angle",
            );
            close(row.v[driven + 2], 0.6 * (4.0 * t).sin(), 0.6, "rate");
            let torque = row.reactions[2].component.expect("a drive has one");
            close(
                torque,
                -0.4 * 2.4 * (4.0 * t).cos(),
                1.0,
                "torque of the drive",
            );
            close(row.v[rotor + 2], 8.0 * (5.0 * t).sin(), 8.0, "rotor");
            // The acceleration is |1 − 2t|, with its kink at t = 0.5.
            let speed = if t < 0.5 { t - t * t } else { t * t - t + 0.5 };
            let bent = (row.v[stone] - speed).abs();
            assert!(bent < 1e-6, "a kink that is not declared: {bent:e}");
            close(row.v[stone + 1], t.powi(4), 1.0, "stone");
            close(row.v[belt + 1], 0.3 * (-t / 2.0).exp(), 0.3, "belt");
            // The reaction acts on the belt and is m·v̇.
            let force = row.reactions[3].force[1];
            close(force, -0.3 * (-t / 2.0).exp(), 0.3, "force of the belt");
        }
    }
    let error = scene_codegen::scene_tape("x", text, &Registry::standard(), &[]);
    let error = error.err().expect("rejected").to_string();
    assert!(
        error.starts_with("`D` has an expression of the time"),
        "{error}"
    );
}

/// A force without a value at some time stops the run with its name.
#[test]
fn a_force_without_a_value_stops_by_name() {
    let text = r#"
scene = { name = "stone", space = "plane", format = 2 }
body = [{ name = "stone", mass = 2.0, inertia = 1.0 }]
force = [{ name = "F", type = "point-force", body = "stone", point = [0, 0], force = ["log(1 - 1.5*t)", 0] }]
"#;
    let failure = study(text).run(&options(1.0), |_| Ok(ControlFlow::Continue(())));
    let error = failure.expect_err("stops").error.to_string();
    assert!(error.contains("the force `F` is not finite"), "{error}");
}

#[test]
fn a_law_without_a_value_stops_by_name() {
    // The wheel has ω = t/0.4, so the angle is 0.5 at t = √0.4.
    let text = MOTOR.replace("20 - 0.5*rate", "1 + 0*log((0.5 - measure)/(1 rad))");
    let study = study(&text);
    let mut last = 0.0;
    let failure = study.run(&options(3.0), |sample| {
        assert!(sample.v[2].is_finite());
        last = sample.t;
        Ok(ControlFlow::Continue(()))
    });
    let error = failure.expect_err("stops").error.to_string();
    assert!(error.contains("the law of drive `motor` (log("), "{error}");
    assert!(last > 0.55 && last < 0.4_f64.sqrt(), "{last}");
}

#[test]
fn units_of_laws_are_checked() {
    let refused = |law: &str| {
        let text = MOTOR
            .replace("20 - 0.5*rate", law)
            .replace("\"plane\"", "\"plane\", format = 2");
        let read = Study::read(
            "test.toml",
            &text,
            &Registry::standard(),
            &RunOptions::default(),
        );
        read.err().expect(law).to_string()
    };
    for (law, part) in [
        ("20 N + 1", "found a force (N)"),
        ("2 N*m - rate", "have no sum, difference or order"),
        ("5*sin(rate)", "found an angular velocity"),
        ("1/(0*2) + measure", "division by zero"),
        ("20 - speed", "no parameter `speed`"),
        ("sin(measure)*(5 N)", "found a force (N)"),
        ("(2/rad)*measure", "found a number without a unit"),
    ] {
        let error = refused(law);
        assert!(error.contains(part), "{law}: {error}");
    }
    for fits in [
        "2 N*m - 3 N*m*s/rad*rate",
        "20*exp(-rate/40)",
        "-5*sin(measure)",
        "sin(measure)",
        "(1 + 2*cos(measure)^2)*exp(-sin(measure))",
        "sin(measure)*(5 N*m)",
    ] {
        study(&MOTOR.replace("20 - 0.5*rate", fits));
    }
}

/// A rod slides between bearings with viscous friction: v = v₀·exp(−c·t/m).
#[test]
fn a_damped_slider_slows_exponentially() {
    let text = r#"
scene = { name = "slider", space = "plane" }
body = [{ name = "slider", mass = 2.0, inertia = 1.0, position = [1.0, 0.0], velocity = [3.0, 0.0] }]
joint = [{ name = "guide", type = "translational", bodies = ["ground", "slider"], at = [1, 0], axis = [1, 0] }]
force = [{ name = "oil", type = "damper", bodies = ["ground", "slider"], at = [[0, 0], [1, 0]], damping = 0.8 }]
"#;
    let (rows, summary) = run(&study(text), &options(4.0));
    for row in rows {
        close(row.v[0], 3.0 * (-0.4 * row.t).exp(), 3.0, "velocity");
    }
    assert!(summary.energy_balance < 1e-8, "{}", summary.energy_balance);
}

/// A train of two wheels on fixed axes is driven by a torque on the first wheel. The motion is that
/// of `gear`. The teeth carry F = J₂·α₂/(r₂·cos α) along the line of action, which loads the
/// bearings.
#[test]
fn teeth_load_the_bearings() {
    let train = |joint: &str| {
        let text = format!(
            r#"
scene = {{ name = "train", space = "plane" }}
body = [
    {{ name = "a", mass = 1.0, inertia = 0.5 }},
    {{ name = "b", mass = 2.0, inertia = 3.0, position = [3.0, 0.0] }},
]
joint = [
    {{ name = "A", type = "revolute", bodies = ["ground", "a"], at = [0, 0] }},
    {{ name = "B", type = "revolute", bodies = ["ground", "b"], at = [3, 0] }},
    {{ name = "teeth", bodies = ["a", "b"], ratio = -0.5, {joint} }},
]
force = [{{ name = "motor", type = "torque", body = "a", torque = 7.0 }}]
"#
        );
        run(&study(&text), &options(1.0)).0
    };
    let gear = train(r#"type = "gear""#);
    let mesh = train(
        r#"type = "mesh", points = { a = [0, 0], b = [0, 0] }, pressure_angle = 0.6435011087932844"#,
    );
    // The reduced inertia is J = J₁ + J₂·ratio².
    let alpha = 7.0 / (0.5 + 3.0 * 0.25);
    // With r₂ = 2 and cos α = 0.8, F·r₂·cos α = J₂·|α₂|.
    let along = 3.0 * 0.5 * alpha / (2.0 * 0.8);
    for (row, gear) in mesh.iter().zip(&gear) {
        close(row.v[2], alpha * row.t, 10.0, "angular velocity");
        for (found, expected) in row.q.iter().zip(&gear.q) {
            close(*found, *expected, 10.0, "coordinate");
        }
        // With n = 0.8·(0, 1) + 0.6·(1, 0), the teeth push the first wheel back and away.
        let [fx, fy, _] = row.reactions[2].force;
        close(fx, -0.6 * along, 10.0, "radial force");
        close(fy, -0.8 * along, 10.0, "circumferential force");
        close(
            row.reactions[2].torque[2],
            -0.8 * along,
            10.0,
            "torque about the centre",
        );
        // The force of the teeth acts on the ground, the first body of the bearing.
        close(row.reactions[0].force[0], -0.6 * along, 10.0, "bearing");
        close(row.reactions[0].force[1], -0.8 * along, 10.0, "bearing");
        close(gear.reactions[0].force[0], 0.0, 10.0, "bearing of a gear");
    }
}

/// A single-track vehicle in a steady turn at the speed V with the steering angle δ has the yaw
/// rate V·δ/(L + K·V²), K = m/L·(b/C_f − a/C_r) (Pacejka, 2012, chapter 1; Rajamani, Vehicle
/// Dynamics and Control, 2012, chapter 3).
#[test]
fn a_single_track_vehicle_turns_as_the_textbook_says() {
    let (mass, a, b, front, rear, speed) = (1500.0, 1.2, 1.6, 6e4, 8e4, 20.0);
    // The errors of the linear theory are δ² times the yaw rate.
    let delta: f64 = 1e-4;
    let text = format!(
        r#"
scene = {{ name = "car", space = "plane" }}
body = [{{ name = "car", mass = {mass}, inertia = 2500.0, velocity = [{speed}, 0.0] }}]
joint = [{{ name = "cruise", type = "velocity", body = "car", point = [0, 0], direction = [1, 0], rate = {speed} }}]
force = [
    {{ name = "front", type = "tyre", body = "car", point = [{a}, 0], normal = [{}, {}], stiffness = {front}, low_speed = 1e-3 }},
    {{ name = "rear", type = "tyre", body = "car", point = [-{b}, 0], normal = [0, 1], stiffness = {rear}, low_speed = 1e-3 }},
]
"#,
        -delta.sin(),
        delta.cos(),
    );
    let rows = run(&study(&text), &options(10.0)).0;
    let wheelbase = a + b;
    let understeer = mass / wheelbase * (b / front - a / rear);
    let expected = speed * delta / (wheelbase + understeer * speed * speed);
    let found = rows.last().expect("rows").v[2];
    assert!((found / expected - 1.0).abs() < 1e-6, "{found}, {expected}");
}

/// A wheel of 1 kg·m² at 1 rad, with this law along its angle.
fn wheel(torque: &str) -> String {
    format!(
        r#"
scene = {{ name = "wheel", space = "plane" }}
body = [{{ name = "wheel", mass = 1, inertia = 1, angle = 1 }}]
joint = [{{ name = "pin", type = "revolute", bodies = ["ground", "wheel"], at = [0, 0] }}]
drive = [{{ name = "motor", joint = "pin", type = "angle", torque = "{torque}" }}]
"#
    )
}

/// Returns Σ cₖ·exp(−aₖ·t) with the value 1, the rate 0 and this acceleration at t = 0.
fn decay([a, b, c]: [f64; 3], acceleration: f64, t: f64) -> f64 {
    // Lagrange: each coefficient follows from the product of the two other factors.
    let part = |a: f64, b: f64, c: f64| (acceleration + b * c) / ((a - b) * (a - c));
    part(a, b, c) * (-a * t).exp() + part(b, c, a) * (-b * t).exp() + part(c, a, b) * (-c * t).exp()
}

/// With the poles −1, −2 and −3, the characteristic polynomial s³ + 6·s² + 11·s + 6 is that of
/// `θ̈ = −11·θ − 6·θ̇ − 6·∫θ`. At the start the integral is zero, so θ̈ = −11.
#[test]
fn an_integral_in_a_law_is_a_state_of_the_motion() {
    let scene = wheel("-11*measure - 6*rate - 6*integral(measure)");
    let (rows, summary) = run(&study(&scene), &options(3.0));
    for row in &rows {
        close(row.q[2], decay([1.0, 2.0, 3.0], -11.0, row.t), 1.0, "angle");
        // The state: −6·∫θ = θ̈ + 11·θ + 6·θ̇, and the integral of each exponential is known.
        let integral = |a: f64, b: f64, c: f64| {
            (b * c - 11.0) / ((a - b) * (a - c)) * (1.0 - (-a * row.t).exp()) / a
        };
        let expected = integral(1.0, 2.0, 3.0) + integral(2.0, 3.0, 1.0) + integral(3.0, 1.0, 2.0);
        close(row.q[3], expected, 1.0, "integral");
    }
    assert!(summary.energy_balance < 1e-8, "{}", summary.energy_balance);
}

/// `θ̈ = −k·y − d·θ̇` with `ẏ = (θ − y)/T` has the polynomial s³ + (1/T + d)·s² + (d/T)·s + k/T. At
/// the start y = θ = 1, so θ̈ = −k.
#[test]
fn a_lag_in_a_law_starts_at_its_input() {
    let poles = [0.5, 1.0, 8.0];
    let [one, two, three]: [f64; 3] = [9.5, 12.5, 4.0];
    let rate = 0.5 * (one - (one * one - 4.0 * two).sqrt());
    let (k, d, time) = (three / rate, one - rate, 1.0 / rate);
    let scene = wheel(&format!("-{k:?}*lag(measure, {time:?}) - {d:?}*rate"));
    let (rows, _) = run(&study(&scene), &options(3.0));
    for row in &rows {
        close(row.q[2], decay(poles, -k, row.t), 1.0, "angle");
    }
    assert_eq!(rows[0].q[3], 1.0);
}

/// A lag of a lag starts at its input, too, and a run that starts at a row continues the states.
#[test]
fn states_of_laws_continue_at_a_restart() {
    let scene =
        wheel("-9*lag(lag(measure, 0.1), 0.2) - 2*rate - 3*integral(measure) - 1*lag(rate, 0.3)");
    let study = study(&scene);
    let (rows, _) = run(&study, &options(2.0));
    assert_eq!(rows[0].q[3..5], [1.0, 1.0]);
    let (middle, last) = (&rows[rows.len() / 2], &rows[rows.len() - 1]);
    let later = study
        .at(middle.t, &middle.q, &middle.v)
        .unwrap_or_else(|e| panic!("{e}"));
    let (again, _) = run(&later, &options(2.0));
    for (k, (a, b)) in again[again.len() - 1].q.iter().zip(&last.q).enumerate() {
        close(*a, *b, 1.0, &format!("coordinate {k}"));
    }
    let refused = study
        .text_at(middle.t, &middle.q, &middle.v)
        .expect_err("no key");
    assert!(
        refused.to_string().contains("state of the law of `motor`"),
        "{refused}"
    );
}

/// Two wheels move independently, so a run may integrate them separately.
#[test]
fn parts_of_a_mechanism_have_their_own_states() {
    let scene = r#"
scene = { name = "wheels", space = "plane" }
body = [
    { name = "a", mass = 1, inertia = 1, angle = 1 },
    { name = "b", mass = 1, inertia = 1, angle = 1 },
]
joint = [
    { name = "first", type = "revolute", bodies = ["ground", "a"], at = [0, 0] },
    { name = "second", type = "revolute", bodies = ["ground", "b"], at = [1, 0] },
]
drive = [
    { name = "one", joint = "first", type = "angle", torque = "-11*measure - 6*rate - 6*integral(measure)" },
    { name = "two", joint = "second", type = "angle", torque = "-4*lag(measure, 0.5) - 1*rate" },
]
"#;
    let study = study(scene);
    let part = study.prepared.mechanism.part(&[1]);
    assert_eq!(part.places.coordinates, [3, 4, 5, 7]);
    let (rows, _) = run(&study, &options(2.0));
    let last = &rows[rows.len() - 1];
    close(last.q[2], decay([1.0, 2.0, 3.0], -11.0, 2.0), 1.0, "angle");
}
