//! Springs and dampers up to the limit of integration: a rotor behind a spring and a damper on a
//! moving base, and a block on a bushing without damping.

use dynamics::{Method, MotionOptions};

use crate::stress::case::{Case, Expected, Family};
use crate::stress::motion::{Row, case, combinations, steps, worst};

/// A linear oscillator with a prescribed motion of its base.
pub(super) const FAMILY: Family = Family {
    name: "stiff",
    about: "a rotor on a torsion spring up to 1e12 N·m/rad and a damper up to 1e9 N·m·s/rad, its foot swinging; undamped ones released off \
            equilibrium, and a block moving off on an undamped bushing up to 1e12 N/m, are resolved or refused",
    cases,
};

/// Moment of inertia of the rotor (kg·m²), amplitude of the base (rad), which oscillates at 1
/// rad/s, and duration of the run (s).
const INERTIA: f64 = 2.0;
const SWING: f64 = 0.3;
const T_END: f64 = 2.0;

/// Allowed number of steps; methods that need more steps must report this. The second value is for
/// the automatic choice of a method: an explicit method may need about this number of steps.
const MAX_STEPS: u64 = 5_000;
const MAX_STEPS_OF_CHOICE: u64 = 40_000;

/// Tolerance of the runs.
const RTOL: f64 = 1e-8;

/// Smallest error bound at the end, as a multiple of the tolerance. A few steps may be less
/// accurate than the other steps.
const LEAST: f64 = 1e3;

fn cases() -> Vec<Case> {
    let base = MotionOptions {
        rtol: RTOL,
        atol: RTOL,
        max_steps: MAX_STEPS,
        ..MotionOptions::to(T_END)
    };
    let mut cases = Vec::new();
    for mut options in combinations(&base) {
        if options.method == Method::Auto {
            options.max_steps = MAX_STEPS_OF_CHOICE;
        }
        for exponent in (2..=12).step_by(2) {
            let stiffness = 10.0_f64.powi(exponent);
            let critical = 2.0 * (stiffness * INERTIA).sqrt();
            for (name, damping) in [("damped", 0.7 * critical), ("undamped", 0.0)] {
                let oscillator = Oscillator {
                    stiffness,
                    damping,
                    // With a damper, the rotor starts with the motion of the base. Without a
                    // damper, it starts at rest, displaced from its equilibrium.
                    start: if damping > 0.0 {
                        [0.0, SWING]
                    } else {
                        [0.01, 0.0]
                    },
                };
                let name = format!("{name} spring {stiffness:e}");
                cases.push(oscillator.case(name, &options).at("stiffness", stiffness));
            }
        }
        for exponent in (2..=12).step_by(2) {
            let block = Block {
                stiffness: 10.0_f64.powi(exponent),
            };
            cases.push(block.case(&options));
        }
        for exponent in (0..=9).step_by(3) {
            let damping = 10.0_f64.powi(exponent);
            let oscillator = Oscillator {
                stiffness: 1.0,
                damping,
                start: [0.0, SWING],
            };
            let name = format!("damper {damping:e}");
            cases.push(oscillator.case(name, &options));
        }
    }
    cases
}

/// The equation is `J·φ̈ = −k·(φ − s) − c·(φ̇ − ṡ)` with `s = A·sin t`.
#[derive(Clone, Copy)]
struct Oscillator {
    stiffness: f64,
    damping: f64,
    /// The values φ and φ̇ at t = 0.
    start: [f64; 2],
}

impl Oscillator {
    fn case(self, name: String, options: &MotionOptions) -> Case {
        let fastest = (self.stiffness / INERTIA).sqrt();
        let phase = if self.damping > 0.0 {
            T_END
        } else {
            fastest * T_END
        };
        let tolerances = LEAST.max(10.0 * steps(options.method, phase, RTOL));
        // The angle of a rotor behind a stiff spring is accurate to 1e-16, so the force is accurate
        // to k·1e-16. This error changes the velocity by c/k or 1/ω times the error.
        let bound = tolerances * RTOL;
        let right = Expected::AnswerOrRefusal {
            bound,
            source: "closed form of the linear oscillator; angle in units of the swing, rate in units of its own largest; local errors of ten \
                     tolerances in each step",
            parts: vec!["step".into(), "at t = ".into()],
        };
        // The implicit methods, which are suitable for stiff scenes, must succeed.
        let is_implicit = matches!(options.method, Method::Auto | Method::Radau5);
        let right = if is_implicit && self.damping > 0.0 {
            match right {
                Expected::AnswerOrRefusal { bound, source, .. } => Expected::answer(bound, source),
                other => other,
            }
        } else {
            right
        };
        case(name, self.scene(), options.clone(), right, move |row, _| {
            self.off(row)
        })
    }

    fn scene(self) -> String {
        let Self {
            stiffness,
            damping,
            start: [angle, omega],
        } = self;
        format!(
            r#"
scene = {{ name = "rotor", space = "plane" }}
[[body]]
name = "foot"
mass = 1.0
inertia = 1.0
angular_velocity = {SWING}
[[body]]
name = "rotor"
mass = 1.0
inertia = {INERTIA:?}
angle = {angle:?}
angular_velocity = {omega:?}
[[joint]]
name = "bearing"
type = "revolute"
bodies = ["ground", "foot"]
at = [0.0, 0.0]
[[joint]]
name = "pin"
type = "revolute"
bodies = ["ground", "rotor"]
at = [0.0, 0.0]
[[drive]]
name = "motor"
joint = "bearing"
type = "angle"
motion = {{ type = "harmonic", amplitude = {SWING}, omega = 1.0, phase = 0.0, offset = 0.0 }}
[[force]]
name = "spring"
type = "torsion-spring-damper"
bodies = ["foot", "rotor"]
stiffness = {stiffness:?}
damping = {damping:?}
free_angle = 0.0
"#
        )
    }

    /// Returns φ and φ̇ at time t.
    fn at(self, t: f64) -> [f64; 2] {
        let Self {
            stiffness: k,
            damping: c,
            start,
        } = self;
        // The solution is φ = a·sin t + b·cos t + free motion, with (k − J)·a − c·b = k·A and c·a +
        // (k − J)·b = c·A.
        let d = (k - INERTIA).powi(2) + c * c;
        let a = SWING * ((k - INERTIA) * k + c * c) / d;
        let b = -SWING * c * INERTIA / d;
        let (sin, cos) = t.sin_cos();
        let forced = [a * sin + b * cos, a * cos - b * sin];
        let [x0, v0] = [start[0] - b, start[1] - a];
        let (decay, square) = (0.5 * c / INERTIA, k / INERTIA);
        let free = if decay * decay < square {
            let omega = (square - decay * decay).sqrt();
            let (sin, cos) = (omega * t).sin_cos();
            let size = (-decay * t).exp();
            let slope = (v0 + decay * x0) / omega;
            let x = size * (x0 * cos + slope * sin);
            [x, size * omega * (slope * cos - x0 * sin) - decay * x]
        } else {
            // The second root is computed from the product k/J of the roots, to avoid cancellation.
            let fast = -(decay + (decay * decay - square).sqrt());
            let slow = square / fast;
            let of_slow = (v0 - fast * x0) / (slow - fast);
            let of_fast = x0 - of_slow;
            let (slow_size, fast_size) = (of_slow * (slow * t).exp(), of_fast * (fast * t).exp());
            [slow_size + fast_size, slow * slow_size + fast * fast_size]
        };
        [forced[0] + free[0], forced[1] + free[1]]
    }

    /// Returns the deviation of a row from the exact solution.
    fn off(self, row: &Row) -> f64 {
        let [angle, omega] = self.at(row.t);
        let rate = (self.start[0] * (self.stiffness / INERTIA).sqrt()).max(SWING);
        worst([(row.q[5] - angle) / SWING, (row.v[5] - omega) / rate])
    }
}

/// The equations `m·ẍ = −k·x`, `m·ÿ = −k·y/4` of a block on a bushing. The bushing is undeformed at
/// the initial state, at which the block has a velocity.
#[derive(Clone, Copy)]
struct Block {
    stiffness: f64,
}

impl Block {
    /// Mass (kg) and initial velocity (m/s).
    const MASS: f64 = 3.0;
    const VELOCITY: [f64; 2] = [0.3, -0.2];

    fn case(self, options: &MotionOptions) -> Case {
        let [fastest, _] = self.frequencies();
        let tolerances = LEAST.max(10.0 * steps(options.method, fastest * T_END, RTOL));
        let right = Expected::AnswerOrRefusal {
            bound: tolerances * RTOL,
            source: "two harmonic oscillators; places and velocities in units of the largest; local errors of ten tolerances in \
                     each step, of which there are as many as the phase asks for",
            parts: vec!["step".into(), "at t = ".into()],
        };
        let name = format!("undamped bushing {:e}", self.stiffness);
        let made = case(name, self.scene(), options.clone(), right, move |row, _| {
            self.off(row)
        });
        made.at("stiffness", self.stiffness)
    }

    fn frequencies(self) -> [f64; 2] {
        [1.0, 0.25].map(|share| (share * self.stiffness / Self::MASS).sqrt())
    }

    fn scene(self) -> String {
        let (k, [x, y]) = (self.stiffness, Self::VELOCITY);
        format!(
            r#"
scene = {{ name = "block", space = "plane" }}
[[body]]
name = "block"
mass = {:?}
inertia = 0.5
velocity = [{x:?}, {y:?}]
[[force]]
name = "mount"
type = "bushing"
bodies = ["ground", "block"]
at = [0.0, 0.0]
stiffness = [{k:?}, {:?}, {k:?}]
damping = [0.0, 0.0, 0.0]
"#,
            Self::MASS,
            0.25 * k
        )
    }

    fn off(self, row: &Row) -> f64 {
        let frequencies = self.frequencies();
        let parts = (0..2).flat_map(|i| {
            let (omega, start) = (frequencies[i], Self::VELOCITY[i]);
            let (sin, cos) = (omega * row.t).sin_cos();
            [row.q[i] * omega / start - sin, row.v[i] / start - cos]
        });
        worst(parts)
    }
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;
    use crate::stress::motion::outcome;

    const DAMPED: Oscillator = Oscillator {
        stiffness: 1e4,
        damping: 300.0,
        start: [0.0, SWING],
    };

    /// The closed form satisfies its equation, in the oscillating and in the overdamped case.
    #[test]
    fn the_closed_form_solves_its_equation() {
        for oscillator in [
            DAMPED,
            Oscillator {
                damping: 3.0,
                stiffness: 1.0,
                start: [0.1, -0.2],
            },
        ] {
            const H: f64 = 1e-4;
            let t = 0.05;
            let [x, v] = oscillator.at(t);
            let (before, after) = (oscillator.at(t - H), oscillator.at(t + H));
            let (slope, a) = (
                (after[0] - before[0]) / (2.0 * H),
                (after[1] - before[1]) / (2.0 * H),
            );
            let (s, sd) = (SWING * t.sin(), SWING * t.cos());
            let force = -oscillator.stiffness * (x - s) - oscillator.damping * (v - sd);
            assert!((slope - v).abs() < 1e-4, "{slope} {v}");
            assert!(
                (INERTIA * a - force).abs() < 1e-3 * force.abs(),
                "{a} {force}"
            );
            let [x0, v0] = oscillator.at(0.0);
            assert!(
                (x0 - oscillator.start[0]).abs() < 1e-13
                    && (v0 - oscillator.start[1]).abs() < 1e-13
            );
        }
    }

    #[test]
    fn a_softer_spring_is_silently_wrong() {
        let released = Oscillator {
            start: [0.1, 0.0],
            ..DAMPED
        };
        let softer = Oscillator {
            stiffness: 0.99e4,
            ..released
        };
        let options = MotionOptions::to(0.05);
        let found = outcome(&softer.scene(), &options, |row, _| released.off(row));
        let right = Expected::answer(1e-6, "closed form");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }
}
