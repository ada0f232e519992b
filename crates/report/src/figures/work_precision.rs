//! Error against run time and against number of evaluations, with three log–log panels for each
//! scene. The best points are at the lower left. Curves differ in colour and in marker. The page
//! uses the light or dark colour scheme of the reader.

use super::curve::{Curve, Look};
use super::decades::{Unit, decades};
use super::plot::{Frame, Labels, legend, legend_height, line};
use super::style::{GREY, INK, TEXT_SIZE, TITLE_SIZE, dark_scheme};
use super::svg::Svg;
use crate::work_precision::{CurveName, WorkPrecisionRow, WorkPrecisionScene};

/// Width of the figure (px).
const WIDTH: f64 = 1120.0;
/// Margin of the page (px).
const MARGIN: f64 = 18.0;
/// Space for labels of the vertical axis (px).
const LABELS: f64 = 44.0;
/// Space between panels (px).
const GUTTER: f64 = 30.0;
/// Height of a panel (px).
const HEIGHT: f64 = 176.0;
/// Space above a panel for the name of its scene (px).
const TITLE: f64 = 30.0;
/// Space below a panel for labels (px).
const BELOW: f64 = 26.0;
/// Number of panels of a scene.
const COLUMNS: usize = 3;

/// Range of errors, as powers of ten. Values outside of this range are drawn at the edge.
const SHOWN: [f64; 2] = [-16.0, 1.0];

/// Fill colour of the area below the error of the reference.
const UNRESOLVED: &str = "#f1f3f5";

/// The quantity on the horizontal axis.
type Work = fn(&WorkPrecisionRow) -> f64;

/// Draws the error of the motion, which is the larger error of position and velocity. Two panels
/// show this error for all methods, over seconds and over evaluations. The third panel shows the
/// error over seconds for one method with all treatments of redundancy and drift. A dashed line is
/// the error of the reference. Runs that did not reach their end have no point; the figure states
/// the number of these runs.
#[must_use]
pub fn work_precision(scenes: &[WorkPrecisionScene]) -> String {
    let methods = Family::methods(scenes);
    let treatments = Family::treatments(scenes);
    let width = (WIDTH - 2.0 * MARGIN - LABELS - GUTTER * (COLUMNS - 1) as f64) / COLUMNS as f64;
    let left = |column: usize| MARGIN + LABELS + column as f64 * (width + GUTTER);
    let both = 2.0 * width + GUTTER;
    let head =
        22.0 + legend_height(&methods.looks(), both).max(legend_height(&treatments.looks(), width));
    let row = TITLE + HEIGHT + BELOW;
    let page = MARGIN + head + row * scenes.len() as f64 + MARGIN;

    let mut svg = Svg::new(WIDTH, page, "Error against run time");
    svg.element("style").text(&dark_scheme());
    let heads = [
        "methods: error against seconds",
        "methods: error against evaluations",
        &treatments.title,
    ];
    for (column, text) in heads.into_iter().enumerate() {
        label(&mut svg, [left(column), MARGIN + 11.0], text, INK);
    }
    legend(&mut svg, [left(0), MARGIN + 20.0], both, &methods.looks());
    legend(
        &mut svg,
        [left(2), MARGIN + 20.0],
        width,
        &treatments.looks(),
    );
    for (k, scene) in scenes.iter().enumerate() {
        let top = MARGIN + head + row * k as f64;
        title(&mut svg, [left(0), top + 20.0], scene);
        let seconds: Work = |row| row.seconds;
        let evaluations: Work = |row| row.evaluations as f64;
        let panels = [
            (&methods, seconds, Unit::Seconds),
            (&methods, evaluations, Unit::Number),
            (&treatments, seconds, Unit::Seconds),
        ];
        let vertical = errors(scene);
        for (column, (family, work, unit)) in panels.into_iter().enumerate() {
            let told = if column == 0 {
                Unit::Number
            } else {
                Unit::Untold
            };
            let curves = family.curves(scene, work);
            let x = curves.iter().flat_map(|c| c.shown().map(|p| p[0]));
            let frame = Frame {
                left: left(column),
                top: top + TITLE,
                width,
                height: HEIGHT,
                x: decades(x, unit, 5),
                y: decades(vertical.clone(), told, 6),
            };
            draw(&mut svg, &frame, scene, &curves);
        }
    }
    svg.finish()
}

/// The error bound of the reference is shown if the bound is at least this fraction of the smallest
/// error.
const FAR: f64 = 1e-3;

/// Logarithms of all errors of a scene, and of the error bound of its reference if the bound is
/// shown.
fn errors(scene: &WorkPrecisionScene) -> impl Iterator<Item = f64> + Clone {
    let runs = scene.rows.iter().filter_map(WorkPrecisionRow::motion_error);
    let smallest = runs.clone().fold(f64::INFINITY, f64::min);
    let limit = Some(scene.reference.motion_limit());
    let near = limit.filter(|limit| *limit >= FAR * smallest);
    runs.chain(near).map(height)
}

/// Position of an error.
fn height(error: f64) -> f64 {
    error.log10().clamp(SHOWN[0], SHOWN[1])
}

fn draw(svg: &mut Svg, frame: &Frame, scene: &WorkPrecisionScene, curves: &[Curve]) {
    let limit = scene.reference.motion_limit();
    let resolved = limit.is_finite() && limit > 0.0;
    let bottom = frame.top + frame.height;
    let [_, y] = frame.place(frame.x.min, height(limit));
    let resolved = resolved && y < bottom;
    if resolved {
        svg.element("rect")
            .at([
                ("x", frame.left),
                ("y", y),
                ("width", frame.width),
                ("height", bottom - y),
            ])
            .with("fill", UNRESOLVED)
            .empty();
    }
    frame.draw(svg, Labels::Shown);
    if resolved {
        svg.element("line")
            .at([
                ("x1", frame.left),
                ("y1", y),
                ("x2", frame.left + frame.width),
                ("y2", y),
            ])
            .with("stroke", GREY)
            .with("stroke-dasharray", "5 4")
            .empty();
    }
    if curves.iter().all(|c| c.shown().next().is_none()) {
        frame.note(svg, "no run reached its end");
    }
    for curve in curves {
        curve.draw(svg, frame);
    }
}

fn title(svg: &mut Svg, [x, y]: [f64; 2], scene: &WorkPrecisionScene) {
    svg.element("text")
        .at([("x", x), ("y", y), ("font-size", TITLE_SIZE)])
        .with("fill", INK)
        .open();
    svg.element("tspan")
        .with("font-weight", "bold")
        .text(&scene.title);
    let failed = scene.rows.iter().filter(|row| row.status != "done").count();
    let limit = scene.reference.motion_limit();
    let mut words = if limit.is_finite() {
        format!("reference accurate to {limit:.0e}")
    } else {
        "no reference".to_owned()
    };
    if failed > 0 {
        words.push_str(&format!(
            "; {failed} of {} runs did not reach the end",
            scene.rows.len()
        ));
    }
    svg.element("tspan")
        .with("fill", GREY)
        .with("dx", "10")
        .with("font-size", &TEXT_SIZE.to_string())
        .text(&words);
    svg.close();
    line(
        svg,
        [MARGIN, y - 17.0],
        [WIDTH - MARGIN, y - 17.0],
        "#e3e6e9",
    );
}

fn label(svg: &mut Svg, [x, y]: [f64; 2], text: &str, colour: &str) {
    svg.element("text")
        .at([("x", x), ("y", y), ("font-size", TEXT_SIZE)])
        .with("font-weight", "bold")
        .with("fill", colour)
        .text(text);
}

/// Curves that are drawn in the same panels, with their names in the legend.
struct Family {
    title: String,
    members: Vec<(CurveName, String)>,
}

impl Family {
    /// All methods with the most frequent treatment.
    fn methods(scenes: &[WorkPrecisionScene]) -> Self {
        let all = names(scenes);
        let first = all.first();
        let alike = |c: &&CurveName| {
            first.is_some_and(|f| {
                c.formulation == f.formulation && c.stabilisation == f.stabilisation
            })
        };
        let members = all
            .iter()
            .filter(alike)
            .map(|c| (c.clone(), c.method.to_owned()));
        Self {
            title: String::new(),
            members: members.collect(),
        }
    }

    /// All treatments of redundancy and drift with the method that has the largest number of
    /// treatments.
    fn treatments(scenes: &[WorkPrecisionScene]) -> Self {
        let all = names(scenes);
        let count = |method: &str| all.iter().filter(|c| c.method == method).count();
        // If several methods have the largest number of treatments, the first of these methods is
        // used.
        let method = all
            .iter()
            .rev()
            .max_by_key(|c| count(c.method))
            .map_or("", |c| c.method);
        let members = all.iter().filter(|c| c.method == method);
        let name = |c: &CurveName| match c.stabilisation {
            "projection" => c.formulation.to_owned(),
            other => format!("{}, {other}", c.formulation),
        };
        Self {
            title: format!("{method}: formulations and stabilisations"),
            members: members.map(|c| (c.clone(), name(c))).collect(),
        }
    }

    fn looks(&self) -> Vec<(&str, Look)> {
        let members = self.members.iter().enumerate();
        members
            .map(|(k, (_, name))| (name.as_str(), Look::nth(k)))
            .collect()
    }

    /// Runs, starting with the loosest tolerance.
    fn curves(&self, scene: &WorkPrecisionScene, work: Work) -> Vec<Curve> {
        let curve = |(k, (name, _)): (usize, &(CurveName, String))| {
            let rows = scene.rows.iter().filter(|row| row.curve == *name);
            let point = |row: &WorkPrecisionRow| {
                let error = row.motion_error()?;
                let x = work(row).log10();
                x.is_finite().then(|| [x, height(error)])
            };
            Curve {
                look: Look::nth(k),
                points: rows.map(point).collect(),
            }
        };
        self.members.iter().enumerate().map(curve).collect()
    }
}

/// Names of all curves in the order of their first appearance.
fn names(scenes: &[WorkPrecisionScene]) -> Vec<CurveName> {
    let mut names: Vec<CurveName> = Vec::new();
    for row in scenes.iter().flat_map(|s| &s.rows) {
        if !names.contains(&row.curve) {
            names.push(row.curve.clone());
        }
    }
    names
}
