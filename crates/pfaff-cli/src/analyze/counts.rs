//! The verdicts if there are too many joints and drives for a table: counts by type, and the first
//! names.

use std::collections::BTreeMap;

use pfaff::report::AnalysisDocument;

use crate::output::{columns, wrapped};

/// Number of names that are listed.
const LISTED: usize = 12;

/// Counts by type, and the first names.
pub(super) fn verdicts(d: &AnalysisDocument) -> String {
    const WORDS: [&str; 3] = ["unique", "not_unique", "undecided"];
    let mut by_type: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for r in &d.reactions {
        if let Some(k) = WORDS.iter().position(|word| *word == r.wrench.verdict) {
            by_type.entry(r.kind).or_default()[k] += 1;
        }
    }
    let header = ["type", "reactions", "unique", "not unique", "undecided"];
    let mut table = vec![header.map(str::to_owned).to_vec()];
    for (kind, counts) in &by_type {
        let total: usize = counts.iter().sum();
        let numbers = [total, counts[0], counts[1], counts[2]];
        let mut line = vec![(*kind).to_owned()];
        line.extend(numbers.map(|n| n.to_string()));
        table.push(line);
    }
    let mut out = format!("\n{}", columns(&table));
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
            listed += &format!(" and {} more (`--json` lists all)", names.len() - LISTED);
        }
        out.push('\n');
        out.push_str(&wrapped(said, &listed));
    }
    out
}
