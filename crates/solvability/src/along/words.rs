//! Passages and stretches as sentences.

use super::data::{Difference, Part, Passage, PassageKind, Stretch};
use crate::analysis::Analysis;
use crate::limits::{GIVEN_DIGITS, SEARCHED_DIGITS};

/// Describes what happens at an instant.
pub(super) fn passage(p: &Passage, generic: &Analysis) -> String {
    let time = format!("at t = {} s", digits(p.time, SEARCHED_DIGITS));
    let interval = p.nearly_singular.map_or(String::new(), |[from, to]| {
        format!(
            " (nearly singular from {} s to {} s)",
            digits(from, SEARCHED_DIGITS),
            digits(to, SEARCHED_DIGITS)
        )
    });
    let what = match &p.kind {
        PassageKind::RankDrops {
            redundancy,
            continuation,
        } => format!(
            "{time} the configuration is singular: the redundancy rises from {} to {redundancy} for an instant{interval}; {}",
            generic.decision.redundancy, continuation
        ),
        PassageKind::NearlySingular { sigma } => format!(
            "{time} the configuration is nearly singular: smallest singular value {sigma:.3e}{interval}; the rank stays, \
             reactions may become large"
        ),
        PassageKind::Undecided { doubt } => format!(
            "{time} the configuration is so nearly singular that the rank is not decided{interval}: {doubt}"
        ),
        PassageKind::Verdicts => {
            format!("{time} other verdicts hold for an instant, at the same rank")
        }
    };
    with_differences(what, &p.differences)
}

/// Describes what holds on a stretch.
pub(super) fn stretch(s: &Stretch, generic: &Analysis) -> String {
    let (from, to) = (digits(s.from, GIVEN_DIGITS), digits(s.to, GIVEN_DIGITS));
    let usual = generic.decision.redundancy;
    let rank = if s.redundancy == usual {
        "at the same rank".to_owned()
    } else {
        format!("the redundancy is {} instead of {usual}", s.redundancy)
    };
    with_differences(
        format!("from t = {from} s to t = {to} s other verdicts hold, {rank}"),
        &s.differences,
    )
}

/// Appends to the sentence which reactions change from unique to not unique, and the reverse.
fn with_differences(sentence: String, differences: &[Difference]) -> String {
    let named = |word: &str| {
        let changed = differences.iter().filter(|d| d.here.word() == word);
        let mut names: Vec<String> = changed.map(|d| name(d, differences)).collect();
        names.dedup();
        names.join(", ")
    };
    let mut text = sentence;
    for (word, words) in [
        ("not_unique", "not unique here, but elsewhere"),
        ("unique", "unique here, but not elsewhere"),
        ("undecided", "not decided here"),
    ] {
        let names = named(word);
        if !names.is_empty() {
            text.push_str(&format!("; {words}: {names}"));
        }
    }
    text
}

/// Name of the reaction if its whole wrench differs in the same way, or else of the part of it that
/// differs.
fn name(d: &Difference, all: &[Difference]) -> String {
    let whole = |w: &&Difference| w.reaction == d.reaction && w.part == Part::Wrench;
    let is_covered = all.iter().find(whole).is_some_and(|w| w.here == d.here);
    match &d.part {
        _ if is_covered => format!("`{}`", d.reaction),
        Part::Wrench => format!("`{}`", d.reaction),
        Part::Component(component) => format!("{component} of `{}`", d.reaction),
        Part::Row(label) => format!("row {label}"),
    }
}

/// Formats a number with this many significant digits, without trailing zeros.
fn digits(x: f64, digits: i32) -> String {
    let before = if x == 0.0 {
        0
    } else {
        x.abs().log10().floor() as i32
    };
    let decimals = (digits - 1 - before).clamp(0, 12) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') {
        match text.trim_end_matches('0').trim_end_matches('.') {
            "-0" => "0".to_owned(),
            short => short.to_owned(),
        }
    } else {
        text
    }
}
