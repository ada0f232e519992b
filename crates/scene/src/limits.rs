//! Limits of a text before parsing, because the parser needs memory for every value and very long
//! lines are not readable. Also the accuracy with which axes of wheels must meet.

use std::ops::Range;

/// Longest line (bytes). A table of a hundred thousand values fits.
pub(crate) const LONGEST_LINE: usize = 4 << 20;

/// Maximum number of the characters `[`, `{`, `,` and `=`. A hundred thousand joints with their
/// bodies have less than two million; each character costs some 200 bytes of memory while the file
/// is read.
pub(crate) const MOST_SIGNS: usize = 1 << 23;

/// Axes of two wheels are parallel if the sine of the angle between them is below this limit. The
/// axes meet, and their pitch point is in their plane, if the distance is below this share of two
/// other distances: those of the bearings and of the pitch point from the apex. A line of action
/// meets an axis, or is parallel to it, if its moment about the axis is below this share of its
/// moment about the bearing. Unit: share. Too small: axes written with few digits need a `line`.
/// Too large: a line of action is not quite normal to the plane of the axes. Test:
/// `bearings_of_teeth`.
pub(crate) const MEETING: f64 = 1e-6;

/// A violation of a limit: its position, the message, and the text of the mark.
pub(crate) struct Excess {
    pub(crate) span: Range<usize>,
    pub(crate) message: String,
    pub(crate) label: &'static str,
}

/// The first violation of a limit in a text, if there is one.
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
