//! Text about the verdicts for mechanisms with too many joints and drives for a table: counts by
//! type, and the first names.

use std::collections::BTreeMap;

use crate::documents::AnalysisDocument;

use crate::words::Block;

/// Number of names that are listed.
const LISTED: usize = 12;

/// Counts verdicts by type, and lists the first names.
pub(super) fn verdicts(d: &AnalysisDocument) -> Vec<Block> {
    const WORDS: [&str; 3] = ["unique", "not_unique", "undecided"];
    let mut by_type: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for r in &d.reactions {
        if let Some(k) = WORDS.iter().position(|word| *word == r.wrench.verdict) {
            by_type.entry(r.kind).or_default()[k] += 1;
        }
    }
    let lines = by_type.iter().map(|(kind, [unique, open, undecided])| {
        let numbers = [unique + open + undecided, *unique, *open, *undecided];
        let [all, unique, open, undecided] = numbers.map(|n| n.to_string());
        [(*kind).to_owned(), all, unique, open, undecided]
    });
    let header = ["type", "reactions", "unique", "not unique", "undecided"];
    let mut out = vec![Block::table(header, lines)];
    let of_word = |word: &str| -> Vec<String> {
        let reactions = d.reactions.iter().filter(|r| r.wrench.verdict == word);
        reactions.map(|r| r.name.clone()).collect()
    };
    for (names, said) in [
        (of_word("not_unique"), "not unique: "),
        (of_word("undecided"), "undecided: "),
        (d.fragile_names(), "unique but FRAGILE: "),
    ] {
        if names.is_empty() {
            continue;
        }
        let mut listed = names[..names.len().min(LISTED)].join(", ");
        if names.len() > LISTED {
            listed += &format!(" and {} more (`--json` prints all)", names.len() - LISTED);
        }
        out.extend([Block::Gap, Block::after(said, listed)]);
    }
    out
}
