//! `tolerance.html`: how far verdicts, reactions and places hold while data vary within their
//! tolerances. One file that opens offline, without scripts.

use crate::documents::{
    MarkerRangeDocument, RangeDocument, ReactionRangeDocument, ToleranceDocument,
};
use report::page::{add, close, list, open, safe};
use report::{Provenance, figures};

use super::words::digits;

/// Reactions and markers that are drawn; the tables have all.
const DRAWN: usize = 24;

/// Explanation of the numbers.
const EXPLANATION: &str = "<p>Each sample is a mechanism whose points, directions and numbers are somewhere within their \
tolerances; it is assembled again from the described pose and analysed there. Numbers are given in two readings. A reaction that is \
<em>unique</em> as described has its values with the redundancy as it is described: redundant rows stay redundant, and play or elasticity \
takes what they miss. For a reaction that is <em>not unique</em> the data may decide what the mechanism leaves open: its values \
are those of rigid parts without play, if all samples determine them. They show how much hangs on the last digits of the data; no real machine \
is as stiff. Histograms show the middle of the samples; the table has the extremes.</p>\n";

/// The page of samples; `clouds` are the places of markers (m), the described one first.
pub(super) fn of(
    d: &ToleranceDocument,
    clouds: &[(String, Vec<[f64; 3]>)],
    provenance: &Provenance,
) -> String {
    let mut page = open(&format!("{}: within tolerances", d.scene));
    let mut sentences = d.sentences();
    let has_range =
        |r: &&ReactionRangeDocument| r.values.first().is_some_and(|v| v.range.is_some());
    let ranged = d.reactions.iter().filter(has_range);
    sentences.extend(ranged.take(3).map(|r| r.sentence.clone()));
    list(&mut page, &sentences);
    page.push_str(EXPLANATION);
    reactions(&mut page, d);
    places(&mut page, d, clouds);
    close(&mut page, provenance);
    page
}

fn reactions(page: &mut String, d: &ToleranceDocument) {
    page.push_str("<h2 id=\"reactions\">Reactions</h2>\n");
    let drawn: Vec<figures::RangeRow<'_>> = (d.reactions.iter())
        .filter_map(|r| {
            let value = r.values.first()?;
            Some(figures::RangeRow {
                name: &r.name,
                what: value.name,
                unit: value.unit,
                is_exact: value.reading == "exact",
                range: value.range.as_ref()?,
            })
        })
        .collect();
    if !drawn.is_empty() {
        page.push_str(&figures::ranges(&drawn[..drawn.len().min(DRAWN)]));
        if drawn.len() > DRAWN {
            let left = drawn.len() - DRAWN;
            add(
                page,
                format_args!("<p class=\"grey\">{left} more are in the table.</p>\n"),
            );
        }
    }
    page.push_str(
        "<div class=\"wide\"><table>\n<tr><th class=\"name\">reaction</th><th class=\"name\">as described</th>\
         <th>unique</th><th>not unique</th><th>undecided</th><th class=\"name\">what</th><th>described</th><th>least</th>\
         <th>5 %</th><th>median</th><th>95 %</th><th>greatest</th><th>mean</th><th>deviation</th><th>samples</th></tr>\n",
    );
    for reaction in &d.reactions {
        reaction_rows(page, reaction);
    }
    page.push_str(
        "</table></div>\n<p class=\"grey\">Verdicts are counted with exact numbers.</p>\n",
    );
    list(page, &d.without_range());
}

/// The numbers of a reaction, each in its row.
fn reaction_rows(page: &mut String, reaction: &ReactionRangeDocument) {
    let verdict = match (reaction.verdict, reaction.fragile) {
        ("unique", true) => "unique, fragile".to_owned(),
        (verdict, _) => verdict.replace('_', " "),
    };
    for (k, value) in reaction.values.iter().enumerate() {
        let counts = reaction.verdicts;
        if k == 0 {
            add(
                page,
                format_args!(
                    "<tr><td class=\"name\"><strong>{}</strong></td><td class=\"name\">{verdict}</td><td>{}</td><td>{}</td><td>{}</td>",
                    safe(&reaction.name),
                    counts.unique,
                    counts.not_unique,
                    counts.undecided
                ),
            );
        } else {
            page.push_str("<tr><td></td><td></td><td></td><td></td><td></td>");
        }
        let rigid = if value.reading == "exact" {
            ", rigid"
        } else {
            ""
        };
        add(
            page,
            format_args!(
                "<td class=\"name\">{} ({}){rigid}</td>",
                value.name, value.unit
            ),
        );
        numbers(page, value.range.as_ref(), value.reason);
        page.push_str("</tr>\n");
    }
}

/// Cells of a range, or why there is no range.
fn numbers(page: &mut String, range: Option<&RangeDocument>, reason: Option<&str>) {
    let Some(range) = range else {
        let reason = reason.unwrap_or("no sample determines it");
        add(
            page,
            format_args!("<td colspan=\"9\" class=\"name grey\">{reason}</td>"),
        );
        return;
    };
    let [low, middle, high] = range.percentiles;
    let described = range.described.map_or("–".to_owned(), digits);
    add(page, format_args!("<td>{described}</td>"));
    let cells = [
        range.least,
        low,
        middle,
        high,
        range.greatest,
        range.mean,
        range.deviation,
    ];
    for x in cells {
        add(page, format_args!("<td>{}</td>", digits(x)));
    }
    add(page, format_args!("<td>{}</td>", range.samples));
}

fn places(page: &mut String, d: &ToleranceDocument, clouds: &[(String, Vec<[f64; 3]>)]) {
    page.push_str("<h2 id=\"places\">Places</h2>\n");
    let spatial = d.markers.0.iter().any(|(_, m)| m.described.len() == 3);
    for (name, places) in clouds.iter().take(DRAWN) {
        page.push_str(&figures::cloud(name, places, spatial));
    }
    if !d.markers.is_empty() {
        page.push_str(
            "<div class=\"wide\"><table>\n<tr><th class=\"name\">marker</th><th class=\"name\">axis</th><th>described (m)</th>\
             <th>least (m)</th><th>greatest (m)</th><th>mean distance (mm)</th><th>largest distance (mm)</th></tr>\n",
        );
        for (name, marker) in &d.markers.0 {
            marker_rows(page, name, marker);
        }
        page.push_str("</table></div>\n");
    }
    if !d.measures.is_empty() {
        page.push_str(
            "<div class=\"wide\"><table>\n<tr><th class=\"name\">measure</th><th>described</th><th>least</th><th>5 %</th>\
             <th>median</th><th>95 %</th><th>greatest</th><th>mean</th><th>deviation</th><th>samples</th></tr>\n",
        );
        for (name, measure) in &d.measures.0 {
            add(
                page,
                format_args!(
                    "<tr><td class=\"name\">{} ({})</td>",
                    safe(name),
                    measure.unit
                ),
            );
            numbers(page, Some(&measure.range), None);
            page.push_str("</tr>\n");
        }
        page.push_str("</table></div>\n");
    }
    page.push_str(
        "<div class=\"wide\"><table>\n<tr><th class=\"name\">body</th><th>moved on average (mm)</th><th>at most (mm)</th>\
         <th>turned at most (mrad)</th></tr>\n",
    );
    for (name, moved) in &d.bodies.0 {
        add(
            page,
            format_args!(
                "<tr><td class=\"name\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                safe(name),
                digits(1e3 * moved.mean),
                digits(1e3 * moved.greatest),
                digits(1e3 * moved.turned)
            ),
        );
    }
    page.push_str(
        "</table></div>\n<p class=\"grey\">Distances from where things are described; free motions stay as they are described.</p>\n",
    );
}

fn marker_rows(page: &mut String, name: &str, marker: &MarkerRangeDocument) {
    for (k, axis) in ["x", "y", "z"]
        .iter()
        .enumerate()
        .take(marker.described.len())
    {
        let name = if k == 0 { safe(name) } else { String::new() };
        add(
            page,
            format_args!(
                "<tr><td class=\"name\">{name}</td><td class=\"name\">{axis}</td><td>{:.6}</td><td>{:.6}</td><td>{:.6}</td>",
                marker.described[k], marker.least[k], marker.greatest[k]
            ),
        );
        let distances = match k {
            0 => [marker.mean, marker.farthest].map(|x| digits(1e3 * x)),
            _ => [String::new(), String::new()],
        };
        let [mean, farthest] = distances;
        add(
            page,
            format_args!("<td>{mean}</td><td>{farthest}</td></tr>\n"),
        );
    }
}
