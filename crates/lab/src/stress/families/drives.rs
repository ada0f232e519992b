//! Drives and torques that jump. A jump of the position is rejected, a jump of the rate causes an
//! impulse, and at a jump of the force a step ends. Two drives that are first consistent and later
//! contradict each other are also tested.

use dynamics::{MotionOptions, Summary};

use crate::stress::case::{Case, Expected, Family};
use crate::stress::motion::{Row, case, combinations, steps, worst};

/// A wheel, and a parallelogram with two motors.
pub(super) const FAMILY: Family = Family {
    name: "drives",
    about: "jumps of a drive, of its rate, of a torque and of the rate of a torque; two motors of a parallelogram that disagree from 1 s on",
    cases,
};

/// Moment of inertia of the wheel about its pin (kg·m²).
const INERTIA: f64 = 0.3;

/// Tolerance of the runs.
const RTOL: f64 = 1e-9;

const T_END: f64 = 2.0;

fn cases() -> Vec<Case> {
    let base = MotionOptions {
        rtol: RTOL,
        atol: RTOL,
        ..MotionOptions::to(T_END)
    };
    let mut cases = Vec::new();
    for options in combinations(&base) {
        let jump = "{ type = \"linear-table\", times = [0.0, 1.0, 1.0, 3.0], values = [0.0, 0.5, 0.75, 1.0] }";
        let refused = Expected::refusal(&["at t = 1", "motor", "jumps by 0.25"]);
        let driven = driven(jump, 0.5);
        cases.push(case(
            "position jumps",
            driven,
            options.clone(),
            refused,
            |_, _| f64::NAN,
        ));

        let kink = "{ type = \"linear-table\", times = [0.0, 1.0, 3.0], values = [0.0, 2.0, 0.0] }";
        let right = Expected::answer(
            1e-9,
            "straight lines; the energy of the impulse, J/2·(1 − 4) J, is answer",
        );
        let driven = self::driven(kink, 2.0);
        cases.push(case(
            "rate jumps",
            driven,
            options.clone(),
            right,
            after_the_kink,
        ));

        let right = Expected::answer(
            1e-9,
            "parabolas, which every method follows exactly where a step ends at the jump; a step over it would be off by its square",
        );
        cases.push(case(
            "torque jumps",
            pushed(),
            options.clone(),
            right,
            after_the_push,
        ));

        let tolerances = 10.0 * steps(options.method, T_END, RTOL);
        let right = Expected::answer(
            tolerances * RTOL,
            "cubics, exact for order three and more where a step ends at the kink; ten tolerances a step",
        );
        cases.push(case(
            "torque kinks",
            swung(),
            options.clone(),
            right,
            after_the_swing,
        ));

        for exponent in [0, -3, -6, -9] {
            let by = 10.0_f64.powi(exponent);
            let name = format!("motors disagree by {by:.0e} rad/s²");
            let refused = Expected::refusal(&["drives", "contradict each other"]);
            cases.push(case(
                name,
                disagreeing(by),
                options.clone(),
                refused,
                |_, _| f64::NAN,
            ));
        }
    }
    cases
}

/// Returns a driven wheel on a pin through its centre of mass.
fn driven(motion: &str, omega: f64) -> String {
    format!(
        r#"
scene = {{ name = "wheel", space = "plane" }}
body = [{{ name = "wheel", mass = 2.0, inertia = {INERTIA}, angular_velocity = {omega:?} }}]
joint = [{{ name = "pin", type = "revolute", bodies = ["ground", "wheel"], at = [0.0, 0.0] }}]
drive = [{{ name = "motor", joint = "pin", type = "angle", motion = {motion} }}]
"#
    )
}

/// The angle is 2·t up to t = 1, and 3 − t for t > 1.
fn after_the_kink(row: &Row, summary: &Summary) -> f64 {
    let lost = format!("{:.6e} J", 0.5 * INERTIA * (1.0 - 4.0));
    let is_reported = summary.events.iter().any(|e| e.text.contains(&lost));
    if !is_reported {
        return f64::INFINITY;
    }
    worst([row.q[2] - (3.0 - row.t), row.v[2] + 1.0])
}

/// Returns the same wheel without a drive. A torque of 1 N·m acts on the wheel and changes to −2
/// N·m at the time `JUMP`.
fn pushed() -> String {
    format!(
        r#"
scene = {{ name = "wheel", space = "plane" }}
body = [{{ name = "wheel", mass = 2.0, inertia = {INERTIA} }}]
joint = [{{ name = "pin", type = "revolute", bodies = ["ground", "wheel"], at = [0.0, 0.0] }}]
[[force]]
name = "push"
type = "torque"
body = "wheel"
torque = {{ type = "linear-table", times = [0.0, {JUMP}, {JUMP}, 3.0], values = [1.0, 1.0, -2.0, -2.0] }}
"#
    )
}

/// Time of the jump of the torque (s).
const JUMP: f64 = 0.7371;

fn after_the_push(row: &Row, _: &Summary) -> f64 {
    let (first, second) = (1.0 / INERTIA, -2.0 / INERTIA);
    let dt = row.t - JUMP;
    let (angle, omega) = (0.5 * first * JUMP * JUMP, first * JUMP);
    let right = [
        angle + omega * dt + 0.5 * second * dt * dt,
        omega + second * dt,
    ];
    worst([row.q[2] - right[0], row.v[2] - right[1]])
}

/// Returns the same wheel with a torque that rises linearly to 1 N·m at the time `JUMP` and falls
/// linearly to zero at 3 s.
fn swung() -> String {
    let jump = format!("[0.0, {JUMP}, {JUMP}, 3.0], values = [1.0, 1.0, -2.0, -2.0]");
    let kink = format!("[0.0, {JUMP}, 3.0], values = [0.0, 1.0, 0.0]");
    pushed().replace(&jump, &kink)
}

fn after_the_swing(row: &Row, _: &Summary) -> f64 {
    // The torque is t/JUMP, then 1 − dt/(3 − JUMP).
    let dt = row.t - JUMP;
    let (angle, omega) = (JUMP * JUMP / 6.0, JUMP / 2.0);
    let fall = 1.0 / (3.0 - JUMP);
    let right = [
        angle + omega * dt + dt * dt * (0.5 - fall * dt / 6.0),
        omega + dt * (1.0 - 0.5 * fall * dt),
    ];
    worst([row.q[2] - right[0] / INERTIA, row.v[2] - right[1] / INERTIA])
}

/// Returns two parallel cranks, each with a motor of 0.4 rad/s. The rate of the second motor grows
/// from t = 1 s on.
fn disagreeing(by: f64) -> String {
    // The difference of the motors is half of `by` times (t − 1)²₊, which a spline would only
    // approximate. Instead the law consists of short linear intervals. The rates jump between two
    // intervals, so the motors differ by 0.05·by rad/s from the first interval on.
    let pieces: Vec<f64> = (0..=10).map(|k| 1.0 + 0.1 * f64::from(k)).collect();
    let values: Vec<f64> = pieces
        .iter()
        .map(|t| 0.4 * t + 0.5 * by * (t - 1.0).powi(2))
        .collect();
    let list = |first: f64, x: &[f64]| {
        let all: Vec<String> = [first].iter().chain(x).map(|x| format!("{x:?}")).collect();
        format!("[{}]", all.join(", "))
    };
    let (times, values) = (list(0.0, &pieces), list(0.0, &values));
    let mut text = r#"scene = { name = "parallelogram", space = "plane" }
"#
    .to_owned();
    for (name, x) in [("one", 0.0), ("two", 1.0)] {
        text += &format!(
            r#"
[[body]]
name = "{name}"
mass = 1.0
inertia = 0.1
position = [{x:?}, 0.5]
angle = 1.5707963267948966
velocity = [-0.2, 0.0]
angular_velocity = 0.4
"#
        );
    }
    text += r#"
[[body]]
name = "coupler"
mass = 1.0
inertia = 0.1
position = [0.5, 1.0]
velocity = [-0.4, 0.0]
"#;
    for (name, x) in [("one", 0.0), ("two", 1.0)] {
        text += &format!(
            r#"
[[joint]]
name = "pivot-{name}"
type = "revolute"
bodies = ["ground", "{name}"]
at = [{x:?}, 0.0]
[[joint]]
name = "tip-{name}"
type = "revolute"
bodies = ["{name}", "coupler"]
at = [{x:?}, 1.0]
"#
        );
    }
    text + &format!(
        r#"
[[drive]]
name = "motor-one"
joint = "pivot-one"
type = "angle"
motion = {{ type = "constant-rate", rate = 0.4 }}
[[drive]]
name = "motor-two"
joint = "pivot-two"
type = "angle"
motion = {{ type = "linear-table", times = {times}, values = {values} }}
"#
    )
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;
    use crate::stress::motion::outcome;

    #[test]
    fn a_jump_at_another_time_is_silently_wrong() {
        let later = pushed().replace("0.7371", "0.7372");
        let found = outcome(&later, &MotionOptions::to(T_END), after_the_push);
        let right = Expected::answer(1e-9, "parabolas");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }

    #[test]
    fn every_jump_is_right_by_the_method_of_the_house() {
        for case in cases().iter().filter(|c| c.method == "auto") {
            let found = (case.run)();
            assert!(
                judge(&case.expected, &found).passes(),
                "{}: {found:?}",
                case.name
            );
        }
    }
}
