//! Carriers of submechanisms: the ground, bases that rotate or slide, vehicles.

use super::pieces::{Stand, hinge};
use super::sketch::{Flat, Place, Sketch, ground};
use crate::fuzz::scenes::Space;

/// A carrier of submechanisms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Carrier {
    Ground,
    Turning,
    Sliding,
    Vehicle,
}

impl Carrier {
    pub(super) const ALL: [Self; 4] = [Self::Ground, Self::Turning, Self::Sliding, Self::Vehicle];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ground => "on the ground",
            Self::Turning => "on a turning base",
            Self::Sliding => "on a sliding base",
            Self::Vehicle => "on a vehicle",
        }
    }

    /// Draws the carrier; returns its bodies.
    pub(super) fn draw(self, s: &mut Sketch<'_>, place: &Place) -> Stand {
        match self {
            Self::Ground => (ground(), [0.0; 2]),
            Self::Turning => turning(s, place),
            Self::Sliding => sliding(s, place),
            Self::Vehicle => vehicle(s, place),
        }
    }
}

/// Returns a drive motion with rates of about `size` per second.
fn motion(s: &mut Sketch<'_>, size: f64) -> String {
    let x = size * s.numbers.within(0.5, 2.0);
    match s.numbers.below(4) {
        0 => format!("{{ type = \"constant-rate\", rate = {x:?} }}"),
        1 => format!(
            "{{ type = \"steps\", steps = [{{ from = 0.1, to = 0.4, by = {:?} }}] }}",
            0.5 * x
        ),
        2 => format!(
            "{{ type = \"harmonic\", amplitude = {:?}, omega = 3.0 }}",
            0.3 * x
        ),
        _ => format!("{{ type = \"polynomial\", coefficients = [0.0, {x:?}, 0.5] }}"),
    }
}

/// Drives one of the joint coordinates with probability 1/`chance`.
pub(super) fn drive_one(s: &mut Sketch<'_>, from: usize, chance: usize) {
    let measured = s.measured[from..].to_vec();
    if measured.is_empty() || !s.numbers.once_in(chance) {
        return;
    }
    let (joint, measure) = s.one(&measured.iter().collect::<Vec<_>>());
    let size = if *measure == "angle" { 1.0 } else { 0.3 };
    let motion = motion(s, size);
    s.drive(joint, measure, &motion);
}

fn turning(s: &mut Sketch<'_>, place: &Place) -> Stand {
    let is_driven = s.numbers.once_in(2);
    let omega = (!is_driven).then(|| s.numbers.within(-2.0, 2.0));
    let base = s.moving_body(place, [0.1, 0.0], omega);
    let first = s.measured.len();
    hinge(s, place, [&ground(), &base], [0.0; 2], 0.0);
    if is_driven {
        drive_one(s, first, 1);
    }
    (base, [0.2, 0.1])
}

fn sliding(s: &mut Sketch<'_>, place: &Place) -> Stand {
    let d: Flat = s.heading();
    let base = s.body(place, [0.1, 0.1]);
    let name = s.joint("translational", [&ground(), &base]);
    s.at_height(place, [0.0; 2], 0.0);
    s.direction("axis", place, d);
    s.measured.push((name, "displacement"));
    let first = s.measured.len() - 1;
    drive_one(s, first, 2);
    (base, [0.0; 2])
}

/// Draws a chassis on two to four wheels that prevent sideways motion, and in half of the cases one
/// axle is steered. In space, the chassis is also constrained to the given plane. The chassis moves
/// at up to 1.5 m/s. Without a steered axle it may also rotate about a separate point.
fn vehicle(s: &mut Sketch<'_>, place: &Place) -> Stand {
    let is_steered = s.numbers.once_in(2);
    let (speed, turn) = (s.numbers.within(0.2, 1.5), s.numbers.within(-1.5, 1.5));
    let chassis = s.body(place, [0.3, 0.0]);
    if is_steered {
        s.velocity(place, [speed, 0.0], 0.0);
    } else {
        s.velocity(place, [speed, 0.3 * turn], turn);
    }
    if s.space == Space::Space {
        s.joint("planar", [&ground(), &chassis]);
        s.at_height(place, [0.0; 2], 0.0);
        s.normal("normal", place);
    }
    for k in 0..2 + s.numbers.below(2) {
        edge(s, place, &chassis, [0.0, 0.25 * (1.0 - k as f64)]);
    }
    if is_steered {
        let front = s.body(place, [0.9, 0.0]);
        let first = s.measured.len();
        hinge(s, place, [&chassis, &front], [0.9, 0.0], 0.0);
        drive_one(s, first, 1);
        for y in [0.2, -0.2] {
            edge(s, place, &front, [0.9, y]);
        }
    }
    (chassis, [0.4, 0.0])
}

/// Adds a knife edge that prevents motion perpendicular to the direction of travel, which is the
/// first axis of the plane.
fn edge(s: &mut Sketch<'_>, place: &Place, body: &str, p: Flat) {
    s.single("knife-edge", &body.to_owned());
    s.at_height(place, p, 0.0);
    s.direction("normal", place, [0.0, 1.0]);
}
