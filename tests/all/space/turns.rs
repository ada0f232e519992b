//! Compares unwrapped angles with closed forms: screws, and springs and motors on the angles of
//! joints in space.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions, Summary};
use model::Registry;
use pfaff::{RunOptions, Study};

/// The end of a run.
struct End {
    q: Vec<f64>,
    v: Vec<f64>,
    summary: Summary,
}

fn study(text: &str) -> Study {
    let study = Study::read(
        "t.toml",
        text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    study.unwrap_or_else(|e| panic!("{e}"))
}

fn run(text: &str, options: &MotionOptions) -> End {
    let (mut q, mut v) = (Vec::new(), Vec::new());
    let summary = study(text).run(options, |sample| {
        (q, v) = (sample.q.to_vec(), sample.v.to_vec());
        Ok(ControlFlow::Continue(()))
    });
    let summary = summary.unwrap_or_else(|e| panic!("{}", e.error));
    End { q, v, summary }
}

/// The options request one row at the end, many revolutions after the start.
fn options(t_end: f64, method: Method, tolerance: f64) -> MotionOptions {
    MotionOptions {
        rtol: tolerance,
        atol: tolerance,
        method,
        output_step: t_end,
        ..MotionOptions::to(t_end)
    }
}

fn close(found: f64, expected: f64, bound: f64, what: &str) {
    let off = (found - expected).abs();
    assert!(off <= bound, "{what}: {found}, expected {expected}");
}

/// A nut is on a vertical screw and starts at a third of a revolution.
fn nut(pitch: f64, omega: f64) -> String {
    format!(
        r#"
scene = {{ name = "nut", space = "spatial", gravity = [0.0, 0.0, -9.81] }}
body = [{{ name = "nut", mass = 0.3, inertia = [2e-4, 2e-4, 3e-4], position = [1.0, 2.0, 0.5],
    orientation = {{ axis = [0, 0, 1], angle = 2.0 }}, velocity = [0.0, 0.0, {velocity}], angular_velocity = [0, 0, {omega}] }}]
joint = [{{ name = "thread", type = "screw", bodies = ["ground", "nut"], at = [1.0, 2.0, 0.0], axis = [0, 0, 1], pitch = {pitch} }}]
"#,
        velocity = pitch / TAU * omega,
    )
}

#[test]
fn a_nut_falls_along_its_thread_turn_by_turn() {
    // The equation is (m + J·(2π/p)²)·z̈ = −m·g: with p = 5 mm the first revolution takes 2.4 s.
    let methods = [
        Method::Dop853,
        Method::Dopri5,
        Method::Tsit5,
        Method::Radau5,
    ];
    for (pitch, method) in methods
        .into_iter()
        .map(|m| (0.005, m))
        .chain([(-0.4, Method::Dop853)])
    {
        let (m, j, omega) = (0.3, 3e-4, 40.0);
        let per_radian = pitch / TAU;
        let fall = m * 9.81 / (m + j / (per_radian * per_radian));
        let t = if pitch < 0.0 { 3.0 } else { 20.0 };
        let expected = 0.5 + per_radian * omega * t - 0.5 * fall * t * t;
        let turns = (expected - 0.5) / pitch;
        assert!(turns.abs() > 50.0, "{turns}");
        let end = run(&nut(pitch, omega), &options(t, method, 1e-10));
        close(end.q[2], expected, 1e-7 * expected.abs().max(1.0), "height");
        let angle = 2.0 + turns * TAU;
        let found = 2.0 * end.q[6].atan2(end.q[3]);
        close((0.5 * (found - angle)).sin(), 0.0, 1e-6, "angle");
        // The unwrapped angle is the angle since the start.
        close(end.q[7], turns * TAU, 1e-6, "turns");
        assert!(end.summary.max_position_residual < 1e-10);
        close(end.v[2], per_radian * end.v[5], 1e-9, "advance");
    }
}

#[test]
fn a_screw_has_one_freedom_and_its_thread_carries_a_couple() {
    let found = study(&nut(0.005, 0.0))
        .analyse(0.0, None)
        .expect("analysed")
        .analysis;
    assert_eq!(
        (
            found.decision.rank,
            found.mobility(),
            found.decision.redundancy
        ),
        (5, 1, 0)
    );
}

/// A wheel on an axis along (1, 2, 2)/3 has a torsion spring, and its tensor is not aligned with
/// its axes.
fn balance(law: &str, tensor: &str) -> String {
    format!(
        r#"
scene = {{ name = "balance", space = "spatial" }}
body = [{{ name = "wheel", mass = 1.0, inertia = {tensor}, position = [0, 0, 0], angular_velocity = [20.0, 40.0, 40.0] }}]
joint = [{{ name = "axle", type = "revolute", bodies = ["ground", "wheel"], at = [0, 0, 0], axis = [1, 2, 2] }}]
drive = [{{ name = "spring", joint = "axle", type = "angle", torque = "{law}" }}]
"#
    )
}

#[test]
fn a_torsion_spring_counts_its_turns() {
    // The moment of inertia J about the axis is a·J·a with a = (1, 2, 2)/3.
    let tensors = [
        ("[0.9, 0.9, 0.9]", 0.9),
        (
            "[[1.0, 0.1, 0.0], [0.1, 0.9, 0.05], [0.0, 0.05, 1.1]]",
            (1.0 + 4.0 * 0.9 + 4.0 * 1.1 + 2.0 * 2.0 * 0.1 + 2.0 * 4.0 * 0.05) / 9.0,
        ),
    ];
    for (tensor, inertia) in tensors {
        let (k, omega) = (1.3_f64, 60.0);
        let own = (k / inertia).sqrt();
        for method in [Method::Dop853, Method::Radau5] {
            for t in [0.25, 1.0, 1.9] {
                let t = t * PI / own;
                let end = run(
                    &balance(&format!("-{k} * measure"), tensor),
                    &options(t, method, 1e-10),
                );
                let angle = omega / own * (own * t).sin();
                close(end.q[7], angle, 1e-6, "angle");
                let rate = (omega * (own * t).cos()).abs();
                let found = end.v[3..6].iter().map(|x| x * x).sum::<f64>().sqrt();
                close(found, rate, 1e-6 * omega, "rate");
                assert!(
                    end.summary.energy_balance < 1e-8,
                    "{}",
                    end.summary.energy_balance
                );
            }
        }
        // The wheel makes more than seven revolutions.
        assert!(omega / own > 7.0 * TAU);
    }
}

#[test]
fn a_spring_on_a_joint_has_no_torque_at_the_start_or_where_it_is_told() {
    let scene = |more: &str| {
        format!(
            r#"
scene = {{ name = "sprung", space = "spatial" }}
body = [{{ name = "wheel", mass = 1.0, inertia = [2.0, 2.0, 2.0], position = [0, 0, 0], angular_velocity = [0, 0, 30.0] }}]
joint = [{{ name = "axle", type = "cylindrical", bodies = ["ground", "wheel"], at = [0, 0, 0], axis = [0, 0, 1] }}]
force = [{{ name = "spring", type = "torsion-spring-damper", joint = "axle", stiffness = 0.5, damping = 0.2{more} }}]
"#
        )
    };
    // The equation is J·θ̈ + c·θ̇ + k·(θ − θ₀) = 0.
    let (j, c, k, v) = (2.0_f64, 0.2_f64, 0.5_f64, 30.0_f64);
    let (sigma, t) = (0.5 * c / j, 5.0);
    let own = (k / j - sigma * sigma).sqrt();
    for (more, free) in [("", 0.0), (", free_angle = 9.5", 9.5)] {
        let from = -free;
        let damped = (-sigma * t).exp();
        let expected =
            free + damped * (from * (own * t).cos() + (v + sigma * from) / own * (own * t).sin());
        let end = run(&scene(more), &options(t, Method::Dop853, 1e-11));
        close(end.q[7], expected, 1e-7, "angle");
    }
}

/// Implicit methods select one coordinate of a hinge and complete the others, for any axis of the
/// body.
#[test]
fn pendulums_swing_about_any_axis_by_the_implicit_method() {
    for axis in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 2, 2], [3, -1, 0]] {
        let size = f64::from(axis.iter().map(|x: &i32| x * x).sum::<i32>()).sqrt();
        let a = axis.map(|x| f64::from(x) / size);
        // Gravity acts across the axis, along `down`; the rod starts along their cross product.
        let across = if axis[0] == 0 {
            [1.0, 0.0, 0.0]
        } else {
            [-a[1], a[0], 0.0]
        };
        let across = if axis == [1, 0, 0] {
            [0.0, 1.0, 0.0]
        } else {
            across
        };
        let length = across.iter().map(|x| x * x).sum::<f64>().sqrt();
        let along = across.map(|x: f64| x / length);
        let down = model::space::cross(a, along).map(|x| -9.81 * x);
        let text = format!(
            r#"
scene = {{ name = "pendulum", space = "spatial", gravity = {down:?} }}
body = [{{ name = "bob", mass = 2.0, inertia = [0.3, 0.3, 0.3], position = {at:?} }}]
joint = [{{ name = "hinge", type = "revolute", bodies = ["ground", "bob"], at = [0, 0, 0], axis = {axis:?} }}]
"#,
            at = along.map(|x| 0.5 * x),
        );
        // The reference is (J + m·l²)·θ̈ = −m·g·l·cos θ from θ = 0, by the same equation in one
        // coordinate.
        let (mut theta, mut rate) = (0.0_f64, 0.0_f64);
        let n = 40_000;
        let h = 2.0 / f64::from(n);
        let accel = |theta: f64| -2.0 * 9.81 * 0.5 / (0.3 + 0.5) * theta.cos();
        for _ in 0..n {
            let k1 = (rate, accel(theta));
            let k2 = (rate + 0.5 * h * k1.1, accel(theta + 0.5 * h * k1.0));
            let k3 = (rate + 0.5 * h * k2.1, accel(theta + 0.5 * h * k2.0));
            let k4 = (rate + h * k3.1, accel(theta + h * k3.0));
            theta += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
            rate += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
        }
        for method in [Method::Dop853, Method::Radau5] {
            let end = run(&text, &options(2.0, method, 1e-10));
            let along_start: f64 = (0..3).map(|k| end.q[k] * along[k]).sum();
            close(along_start, 0.5 * theta.cos(), 1e-7, "the bob");
            assert!(
                end.summary.energy_balance < 1e-7,
                "{}",
                end.summary.energy_balance
            );
        }
    }
}

/// Two parallel shafts: the second one is coupled to the first, and a torque acts on the first.
fn train(ratio: f64) -> String {
    format!(
        r#"
scene = {{ name = "train", space = "spatial" }}
body = [
    {{ name = "fast", mass = 1.0, inertia = [0.1, 0.1, 0.2], position = [0, 0, 0] }},
    {{ name = "slow", mass = 1.0, inertia = [[0.5, 0.02, 0.01], [0.02, 0.4, 0.0], [0.01, 0.0, 0.7]], position = [1, 0, 0] }},
]
joint = [
    {{ name = "A", type = "revolute", bodies = ["ground", "fast"], at = [0, 0, 0], axis = [0, 0, 1] }},
    {{ name = "mesh", type = "coupling", measures = ["A.angle", "B.angle"], ratio = {ratio:?} }},
    {{ name = "B", type = "revolute", bodies = ["ground", "slow"], at = [1, 0, 0], axis = [0, 0, 1] }},
]
force = [{{ name = "motor", type = "torque", body = "fast", torque = [0, 0, 3.0] }}]
"#
    )
}

#[test]
fn a_train_keeps_its_ratio_over_two_hundred_turns() {
    for method in [Method::Dop853, Method::Radau5] {
        let (ratio, t) = (-0.4142135623730951, 14.0);
        let end = run(&train(ratio), &options(t, method, 1e-10));
        let angle = 0.5 * 3.0 / (0.2 + 0.7 * ratio * ratio) * t * t;
        assert!(angle > 100.0 * TAU, "{angle}");
        close(end.q[14], angle, 1e-6 * angle, "the fast shaft");
        close(end.q[15], ratio * angle, 1e-6 * angle, "the slow shaft");
        assert!(end.summary.max_position_residual < 1e-9);
    }
    let found = study(&train(0.5))
        .analyse(0.0, None)
        .expect("analysed")
        .analysis;
    assert_eq!(
        (
            found.decision.rank,
            found.mobility(),
            found.decision.redundancy
        ),
        (11, 1, 0)
    );
    let names: Vec<&str> = found.reactions.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["A", "mesh", "B"]);
}

#[test]
fn a_cylindrical_joint_with_a_coupling_is_a_screw() {
    let pitch = 0.02;
    let coupled = nut(pitch, 40.0).replace(
        &format!(r#"type = "screw", bodies = ["ground", "nut"], at = [1.0, 2.0, 0.0], axis = [0, 0, 1], pitch = {pitch} }}"#),
        &format!(
            r#"type = "cylindrical", bodies = ["ground", "nut"], at = [1.0, 2.0, 0.0], axis = [0, 0, 1] }},
    {{ name = "lead", type = "coupling", measures = ["thread.angle", "thread.displacement"], ratio = {:?} }}"#,
            pitch / TAU
        ),
    );
    assert!(coupled.contains("coupling"));
    let [a, b] =
        [nut(pitch, 40.0), coupled].map(|text| run(&text, &options(8.0, Method::Dop853, 1e-11)));
    for k in 0..7 {
        close(a.q[k], b.q[k], 1e-9, "coordinate");
    }
}

#[test]
fn a_cam_follows_its_polynomial() {
    // With y = 0.03·θ − 0.002·θ² + 0.0001·θ³ and without gravity, ½·(J + m·h'²)·θ̇² is constant.
    let text = r#"
scene = { name = "cam", space = "spatial" }
body = [
    { name = "cam", mass = 1.0, inertia = [0.1, 0.1, 0.2], position = [0, 0, 0], angular_velocity = [0, 0, 5.0] },
    { name = "rod", mass = 30.0, inertia = [1, 1, 1], position = [0, 1, 0], velocity = [0, 0.15, 0] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "cam"], at = [0, 0, 0], axis = [0, 0, 1] },
    { name = "B", type = "translational", bodies = ["ground", "rod"], at = [0, 1, 0], axis = [0, 1, 0] },
    { name = "cam and rod", type = "coupling", measures = ["A.angle", "B.displacement"], ratio = 0.03, coefficients = [-0.002, 0.0001] },
]
"#;
    let h = |x: f64| 0.03 * x - 0.002 * x * x + 0.0001 * x * x * x;
    let slope = |x: f64| 0.03 - 0.004 * x + 0.0003 * x * x;
    for method in [Method::Dop853, Method::Radau5] {
        let end = run(text, &options(6.0, method, 1e-11));
        let angle = end.q[14];
        assert!(angle > 4.0 * TAU, "{angle}");
        close(end.q[8], 1.0 + h(angle), 1e-9, "the rod");
        let energy = |x: f64, rate: f64| (0.2 + 30.0 * slope(x) * slope(x)) * rate * rate;
        close(energy(angle, end.v[5]), energy(0.0, 5.0), 1e-8, "energy");
        // The time is t = ∫ √((J + m·h'²)/2E) dθ, by Simpson's rule.
        let n = 20_000;
        let dt = |x: f64| ((0.2 + 30.0 * slope(x) * slope(x)) / energy(0.0, 5.0)).sqrt();
        let x = |k: usize| angle * k as f64 / n as f64;
        let sum: f64 = (0..=n)
            .map(|k| {
                dt(x(k)) * [1.0, 2.0, 4.0][usize::from(k != 0 && k != n) + usize::from(k % 2 == 1)]
            })
            .sum();
        close(sum * angle / (3.0 * n as f64), 6.0, 1e-8, "time");
    }
}
