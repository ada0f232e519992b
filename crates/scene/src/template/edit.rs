//! Changes of parts of a text. The rest of the text does not change.

use std::ops::Range;

use toml::de::DeTable;

/// Parts of a text with their new texts.
pub(super) type Edits = Vec<(Range<usize>, String)>;

/// Returns the text with these changes. Returns `None` if the result is not TOML, because keys have
/// an unusual form.
pub(super) fn edited(text: &str, mut edits: Edits) -> Option<String> {
    edits.sort_by_key(|(span, _)| span.start);
    let (mut out, mut end) = (String::with_capacity(text.len()), 0);
    for (span, new) in edits {
        // Two entries that are removed may share a comma.
        out += text.get(end..span.start.max(end))?;
        out += &new;
        end = span.end.max(end);
    }
    out += text.get(end..)?;
    DeTable::parse(&out).is_ok().then_some(out)
}

/// Returns the range of an entry with its line, or with its comma.
pub(super) fn entry(text: &str, span: Range<usize>, is_inline: bool) -> Range<usize> {
    let (before, after) = (&text[..span.start], &text[span.end..]);
    if !is_inline {
        let start = before.rfind('\n').map_or(0, |k| k + 1);
        let line = after.find('\n').map_or(after.len(), |k| k + 1);
        return start..span.end + line;
    }
    let rest = after.trim_start();
    match rest.strip_prefix(',') {
        Some(rest) => span.start..text.len() - rest.trim_start().len(),
        None => before.trim_end().trim_end_matches(',').len()..span.end,
    }
}
