//! Text on the ranges of verdicts, reactions and positions.

use crate::documents::{ReactionRangeDocument, ToleranceDocument, distance};
use model::words::rounded;

use crate::words::Block;

/// Number of reactions that also have a sentence.
const IN_WORDS: usize = 3;

/// Largest number of lines of a list; a longer list is cut to its first lines and a count.
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
            "90 % between",
        ];
        let lines = ranged.iter().take(LISTED).filter_map(|r| row(r));
        blocks.push(Block::table(columns, lines));
        blocks.extend(more(ranged.len()));
    }
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

fn more(listed: usize) -> Option<Block> {
    let more = listed.checked_sub(LISTED).filter(|more| *more > 0)?;
    Some(Block::sentence(format!(
        "and {more} more (`--json` prints all)"
    )))
}

fn row(reaction: &ReactionRangeDocument) -> Option<[String; 7]> {
    let value = reaction.values.first()?;
    let range = value.range.as_ref()?;
    let verdict = match (reaction.fragile, value.unique) {
        (true, _) => "unique, FRAGILE".to_owned(),
        (false, true) => "unique".to_owned(),
        (false, false) => reaction.verdict.replace('_', " "),
    };
    let [low, _, high] = range.percentiles.map(digits);
    let what = match value.reading {
        "exact" => format!("{} ({}), rigid", value.name, value.unit),
        _ => format!("{} ({})", value.name, value.unit),
    };
    Some([
        reaction.name.clone(),
        verdict,
        what,
        range.described.map_or("–".to_owned(), digits),
        digits(range.least),
        digits(range.greatest),
        format!("{low} … {high}"),
    ])
}

/// Lists markers and joint coordinates, and the body with the largest displacement.
fn places(d: &ToleranceDocument) -> Vec<Block> {
    let mut blocks = Vec::new();
    for (name, marker) in d.markers.0.iter().take(LISTED) {
        let (farthest, mean) = (distance(marker.farthest), distance(marker.mean));
        blocks.push(Block::sentence(match marker.farthest {
            0.0 => format!("marker {name}: no displacement"),
            _ => format!("marker {name}: displaced by up to {farthest}, {mean} on average"),
        }));
    }
    blocks.extend(more(d.markers.0.len()));
    for (name, measure) in d.measures.0.iter().take(LISTED) {
        let (range, unit) = (&measure.range, measure.unit);
        let [least, greatest] = [range.least, range.greatest].map(digits);
        let described = range.described.map_or(String::new(), |x| {
            format!(" ({} {unit} as described)", digits(x))
        });
        blocks.push(Block::sentence(format!(
            "measure {name}: {least} … {greatest} {unit}{described}"
        )));
    }
    blocks.extend(more(d.measures.0.len()));
    let bodies = d.bodies.0.iter();
    let farthest = bodies.max_by(|a, b| a.1.greatest.total_cmp(&b.1.greatest));
    if let Some((name, moved)) = farthest
        && moved.greatest > 0.0
    {
        blocks.push(Block::sentence(format!(
            "largest displacement: body {name}, up to {}, rotated by up to {:.1e} rad",
            distance(moved.greatest),
            moved.turned
        )));
    }
    blocks
}

/// Formats a number with four significant digits.
pub(super) fn digits(x: f64) -> String {
    let short: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    rounded(short + 0.0)
}
