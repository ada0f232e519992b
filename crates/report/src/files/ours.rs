//! Decides from the start of a file whether this program has written the file. An unrecognised file
//! counts as a file of another program and is not replaced.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Number of bytes that are read to recognise a file.
const HEAD: u64 = 1 << 12;

/// The start of scenes that this program writes.
pub const PROVENANCE: &str = "# Written by pfaff";

/// Whether a file can be replaced without a loss. This is true if the file does not exist, is
/// empty, or was written by this program. An unreadable file does not count as written by this
/// program.
#[must_use]
pub fn is_ours(path: &Path) -> bool {
    match head_of(path) {
        Ok(head) => head.is_empty() || has_mark(path, &head),
        // Replacing a broken link loses no content.
        Err(e) => matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory),
    }
}

/// Whether this program has written a file. Only these files may be removed. A link counts as
/// created by the user.
pub(super) fn is_marked(path: &Path) -> bool {
    is_plain(path) && head_of(path).is_ok_and(|head| has_mark(path, &head))
}

fn head_of(path: &Path) -> io::Result<Vec<u8>> {
    // Only regular files are read, because reading a pipe would block.
    if !fs::metadata(path)?.is_file() {
        return Err(ErrorKind::InvalidInput.into());
    }
    let mut head = Vec::new();
    File::open(path)?.take(HEAD).read_to_end(&mut head)?;
    Ok(head)
}

fn has_mark(path: &Path, head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    let ending = path.extension().and_then(|ending| ending.to_str());
    match ending.map(str::to_ascii_lowercase).as_deref() {
        Some("csv") => is_table(text.lines().next().unwrap_or_default()),
        Some("json") => {
            let bare: String = text.split_whitespace().collect();
            bare.starts_with("{\"format\":") && bare.contains(",\"version\":\"")
        }
        Some("html") => text.contains("<meta name=\"generator\" content=\"pfaff"),
        Some("svg") => text.contains(crate::figures::GENERATOR),
        Some("toml") => text.starts_with(PROVENANCE),
        Some("parquet") => text.starts_with("PAR1"),
        Some("png") => is_picture(head),
        _ => false,
    }
}

/// Whether these bytes start a PNG file with this program as its `Software`.
fn is_picture(head: &[u8]) -> bool {
    let named = ["tEXtSoftware\0", crate::figures::SOFTWARE].concat();
    // The length of a chunk does not include the name of the chunk.
    let length = (named.len() - 4) as u32;
    let chunk = [&length.to_be_bytes(), named.as_bytes()].concat();
    head.starts_with(b"\x89PNG\r\n\x1a\n") && head.windows(chunk.len()).any(|part| part == chunk)
}

/// Whether this is the header of a table of this program. These tables contain quantities of
/// bodies, joints and drives over time, runs of a sweep, samples of tolerances, runs of a
/// comparison, matrices or modes.
fn is_table(header: &str) -> bool {
    let mut names = header.split(',');
    match names.next() {
        // Measures at the end of a header have arbitrary names.
        Some("t" | "t (s)") => names.next().is_none_or(|name| name.contains('.')),
        Some("sample") => names.next() == Some("status"),
        Some("run") => names.any(|name| name == "status"),
        // Matrices of a linearised motion, with the names of their columns.
        Some("A" | "B" | "M" | "D" | "K") => names.all(|name| name.contains('.')),
        Some("mode") => header.starts_with("mode,real,imaginary,"),
        Some("scene") => header.starts_with("scene,formulation,method,"),
        Some("case") => header.starts_with("case,rank,redundancy,"),
        _ => false,
    }
}

/// Whether the path is a file itself, and neither a link nor a directory.
pub(super) fn is_plain(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|known| known.is_file())
}
