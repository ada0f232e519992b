//! Extreme mechanisms in space: fast spin, many revolutions, needles, half turns, loops that become
//! singular, and disks that nearly lie flat. Masses and lengths cover many powers of ten. Each
//! motion has a closed form.

use std::f64::consts::{PI, TAU};
use std::time::Duration;

use dynamics::{Method, MotionOptions};
use joints::space3::cross;

use super::long_runs::swing;
use crate::mechanisms::space::{RollingDisk, bricard_of_size};
use crate::stress::case::{Case, Expected, Family};
use crate::stress::motion::{Row, case, combinations, moving, outcome_of, prepared, worst};

/// Mechanisms in space.
pub(super) const FAMILY: Family = Family {
    name: "in-space",
    about: "spin of 1e4 rad/s, a million turns, needles, half turns, loops through their flat poses, disks that nearly lie, and ratios of masses and lengths up to 1e12",
    cases,
};

/// Acceleration of free fall (m/s²).
const GRAVITY: f64 = 9.81;

/// Tolerance of the runs.
const RTOL: f64 = 1e-11;

/// Time limit of a case. A million revolutions need fifteen million evaluations.
const TIME_LIMIT: Duration = Duration::from_secs(600);

type Vector = [f64; 3];

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    rotors(&mut cases);
    tops(&mut cases);
    needles(&mut cases);
    half_turns(&mut cases);
    loops(&mut cases);
    disks(&mut cases);
    masses(&mut cases);
    lengths(&mut cases);
    cases
}

/// Returns options of a run up to a time, for a mechanism with lengths of this size.
fn until(t_end: f64, size: f64) -> MotionOptions {
    MotionOptions {
        rtol: RTOL,
        atol: RTOL * size,
        output_step: t_end,
        ..MotionOptions::to(t_end)
    }
}

/// Returns the largest component of the deviation of the first body's mass centre from a position,
/// relative to a length.
fn off_place(row: &Row, place: Vector, size: f64) -> f64 {
    worst((0..3).map(|k| (row.q[k] - place[k]) / size))
}

// Tests fast spin.

/// Axis of the rotor, and the vector from the hinge of the rotor to its mass centre (m).
const AXIS: Vector = [0.48, 0.6, 0.64];
const ARM: Vector = [0.08, -0.064, 0.0];

/// Returns the lever arm after a rotation about the axis.
fn turned(angle: f64) -> Vector {
    let (sin, cos) = angle.sin_cos();
    let across = cross(AXIS, ARM);
    std::array::from_fn(|k| cos * ARM[k] + sin * across[k])
}

/// Adds a rotor about an oblique axis, with an initial speed, and with a drive for many revolutions
/// within one output step.
fn rotors(cases: &mut Vec<Case>) {
    let size = 0.1;
    let (omega, turns) = (1e4, 100.0);
    let t_end = TAU * turns / omega;
    for options in combinations(&until(t_end, size)) {
        // As in the plane, the bound is N²/2 tolerances in N = 50 steps per revolution.
        let right = Expected::AnswerOrRefusal {
            bound: RTOL * 0.05 * (50.0 * turns).powi(2),
            source: "uniform rotation about a skew axis; errors of the speed in some 50 steps a turn, added up in the phase",
            parts: vec!["step".into(), "at t = ".into()],
        };
        let speed = cross(AXIS.map(|x| omega * x), ARM);
        let text = rotor(
            &format!(
                ", velocity = {speed:?}, angular_velocity = {:?}",
                AXIS.map(|x| omega * x)
            ),
            "",
        );
        let made = case(
            "a rotor at 1e4 rad/s",
            text,
            options,
            right,
            move |row, _| off_place(row, turned(omega * row.t), size),
        );
        cases.push(made);
    }
    for turns in [1e3, 1e6] {
        let t_end = 1.0;
        let rate = TAU * turns;
        let drive = format!(
            "drive = [{{ name = \"motor\", joint = \"pin\", type = \"angle\", motion = {{ type = \"constant-rate\", rate = {rate:?} }} }}]"
        );
        let right = Expected::answer(
            1e-8,
            "the angle of the drive, known to a rounding of 2π·10⁶ rad, which is 1e-9",
        );
        let made = case(
            format!("a driven rotor, {turns:.0e} turns"),
            rotor("", &drive),
            MotionOptions {
                method: Method::Dop853,
                // The state is a given function of time. The tolerance is loose, because steps only
                // need to resolve the revolutions.
                rtol: 1e-2,
                atol: 1e-2 * size,
                max_steps: 20_000_000,
                ..until(t_end, size)
            },
            right,
            move |row, _| off_place(row, turned(rate * row.t), size),
        );
        cases.push(made.within(TIME_LIMIT));
    }
}

fn rotor(speed: &str, drive: &str) -> String {
    format!(
        r#"
scene = {{ name = "rotor", space = "spatial" }}
body = [{{ name = "rotor", mass = 2.0, inertia = [0.01, 0.02, 0.025], position = {ARM:?}, orientation = {{ axis = [1, -2, 3], angle = 0.8 }}{speed} }}]
joint = [{{ name = "pin", type = "revolute", bodies = ["ground", "rotor"], at = [0, 0, 0], axis = {AXIS:?} }}]
{drive}
"#
    )
}

/// Adds tops in steady precession, for which `A·Ω²·cos θ − C·ω₃·Ω + m·g·l = 0` with the moments A,
/// C about the fixed point.
fn tops(cases: &mut Vec<Case>) {
    let (mass, arm, [across, along]) = (1.5, 0.1, [0.004, 0.002]);
    let tilt = 0.7_f64;
    let (sin, cos) = tilt.sin_cos();
    let (about_point, moment) = (across + mass * arm * arm, mass * GRAVITY * arm);
    for spin in [2e2, 1e3, 1e4] {
        let own = along * spin;
        let root = (own * own - 4.0 * about_point * cos * moment).sqrt();
        let precession = 2.0 * moment / (own + root);
        let axis = [sin, 0.0, cos];
        let turning: Vector = std::array::from_fn(|k| {
            let upright = if k == 2 { precession } else { 0.0 };
            upright + (spin - precession * cos) * axis[k]
        });
        let centre = axis.map(|x| arm * x);
        let velocity = cross(turning, centre);
        let text = format!(
            r#"
scene = {{ name = "top", space = "spatial", gravity = [0, 0, -{GRAVITY}] }}
body = [{{ name = "top", mass = {mass}, inertia = [{across}, {across}, {along}], position = {centre:?}, orientation = {{ axis = [0, 1, 0], angle = {tilt} }}, velocity = {velocity:?}, angular_velocity = {turning:?} }}]
joint = [{{ name = "tip", type = "spherical", bodies = ["ground", "top"], at = [0, 0, 0] }}]
"#
        );
        let t_end = 1e3 / spin;
        let right = Expected::answer(1e-6, "steady precession of a heavy symmetric top");
        for options in combinations(&until(t_end, arm)) {
            let made = case(
                format!("a top at {spin:.0e} rad/s"),
                text.clone(),
                options,
                right.clone(),
                move |row, _| {
                    let (s, c) = (precession * row.t).sin_cos();
                    off_place(row, [arm * sin * c, arm * sin * s, arm * cos], arm)
                },
            );
            cases.push(made.at("rad/s", spin));
        }
    }
}

// Tests pendulum motions.

/// Returns the expectation from the closed form of a pendulum motion. If masses differ by many
/// powers of ten, implicit methods select the coordinates of heavy bodies as independent
/// coordinates, even if these coordinates change ten times less than other coordinates. Errors grow
/// by the square of this factor, and at every change of the independent coordinates.
fn swings(options: &MotionOptions) -> Expected {
    let bound = if options.method == Method::Radau5 {
        1e-6
    } else {
        1e-7
    };
    Expected::answer(bound, "a compound pendulum by Jacobi's elliptic functions")
}

/// A uniform rod of 1.5 m that falls from the horizontal about its end moves like a point mass on a
/// massless rod of 1 m. Returns the position of the mass centre of the rod at t, in the vertical
/// plane through `along`.
fn rod(t: f64, along: [f64; 2]) -> Vector {
    let [angle, _] = swing(t);
    let (sin, cos) = angle.sin_cos();
    [0.75 * cos * along[0], 0.75 * cos * along[1], -0.75 * sin]
}

/// Transverse moment of inertia of the rod (kg·m²), for a mass of 1 kg.
const ACROSS: f64 = 0.1875;

/// The horizontal direction of the rod at the initial state.
const ALONG: [f64; 2] = [-0.8, 0.6];

/// Returns the rod on a joint, with this axial moment of inertia and its axis along x of the body
/// frame.
fn swinging(joint: &str, about_itself: f64) -> String {
    let angle = ALONG[1].atan2(ALONG[0]);
    format!(
        r#"
scene = {{ name = "rod", space = "spatial", gravity = [0, 0, -{GRAVITY}] }}
body = [{{ name = "rod", mass = 1.0, inertia = [{about_itself:?}, {ACROSS}, {ACROSS}], position = [{:?}, {:?}, 0], orientation = {{ axis = [0, 0, 1], angle = {angle:?} }} }}]
joint = [{{ name = "end", bodies = ["ground", "rod"], at = [0, 0, 0], {joint} }}]
"#,
        0.75 * ALONG[0],
        0.75 * ALONG[1],
    )
}

const BALL: &str = "type = \"spherical\"";
const HINGE: &str = "type = \"revolute\", axis = [0.6, 0.8, 0]";

/// Adds rods with a very small axial moment of inertia, on a ball joint and on a hinge. A rod
/// without this moment does not spin.
fn needles(cases: &mut Vec<Case>) {
    let t_end = 3.0;
    for (joint, words) in [(BALL, "ball"), (HINGE, "hinge")] {
        for about_itself in [1e-3, 1e-6, 1e-9, 1e-12, 1e-18, 0.0] {
            for options in combinations(&until(t_end, 1.0)) {
                let right = if about_itself > 0.0 && about_itself < 1e-15 && joint == BALL {
                    // The rounding error of the torque about the axis of the rod causes an
                    // arbitrary rotation.
                    Expected::AnswerOrRefusal {
                        bound: 1e-6,
                        source: "a compound pendulum by Jacobi's elliptic functions",
                        parts: vec!["step".into(), "at t = ".into()],
                    }
                } else {
                    swings(&options)
                };
                let name = format!("a needle of {about_itself:.0e} kg·m² on a {words}");
                let made = case(
                    name,
                    swinging(joint, about_itself),
                    options,
                    right,
                    |row, _| off_place(row, rod(row.t, ALONG), 0.75),
                );
                cases.push(made);
            }
        }
    }
}

/// Adds frames that are rotated by half a turn, for which the scalar part of the quaternion is
/// zero, and bodies that rotate through this orientation.
fn half_turns(cases: &mut Vec<Case>) {
    let third = 1.0 / 3.0_f64.sqrt();
    let axes = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [third; 3],
    ];
    for (axis, past) in axes
        .into_iter()
        .flat_map(|axis| [-1e-9, 0.0, 1e-9].map(|past| (axis, past)))
    {
        let text = format!(
            r#"
scene = {{ name = "ball", space = "spatial", gravity = [0, 0, -{GRAVITY}] }}
body = [{{ name = "ball", mass = 1.0, inertia = [{ACROSS}, {ACROSS}, {ACROSS}], position = [{:?}, {:?}, 0], orientation = {{ axis = {axis:?}, angle = {:?} }} }}]
joint = [{{ name = "end", type = "spherical", bodies = ["ground", "ball"], at = [0, 0, 0] }}]
"#,
            0.75 * ALONG[0],
            0.75 * ALONG[1],
            PI + past,
        );
        let right = Expected::answer(1e-7, "the motion does not depend on the frame of a ball");
        let options = MotionOptions {
            method: Method::Dop853,
            ..until(3.0, 1.0)
        };
        let name = format!(
            "a frame turned by π {past:+.0e} about {}",
            ["x", "y", "z", "a diagonal"][axes.iter().position(|a| *a == axis).unwrap_or(0)]
        );
        let made = case(name, text, options, right, |row, _| {
            off_place(row, rod(row.t, ALONG), 0.75)
        });
        cases.push(made);
    }
}

// Tests closed loops.

/// Adds parallelograms of revolute joints with 3 redundant rows each, which start at an angle
/// before their singular configuration. Without gravity they rotate uniformly, through all singular
/// configurations.
fn loops(cases: &mut Vec<Case>) {
    let t_end = 7.0;
    for before in [1.0, 1e-2, 1e-4, 1e-6, 1e-8] {
        for n in [1, 2, 5] {
            for options in combinations(&until(t_end, 1.0)) {
                if n == 5 && options.method == Method::Radau5 {
                    // The case is solved with sparse matrices, and rejected with an error.
                    continue;
                }
                let start = -before;
                let right = if before < 1e-7 {
                    // The relative accuracy of velocities would be only 3e-8.
                    Expected::refusal(&["are dependent to within"])
                } else {
                    Expected::AnswerOrRefusal {
                        bound: 1e-6,
                        source: "all cranks have the same angle, and its rate is constant",
                        parts: vec!["singular".into()],
                    }
                };
                let made = case(
                    format!("{n} parallelograms, {before:.0e} before the flat pose"),
                    parallelograms(n, start),
                    options,
                    right,
                    move |row, _| {
                        let (sin, cos) = (start + row.t).sin_cos();
                        off_place(row, [0.5 * cos, 0.5 * sin, 0.0], 1.0)
                    },
                );
                cases.push(made);
            }
        }
    }
}

/// Returns n parallelograms in a row: n + 1 cranks of 1 m at this angle on the x-axis, and n
/// couplers.
fn parallelograms(n: usize, angle: f64) -> String {
    let (sin, cos) = angle.sin_cos();
    let mut text = "scene = { name = \"row\", space = \"spatial\" }\n".to_owned();
    for k in 0..=n {
        let x = k as f64;
        text += &format!(
            "[[body]]\nname = \"crank {k}\"\nmass = 1.0\ninertia = [0.01, 0.1, 0.1]\nposition = [{:?}, {:?}, 0.0]\norientation = {{ axis = [0, 0, 1], angle = {angle:?} }}\n\
             velocity = [{:?}, {:?}, 0.0]\nangular_velocity = [0, 0, 1]\n\
             [[joint]]\nname = \"foot {k}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"crank {k}\"]\nat = [{x:?}, 0.0, 0.0]\naxis = [0, 0, 1]\n",
            x + 0.5 * cos,
            0.5 * sin,
            -0.5 * sin,
            0.5 * cos
        );
    }
    for k in 0..n {
        let x = k as f64;
        text += &format!(
            "[[body]]\nname = \"rod {k}\"\nmass = 1.0\ninertia = [0.01, 0.1, 0.1]\nposition = [{:?}, {sin:?}, 0.0]\nvelocity = [{:?}, {cos:?}, 0.0]\nangular_velocity = [0, 0, 0]\n",
            x + cos + 0.5,
            -sin
        );
        for (side, at) in [(k, x + cos), (k + 1, x + 1.0 + cos)] {
            text += &format!(
                "[[joint]]\nname = \"pin {k} {side}\"\ntype = \"revolute\"\nbodies = [\"crank {side}\", \"rod {k}\"]\nat = [{at:?}, {sin:?}, 0.0]\naxis = [0, 0, 1]\n"
            );
        }
    }
    text
}

// Tests rolling disks.

/// Adds disks in steady motion that nearly lie on the plane. The smaller the angle between disk and
/// plane, the faster the contact point moves around, as for a coin that comes to rest.
fn disks(cases: &mut Vec<Case>) {
    for tilt in [0.3, 1e-1, 1e-2, 2e-3, 1e-4] {
        let [across, _] = RollingDisk::MOMENTS;
        let weight = RollingDisk::MASS * RollingDisk::GRAVITY * RollingDisk::RADIUS;
        let precession = 1.1 * (weight / (across * f64::sin(tilt))).sqrt();
        let disk = RollingDisk { tilt, precession };
        let t_end = 20.0 / precession;
        let source = "steady rolling: (C + m·r²)·ω₃ = A·Ω·cos θ − m·g·r·cos θ/(Ω·sin θ); the mass centre runs on a circle";
        let right = if tilt < 1e-3 {
            // At this angle, the contact row is dependent to working precision.
            Expected::refusal(&["edge", "parallel"])
        } else if tilt < 5e-3 {
            // The height of the centre is proportional to a sine, which is computed from a cosine
            // of nearly 1.
            let parts = vec!["edge".into(), "contact".into()];
            Expected::AnswerOrRefusal {
                bound: 1e-6,
                source,
                parts,
            }
        } else {
            Expected::answer(1e-6, source)
        };
        for options in combinations(&until(t_end, 1.0)) {
            let made = moving(
                format!("a disk tilted by {tilt:.0e} rad"),
                options,
                right.clone(),
                move |options| {
                    let prepared = prepared(&disk.description())?;
                    let start = prepared.v[..3].to_vec();
                    let at = prepared.q[..3].to_vec();
                    Ok(outcome_of(&prepared, options, |row, _| {
                        let (sin, cos) = (precession * row.t).sin_cos();
                        let [x, y] = [start[0], start[1]];
                        let place = [
                            at[0] + (sin * x - (1.0 - cos) * y) / precession,
                            at[1] + (sin * y + (1.0 - cos) * x) / precession,
                            at[2],
                        ];
                        off_place(row, place, 1.0)
                    }))
                },
            );
            cases.push(made.at("tilt (rad)", tilt));
        }
    }
    let lying = RollingDisk {
        tilt: 0.0,
        precession: 1.0,
    };
    let refused = Expected::refusal(&["edge", "parallel"]);
    let options = MotionOptions {
        method: Method::Dop853,
        ..until(1.0, 1.0)
    };
    cases.push(moving(
        "a disk that lies",
        options,
        refused,
        move |options| {
            let mut description = lying.description();
            for body in &mut description.bodies {
                (body.velocity, body.angular_velocity) = (Some([0.0; 3]), Some([0.0; 3]));
            }
            let prepared = prepared(&description)?;
            Ok(outcome_of(&prepared, options, |_, _| 0.0))
        },
    ));
}

// Tests powers of ten.

/// Adds a rod with a ball that rotates freely about the mass centre of the ball. This is a compound
/// pendulum for any masses.
fn masses(cases: &mut Vec<Case>) {
    for power in [-12, -9, -6, -3, 0, 3, 6, 9, 12] {
        let mass = f64::powi(10.0, power);
        // Moment of inertia about the end of the rod, with the ball at 0.5 m from this end; the
        // moment of the weight follows.
        let inertia = 0.75 + mass * 0.25;
        let moment = 0.75 + mass * 0.5;
        let rate = (moment / inertia).sqrt();
        let text = swinging(HINGE, 0.01).replace(
            "}]\njoint = [",
            &format!(
                "}},\n        {{ name = \"ball\", mass = {mass:?}, inertia = [{0:?}, {0:?}, {0:?}], position = [{1:?}, {2:?}, 0] }}]\n\
                 joint = [{{ name = \"centre\", type = \"spherical\", bodies = [\"rod\", \"ball\"], at = [{1:?}, {2:?}, 0] }},\n         ",
                0.004 * mass, 0.5 * ALONG[0], 0.5 * ALONG[1],
            ),
        );
        for options in combinations(&until(3.0, 1.0)) {
            let right = swings(&options);
            let made = case(
                format!("a ball of 1e{power} kg on a rod"),
                text.clone(),
                options,
                right,
                move |row, _| off_place(row, rod(rate * row.t, ALONG), 0.75),
            );
            cases.push(made.at("kg", mass));
        }
    }
}

/// Adds Bricard's linkage with lengths of many powers of ten. Times are proportional to the square
/// root of the length.
fn lengths(cases: &mut Vec<Case>) {
    for power in [-6, -3, 0, 3, 6] {
        let size = f64::powi(10.0, power);
        let t_end = size.sqrt();
        let right = Expected::answer(
            1e-8,
            "angle and rate at 1 s of the IFToMM benchmark A04, scaled: −1.035028459518 rad, −2.03641538097 rad/s",
        );
        for options in combinations(&until(t_end, size)) {
            let made = moving(
                format!("Bricard's linkage of 1e{power} m"),
                options,
                right.clone(),
                move |options| {
                    let prepared = prepared(&bricard_of_size(size))?;
                    Ok(outcome_of(&prepared, options, |row, _| {
                        let angle = row.q[2].atan2(row.q[0]);
                        let rate = (row.q[0] * row.v[2] - row.q[2] * row.v[0])
                            / (row.q[0].powi(2) + row.q[2].powi(2));
                        worst([angle + 1.035_028_459_518, rate * t_end + 2.036_415_380_97])
                    }))
                },
            );
            cases.push(made.at("m", size));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::families::assert_passes_where;
    use crate::stress::{Judgement, judge};

    /// The closed form of the rod satisfies the energy equation.
    #[test]
    fn the_rod_falls_by_its_energy() {
        let (t, h) = (0.4, 1e-5);
        let [before, after] = [t - h, t + h].map(|t| rod(t, ALONG));
        let speed = worst((0..3).map(|k| (after[k] - before[k]) / (2.0 * h)));
        let fallen = -rod(t, ALONG)[2];
        // The energy equation is ½·J·ω² = m·g·h with J = 0.75 kg·m² about the end.
        let [_, rate] = swing(t);
        assert!((0.375 * rate * rate - GRAVITY * fallen).abs() < 1e-9);
        assert!(speed <= 0.75 * rate * (1.0 + 1e-9));
        assert!((rod(0.0, ALONG)[0] - 0.75 * ALONG[0]).abs() < 1e-15);
    }

    #[test]
    fn every_motion_in_space_is_right_or_refused() {
        // Cases with a million revolutions are omitted, because they take minutes.
        let is_short = |name: &str| !name.contains("1e6 turns");
        assert_passes_where(FAMILY, |case| {
            case.method == "dop853" && is_short(&case.name)
        });
    }

    #[test]
    fn a_needle_that_swings_in_another_plane_is_silently_wrong() {
        let options = until(1.0, 1.0);
        let found = crate::stress::motion::outcome(&swinging(BALL, 1e-9), &options, |row, _| {
            off_place(row, rod(row.t, [ALONG[1], ALONG[0]]), 0.75)
        });
        let right = Expected::answer(1e-7, "another plane");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }
}
