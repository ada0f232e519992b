//! The page `tolerance.html`. It shows how verdicts, reactions and positions vary if the data vary
//! within their tolerances. The page is a single file without scripts that can be opened offline.

use crate::documents::{
    MarkerRangeDocument, RangeDocument, ReactionRangeDocument, ToleranceDocument,
};
use report::page::{add, close, list, open, safe};
use report::{Provenance, figures};

use model::words::short;

/// Largest number of reactions and markers that are drawn. The tables contain all reactions and
/// markers.
const DRAWN: usize = 24;

/// Explanation of the numbers on the page.
const EXPLANATION: &str = "<p>Each sample is a mechanism whose points, directions and numbers lie within their tolerances. The sample is \
assembled again from the pose described in the scene and is analysed in the assembled pose. The page computes reactions under one of two \
assumptions. If a reaction is <em>unique</em> as described in the scene, its values assume the redundancy of the described mechanism: \
redundant rows stay redundant, and clearance or elasticity absorbs their constraint violations. If a reaction is <em>not unique</em> as \
described, the data of a sample can determine its value. The page then shows the values for rigid parts without clearance, marked \
<em>rigid</em>, if all samples determine them. These values show how strongly the reaction depends on the last digits of the data. No real \
machine is as stiff as rigid parts without clearance. The histograms show the central part of the samples. The table lists the extremes.</p>\n";

/// Builds the page of the samples. `clouds` contains the positions of markers (m). For each marker,
/// the described position comes first.
pub(super) fn of(
    d: &ToleranceDocument,
    clouds: &[(String, Vec<[f64; 3]>)],
    provenance: &Provenance,
) -> String {
    let mut page = open(&format!("{}: tolerance analysis", d.scene));
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
                format_args!("<p class=\"grey\">The table contains {left} more reactions.</p>\n"),
            );
        }
    }
    page.push_str(
        "<div class=\"wide\"><table>\n<tr><th class=\"name\">reaction</th><th class=\"name\">verdict as described</th>\
         <th>samples: unique</th><th>not unique</th><th>undecided</th><th class=\"name\">quantity</th><th>value as described</th><th>minimum</th>\
         <th>5 %</th><th>median</th><th>95 %</th><th>maximum</th><th>mean</th><th>standard deviation</th><th>samples</th></tr>\n",
    );
    for reaction in &d.reactions {
        reaction_rows(page, reaction);
    }
    page.push_str(
        "</table></div>\n<p class=\"grey\">The verdicts in the columns <em>unique</em>, <em>not unique</em> and <em>undecided</em> treat the data of each sample as exact.</p>\n",
    );
    list(page, &d.without_range());
}

/// Writes the components of a reaction, with one row of the table for each component.
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

/// Writes the cells of a range, or the reason why there is no range.
fn numbers(page: &mut String, range: Option<&RangeDocument>, reason: Option<&str>) {
    let Some(range) = range else {
        let reason = reason.unwrap_or("no sample determines this value");
        add(
            page,
            format_args!("<td colspan=\"9\" class=\"name grey\">{reason}</td>"),
        );
        return;
    };
    let [low, middle, high] = range.percentiles;
    let described = range.described.map_or("–".to_owned(), short);
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
        add(page, format_args!("<td>{}</td>", short(x)));
    }
    add(page, format_args!("<td>{}</td>", range.samples));
}

fn places(page: &mut String, d: &ToleranceDocument, clouds: &[(String, Vec<[f64; 3]>)]) {
    page.push_str("<h2 id=\"places\">Positions</h2>\n");
    let spatial = d.markers.0.iter().any(|(_, m)| m.described.len() == 3);
    for (name, places) in clouds.iter().take(DRAWN) {
        page.push_str(&figures::cloud(name, places, spatial));
    }
    if !d.markers.is_empty() {
        page.push_str(
            "<div class=\"wide\"><table>\n<tr><th class=\"name\">marker</th><th class=\"name\">axis</th><th>position as described (m)</th>\
             <th>minimum (m)</th><th>maximum (m)</th><th>mean displacement (mm)</th><th>largest displacement (mm)</th></tr>\n",
        );
        for (name, marker) in &d.markers.0 {
            marker_rows(page, name, marker);
        }
        page.push_str("</table></div>\n");
    }
    if !d.measures.is_empty() {
        page.push_str(
            "<div class=\"wide\"><table>\n<tr><th class=\"name\">measure</th><th>value as described</th><th>minimum</th><th>5 %</th>\
             <th>median</th><th>95 %</th><th>maximum</th><th>mean</th><th>standard deviation</th><th>samples</th></tr>\n",
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
        "<div class=\"wide\"><table>\n<tr><th class=\"name\">body</th><th>mean displacement (mm)</th><th>largest displacement (mm)</th>\
         <th>largest rotation (mrad)</th></tr>\n",
    );
    for (name, moved) in &d.bodies.0 {
        add(
            page,
            format_args!(
                "<tr><td class=\"name\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                safe(name),
                short(1e3 * moved.mean),
                short(1e3 * moved.greatest),
                short(1e3 * moved.turned)
            ),
        );
    }
    page.push_str(
        "</table></div>\n<p class=\"grey\">Displacements and rotations are relative to the pose described in the scene. The coordinates of free motions keep the values described in the scene.</p>\n",
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
            0 => [marker.mean, marker.farthest].map(|x| short(1e3 * x)),
            _ => [String::new(), String::new()],
        };
        let [mean, farthest] = distances;
        add(
            page,
            format_args!("<td>{mean}</td><td>{farthest}</td></tr>\n"),
        );
    }
}
