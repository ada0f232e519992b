//! Compares motions of point masses and thin rods with closed forms. Nothing acts on the rotations
//! of these bodies that have no inertia.

use std::ops::ControlFlow;

use dynamics::MotionOptions;
use dynamics::linearise::LineariseOptions;
use model::Registry;
use pfaff::{RunOptions, Study};

fn study(text: &str) -> Study {
    let registry = Registry::standard();
    let study = Study::read("test.toml", text, &registry, &RunOptions::default());
    study.unwrap_or_else(|e| panic!("{e}"))
}

/// Returns coordinates and the first reaction at the end of a motion.
fn run(text: &str, t_end: f64) -> (Vec<f64>, [f64; 3]) {
    let options = MotionOptions {
        rtol: 1e-11,
        atol: 1e-13,
        ..MotionOptions::to(t_end)
    };
    let mut last = (Vec::new(), [0.0; 3]);
    let summary = study(text).run(&options, |sample| {
        let reactions = sample.reactions()?;
        last = (sample.q.to_vec(), reactions.as_chosen()[0].force);
        Ok(ControlFlow::Continue(()))
    });
    summary.unwrap_or_else(|e| panic!("{}", e.error));
    last
}

fn close(found: f64, expected: f64) {
    let off = (found - expected).abs();
    assert!(
        off < 1e-8 * (1.0 + expected.abs()),
        "{found}, expected {expected}"
    );
}

/// A bob on a rope of 2 m moves on a circle, with the rope at 0.5 rad to the vertical. Closed form:
/// ω² = g/(L·cos θ); tension m·g/cos θ.
#[test]
fn a_point_mass_on_a_rope_moves_like_a_conical_pendulum() {
    let (g, length, theta, t): (f64, f64, f64, f64) = (9.81, 2.0, 0.5, 2.0);
    let omega = (g / (length * theta.cos())).sqrt();
    let radius = length * theta.sin();
    let (x, z, speed) = (radius, -length * theta.cos(), omega * radius);
    let (q, force) = run(
        &format!(
            r#"
scene = {{ name = "cone", space = "spatial", gravity = [0, 0, -{g}] }}
body = [{{ name = "bob", mass = 3, inertia = [0, 0, 0], position = [{x:?}, 0, {z:?}], velocity = [0, {speed:?}, 0] }}]
joint = [{{ name = "rope", type = "distance", bodies = ["ground", "bob"], at = [[0, 0, 0], [{x:?}, 0, {z:?}]] }}]
"#
        ),
        t,
    );
    close(q[0], radius * (omega * t).cos());
    close(q[1], radius * (omega * t).sin());
    close(q[2], z);
    // The bob does not rotate.
    assert_eq!(q[3..], [1.0, 0.0, 0.0, 0.0]);
    // The rope pulls the bob with m·g/cos θ, which is the load on the ground.
    close(force[2], -3.0 * g);
    close(force[0].hypot(force[1]), 3.0 * g * theta.tan());
}

/// A ball carries a thin rod of 2 m, which moves on a cone. Closed form: ω² = m·g·(L/2)/(J·cos θ)
/// with J = m·L²/3. The moment of inertia about the rod is zero.
#[test]
fn a_thin_rod_on_a_ball_moves_on_a_cone() {
    let (g, length, theta, t, m): (f64, f64, f64, f64, f64) = (9.81, 2.0, 0.5, 2.0, 3.0);
    let omega = (g * 1.5 / (length * theta.cos())).sqrt();
    let radius = 0.5 * length * theta.sin();
    let (x, z, speed, j) = (
        radius,
        -0.5 * length * theta.cos(),
        omega * radius,
        m * length * length / 12.0,
    );
    let (q, force) = run(
        &format!(
            r#"
scene = {{ name = "cone", space = "spatial", gravity = [0, 0, -{g}] }}
joint = [{{ name = "ball", type = "spherical", bodies = ["ground", "rod"], at = [0, 0, 0] }}]
[[body]]
name = "rod"
mass = {m}
inertia = [{j}, {j}, 0]
position = [{x:?}, 0, {z:?}]
orientation = {{ axis = [0, 1, 0], angle = -{theta} }}
velocity = [0, {speed:?}, 0]
"#
        ),
        t,
    );
    close(q[0], radius * (omega * t).cos());
    close(q[1], radius * (omega * t).sin());
    close(q[2], z);
    close(force[2], -m * g);
    close(force[0].hypot(force[1]), m * omega * omega * radius);
}

/// Two bobs of equal mass on ropes of 1 m in the plane. Closed form of the small oscillations:
/// ω² = (2 ± √2)·g/L.
#[test]
fn ropes_with_two_point_masses_have_the_frequencies_of_a_double_pendulum() {
    let rope = r#"
scene = { name = "rope", space = "plane", gravity = [0, -9.81] }
body = [
    { name = "a", mass = 2, inertia = 0, position = [0, -1] },
    { name = "b", mass = 2, inertia = 0, position = [0, -2] },
]
joint = [
    { name = "upper", type = "distance", bodies = ["ground", "a"], at = [[0, 0], [0, -1]] },
    { name = "lower", type = "distance", bodies = ["a", "b"], at = [[0, -1], [0, -2]] },
]
"#;
    let found = study(rope).linearise(0.0, &LineariseOptions::default());
    let modes = found
        .unwrap_or_else(|e| panic!("{e}"))
        .modes()
        .expect("converges");
    let mut frequencies: Vec<f64> = modes.iter().map(|mode| mode.value[1].abs()).collect();
    frequencies.sort_by(f64::total_cmp);
    let [slow, fast] = [-1.0, 1.0].map(|sign: f64| (9.81 * (2.0 + sign * 2.0_f64.sqrt())).sqrt());
    close(frequencies[frequencies.len() - 1], fast);
    close(frequencies[frequencies.len() - 2], slow);
}

/// A spring away from the centre of mass accelerates the rotation without limit if the body has no
/// inertia.
#[test]
fn a_force_away_from_the_centre_needs_an_inertia() {
    let scene = r#"
scene = { name = "bob", space = "plane" }
body = [{ name = "bob", mass = 2, inertia = 0, position = [0, -1] }]
joint = [{ name = "rope", type = "distance", bodies = ["ground", "bob"], at = [[0, 0], [0, -1]] }]
force = [{ name = "spring", type = "spring-damper", bodies = ["ground", "bob"], at = [[3, 0], [0.1, -1]], stiffness = 5, damping = 0 }]
"#;
    let study = study(scene);
    let refused = study.run(&MotionOptions::to(1.0), |_| Ok(ControlFlow::Continue(())));
    let error = refused.expect_err("refused").error.to_string();
    assert!(error.contains("`bob` can move its angle freely"), "{error}");
}
