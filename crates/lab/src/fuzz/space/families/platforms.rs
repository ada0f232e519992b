//! Platforms on rods and legs. Rods can spin about their axes, and lines of force can be dependent.

use super::super::catalogue::translational;
use super::super::drawing::{Kind, Measure};
use super::super::ratio::Ratio;
use super::super::vector::Vector;
use super::pen::Pen;

pub(super) fn platforms(pen: &mut Pen<'_>) {
    match pen.numbers.below(4) {
        0 | 1 => bars(pen),
        2 => rods(pen),
        _ => legs(pen),
    }
}

/// Returns the ends of n bars. Each bar has one end on the base and one end on the platform.
fn ends(pen: &mut Pen<'_>, n: usize) -> Vec<[Vector; 2]> {
    let way = pen.numbers.below(6);
    let (zero, height) = (Ratio::zero(), &pen.whole(1, 6) * &pen.step);
    let (centre, common) = (pen.point(), pen.direction());
    let mut ends: Vec<[Vector; 2]> = Vec::new();
    while ends.len() < n {
        let (low, high) = (pen.point_at(&zero), pen.point_at(&height));
        let factor = &pen.not_zero(3) * &pen.step;
        let pair = match way {
            // The lines pass through one point, are parallel, or all intersect one line.
            0 => [centre.clone(), high],
            1 => [low.clone(), low.along(&factor, &common)],
            2 => [centre.along(&factor, &common), high],
            // The lines are in one plane.
            3 => [pen.point_at(&zero), low],
            _ => [low, high],
        };
        if pair[0] != pair[1] && !ends.contains(&pair) {
            ends.push(pair);
        }
    }
    ends
}

/// Draws massless bars.
fn bars(pen: &mut Pen<'_>) {
    let (base, platform) = (pen.base, pen.body());
    let n = 4 + pen.numbers.below(4);
    for [from, at] in ends(pen, n) {
        pen.joint([base, platform], Kind::Distance { from, at });
    }
    pen.unknown();
}

/// Draws the bars as bodies between spherical joints, so that each bar can spin freely. Some bars
/// have a universal joint at one end.
fn rods(pen: &mut Pen<'_>) {
    let (base, platform) = (pen.base, pen.body());
    let n = 2 + pen.numbers.below(5);
    for [low, high] in ends(pen, n) {
        let first = if pen.once_in(3) {
            let first = pen.across(&(&high - &low));
            let second = pen.across(&first);
            Kind::Universal {
                at: low,
                first,
                second,
            }
        } else {
            Kind::Spherical { at: low }
        };
        pen.chain(base, platform, &[first, Kind::Spherical { at: high }]);
    }
    pen.unknown();
}

/// Draws legs with a universal, a translational and a spherical joint, driven or not.
fn legs(pen: &mut Pen<'_>) {
    let (base, platform) = (pen.base, pen.body());
    let n = 3 + pen.numbers.below(3);
    let is_driven = pen.once_in(2);
    for [low, high] in ends(pen, n) {
        let leg = &high - &low;
        let first = pen.across(&leg);
        let kinds = [
            Kind::Universal {
                at: low.clone(),
                second: leg.cross(&first),
                first,
            },
            translational(&low.along(&Ratio::new(1, 2), &leg), &leg),
            Kind::Spherical { at: high },
        ];
        let (_, joint) = pen.chain(base, platform, &kinds);
        if is_driven {
            pen.drive(joint + 1, Measure::Displacement);
        }
    }
    // A leg without a drive does not constrain the six degrees of freedom of the platform.
    pen.expects(0);
}
