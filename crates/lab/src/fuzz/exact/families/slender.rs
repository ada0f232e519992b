//! Drawings of full rank near a lower rank: displaced pins, dead centres, lines at small angles,
//! thin loops. If the tolerance is at most a third of the distance from the lower rank, the program
//! must not report redundant rows.

use suite::numbers::Numbers;

use super::super::drawing::{Drawing, GROUND, Side, Tie, Vector, along};
use super::super::ratio::Ratio;
use super::pen::Pen;

/// A kind of drawings near a lower rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slender {
    /// Parallel cranks with one displaced pin.
    OffsetCrank,
    /// Two pins of one door.
    OffsetPin,
    /// A four-bar near its dead centre, with its rocker locked.
    DeadCentre,
    /// A slider-crank near its dead centre, with its slider locked.
    SliderCrank,
    /// A bar supported by two other bars whose lines nearly meet on the line of the first bar.
    ThinTriangle,
    /// A parallelogram with short sides.
    ThinLoop,
    /// Knife edges with a small angle between their normals.
    SteepEdges,
    /// A slot at a small angle to a slider.
    SteepSlot,
    /// Steered wheels that are nearly straight.
    Steering,
    /// A closed train of gears for which the product of the ratios is nearly one.
    Train,
}

impl Slender {
    /// All kinds.
    pub const ALL: [Self; 10] = [
        Self::OffsetCrank,
        Self::OffsetPin,
        Self::DeadCentre,
        Self::SliderCrank,
        Self::ThinTriangle,
        Self::ThinLoop,
        Self::SteepEdges,
        Self::SteepSlot,
        Self::Steering,
        Self::Train,
    ];

    /// Returns the name of the kind.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::OffsetCrank => "offset cranks",
            Self::OffsetPin => "offset pins",
            Self::DeadCentre => "dead centres",
            Self::SliderCrank => "slider-cranks",
            Self::ThinTriangle => "thin triangles",
            Self::ThinLoop => "thin loops",
            Self::SteepEdges => "steep edges",
            Self::SteepSlot => "steep slots",
            Self::Steering => "steering near zero",
            Self::Train => "nearly closed trains",
        }
    }

    /// Returns a drawing of the kind.
    #[must_use]
    pub fn draw(self, numbers: &mut Numbers) -> Drawing {
        let mut pen = Pen::new(numbers);
        pen.drawing.stretch = 1;
        match self {
            Self::OffsetCrank => offset_crank(&mut pen),
            Self::OffsetPin => offset_pin(&mut pen),
            Self::DeadCentre => dead_centre(&mut pen),
            Self::SliderCrank => held_slider_crank(&mut pen),
            Self::ThinTriangle => thin_triangle(&mut pen),
            Self::ThinLoop => thin_loop(&mut pen),
            Self::SteepEdges => steep_edges(&mut pen),
            Self::SteepSlot => steep_slot(&mut pen),
            Self::Steering => steering(&mut pen),
            Self::Train => train(&mut pen),
        }
        pen.drawing
    }
}

fn quarter([x, y]: Vector) -> Vector {
    [-y, x]
}

/// Returns a random number from 1e-4 to 5e-2, with either sign.
fn little(pen: &mut Pen<'_>) -> Ratio {
    let [n, d] = [
        [1, 2, 5][pen.numbers.below(3)],
        [100, 1_000, 10_000][pen.numbers.below(3)],
    ];
    let sign = 1 - 2 * pen.numbers.below(2) as i128;
    Ratio::new(sign * n, d)
}

/// Returns a vector of the grid, rotated by a small angle.
fn turned(pen: &mut Pen<'_>, v: Vector) -> Vector {
    let little = little(pen);
    along(v, little, quarter(v))
}

fn offset_crank(pen: &mut Pen<'_>) {
    let (arm, coupler) = (pen.vector(6), pen.body());
    let pivots: Vec<Vector> = if pen.once_in(2) {
        let (origin, line) = (pen.point(), pen.direction());
        pen.places(origin, line, 3)
    } else {
        (0..3).map(|_| pen.point()).collect()
    };
    for (k, pivot) in pivots.into_iter().enumerate() {
        let crank = pen.body();
        let pin = match k {
            2 => {
                let (little, off) = (little(pen), pen.vector(3));
                along(pivot, little, off)
            }
            _ => pivot,
        };
        pen.hinge([GROUND, crank], pin);
        pen.hinge([crank, coupler], along(pivot, Ratio::ONE, arm));
    }
}

fn offset_pin(pen: &mut Pen<'_>) {
    let door = pen.body();
    let base = if pen.once_in(2) { pen.body() } else { GROUND };
    let (at, off, little) = (pen.point(), pen.vector(5), little(pen));
    pen.hinge([base, door], at);
    let beside = along(at, little, off);
    if pen.once_in(3) {
        let u = pen.direction();
        let axis = pen.drawing.across(u);
        let from = pen.on_line(beside, axis, 2);
        pen.link(
            &[base, door],
            Tie::PinInSlot {
                from,
                at: beside,
                along: u,
            },
        );
    } else {
        // The row along the line of the pins is omitted, because it would be redundant.
        let u = quarter(off);
        let from = beside;
        pen.link(
            &[base, door],
            Tie::PinInSlot {
                from,
                at: beside,
                along: u,
            },
        );
    }
    if pen.once_in(2) {
        // A further well-constrained part makes the whole drawing larger.
        let (far, end) = (pen.point(), pen.point());
        let other = pen.body();
        pen.hinge([door, other], far);
        pen.bar([GROUND, other], end, along(far, Ratio::ONE, quarter(off)));
    }
}

fn dead_centre(pen: &mut Pen<'_>) {
    let (a, arm) = (pen.point(), pen.vector(4));
    let b = along(a, Ratio::ONE, arm);
    let bent = turned(pen, arm);
    let share = pen.not_zero(3);
    let c = along(b, share, bent);
    let d = along(pen.point(), pen.step, quarter(arm));
    let bars = [0; 3].map(|_| pen.body());
    pen.hinge([GROUND, bars[0]], a);
    pen.hinge([bars[0], bars[1]], b);
    pen.hinge([bars[1], bars[2]], c);
    let bearing = pen.hinge([bars[2], GROUND], d);
    if pen.once_in(2) {
        pen.drawing.drive(bearing);
    } else {
        let across = quarter([c[0] - d[0], c[1] - d[1]]);
        pen.bar([bars[2], GROUND], c, along(c, Ratio::whole(2), across));
    }
}

fn held_slider_crank(pen: &mut Pen<'_>) {
    let (pivot, way) = (pen.point(), pen.vector(3));
    let bent = turned(pen, way);
    let (first, second) = (pen.not_zero(3), pen.not_zero(5));
    let tip = along(pivot, first, bent);
    let end = along(pivot, first + second, way);
    let [crank, rod, slider] = [0; 3].map(|_| pen.body());
    pen.hinge([GROUND, crank], pivot);
    pen.hinge([crank, rod], tip);
    pen.hinge([rod, slider], end);
    pen.slider([GROUND, slider], end, quarter(way));
    let anchor = along(end, Ratio::whole(2), way);
    pen.bar([GROUND, slider], anchor, end);
}

fn thin_triangle(pen: &mut Pen<'_>) {
    let (node, line) = (pen.point(), pen.vector(4));
    let body = pen.drawing.body_at(node);
    let bent = turned(pen, line);
    let (first, second) = (pen.not_zero(4), pen.not_zero(4));
    pen.bar([GROUND, body], along(node, first, line), node);
    pen.bar([GROUND, body], along(node, second, bent), node);
}

fn thin_loop(pen: &mut Pen<'_>) {
    let (a, long) = (pen.point(), pen.vector(6));
    let (little, side) = (little(pen), pen.vector(5));
    let [b, c, d] = [
        along(a, Ratio::ONE, long),
        along(along(a, Ratio::ONE, long), little, side),
        along(a, little, side),
    ];
    let bars = [0; 3].map(|_| pen.body());
    pen.hinge([GROUND, bars[0]], a);
    pen.hinge([bars[0], bars[1]], b);
    pen.hinge([bars[1], bars[2]], c);
    pen.hinge([bars[2], GROUND], d);
}

fn steep_edges(pen: &mut Pen<'_>) {
    let (body, at, normal) = (pen.body(), pen.point(), pen.vector(4));
    let other = if pen.once_in(2) {
        pen.on_line(at, normal, 5)
    } else {
        at
    };
    let bent = turned(pen, normal);
    pen.link(&[body], Tie::KnifeEdge { at, along: normal });
    pen.link(
        &[body],
        Tie::KnifeEdge {
            at: other,
            along: bent,
        },
    );
    if pen.once_in(2) {
        let far = pen.point();
        pen.link(
            &[body],
            Tie::KnifeEdge {
                at: along(far, pen.step, normal),
                along: quarter(normal),
            },
        );
    }
}

fn steep_slot(pen: &mut Pen<'_>) {
    let (body, at, u) = (pen.body(), pen.point(), pen.vector(4));
    let base = if pen.once_in(2) { pen.body() } else { GROUND };
    pen.slider([base, body], at, u);
    let bent = turned(pen, u);
    let (pin, axis) = (pen.point(), pen.drawing.across(bent));
    let from = pen.on_line(pin, axis, 3);
    pen.link(
        &[base, body],
        Tie::PinInSlot {
            from,
            at: pin,
            along: bent,
        },
    );
}

/// Adds a rear wheel, and two front wheels with equal steering angles, so that the axles have no
/// common centre of rotation.
fn steering(pen: &mut Pen<'_>) {
    let (rear, ahead) = (pen.point(), pen.vector(5));
    let side = quarter(ahead);
    let chassis = pen.drawing.body_at(rear);
    pen.link(
        &[chassis],
        Tie::KnifeEdge {
            at: rear,
            along: side,
        },
    );
    let bent = turned(pen, side);
    let is_forked = pen.once_in(2);
    for share in [Ratio::new(1, 3), Ratio::new(-1, 3)] {
        let at = along(along(rear, Ratio::ONE, ahead), share, side);
        let steered: Side = if is_forked {
            let fork = pen.body();
            let pivot = pen.hinge([chassis, fork], at);
            pen.drawing.drive(pivot);
            fork
        } else {
            chassis
        };
        pen.link(&[steered], Tie::KnifeEdge { at, along: bent });
    }
}

fn train(pen: &mut Pen<'_>) {
    let wheels: Vec<Side> = (0..2 + pen.numbers.below(2))
        .map(|_| {
            let at = pen.point();
            let wheel = pen.drawing.body_at(at);
            pen.hinge([GROUND, wheel], at);
            wheel
        })
        .collect();
    let mut product = Ratio::ONE;
    for pair in wheels.windows(2) {
        let ratio = Ratio::new([-1, -2, 3][pen.numbers.below(3)], 2);
        pen.link(&[pair[0], pair[1], GROUND], Tie::Gear { ratio });
        product = product * ratio;
    }
    let ratio = product * (Ratio::ONE + little(pen));
    pen.link(
        &[wheels[0], wheels[wheels.len() - 1], GROUND],
        Tie::Gear { ratio },
    );
}
