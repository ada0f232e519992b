//! Error over what is made extreme: one panel for each family and each varied number, doubly
//! logarithmic; each point is the worst of all cases at this value.

use super::curve::{Curve, Look, legend, legend_height};
use super::decades::{Unit, decades};
use super::plot::{Frame, Labels, line};
use super::style::{GREY, INK, TEXT_SIZE, TITLE_SIZE, dark_scheme};
use super::svg::Svg;
use crate::stress::{StressFamily, StressRow};

/// Width of the figure (px).
const WIDTH: f64 = 1120.0;
/// Margin of the page (px).
const MARGIN: f64 = 18.0;
/// Room for labels of the vertical axis (px).
const LABELS: f64 = 44.0;
/// Room between panels (px).
const GUTTER: f64 = 30.0;
/// Height of a panel (px).
const HEIGHT: f64 = 190.0;
/// Room above a panel for its title (px).
const TITLE: f64 = 26.0;
/// Room below a panel for labels and the name of the axis (px).
const BELOW: f64 = 46.0;
/// Panels side by side.
const COLUMNS: usize = 2;

/// Errors shown, as powers of ten; what lies beyond, zero too, is drawn at the edge.
const SHOWN: [f64; 2] = [-17.0, 1.0];

/// One panel: cases of a family over the same number.
struct Plot<'r> {
    family: &'static str,
    varied: &'static str,
    series: Vec<(&'r str, Curve)>,
    /// The bound of all its cases, where they have only one.
    bound: Option<f64>,
}

/// Errors of all families that vary a number; an empty text where none does. A dashed line is the
/// bound. Refusals have no point.
#[must_use]
pub fn extremes(families: &[StressFamily]) -> String {
    let plots: Vec<Plot<'_>> = families.iter().flat_map(plots).collect();
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
        "Error over what is made extreme",
    );
    svg.element("style").text(&dark_scheme());
    for (k, plot) in plots.iter().enumerate() {
        let left = MARGIN + LABELS + (k % COLUMNS) as f64 * (width + GUTTER + LABELS);
        let top = MARGIN + row * (k / COLUMNS) as f64;
        plot.draw(&mut svg, [left, top], width, head);
    }
    svg.finish()
}

/// The panels of a family, in the order in which its numbers appear.
fn plots(family: &StressFamily) -> Vec<Plot<'_>> {
    let mut names: Vec<&'static str> = Vec::new();
    for (name, _) in family.rows.iter().filter_map(|row| row.varied) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let of = |varied: &'static str| {
        let of_it = |row: &&StressRow| row.varied.is_some_and(|(name, _)| name == varied);
        let rows: Vec<&StressRow> = family.rows.iter().filter(of_it).collect();
        let first = rows.first().map_or(f64::NAN, |row| row.bound);
        Plot {
            family: family.name,
            varied,
            series: series(&rows),
            bound: rows.iter().all(|row| row.bound == first).then_some(first),
        }
    };
    names.into_iter().map(of).collect()
}

/// One curve for each formulation, or for each method where there is one formulation.
fn series<'r>(rows: &[&'r StressRow]) -> Vec<(&'r str, Curve)> {
    let alike = rows
        .windows(2)
        .all(|w| w[0].formulation == w[1].formulation);
    let name = |row: &'r StressRow| match alike {
        true => row.method.as_str(),
        false => row.formulation.as_str(),
    };
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&name(row)) {
            names.push(name(row));
        }
    }
    let curve = |(k, own): (usize, &'r str)| {
        let own_rows = rows.iter().filter(|row| name(row) == own);
        let mut points: Vec<[f64; 2]> = Vec::new();
        for row in own_rows.filter(|row| !row.error.is_nan()) {
            let x = row.varied.map_or(f64::NAN, |(_, value)| value.log10());
            let y = row.error.abs().log10().clamp(SHOWN[0], SHOWN[1]);
            match points.iter_mut().find(|p| p[0] == x) {
                Some(point) => point[1] = point[1].max(y),
                None if x.is_finite() => points.push([x, y]),
                None => {}
            }
        }
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let points = points.into_iter().map(Some).collect();
        let look = Look::nth(k);
        (own, Curve { look, points })
    };
    names.into_iter().enumerate().map(curve).collect()
}

impl Plot<'_> {
    fn looks(&self) -> Vec<(&str, Look)> {
        self.series
            .iter()
            .map(|(name, c)| (*name, c.look))
            .collect()
    }

    fn draw(&self, svg: &mut Svg, [left, top]: [f64; 2], width: f64, head: f64) {
        svg.element("text")
            .at([("x", left), ("y", top + 14.0), ("font-size", TITLE_SIZE)])
            .with("font-weight", "bold")
            .with("fill", INK)
            .text(&format!("{}: error over {}", self.family, self.varied));
        legend(svg, [left, top + TITLE], width, &self.looks());
        let points = || self.series.iter().flat_map(|(_, curve)| curve.shown());
        let bound = self
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
            .text(self.varied);
        if let Some(bound) = bound {
            let [_, y] = frame.place(frame.x.min, bound);
            line(svg, [left, y], [left + width, y], GREY);
        }
        for (_, curve) in &self.series {
            curve.draw(svg, &frame);
        }
        if points().next().is_none() {
            frame.note(svg, "all cases were refused");
        }
    }
}
