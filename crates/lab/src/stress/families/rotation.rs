//! Fast rotation of a body on a pin, with up to a million revolutions per second, for many
//! revolutions.

use std::f64::consts::TAU;

use dynamics::{Method, MotionOptions};

use crate::stress::case::{Case, Expected, Family};
use crate::stress::motion::{Row, case, combinations, steps, worst};

/// A rotor whose centre of mass is not at its pin.
pub(super) const FAMILY: Family = Family {
    name: "rotation",
    about: "a rotor on a pin away from its centre of mass, at up to 1e6 rad/s for 1000 turns: every turn has to be resolved",
    cases,
};

/// Distance of the centre of mass from the pin (m).
const ARM: f64 = 0.1;

/// Tolerance of the runs.
const RTOL: f64 = 1e-11;

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (omega, turns) in [
        (1.0, 1.0),
        (1e3, 100.0),
        (1e6, 1.0),
        (1e6, 100.0),
        (1e6, 1000.0),
        (1e9, 100.0),
    ] {
        let t_end = TAU * turns / omega;
        let base = MotionOptions {
            rtol: RTOL,
            atol: RTOL * ARM,
            output_step: t_end,
            ..MotionOptions::to(t_end)
        };
        // An error of the speed in step k of N changes the phase in all later steps. The sum is
        // N²/2 tolerances, with some tens of steps per revolution.
        let drift = 0.05 * (50.0 * turns).powi(2);
        for options in combinations(&base) {
            if options.method != Method::Auto && turns > 100.0 {
                continue;
            }
            let local = 100.0 * steps(options.method, TAU * turns, RTOL);
            let right = limit(RTOL * local.max(drift));
            let name = format!("{omega:e} rad/s, {turns} turns");
            let made = case(name, rotor(omega), options, right, move |row, _| {
                off(row, omega, t_end)
            });
            cases.push(made.at("rad/s", omega));
        }
    }
    cases
}

/// Returns the expectation for methods of low order. For this tolerance, these methods need more
/// steps than allowed, or the steps are too short for the accuracy of such large velocities.
fn limit(bound: f64) -> Expected {
    Expected::AnswerOrRefusal {
        bound,
        source: "uniform rotation, in radians of the phase and in arms; local errors of the tolerance in some 50 steps a turn, added up \
                 in speed and phase",
        parts: vec!["step".into(), "at t = ".into()],
    }
}

fn rotor(omega: f64) -> String {
    let speed = ARM * omega;
    format!(
        r#"
scene = {{ name = "rotor", space = "plane" }}
body = [{{ name = "rotor", mass = 2.0, inertia = 0.01, position = [{ARM}, 0.0], velocity = [0.0, {speed:?}], angular_velocity = {omega:?} }}]
joint = [{{ name = "pin", type = "revolute", bodies = ["ground", "rotor"], at = [0.0, 0.0] }}]
"#
    )
}

/// Returns the deviation of the rotor from uniform rotation: the error of the phase, and the
/// relative errors of the velocities.
fn off(row: &Row, omega: f64, t: f64) -> f64 {
    let phase = omega * t;
    let (sin, cos) = phase.sin_cos();
    let place = [row.q[0] / ARM - cos, row.q[1] / ARM - sin, row.q[2] - phase];
    let speed = ARM * omega;
    let rate = [
        row.v[0] / speed + sin,
        row.v[1] / speed - cos,
        row.v[2] / omega - 1.0,
    ];
    worst(place.into_iter().chain(rate))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;
    use crate::stress::motion::outcome;

    #[test]
    fn a_turn_too_many_is_silently_wrong() {
        let options = MotionOptions::to(TAU);
        let found = outcome(&rotor(1.0), &options, |row, _| {
            off(row, 1.0, TAU) + (row.q[2] - 2.0 * TAU).abs()
        });
        assert_eq!(judge(&limit(1e-3), &found), Judgement::SilentlyWrong);
    }
}
