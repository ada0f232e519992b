//! Submechanisms: repeated pivots and slides, cranks, chains, sliders, gears, and bodies with more
//! bars or hinges than necessary. Some submechanisms have a small misalignment. Each function
//! returns a body and a point of this body, on which another submechanism may be mounted.

use super::sketch::{Flat, Place, Side, Sketch, across, along};
use crate::fuzz::scenes::Space;

/// A body and one of its points.
pub(super) type Stand = (Side, Flat);

/// Adds a pivot of two bodies in the plane of a submechanism, in one of many forms. Most forms are
/// redundant.
pub(super) fn pivot(s: &mut Sketch<'_>, place: &Place, [a, b]: [&Side; 2], p: Flat) {
    match s.numbers.below(8) {
        0 | 1 => {
            hinge(s, place, [a, b], p, 0.0);
            hinge(s, place, [a, b], p, 0.2);
        }
        2 if s.space == Space::Plane => {
            let count = 2 + s.numbers.below(2);
            slots(s, place, [a, b], p, count);
        }
        3 if s.space == Space::Plane => {
            hinge(s, place, [a, b], p, 0.0);
            slots(s, place, [a, b], p, 1);
        }
        2 => {
            hinge(s, place, [a, b], p, 0.0);
            ball(s, place, [a, b], p, 0.3);
        }
        3 => {
            hinge(s, place, [a, b], p, 0.0);
            s.joint("cylindrical", [a, b]);
            s.at_height(place, p, -0.2);
            s.normal("axis", place);
        }
        4 if s.space == Space::Plane && a == "ground" => lines(s, place, b, p),
        _ => {
            hinge(s, place, [a, b], p, 0.0);
        }
    }
}

/// Adds a hinge at `height` above the plane; in planar scenes the height has no effect.
pub(super) fn hinge(
    s: &mut Sketch<'_>,
    place: &Place,
    pair: [&Side; 2],
    p: Flat,
    height: f64,
) -> String {
    let name = s.joint("revolute", pair);
    s.at_height(place, p, height);
    if s.space == Space::Space {
        s.normal("axis", place);
    }
    s.measured.push((name.clone(), "angle"));
    name
}

fn ball(s: &mut Sketch<'_>, place: &Place, pair: [&Side; 2], p: Flat, height: f64) {
    s.joint("spherical", pair);
    s.at_height(place, p, height);
}

/// Adds perpendicular slots with a common pin.
fn slots(s: &mut Sketch<'_>, place: &Place, pair: [&Side; 2], p: Flat, count: usize) {
    let first = s.heading();
    for k in 0..count {
        let d = match k {
            0 => first,
            1 => across(first),
            _ => s.any_heading(),
        };
        s.joint("pin-in-slot", pair);
        s.at_height(place, p, 0.0);
        s.direction("axis", place, d);
    }
}

/// Constrains a point of a body to two or three lines of the ground.
fn lines(s: &mut Sketch<'_>, place: &Place, body: &Side, p: Flat) {
    let count = 2 + s.numbers.below(2);
    for k in 0..count {
        let d = [[0.0, 1.0], [1.0, 0.0], [0.6, 0.8]][k];
        s.single("point-on-line", body);
        s.at_height(place, p, 0.0);
        let ends = [along(p, -0.5, d), along(p, 0.75, d)].map(|p| s.point(place, p));
        s.line("line", &format!("[{}, {}]", ends[0], ends[1]));
    }
}

/// Adds a slide along a direction; in half of the cases the slide is doubled.
fn slide(s: &mut Sketch<'_>, place: &Place, pair: [&Side; 2], p: Flat, d: Flat) {
    let name = s.joint("translational", pair);
    s.at_height(place, p, 0.0);
    s.direction("axis", place, d);
    s.measured.push((name, "displacement"));
    if s.numbers.once_in(2) {
        s.joint("translational", pair);
        s.at_height(place, along(p, 0.2, across(d)), 0.0);
        s.direction("axis", place, d);
    }
}

/// Adds two to four parallel cranks under a coupler.
pub(super) fn cranks(s: &mut Sketch<'_>, place: &Place, (base, at): &Stand) -> Stand {
    let (h, l) = (s.heading(), s.length(4, 10));
    let count = 2 + s.numbers.below(3);
    let width = if s.numbers.once_in(3) {
        l
    } else {
        s.length(4, 12)
    };
    let omega = s.numbers.once_in(3).then(|| s.numbers.within(-3.0, 3.0));
    let is_level = s.numbers.once_in(2);
    let pivots: Vec<Flat> = (0..count)
        .map(|k| {
            let step = if is_level || k == 0 {
                0.0
            } else {
                s.length(-3, 3)
            };
            [at[0] + width * k as f64, at[1] + step]
        })
        .collect();
    let tips: Vec<Flat> = pivots.iter().map(|p| along(*p, l, h)).collect();
    let middle = along(tips[0], 0.5 * width, [1.0, 0.0]);
    let coupler = s.body(place, middle);
    for (k, (p, tip)) in pivots.iter().zip(&tips).enumerate() {
        let own = omega.filter(|_| k == 0);
        let crank = s.moving_body(place, along(*p, 0.5 * l, h), own);
        pivot(s, place, [base, &crank], *p);
        if s.numbers.once_in(4) {
            pivot(s, place, [&crank, &coupler], *tip);
        } else {
            hinge(s, place, [&crank, &coupler], *tip, 0.0);
        }
    }
    (coupler, tips[0])
}

/// Adds one to three links with repeated pivots.
pub(super) fn chain(s: &mut Sketch<'_>, place: &Place, (base, at): &Stand) -> Stand {
    let (mut side, mut p) = (base.clone(), *at);
    for _ in 0..=s.numbers.below(3) {
        let (h, l) = (s.heading(), s.length(4, 10));
        let omega = s.numbers.once_in(4).then(|| s.numbers.within(-3.0, 3.0));
        let link = s.moving_body(place, along(p, 0.5 * l, h), omega);
        pivot(s, place, [&side, &link], p);
        (side, p) = (link, along(p, l, h));
    }
    (side, p)
}

/// Adds a body on a slide, in half of the cases with a crank and a rod.
pub(super) fn slider(s: &mut Sketch<'_>, place: &Place, (base, at): &Stand) -> Stand {
    let d = s.heading();
    if s.numbers.once_in(2) {
        let block = s.body(place, *at);
        slide(s, place, [base, &block], *at, d);
        return (block, *at);
    }
    let (h, l) = (s.any_heading(), s.length(4, 8));
    let tip = along(*at, l, h);
    // The rod connects the tip of the crank to the line of the slider, which passes through the
    // pivot of the crank.
    let rod = l * s.one(&[1.5, 2.0, 2.25]);
    let off = tip[0] * d[1] - tip[1] * d[0] - (at[0] * d[1] - at[1] * d[0]);
    let reach = (rod * rod - off * off).max(0.04).sqrt();
    let foot = along(tip, -off, [d[1], -d[0]]);
    let pin = along(foot, reach, d);
    let crank = s.body(place, along(*at, 0.5 * l, h));
    let bar = s.body(place, [0.5 * (tip[0] + pin[0]), 0.5 * (tip[1] + pin[1])]);
    let block = s.body(place, pin);
    pivot(s, place, [base, &crank], *at);
    hinge(s, place, [&crank, &bar], tip, 0.0);
    pivot(s, place, [&bar, &block], pin);
    slide(s, place, [base, &block], pin, d);
    (block, pin)
}

/// Adds wheels on pins of a body; in half of the cases the train of gears is closed.
pub(super) fn gears(s: &mut Sketch<'_>, place: &Place, (base, at): &Stand) -> Stand {
    let radii = [0.1, s.one(&[0.1, 0.2]), 0.15];
    let (mut wheels, mut pins) = (Vec::new(), Vec::new());
    let mut p = *at;
    for (k, r) in radii.iter().enumerate() {
        if k > 0 {
            p = along(p, radii[k - 1] + r, [1.0, 0.0]);
        }
        let omega = (k == 0 && s.numbers.once_in(2)).then_some(2.0);
        let wheel = s.moving_body(place, p, omega);
        pins.push(hinge(s, place, [base, &wheel], p, 0.0));
        if s.numbers.once_in(2) {
            hinge(s, place, [base, &wheel], p, 0.2);
        }
        wheels.push(wheel);
    }
    let mut pairs = vec![
        ([0, 1], -radii[0] / radii[1]),
        ([1, 2], -radii[1] / radii[2]),
    ];
    if s.numbers.once_in(2) {
        pairs.push(([0, 2], radii[0] / radii[2]));
    }
    for ([a, b], ratio) in pairs {
        if s.space == Space::Plane {
            s.joint("gear", [&wheels[a], &wheels[b]]);
            s.line("carrier", &format!("\"{base}\""));
        } else {
            s.coupling([&pins[a], &pins[b]]);
        }
        s.line("ratio", &format!("{ratio:?}"));
    }
    (wheels[2].clone(), p)
}

/// Adds a body on bars; some bars are redundant. There are three to five bars in the plane, and six
/// to eight bars in space.
pub(super) fn braced(s: &mut Sketch<'_>, place: &Place, (base, at): &Stand) -> Stand {
    let far = along(*at, 0.6, s.heading());
    let body = s.body(place, far);
    let is_flat = s.space == Space::Plane;
    let least = if is_flat { 3 } else { 6 };
    for _ in 0..least + s.numbers.below(3) {
        let foot = along(*at, s.length(2, 8), s.heading());
        let head = along(far, s.length(1, 4), s.any_heading());
        if is_flat {
            s.bar(place, [base, &body], [foot, head]);
        } else {
            let heights = [0.1, 0.6].map(|h| h * s.numbers.within(-1.0, 1.0));
            let ends = [(foot, heights[0]), (head, heights[1])];
            s.bar_in_space(place, [base, &body], ends);
        }
    }
    (body, far)
}

/// Adds a body that is locked by a misalignment of some tenths of a millimetre. The body has hinges
/// in a row, and one hinge is displaced from the axis; or the body has a pin and a bar, and the
/// line of the bar nearly passes through the pin.
pub(super) fn slightly_off(s: &mut Sketch<'_>, place: &Place, (base, at): &Stand) -> Stand {
    let h = s.heading();
    let far = along(*at, 0.6, h);
    let off = s.one(&[1e-4, 3e-4, 1e-3, 3e-3]);
    let body = s.body(place, far);
    if s.space == Space::Plane {
        pivot(s, place, [base, &body], *at);
        let from = along(along(*at, off, across(h)), -0.3, h);
        s.bar(place, [base, &body], [from, along(from, 0.8, h)]);
    } else {
        let count = 3 + s.numbers.below(2);
        let which = s.numbers.below(count);
        for k in 0..count {
            let p = if k == which { along(*at, off, h) } else { *at };
            hinge(s, place, [base, &body], p, 0.25 * k as f64);
        }
    }
    (body, far)
}
