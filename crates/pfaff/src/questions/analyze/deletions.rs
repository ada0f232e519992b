//! The rows that may be deleted, in words.

use crate::documents::AnalysisDocument;
use crate::documents::MakeUniqueDocument;

use crate::words::{Block, count};

/// Number of sets that are listed for a reaction if no option requested them.
const WAYS: usize = 1;

/// Number of reactions for which such hints are listed.
pub(super) const HINTS: usize = 8;

/// The hints, or the requested answers if there are any, and the number of admissible sets.
pub(super) fn of(d: &AnalysisDocument, hints: &[MakeUniqueDocument]) -> Vec<Block> {
    let mut out = Vec::new();
    let item = |text: String| Block::after("- ", text);
    if d.answers.make_unique.is_empty() && hints.iter().any(|hint| hint.reason.is_none()) {
        let heading = "What would make it unique (a decision of the designer, not a finding):";
        out.push(Block::Heading(heading.to_owned()));
        let hint = |hint: &MakeUniqueDocument| {
            Block::after(format!("- {}: ", hint.reaction), ways(hint, WAYS))
        };
        out.extend(hints.iter().take(HINTS).map(hint));
        if hints.len() > HINTS {
            out.push(item("others: `--make-unique NAME`".to_owned()));
        }
    }
    for wanted in &d.answers.make_unique {
        let allowed = match wanted.allowed {
            "sensible" => "no joint of several rows loses all of them",
            "sensible, whole" => {
                "joints of several rows would have to keep one; that is not enough"
            }
            "whole" => "joints and drives as a whole",
            _ => "of the rows allowed",
        };
        out.push(Block::Heading(format!(
            "To make {} unique, with the motion as it is ({allowed}):",
            wanted.reaction
        )));
        match wanted.ways.as_slice() {
            [] => out.push(item(ways(wanted, 0))),
            all => out.extend(all.iter().map(|way| item(way.text.clone()))),
        }
        if !wanted.complete && wanted.reason.is_none() {
            out.push(item("and others: the search was not finished".to_owned()));
        }
    }
    if d.ranks.redundancy > 0 && d.answers.eliminations.is_some() {
        out.extend([Block::Gap, Block::sentence(eliminations(d))]);
    }
    out
}

/// The number of sets of rows that can be eliminated, and those that were asked for.
fn eliminations(d: &AnalysisDocument) -> String {
    let rows = count(d.ranks.redundancy, "row", "rows");
    let Some(found) = &d.answers.eliminations else {
        return String::new();
    };
    let Some(n) = &found.count else {
        let reason = found.reason.as_deref().unwrap_or_default();
        return format!("the sets of {rows} that can be eliminated are not counted: {reason}");
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
    format!("{n} {word} of {rows} can be eliminated without a change of motion{sets}")
}

/// The first sets in words, and the number of others.
fn ways(found: &MakeUniqueDocument, most: usize) -> String {
    if let Some(reason) = &found.reason {
        return format!("not known: {reason}");
    }
    let texts: Vec<&str> = found
        .ways
        .iter()
        .take(most)
        .map(|w| w.text.as_str())
        .collect();
    let more = found.ways.len() - texts.len();
    match (texts.as_slice(), found.complete) {
        ([], true) => "nothing that is allowed to be deleted makes it so".to_owned(),
        ([], false) => "nothing was found in the sets that were tried".to_owned(),
        (texts, _) if more == 0 => texts.join("; or "),
        (texts, _) => format!(
            "{}; or {more} other {} (`--make-unique \"{}\"`)",
            texts.join("; or "),
            if more == 1 { "way" } else { "ways" },
            found.reaction
        ),
    }
}
