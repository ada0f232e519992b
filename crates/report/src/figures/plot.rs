//! Common parts of all diagrams: a frame with grid and ticks, curves with gaps, legends.

use super::axis::{Axis, drawable};
use super::style::{GREY, GRID, INK, Style, TEXT_SIZE};
use super::svg::{Svg, point_list, text_width};

/// Width of curves (px).
const CURVE: &str = "1.7";

/// A rectangle of the page (px) with axes.
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) x: Axis,
    pub(super) y: Axis,
}

/// Position of the labels of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Labels {
    Shown,
    Hidden,
}

impl Frame {
    /// Position of a point on the page.
    pub(super) fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [
            self.left + self.width * self.x.position(x),
            self.top + self.height * (1.0 - self.y.position(y)),
        ]
    }

    /// Grid, ticks and their labels.
    pub(super) fn draw(&self, svg: &mut Svg, x_labels: Labels) {
        let bottom = self.top + self.height;
        svg.element("g")
            .with("font-size", &TEXT_SIZE.to_string())
            .with("fill", GREY)
            .open();
        for tick in &self.x.ticks {
            let [x, _] = self.place(tick.value, self.y.min);
            line(svg, [x, self.top], [x, bottom], GRID);
            if x_labels == Labels::Shown {
                svg.element("text")
                    .at([("x", x), ("y", bottom + 16.0)])
                    .with("text-anchor", "middle")
                    .text(&tick.label);
            }
        }
        for tick in &self.y.ticks {
            let [_, y] = self.place(self.x.min, tick.value);
            line(svg, [self.left, y], [self.left + self.width, y], GRID);
            svg.element("text")
                .at([("x", self.left - 6.0), ("y", y + 4.0)])
                .with("text-anchor", "end")
                .text(&tick.label);
        }
        svg.element("rect")
            .at([
                ("x", self.left),
                ("y", self.top),
                ("width", self.width),
                ("height", self.height),
            ])
            .with("fill", "none")
            .with("stroke", "#8a939b")
            .empty();
        svg.close();
    }

    /// A note in the middle of the frame.
    pub(super) fn note(&self, svg: &mut Svg, text: &str) {
        svg.element("text")
            .at([
                ("x", self.left + 0.5 * self.width),
                ("y", self.top + 0.5 * self.height + 4.0),
                ("font-size", TEXT_SIZE),
            ])
            .with("text-anchor", "middle")
            .with("fill", GREY)
            .text(text);
    }

    /// A curve. Values that cannot be drawn leave a gap, and a single value between gaps is a dot.
    pub(super) fn curve(&self, svg: &mut Svg, x: &[f64], y: &[f64], style: Style) {
        let mut points = Vec::new();
        for (&x, &y) in x.iter().zip(y) {
            if drawable(x) && drawable(y) {
                points.push(self.place(x, y));
            } else {
                stroke(svg, &points, style);
                points.clear();
            }
        }
        stroke(svg, &points, style);
    }
}

/// Draws a part of a curve without gaps.
fn stroke(svg: &mut Svg, points: &[[f64; 2]], style: Style) {
    match points {
        [] => {}
        [[x, y]] => svg
            .element("circle")
            .at([("cx", *x), ("cy", *y), ("r", 2.2)])
            .with("fill", style.colour())
            .empty(),
        _ => svg
            .element("polyline")
            .with("points", &point_list(thinned(points)))
            .with("fill", "none")
            .with("stroke", style.colour())
            .with("stroke-width", CURVE)
            .with("stroke-linejoin", "round")
            .with("stroke-dasharray", style.pattern.dashes())
            .empty(),
    }
}

/// Omits points that are closer than a quarter of a pixel to the last point shown.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut shown: Vec<[f64; 2]> = Vec::with_capacity(points.len().min(4096));
    for (k, p) in points.iter().enumerate() {
        let far = shown
            .last()
            .is_none_or(|s| (s[0] - p[0]).abs().max((s[1] - p[1]).abs()) >= 0.25);
        if far || k + 1 == points.len() {
            shown.push(*p);
        }
    }
    shown
}

/// A thin line.
pub(super) fn line(svg: &mut Svg, a: [f64; 2], b: [f64; 2], colour: &str) {
    svg.element("line")
        .at([("x1", a[0]), ("y1", a[1]), ("x2", b[0]), ("y2", b[1])])
        .with("stroke", colour)
        .empty();
}

/// Height of a line of a legend (px).
const LEGEND_LINE: f64 = 18.0;
/// Length of the sample of a curve (px).
const SAMPLE: f64 = 24.0;

/// Appearance of a curve, shown by a short sample in a legend.
pub(super) trait Sample: Copy {
    /// Draws the sample between two points.
    fn sample(self, svg: &mut Svg, ends: [[f64; 2]; 2]);
}

impl Sample for Style {
    fn sample(self, svg: &mut Svg, ends: [[f64; 2]; 2]) {
        stroke(svg, &ends, self);
    }
}

/// A name and its curve.
pub(super) type Entry<'a, S = Style> = (&'a str, S);

/// Positions of the entries of a legend, relative to its corner, and the number of its lines.
fn legend_layout<S>(entries: &[Entry<'_, S>], width: f64) -> (Vec<[f64; 2]>, usize) {
    let (mut x, mut row) = (0.0, 0);
    let mut places = Vec::with_capacity(entries.len());
    for (label, _) in entries {
        let w = SAMPLE + 6.0 + text_width(label, TEXT_SIZE) + 12.0;
        if x > 0.0 && x + w > width {
            (x, row) = (0.0, row + 1);
        }
        places.push([x, row as f64 * LEGEND_LINE]);
        x += w;
    }
    (places, if entries.is_empty() { 0 } else { row + 1 })
}

/// Height of a legend (px).
pub(super) fn legend_height<S>(entries: &[Entry<'_, S>], width: f64) -> f64 {
    legend_layout(entries, width).1 as f64 * LEGEND_LINE
}

/// Draws a legend from its upper left corner.
pub(super) fn legend<S: Sample>(
    svg: &mut Svg,
    corner: [f64; 2],
    width: f64,
    entries: &[Entry<'_, S>],
) {
    for ([x, y], (label, style)) in legend_layout(entries, width).0.into_iter().zip(entries) {
        let (x, y) = (corner[0] + x, corner[1] + y + 0.5 * LEGEND_LINE);
        style.sample(svg, [[x, y], [x + SAMPLE, y]]);
        svg.element("text")
            .at([
                ("x", x + SAMPLE + 6.0),
                ("y", y + 4.0),
                ("font-size", TEXT_SIZE),
            ])
            .with("fill", INK)
            .text(label);
    }
}
