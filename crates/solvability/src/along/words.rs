//! Describes singular configurations and time intervals as sentences.

use super::data::{Difference, Passage, PassageKind, Stretch};
use crate::limits::{GIVEN_DIGITS, SEARCHED_DIGITS};
use model::words::{digits, short};

/// Describes the event at an instant of a motion. `usual` is the redundancy almost everywhere.
pub(super) fn passage(p: &Passage, usual: usize) -> String {
    let time = format!("at t = {} s", digits(p.time, SEARCHED_DIGITS));
    let [from, to] = p.nearly_singular.map(|t| digits(t, SEARCHED_DIGITS));
    let interval = format!(" (nearly singular from {from} s to {to} s)");
    let what = match &p.kind {
        PassageKind::RankDrops {
            redundancy,
            continuation,
        } => format!(
            "{time} the configuration is singular: the redundancy rises from {usual} to {redundancy} for an instant{interval}; {continuation}"
        ),
        PassageKind::NearlySingular { sigma } => format!(
            "{time} the configuration is nearly singular: smallest singular value {sigma}{interval}; the rank stays, \
             reactions may become large",
            sigma = short(*sigma)
        ),
        PassageKind::Undecided { doubt } => format!(
            "{time} the configuration is so nearly singular that the rank is not decided{interval}: {doubt}"
        ),
    };
    with_differences(what, &p.differences)
}

/// Describes the rank on a time interval of a motion. `usual` is the redundancy almost everywhere.
pub(super) fn stretch(s: &Stretch, usual: usize) -> String {
    let (from, to) = (digits(s.from, GIVEN_DIGITS), digits(s.to, GIVEN_DIGITS));
    format!(
        "from t = {from} s to t = {to} s the redundancy is {} instead of {usual}",
        s.redundancy
    )
}

/// Appends the reactions that change from unique to not unique, and the reverse, to the sentence.
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

/// Returns the name of the reaction if all of its components differ in the same way, and otherwise
/// the name of its component.
fn name(d: &Difference, all: &[Difference]) -> String {
    let whole = |w: &&Difference| w.reaction == d.reaction && w.component.is_none();
    let is_covered = all.iter().find(whole).is_some_and(|w| w.here == d.here);
    match d.component.filter(|_| !is_covered) {
        None => format!("`{}`", d.reaction),
        Some(component) => format!("{component} of `{}`", d.reaction),
    }
}
