//! Limit positions of drives, calculated from the lengths of triangles.

use std::f64::consts::PI;

use joints::TranslationalDisplacementDrive;
use joints::{Direction, DistanceLengthDrive, Revolute, RevoluteAngleDrive, Translational};
use model::start::assemble;
use model::{Body, BodyRef, Description, Function, Mechanism, StartOptions, System};

use super::*;

const GROUND: BodyRef = BodyRef::Ground;

/// Adds a bar of 1 m with this foot, whose other end is at this angle.
fn bar(d: &mut Description, foot: BodyRef, at: [f64; 2], angle: f64) -> ([f64; 2], BodyRef) {
    let end = [at[0] + angle.cos(), at[1] + angle.sin()];
    let position = [0.5 * (at[0] + end[0]), 0.5 * (at[1] + end[1])];
    let name = format!("bar {}", d.bodies.len());
    let bar = d.body(Body {
        position,
        angle,
        ..Body::new(&name, 1.0, 0.1)
    });
    let [s_i, s_j] = [foot, bar].map(|b| d.local(b, at));
    d.joint(
        &format!("pivot of {name}"),
        &[foot, bar],
        Revolute { s_i, s_j },
    );
    (end, bar)
}

fn rate(rate: f64) -> Function {
    Function::constant_rate(rate).expect("finite")
}

/// Returns the limit that is found from the start, with velocities that satisfy the rows.
fn limit(d: &Description) -> Option<DriveLimit> {
    let mut mechanism = Mechanism::build(d).expect("builds");
    let q = assemble(&mut mechanism, &StartOptions::default())
        .expect("assembles")
        .q;
    let kept: Vec<usize> = (0..mechanism.layout().m).collect();
    let given = vec![None; mechanism.layout().n_v];
    let found =
        model::start::consistent_velocity(&mechanism, &StartOptions::default(), &q, &given, &kept);
    let v = found.expect("velocities").v;
    drive_limit(&mechanism, &kept, (0.0, &q, &v))
}

/// The end of the bar is at most 3 m from a winch. The winch is 2 m behind the pivot of the bar.
#[test]
fn a_winch_stops_where_its_bar_is_stretched() {
    let stretched = |angle: f64, speed: f64| {
        let mut d = Description::new("winch");
        let (end, bar) = bar(&mut d, GROUND, [0.0; 2], angle);
        let rope = DistanceLengthDrive::new([-2.0, 0.0], d.local(bar, end));
        d.drive("winch", &[GROUND, bar], rope, rate(speed));
        limit(&d)
    };
    let found = stretched(0.2, 0.1).expect("it is stretched at 3 m");
    // From the cosine law of the triangle with sides of 2 m and 1 m.
    let before = (5.0 + 4.0 * 0.2_f64.cos()).sqrt();
    assert!(
        (found.time - (3.0 - before) / 0.1).abs() < 1e-9,
        "{found:?}"
    );
    let [winch] = &found.drives[..] else {
        panic!("{found:?}")
    };
    assert!(
        (winch.value.expect("a length") - 3.0).abs() < 1e-9,
        "{winch:?}"
    );
    assert!(
        found
            .to_string()
            .ends_with("beyond 3 m: there is no configuration"),
        "{found}"
    );
    // If the winch winds up, the end of the bar moves towards the winch. Far from the stretched bar
    // there is no limit.
    assert_eq!(stretched(0.2, -0.1), None);
    assert_eq!(stretched(1.5, 0.1), None);
}

/// Two motors move the ends of a two-bar chain apart by sliders. The largest distance of the ends
/// is 2 m.
#[test]
fn two_drives_reach_as_far_as_the_arm() {
    let mut d = Description::new("two sliders");
    let apart = 2.0 * 0.1_f64.cos();
    let sliders = [[0.0, 0.0], [apart, 0.0]].map(|position| {
        let name = format!("slider {}", d.bodies.len());
        let body = d.body(Body {
            position,
            ..Body::new(&name, 1.0, 0.1)
        });
        let s_i = position;
        d.joint(
            &format!("rail of {name}"),
            &[GROUND, body],
            Translational::new(s_i, [0.0; 2], Direction::X),
        );
        (body, s_i)
    });
    let (top, first) = bar(&mut d, sliders[0].0, [0.0, 0.0], 0.1);
    let (_, second) = bar(&mut d, first, top, -0.1);
    let [s_i, s_j] = [second, sliders[1].0].map(|b| d.local(b, [apart, 0.0]));
    d.joint("end", &[second, sliders[1].0], Revolute { s_i, s_j });
    for (k, (body, s_i)) in sliders.into_iter().enumerate() {
        let drive = TranslationalDisplacementDrive::new(s_i, [0.0; 2], Direction::X);
        let speed = [-0.1, 0.3][k];
        d.drive(["left", "right"][k], &[GROUND, body], drive, rate(speed));
    }
    let found = limit(&d).expect("the chain is straight at 2 m");
    assert!((found.time - (2.0 - apart) / 0.4).abs() < 1e-9, "{found:?}");
    let names: Vec<&str> = found
        .drives
        .iter()
        .map(|drive| drive.name.as_str())
        .collect();
    assert_eq!(names, ["left", "right"]);
    assert!(
        found
            .to_string()
            .contains("drives `left` and `right` cannot continue together"),
        "{found}"
    );
}

/// An arm of two bars that rotates freely about its foot is straight at 2 m, for any angle. A crank
/// that makes full revolutions has no such limit.
#[test]
fn a_free_arm_reaches_as_far_as_it_is_long() {
    let mut d = Description::new("arm");
    let (elbow, upper) = bar(&mut d, GROUND, [0.0; 2], 0.7);
    let (hand, lower) = bar(&mut d, upper, elbow, 0.5);
    let reach = DistanceLengthDrive::new([0.0; 2], d.local(lower, hand));
    d.drive("reach", &[GROUND, lower], reach, rate(0.1));
    let found = limit(&d).expect("it is straight at 2 m");
    let value = found.drives[0].value.expect("a length");
    assert!((value - 2.0).abs() < 1e-9, "{value}");

    // Additional pendulums are also free, and have no influence.
    for place in [3.0, 4.0, 5.0] {
        bar(&mut d, GROUND, [place, 0.0], 0.3);
    }
    let beside = limit(&d).expect("it is straight at 2 m");
    assert_eq!(beside.drives.len(), 1);
    let value = beside.drives[0].value.expect("a length");
    assert!((value - 2.0).abs() < 1e-9, "{value}");

    let mut d = Description::new("crank");
    let (_, crank) = bar(&mut d, GROUND, [0.0; 2], PI / 3.0);
    let motor = RevoluteAngleDrive::new([0.0; 2], d.local(crank, [0.0; 2]));
    d.drive("motor", &[GROUND, crank], motor, rate(1.0));
    assert_eq!(limit(&d), None);
}

/// A parallelogram passes through the configuration with collinear bars, at which the branches of
/// its motion meet. Its drive can continue, from any start of the search near that configuration.
#[test]
fn branches_that_meet_are_no_limit() {
    for angle in [0.0, -1e-14, -1e-12, -1e-9, -1e-6, -1e-3] {
        let mut d = Description::new("parallelogram");
        let (left, first) = bar(&mut d, GROUND, [0.0; 2], angle);
        let (right, second) = bar(&mut d, GROUND, [2.0, 0.0], angle);
        let position = [0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])];
        let coupler = d.body(Body {
            position,
            ..Body::new("coupler", 1.0, 0.1)
        });
        for (at, crank) in [(left, first), (right, second)] {
            let [s_i, s_j] = [crank, coupler].map(|b| d.local(b, at));
            let name = format!("pin {}", d.joints.len());
            d.joint(&name, &[crank, coupler], Revolute { s_i, s_j });
        }
        let motor = RevoluteAngleDrive::new([0.0; 2], d.local(first, [0.0; 2]));
        d.drive("motor", &[GROUND, first], motor, rate(1.0));
        let mut mechanism = Mechanism::build(&d).expect("builds");
        let q = assemble(&mut mechanism, &StartOptions::default())
            .expect("assembles")
            .q;
        // All bars rotate with 1 rad/s, and the coupler moves without rotation.
        let of_crank = |x: f64| [-(0.5 * angle.sin()), 0.5 * angle.cos(), x];
        let [left, right] = [of_crank(1.0), of_crank(1.0)];
        let coupler = [-angle.sin(), angle.cos(), 0.0];
        let v = [left, right, coupler].concat();
        let kept: Vec<usize> = (0..mechanism.layout().m).collect();
        let found = drive_limit(&mechanism, &kept, (0.0, &q, &v));
        assert_eq!(found, None, "at {angle} rad");
    }
}
