//! What a text may have before it is taken apart: the parser needs memory for every value, and nothing is gained by lines that
//! nobody can read.

use crate::findings::Findings;

/// Longest line (bytes). A table of a hundred thousand values fits.
pub(crate) const LONGEST_LINE: usize = 4 << 20;

/// Signs `[`, `{`, `,` and `=`. A hundred thousand joints with their bodies have less than two million; each costs some 200 bytes while the file is
/// read.
pub(crate) const MOST_SIGNS: usize = 1 << 23;

/// Reports a text that is beyond these limits, where it leaves them.
pub(crate) fn check(findings: &mut Findings) {
    let text = findings.source.text();
    let mut at = 0;
    for line in text.split('\n') {
        if line.len() > LONGEST_LINE {
            let span = at + LONGEST_LINE..at + LONGEST_LINE + 1;
            let message = format!(
                "a line of {} bytes, more than {LONGEST_LINE}: write long lists in several lines",
                line.len()
            );
            return findings.error(span, message, "too long");
        }
        at += line.len() + 1;
    }
    let sign = |byte: &u8| matches!(byte, b'[' | b'{' | b',' | b'=');
    let mut signs = text.bytes().enumerate().filter(|(_, byte)| sign(byte));
    if let Some((at, _)) = signs.nth(MOST_SIGNS) {
        let message = format!(
            "more than {MOST_SIGNS} signs `[`, `{{`, `,` and `=`: too many values for one scene"
        );
        findings.error(at..at + 1, message, "these and those that follow");
    }
}
