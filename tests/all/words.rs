//! Words that prose must not contain: things do not tell, know or judge, and nouns are named. See
//! CONTRIBUTING.md. Prose is Markdown, comments, and the texts of programs of three words and more;
//! code blocks and code spans are not.

use std::fs;
use std::path::{Path, PathBuf};

use regex_lite::Regex;

/// Each pattern with what to write instead.
const PATTERNS: [(&str, &str); 11] = [
    (r"\b(told|tells?|telling)\b", "report, print, state, show"),
    (r"\bnobody\b", "not, no user"),
    (r"\b(is|are) none\b", "is not, is zero"),
    (r"\bbeside\b", "next to, and, relative to"),
    (r"\bbut for\b", "except, to within"),
    (r"\bhangs? on\b", "depends on"),
    (r"\ball the same\b", "anyway"),
    (r"\b(goes|go|going|went) on\b", "continue"),
    (r"\bhad better\b", "should"),
    (r"\bknows\b", "contains, has"),
    (
        r"(^|[.;:] )(Told|Refused|Stated|Said) (is|are|was|were|of)\b",
        "the subject first",
    ),
];

/// Files and folders that are not prose of ours, and words that are right where they stand.
const EXCEPTIONS: [(&str, &str); 7] = [
    ("THIRD-PARTY.md", "texts of others"),
    ("/target/", "not in the repository"),
    ("/generated", "follows from definitions"),
    ("/docs/reports/", "tables and figures of programs"),
    ("tests/all/words.rs", "the patterns"),
    ("xtask/src/house/tests.rs", "names that are no nouns"),
    ("/tests/ui/", "compared with the compiler, line by line"),
];

fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("readable").flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') || ["node_modules", "target"].contains(&name.as_str()) {
            continue;
        }
        if path.is_dir() {
            files(&path, out);
        } else if [".md", ".rs"].iter().any(|end| name.ends_with(end)) {
            out.push(path);
        }
    }
}

/// Lines of prose with their numbers from 1, without code.
fn prose(text: &str, is_page: bool) -> Vec<(usize, String)> {
    let mut is_code = false;
    let mut lines = Vec::new();
    for (k, line) in text.lines().enumerate() {
        let own = line.trim_start();
        let comment = own
            .strip_prefix("//")
            .map(|rest| rest.trim_start_matches(['/', '!']));
        let written = if is_page { Some(own) } else { comment };
        if written.is_some_and(|line| line.trim_start().starts_with("```")) {
            is_code = !is_code;
            continue;
        }
        match written {
            Some(_) if is_code => {}
            Some(line) => lines.push((k + 1, without_spans(line))),
            None => {
                is_code = false;
                lines.extend(texts(own).map(|text| (k + 1, without_spans(text))));
            }
        }
    }
    lines
}

/// Texts of a line of code that are sentences.
fn texts(line: &str) -> impl Iterator<Item = &str> {
    let quoted = line.split('"').skip(1).step_by(2);
    quoted.filter(|text| text.split_whitespace().count() > 2)
}

/// A line without code spans, without the names of values that are filled in, and without "if there
/// is none", which is right.
fn without_spans(line: &str) -> String {
    let words = line.split('`').step_by(2).collect::<Vec<_>>().join("…");
    let mut parts = words.split('{');
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out.push_str(part.split_once('}').map_or(part, |(_, rest)| rest));
    }
    out.replace("there is none", "")
        .replace("there are none", "")
}

#[test]
fn prose_has_no_forbidden_words() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the root");
    let mut all = Vec::new();
    files(root, &mut all);
    let patterns = PATTERNS.map(|(pattern, instead)| {
        let pattern = Regex::new(&format!("(?i){pattern}")).expect("a pattern");
        (pattern, instead)
    });
    let mut found = Vec::new();
    for path in all {
        let name = path.to_string_lossy().replace('\\', "/");
        if EXCEPTIONS.iter().any(|(part, _)| name.contains(part)) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("readable");
        for (line, words) in prose(&text, name.ends_with(".md")) {
            for (pattern, instead) in &patterns {
                if let Some(hit) = pattern.find(&words) {
                    let hit = hit.as_str();
                    found.push(format!("{name}:{line}: `{hit}`, write {instead}: {words}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "{}: {found:#?}", found.len());
}

#[test]
fn prose_is_found_and_code_is_not() {
    let text =
        "/// A thing tells.\nlet told = \"one\";\nlet x = \"it is told here\"; // no\n/// `told`\n";
    let lines = prose(text, false);
    let words: Vec<&str> = lines.iter().map(|(_, words)| words.trim()).collect();
    assert_eq!(words, ["A thing tells.", "it is told here", "…"]);
    let page = "It tells.\n```rust\n// told\n```\nEnd\n";
    assert_eq!(prose(page, true).len(), 2);
}
