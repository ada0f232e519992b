//! Compares the answer of the program with exact arithmetic.

use serde_json::{Value, json};

use super::expected::{Elsewhere, Expected, ExpectedReaction, Verdict};
use super::findings::{Findings, Kind, list, rows, share_of_free};
use super::truth::Truth;
use super::{deletions, words};

/// Part of the sentence that a redundancy exists only at this configuration.
const ONLY_HERE: &str = "hold at this singular configuration only";

/// Compares a document with the correct results.
#[must_use]
pub fn examine(truth: &Truth, right: &Expected, answer: &Value) -> Findings {
    let mut findings = Findings::default();
    if ranks_and_reactions(truth, right, answer, &mut findings) {
        words::examine(truth, right, answer, &mut findings);
        deletions::examine(truth, answer, &mut findings);
    }
    findings
}

/// Compares ranks and verdicts, in the plane or in space; returns whether the rank is decided.
pub fn ranks_and_reactions(
    truth: &Truth,
    right: &Expected,
    answer: &Value,
    findings: &mut Findings,
) -> bool {
    let is_decided = answer["evidence"]["status"] == "decided";
    if is_decided {
        ranks(right, answer, findings);
        elsewhere(right, answer, findings);
        kept_rows(truth, answer, findings);
    } else {
        let reason = &answer["evidence"]["reason"];
        findings.note(
            Kind::Undecided,
            format!("rank {}: {reason}", answer["rank"]),
        );
    }
    reactions(right, truth.rounding, answer, findings);
    is_decided
}

/// Compares the verdicts on the reactions of all joints and drives.
pub fn reactions(right: &Expected, rounding: f64, answer: &Value, findings: &mut Findings) {
    for reaction in &right.reactions {
        let mut reactions = list(&answer["reactions"]).iter();
        match reactions.find(|r| r["name"] == reaction.name.as_str()) {
            Some(told) => of_reaction(reaction, told, rounding, findings),
            None => findings.note(Kind::Verdict, format!("{} has no verdict", reaction.name)),
        }
    }
}

fn ranks(right: &Expected, answer: &Value, findings: &mut Findings) {
    for (key, number) in [
        ("rows", right.rows),
        ("rank", right.rank),
        ("redundancy", right.redundancy),
        ("mobility", right.mobility),
    ] {
        findings.number(Kind::Rank, key, &answer[key], number);
    }
    for (key, what, rank) in [
        ("rank_holonomic", "Φq", right.rank_holonomic),
        ("rank_nonholonomic", "Ψ", right.rank_nonholonomic),
    ] {
        let doubt = format!("the rank of {what} alone is undecided");
        let mut warnings = list(&answer["warnings"]).iter();
        if warnings.any(|w| w.as_str().is_some_and(|w| w.contains(&doubt))) {
            findings.note(Kind::Undecided, doubt);
        } else {
            findings.number(Kind::Rank, key, &answer[key], rank);
        }
    }
    if let Some(left) = right.without_drives {
        let without = &answer["without_drives"];
        for (key, number) in [("rank", left.rank), ("redundancy", left.redundancy)] {
            let what = format!("{key} without drives");
            findings.number(Kind::Rank, &what, &without[key], number);
        }
    }
}

/// Compares the statements of the answer about other configurations. No statement is required, but
/// every statement must be correct.
pub(in crate::fuzz) fn elsewhere(right: &Expected, answer: &Value, findings: &mut Findings) {
    let redundancy = right.redundancy as u64;
    let told = answer["generic"]["redundancy"].as_u64();
    let permanent = answer["evidence"]["permanent"].as_bool();
    let mut warnings = list(&answer["warnings"]).iter().filter_map(Value::as_str);
    let falls =
        told.is_some_and(|told| told < redundancy) || warnings.any(|w| w.contains(ONLY_HERE));
    let rises = told.is_some_and(|told| told > redundancy);
    let is_wrong = match right.elsewhere {
        Elsewhere::Same => falls || rises || permanent == Some(false),
        Elsewhere::NotHigher => falls,
        Elsewhere::Higher => permanent == Some(true) || told.is_some_and(|told| told >= redundancy),
        Elsewhere::Unknown => false,
    };
    if is_wrong {
        let text = format!(
            "redundancy {redundancy}, {}: answer {}, permanent {}",
            right.elsewhere.words(),
            answer["generic"]["redundancy"],
            answer["evidence"]["permanent"]
        );
        findings.note(Kind::Sentence, text);
    }
}

/// Checks that the independent rows in the answer are independent, and that their number is the
/// rank.
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

fn of_reaction(right: &ExpectedReaction, answer: &Value, rounding: f64, findings: &mut Findings) {
    let name = &right.name;
    if rows(&answer["rows"]) != right.own_rows() {
        findings.note(
            Kind::Rank,
            format!("{name}: answer rows {}", answer["rows"]),
        );
        return;
    }
    findings.verdict(name, &answer["verdict"], right.is_unique);
    if answer["settled"].is_string() && right.is_unique != Verdict::Unique {
        findings.note(
            Kind::Sentence,
            format!("{name}: settled as {}, is not unique", answer["settled"]),
        );
    }
    findings.verdict(
        &format!("{name}, multipliers"),
        &answer["multipliers"],
        right.multipliers(),
    );
    for row in list(&answer["row_verdicts"]) {
        let what = format!("{name}, row {}", row["row"]);
        let told = rows(&json!([row["row"]])).first().copied();
        match right.rows.iter().find(|(i, ..)| Some(*i) == told) {
            Some((.., is_unique)) => findings.verdict(&what, &row["verdict"], *is_unique),
            None => findings.note(Kind::Rank, what),
        }
    }
    if right.wrench.is_none() {
        return;
    }
    for component in list(&answer["components"]) {
        let axis = component["name"].as_str().unwrap_or_default();
        let what = format!("{name}.{axis}");
        match right.components().iter().find(|(name, _)| *name == axis) {
            Some((_, is_unique)) => findings.verdict(&what, &component["verdict"], *is_unique),
            None => findings.note(Kind::Verdict, format!("{what} is no component")),
        }
    }
    directions(right, answer, rounding, findings);
}

/// Compares the number of unique directions, and checks that no self-stress has a component along
/// these directions.
fn directions(right: &ExpectedReaction, answer: &Value, rounding: f64, findings: &mut Findings) {
    let name = &right.name;
    let Some(wrench) = right.wrench.as_ref().filter(|wrench| !wrench.is_open) else {
        return;
    };
    let directions = list(&answer["unique_directions"]);
    let verdicts = list(&answer["components"]).iter().map(|c| &c["verdict"]);
    if verdicts
        .chain([&answer["verdict"]])
        .any(|v| v == "undecided")
        || answer["unique_directions"].is_null()
    {
        return;
    }
    let live = right.carried - right.free;
    if directions.len() != live {
        // The answer contains no directions if their number is uncertain.
        let kind = if directions.is_empty() {
            Kind::Undecided
        } else {
            Kind::Verdict
        };
        let text = format!(
            "{name}: answer {} unique directions, right {live}",
            directions.len()
        );
        findings.note(kind, text);
        return;
    }
    let told = list(&answer["components"]).iter().map(|c| &c["name"]);
    let place = |name: &Value| wrench.components.iter().position(|(axis, _)| name == axis);
    let axes: Vec<usize> = told.filter_map(place).collect();
    let vectors = directions
        .iter()
        .map(|d| list(d).iter().map(|x| x.as_f64().unwrap_or(f64::NAN)));
    let vectors: Vec<Vec<f64>> = vectors.map(Iterator::collect).collect();
    for direction in &vectors {
        if let Some(share) = share_of_free(&wrench.free, &axes, direction, rounding) {
            let text = format!(
                "{name}: direction {direction:?} is not unique: {share:.1e} of a free wrench"
            );
            findings.note(Kind::Verdict, text);
        }
    }
}
