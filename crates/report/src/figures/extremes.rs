//! Error over an extreme parameter value, in log–log axes. The figure has one panel for each test
//! and each varied parameter.

use super::curve::{Curve, Look};
use super::decades::{Unit, decades};
use super::plot::{Frame, Labels, legend, legend_height, line};
use super::style::{GREY, INK, TEXT_SIZE, TITLE_SIZE, dark_scheme};
use super::svg::Svg;

/// Width of the figure (px).
const WIDTH: f64 = 1120.0;
/// Margin of the page (px).
const MARGIN: f64 = 18.0;
/// Space for labels of the vertical axis (px).
const LABELS: f64 = 44.0;
/// Space between panels (px).
const GUTTER: f64 = 30.0;
/// Height of a panel (px).
const HEIGHT: f64 = 190.0;
/// Space above a panel for its title (px).
const TITLE: f64 = 26.0;
/// Space below a panel for labels and the name of the axis (px).
const BELOW: f64 = 46.0;
/// Number of panels in a row.
const COLUMNS: usize = 2;

/// Range of errors, as powers of ten. Values outside of this range, including zero, are drawn at
/// the edge.
const SHOWN: [f64; 2] = [-17.0, 1.0];

/// One panel: errors over a varied parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes<'a> {
    /// The test.
    pub title: &'a str,
    /// Name of the varied parameter.
    pub varied: &'a str,
    /// Curves by name. Each point of a curve is a parameter value and an error.
    pub series: Vec<(&'a str, Vec<[f64; 2]>)>,
    /// Largest accepted error, if it is the same for all cases.
    pub bound: Option<f64>,
}

/// Draws errors over varied parameters, panel by panel. Returns an empty text if there are no
/// panels. A dashed line is the bound. If there are several errors at one parameter value, the
/// largest error is drawn. NaN is not drawn.
#[must_use]
pub fn extremes(panels: &[Extremes<'_>]) -> String {
    let plots: Vec<Plot<'_>> = panels.iter().map(Plot::of).collect();
    if plots.is_empty() {
        return String::new();
    }
    let width = (WIDTH - 2.0 * MARGIN - COLUMNS as f64 * LABELS - GUTTER) / COLUMNS as f64;
    let legends = plots.iter().map(|p| legend_height(&p.looks(), width));
    let head = TITLE + legends.fold(0.0, f64::max);
    let row = head + HEIGHT + BELOW;
    let lines = plots.len().div_ceil(COLUMNS) as f64;
    let mut svg = Svg::new(
        WIDTH,
        2.0 * MARGIN + row * lines,
        "Error against the varied parameter",
    );
    svg.element("style").text(&dark_scheme());
    for (k, plot) in plots.iter().enumerate() {
        let left = MARGIN + LABELS + (k % COLUMNS) as f64 * (width + GUTTER + LABELS);
        let top = MARGIN + row * (k / COLUMNS) as f64;
        plot.draw(&mut svg, [left, top], width, head);
    }
    svg.finish()
}

/// A panel with its curves on the logarithmic plane.
struct Plot<'a> {
    panel: &'a Extremes<'a>,
    curves: Vec<Curve>,
}

impl<'a> Plot<'a> {
    fn of(panel: &'a Extremes<'a>) -> Self {
        let series = panel.series.iter().enumerate();
        Self {
            panel,
            curves: series.map(|(k, (_, points))| curve(k, points)).collect(),
        }
    }

    fn looks(&self) -> Vec<(&str, Look)> {
        let names = self.panel.series.iter().map(|(name, _)| *name);
        names.zip(self.curves.iter().map(|c| c.look)).collect()
    }

    fn draw(&self, svg: &mut Svg, [left, top]: [f64; 2], width: f64, head: f64) {
        svg.element("text")
            .at([("x", left), ("y", top + 14.0), ("font-size", TITLE_SIZE)])
            .with("font-weight", "bold")
            .with("fill", INK)
            .text(&format!(
                "{}: error against {}",
                self.panel.title, self.panel.varied
            ));
        legend(svg, [left, top + TITLE], width, &self.looks());
        let points = || self.curves.iter().flat_map(Curve::shown);
        let bound = self
            .panel
            .bound
            .filter(|b| *b > 0.0)
            .map(|b| b.log10().clamp(SHOWN[0], SHOWN[1]));
        let frame = Frame {
            left,
            top: top + head,
            width,
            height: HEIGHT,
            x: decades(points().map(|p| p[0]), Unit::Number, 8),
            y: decades(points().map(|p| p[1]).chain(bound), Unit::Number, 6),
        };
        frame.draw(svg, Labels::Shown);
        svg.element("text")
            .at([
                ("x", left + 0.5 * width),
                ("y", top + head + HEIGHT + 34.0),
                ("font-size", TEXT_SIZE),
            ])
            .with("text-anchor", "middle")
            .with("fill", GREY)
            .text(self.panel.varied);
        if let Some(bound) = bound {
            let [_, y] = frame.place(frame.x.min, bound);
            line(svg, [left, y], [left + width, y], GREY);
        }
        for curve in &self.curves {
            curve.draw(svg, &frame);
        }
        if points().next().is_none() {
            frame.note(svg, "all cases were rejected");
        }
    }
}

/// The largest error at each parameter value, as decimal logarithms.
fn curve(k: usize, points: &[[f64; 2]]) -> Curve {
    let mut worst: Vec<[f64; 2]> = Vec::new();
    for [value, error] in points.iter().filter(|[_, error]| !error.is_nan()) {
        let (x, y) = (value.log10(), error.abs().log10().clamp(SHOWN[0], SHOWN[1]));
        match worst.iter_mut().find(|p| p[0] == x) {
            Some(point) => point[1] = point[1].max(y),
            None if x.is_finite() => worst.push([x, y]),
            None => {}
        }
    }
    worst.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Curve {
        look: Look::nth(k),
        points: worst.into_iter().map(Some).collect(),
    }
}
