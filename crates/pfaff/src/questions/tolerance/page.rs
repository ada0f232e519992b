//! The page `tolerance.html`. It shows how verdicts, reactions and positions vary if the data vary
//! within their tolerances. The page is a single file without scripts that can be opened offline.

use crate::documents::{
    MarkerRangeDocument, RangeDocument, ReactionRangeDocument, ToleranceDocument,
};
use crate::words::{Cell, html_table};
use model::words::{digits, units};
use report::page::{add, close, list, open};
use report::{Provenance, figures};

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
    let heads = [
        "reaction",
        "verdict as described",
        "samples: unique",
        "not unique",
        "undecided",
        "quantity",
    ];
    let lines = d.reactions.iter().flat_map(reaction_lines);
    let head = cells(heads).chain(cells(RANGE)).chain(cells(["reason"]));
    page.push_str(&html_table(&table(head, lines)));
    page.push_str(
        "<p class=\"grey\">The verdicts in the columns <em>unique</em>, <em>not unique</em> and <em>undecided</em> treat the data of each sample as exact.</p>\n",
    );
    list(page, &d.without_range());
}

/// Columns of a range.
const RANGE: [&str; 9] = [
    "value as described",
    "minimum",
    "5 %",
    "median",
    "95 %",
    "maximum",
    "mean",
    "standard deviation",
    "samples",
];

fn cells<const N: usize>(texts: [&str; N]) -> impl Iterator<Item = Cell> {
    texts.map(Cell::from).into_iter()
}

fn table(
    head: impl Iterator<Item = Cell>,
    lines: impl Iterator<Item = Vec<Cell>>,
) -> Vec<Vec<Cell>> {
    std::iter::once(head.collect()).chain(lines).collect()
}

/// Returns one line of the table for each number of a reaction.
fn reaction_lines(reaction: &ReactionRangeDocument) -> impl Iterator<Item = Vec<Cell>> + '_ {
    let verdict = match (reaction.verdict, reaction.fragile) {
        ("unique", true) => "unique, fragile".to_owned(),
        (verdict, _) => verdict.replace('_', " "),
    };
    let counts = reaction.verdicts;
    let counts = [counts.unique, counts.not_unique, counts.undecided];
    let own = [reaction.name.clone(), verdict].into_iter();
    let own: Vec<String> = own.chain(counts.map(|n| n.to_string())).collect();
    reaction.values.iter().enumerate().map(move |(k, value)| {
        let own = own
            .iter()
            .map(|text| if k == 0 { text.as_str() } else { "" });
        let rigid = if value.reading == "exact" {
            ", rigid"
        } else {
            ""
        };
        let unknown = || value.reason.unwrap_or("no sample determines this value");
        let reason = value.range.as_ref().map_or_else(unknown, |_| "");
        let own = own
            .map(Cell::from)
            .chain([format!("{}{rigid}", value.name).into()]);
        own.chain(range(value.range.as_ref(), value.unit))
            .chain([reason.into()])
            .collect()
    })
}

/// Returns the cells of a range.
fn range(range: Option<&RangeDocument>, unit: &'static str) -> impl Iterator<Item = Cell> {
    let numbers = range.map_or([None; 8], |range| {
        let [low, middle, high] = range.percentiles.map(Some);
        let [least, greatest, mean] = [range.least, range.greatest, range.mean].map(Some);
        let deviation = Some(range.deviation);
        [
            range.described,
            least,
            low,
            middle,
            high,
            greatest,
            mean,
            deviation,
        ]
    });
    let samples = range.map_or_else(String::new, |range| range.samples.to_string());
    let numbers = numbers.into_iter().map(move |x| Cell::quantity(x, unit));
    numbers.chain([samples.into()])
}

fn places(page: &mut String, d: &ToleranceDocument, clouds: &[(String, Vec<[f64; 3]>)]) {
    page.push_str("<h2 id=\"places\">Positions</h2>\n");
    let spatial = d.markers.0.iter().any(|(_, m)| m.described.len() == 3);
    for (name, places) in clouds.iter().take(DRAWN) {
        page.push_str(&figures::cloud(name, places, spatial));
    }
    if !d.markers.is_empty() {
        let unit = units().unprefixed("m").0;
        let positions = ["position as described", "minimum", "maximum"];
        let positions = positions.map(|name| Cell::from(format!("{name} ({unit})")));
        let displaced = cells(["mean displacement", "largest displacement"]);
        let head = cells(["marker", "axis"]).chain(positions).chain(displaced);
        let lines = d.markers.0.iter().flat_map(marker_lines);
        page.push_str(&html_table(&table(head, lines)));
    }
    if !d.measures.is_empty() {
        let lines = d.measures.0.iter().map(|(name, measure)| {
            let range = range(Some(&measure.range), measure.unit);
            cells([name.as_str()]).chain(range).collect()
        });
        let head = cells(["measure"]).chain(cells(RANGE));
        page.push_str(&html_table(&table(head, lines)));
    }
    let head = cells([
        "body",
        "mean displacement",
        "largest displacement",
        "largest rotation",
    ]);
    let lines = d.bodies.0.iter().map(|(name, moved)| {
        let lengths = [moved.mean, moved.greatest].map(|x| Cell::quantity(x, "m"));
        let turned = Cell::quantity(moved.turned, "rad");
        cells([name.as_str()])
            .chain(lengths)
            .chain([turned])
            .collect()
    });
    page.push_str(&html_table(&table(head, lines)));
    page.push_str(
        "<p class=\"grey\">Displacements and rotations are relative to the pose described in the scene. The coordinates of free motions keep the values described in the scene.</p>\n",
    );
}

/// Significant digits of a position, so that the table shows small displacements.
const DIGITS: usize = 7;

/// Returns one line of the table for each coordinate of a marker.
fn marker_lines((name, marker): &(String, MarkerRangeDocument)) -> impl Iterator<Item = Vec<Cell>> {
    let metres = units().unprefixed("m").1;
    let axes = ["x", "y", "z"].iter().zip(&marker.described).enumerate();
    axes.map(move |(k, (axis, described))| {
        let name = if k == 0 { name.as_str() } else { "" };
        let places = [*described, marker.least[k], marker.greatest[k]];
        let places = places.map(|x| Cell::from(digits(x / metres, DIGITS)));
        let displaced = [marker.mean, marker.farthest].map(|x| (k == 0).then_some(x));
        let displaced = displaced.map(|x| match x {
            None => "".into(),
            x => Cell::quantity(x, "m"),
        });
        cells([name, axis]).chain(places).chain(displaced).collect()
    })
}
