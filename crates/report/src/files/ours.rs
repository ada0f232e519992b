//! Whether a file was written by this program, as far as its beginning shows. Whatever is not
//! recognised is somebody else's and is not replaced.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Bytes that are read to recognise a file.
const HEAD: u64 = 1 << 12;

/// The beginning of scenes that this program writes.
pub const PROVENANCE: &str = "# Written by pfaff";

/// Whether nothing is lost if a file is replaced: it does not exist, is empty, or was written by
/// this program. What cannot be read is not ours.
#[must_use]
pub fn is_ours(path: &Path) -> bool {
    match head_of(path) {
        Ok(head) => head.is_empty() || has_mark(path, &head),
        // A link that leads nowhere has nothing to lose.
        Err(e) => matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory),
    }
}

/// Whether this program has written a file: only such a file may be removed. A link is of whoever
/// made it.
pub(super) fn is_marked(path: &Path) -> bool {
    is_plain(path) && head_of(path).is_ok_and(|head| has_mark(path, &head))
}

fn head_of(path: &Path) -> io::Result<Vec<u8>> {
    // A pipe would be waited for.
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

/// Whether this is the beginning of a PNG file with this program as its `Software`.
fn is_picture(head: &[u8]) -> bool {
    let named = ["tEXtSoftware\0", crate::figures::SOFTWARE].concat();
    // The name of a chunk is not part of its length.
    let length = (named.len() - 4) as u32;
    let chunk = [&length.to_be_bytes(), named.as_bytes()].concat();
    head.starts_with(b"\x89PNG\r\n\x1a\n") && head.windows(chunk.len()).any(|part| part == chunk)
}

/// Whether this is the header of one of our tables: quantities of bodies, joints and drives over
/// time, runs of a sweep, samples of tolerances, runs of a comparison, matrices or modes.
fn is_table(header: &str) -> bool {
    let mut names = header.split(',');
    match names.next() {
        // Measures at the end of a row have names of their own.
        Some("t") => names.next().is_none_or(|name| name.contains('.')),
        Some("sample") => names.next() == Some("status"),
        Some("run") => names.any(|name| name == "status"),
        // Matrices of a linearised motion, with the names of their columns.
        Some("A" | "B" | "M" | "D" | "K") => names.all(|name| name.contains('.')),
        Some("mode") => header.starts_with("mode,real,imaginary,"),
        Some("scene") => header.starts_with("scene,formulation,method,"),
        _ => false,
    }
}

/// Whether it is a file itself: no link and no directory.
pub(super) fn is_plain(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|known| known.is_file())
}
