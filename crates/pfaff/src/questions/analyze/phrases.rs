//! Phrases that several parts of the text use.

use crate::documents::{ComponentDocument, SensitivityDocument, VerdictDocument};

/// Converts a word of the document to prose, such as `not unique` for `not_unique`.
pub(super) fn spoken(word: &str) -> String {
    word.replace('_', " ")
}

/// Returns the addition to a verdict that depends on the last digits of the data.
pub(super) fn hanging(data: &SensitivityDocument) -> &'static str {
    if data.fragile { ", FRAGILE" } else { "" }
}

/// Returns the addition to a verdict that is valid only within the tolerance, with its margin.
fn within(v: &VerdictDocument) -> String {
    if v.within_tolerance {
        format!(" within the tolerance ({:.1e})", v.margin)
    } else {
        String::new()
    }
}

/// Lists components with their verdicts.
pub(super) fn each(components: &[ComponentDocument]) -> String {
    let words = components.iter();
    let words: Vec<String> = words
        .map(|c| {
            let spoken = spoken(c.verdict.verdict);
            let (within, fragile) = (within(&c.verdict), hanging(&c.data));
            format!("{} {spoken}{within}{fragile}", c.name)
        })
        .collect();
    words.join(", ")
}

/// Formats a point with four decimals.
pub(super) fn coordinates(point: &[f64]) -> String {
    let rounded = |x: &f64| ((1e4 * x).round() / 1e4 + 0.0).to_string();
    let numbers: Vec<String> = point.iter().map(rounded).collect();
    format!("({})", numbers.join(", "))
}
