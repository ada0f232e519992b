//! The rows that may be deleted, in words.

use pfaff::report::AnalysisDocument;
use pfaff::report::documents::MakeUniqueDocument;

use crate::output::{count, wrapped};

/// Number of sets that are listed for a reaction if no option requested them.
const WAYS: usize = 1;

/// Number of reactions for which such hints are listed.
pub(super) const HINTS: usize = 8;

/// The hints, or the requested answers if there are any, and the number of admissible sets.
pub(super) fn describe(d: &AnalysisDocument, hints: &[MakeUniqueDocument]) -> String {
    let mut out = String::new();
    let useful = hints.iter().any(|hint| hint.reason.is_none());
    if useful && d.answers.make_unique.is_empty() {
        out.push_str("\nWhat would make it unique (a decision of the designer, not a finding):\n");
        for hint in hints.iter().take(HINTS) {
            out.push_str(&wrapped(
                &format!("- {}: ", hint.reaction),
                &ways(hint, WAYS),
            ));
        }
    }
    if useful && hints.len() > HINTS && d.answers.make_unique.is_empty() {
        out.push_str("- others: `--make-unique NAME`\n");
    }
    for wanted in &d.answers.make_unique {
        out.push_str(&format!(
            "\nTo make {} unique, with the motion as it is ({}):\n",
            wanted.reaction,
            match wanted.allowed {
                "sensible" => "no joint of several rows loses all of them",
                "sensible, whole" =>
                    "joints of several rows would have to keep one; that is not enough",
                "whole" => "joints and drives as a whole",
                _ => "of the rows allowed",
            }
        ));
        match wanted.ways.as_slice() {
            [] => out.push_str(&wrapped("- ", &ways(wanted, 0))),
            all => all
                .iter()
                .for_each(|way| out.push_str(&wrapped("- ", &way.text))),
        }
        if !wanted.complete && wanted.reason.is_none() {
            out.push_str("- and others: the search was not finished\n");
        }
    }
    let Some(eliminations) = d
        .answers
        .eliminations
        .as_ref()
        .filter(|_| d.ranks.redundancy > 0)
    else {
        return out;
    };
    let number = eliminations.count.map(|n| n.to_string());
    let reason = eliminations.reason.clone().unwrap_or_default();
    let sets = match &eliminations.sets {
        None => " (`--eliminations` lists them)".to_owned(),
        Some(sets) => {
            let sets = sets.iter().map(|set| {
                let rows: Vec<String> = set.iter().map(usize::to_string).collect();
                format!("{{{}}}", rows.join(","))
            });
            format!(": {}", sets.collect::<Vec<_>>().join(" "))
        }
    };
    let rows = count(d.ranks.redundancy, "row", "rows");
    let sentence = match number {
        Some(n) => {
            let word = if n == "1" { "set" } else { "sets" };
            format!("{n} {word} of {rows} can be eliminated without a change of motion{sets}")
        }
        None => format!("the sets of {rows} that can be eliminated are not counted: {reason}"),
    };
    out.push('\n');
    out.push_str(&wrapped("", &sentence));
    out
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
