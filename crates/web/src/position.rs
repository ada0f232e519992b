//! Positions in UTF-16 units, which JavaScript and its editors count. A text of the library has
//! positions in bytes.

/// Returns the position in UTF-16 units of a byte. A byte inside of a character counts as the begin
/// of the character.
///
/// ```
/// use pfaff_web::position::{to_byte, to_utf16};
///
/// let text = "µ = \"𝜑\" # φ";
/// assert_eq!((to_utf16(text, 2), to_utf16(text, text.len())), (1, 12));
/// assert_eq!((to_byte(text, 1), to_byte(text, 12)), (2, text.len()));
/// assert_eq!(to_byte(text, 99), text.len());
/// ```
#[must_use]
pub fn to_utf16(text: &str, byte: usize) -> usize {
    text[..text.floor_char_boundary(byte)]
        .encode_utf16()
        .count()
}

/// Returns the byte of a position in UTF-16 units. A position after the end counts as the end.
#[must_use]
pub fn to_byte(text: &str, utf16: usize) -> usize {
    let mut units = 0;
    let mut all = text.char_indices();
    let found = all.find(|(_, c)| {
        units += c.len_utf16();
        units > utf16
    });
    found.map_or(text.len(), |(byte, _)| byte)
}
