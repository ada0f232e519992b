//! Checks the consistency of the book: contents, links, figures, doc tests. The contract tests of
//! the command compare the output in its examples.

#[path = "../examples/book_figures/figures.rs"]
mod figures;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use joints::spec::Shape;
use pfaff::dynamics::{Method, Stabilisation};
use pfaff::model::{BodySpace, Definitions, Registry};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ lies in the root")
}

fn book() -> PathBuf {
    root().join("docs/book")
}

/// Returns the names of the files in a folder of the book with this ending.
fn files(folder: &str, end: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(book().join(folder)).expect("a folder");
    entries
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(end))
        .collect()
}

fn read(name: &str) -> String {
    fs::read_to_string(book().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Returns the lines outside of code blocks, without inline code.
fn prose(text: &str) -> Vec<String> {
    let mut inside = false;
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            inside = !inside;
        } else if !inside {
            let plain = line.split('`').step_by(2);
            lines.push(plain.collect::<Vec<_>>().join(""));
        }
    }
    lines
}

/// Returns the targets of links and figures.
fn links(text: &str) -> Vec<String> {
    let lines = prose(text);
    let pieces = lines.iter().flat_map(|line| line.split("](").skip(1));
    pieces
        .filter_map(|rest| rest.split(')').next())
        .map(str::to_owned)
        .collect()
}

/// Returns the anchor of a heading: letters, digits, `-` and `_`, blanks as `-`.
fn anchor(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    text.chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

fn anchors(name: &str) -> BTreeSet<String> {
    let lines = headings(&read(name));
    lines.iter().map(|line| anchor(line)).collect()
}

/// Headings, including inline code.
fn headings(text: &str) -> Vec<String> {
    let mut inside = false;
    let mut found = Vec::new();
    for line in text.lines() {
        inside ^= line.starts_with("```");
        if !inside && line.starts_with('#') {
            found.push(line.to_owned());
        }
    }
    found
}

#[test]
fn the_summary_lists_every_chapter_once() {
    let listed = links(&read("SUMMARY.md"));
    let mut chapters = files("", ".md");
    chapters.remove("SUMMARY.md");
    assert_eq!(listed.iter().cloned().collect::<BTreeSet<_>>(), chapters);
    assert_eq!(listed.len(), chapters.len(), "a chapter is listed twice");
}

#[test]
fn every_chapter_is_a_doc_test() {
    let module = fs::read_to_string(root().join("tests/book.rs")).expect("readable");
    for chapter in files("", ".md").iter().filter(|c| *c != "SUMMARY.md") {
        let included = format!("include_str!(\"../docs/book/{chapter}\")");
        assert!(module.contains(&included), "tests/book.rs has no {chapter}");
    }
}

#[test]
fn links_lead_somewhere() {
    let mut seen = 0;
    for chapter in files("", ".md") {
        for link in links(&read(&chapter)) {
            if link.starts_with("https://") {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
            let file = if file.is_empty() { &chapter } else { file };
            // The book that is published contains its own folder only.
            let is_inside = !file.starts_with(['.', '/']);
            assert!(is_inside, "{chapter} links to {link}, outside of the book");
            assert!(book().join(file).exists(), "{chapter} links to {link}");
            let found = heading.is_empty() || anchors(file).contains(heading);
            assert!(
                found,
                "{chapter} links to {link}; there are {:?}",
                anchors(file)
            );
            seen += 1;
        }
    }
    assert!(seen > 50, "{seen} links");
}

#[test]
fn every_chapter_has_one_title_and_headings_of_their_own() {
    for chapter in files("", ".md") {
        let headings = headings(&read(&chapter));
        let titles = headings.iter().filter(|h| h.starts_with("# ")).count();
        assert!(titles == 1 || chapter == "SUMMARY.md", "{chapter}");
        let own: BTreeSet<_> = headings.iter().map(|h| anchor(h)).collect();
        assert_eq!(own.len(), headings.len(), "{chapter}: {headings:?}");
    }
}

/// Figures that the program does not draw: a manual drawing, and pages in a browser, whose fonts
/// differ between machines.
const MADE_OTHERWISE: [&str; 3] = [
    "tipper-drawing.svg",
    "tipper-report.png",
    "four-hinges-report.png",
];

#[test]
fn figures_are_those_of_their_command_and_all_are_shown() {
    let shown: BTreeSet<String> = files("", ".md")
        .iter()
        .flat_map(|chapter| links(&read(chapter)))
        .filter_map(|link| link.strip_prefix("figures/").map(str::to_owned))
        .collect();
    let drawn = figures::all(root()).expect("every figure can be drawn");
    let all = drawn.iter().map(|(name, _)| *name);
    let all = all.chain(MADE_OTHERWISE);
    let names: BTreeSet<String> = all.map(str::to_owned).collect();
    assert_eq!(shown, names);
    assert_eq!(files("figures", ""), names);
    for (name, svg) in drawn {
        assert!(
            svg == read(&format!("figures/{name}")),
            "docs/book/figures/{name} is old: cargo run --release -p tests --example book_figures"
        );
    }
}

/// Checks the types of one space with their keys, rows and joint coordinates.
fn in_space_of<S: BodySpace>(definitions: &Definitions<S>, has: &impl Fn(&str)) {
    let constraints = definitions.constraint_specs();
    for spec in constraints.chain(definitions.force_specs()) {
        has(&format!("| `{}` |", spec.scene_type));
        has(&format!("type = \"{}\"", spec.scene_type));
        if spec.bearings {
            has("`bearings`");
        }
        for parameter in spec.parameters {
            // The reference point has other keys, and a parameter that follows from another
            // parameter or from bearings has no key.
            let is_key = match parameter.shape {
                Shape::Point { .. } | Shape::Axes { like: Some(_), .. } => false,
                Shape::Axes { like: None, .. } => !spec.bearings,
                _ => true,
            };
            if is_key {
                has(parameter.name);
            }
        }
        for definition in definitions.constraints(spec.scene_type) {
            let rows: Vec<_> = definition.spec.rows.iter().map(|row| row.name).collect();
            has(&format!("| `{}` | {} |", spec.scene_type, rows.join(", ")));
            for measure in definition.spec.measures {
                has(&format!("`{}`", measure.name));
            }
        }
    }
}

#[test]
fn the_reference_of_scenes_is_complete() {
    let text = read("scene-format.md");
    let has = |piece: &str| assert!(text.contains(piece), "scene-format.md has no {piece}");
    let registry = Registry::standard();
    in_space_of(registry.plane(), &has);
    in_space_of(registry.space(), &has);
    let choices = Method::ALL.iter().map(|m| m.name());
    for name in choices.chain(Stabilisation::ALL.iter().map(|s| s.name())) {
        has(&format!("`{name}`"));
    }
}

#[test]
fn every_library_has_an_example_of_its_own() {
    // Programs, and crates that only the laboratory and tests use.
    let others = ["bench", "exact", "pfaff-cli", "robot-trolley", "web"];
    let headings = headings(&read("crates.md"));
    for entry in fs::read_dir(root().join("crates"))
        .expect("crates/")
        .flatten()
    {
        let name = entry.file_name().to_string_lossy().into_owned();
        let found = headings.contains(&format!("## {name}"));
        assert_eq!(found, !others.contains(&name.as_str()), "{name}");
    }
}
