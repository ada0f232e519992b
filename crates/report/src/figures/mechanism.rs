//! A mechanism to scale: bodies as rounded outlines through their joints, joints as symbols marked
//! by the verdict of their reactions.

mod legend;
mod names;

use model::{BodyRef, Mechanism, System};
use solvability::ReactionVerdict;

use super::FigureError;
use super::axis::{DRAWABLE, round_step};
use super::geometry::{Site, posed, sites};
use super::outline::{double_area, hull, rounded};
use super::style::{GREY, HATCH, HATCH_PITCH, INK, Mark, TEXT_SIZE, TITLE_SIZE};
use super::svg::{Svg, number};
use super::symbol::{ground, pitch_circle};
use legend::Legend;
use names::{Drawn, draw_names};

/// How joints and drives are marked.
#[derive(Clone, Copy, Debug)]
pub enum Marking<'a> {
    /// All alike.
    Plain,
    /// By the verdicts of an analysis.
    Verdicts(&'a [ReactionVerdict]),
}

/// What joints and drives are labelled with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Labels {
    /// Their names.
    Names,
    /// Their names and the numbers of their rows of C, from 1, as `B 3–4`.
    NamesAndRows,
}

/// Width of the page and largest height of the drawing (px).
const WIDTH: f64 = 960.0;
const LARGEST_HEIGHT: f64 = 640.0;
/// Room around the drawing for names (px).
const ROOM: [f64; 2] = [90.0, 60.0];
/// Margin of the page, and room for the title (px).
const MARGIN: f64 = 16.0;
const TITLE: f64 = 30.0;
/// Margin of a body around its joints (px).
const FLESH: f64 = 11.0;

/// Fills of bodies; pale, so that they are not mistaken for marks.
const FLESHES: [&str; 6] = [
    "#e6ebf0", "#efe9dc", "#e4ede1", "#ece4ee", "#f1e6e2", "#e0ecec",
];

/// Draws a mechanism at coordinates q and time t.
///
/// Bodies are hulls of the points where joints take hold of them and of their centres of mass:
/// their true shapes are unknown. Every symbol has its name, type and verdict as tool tip.
///
/// # Errors
/// - [`FigureError::Coordinates`], [`FigureError::Coordinate`]: q is no configuration of the
///   mechanism.
/// - [`FigureError::Verdicts`]: the verdicts are those of another mechanism.
pub fn mechanism(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    marking: Marking<'_>,
) -> Result<String, FigureError> {
    labelled_mechanism(mechanism, t, q, marking, Labels::Names)
}

/// The same with other labels.
///
/// # Errors
/// As [`mechanism()`].
pub fn labelled_mechanism(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    marking: Marking<'_>,
    labels: Labels,
) -> Result<String, FigureError> {
    let mut s = mechanism.scratch();
    posed(mechanism, t, q, &mut s)?;
    let marks = marks(mechanism, marking)?;
    let sites = sites(mechanism, &s);
    let centres: Vec<[f64; 2]> = s.poses.iter().map(|p| [p.x, p.y]).collect();
    let view = View::around(&sites, &centres);
    let legend = Legend::of(mechanism, &sites, marking);
    let height = view.bottom() + 34.0 + legend.height();

    let mut svg = Svg::new(WIDTH, height, mechanism.name());
    define_hatch(&mut svg);
    heading(&mut svg, mechanism.name(), t);
    let hulls = hulls(&sites, &centres, &view);
    draw_bodies(&mut svg, mechanism, &hulls);
    draw_centres(&mut svg, &centres, &view);
    draw_joints(&mut svg, mechanism, &sites, &marks, &view);
    let drawn = Drawn {
        sites: &sites,
        marks: &marks,
        centres: &centres,
        hulls: &hulls,
        view: &view,
    };
    draw_names(&mut svg, mechanism, labels, &drawn);
    scale_bar(&mut svg, &view);
    legend.draw(&mut svg, view.bottom() + 30.0);
    Ok(svg.finish())
}

fn marks(mechanism: &Mechanism, marking: Marking<'_>) -> Result<Vec<Mark>, FigureError> {
    let expected = mechanism.layout().groups.len();
    let verdicts = match marking {
        Marking::Plain => return Ok(vec![Mark::Plain; expected]),
        Marking::Verdicts(verdicts) => verdicts,
    };
    if verdicts.len() != expected {
        return Err(FigureError::Verdicts {
            mechanism: mechanism.name().to_owned(),
            found: verdicts.len(),
            expected,
        });
    }
    let marks = verdicts.iter().map(|r| Mark::of(&r.wrench.verdict));
    Ok(marks.collect())
}

/// From the plane of the mechanism (m) to the page (px).
struct View {
    /// px/m
    scale: f64,
    /// What is in the middle of the drawing.
    middle: [f64; 2],
    /// Height of the drawing (px).
    height: f64,
}

impl View {
    fn around(sites: &[Site], centres: &[[f64; 2]]) -> Self {
        let joints = sites.iter().flat_map(|s| {
            let points = s.attachments.iter().map(|a| a.1);
            points.chain([s.place]).chain(corners(s))
        });
        let points: Vec<[f64; 2]> = joints.chain(centres.iter().copied()).collect();
        let range =
            |k: usize| super::axis::range(points.iter().map(|p| p[k])).unwrap_or([0.0, 0.0]);
        let (x, y) = (range(0), range(1));
        let (dx, dy) = (x[1] - x[0], y[1] - y[0]);
        let room = [WIDTH - 2.0 * ROOM[0], LARGEST_HEIGHT - 2.0 * ROOM[1]];
        let size = dx.max(dy);
        // Something without size, or with a size lost in its distance from the origin, gets one
        // metre.
        let far = x[0].abs().max(y[0].abs());
        let scale = if size > 1e-9 * far && size > 1.0 / DRAWABLE {
            (room[0] / dx).min(room[1] / dy)
        } else {
            0.2 * room[0] / far.max(1.0)
        };
        Self {
            scale,
            middle: [x[0] + 0.5 * dx, y[0] + 0.5 * dy],
            height: (scale * dy + 2.0 * ROOM[1]).max(200.0),
        }
    }

    fn to_page(&self, p: [f64; 2]) -> [f64; 2] {
        [
            0.5 * WIDTH + self.scale * (p[0] - self.middle[0]),
            TITLE + 0.5 * self.height - self.scale * (p[1] - self.middle[1]),
        ]
    }

    fn bottom(&self) -> f64 {
        TITLE + self.height
    }
}

/// What the pitch circles of a site reach.
fn corners(site: &Site) -> impl Iterator<Item = [f64; 2]> {
    let circles = site.pitch.into_iter().flatten();
    circles.flat_map(|c| [-c.radius, c.radius].map(|r| [c.centre[0] + r, c.centre[1] + r]))
}

fn define_hatch(svg: &mut Svg) {
    svg.element("defs").open();
    svg.element("pattern")
        .with("id", HATCH)
        .with("patternUnits", "userSpaceOnUse")
        .with("patternTransform", "rotate(45)")
        .at([("width", HATCH_PITCH), ("height", HATCH_PITCH)])
        .open();
    svg.element("rect")
        .at([("width", HATCH_PITCH), ("height", HATCH_PITCH)])
        .with("fill", "#ffffff")
        .empty();
    svg.element("rect")
        .at([("width", 0.45 * HATCH_PITCH), ("height", HATCH_PITCH)])
        .with("fill", Mark::NotUnique.stroke())
        .empty();
    svg.close();
    svg.close();
}

fn heading(svg: &mut Svg, name: &str, t: f64) {
    svg.element("text")
        .at([
            ("x", MARGIN),
            ("y", MARGIN + 12.0),
            ("font-size", TITLE_SIZE),
        ])
        .with("fill", INK)
        .open();
    svg.element("tspan").with("font-weight", "bold").text(name);
    svg.element("tspan")
        .with("dx", "8")
        .with("fill", GREY)
        .with("font-size", &TEXT_SIZE.to_string())
        .text(&format!("t = {} s", shortened(t)));
    svg.close();
}

/// The outline of each body on the page, without its margin.
fn hulls(sites: &[Site], centres: &[[f64; 2]], view: &View) -> Vec<Vec<[f64; 2]>> {
    let mut points: Vec<Vec<[f64; 2]>> = centres.iter().map(|c| vec![view.to_page(*c)]).collect();
    for (body, point) in sites.iter().flat_map(|s| &s.attachments) {
        if let BodyRef::Body(k) = body {
            points[*k].push(view.to_page(*point));
        }
    }
    points.iter().map(|p| hull(p)).collect()
}

fn draw_bodies(svg: &mut Svg, mechanism: &Mechanism, hulls: &[Vec<[f64; 2]>]) {
    let mut order: Vec<usize> = (0..hulls.len()).collect();
    order.sort_by(|&a, &b| double_area(&hulls[b]).total_cmp(&double_area(&hulls[a])));
    for k in order {
        svg.element("g").open();
        svg.element("title").text(&mechanism.bodies()[k].name);
        svg.element("path")
            .with("d", &rounded(&hulls[k], FLESH))
            .with("fill", FLESHES[k % FLESHES.len()])
            .with("fill-opacity", "0.85")
            .with("stroke", "#8d969e")
            .with("stroke-width", "1.2")
            .empty();
        svg.close();
    }
}

/// Centres of mass: a small cross in a ring.
fn draw_centres(svg: &mut Svg, centres: &[[f64; 2]], view: &View) {
    for c in centres {
        let [x, y] = view.to_page(*c);
        let (x, y) = (number(x), number(y));
        svg.element("path")
            .with(
                "d",
                &format!("M{x},{y} m-4,0 a4,4 0 1 1 8,0 a4,4 0 1 1 -8,0 h8 m-4,-4 v8"),
            )
            .with("fill", "none")
            .with("stroke", GREY)
            .empty();
    }
}

fn draw_joints(svg: &mut Svg, mechanism: &Mechanism, sites: &[Site], marks: &[Mark], view: &View) {
    for circle in sites.iter().filter_map(|s| s.pitch).flatten() {
        pitch_circle(svg, view.to_page(circle.centre), circle.radius * view.scale);
    }
    for site in sites.iter().filter(|s| s.grounded) {
        ground(svg, view.to_page(site.place));
    }
    let mut order: Vec<usize> = (0..sites.len()).collect();
    order.sort_by_key(|&k| sites[k].symbol.layer());
    for k in order {
        let group = &mechanism.layout().groups[k];
        let words = match marks[k] {
            Mark::Plain => String::new(),
            mark => format!(": reaction {}", mark.words()),
        };
        svg.element("g").open();
        svg.element("title").text(&format!(
            "{} ({}){words}",
            group.name, group.spec.common.scene_type
        ));
        let [place, end] = [sites[k].place, sites[k].end].map(|p| view.to_page(p));
        sites[k].symbol.draw(svg, place, end, marks[k]);
        svg.close();
    }
}

/// A round length, about a sixth of the page.
fn scale_bar(svg: &mut Svg, view: &View) {
    let length = round_step(0.1 * WIDTH / view.scale);
    let (x0, y) = (MARGIN, view.bottom() + 2.0);
    let x1 = x0 + length * view.scale;
    svg.element("path")
        .with(
            "d",
            &format!(
                "M{},{} v8 M{},{} v8 M{},{} H{}",
                number(x0),
                number(y - 4.0),
                number(x1),
                number(y - 4.0),
                number(x0),
                number(y),
                number(x1)
            ),
        )
        .with("fill", "none")
        .with("stroke", INK)
        .with("stroke-width", "1.4")
        .empty();
    svg.element("text")
        .at([("x", x1 + 8.0), ("y", y + 4.0), ("font-size", TEXT_SIZE)])
        .with("fill", INK)
        .text(&metres(length));
}

/// A time without the last digits of rounding: 0.3, not 0.30000000000000004.
fn shortened(t: f64) -> String {
    let rounded = (t * 1e6).round() / 1e6;
    if rounded.is_finite() && (rounded - t).abs() <= 1e-9 * t.abs() {
        format!("{rounded}")
    } else {
        format!("{t}")
    }
}

fn metres(length: f64) -> String {
    if (1e-3..1e4).contains(&length) {
        // One digit, however the power of ten was rounded.
        let digits = (-length.log10()).ceil().max(0.0) as usize;
        format!("{length:.digits$} m")
    } else {
        format!("{length:.0e} m")
    }
}
