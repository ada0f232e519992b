//! Curves with markers.

use super::plot::{Frame, Sample};
use super::style::Style;
use super::svg::{Svg, point_list};

/// Half the size of a marker (px).
const HALF: f64 = 3.4;

/// Appearance of a curve. The index of a curve determines both colour and marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Look(usize);

impl Look {
    pub(super) fn nth(place: usize) -> Self {
        Self(place)
    }

    fn colour(self) -> &'static str {
        Style {
            colour: self.0,
            ..Style::default()
        }
        .colour()
    }

    /// Outline of the marker around the origin.
    fn marker(self) -> &'static [[f64; 2]] {
        const SHAPES: [&[[f64; 2]]; 7] = [
            // circle (an octagon), square, triangle, diamond, triangle pointing down, cross,
            // three-pointed star
            &[
                [1.0, 0.41],
                [0.41, 1.0],
                [-0.41, 1.0],
                [-1.0, 0.41],
                [-1.0, -0.41],
                [-0.41, -1.0],
                [0.41, -1.0],
                [1.0, -0.41],
            ],
            &[[0.9, 0.9], [-0.9, 0.9], [-0.9, -0.9], [0.9, -0.9]],
            &[[0.0, -1.25], [1.15, 0.85], [-1.15, 0.85]],
            &[[0.0, -1.35], [1.2, 0.0], [0.0, 1.35], [-1.2, 0.0]],
            &[[0.0, 1.25], [1.15, -0.85], [-1.15, -0.85]],
            &[
                [0.4, 0.4],
                [0.4, 1.25],
                [-0.4, 1.25],
                [-0.4, 0.4],
                [-1.25, 0.4],
                [-1.25, -0.4],
                [-0.4, -0.4],
                [-0.4, -1.25],
                [0.4, -1.25],
                [0.4, -0.4],
                [1.25, -0.4],
                [1.25, 0.4],
            ],
            &[[1.3, 0.4], [-1.3, 0.4], [-1.3, -0.4], [1.3, -0.4]],
        ];
        SHAPES[self.0 % SHAPES.len()]
    }

    fn mark(self, svg: &mut Svg, [x, y]: [f64; 2]) {
        let outline = self
            .marker()
            .iter()
            .map(|[u, v]| [x + HALF * u, y + HALF * v]);
        svg.element("polygon")
            .with("points", &point_list(outline))
            .with("fill", self.colour())
            .empty();
    }

    fn line(self, svg: &mut Svg, points: &[[f64; 2]]) {
        svg.element("polyline")
            .with("points", &point_list(points.iter().copied()))
            .with("fill", "none")
            .with("stroke", self.colour())
            .with("stroke-width", "1.5")
            .with("stroke-linejoin", "round")
            .empty();
    }
}

/// A curve in logarithmic coordinates. A run without a result leaves a gap.
pub(super) struct Curve {
    pub(super) look: Look,
    pub(super) points: Vec<Option<[f64; 2]>>,
}

impl Curve {
    /// The existing points.
    pub(super) fn shown(&self) -> impl Iterator<Item = [f64; 2]> {
        self.points.iter().copied().flatten()
    }

    pub(super) fn draw(&self, svg: &mut Svg, frame: &Frame) {
        for piece in self.points.split(Option::is_none) {
            let points = piece.iter().flatten();
            let points: Vec<[f64; 2]> = points.map(|[x, y]| frame.place(*x, *y)).collect();
            if points.len() > 1 {
                self.look.line(svg, &points);
            }
            for point in points {
                self.look.mark(svg, point);
            }
        }
    }
}

impl Sample for Look {
    fn sample(self, svg: &mut Svg, [a, b]: [[f64; 2]; 2]) {
        self.line(svg, &[a, b]);
        self.mark(svg, [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
    }
}
