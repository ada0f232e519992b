//! Limits of a text. They are checked before parsing, because the parser needs memory for every
//! value and very long lines are not readable. The module also defines how accurately the axes of
//! wheels must meet.

use std::ops::Range;

/// Longest line. This is sufficient for a table of 100 000 values. Unit: bytes. Too small: long
/// tables are rejected. Too large: errors in one line take too much time. Test:
/// `large_texts_are_refused_at_once`.
pub(crate) const LONGEST_LINE: usize = 4 << 20;

/// Maximum number of the characters `[`, `{`, `,` and `=`. The text of 100 000 joints with their
/// bodies contains less than two million of these characters. While the file is read, each
/// character needs about 200 bytes of memory. Unit: number. Too small: large scenes are rejected.
/// Too large: the memory of small machines is insufficient. Test:
/// `large_texts_are_refused_at_once`.
pub(crate) const MOST_SIGNS: usize = 1 << 23;

/// Two axes of wheels are parallel if the sine of the angle between them is below this limit.
/// Parallel axes of bearings coincide if their distance is at most this fraction of the largest
/// distance among the points of the bearings and the centres of mass of their bodies. The axes
/// meet, and the pitch point is in their plane, if the distance is below this fraction of the
/// largest distance among the bearings, the pitch point and the apex. A line of action meets an
/// axis, or is parallel to it, if its moment about the axis is below this fraction of its moment
/// about the bearing. Unit: share. Too small: axes that are given with few digits need a `line`.
/// Too large: a line of action is not quite normal to the plane of the axes. Test:
/// `bearings_of_teeth`.
pub(crate) const MEETING: f64 = 1e-6;

/// Largest plausible ratio of a given force to the weight of all bodies. A force of 5 kN that is
/// given as 5000 kN, or masses that are given in tonnes, make it 1000 times too large. Unit: share.
/// Too small: a jack or a cylinder that lifts an additional load gives a warning. Too large: a
/// wrong unit causes no warning. Test: `a_force_of_a_hundred_weights_is_reported`.
pub(crate) const HEAVIEST_FORCE: f64 = 100.0;

/// Largest plausible ratio of the length of a spring at the start to its free length. The length of
/// a drawing in mm that is read in m makes the ratio 1000 times too small or too large. Unit:
/// share. Too small: a rubber band, which stretches to 8 times its length, gives a warning. Too
/// large: a free length in cm that is read as mm causes no warning. Test:
/// `a_spring_of_ten_free_lengths_is_reported`.
pub(crate) const LONGEST_SPRING: f64 = 10.0;

/// Number of equal parts of the run. At the ends of these parts, expressions of the time must have
/// a value, and forces are compared with the weight. Unit: number. Too small: an expression without
/// a value stops the run instead of being reported at its position. Too large: reading a scene with
/// many functions takes longer. Test: `a_force_of_a_hundred_weights_is_reported`.
pub(crate) const RUN_INSTANTS: u32 = 100;

/// A violation of a limit: its position, the message, and the text at the mark.
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
