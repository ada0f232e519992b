//! The texts of licences in the sources of crates.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::spdx::taken;
use super::{Package, Source};
use crate::tree::root;

/// Starts of the names of licence files, in lower case.
const BEGINNINGS: [&str; 6] = [
    "license",
    "licence",
    "copying",
    "copyright",
    "notice",
    "unlicense",
];

/// Parts of the name of a file that contains the text of one licence, in lower case.
const NAMES: [(&str, &[&str]); 8] = [
    ("MIT", &["mit"]),
    ("Apache-2.0", &["apache"]),
    ("Zlib", &["zlib"]),
    ("BSD-2-Clause", &["bsd"]),
    ("BSD-3-Clause", &["bsd"]),
    ("BSL-1.0", &["boost", "bsl"]),
    ("Unicode-3.0", &["unicode"]),
    ("Unlicense", &["unlicense"]),
];

/// Returns the licence texts of these crates without repetitions. Each text has the list of its
/// crates.
pub(super) fn texts<'p>(
    packages: impl Iterator<Item = &'p Package>,
    sources: &BTreeMap<(String, String), Source>,
) -> Result<Vec<(String, Vec<String>)>, String> {
    let mut texts: BTreeMap<String, (String, Vec<String>)> = BTreeMap::new();
    for package in packages {
        let Package { name, version, .. } = package;
        let source = sources.get(&(name.clone(), version.clone()));
        let source =
            source.ok_or_else(|| format!("cargo metadata does not contain {name} {version}"))?;
        let folder = Path::new(&source.manifest)
            .parent()
            .unwrap_or(Path::new("."));
        let taken = taken(&package.licence)?;
        let mut found = Vec::new();
        for file in files(folder, &taken)? {
            let text = fs::read_to_string(&file);
            found.push(text.map_err(|e| format!("{}: {e}", file.display()))?);
        }
        if found.is_empty() {
            let standard = standard(&taken)?;
            found.push(
                standard.ok_or_else(|| format!("{name} {version} has no text of {taken:?}"))?,
            );
        }
        let authors = match source.authors.join(", ") {
            authors if authors.is_empty() => String::new(),
            authors => format!(" by {authors}"),
        };
        for text in found {
            // Texts that differ only in white space count as equal.
            let same = text.split_whitespace().collect::<Vec<_>>().join(" ");
            let lines: Vec<&str> = text.trim().lines().map(str::trim_end).collect();
            let (_, crates) = texts.entry(same).or_insert((lines.join("\n"), Vec::new()));
            crates.push(format!("{name} {version}{authors}"));
        }
    }
    let mut texts: Vec<_> = texts.into_values().collect();
    texts.sort_by(|(_, a), (_, b)| a.cmp(b));
    Ok(texts)
}

/// The text of a licence for crates whose sources contain no licence text. It is the text in this
/// workspace, and the heading names the authors.
fn standard(taken: &[&str]) -> Result<Option<String>, String> {
    if taken != ["MIT"] {
        return Ok(None);
    }
    let own = fs::read_to_string(root().join("LICENSE-MIT"));
    let own = own.map_err(|e| format!("LICENSE-MIT: {e}"))?;
    let lines = own.lines().map(|line| {
        if line.starts_with("Copyright") {
            "Copyright (c) the authors of the crates named above (their sources have no text)"
        } else {
            line
        }
    });
    Ok(Some(lines.collect::<Vec<_>>().join("\n")))
}

/// Returns the files in a folder that contain these licences or notices.
fn files(folder: &Path, taken: &[&str]) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<(String, PathBuf)> = entries
        .flatten()
        .map(|entry| {
            (
                entry.file_name().to_string_lossy().to_lowercase(),
                entry.path(),
            )
        })
        .filter(|(name, path)| {
            path.is_file() && BEGINNINGS.iter().any(|begin| name.starts_with(begin))
        })
        .collect();
    files.sort();
    let is_of = |name: &str, licence: &str| {
        let words = NAMES.iter().filter(|(of, _)| *of == licence);
        words
            .flat_map(|(_, words)| *words)
            .any(|word| name.contains(word))
    };
    let is_of_one = |name: &str| NAMES.iter().any(|(of, _)| is_of(name, of));
    let has_own = files
        .iter()
        .any(|(name, _)| taken.iter().any(|of| is_of(name, of)));
    files.retain(|(name, _)| {
        if is_of_one(name) {
            return taken.iter().any(|of| is_of(name, of));
        }
        // A file without the name of a licence contains all licences, a copyright, or a notice.
        !has_own || !name.starts_with("licen")
    });
    Ok(files.into_iter().map(|(_, path)| path).collect())
}
