//! Text about the rows that may be deleted.

use crate::documents::AnalysisDocument;
use crate::documents::MakeUniqueDocument;

use crate::words::{Block, count, grouped};

/// Number of sets that are listed for a reaction if no option requests them.
const WAYS: usize = 1;

/// Number of reactions with hints.
pub(super) const HINTS: usize = 8;

/// Returns the requested results, or the hints if no results were requested. Also returns the
/// number of admissible sets.
pub(super) fn of(d: &AnalysisDocument, hints: &[MakeUniqueDocument]) -> Vec<Block> {
    let mut out = Vec::new();
    let item = |text: String| Block::after("- ", text);
    if d.answers.make_unique.is_empty() && hints.iter().any(|hint| hint.reason.is_none()) {
        // Reactions with the same set are listed together.
        let hinted = hints.iter().take(HINTS);
        let lines = grouped(hinted.map(|hint| (ways(hint, WAYS), hint.reaction.as_str())));
        let lead = "Design changes for unique reactions";
        if let [(text, _)] = lines.as_slice()
            && hints.iter().all(|hint| hint.ways.is_empty())
        {
            out.extend([Block::Gap, Block::sentence(format!("{lead}: {text}"))]);
        } else {
            let ways = lines.iter();
            let mut ways: Vec<String> = ways
                .map(|(text, names)| format!("{}: {text}", names.join(", ")))
                .collect();
            if hints.len() > HINTS {
                ways.push("others: `--make-unique NAME`".to_owned());
            }
            let ways = ways.join("; ");
            let text = format!("{lead} (all: `--make-unique NAME`): {ways}");
            out.extend([Block::Gap, Block::sentence(text)]);
        }
    }
    for wanted in &d.answers.make_unique {
        let allowed = match wanted.allowed {
            "sensible" => "a joint of several rows keeps at least one",
            "sensible, whole" => "also whole joints, because single rows do not suffice",
            "whole" => "whole joints and drives",
            _ => "only the rows that --allow names",
        };
        out.push(Block::Heading(format!(
            "Ways to make {} unique without changing the motion ({allowed}):",
            wanted.reaction
        )));
        match wanted.ways.as_slice() {
            [] => out.push(item(ways(wanted, 0))),
            all => out.extend(all.iter().map(|way| item(way.text.clone()))),
        }
        if !wanted.complete && wanted.reason.is_none() {
            out.push(item(
                "there may be more ways: the search was not completed".to_owned(),
            ));
        }
    }
    if d.ranks.redundancy > 0
        && let Some(found) = &d.answers.eliminations
    {
        let sentence = [Block::Gap, Block::sentence(eliminations(d))];
        match found.sets {
            Some(_) => out.extend(sentence),
            None => out.extend(sentence.map(|block| Block::Detail(Box::new(block)))),
        }
    }
    out
}

/// Describes the number of sets of rows that can be eliminated, and lists the requested sets.
fn eliminations(d: &AnalysisDocument) -> String {
    let rows = count(d.ranks.redundancy, "row", "rows");
    let Some(found) = &d.answers.eliminations else {
        return String::new();
    };
    let Some(n) = &found.count else {
        let reason = found.reason.as_deref().unwrap_or_default();
        return format!("the sets of {rows} that can be eliminated were not counted: {reason}");
    };
    let sets = match &found.sets {
        None => " (`--eliminations` lists them)".to_owned(),
        Some(sets) => {
            let sets = sets.iter().map(|set| {
                let rows: Vec<String> = set.iter().map(usize::to_string).collect();
                format!("{{{}}}", rows.join(","))
            });
            format!(": {}", sets.collect::<Vec<_>>().join(" "))
        }
    };
    let n = n.to_string();
    let word = if n == "1" { "set" } else { "sets" };
    format!("{n} {word} of {rows} can be eliminated without changing the motion{sets}")
}

/// Describes the first sets, and the number of the other sets.
fn ways(found: &MakeUniqueDocument, most: usize) -> String {
    if let Some(reason) = &found.reason {
        return format!("undecided: {reason}");
    }
    let texts: Vec<&str> = found
        .ways
        .iter()
        .take(most)
        .map(|w| w.text.as_str())
        .collect();
    let more = found.ways.len() - texts.len();
    match (texts.as_slice(), found.complete) {
        ([], true) => "no set of the allowed rows makes it unique".to_owned(),
        ([], false) => "none of the examined sets makes it unique".to_owned(),
        (texts, _) if more == 0 => texts.join("; or "),
        (texts, _) => format!(
            "{} ({more} other {})",
            texts.join("; or "),
            if more == 1 { "way" } else { "ways" }
        ),
    }
}
