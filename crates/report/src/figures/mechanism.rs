//! The drawing of a mechanism as an SVG figure, to scale. The figure shows the [`DrawingModel`] at
//! one time, with names and a legend.

mod view;

use model::reaction::ConstraintGroup;
use model::{ConstraintKind, Mechanism, System};
use solvability::ReactionVerdict;

use super::FigureError;
use super::axis::round_step;
use super::drawing::{DrawingModel, DrawnSite, Stage};
use super::geometry::posed;
use super::label::{Rect, Request, place};
use super::svg::{Svg, number, text_width};
use super::symbol::{SHAPES, SHORT, SPRING, Shape};
use crate::recording::Frame;
use view::View;

/// Marking of joints and drives.
#[derive(Clone, Copy, Debug)]
pub enum Marking<'a> {
    /// All joints are marked in the same way.
    Plain,
    /// Joints are marked by the verdicts on their reactions.
    Verdicts(&'a [ReactionVerdict]),
}

/// The labels of joints and drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Labels {
    /// Names of joints and drives.
    Names,
    /// Names of joints and drives with the indices of their rows of C, counted from 1, such as
    /// `B 3–4`.
    NamesAndRows,
}

/// Width of the page and largest height of the drawing (px).
const WIDTH: f64 = 960.0;
const LARGEST_HEIGHT: f64 = 640.0;
/// Space around the drawing for names (px).
const ROOM: [f64; 2] = [90.0, 60.0];
/// Margin of the page, and space for the title (px).
const MARGIN: f64 = 16.0;
const TITLE: f64 = 30.0;
/// Sizes of text (px), as in the style sheet.
const NAME_SIZE: f64 = 13.0;
const BODY_SIZE: f64 = 12.0;
/// Largest number of names in a drawing. With more names, the drawing would be unreadable, so only
/// the tool tips contain the names.
const MAX_LABELS: usize = 300;
/// Height of a line of the legend, and width of a symbol in the legend (px).
const LEGEND: [f64; 2] = [36.0, 50.0];
/// Length of a rail beyond its block, and half the length of an axis that is seen from the side
/// (px).
const RAIL: f64 = 30.0;
const AXIS: f64 = 36.0;
/// Distance of the coordinate axes from the left edge and from the lower edge of the drawing, and
/// the largest length of these axes (px).
const TRIAD: [f64; 2] = [46.0, 40.0];
const LONGEST: f64 = 48.0;

/// The style sheet of pages and figures; the first rule defines the colours.
pub const LOOKS: &str = include_str!("picture.css");

/// Draws a mechanism at coordinates q and time t.
///
/// Bodies are drawn as convex hulls of their centres of mass and of the points at which joints and
/// forces act, because their true shapes are unknown. Every symbol has a tool tip with its name,
/// type and verdict.
///
/// # Errors
/// - [`FigureError::Coordinates`], [`FigureError::Coordinate`]: q is not a configuration of the
///   mechanism.
/// - [`FigureError::Verdicts`]: the verdicts belong to another mechanism.
pub fn mechanism(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    marking: Marking<'_>,
) -> Result<String, FigureError> {
    labelled_mechanism(mechanism, t, q, marking, Labels::Names)
}

/// Works like [`mechanism()`], with other labels.
///
/// # Errors
/// Returns the same errors as [`mechanism()`].
pub fn labelled_mechanism(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    marking: Marking<'_>,
    labels: Labels,
) -> Result<String, FigureError> {
    posed(mechanism, t, q, &mut mechanism.scratch())?;
    let marks = marks(mechanism, marking)?;
    let bodies: Vec<usize> = (0..mechanism.bodies().len()).collect();
    let coordinates: Vec<usize> = (0..mechanism.layout().n_q).collect();
    let stage = Stage {
        mechanism,
        bodies: &bodies,
        coordinates: &coordinates,
        frames: &[Frame::at_rest(t, q, mechanism.layout().n_v)],
    };
    let model = stage.drawing(mechanism);
    let view = View::around(&model);
    let legend = legend(mechanism, &model, marking);
    let lines = legend.last().map_or(0.0, |entry| entry.at[1] + 1.0);
    let height = view.bottom() + 24.0 + LEGEND[0] * lines + 6.0;
    let picture = Picture {
        groups: &mechanism.layout().groups,
        svg: Svg::new(WIDTH, height, mechanism.name()),
        model: &model,
        marks,
        view,
    };
    Ok(picture.paint(mechanism.name(), t, labels, &legend))
}

/// The class of each joint and drive.
fn marks(mechanism: &Mechanism, marking: Marking<'_>) -> Result<Vec<&'static str>, FigureError> {
    let expected = mechanism.layout().groups.len();
    let verdicts = match marking {
        Marking::Plain => return Ok(vec!["plain"; expected]),
        Marking::Verdicts(verdicts) => verdicts,
    };
    if verdicts.len() != expected {
        return Err(FigureError::Verdicts {
            mechanism: mechanism.name().to_owned(),
            found: verdicts.len(),
            expected,
        });
    }
    Ok(verdicts.iter().map(|r| r.wrench.verdict.word()).collect())
}

/// A symbol with its meaning.
struct Entry {
    symbol: &'static str,
    mark: &'static str,
    words: String,
    /// Distance from the left (px), and index of the line.
    at: [f64; 2],
}

/// Marks of verdicts, followed by the symbols in the drawing, line by line.
fn legend(mechanism: &Mechanism, model: &DrawingModel, marking: Marking<'_>) -> Vec<Entry> {
    let verdicts = match marking {
        Marking::Plain => &[][..],
        Marking::Verdicts(_) => &["unique", "not_unique", "undecided"],
    };
    let verdicts = verdicts
        .iter()
        .map(|v| ("pin", *v, format!("reaction {}", v.replace('_', " "))));
    let groups = &mechanism.layout().groups;
    let kinds = model.sites.iter().zip(groups).map(|(site, group)| {
        let kind = group.spec.common.scene_type;
        let end = if group.kind == ConstraintKind::Drive {
            " drive"
        } else {
            ""
        };
        (site.symbol, "plain", format!("{kind}{end}"))
    });
    let mut entries: Vec<Entry> = Vec::new();
    let mut at = [MARGIN, 0.0];
    for (symbol, mark, words) in verdicts.chain(kinds) {
        if entries.iter().any(|e| e.words == words) {
            continue;
        }
        let width = LEGEND[1] + text_width(&words, NAME_SIZE) + 10.0;
        let is_first_kind = mark == "plain" && entries.last().is_some_and(|e| e.mark != mark);
        if is_first_kind || at[0] + width > WIDTH - MARGIN {
            at = [MARGIN, at[1] + 1.0];
        }
        entries.push(Entry {
            symbol,
            mark,
            words,
            at,
        });
        at[0] += width;
    }
    entries
}

/// A figure under construction.
struct Picture<'a> {
    groups: &'a [ConstraintGroup],
    model: &'a DrawingModel,
    marks: Vec<&'static str>,
    view: View,
    svg: Svg,
}

impl Picture<'_> {
    fn paint(mut self, name: &str, t: f64, labels: Labels, legend: &[Entry]) -> String {
        self.svg.element("style").text(&looks());
        self.define_hatch();
        self.svg
            .element("text")
            .at([("x", MARGIN), ("y", 28.0)])
            .open();
        self.svg
            .element("tspan")
            .with("font-weight", "bold")
            .text(name);
        let time = format!("t = {} s", shortened(t));
        self.svg.element("tspan").with("dx", "8").text(&time);
        self.svg.close();
        self.bodies();
        self.joints();
        self.forces();
        self.markers();
        self.names(labels);
        self.scale_bar();
        self.legend(legend);
        self.svg.finish()
    }

    fn define_hatch(&mut self) {
        let square = [("width", 4.0), ("height", 4.0)];
        let line = [("width", 1.8), ("height", 4.0)];
        self.svg.element("defs").open();
        self.svg
            .element("pattern")
            .with("id", "hatch")
            .with("patternUnits", "userSpaceOnUse")
            .with("patternTransform", "rotate(45)")
            .at(square)
            .open();
        self.svg
            .element("rect")
            .with("class", "hatch-ground")
            .at(square)
            .empty();
        self.svg
            .element("rect")
            .with("class", "hatch-line")
            .at(line)
            .empty();
        self.svg.close();
        self.svg.close();
    }

    fn bodies(&mut self) {
        for &k in &self.model.order {
            let scale = self.view.scale;
            let (corners, angle) = self.model.silhouette(k);
            let corners = corners.iter().map(|[x, y]| pair([x * scale, -y * scale]));
            let corners: Vec<String> = corners.collect();
            let outline = format!("M{}L{}Z", corners.join("L"), corners[0]);
            let at = self.view.to_page(self.model.centre(k as isize));
            self.group(&format!("body b{}", k % 6), at, angle);
            self.svg.element("title").text(&self.model.bodies[k].name);
            self.svg.element("g").with("class", "hull").open();
            self.path("rim", &outline);
            self.path("flesh", &outline);
            self.svg.close();
            self.strokes("centre");
            self.svg.close();
        }
    }

    /// Opens a group at a position on the page, rotated by an angle (rad).
    fn group(&mut self, class: &str, [x, y]: [f64; 2], angle: f64) {
        let turn = -angle.to_degrees() + 0.0;
        let transform = format!(
            "translate({} {}) rotate({})",
            number(x),
            number(y),
            number(turn)
        );
        let group = self.svg.element("g").with("class", class);
        group.with("transform", &transform).open();
    }

    fn path(&mut self, class: &str, d: &str) {
        let path = self.svg.element("path").with("class", class);
        path.with("d", d).empty();
    }

    fn strokes(&mut self, symbol: &str) {
        for (class, d) in Shape::named(symbol).strokes {
            self.path(class, d);
        }
    }

    /// A symbol at a position on the page.
    fn symbol(&mut self, symbol: &str, class: &str, at: [f64; 2], angle: f64, title: &str) {
        self.group(class, at, angle);
        if !title.is_empty() {
            self.svg.element("title").text(title);
        }
        self.strokes(symbol);
        self.svg.close();
    }

    fn joints(&mut self) {
        let model = self.model;
        for site in &model.sites {
            let place = self.view.to_page(model.at(&site.place));
            for wheel in &site.wheels {
                let corners = model.wheel(wheel).into_iter();
                let corners = corners.map(|p| pair(self.view.to_page(p)));
                let corners: Vec<String> = corners.collect();
                self.path("wheel", &format!("M{}Z", corners.join("L")));
            }
            if site.is_guided() {
                self.rail(site, place);
            } else if site.grounded {
                let shown = self.view.to_page(model.at(site.shown()));
                self.symbol("foot", "", shown, 0.0, "");
            }
        }
        let layer = |k: &usize| SHAPES.iter().position(|s| s.name == model.sites[*k].symbol);
        let mut order: Vec<usize> = (0..model.sites.len()).collect();
        order.sort_by_key(layer);
        for k in order {
            let (site, group, mark) = (&model.sites[k], &self.groups[k], self.marks[k]);
            let [place, shown] =
                [&site.place, site.shown()].map(|p| self.view.to_page(model.at(p)));
            let mut title = format!("{} ({})", group.name, group.spec.common.scene_type);
            if mark != "plain" {
                title += &format!(": reaction {}", mark.replace('_', " "));
            }
            let class = format!("site {mark}");
            if let ("rod", Some(end)) = (site.symbol, &site.end) {
                let end = self.view.to_page(model.at(end));
                let line = format!("M{}L{}", pair(place), pair(end));
                self.path(&format!("rod {mark}"), &line);
                self.symbol("rod", &class, end, 0.0, &title);
            }
            if !site.is_guided() {
                self.axis(site, shown);
            }
            self.symbol(site.symbol, &class, shown, model.angle(site), &title);
        }
    }

    /// The guide of a block, hatched if it is part of the ground.
    fn rail(&mut self, site: &DrawnSite, place: [f64; 2]) {
        let (end, angle) = (
            self.view.to_page(self.model.at(site.shown())),
            self.model.angle(site),
        );
        let along = (end[0] - place[0]) * angle.cos() - (end[1] - place[1]) * angle.sin();
        let (from, to) = (along.min(0.0) - RAIL, along.max(0.0) + RAIL);
        let mut rail = format!("M{} 0H{}", number(from), number(to));
        if site.grounded {
            rail += &format!("M{} 11H{}", number(from), number(to));
            let ticks = ((to - from - 6.0) / 8.0) as usize;
            for k in 0..=ticks {
                rail += &format!("M{} 11l-5 6", number(from + 6.0 + 8.0 * k as f64));
            }
        }
        self.group("", place, angle);
        self.path("rail", &rail);
        self.svg.close();
    }

    /// The rotation axis of a joint in space, as a short line.
    fn axis(&mut self, site: &DrawnSite, [x, y]: [f64; 2]) {
        if let Some([right, up]) = self.model.axis(site) {
            let (dx, dy) = (AXIS * right, -AXIS * up);
            let line = format!("M{}L{}", pair([x - dx, y - dy]), pair([x + dx, y + dy]));
            self.path("rail", &line);
        }
    }

    fn forces(&mut self) {
        let model = self.model;
        for force in &model.forces {
            let points = force
                .points
                .iter()
                .map(|&(b, p)| (b, self.view.to_page(model.held(b, p))));
            let points: Vec<_> = points.collect();
            for &(_, at) in points.iter().filter(|(body, _)| *body < 0) {
                self.symbol("foot", "", at, 0.0, "");
            }
            let title = format!("{} ({})", force.name, force.kind);
            match points[..] {
                [(_, a), (_, b), ..] => self.spring(a, b, &title),
                [(_, at)] => self.symbol("load", "", at, 0.0, &title),
                [] => {
                    let body = force.bodies.iter().rfind(|b| **b >= 0).copied();
                    let at = self.view.to_page(model.centre(body.unwrap_or(-1)));
                    self.symbol("couple", "", at, 0.0, &title);
                }
            }
        }
    }

    fn markers(&mut self) {
        let model = self.model;
        for marker in &model.markers {
            let at = self.view.to_page(model.held(marker.b, marker.p));
            self.symbol("marker", "", at, 0.0, &marker.name);
        }
    }

    fn spring(&mut self, a: [f64; 2], b: [f64; 2], title: &str) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let (length, angle) = (dx.hypot(dy), (-dy).atan2(dx));
        if length <= SHORT {
            return self.symbol("short spring", "", a, angle, title);
        }
        let points = SPRING.map(|[x, y]| pair([x * length, y]));
        self.group("", a, angle);
        self.svg.element("title").text(title);
        self.path("spring", &format!("M{}", points.join("L")));
        self.svg.close();
    }

    /// Writes the names of joints in the colours of their marks, followed by bodies and markers.
    fn names(&mut self, labels: Labels) {
        let (model, view) = (self.model, &self.view);
        let n = model.sites.len() + model.bodies.len() + model.markers.len();
        if n > MAX_LABELS {
            return;
        }
        let texts: Vec<String> = self
            .groups
            .iter()
            .map(|group| match labels {
                Labels::Names => group.name.clone(),
                Labels::NamesAndRows if group.limits.open_side.is_some() => {
                    format!("{} {} one-sided", group.name, group.rows)
                }
                Labels::NamesAndRows => format!("{} {}", group.name, group.rows),
            })
            .collect();
        let shown = model
            .sites
            .iter()
            .map(|s| view.to_page(model.at(s.shown())));
        let shown: Vec<[f64; 2]> = shown.collect();
        let joints = texts.iter().zip(&shown).map(|(text, at)| Request {
            text,
            size: NAME_SIZE,
            anchor: *at,
        });
        let bodies = 0..model.bodies.len();
        let centres = bodies.map(|k| view.to_page(model.centre(k as isize)));
        let centres: Vec<[f64; 2]> = centres.collect();
        let bodies = model.bodies.iter().zip(&centres).map(|(body, at)| Request {
            text: &body.name,
            size: BODY_SIZE,
            anchor: *at,
        });
        let markers = model.markers.iter();
        let marked: Vec<[f64; 2]> = markers
            .map(|m| view.to_page(model.held(m.b, m.p)))
            .collect();
        let markers = model
            .markers
            .iter()
            .zip(&marked)
            .map(|(marker, at)| Request {
                text: &marker.name,
                size: BODY_SIZE,
                anchor: *at,
            });
        let requests: Vec<Request<'_>> = joints.chain(bodies).chain(markers).collect();
        let mut symbols: Vec<Rect> = Vec::new();
        for (site, at) in model.sites.iter().zip(&shown) {
            symbols.push(Shape::named(site.symbol).around(*at, model.angle(site)));
            if site.grounded && !site.is_guided() {
                symbols.push(Shape::named("foot").around(*at, 0.0));
            }
        }
        symbols.extend(
            centres
                .iter()
                .map(|at| Shape::named("centre").around(*at, 0.0)),
        );
        let crosses = marked.iter();
        symbols.extend(crosses.map(|at| Shape::named("marker").around(*at, 0.0)));
        let page = Rect {
            centre: [0.5 * WIDTH, TITLE + 0.5 * view.height],
            half: [0.5 * WIDTH - 4.0, 0.5 * view.height - 4.0],
        };
        let places = place(&page, &symbols, &requests);
        for (k, (request, rect)) in requests.iter().zip(places).enumerate() {
            let Some(Rect { centre: [x, y], .. }) = rect else {
                continue;
            };
            let class = match self.marks.get(k) {
                Some(mark) => format!("name {mark}"),
                None => "name body-name".to_owned(),
            };
            let text = self.svg.element("text").with("class", &class);
            let text = text.at([("x", x), ("y", y + 0.36 * request.size)]);
            text.with("text-anchor", "middle").text(request.text);
        }
    }

    /// In the plane, draws a scale bar of a round length, about a sixth of the page. In space,
    /// draws the axes of the ground, each with a round length.
    fn scale_bar(&mut self) {
        let view = self.model.view;
        if !view.is_plane() {
            return self.triad();
        }
        let length = round_step(0.1 * WIDTH / self.view.scale);
        let (y, pixels) = (self.view.bottom() + 2.0, length * self.view.scale);
        self.svg.element("g").with("class", "scale").open();
        let bar = format!("M{MARGIN} {}v8v-4h{}v-4v8", number(y - 4.0), number(pixels));
        self.path("", &bar);
        let text = self.svg.element("text");
        text.at([("x", MARGIN + pixels + 8.0), ("y", y + 4.0)])
            .text(&metres(length));
        self.svg.close();
    }

    fn triad(&mut self) {
        let length = round_step(0.4 * LONGEST / self.view.scale);
        let at = [TRIAD[0], self.view.bottom() - TRIAD[1]];
        self.svg.element("g").with("class", "scale").open();
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            let axis: [f64; 3] = std::array::from_fn(|j| if j == k { 1.0 } else { 0.0 });
            let [right, up] = self.model.view.flat(axis);
            let to = |pixels: f64| [at[0] + pixels * right, at[1] - pixels * up];
            let arm = length * self.view.scale;
            self.path("", &format!("M{}L{}", pair(at), pair(to(arm))));
            let [x, y] = to(arm + 12.0);
            let text = self.svg.element("text").with("text-anchor", "middle");
            text.at([("x", x), ("y", y + 4.0)]).text(name);
        }
        let text = self.svg.element("text");
        text.at([("x", MARGIN), ("y", self.view.bottom() + 8.0)])
            .text(&format!("axes {}", metres(length)));
        self.svg.close();
    }

    fn legend(&mut self, entries: &[Entry]) {
        let top = self.view.bottom() + 24.0 + 0.5 * LEGEND[0];
        for entry in entries {
            let ([x, line], shape) = (entry.at, Shape::named(entry.symbol));
            let y = top + LEGEND[0] * line;
            let at = [x + 0.5 * LEGEND[1] - 4.0, y - shape.middle];
            self.symbol(entry.symbol, &format!("site {}", entry.mark), at, 0.0, "");
            let text = self.svg.element("text");
            text.at([("x", x + LEGEND[1]), ("y", y + 4.0)])
                .text(&entry.words);
        }
    }
}

/// The style sheet, in which the names of colours are replaced by the colours of the light scheme.
fn looks() -> String {
    let root = LOOKS.split_once(":root {").map_or("", |(_, root)| root);
    let (colours, rules) = root.split_once('}').unwrap_or(("", root));
    let named = colours.split(';').filter_map(|c| c.trim().split_once(": "));
    named.fold(rules.to_owned(), |rules, (name, colour)| {
        rules.replace(&format!("var({name})"), colour)
    })
}

fn pair([x, y]: [f64; 2]) -> String {
    format!("{} {}", number(x), number(y))
}

/// Writes a time without digits that are rounding errors: 0.3, not 0.30000000000000004.
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
        // The number has one significant digit, even if the power of ten has a rounding error.
        let digits = (-length.log10()).ceil().max(0.0) as usize;
        format!("{length:.digits$} m")
    } else {
        format!("{length:.0e} m")
    }
}
