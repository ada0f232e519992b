//! What a text may have before it is taken apart: the parser needs memory for every value, and
//! nothing is gained by lines that nobody can read. And how well axes of wheels must meet.

use std::ops::Range;

/// Longest line (bytes). A table of a hundred thousand values fits.
pub(crate) const LONGEST_LINE: usize = 4 << 20;

/// Signs `[`, `{`, `,` and `=`. A hundred thousand joints with their bodies have less than two
/// million; each costs some 200 bytes while the file is read.
pub(crate) const MOST_SIGNS: usize = 1 << 23;

/// Axes of two wheels are parallel if the sine of the angle between them is below this; they meet,
/// and their pitch point lies in their plane, if the distance is below this share of those of the
/// bearings and the pitch point from the apex. A line of action meets an axis, or is parallel to
/// it, if its moment about the axis is below this share of that about the bearing.
/// Unit: share. Less: axes written with few digits need a `line`. More: a line of action is not
/// quite normal to the plane of the axes. Test: `bearings_of_teeth`.
pub(crate) const MEETING: f64 = 1e-6;

/// What is beyond a limit: where, what to say, and at its place.
pub(crate) struct Excess {
    pub(crate) span: Range<usize>,
    pub(crate) message: String,
    pub(crate) label: &'static str,
}

/// The first excess of a text, if there is one.
pub(crate) fn excess(text: &str) -> Option<Excess> {
    let mut at = 0;
    for line in text.split('\n') {
        if line.len() > LONGEST_LINE {
            let first = at + LONGEST_LINE;
            let bytes = line.len();
            return Some(Excess {
                span: first..first + 1,
                message: format!(
                    "a line of {bytes} bytes, more than {LONGEST_LINE}: write long lists in several lines"
                ),
                label: "too long",
            });
        }
        at += line.len() + 1;
    }
    let sign = |byte: &u8| matches!(byte, b'[' | b'{' | b',' | b'=');
    let mut signs = text.bytes().enumerate().filter(|(_, byte)| sign(byte));
    let (at, _) = signs.nth(MOST_SIGNS)?;
    Some(Excess {
        span: at..at + 1,
        message: format!(
            "more than {MOST_SIGNS} signs `[`, `{{`, `,` and `=`: too many values for one scene"
        ),
        label: "this one and those that follow",
    })
}
