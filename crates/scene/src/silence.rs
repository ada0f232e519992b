//! `silence` of `[scene]`: the warnings that the author suppresses, by their codes.

use model::codes::Code;
use serde_json::json;

use crate::key::{Key, Takes};
use crate::nearest::{did_you_mean, list};
use crate::table::Table;

/// All warnings about a scene. A warning is never an error, and each warning can be suppressed.
const WARNINGS: [Code; 14] = [
    Code::new(186),
    Code::new(187),
    Code::new(188),
    Code::new(189),
    Code::new(190),
    Code::new(191),
    Code::new(192),
    Code::new(193),
    Code::new(194),
    Code::new(195),
    Code::new(196),
    Code::new(197),
    Code::new(198),
    Code::new(199),
];

/// The codes in the form given in the text.
pub(crate) fn warnings() -> Vec<String> {
    WARNINGS.iter().map(ToString::to_string).collect()
}

const SILENCE: Key = Key::optional(
    "silence",
    "a list of codes of warnings [\"P0192\", …]",
    Takes::Warnings,
)
.doc("Codes of warnings to suppress, because the reported property is intended")
.or(|| json!([]));

/// The key of `[scene]`.
pub(crate) const SCENE_KEYS: [Key; 1] = [SILENCE];

/// Suppresses the warnings that `[scene]` lists.
pub(crate) fn read(table: &mut Table) {
    for item in table.items(&SILENCE) {
        let Some(text) = item.text(SILENCE.expected) else {
            continue;
        };
        if let Some(code) = WARNINGS.iter().find(|code| code.to_string() == text) {
            table.findings.silence(*code);
            continue;
        }
        let codes = warnings();
        let names = || codes.iter().map(String::as_str);
        table.findings.error_with_help(
            const { Code::new(180) },
            item.span(),
            format!("`[scene]`: `silence` contains `{text}`, which is not a warning of a scene"),
            "no such warning",
            did_you_mean(text, names()).or_else(|| Some(format!("there are {}", list(names())))),
        );
    }
}
