//! A steered wheel is rotated through ±90°. At this angle, the forward speed of the frame is zero
//! for any speed of the wheel. If two wheels have equal steering angles, no motion is possible.

use dynamics::MotionOptions;

use crate::stress::case::{Case, Expected, Family};
use crate::stress::motion::{Row, case, combinations, steps, worst};

/// A tricycle with two redundant rear edges.
pub(super) const FAMILY: Family = Family {
    name: "steering",
    about: "a tricycle whose front wheel turns through 90° and back, and one with two front wheels that stay parallel, which has to be refused",
    cases,
};

/// Mass (kg), moment of inertia about the midpoint of the rear axle, which is the centre of mass
/// (kg·m²), and wheelbase (m).
const MASS: f64 = 20.0;
const INERTIA: f64 = 1.7;
const BASE: f64 = 0.6;

/// Amplitude of the steering angle (rad): δ = 2·sin(t), which is 90° at 0.904 s and again at 2.238
/// s.
const AMPLITUDE: f64 = 2.0;
const T_END: f64 = 5.0;

/// Tolerance of the runs.
const RTOL: f64 = 1e-10;

/// The source of the exact solution.
const SOURCE: &str = "energy: the front edge, the fork without inertia and the rear edges do no work; heading and place by quadrature. Ten \
                      tolerances a step, and 1e4 in all where steps are few";

fn cases() -> Vec<Case> {
    let base = MotionOptions {
        rtol: RTOL,
        atol: RTOL,
        ..MotionOptions::to(T_END)
    };
    let locked = Expected::refusal(&["the dropped row", "violated", "contradicts the kept rows"]);
    let mut cases = Vec::new();
    for options in combinations(&base) {
        let name = "through 90°";
        let tolerances = (10.0 * steps(options.method, T_END, RTOL)).max(1e4);
        let right = Expected::answer(tolerances * RTOL, SOURCE);
        cases.push(case(name, tricycle(1), options.clone(), right, |row, _| {
            off(row, &closed_form())
        }));
        let name = "parallel front wheels";
        let right = locked.clone();
        cases.push(case(name, tricycle(2), options, right, |_, _| f64::NAN));
    }
    cases
}

/// Returns a tricycle with one front wheel in the middle, or with two front wheels at the sides.
/// Each front wheel is on a massless fork.
fn tricycle(wheels: usize) -> String {
    let sides: &[f64] = if wheels == 1 { &[0.0] } else { &[-0.2, 0.2] };
    let mut text = format!(
        r#"
scene = {{ name = "tricycle", space = "plane" }}
[[body]]
name = "frame"
mass = {MASS}
inertia = {INERTIA}
velocity = [1.0, 0.0]
"#
    );
    for (k, y) in sides.iter().enumerate() {
        text += &format!(
            r#"
[[body]]
name = "fork-{k}"
mass = 0.0
inertia = 0.0
position = [{BASE}, {y}]
velocity = [1.0, 0.0]
angular_velocity = {AMPLITUDE}
[[joint]]
name = "head-{k}"
type = "revolute"
bodies = ["frame", "fork-{k}"]
at = [{BASE}, {y}]
[[joint]]
name = "front-{k}"
type = "knife-edge"
body = "fork-{k}"
at = [{BASE}, {y}]
normal = [0.0, 1.0]
[[drive]]
name = "steering-{k}"
joint = "head-{k}"
type = "angle"
motion = {{ type = "harmonic", amplitude = {AMPLITUDE}, omega = 1.0, phase = 0.0, offset = 0.0 }}
"#
        );
    }
    for (name, y) in [("left", 0.2), ("right", -0.2)] {
        text += &format!(
            r#"
[[joint]]
name = "rear-{name}"
type = "knife-edge"
body = "frame"
at = [0.0, {y}]
normal = [0.0, 1.0]
"#
        );
    }
    text
}

/// Returns the speed of the midpoint of the rear axle along the frame, and the rate of rotation, at
/// a steering angle. With the speed u of the front wheel `v = u·cos δ`, `ω = u·sin δ/L`, and
/// `u²·(m·cos²δ + J·sin²δ/L²)` is constant, with its value at δ = 0, v = 1 m/s.
fn speeds(delta: f64) -> [f64; 2] {
    let (sin, cos) = delta.sin_cos();
    let u = (MASS / (MASS * cos * cos + INERTIA * (sin / BASE).powi(2))).sqrt();
    [u * cos, u * sin / BASE]
}

/// Returns position, heading, forward speed and rate of rotation at the end. The integrals are
/// computed by Gauss–Legendre quadrature with four nodes on intervals of 1 ms.
fn closed_form() -> [f64; 5] {
    const NODES: [f64; 2] = [0.339_981_043_584_856_3, 0.861_136_311_594_052_6];
    const WEIGHTS: [f64; 2] = [0.652_145_154_862_546_1, 0.347_854_845_137_453_9];
    let integral = |f: &dyn Fn(f64) -> f64, from: f64, to: f64| -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let pair = |(x, w): (&f64, &f64)| w * (f(middle - half * x) + f(middle + half * x));
        half * NODES.iter().zip(&WEIGHTS).map(pair).sum::<f64>()
    };
    let at = |t: f64| speeds(AMPLITUDE * t.sin());
    let (mut place, mut heading) = ([0.0; 2], 0.0);
    const PIECES: u32 = 5000;
    for k in 0..PIECES {
        let time = |k: u32| T_END * f64::from(k) / f64::from(PIECES);
        let (from, to) = (time(k), time(k + 1));
        let along = |t: f64| heading + integral(&|t| at(t)[1], from, t);
        place[0] += integral(&|t| at(t)[0] * along(t).cos(), from, to);
        place[1] += integral(&|t| at(t)[0] * along(t).sin(), from, to);
        heading += integral(&|t| at(t)[1], from, to);
    }
    let [v, omega] = at(T_END);
    [place[0], place[1], heading, v, omega]
}

/// Returns the deviation of the frame from the exact solution.
fn off(row: &Row, right: &[f64; 5]) -> f64 {
    let [x, y, heading, v, omega] = right;
    let (sin, cos) = heading.sin_cos();
    let place = [row.q[0] - x, row.q[1] - y, row.q[2] - heading];
    let speed = [row.v[0] - v * cos, row.v[1] - v * sin, row.v[2] - omega];
    worst(place.into_iter().chain(speed))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;
    use crate::stress::motion::outcome;

    /// At 90° the frame rotates about the midpoint of the rear axle, and its rotation has all the
    /// energy.
    #[test]
    fn at_a_right_angle_the_frame_turns_on_the_spot() {
        let [v, omega] = speeds(std::f64::consts::FRAC_PI_2);
        assert!(v.abs() < 1e-15);
        assert!((0.5 * INERTIA * omega * omega - 0.5 * MASS).abs() < 1e-12);
    }

    #[test]
    fn another_inertia_is_silently_wrong() {
        let heavier = tricycle(1).replace("inertia = 1.7", "inertia = 1.71");
        let options = MotionOptions::to(T_END);
        let found = outcome(&heavier, &options, |row, _| off(row, &closed_form()));
        let right = Expected::answer(1e-6, "energy");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }

    #[test]
    fn wheels_turn_through_a_right_angle_and_parallel_ones_lock() {
        for wheels in [1, 2] {
            let found = outcome(&tricycle(wheels), &MotionOptions::to(T_END), |row, _| {
                off(row, &closed_form())
            });
            let right = match wheels {
                1 => Expected::answer(1e-5, "energy"),
                _ => Expected::refusal(&["the dropped row"]),
            };
            assert!(judge(&right, &found).passes(), "{found:?}");
        }
    }
}
