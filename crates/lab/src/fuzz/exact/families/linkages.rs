//! Linkages at configurations in which bars are collinear, and parallel cranks, which are redundant
//! at all configurations.

use super::super::drawing::{GROUND, Side, Vector, along};
use super::super::ratio::Ratio;
use super::pen::Pen;

pub(super) fn linkage(pen: &mut Pen<'_>) {
    match pen.numbers.below(5) {
        0 | 1 => cranks(pen),
        2 => chain(pen),
        3 => four_bar(pen),
        _ => slider_crank(pen),
    }
}

/// Adds two to five cranks under one coupler. All cranks are equal, or one is different; some are
/// driven.
fn cranks(pen: &mut Pen<'_>) {
    let count = 2 + pen.numbers.below(4);
    let arm = pen.vector(6);
    let (coupler, is_spoilt) = (pen.body(), pen.once_in(3));
    let is_on_line = pen.once_in(4);
    let (origin, line) = (pen.point(), pen.direction());
    let pivots: Vec<Vector> = if is_on_line {
        pen.places(origin, line, count)
    } else {
        (0..count).map(|_| pen.point()).collect()
    };
    let drives = if pen.once_in(2) {
        0
    } else {
        pen.numbers.below(count + 1)
    };
    let [x, y] = [0, 1].map(|axis| pivots[1][axis] - pivots[0][axis]);
    if !is_spoilt && !(x * arm[1] - y * arm[0]).is_zero() {
        // Two cranks support the coupler, which has one degree of freedom.
        pen.drawing.redundancy = Some(count - 2 + drives.saturating_sub(1));
    }
    for (k, pivot) in pivots.into_iter().enumerate() {
        let crank = pen.body();
        let mut tip = along(pivot, Ratio::ONE, arm);
        if is_spoilt && k == 0 {
            tip = along(tip, pen.step, [Ratio::ONE, Ratio::ZERO]);
        }
        let bearing = pen.hinge([GROUND, crank], pivot);
        pen.hinge([crank, coupler], tip);
        if k < drives {
            pen.drawing.drive(bearing);
        }
    }
}

/// Adds a chain of hinges between two pivots on the ground. All hinges are on one line, the links
/// may point forward or backward, and one end is driven.
fn chain(pen: &mut Pen<'_>) {
    let n = 2 + pen.numbers.below(4);
    let (origin, line) = (pen.point(), pen.direction());
    let mut places = pen.places(origin, line, n + 1);
    if pen.once_in(3) {
        let k = pen.numbers.below(n + 1);
        places[k] = pen.beside(places[k], line);
    }
    let mut before: Side = GROUND;
    let mut first = None;
    for place in &places[..n] {
        let next = pen.body();
        let joint = pen.hinge([before, next], *place);
        first = first.or(Some(joint));
        before = next;
    }
    if !pen.once_in(4) {
        pen.hinge([before, GROUND], places[n]);
    }
    if let Some(joint) = first.filter(|_| pen.once_in(3)) {
        pen.drawing.drive(joint);
    }
    if pen.once_in(3) {
        let (far, near) = (pen.point(), places[n / 2]);
        pen.bar([GROUND, Some(pen.drawing.origins.len() - 1)], far, near);
    }
}

/// Adds a four-bar whose crank and coupler are collinear or not, with the rocker or the crank
/// locked.
fn four_bar(pen: &mut Pen<'_>) {
    let [a, d] = [pen.point(), pen.point()];
    let arm = pen.vector(4);
    let b = along(a, Ratio::ONE, arm);
    let c = match pen.numbers.below(3) {
        0 => pen.point(),
        1 => along(a, pen.whole(2, 3), arm),
        _ => along(a, -pen.whole(1, 2), arm),
    };
    let bars = [0; 3].map(|_| pen.body());
    let joints = [
        pen.hinge([GROUND, bars[0]], a),
        pen.hinge([bars[0], bars[1]], b),
        pen.hinge([bars[1], bars[2]], c),
        pen.hinge([bars[2], GROUND], d),
    ];
    for joint in joints {
        if pen.once_in(4) {
            pen.drawing.drive(joint);
        }
    }
}

/// Adds a slider-crank at a dead centre, or displaced from the dead centre by one step of the grid.
fn slider_crank(pen: &mut Pen<'_>) {
    let (pivot, way) = (pen.point(), pen.direction());
    let tip = along(pivot, pen.not_zero(3) * pen.step, way);
    let mut end: Vector = along(tip, pen.not_zero(5) * pen.step, way);
    if pen.once_in(3) {
        end = pen.beside(end, way);
    }
    let [crank, rod, slider] = [0; 3].map(|_| pen.body());
    let bearing = pen.hinge([GROUND, crank], pivot);
    pen.hinge([crank, rod], tip);
    pen.hinge([rod, slider], end);
    let k = Ratio::whole(i64::from(pen.drawing.stretch));
    let normal = [-(k * way[1]), way[0]];
    pen.slider([GROUND, slider], end, normal);
    match pen.numbers.below(3) {
        0 => pen.drawing.drive(bearing),
        // The slider is locked, and the crank is at a dead centre, at which the slider cannot
        // rotate it.
        1 => {
            let anchor = along(end, Ratio::whole(2), way);
            pen.bar([GROUND, slider], anchor, end);
        }
        _ => {}
    }
}
