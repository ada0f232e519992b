//! Describes the same mechanism in different ways: translated, rotated, in other units, in another
//! order. Verdicts must be equal, and the motion must be the same after conversion.

use dynamics::MotionOptions;
use model::{BodyRef, Description};
use solvability::Analysis;

use crate::mechanisms::robot::{robot_of_size, steering_of_size};
use crate::mechanisms::sketch::{Sketch, Tie};
use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{
    Row, acceleration, analysed, asking, last_row, moving, prepared, worst,
};

/// Mechanisms that are translated, rotated, scaled, or described in another order.
pub(super) const FAMILY: Family = Family {
    name: "invariance",
    about: "the robot and three falling cranks moved by 1e6 m, turned, in other units and in another order: the same verdicts, accelerations and motion",
    cases,
};

/// Acceleration of free fall (m/s²).
const G: f64 = 9.81;
/// Tolerance of the runs. The integration errors must be smaller than the compared differences.
const TIGHT: f64 = 1e-12;

/// A change of the description of a mechanism: lengths are multiplied by `size`, the mechanism is
/// rotated by `angle`, then translated. The order of bodies and joints is reversed or not.
#[derive(Clone, Copy)]
struct Change {
    name: &'static str,
    size: f64,
    angle: f64,
    by: [f64; 2],
    reversed: bool,
}

impl Change {
    const NONE: Self = Self {
        name: "as it is",
        size: 1.0,
        angle: 0.0,
        by: [0.0; 2],
        reversed: false,
    };

    const ALL: [Self; 10] = [
        Self {
            name: "moved by 1e3 m",
            by: [1e3, -7e2],
            ..Self::NONE
        },
        Self {
            name: "moved by 1e6 m",
            by: [1e6, -3e5],
            ..Self::NONE
        },
        Self {
            name: "turned by 0.7 rad",
            angle: 0.7,
            ..Self::NONE
        },
        Self {
            name: "turned by 90°",
            angle: std::f64::consts::FRAC_PI_2,
            ..Self::NONE
        },
        Self {
            name: "turned by −3 rad",
            angle: -3.0,
            ..Self::NONE
        },
        Self {
            name: "in millimetres",
            size: 1e3,
            ..Self::NONE
        },
        Self {
            name: "1e6 times as large",
            size: 1e6,
            ..Self::NONE
        },
        Self {
            name: "1e6 times as small",
            size: 1e-6,
            ..Self::NONE
        },
        Self {
            name: "in reverse order",
            reversed: true,
            ..Self::NONE
        },
        Self {
            name: "turned, in millimetres, in reverse order",
            angle: 0.3,
            size: 1e3,
            reversed: true,
            ..Self::NONE
        },
    ];

    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        [cos * x - sin * y, sin * x + cos * y]
    }

    /// Returns the error bound after the change. Coordinates of 1e6 m are accurate to 1e-10 m, and
    /// rounding errors grow by a factor of a hundred during the computation.
    fn bound(&self) -> f64 {
        let far = self.by[0].abs().max(self.by[1].abs());
        1e-10 + 1e2 * f64::EPSILON * far
    }
}

/// A function that returns the description of a mechanism after a change.
type Written = fn(&Change) -> Description;

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    // The robot runs to the end of the first turn of the wheel; the cranks run to shortly before
    // their first singular configuration.
    for (name, written, t_end) in [
        ("robot", robot as Written, 2.0),
        ("three cranks", three_cranks, 0.3),
    ] {
        for change in Change::ALL {
            let named = format!("{name}, {}", change.name);
            let right = Expected::answer(
                0.0,
                "a verdict belongs to the mechanism, not to how it is written down",
            );
            cases.push(asking(named.clone(), "analyze", right, move || {
                verdicts(written, &change)
            }));
            let options = MotionOptions {
                rtol: TIGHT,
                atol: TIGHT,
                ..MotionOptions::to(t_end)
            };
            let source = "the same motion taken back; sizes in that of the mechanism, rounding of far coordinates a hundredfold";
            let right = Expected::answer(change.bound(), source);
            cases.push(moving(named.clone(), options, right, move |o| {
                motion(written, &change, o)
            }));
        }
    }
    cases
}

/// Returns the robot. It has no joint with the ground, so each body can be moved separately.
fn robot(change: &Change) -> Description {
    let mut d = robot_of_size(change.size, steering_of_size(change.size));
    for body in &mut d.bodies {
        let [x, y] = change.turned(body.position);
        body.position = [x + change.by[0], y + change.by[1]];
        body.velocity = body.velocity.map(|v| change.turned(v));
        body.angle += change.angle;
    }
    if change.reversed {
        let last = d.bodies.len() - 1;
        d.bodies.reverse();
        d.joints.reverse();
        let bodies = d.joints.iter_mut().map(|j| &mut j.bodies);
        for body in bodies
            .chain(d.drives.iter_mut().map(|x| &mut x.bodies))
            .flatten()
        {
            if let BodyRef::Body(k) = body {
                *k = last - *k;
            }
        }
    }
    d
}

/// Returns three parallel cranks of 0.5 m under a coupler, falling from 1 rad.
fn three_cranks(change: &Change) -> Description {
    let (length, theta) = (0.5, 1.0_f64);
    let tip = [length * theta.cos(), length * theta.sin()];
    let mut sketch = Sketch::default();
    let pivots = [0.0, 1.0, 1.7];
    let coupler = sketch.body([0.85 + tip[0], tip[1]], 0.0);
    for x in pivots {
        let crank = sketch.body([x + 0.5 * tip[0], 0.5 * tip[1]], theta);
        sketch.link(&[BodyRef::Ground, crank], Tie::Revolute { at: [x, 0.0] });
        sketch.link(
            &[crank, coupler],
            Tie::Revolute {
                at: [x + tip[0], tip[1]],
            },
        );
    }
    for body in &mut sketch.bodies {
        body.inertia = 0.05;
    }
    let mut sketch = sketch
        .scaled(change.size)
        .turned(change.angle)
        .moved(change.by);
    if change.reversed {
        let order = |n: usize| -> Vec<usize> { (0..n).rev().collect() };
        sketch = sketch
            .with_bodies(&order(sketch.bodies.len()))
            .with_links(&order(sketch.links.len()));
    }
    let gravity = change.turned([0.0, -G * change.size]);
    Description {
        gravity,
        ..sketch.description()
    }
}

/// Returns the results for a mechanism, by name: ranks, then the verdict and the number of unique
/// directions of each reaction.
fn said(a: &Analysis) -> (Vec<usize>, Vec<(String, &'static str, usize)>) {
    let mut reactions: Vec<_> = a
        .reactions
        .iter()
        .map(|r| {
            (
                r.name.clone(),
                r.wrench.verdict.word(),
                r.unique_directions.len(),
            )
        })
        .collect();
    reactions.sort();
    let decision = &a.decision;
    (
        vec![
            a.rank_holonomic,
            a.rank_nonholonomic,
            decision.rank,
            decision.redundancy,
        ],
        reactions,
    )
}

fn verdicts(written: Written, change: &Change) -> Result<Outcome, Outcome> {
    let expected = said(&analysed(&written(&Change::NONE))?);
    let a = analysed(&written(change))?;
    if let rank::RankStatus::Undecided(doubt) = &a.decision.status {
        return Err(Outcome::refused(doubt));
    }
    let found = said(&a);
    let detail = format!("ranks {:?}, {} reactions", found.0, found.1.len());
    Ok(Outcome::fact(found == expected, detail))
}

/// Compares accelerations at the initial state, and the last output row.
fn motion(written: Written, change: &Change, options: &MotionOptions) -> Result<Outcome, Outcome> {
    let made = |change: &Change| -> Result<(Row, Vec<f64>), Outcome> {
        let found = prepared(&written(change))?;
        let options = MotionOptions {
            atol: options.atol * change.size.min(1.0),
            ..options.clone()
        };
        let a = acceleration(&found, &options)?;
        Ok((last_row(&found, &options)?.0, a))
    };
    let (was, a_was) = made(&Change::NONE)?;
    let (is, a_is) = made(change)?;
    let errors = [
        off(&was.q, &is.q, change, change.by, change.angle),
        off(&was.v, &is.v, change, [0.0; 2], 0.0),
        off(&a_was, &a_is, change, [0.0; 2], 0.0),
    ];
    Ok(Outcome::answer(
        worst(errors),
        format!(
            "position, velocity, acceleration {:?}",
            errors.map(|e| format!("{e:.1e}"))
        ),
    ))
}

/// Returns the largest difference between converted and original values, relative to the size of
/// the mechanism.
fn off(was: &[f64], is: &[f64], change: &Change, by: [f64; 2], angle: f64) -> f64 {
    let mut bodies: Vec<&[f64]> = is.chunks(3).collect();
    if change.reversed {
        bodies.reverse();
    }
    if was.len() != is.len() {
        return f64::NAN;
    }
    worst(was.chunks(3).zip(bodies).flat_map(|(was, is)| {
        let [x, y] = change.turned([was[0] * change.size, was[1] * change.size]);
        [
            (is[0] - x - by[0]) / change.size,
            (is[1] - y - by[1]) / change.size,
            is[2] - was[2] - angle,
        ]
    }))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn nothing_depends_on_the_frame() {
        super::super::assert_passes(FAMILY);
    }

    /// If a wrong angle is used for the conversion, the test detects an error.
    #[test]
    fn another_frame_is_silently_wrong() {
        let written: Written = |change| {
            three_cranks(&Change {
                angle: 1.000_001 * change.angle,
                ..*change
            })
        };
        let options = MotionOptions::to(0.1);
        let found = motion(
            written,
            &Change {
                angle: 0.3,
                ..Change::NONE
            },
            &options,
        )
        .expect("it falls");
        assert_eq!(
            judge(&Expected::answer(1e-10, "the same motion"), &found),
            Judgement::SilentlyWrong
        );
    }
}
