//! Text about the ranges of verdicts, reactions and positions.

use crate::documents::{BoundsOfSamples, ReactionRangeDocument, ToleranceDocument};
use model::words::{estimate, quantity};

use crate::words::{Block, Cell};

/// Number of reactions that also have a sentence.
const IN_WORDS: usize = 3;

/// Largest number of lines of a list. A longer list is reduced to its first lines and a count.
const LISTED: usize = 12;

pub(super) fn of(d: &ToleranceDocument) -> Vec<Block> {
    let mut blocks: Vec<Block> = d.sentences().into_iter().map(Block::sentence).collect();
    let has_range =
        |r: &&ReactionRangeDocument| r.values.first().is_some_and(|v| v.range.is_some());
    let ranged: Vec<&ReactionRangeDocument> = d.reactions.iter().filter(has_range).collect();
    if !ranged.is_empty() {
        let columns = [
            "reaction",
            "verdict",
            "what",
            "as described",
            "least",
            "greatest",
            "90 % from",
            "to",
        ];
        let lines = ranged.iter().take(LISTED).filter_map(|r| row(r));
        blocks.push(Block::table(columns, lines));
        blocks.extend(more(ranged.len()));
    }
    blocks.extend(permitted(d));
    blocks.extend(bounds(d));
    let item = |text: String| Block::after("- ", text);
    let first = ranged.iter().take(IN_WORDS).map(|r| r.sentence.clone());
    blocks.extend(first.chain(d.without_range()).map(item));
    let places = places(d);
    if !places.is_empty() {
        blocks.push(Block::Gap);
        blocks.extend(places);
    }
    blocks
}

/// Lists the bounds of the first number of each reaction without a range. The largest bounds come
/// first.
fn bounds(d: &ToleranceDocument) -> Vec<Block> {
    let Some(assumption) = &d.bounds else {
        return Vec::new();
    };
    let known = d.reactions.iter().filter_map(|r| {
        let value = r.values.first()?;
        Some((r, value, value.bounds?))
    });
    let mut known: Vec<_> = known.collect();
    let size = |b: &BoundsOfSamples| b.lowest.abs().max(b.highest.abs());
    known.sort_by(|a, b| size(&b.2).total_cmp(&size(&a.2)));
    if known.is_empty() {
        let words = match d.described.redundancy {
            0 => "no bounds: the described scene has no redundant row",
            _ => {
                "no bounds: they do not exist for some samples, for example because too many joints are rigid; \
                 `analyze --bounds` prints the reason"
            }
        };
        return vec![Block::sentence(words)];
    }
    let lines = known.iter().take(LISTED).map(|(r, value, bounds)| {
        [
            r.name.as_str().into(),
            value.name.into(),
            Cell::quantity(bounds.lowest, value.unit),
            Cell::quantity(bounds.highest, value.unit),
        ]
    });
    let lines: Vec<[Cell; 4]> = lines.collect();
    let mut out = vec![
        Block::Heading("Bounds in all samples:".to_owned()),
        Block::table(["reaction", "what", "lowest", "highest"], lines),
    ];
    out.extend(more(known.len()));
    out.push(Block::after("valid ", assumption));
    out.push(Block::Gap);
    out
}

/// Lists the ranges that one-sided joints permit.
fn permitted(d: &ToleranceDocument) -> Vec<Block> {
    let numbers = d.reactions.iter().flat_map(|r| {
        let values = r.values.iter();
        values.filter_map(move |value| Some((r, value, value.permitted?)))
    });
    let known: Vec<_> = numbers.collect();
    if known.is_empty() {
        return Vec::new();
    }
    let lines = known.iter().take(LISTED).map(|(r, value, range)| {
        let end = |value: Option<f64>, unit| match value {
            Some(_) => Cell::quantity(value, unit),
            None => "no limit".into(),
        };
        [
            r.name.as_str().into(),
            value.name.into(),
            end(range.lowest, value.unit),
            end(range.highest, value.unit),
        ]
    });
    let lines: Vec<[Cell; 4]> = lines.collect();
    let heading =
        "Loads with which the one-sided joints stay closed (contacts may slip), over all samples:";
    let mut out = vec![
        Block::Heading(heading.to_owned()),
        Block::table(["reaction", "what", "lowest", "highest"], lines),
    ];
    out.extend(more(known.len()));
    out.push(Block::Gap);
    out
}

fn more(listed: usize) -> Option<Block> {
    let more = listed.checked_sub(LISTED).filter(|more| *more > 0)?;
    Some(Block::sentence(format!(
        "and {more} more (`--json` prints all)"
    )))
}

fn row(reaction: &ReactionRangeDocument) -> Option<[Cell; 8]> {
    let value = reaction.values.first()?;
    let range = value.range.as_ref()?;
    let verdict = match (reaction.fragile, value.unique) {
        (true, _) => "unique, FRAGILE".to_owned(),
        (false, true) => "unique".to_owned(),
        (false, false) => reaction.verdict.replace('_', " "),
    };
    let what = match value.reading {
        "exact" => format!("{}, rigid", value.name),
        _ => value.name.to_owned(),
    };
    let number = |x: Option<f64>| Cell::quantity(x, value.unit);
    let [low, _, high] = range.percentiles;
    Some([
        reaction.name.clone().into(),
        verdict.into(),
        what.into(),
        number(range.described),
        number(Some(range.least)),
        number(Some(range.greatest)),
        number(Some(low)),
        number(Some(high)),
    ])
}

/// Lists markers and joint coordinates, and the body with the largest displacement.
fn places(d: &ToleranceDocument) -> Vec<Block> {
    let mut blocks = Vec::new();
    for (name, marker) in d.markers.0.iter().take(LISTED) {
        let (farthest, mean) = (quantity(marker.farthest, "m"), quantity(marker.mean, "m"));
        blocks.push(Block::sentence(match marker.farthest {
            0.0 => format!("marker {name}: no displacement"),
            _ => format!("marker {name}: displaced by up to {farthest}, {mean} on average"),
        }));
    }
    blocks.extend(more(d.markers.0.len()));
    let measures = d.measures.0.iter().take(LISTED).map(|(name, measure)| {
        let number = |x: Option<f64>| Cell::quantity(x, measure.unit);
        let range = &measure.range;
        let [least, greatest] = [range.least, range.greatest].map(Some);
        let numbers = [range.described, least, greatest].map(number);
        let [described, least, greatest] = numbers;
        [name.into(), described, least, greatest]
    });
    let measures: Vec<[Cell; 4]> = measures.collect();
    if !measures.is_empty() {
        let columns = ["measure", "as described", "least", "greatest"];
        blocks.push(Block::table(columns, measures));
        blocks.extend(more(d.measures.0.len()));
    }
    let bodies = d.bodies.0.iter();
    let farthest = bodies.max_by(|a, b| a.1.greatest.total_cmp(&b.1.greatest));
    if let Some((name, moved)) = farthest
        && moved.greatest > 0.0
    {
        blocks.push(Block::sentence(format!(
            "largest displacement: body {name}, up to {}, rotated by up to {}",
            quantity(moved.greatest, "m"),
            estimate(moved.turned, "rad")
        )));
    }
    blocks
}
