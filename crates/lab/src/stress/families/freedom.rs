//! Mechanisms with at least as many drives as degrees of freedom. No equation is integrated, and
//! the reactions follow from inverse dynamics.

use std::ops::ControlFlow;

use dynamics::{MotionOptions, PreparedMechanism, simulate};

use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{combinations, moving, study, worst};

/// A crank under gravity with one motor, or with two motors.
pub(super) const FAMILY: Family = Family {
    name: "freedom",
    about: "a crank under gravity whose motor prescribes its angle, alone or with a second one that agrees: the torque by inverse dynamics",
    cases,
};

const MASS: f64 = 2.0;
const INERTIA: f64 = 0.3;
const ARM: f64 = 0.4;
const GRAVITY: f64 = 9.81;

/// The angle is `A·sin(ω·t)`.
const SWING: f64 = 1.2;
const RATE: f64 = 3.0;

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for options in combinations(&MotionOptions::to(2.0)) {
        for motors in [1, 2] {
            let right = Expected::answer(
                1e-12,
                "moments about the pin, (J + m·a²)·φ̈ + m·g·a·cos φ, the sum of both motors; some thousand roundings",
            );
            let name = format!("{motors} motors");
            cases.push(moving(name, options.clone(), right, move |options| {
                Ok(torque(&study(&crank(motors))?.prepared, options))
            }));
        }
    }
    cases
}

fn crank(motors: usize) -> String {
    let omega = SWING * RATE;
    let speed = ARM * omega;
    let mut text = format!(
        r#"
scene = {{ name = "crank", space = "plane", gravity = [0.0, -{GRAVITY}] }}
body = [{{ name = "crank", mass = {MASS:?}, inertia = {INERTIA}, position = [{ARM}, 0.0], velocity = [0.0, {speed:?}], angular_velocity = {omega:?} }}]
joint = [{{ name = "pin", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] }}]
"#
    );
    for k in 0..motors {
        text += &format!(
            r#"
[[drive]]
name = "motor-{k}"
joint = "pin"
type = "angle"
motion = {{ type = "harmonic", amplitude = {SWING}, omega = {RATE:?}, phase = 0.0, offset = 0.0 }}
"#
        );
    }
    text
}

/// Returns the errors of angles, rates and the sum of the torques of the motors, for all rows.
fn torque(prepared: &PreparedMechanism, options: &MotionOptions) -> Outcome {
    let mut errors = Vec::new();
    let result = simulate(prepared, options, |row| {
        let (sin, cos) = (RATE * row.t).sin_cos();
        let (angle, omega) = (SWING * sin, SWING * RATE * cos);
        let alpha = -RATE * RATE * angle;
        let right = (INERTIA + MASS * ARM * ARM) * alpha + MASS * GRAVITY * ARM * angle.cos();
        // The torques act on the crank, which is the second body of the motors.
        let multipliers = row.multipliers()?;
        let found: f64 = -multipliers.as_chosen()[2..].iter().sum::<f64>();
        errors.push((row.q[2] - angle) / SWING);
        errors.push((row.v[2] - omega) / (SWING * RATE));
        errors.push((found - right) / (MASS * GRAVITY * ARM));
        Ok(ControlFlow::Continue(()))
    });
    match result {
        Ok(summary) => Outcome::answer(worst(errors), format!("{} steps", summary.steps)),
        Err(failure) => Outcome::refused(&failure.error),
    }
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn the_torque_of_a_heavier_crank_is_silently_wrong() {
        let heavier = crank(1).replace("mass = 2.0", "mass = 2.0001");
        let study = study(&heavier).expect("a scene");
        let found = torque(&study.prepared, &MotionOptions::to(2.0));
        let right = Expected::answer(1e-12, "moments about the pin");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }

    #[test]
    fn torques_are_those_of_inverse_dynamics() {
        super::super::assert_passes(FAMILY);
    }
}
