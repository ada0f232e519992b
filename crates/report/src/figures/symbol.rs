//! Symbols of joints and drives, in pixels around their place. The mark of the verdict fills them.

use super::style::{GREY, INK, Mark};
use super::svg::{Svg, point_list};

/// What a joint leaves free, as a picture. Directions are global unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Symbol {
    /// Two points coincide.
    Pin,
    /// Nothing is free.
    Weld,
    /// A block on a straight guide.
    Block { axis: [f64; 2] },
    /// A pin in a straight slot.
    Slot { axis: [f64; 2] },
    /// Two points keep their distance.
    Rod,
    /// A blade or wheel, seen from above.
    Edge { along: [f64; 2] },
    /// Rotations depend on each other.
    Rotation,
    /// A prescribed motion along an axis, or about the place.
    Drive { axis: Option<[f64; 2]> },
}

/// Half the sides of symbols (px).
const PIN: f64 = 6.5;
const WELD: f64 = 6.5;
const BLOCK: [f64; 2] = [12.0, 7.5];
const GUIDE: f64 = 27.0;
const SLOT: [f64; 2] = [18.0, 7.0];
const ROD_END: f64 = 4.5;
const EDGE: [f64; 2] = [18.0, 4.2];
const ROTATION: f64 = 8.5;
/// Half the length of the arrow of a drive, half its width, and its distance from the axis.
const ARROW: [f64; 3] = [19.0, 6.5, 19.0];
/// Radius of the arrow of a rotary drive.
const TURN: f64 = 15.0;

impl Symbol {
    /// Painted first are those that would hide others.
    pub(super) fn layer(self) -> usize {
        match self {
            Self::Rod => 0,
            Self::Block { .. } | Self::Slot { .. } => 1,
            Self::Edge { .. } => 2,
            Self::Rotation | Self::Weld => 3,
            Self::Drive { .. } => 4,
            Self::Pin => 5,
        }
    }

    /// The same symbol lying along x, for a legend.
    pub(super) fn lying(self) -> Self {
        let x = [1.0, 0.0];
        match self {
            Self::Block { .. } => Self::Block { axis: x },
            Self::Slot { .. } => Self::Slot { axis: x },
            Self::Edge { .. } => Self::Edge { along: x },
            Self::Drive { axis: Some(_) } => Self::Drive { axis: Some(x) },
            other => other,
        }
    }

    /// Centre of the symbol relative to its place (px): arrows of drives stand beside their joints.
    pub(super) fn offset(self) -> [f64; 2] {
        match self {
            Self::Drive { axis: Some(axis) } => {
                // To the right of a vertical axis, below a horizontal one.
                let normal = [-axis[1], -axis[0]];
                let sign = if normal[0] < -1e-6 || (normal[0] < 1e-6 && normal[1] < 0.0) {
                    -1.0
                } else {
                    1.0
                };
                [sign * ARROW[2] * normal[0], sign * ARROW[2] * normal[1]]
            }
            _ => [0.0, 0.0],
        }
    }

    /// Half the sides of its bounding box on the page (px).
    pub(super) fn half_box(self) -> [f64; 2] {
        let turned = |[x, y]: [f64; 2], [c, s]: [f64; 2]| {
            [x * c.abs() + y * s.abs(), x * s.abs() + y * c.abs()]
        };
        match self {
            Self::Pin => [PIN, PIN],
            Self::Weld => [WELD, WELD],
            Self::Block { axis } => turned(BLOCK, axis),
            Self::Slot { axis } => turned(SLOT, axis),
            Self::Rod => [ROD_END, ROD_END],
            Self::Edge { along } => turned(EDGE, along),
            Self::Rotation => [ROTATION, ROTATION],
            Self::Drive { axis: Some(axis) } => turned([ARROW[0], ARROW[1]], axis),
            Self::Drive { axis: None } => [TURN, TURN],
        }
    }

    /// Draws it at a place of the page; `end` is the point of the other body.
    pub(super) fn draw(self, svg: &mut Svg, place: [f64; 2], end: [f64; 2], mark: Mark) {
        match self {
            Self::Rod => return rod(svg, place, end, mark),
            Self::Block { .. } | Self::Slot { .. } => guide(svg, place, end),
            _ => {}
        }
        let offset = self.offset();
        let centre = [place[0] + offset[0], place[1] + offset[1]];
        let transform = format!(
            "translate({:.2} {:.2}) rotate({:.2})",
            centre[0],
            centre[1],
            self.angle()
        );
        svg.element("g")
            .with("transform", &transform)
            .with("fill", mark.fill())
            .with("stroke", mark.stroke())
            .with("stroke-width", "1.6")
            .with("stroke-dasharray", mark.dashes())
            .with("stroke-linejoin", "round")
            .open();
        match self {
            Self::Pin => circle(svg, PIN),
            Self::Weld => {
                rectangle(svg, [WELD, WELD], 0.0);
                let (a, b) = (WELD, -WELD);
                path(svg, &format!("M{b},{b} L{a},{a} M{b},{a} L{a},{b}"));
            }
            Self::Block { .. } => {
                guide(svg, [-GUIDE, 0.0], [GUIDE, 0.0]);
                rectangle(svg, BLOCK, 1.5);
            }
            Self::Slot { .. } => {
                svg.element("g").with("fill", "#ffffff").open();
                rectangle(svg, SLOT, SLOT[1]);
                svg.close();
                circle(svg, SLOT[1] - 2.0);
            }
            Self::Edge { .. } => rectangle(svg, EDGE, 2.5),
            Self::Rotation => {
                circle(svg, ROTATION);
                circle(svg, 2.0);
            }
            Self::Drive { axis: Some(_) } => polygon(svg, &double_arrow()),
            Self::Drive { axis: None } => polygon(svg, &turning_arrow()),
            Self::Rod => {}
        }
        svg.close();
    }

    /// Angle on the page (degrees, clockwise because y points down there).
    fn angle(self) -> f64 {
        match self {
            Self::Block { axis: [x, y] }
            | Self::Slot { axis: [x, y] }
            | Self::Edge { along: [x, y] }
            | Self::Drive { axis: Some([x, y]) } => (-y).atan2(x).to_degrees(),
            _ => 0.0,
        }
    }
}

/// The foot of a joint that holds to the ground, below its place.
pub(super) fn ground(svg: &mut Svg, [x, y]: [f64; 2]) {
    svg.element("g")
        .with("transform", &format!("translate({x:.2} {y:.2})"))
        .with("stroke", INK)
        .with("stroke-width", "1.2")
        .open();
    svg.element("path")
        .with("d", "M0,0 L-9,14 L9,14 Z")
        .with("fill", "#ffffff")
        .with("stroke-linejoin", "round")
        .empty();
    svg.element("path")
        .with(
            "d",
            "M-15,14 L15,14 M-9,14 l-5,6 M-3,14 l-5,6 M3,14 l-5,6 M9,14 l-5,6 M15,14 l-5,6",
        )
        .with("fill", "none")
        .empty();
    svg.close();
}

/// Extent of the foot of the ground below a place (px).
pub(super) const GROUND_DEPTH: f64 = 20.0;

fn rod(svg: &mut Svg, a: [f64; 2], b: [f64; 2], mark: Mark) {
    svg.element("line")
        .at([("x1", a[0]), ("y1", a[1]), ("x2", b[0]), ("y2", b[1])])
        .with("stroke", mark.stroke())
        .with("stroke-width", "2.4")
        .with("stroke-dasharray", mark.dashes())
        .empty();
    for [x, y] in [a, b] {
        svg.element("circle")
            .at([("cx", x), ("cy", y), ("r", ROD_END)])
            .with("fill", mark.fill())
            .with("stroke", mark.stroke())
            .with("stroke-width", "1.6")
            .empty();
    }
}

/// A dash-dotted centre line.
fn guide(svg: &mut Svg, a: [f64; 2], b: [f64; 2]) {
    svg.element("line")
        .at([("x1", a[0]), ("y1", a[1]), ("x2", b[0]), ("y2", b[1])])
        .with("stroke", GREY)
        .with("stroke-width", "1.2")
        .with("stroke-dasharray", "8 2.5 2 2.5")
        .empty();
}

/// A circle that rolls, dash-dotted.
pub(super) fn pitch_circle(svg: &mut Svg, [x, y]: [f64; 2], radius: f64) {
    svg.element("circle")
        .at([("cx", x), ("cy", y), ("r", radius)])
        .with("fill", "none")
        .with("stroke", GREY)
        .with("stroke-width", "1")
        .with("stroke-dasharray", "8 2.5 2 2.5")
        .empty();
}

fn circle(svg: &mut Svg, radius: f64) {
    svg.element("circle").at([("r", radius)]).empty();
}

fn rectangle(svg: &mut Svg, [x, y]: [f64; 2], corner: f64) {
    svg.element("rect")
        .at([
            ("x", -x),
            ("y", -y),
            ("width", 2.0 * x),
            ("height", 2.0 * y),
            ("rx", corner),
        ])
        .empty();
}

fn path(svg: &mut Svg, d: &str) {
    svg.element("path").with("d", d).empty();
}

fn polygon(svg: &mut Svg, points: &[[f64; 2]]) {
    svg.element("polygon")
        .with("points", &point_list(points.iter().copied()))
        .empty();
}

fn double_arrow() -> Vec<[f64; 2]> {
    let [l, w, _] = ARROW;
    let (neck, shaft) = (l - 9.0, 0.4 * w);
    let upper = [
        [-l, 0.0],
        [-neck, -w],
        [-neck, -shaft],
        [neck, -shaft],
        [neck, -w],
        [l, 0.0],
    ];
    let lower = [[neck, w], [neck, shaft], [-neck, shaft], [-neck, w]];
    upper.into_iter().chain(lower).collect()
}

/// Three quarters of a turn, counter-clockwise on the page.
fn turning_arrow() -> Vec<[f64; 2]> {
    const STEPS: usize = 24;
    let (outer, inner) = (TURN - 2.0, TURN - 6.0);
    let at = |radius: f64, angle: f64| [radius * angle.cos(), -radius * angle.sin()];
    let angle = |k: usize| (-30.0 + 240.0 * k as f64 / STEPS as f64).to_radians();
    let (middle, tip) = (0.5 * (outer + inner), 0.5);
    let mut points: Vec<[f64; 2]> = (0..=STEPS).map(|k| at(outer, angle(k))).collect();
    points.push(at(middle + 5.5, angle(STEPS)));
    points.push(at(middle, angle(STEPS) + tip));
    points.push(at(middle - 5.5, angle(STEPS)));
    points.extend((0..=STEPS).rev().map(|k| at(inner, angle(k))));
    points
}
