//! Quantities over time, with one panel for each quantity.

use super::axis::{Axis, drawable, range};
use super::plot::{Entry, Frame, Labels, legend, legend_height};
use super::style::{GREY, INK, Style, TEXT_SIZE, TITLE_SIZE};
use super::svg::{Svg, text_width};

/// A curve over time. If `t` and `y` have different lengths, the end of the longer list is omitted.
#[derive(Clone, Copy, Debug)]
pub struct Series<'a> {
    /// Name in the legend. If the name is empty, the legend does not contain the curve.
    pub label: &'a str,
    /// Times (s).
    pub t: &'a [f64],
    /// Values. A value that is not finite is a gap.
    pub y: &'a [f64],
    /// Appearance of the curve.
    pub style: Style,
}

impl Series<'_> {
    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let pairs = self.t.iter().copied().zip(self.y.iter().copied());
        pairs.filter(|(t, y)| drawable(*t) && drawable(*y))
    }
}

/// Curves of one quantity.
#[derive(Clone, Copy, Debug)]
pub struct Panel<'a> {
    /// Name of the quantity.
    pub title: &'a str,
    /// Unit of the quantity.
    pub unit: &'a str,
    /// Curves of the quantity.
    pub series: &'a [Series<'a>],
}

impl<'a> Panel<'a> {
    fn entries(&self) -> Vec<Entry<'a>> {
        let labelled = self.series.iter().filter(|s| !s.label.is_empty());
        labelled.map(|s| (s.label, s.style)).collect()
    }
}

/// Width of a figure (px).
const WIDTH: f64 = 960.0;
/// Height of the frame of a panel (px).
const FRAME: f64 = 150.0;
/// Height of the frame if there is only one panel (px).
const FRAME_ALONE: f64 = 300.0;
/// Margin of the page (px).
const MARGIN: f64 = 16.0;
/// Space between columns (px).
const GUTTER: f64 = 30.0;
/// Space for a title (px).
const TITLE: f64 = 26.0;
/// Space below the lowest frames (px).
const BELOW: f64 = 40.0;

/// A figure of one quantity over time.
///
/// ```
/// use pfaff_report::figures::{Series, Style, history};
/// let t = [0.0, 1.0, 2.0];
/// let y = [0.0, f64::NAN, 4.0]; // a gap in the middle
/// let series = Series { label: "run 1", t: &t, y: &y, style: Style::nth(0) };
/// let svg = history("force in A", "N", &[series]);
/// assert!(svg.starts_with("<svg") && svg.contains("force in A"));
/// ```
#[must_use]
pub fn history(title: &str, unit: &str, series: &[Series<'_>]) -> String {
    let panel = Panel {
        title,
        unit,
        series,
    };
    draw(&[panel], 1, FRAME_ALONE)
}

/// A figure of several quantities over the same time, with `columns` small panels in each row. If
/// all panels have the same curves, there is one common legend.
#[must_use]
pub fn histories(panels: &[Panel<'_>], columns: usize) -> String {
    draw(panels, columns.clamp(1, panels.len().max(1)), FRAME)
}

fn draw(panels: &[Panel<'_>], columns: usize, frame_height: f64) -> String {
    let all = panels.iter().flat_map(|p| p.series);
    let times = range(all.flat_map(Series::points).map(|p| p.0)).unwrap_or([0.0, 1.0]);
    let x = Axis::over(times, if columns > 2 { 5 } else { 8 });
    let y_axes: Vec<Axis> = panels
        .iter()
        .map(|p| {
            let values = range(p.series.iter().flat_map(Series::points).map(|p| p.1));
            Axis::around(values.unwrap_or([0.0, 1.0]), (frame_height / 30.0) as usize)
        })
        .collect();
    let labels = y_axes.iter().flat_map(|a| &a.ticks);
    let label_width = labels.fold(30.0, |w, t| text_width(&t.label, TEXT_SIZE).max(w)) + 8.0;
    let cell = (WIDTH - 2.0 * MARGIN - GUTTER * (columns - 1) as f64) / columns as f64;
    let width = (cell - label_width).max(80.0);

    let shared = shared_legend(panels);
    let legend_width = WIDTH - 2.0 * MARGIN - label_width;
    let shared_entries = match panels {
        [first, ..] if shared => first.entries(),
        _ => Vec::new(),
    };
    let head = MARGIN + legend_height(&shared_entries, legend_width);
    let own = if shared {
        0.0
    } else {
        let heights = panels.iter().map(|p| legend_height(&p.entries(), width));
        heights.fold(0.0, f64::max)
    };
    let row_height = TITLE + own + frame_height + 10.0;
    let rows = panels.len().div_ceil(columns);
    let height = head + rows as f64 * row_height + BELOW;

    let titles: Vec<&str> = panels.iter().map(|p| p.title).collect();
    let mut svg = Svg::new(WIDTH, height, &titles.join(", "));
    legend(
        &mut svg,
        [MARGIN + label_width, MARGIN],
        legend_width,
        &shared_entries,
    );
    for (k, (panel, y)) in panels.iter().zip(y_axes).enumerate() {
        let (row, column) = (k / columns, k % columns);
        let left = MARGIN + label_width + column as f64 * (cell + GUTTER);
        let top = head + row as f64 * row_height;
        let frame = Frame {
            left,
            top: top + TITLE + own,
            width,
            height: frame_height,
            x: x.clone(),
            y,
        };
        title(&mut svg, [left, top + 17.0], panel, &frame.y);
        if !shared {
            legend(&mut svg, [left, top + TITLE - 2.0], width, &panel.entries());
        }
        let lowest = k + columns >= panels.len();
        let x_labels = if lowest {
            Labels::Shown
        } else {
            Labels::Hidden
        };
        frame.draw(&mut svg, x_labels);
        if lowest {
            time_label(&mut svg, &frame);
        }
        if panel.series.iter().all(|s| s.points().next().is_none()) {
            frame.note(&mut svg, "no data");
        }
        for s in panel.series {
            frame.curve(&mut svg, s.t, s.y, s.style);
        }
    }
    svg.finish()
}

/// Whether the curves of all panels have the same names and styles.
fn shared_legend(panels: &[Panel<'_>]) -> bool {
    panels.windows(2).all(|pair| {
        let (a, b) = (pair[0].series, pair[1].series);
        let same = |(a, b): (&Series<'_>, &Series<'_>)| a.label == b.label && a.style == b.style;
        a.len() == b.len() && a.iter().zip(b).all(same)
    })
}

fn title(svg: &mut Svg, [x, y]: [f64; 2], panel: &Panel<'_>, axis: &Axis) {
    let unit = axis.unit(panel.unit);
    svg.element("text")
        .at([("x", x), ("y", y), ("font-size", TITLE_SIZE)])
        .with("fill", INK)
        .open();
    svg.element("tspan")
        .with("font-weight", "bold")
        .text(panel.title);
    if !unit.is_empty() {
        svg.element("tspan")
            .with("fill", GREY)
            .with("dx", "6")
            .with("font-size", &TEXT_SIZE.to_string())
            .text(&format!("({unit})"));
    }
    svg.close();
}

fn time_label(svg: &mut Svg, frame: &Frame) {
    svg.element("text")
        .at([
            ("x", frame.left + 0.5 * frame.width),
            ("y", frame.top + frame.height + 33.0),
            ("font-size", TEXT_SIZE),
        ])
        .with("text-anchor", "middle")
        .with("fill", INK)
        .text(&format!("t ({})", frame.x.unit("s")));
}
