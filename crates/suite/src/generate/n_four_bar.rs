//! The N-four-bar has N + 1 unit uprights on the ground and N unit rods between the tops of the
//! uprights. All loops are parallelograms. At the initial state, the uprights are vertical, and the
//! tops move at 1 m/s.
//!
//! All uprights have the same angle θ from the upward vertical. For rods of 1 kg and 1 m, the
//! equation of motion is `[(N + 1)/3 + N]·θ̈ = [(N + 1)/2 + N]·g·sin θ`. No row is redundant unless
//! the uprights are horizontal.
//!
//! Source: the benchmark A02 of the IFToMM/LIM library, for N = 2.

use std::f64::consts::FRAC_PI_2;
use std::io;

use super::answer::{Answer, FreeReaction};
use super::family::Family;
use super::text::{BodyText, SceneText};

/// Gravity (m/s²).
pub const GRAVITY: f64 = 9.81;

/// End time of the run (s).
const T_END: f64 = 5.0;

pub(super) struct NFourBar {
    n: usize,
}

impl NFourBar {
    pub(super) fn new(n: usize) -> Self {
        Self { n }
    }
}

/// Returns θ̈ of N loops at the angle θ from the upward vertical (rad/s²).
///
/// ```
/// use suite::generate::n_four_bar::{GRAVITY, acceleration};
/// // One loop, horizontal: two uprights of inertia 1/3 and a mass of 1 at their tops; the weights act at the arms 1/2, 1/2 and 1.
/// let horizontal = acceleration(1, std::f64::consts::FRAC_PI_2);
/// assert!((horizontal - 2.0 * GRAVITY / (5.0 / 3.0)).abs() < 1e-14);
/// ```
#[must_use]
pub fn acceleration(n: usize, theta: f64) -> f64 {
    let n = n as f64;
    ((n + 1.0) / 2.0 + n) * GRAVITY * theta.sin() / ((n + 1.0) / 3.0 + n)
}

impl Family for NFourBar {
    fn answer(&self) -> Answer {
        let joints = self.n + 1 + 2 * self.n;
        Answer::new(2 * self.n + 1, joints, 0, 2 * joints, 0)
    }

    fn free_reactions(&self) -> Vec<FreeReaction> {
        Vec::new()
    }

    fn words(&self) -> Vec<String> {
        vec![
            format!(
                "{} loops of unit rods of 1 kg in a row; the tops start with 1 m/s.",
                self.n
            ),
            "Every reaction is unique. At the angle a of the uprights from the upward vertical,"
                .to_owned(),
            "[(n + 1)/3 + n] a'' = [(n + 1)/2 + n] g sin(a), a(0) = 0, a'(0) = 1 rad/s.".to_owned(),
        ]
    }

    fn write(&self, name: &str, scene: &mut SceneText) -> io::Result<()> {
        let rod = BodyText {
            mass: 1.0,
            inertia: 1.0 / 12.0,
            ..BodyText::default()
        };
        scene.scene(name, [0.0, -GRAVITY])?;
        for k in 0..=self.n {
            let upright = BodyText {
                position: [k as f64, 0.5],
                angle: FRAC_PI_2,
                velocity: [0.5, 0.0],
                angular_velocity: -1.0,
                ..rod
            };
            scene.body(format_args!("upright-{k}"), &upright)?;
        }
        for k in 1..=self.n {
            let coupler = BodyText {
                position: [k as f64 - 0.5, 1.0],
                velocity: [1.0, 0.0],
                ..rod
            };
            scene.body(format_args!("rod-{k}"), &coupler)?;
        }
        for k in 0..=self.n {
            let upright = format_args!("upright-{k}");
            scene.revolute(
                format_args!("foot-{k}"),
                [&"ground", &upright],
                [k as f64, 0.0],
            )?;
        }
        for k in 1..=self.n {
            for upright in [k - 1, k] {
                scene.revolute(
                    format_args!("top-{upright}-{k}"),
                    [&format_args!("upright-{upright}"), &format_args!("rod-{k}")],
                    [upright as f64, 1.0],
                )?;
            }
        }
        scene.run_to(T_END)
    }
}
