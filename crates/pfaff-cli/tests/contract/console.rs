//! Console blocks in pages: the output in a page must be the output of the command.
//!
//! A block is fenced as `console`. A line that begins with `$ pfaff ` is run, in a folder with the
//! scenes of the pages at their paths in the repository. The lines up to the next `$ ` are its
//! output, errors last. A line `…` represents any number of lines, possibly zero. Other commands
//! (`$ cargo …`) are not run.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{Folder, stderr, stdout};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Represents lines that a page omits.
const OMISSION: &str = "…";

/// A command of a page and the lines that it shows.
struct Shown<'a> {
    line: usize,
    command: &'a str,
    output: Vec<&'a str>,
}

/// Returns all commands in the console blocks of a page.
fn shown(page: &str) -> Vec<Shown<'_>> {
    let mut found: Vec<Shown<'_>> = Vec::new();
    let mut is_console = false;
    let mut is_open = false;
    for (number, line) in page.lines().enumerate() {
        match line.strip_prefix("```") {
            Some(language) => {
                is_console = language == "console" && !is_console;
                is_open = false;
            }
            None if !is_console => {}
            None => match (line.strip_prefix("$ "), found.last_mut()) {
                (Some(command), _) => {
                    is_open = true;
                    found.push(Shown {
                        line: number + 1,
                        command,
                        output: Vec::new(),
                    });
                }
                (None, Some(last)) if is_open => last.output.push(line),
                (None, _) => panic!("line {}: a console block begins with `$ `", number + 1),
            },
        }
    }
    found
}

/// Returns the words of a command line; a quoted word may contain blanks.
fn words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in command.chars() {
        match (c, quote) {
            (c, Some(q)) if c == q => quote = None,
            ('"' | '\'', None) => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (' ', None) => words.extend(word.take()),
            (c, _) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// Whether lines match a pattern with omissions; otherwise it returns the first part of the pattern
/// that does not occur.
fn matches<'a>(pattern: &[&'a str], lines: &[&str]) -> Result<(), Vec<&'a str>> {
    let stretches: Vec<&[&str]> = pattern.split(|line| *line == OMISSION).collect();
    let mut rest = lines;
    for (k, stretch) in stretches.iter().enumerate() {
        let (is_first, is_last) = (k == 0, k + 1 == stretches.len());
        let at = match (is_first, is_last) {
            (true, true) => (rest == *stretch).then_some(0),
            (true, false) => rest.starts_with(stretch).then_some(0),
            (false, true) => rest.ends_with(stretch).then(|| rest.len() - stretch.len()),
            (false, false) => (0..=rest.len()).find(|at| rest[*at..].starts_with(stretch)),
        };
        match at {
            Some(at) => rest = &rest[at + stretch.len()..],
            None => return Err(stretch.to_vec()),
        }
    }
    Ok(())
}

/// Creates a folder with the scenes that the pages use.
fn scenes(name: &str) -> Folder {
    let folder = Folder::new(name);
    for place in ["examples", "crates/robot-trolley"] {
        let to = folder.0.join(place);
        fs::create_dir_all(&to).expect("a folder can be made");
        let from = Path::new(ROOT).join(place);
        for entry in fs::read_dir(from).expect("readable") {
            let path = entry.expect("readable").path();
            if path.extension().is_some_and(|e| e == "toml") {
                let name = path.file_name().expect("a file");
                fs::copy(&path, to.join(name)).expect("a scene can be copied");
            }
        }
    }
    folder
}

/// Runs every `$ pfaff` of a page and compares the output; returns the number of commands.
fn check(page: &Path, folder: &Folder) -> usize {
    let text = fs::read_to_string(page).unwrap_or_else(|e| panic!("{}: {e}", page.display()));
    let mut count = 0;
    for shown in shown(&text) {
        let words = words(shown.command);
        let Some((_, arguments)) = words.split_first().filter(|(first, _)| *first == "pfaff")
        else {
            continue;
        };
        count += 1;
        let output = Command::new(env!("CARGO_BIN_EXE_pfaff"))
            .args(arguments)
            .current_dir(&folder.0)
            .output()
            .expect("the command starts");
        let printed = stdout(&output) + &stderr(&output);
        let lines: Vec<&str> = printed.lines().map(str::trim_end).collect();
        if let Err(missing) = matches(&shown.output, &lines) {
            panic!(
                "{}:{}: `{}` does not print, in this place,\n\n{}\n\nIt prints\n\n{printed}",
                page.display(),
                shown.line,
                shown.command,
                missing.join("\n"),
            );
        }
    }
    count
}

/// Checks all pages directly in a folder of the repository; each must contain at least one command.
fn check_pages(place: &str) {
    let folder = scenes(&format!("pages of {}", place.replace('/', " ")));
    let entries = fs::read_dir(Path::new(ROOT).join(place)).expect("readable");
    let mut pages: Vec<PathBuf> = entries
        .map(|e| e.expect("readable").path())
        .filter(|p| p.extension().is_some_and(|e| e == "md"))
        .collect();
    pages.sort();
    assert!(!pages.is_empty(), "{place} has no pages");
    for page in pages {
        let count = check(&page, &folder);
        assert!(count > 0, "{} shows no command", page.display());
    }
}

#[test]
fn the_gallery_shows_what_the_command_prints() {
    check_pages("examples");
}

/// The beginnings of warnings that some examples demonstrate.
const WARNED: [(&str, &str); 2] = [
    (
        "chebyshev.toml",
        "mobility 1 at first order, but this mechanism cannot move",
    ),
    (
        "truck.toml",
        "redundancy 2 and its verdicts hold at this singular configuration only",
    ),
];

/// Every example is read without output on standard error, and analysed without warnings except the
/// intended ones.
#[test]
fn the_gallery_is_read_in_silence() {
    let folder = scenes("the gallery in silence");
    for entry in fs::read_dir(folder.0.join("examples")).expect("readable") {
        let path = entry.expect("readable").path();
        let scene = path.to_str().expect("UTF-8");
        for arguments in [["check", scene].as_slice(), &["analyze", scene, "--json"]] {
            let output = super::pfaff(arguments);
            assert_eq!(output.status.code(), Some(0), "{scene}");
            assert_eq!(stderr(&output), "", "{scene}");
            let text = stdout(&output);
            if arguments[0] == "analyze" {
                let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
                let warnings = document["warnings"].as_array().expect("an array");
                let meant = |w: &&serde_json::Value| {
                    let text = w.as_str().unwrap_or_default();
                    let mut known = WARNED.iter();
                    known.any(|(of, begins)| scene.ends_with(of) && text.starts_with(begins))
                };
                assert!(warnings.iter().all(|w| meant(&w)), "{scene}: {warnings:?}");
            }
        }
    }
}

#[test]
fn a_page_that_shows_something_else_is_noticed() {
    let lines = ["a", "b", "c", "d"];
    for right in [
        vec!["a", "b", "c", "d"],
        vec!["a", "…", "d"],
        vec!["…", "b", "c", "…"],
        vec!["a", "b", "…", "c", "d"],
        vec!["…"],
    ] {
        assert!(matches(&right, &lines).is_ok(), "{right:?}");
    }
    for wrong in [
        vec![],
        vec!["a", "b"],
        vec!["b", "…"],
        vec!["a", "…", "c"],
        vec!["…", "b", "d", "…"],
        vec!["…", "c", "…", "b", "…"],
        vec!["a", "…", "c", "…", "c", "d"],
    ] {
        assert!(matches(&wrong, &lines).is_err(), "{wrong:?}");
    }
    assert_eq!(
        words("pfaff a --b \"c d\" ''"),
        ["pfaff", "a", "--b", "c d", ""]
    );
}

#[test]
fn commands_and_their_output_are_found_in_a_page() {
    let page = "text\n```toml\n$ no\n```\n```console\n$ pfaff a\nx\n\ny\n$ pfaff b\n```\n";
    let found = shown(page);
    let commands: Vec<(usize, &str)> = found.iter().map(|s| (s.line, s.command)).collect();
    assert_eq!(commands, [(6, "pfaff a"), (10, "pfaff b")]);
    assert_eq!(found[0].output, ["x", "", "y"]);
    assert!(found[1].output.is_empty());
}
