//! The meaning of the code of an error, and the possible remedies.

use model::codes::{Code, Entry, Example};

use crate::refusal::Refusal;
use crate::words::wrapped;

/// Finds the entry of a code, such as `P0102`.
///
/// # Errors
/// Returns an error if there is no such code.
pub fn entry(text: &str) -> Result<&'static Entry, Refusal> {
    Code::find(text).ok_or_else(|| {
        Refusal::input(format!(
            "there is no code `{text}`; `pfaff explain` lists all"
        ))
    })
}

/// Returns the meaning and the remedies as text.
#[must_use]
pub fn words(entry: &Entry) -> String {
    let mut text = wrapped(&format!("{}: ", entry.code), entry.title);
    text.push_str(&wrapped("what to do: ", entry.advice));
    match entry.example {
        Example::Scene(arguments, scene) => {
            text.push_str(&format!("example: pfaff {arguments}, with the scene\n\n"));
            for line in scene.trim().lines() {
                text.push_str(format!("    {line}").trim_end());
                text.push('\n');
            }
        }
        Example::Command(arguments) => text.push_str(&format!("example: pfaff {arguments}\n")),
        Example::None(reason) => text.push_str(&format!("no short example: {reason}\n")),
    }
    text
}
