//! Paths of points in the plane, with the same scale on both axes.

mod recorder;

use super::axis::{Axis, drawable, range};
use super::plot::{Entry, Frame, Labels, legend, legend_height};
use super::style::{GREY, INK, Style, TEXT_SIZE, TITLE_SIZE};
use super::svg::{Svg, text_width};

pub use recorder::PathRecorder;

/// The path of a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Name in the legend.
    pub label: String,
    /// x (m). A value that is not finite is a gap.
    pub x: Vec<f64>,
    /// y (m).
    pub y: Vec<f64>,
    /// Appearance of the path.
    pub style: Style,
}

impl Path {
    fn points(&self) -> impl DoubleEndedIterator<Item = [f64; 2]> {
        let pairs = self.x.iter().zip(&self.y).map(|(x, y)| [*x, *y]);
        pairs
            .collect::<Vec<_>>()
            .into_iter()
            .filter(|p| p.iter().all(|v| drawable(*v)))
    }
}

/// Largest width and height of the frame (px).
const LARGEST: [f64; 2] = [840.0, 560.0];
/// Largest ratio of the longer side of a frame to the shorter side.
const SLENDER: f64 = 3.5;
/// Margin of the page (px).
const MARGIN: f64 = 16.0;

/// Draws paths in the plane with equal axes. A ring marks the start of each path, and a dot marks
/// the end.
#[must_use]
pub fn paths(title: &str, paths: &[Path]) -> String {
    let all = || paths.iter().flat_map(Path::points);
    let x = range(all().map(|p| p[0])).unwrap_or([0.0, 1.0]);
    let y = range(all().map(|p| p[1])).unwrap_or([0.0, 1.0]);
    let (x, y, size) = equal(x, y);
    let labels = y.ticks.iter().map(|t| text_width(&t.label, TEXT_SIZE));
    let left = MARGIN + labels.fold(30.0, f64::max) + 30.0;
    let width = left + size[0] + MARGIN;
    let entries: Vec<Entry<'_>> = paths.iter().map(|p| (p.label.as_str(), p.style)).collect();
    let top = MARGIN + 26.0 + legend_height(&entries, size[0]) + 6.0;

    let mut svg = Svg::new(width, top + size[1] + 46.0, title);
    svg.element("text")
        .at([("x", left), ("y", MARGIN + 14.0), ("font-size", TITLE_SIZE)])
        .with("font-weight", "bold")
        .with("fill", INK)
        .text(title);
    legend(&mut svg, [left, MARGIN + 24.0], size[0], &entries);
    let frame = Frame {
        left,
        top,
        width: size[0],
        height: size[1],
        x,
        y,
    };
    frame.draw(&mut svg, Labels::Shown);
    axis_labels(&mut svg, &frame);
    if all().next().is_none() {
        frame.note(&mut svg, "no data");
    }
    for path in paths {
        frame.curve(&mut svg, &path.x, &path.y, path.style);
    }
    for path in paths {
        ends(&mut svg, &frame, path);
    }
    svg.finish()
}

/// Axes with equal scales around two ranges, and the size of their frame (px).
fn equal(x: [f64; 2], y: [f64; 2]) -> (Axis, Axis, [f64; 2]) {
    let span = |r: [f64; 2]| r[1] - r[0];
    let largest = span(x).max(span(y));
    let least = largest / SLENDER;
    let fallback = if largest > 0.0 { 0.0 } else { 1.0 };
    let room = |r: [f64; 2]| {
        let half = 0.5 * (1.12 * span(r)).max(least).max(fallback);
        let middle = r[0] + 0.5 * span(r);
        [middle - half, middle + half]
    };
    let (x, y) = (room(x), room(y));
    let scale = (LARGEST[0] / span(x)).min(LARGEST[1] / span(y));
    let size = [(scale * span(x)).max(1.0), (scale * span(y)).max(1.0)];
    let ticks = |pixels: f64| ((pixels / 60.0) as usize).max(2);
    (
        Axis::over(x, ticks(size[0])),
        Axis::over(y, ticks(size[1])),
        size,
    )
}

fn axis_labels(svg: &mut Svg, frame: &Frame) {
    svg.element("text")
        .at([
            ("x", frame.left + 0.5 * frame.width),
            ("y", frame.top + frame.height + 34.0),
            ("font-size", TEXT_SIZE),
        ])
        .with("text-anchor", "middle")
        .with("fill", INK)
        .text(&format!("x ({})", frame.x.unit("m")));
    svg.element("text")
        .at([
            ("x", frame.left + frame.width),
            ("y", frame.top + frame.height + 34.0),
            ("font-size", TEXT_SIZE),
        ])
        .with("text-anchor", "end")
        .with("fill", GREY)
        .text("○ start  ● end");
    let (x, y) = (MARGIN + 10.0, frame.top + 0.5 * frame.height);
    svg.element("text")
        .at([("x", x), ("y", y), ("font-size", TEXT_SIZE)])
        .with("text-anchor", "middle")
        .with("fill", INK)
        .with("transform", &format!("rotate(-90 {x:.1} {y:.1})"))
        .text(&format!("y ({})", frame.y.unit("m")));
}

fn ends(svg: &mut Svg, frame: &Frame, path: &Path) {
    let (start, end) = (path.points().next(), path.points().next_back());
    for (point, fill) in [(start, "#ffffff"), (end, path.style.colour())] {
        let Some([x, y]) = point else { continue };
        let [x, y] = frame.place(x, y);
        svg.element("circle")
            .at([("cx", x), ("cy", y), ("r", 3.6)])
            .with("fill", fill)
            .with("stroke", path.style.colour())
            .with("stroke-width", "1.5")
            .empty();
    }
}
