//! Phrases that several parts of the text use.

use crate::documents::{ComponentDocument, SensitivityDocument, VerdictDocument};
use model::words::{rough, vector};

use crate::words::grouped;

/// Largest number of joints and drives that the text describes one by one.
pub(super) const LINES: usize = 250;

/// Converts a word of the document to prose, such as `not unique` for `not_unique`.
pub(super) fn spoken(word: &str) -> String {
    word.replace('_', " ")
}

/// Returns the text that follows a verdict if the reaction depends on the last digits of the data.
pub(super) fn hanging(data: &SensitivityDocument) -> &'static str {
    if data.fragile { ", FRAGILE" } else { "" }
}

/// Returns the text that follows a verdict if the verdict is valid only within the tolerance. The
/// text contains the margin.
fn within(v: &VerdictDocument) -> String {
    if v.within_tolerance {
        format!(" within the tolerance ({})", rough(v.margin))
    } else {
        String::new()
    }
}

/// Lists components by their verdicts, such as `Fy not unique; Fx, T unique`. Components that are
/// zero under any load come last.
pub(super) fn each(components: &[ComponentDocument]) -> String {
    let verdicts = components.iter().map(|c| {
        let spoken = if c.zero {
            "zero".to_owned()
        } else {
            spoken(c.verdict.verdict)
        };
        let (within, fragile) = (within(&c.verdict), hanging(&c.data));
        (format!("{spoken}{within}{fragile}"), c.name)
    });
    let mut verdicts = grouped(verdicts);
    // Unique components come after components that are not unique.
    verdicts.sort_by_key(|(verdict, _)| (verdict == "zero", verdict.starts_with("unique")));
    let words = verdicts.iter();
    let words = words.map(|(verdict, names)| format!("{} {verdict}", names.join(", ")));
    words.collect::<Vec<_>>().join("; ")
}

/// Formats a point.
pub(super) fn coordinates(point: &[f64]) -> String {
    let largest = point.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    vector(point, largest, "m")
}
