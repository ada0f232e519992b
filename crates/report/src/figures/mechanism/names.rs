//! Names of joints and bodies in the figure of a mechanism.

use std::cmp::Ordering;
use std::ops::Range;

use model::{Mechanism, System};

use super::{Labels, TITLE, View, WIDTH};
use crate::figures::geometry::Site;
use crate::figures::label::{Field, Rect, Request, place};
use crate::figures::outline::sides;
use crate::figures::plot::line;
use crate::figures::style::{GREY, Mark, TEXT_SIZE};
use crate::figures::svg::Svg;
use crate::figures::symbol::GROUND_DEPTH;

/// More names than this are a grey mass: names are then in the tool tips alone.
const MAX_LABELS: usize = 300;

/// What names are drawn on.
pub(super) struct Drawn<'a> {
    pub(super) sites: &'a [Site],
    pub(super) marks: &'a [Mark],
    pub(super) centres: &'a [[f64; 2]],
    pub(super) hulls: &'a [Vec<[f64; 2]>],
    pub(super) view: &'a View,
}

/// Names joints by the colours of their marks, then bodies.
pub(super) fn draw_names(svg: &mut Svg, mechanism: &Mechanism, labels: Labels, drawn: &Drawn<'_>) {
    let Drawn {
        sites,
        marks,
        centres,
        hulls,
        view,
    } = *drawn;
    let groups = &mechanism.layout().groups;
    if groups.len() + hulls.len() > MAX_LABELS {
        return;
    }
    let texts: Vec<[String; 2]> = groups
        .iter()
        .map(|group| match labels {
            Labels::Names => [group.name.clone(), String::new()],
            Labels::NamesAndRows => [group.name.clone(), rows(&group.rows)],
        })
        .collect();
    let whole: Vec<String> = texts.iter().map(|parts| parts.join(" ")).collect();
    let mut symbols: Vec<Rect> = sites.iter().map(|s| symbol_box(s, view)).collect();
    let joints = whole.iter().zip(&symbols).map(|(text, at)| Request {
        text,
        size: TEXT_SIZE,
        anchor: at.centre,
        half: at.half,
    });
    let bodies = mechanism.bodies().iter().zip(hulls).map(|(body, hull)| {
        let n = hull.len() as f64;
        let sum = hull
            .iter()
            .fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
        Request {
            text: &body.name,
            size: TEXT_SIZE,
            anchor: [sum[0] / n, sum[1] / n],
            half: [0.0, 0.0],
        }
    });
    let requests: Vec<Request<'_>> = joints.chain(bodies).collect();
    let feet = sites.iter().filter(|s| s.grounded).map(|s| {
        let [x, y] = view.to_page(s.place);
        Rect {
            centre: [x, y + 0.5 * GROUND_DEPTH],
            half: [16.0, 0.5 * GROUND_DEPTH],
        }
    });
    let marks_of_mass = centres.iter().map(|c| Rect {
        centre: view.to_page(*c),
        half: [4.5, 4.5],
    });
    symbols.extend(feet.chain(marks_of_mass));
    let lines: Vec<_> = hulls.iter().flat_map(|h| sides(h)).collect();
    let field = Field {
        page: Rect {
            centre: [0.5 * WIDTH, TITLE + 0.5 * view.height],
            half: [0.5 * WIDTH - 4.0, 0.5 * view.height - 4.0],
        },
        symbols: &symbols,
        lines: &lines,
    };
    let places = place(&field, &requests);
    for (k, (request, rect)) in requests.iter().zip(places).enumerate() {
        let Some(rect) = rect else { continue };
        match (marks.get(k), texts.get(k)) {
            (Some(mark), Some([text, rows])) => {
                let look = [mark.stroke(), "bold", "normal"];
                name(svg, request, &rect, [text, rows], look);
            }
            _ => {
                let look = [GREY, "normal", "italic"];
                name(svg, request, &rect, [request.text, ""], look);
            }
        }
    }
}

/// Rows as the user counts them.
fn rows(rows: &Range<usize>) -> String {
    let (first, last) = (rows.start + 1, rows.end);
    match last.cmp(&first) {
        Ordering::Greater => format!("{first}–{last}"),
        Ordering::Equal => first.to_string(),
        Ordering::Less => String::new(),
    }
}

fn symbol_box(site: &Site, view: &View) -> Rect {
    let (place, offset) = (view.to_page(site.place), site.symbol.offset());
    Rect {
        centre: [place[0] + offset[0], place[1] + offset[1]],
        half: site.symbol.half_box(),
    }
}

/// A name with a halo, and a line to its anchor if it is not beside it.
fn name(
    svg: &mut Svg,
    request: &Request<'_>,
    rect: &Rect,
    [text, rows]: [&str; 2],
    [colour, weight, slant]: [&str; 3],
) {
    let [dx, dy] = [0, 1].map(|k| rect.centre[k] - request.anchor[k]);
    let gap =
        [0, 1].map(|k| (rect.centre[k] - request.anchor[k]).abs() - rect.half[k] - request.half[k]);
    if gap[0].max(gap[1]) > 14.0 {
        // From the edge of the text to the edge of the symbol.
        let to = (rect.half[0] / dx.abs()).min(rect.half[1] / dy.abs());
        let from = (request.half[0] / dx.abs()).min(request.half[1] / dy.abs());
        let at = |f: f64| [request.anchor[0] + f * dx, request.anchor[1] + f * dy];
        line(svg, at(from), at(1.0 - to), "#a5adb4");
    }
    let element = svg
        .element("text")
        .at([
            ("x", rect.centre[0]),
            ("y", rect.centre[1] + 0.36 * request.size),
            ("font-size", request.size),
        ])
        .with("text-anchor", "middle")
        .with("font-weight", weight)
        .with("font-style", slant)
        .with("fill", colour)
        .with("stroke", "#ffffff")
        .with("stroke-opacity", "0.85")
        .with("stroke-width", "3")
        .with("stroke-linejoin", "round")
        .with("paint-order", "stroke");
    if rows.is_empty() {
        element.text(text);
        return;
    }
    element.open();
    svg.element("tspan").text(text);
    svg.element("tspan")
        .with("font-weight", "normal")
        .with("dx", "3")
        .text(rows);
    svg.close();
}
