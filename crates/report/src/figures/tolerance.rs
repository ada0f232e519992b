//! Distributions of values over samples, as a column of histograms, and positions of a marker.

use super::RangeDocument;
use super::axis::{Axis, range as extent};
use super::plot::{Frame, Labels, line};
use super::style::{GREY, INK, TEXT_SIZE, dark_scheme};
use super::svg::Svg;

/// Width of a figure (px).
const WIDTH: f64 = 960.0;
/// Space for names (px).
const NAMES: f64 = 210.0;
/// Space at the right edge for the number of values outside the histogram (px).
const RIGHT: f64 = 70.0;
/// Height of a histogram (px).
const HEIGHT: f64 = 56.0;
/// Space below a histogram for its labels (px).
const BELOW: f64 = 26.0;
/// Colour of values with the same redundancy as the described data.
const KEPT: &str = "#0072b2";
/// Colour of values that are unique only with exact data.
const EXACT: &str = "#d55e00";
/// Opacity of the band that marks the middle nine tenths.
const BAND: &str = "0.12";

/// The smallest and largest value of one reaction component, and the distribution of its values.
pub struct RangeRow<'a> {
    /// The joint or drive.
    pub name: &'a str,
    /// Name of the component.
    pub what: &'a str,
    /// Unit of the component.
    pub unit: &'a str,
    /// Whether the component is unique only with exact data.
    pub is_exact: bool,
    /// Range of the values.
    pub range: &'a RangeDocument,
}

/// Draws histograms, each with a separate axis. A line marks the value for the described data, and
/// a band marks the middle nine tenths. The number of values outside of a histogram is written at
/// its edges.
#[must_use]
pub fn ranges(rows: &[RangeRow<'_>]) -> String {
    let row = HEIGHT + BELOW + 10.0;
    let height = 34.0 + row * rows.len() as f64;
    let mut svg = Svg::new(WIDTH, height, "Ranges of reactions");
    svg.element("style").text(&dark_scheme());
    label(
        &mut svg,
        [NAMES, 18.0],
        "line: value as described; band: 5th to 95th percentile of the samples",
        GREY,
    );
    for (k, own) in rows.iter().enumerate() {
        histogram(&mut svg, 30.0 + row * k as f64, own);
    }
    svg.finish()
}

fn histogram(svg: &mut Svg, top: f64, row: &RangeRow<'_>) {
    let range = row.range;
    let h = &range.histogram;
    let marks = [h.from, h.to].into_iter();
    let near = |x: &f64| (x - h.from).abs().min((x - h.to).abs()) <= h.to - h.from;
    let marks = marks.chain(range.described.filter(near));
    let shown = extent(marks).unwrap_or([0.0, 1.0]);
    let frame = Frame {
        left: NAMES,
        top,
        width: WIDTH - NAMES - RIGHT,
        height: HEIGHT,
        x: Axis::around(shown, 6),
        y: Axis {
            min: 0.0,
            max: 1.05,
            ticks: Vec::new(),
            exponent: 0,
        },
    };
    let bottom = top + HEIGHT;
    let colour = if row.is_exact { EXACT } else { KEPT };
    let [low, _, high] = range.percentiles;
    let x_of = |x: f64| frame.place(x, 0.0)[0];
    frame.draw(svg, Labels::Shown);
    svg.element("rect")
        .at([
            ("x", x_of(low)),
            ("y", top),
            ("width", (x_of(high) - x_of(low)).max(1.0)),
            ("height", HEIGHT),
        ])
        .with("fill", colour)
        .with("fill-opacity", BAND)
        .empty();
    let most = h.counts.iter().copied().max().unwrap_or(1).max(1) as f64;
    let n = h.counts.len() as f64;
    for (k, count) in h.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let edge = |k: usize| x_of(h.from + (h.to - h.from) * k as f64 / n);
        let (left, right) = (edge(k), edge(k + 1));
        let tall = HEIGHT / 1.05 * *count as f64 / most;
        svg.element("rect")
            .at([
                ("x", left),
                ("y", bottom - tall),
                ("width", (right - left - 0.8).max(1.2)),
                ("height", tall),
            ])
            .with("fill", colour)
            .empty();
    }
    if let Some(x) = range.described.filter(near).map(x_of) {
        line(svg, [x, top - 3.0], [x, bottom + 3.0], INK);
    }
    let unit = frame.x.unit(row.unit);
    let reading = if row.is_exact { ", rigid" } else { "" };
    label(svg, [12.0, top + 20.0], row.name, INK);
    label(
        svg,
        [12.0, top + 38.0],
        &format!("{} in {unit}{reading}", row.what),
        GREY,
    );
    for (count, x, anchor) in [
        (h.outside[0], NAMES + 4.0, "start"),
        (h.outside[1], WIDTH - RIGHT + 6.0, "start"),
    ] {
        if count > 0 {
            let told = if x < 0.5 * WIDTH {
                format!("← {count}")
            } else {
                format!("{count} →")
            };
            svg.element("text")
                .at([("x", x), ("y", top + 14.0), ("font-size", TEXT_SIZE)])
                .with("text-anchor", anchor)
                .with("fill", GREY)
                .text(&told);
        }
    }
}

/// Side of a panel of positions (px).
const SIDE: f64 = 260.0;

/// Draws the positions of a marker (m) relative to its first position, in mm. One panel shows y
/// over x; in space, a second panel shows z over x. The figure is empty if the marker does not
/// move.
#[must_use]
pub fn cloud(name: &str, places: &[[f64; 3]], spatial: bool) -> String {
    let Some(&first) = places.first() else {
        return String::new();
    };
    let apart = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| 1e3 * (p[k] - first[k])) };
    let all: Vec<[f64; 3]> = places.iter().skip(1).map(apart).collect();
    let largest = all.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
    if largest == 0.0 {
        return String::new();
    }
    let views: &[(usize, &str)] = if spatial {
        &[(1, "y"), (2, "z")]
    } else {
        &[(1, "y")]
    };
    let (margin, head) = (64.0, 34.0);
    let width = (SIDE + margin) * views.len() as f64 + 20.0;
    let mut svg = Svg::new(width, SIDE + head + 44.0, &format!("Positions of {name}"));
    svg.element("style").text(&dark_scheme());
    label(&mut svg, [margin, 18.0], name, INK);
    for (k, (axis, letter)) in views.iter().enumerate() {
        let both = Axis::around([-largest, largest], 6);
        let frame = Frame {
            left: margin + k as f64 * (SIDE + margin),
            top: head,
            width: SIDE,
            height: SIDE,
            x: both.clone(),
            y: both,
        };
        frame.draw(&mut svg, Labels::Shown);
        for p in &all {
            let [x, y] = frame.place(p[0], p[*axis]);
            svg.element("circle")
                .at([("cx", x), ("cy", y), ("r", 1.3)])
                .with("fill", KEPT)
                .with("fill-opacity", "0.5")
                .empty();
        }
        let [x, y] = frame.place(0.0, 0.0);
        line(&mut svg, [x - 6.0, y], [x + 6.0, y], INK);
        line(&mut svg, [x, y - 6.0], [x, y + 6.0], INK);
        let words = format!("{letter} against x ({})", frame.x.unit("mm"));
        label(&mut svg, [frame.left, head + SIDE + 36.0], &words, GREY);
    }
    svg.finish()
}

fn label(svg: &mut Svg, [x, y]: [f64; 2], text: &str, colour: &str) {
    svg.element("text")
        .at([("x", x), ("y", y), ("font-size", TEXT_SIZE)])
        .with("fill", colour)
        .text(text);
}
