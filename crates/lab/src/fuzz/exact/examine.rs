//! Comparison of the answer of the program with exact arithmetic.

use serde_json::{Value, json};

use super::findings::{Findings, Kind, along_free, list, rows};
use super::truth::Truth;
use super::{deletions, words};

/// Compares a document with the correct results.
#[must_use]
pub fn examine(truth: &Truth, answer: &Value) -> Findings {
    let mut findings = Findings::default();
    let is_decided = answer["evidence"]["status"] == "decided";
    if is_decided {
        ranks(truth, answer, &mut findings);
    } else {
        let reason = &answer["evidence"]["reason"];
        findings.note(
            Kind::Undecided,
            format!("rank {}: {reason}", answer["rank"]),
        );
    }
    reactions(truth, answer, &mut findings);
    if is_decided {
        words::examine(truth, answer, &mut findings);
        deletions::examine(truth, answer, &mut findings);
    }
    findings
}

/// Compares the verdicts of all joints and drives.
pub(super) fn reactions(truth: &Truth, answer: &Value, findings: &mut Findings) {
    for (link, placed) in truth.posed.links.iter().enumerate() {
        let name = &placed.link.name;
        let mut reactions = list(&answer["reactions"]).iter();
        match reactions.find(|r| r["name"] == name.as_str()) {
            Some(reaction) => of_reaction(truth, link, reaction, findings),
            None => findings.note(Kind::Verdict, format!("{name} has no verdict")),
        }
    }
}

fn ranks(truth: &Truth, answer: &Value, findings: &mut Findings) {
    let (rows_in_all, rank) = (truth.rows.len(), truth.rank());
    let freedom = 3 * truth.posed.frames.len() - rank;
    findings.number(Kind::Rank, "rows", &answer["rows"], rows_in_all);
    findings.number(Kind::Rank, "rank", &answer["rank"], rank);
    findings.number(
        Kind::Rank,
        "redundancy",
        &answer["redundancy"],
        rows_in_all - rank,
    );
    findings.number(Kind::Rank, "mobility", &answer["mobility"], freedom);
    for (key, what, nonholonomic) in [
        ("rank_holonomic", "Φq", false),
        ("rank_nonholonomic", "Ψ", true),
    ] {
        let doubt = format!("the rank of {what} alone is undecided");
        let mut warnings = list(&answer["warnings"]).iter();
        if warnings.any(|w| w.as_str().is_some_and(|w| w.contains(&doubt))) {
            findings.note(Kind::Undecided, doubt);
        } else {
            findings.number(
                Kind::Rank,
                key,
                &answer[key],
                truth.rank_where(nonholonomic),
            );
        }
    }
    if truth.posed.has_constant_rank {
        let elsewhere = &answer["generic"]["redundancy"];
        if !elsewhere.is_null() {
            let what = "redundancy elsewhere";
            findings.number(Kind::Sentence, what, elsewhere, truth.redundancy());
        }
        if answer["evidence"]["permanent"] == false {
            findings.note(Kind::Sentence, "the rank is the same everywhere".to_owned());
        }
    }
    kept_rows(truth, answer, findings);
}

/// The kept rows must be independent, and their number must be the rank.
pub(super) fn kept_rows(truth: &Truth, answer: &Value, findings: &mut Findings) {
    let (kept, rank) = (rows(&answer["kept_rows"]), truth.rank());
    if kept.len() != rank || truth.rank_of(&kept) != rank {
        let text = format!(
            "the kept rows {} have rank {}",
            answer["kept_rows"],
            truth.rank_of(&kept)
        );
        findings.note(Kind::Rank, text);
    }
}

fn of_reaction(truth: &Truth, link: usize, answer: &Value, findings: &mut Findings) {
    let name = &truth.posed.links[link].link.name;
    let own = truth.rows_of(link);
    if rows(&answer["rows"]) != own {
        findings.note(
            Kind::Rank,
            format!("{name}: answer rows {}", answer["rows"]),
        );
        return;
    }
    let is_unique = truth.is_unique(&own);
    findings.verdict(name, &answer["verdict"], is_unique);
    if answer["settled"].is_string() && !is_unique {
        findings.note(
            Kind::Sentence,
            format!("{name}: settled as {}, is not unique", answer["settled"]),
        );
    }
    let all_rows = own.iter().all(|&i| truth.row_is_unique(i));
    findings.verdict(
        &format!("{name}, multipliers"),
        &answer["multipliers"],
        all_rows,
    );
    for row in list(&answer["row_verdicts"]) {
        let what = format!("{name}, row {}", row["row"]);
        match rows(&json!([row["row"]])).first().copied() {
            Some(i) if own.contains(&i) => {
                findings.verdict(&what, &row["verdict"], truth.row_is_unique(i));
            }
            _ => findings.note(Kind::Rank, what),
        }
    }
    let Some(free) = truth.free_wrenches(link) else {
        return;
    };
    for component in list(&answer["components"]) {
        let axis = component["name"].as_str().unwrap_or_default();
        let is_unique = free.iter().all(|w| w.is_zero(axis, truth.posed));
        findings.verdict(&format!("{name}.{axis}"), &component["verdict"], is_unique);
    }
    directions(truth, link, answer, findings);
}

/// The number of unique directions must be correct, and no solution without loads may have a
/// component along them.
fn directions(truth: &Truth, link: usize, answer: &Value, findings: &mut Findings) {
    let name = &truth.posed.links[link].link.name;
    let directions = list(&answer["unique_directions"]);
    let verdicts = list(&answer["components"]).iter().map(|c| &c["verdict"]);
    if verdicts
        .chain([&answer["verdict"]])
        .any(|v| v == "undecided")
        || answer["unique_directions"].is_null()
    {
        return;
    }
    let right = truth.live_directions(link);
    if directions.len() != right {
        // No directions are given if their number is uncertain.
        let kind = if directions.is_empty() {
            Kind::Undecided
        } else {
            Kind::Verdict
        };
        let text = format!(
            "{name}: answer {} unique directions, right {right}",
            directions.len()
        );
        findings.note(kind, text);
        return;
    }
    let axes = list(&answer["components"]).iter().map(|c| &c["name"]);
    let axes: Vec<usize> = axes
        .filter_map(|name| ["Fx", "Fy", "T"].iter().position(|axis| name == axis))
        .collect();
    let vectors = directions
        .iter()
        .map(|d| list(d).iter().map(|x| x.as_f64().unwrap_or(f64::NAN)));
    let vectors: Vec<Vec<f64>> = vectors.map(Iterator::collect).collect();
    for direction in &vectors {
        if let Some(share) = along_free(truth, link, &axes, direction) {
            let text = format!(
                "{name}: direction {direction:?} is not unique: {share:.1e} of a free wrench"
            );
            findings.note(Kind::Verdict, text);
        }
    }
}
