//! Drives that agree, drives that contradict each other, and drives that contradict joints. The
//! expected differences are calculated manually.

use std::f64::consts::PI;

use joints::{
    Direction, Revolute, RevoluteAngleDrive, Translational, TranslationalDisplacementDrive,
};
use model::start::assemble;
use model::{
    Body, BodyRef, ConstraintLevel, Description, Function, Mechanism, StartOptions, Tolerance,
};

use super::*;

const GROUND: BodyRef = BodyRef::Ground;

fn pin(d: &mut Description, name: &str, bodies: [BodyRef; 2], place: [f64; 2]) {
    let [s_i, s_j] = bodies.map(|b| d.local(b, place));
    d.joint(name, &bodies, Revolute { s_i, s_j });
}

fn motor(d: &mut Description, name: &str, body: BodyRef, place: [f64; 2], motion: Function) {
    let drive = RevoluteAngleDrive::new(place, d.local(body, place));
    d.drive(name, &[GROUND, body], drive, motion);
}

/// A beam on two rails along x, each with a separate motor.
fn gantry(motions: [Function; 2]) -> Description {
    let mut d = Description::new("gantry");
    let beam = d.body(Body::new("beam", 40.0, 10.0));
    let bodies = [GROUND, beam];
    let axis = Direction::X;
    for (k, motion) in motions.into_iter().enumerate() {
        let s = [0.0, [1.0, -1.0][k]];
        let (s_i, s_j) = (s, s);
        let rail = Translational::new(s_i, s_j, axis);
        d.joint(["rail-left", "rail-right"][k], &bodies, rail);
        let drive = TranslationalDisplacementDrive::new(s_i, s_j, axis);
        d.drive(["left", "right"][k], &bodies, drive, motion);
    }
    d
}

/// Returns a motion to this value from 0.5 s to 1 s.
fn late(to: f64) -> Function {
    Function::steps(0.0, &[[0.5, 1.0, to]]).expect("ordered")
}

fn rate(rate: f64) -> Function {
    Function::constant_rate(rate).expect("finite")
}

fn assembled(d: &Description) -> (Mechanism, Vec<f64>) {
    let mut mechanism = Mechanism::build(d).expect("builds");
    let q = assemble(&mut mechanism, &StartOptions::default())
        .expect("assembles")
        .q;
    (mechanism, q)
}

/// Returns the configuration at which the coordinates of the independent drives have their
/// prescribed values.
fn followed_drives(mechanism: &Mechanism, q: &[f64], t: f64) -> Option<Vec<f64>> {
    let mut last = None;
    let seen = walk(mechanism, q, t, None, |time, q| {
        last = Some((time, q.to_vec()));
        Ok(true)
    });
    seen.expect("a start");
    last.filter(|(time, _)| *time == t).map(|(_, q)| q)
}

fn at_start(d: &Description) -> Vec<Contradiction> {
    let (mechanism, q) = assembled(d);
    contradicting_drives(&mechanism, 0.0, &q).expect("a configuration")
}

fn along(d: &Description, t_end: f64) -> Option<Contradiction> {
    let (mechanism, q) = assembled(d);
    contradicting_drives_along(&mechanism, &q, t_end).expect("a configuration")
}

#[test]
fn motors_that_agree_contradict_nothing() {
    for motions in [[rate(0.3), rate(0.3)], [late(0.3), late(0.3)]] {
        let d = gantry(motions);
        assert_eq!((at_start(&d), along(&d, 2.0)), (vec![], None));
    }
}

#[test]
fn motors_of_two_speeds_are_named_at_the_start() {
    let found = at_start(&gantry([rate(0.3), rate(0.6)]));
    let [one] = found.as_slice() else {
        panic!("{found:?}");
    };
    let text = "at t = 0 s drives `left` and `right` contradict each other: they require different velocities, which differ by 0.3 m/s (`left` requires the displacement of `rail-left` to change \
                at 0.3 m/s and `right` requires the displacement of `rail-right` to change at 0.6 m/s, and row 2 (`rail-left`, angle) connects them with each \
                other). Redundant drives must follow the same motion; delete or correct one of them";
    assert_eq!(one.to_string(), text);
    assert!(one.is_of_drives());
}

/// The motors differ by 0.3 m and 0.6 m. No rail is named, whatever the size of the difference is.
#[test]
fn motors_that_part_later_are_named_with_the_time() {
    for (far, said) in [(0.6, "0.6 m"), (600.0, "600 m")] {
        let d = gantry([late(0.3), late(far)]);
        assert_eq!(at_start(&d), []);
        assert_eq!(along(&d, 0.5), None);
        // At 13 positions up to 1.5 s, 0.625 s is the first time at which the motors differ: s =
        // 1/4, 10s³ − 15s⁴ + 6s⁵ = 0.103516.
        let one = along(&d, 1.5).expect("they differ");
        let share = 10.0 * 0.25_f64.powi(3) - 15.0 * 0.25_f64.powi(4) + 6.0 * 0.25_f64.powi(5);
        assert_eq!((one.time, one.level), (0.625, ConstraintLevel::Position));
        assert!(
            (one.size / (share * (far - 0.3)) - 1.0).abs() < 1e-12,
            "{one}"
        );
        let joints: Vec<&str> = one.rows.iter().map(|r| r.joint.as_str()).collect();
        assert_eq!(joints, ["rail-left", "left", "right"], "{one}");
        // At the end the whole difference is reported.
        let (mechanism, q) = assembled(&d);
        let there = followed_drives(&mechanism, &q, 1.0).expect("reached");
        assert!(
            (there[0] - 0.3).abs() < 1e-15,
            "the first drive is followed"
        );
        let text =
            contradicting_drives(&mechanism, 1.0, &there).expect("a configuration")[0].to_string();
        let asked =
            format!("`right` requires the displacement of `rail-right` to change by {said},");
        assert!(
            text.starts_with("at t = 1 s drives `left` and `right` contradict"),
            "{text}"
        );
        assert!(text.contains(&asked), "{text}");
    }
}

/// A drive moves too far for the continuation. In this case the drives are compared up to the last
/// position of the continuation.
#[test]
fn what_leads_far_away_is_compared_on_the_way() {
    let one = along(&gantry([late(1e6), late(0.3)]), 1.5).expect("they differ");
    assert!(
        one.time > 0.5 && one.time < 0.625 && one.is_of_drives(),
        "{one}"
    );
}

/// The functions of time differ slightly. At a single time, differences above rounding are
/// reported. Along the motion, differences are reported only if they would stop a simulation.
#[test]
fn small_differences_are_told_at_their_time() {
    for size in [1e-3, 1e-6, 1e-9, 1e-12] {
        let late = Function::steps(0.0, &[[1.0, 2.0, size]]).expect("ordered");
        let d = locomotive([late, rate(0.0)]);
        let (mechanism, q) = assembled(&d);
        let there = followed_drives(&mechanism, &q, 2.0).expect("reached");
        let found = contradicting_drives(&mechanism, 2.0, &there).expect("a configuration");
        // The positions differ by less than the limit of 1e-9, and the rates by twice as much.
        assert_eq!(along(&d, 2.0).is_some(), size > 1e-10, "{size}");
        if size < 1e-10 {
            assert_eq!(found, [], "below what the poses are known to");
            continue;
        }
        assert_eq!(found.len(), 1, "{size}: {found:?}");
        assert!(
            (found[0].size / size - 1.0).abs() < 1e-3,
            "{size}: {}",
            found[0]
        );
    }
}

/// Two cranks of 0.5 m, 1 m apart, joined by a rod, each with a motor.
fn locomotive(motions: [Function; 2]) -> Description {
    let mut d = Description::new("locomotive");
    let (length, angle) = (0.5, 0.3_f64);
    let tip = [length * angle.cos(), length * angle.sin()];
    let mut wheels = Vec::new();
    for (k, name) in ["front", "rear"].into_iter().enumerate() {
        let position = [k as f64, 0.0];
        let wheel = d.body(Body {
            position,
            ..Body::new(name, 1.0, 1.0)
        });
        pin(&mut d, &format!("axle-{name}"), [GROUND, wheel], position);
        wheels.push(wheel);
    }
    let rod = d.body(Body {
        position: [0.5 + tip[0], tip[1]],
        ..Body::new("rod", 1.0, 1.0)
    });
    for (k, motion) in motions.into_iter().enumerate() {
        let x = k as f64;
        pin(
            &mut d,
            &format!("pin-{k}"),
            [wheels[k], rod],
            [x + tip[0], tip[1]],
        );
        motor(&mut d, &format!("motor-{k}"), wheels[k], [x, 0.0], motion);
    }
    d
}

/// During the motion there are six configurations at which the rank drops and the second wheel
/// could rotate in the opposite direction. The second wheel does not rotate in the opposite
/// direction.
#[test]
fn agreeing_motors_are_followed_through_flat_poses() {
    for turns in [0.7, 3.0] {
        let d = locomotive([rate(2.0 * PI * turns), rate(2.0 * PI * turns)]);
        assert_eq!(along(&d, 1.0), None, "{turns} turns");
        let (mechanism, q) = assembled(&d);
        let there = followed_drives(&mechanism, &q, 1.0).expect("reached");
        let angle = 0.3 + 2.0 * PI * turns;
        let rod = [0.5 + 0.5 * angle.cos(), 0.5 * angle.sin(), 0.0];
        for (found, expected) in there[6..].iter().zip(rod) {
            assert!((found - expected).abs() < 1e-12, "{there:?}");
        }
    }
}

#[test]
fn a_motor_that_lags_behind_is_named_with_the_joints_between() {
    let one = along(
        &locomotive([
            rate(1.0),
            Function::steps(0.0, &[[0.0, 1.0, 1.0]]).expect("ordered"),
        ]),
        0.1,
    );
    let one = one.expect("they differ");
    // At rest, the second motor starts with zero speed.
    assert_eq!(one.time, 0.1 / 12.0);
    let text = one.to_string();
    assert!(
        text.contains("drives `motor-0` and `motor-1` contradict each other"),
        "{text}"
    );
    assert!(
        text.contains("`pin-0`") && text.contains("connect them with each other"),
        "{text}"
    );
}

/// Two motors that differ by a ten-thousandth, on parts with an accuracy of one millimetre. Within
/// the tolerance, the wheels can follow both motors at other angles and other speeds. A difference
/// of half a radian cannot result from the tolerance of the parts.
#[test]
fn motors_that_differ_by_less_than_the_parts_contradict_nothing() {
    let step = |to: f64| Function::steps(0.0, &[[0.0, 1.0, to]]).expect("ordered");
    let with = |tolerance: Option<f64>, to: f64| {
        let mut d = locomotive([step(1.0), step(to)]);
        d.tolerance = Tolerance {
            length: tolerance,
            ..Tolerance::default()
        };
        along(&d, 1.0)
    };
    assert!(with(None, 1.0001).is_some());
    assert_eq!(with(Some(1e-3), 1.0001), None);
    assert!(with(Some(1e-3), 1.5).is_some());
}

/// Hinges 0.8 m apart lock the leaf. The motor on the first hinge prescribes a rotation.
fn locked_door(motion: Function) -> Description {
    let mut d = Description::new("door");
    let leaf = d.body(Body {
        position: [0.4, 0.0],
        ..Body::new("leaf", 20.0, 1.0)
    });
    pin(&mut d, "hinge", [GROUND, leaf], [0.0, 0.0]);
    pin(&mut d, "third", [GROUND, leaf], [0.8, 0.0]);
    motor(&mut d, "motor", leaf, [0.0, 0.0], motion);
    d
}

#[test]
fn a_drive_that_asks_for_what_joints_forbid_is_named_with_them() {
    let found = at_start(&locked_door(rate(2.0)));
    let text = "at t = 0 s drive `motor` requires the angle of `hinge` to change at 2 rad/s, which differs by 2 rad/s from the value that rows 2 (`hinge`, y) and 4 \
                (`third`, y) allow. The remaining rows do not allow the motion that one row prescribes: the mechanism is locked, or in a singular configuration. Begin at another configuration, or prescribe another motion";
    assert_eq!(
        found.iter().map(ToString::to_string).collect::<Vec<_>>(),
        [text]
    );
    // The same contradiction at a later time.
    let d = locked_door(late(0.25));
    assert_eq!(at_start(&d), []);
    let one = along(&d, 1.0).expect("it turns in the end");
    assert!((one.time, one.demands.len()) == (7.0 / 12.0, 1), "{one}");
    // A motor that holds the leaf at rest does not contradict the hinges.
    assert_eq!(along(&locked_door(rate(0.0)), 1.0), None);
}

/// There is no contradiction if no row is redundant, or if there are no drives.
#[test]
fn a_drive_that_is_needed_contradicts_nothing() {
    let mut d = Description::new("crank");
    let crank = d.body(Body::new("crank", 1.0, 1.0));
    pin(&mut d, "pin", [GROUND, crank], [0.0, 0.0]);
    assert_eq!((at_start(&d), along(&d, 1.0)), (vec![], None));
    motor(&mut d, "motor", crank, [0.0, 0.0], rate(50.0));
    assert_eq!((at_start(&d), along(&d, 1.0)), (vec![], None));
    let (mechanism, q) = assembled(&d);
    assert!(contradicting_drives_along(&mechanism, &q[1..], 1.0).is_err());
    assert!(contradicting_drives_along(&mechanism, &q, f64::NAN).is_err());
}

/// A slider-crank in line. Its motor is redundant only at this configuration, so there is no
/// contradiction.
#[test]
fn a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later() {
    let mut d = Description::new("dead centre");
    let body = |name: &str, x: f64| Body {
        position: [x, 0.0],
        ..Body::new(name, 1.0, 0.1)
    };
    let crank = d.body(body("crank", 0.5));
    let rod = d.body(body("rod", 2.0));
    let slider = d.body(body("slider", 3.0));
    pin(&mut d, "A", [GROUND, crank], [0.0, 0.0]);
    pin(&mut d, "B", [crank, rod], [1.0, 0.0]);
    pin(&mut d, "C", [rod, slider], [3.0, 0.0]);
    let (s_i, s_j, axis) = ([3.0, 0.0], [0.0, 0.0], Direction::X);
    let guide = Translational::new(s_i, s_j, axis);
    d.joint("D", &[GROUND, slider], guide);
    let drive = TranslationalDisplacementDrive::new(s_i, s_j, axis);
    let law = Function::polynomial(&[0.0, 0.0, 0.0, -1.0]).expect("finite");
    d.drive("motor", &[GROUND, slider], drive, law);
    assert_eq!(along(&d, 1.0), None);
}
