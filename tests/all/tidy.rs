//! Rules of the project that the compiler does not check; see ARCHITECTURE.md.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ lies in the root")
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn crates() -> BTreeSet<String> {
    let entries = fs::read_dir(root().join("crates")).expect("crates/ exists");
    entries
        .map(|e| {
            e.expect("readable")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect()
}

/// Returns the workspace crates on which a crate depends outside of tests.
fn dependencies(name: &str) -> BTreeSet<String> {
    let manifest = read(format!("crates/{name}/Cargo.toml"));
    let section = manifest
        .split("\n[dependencies]")
        .nth(1)
        .unwrap_or_default();
    let section = section.split("\n[").next().unwrap_or_default();
    let names = section
        .lines()
        .filter_map(|line| line.split(['.', ' ', '=']).next());
    names
        .filter(|n| crates().contains(*n))
        .map(str::to_owned)
        .collect()
}

/// Lists our Rust files that are not generated.
fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("readable").flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        if path.is_dir()
            && !["target", "node_modules", "generated", "definitions", "ui"]
                .contains(&name.as_str())
        {
            sources(&path, out);
        } else if name.ends_with(".rs") {
            out.push(path);
        }
    }
}

#[test]
fn architecture_lists_the_crates_and_their_dependencies() {
    let text = read("ARCHITECTURE.md");
    let mut listed = BTreeSet::new();
    for line in text.lines().filter(|l| l.starts_with("| `")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let (name, uses) = (cells[0].trim_matches('`').to_owned(), cells[2]);
        if uses != "all of the above" && !name.contains('<') && crates().contains(&name) {
            let uses: BTreeSet<String> = uses
                .split(", ")
                .filter(|u| *u != "–")
                .map(str::to_owned)
                .collect();
            assert_eq!(
                dependencies(&name),
                uses,
                "dependencies of `{name}` in ARCHITECTURE.md"
            );
        }
        listed.insert(name);
    }
    let missing: Vec<_> = crates()
        .into_iter()
        .filter(|c| !listed.contains(c))
        .collect();
    assert!(missing.is_empty(), "not in ARCHITECTURE.md: {missing:?}");
}

#[test]
fn nothing_at_run_time_depends_on_the_generator() {
    let users = |generator: &str| -> Vec<String> {
        let all = crates().into_iter();
        all.filter(|name| dependencies(name).contains(generator))
            .collect()
    };
    assert_eq!(users("codegen"), ["joint-macro"]);
    assert_eq!(users("symbolic"), ["codegen", "scene-codegen"]);
    // Sweeps use operation lists; the part that prints modules is a feature that the product does
    // not enable.
    assert_eq!(users("scene-codegen"), ["pfaff"]);
    let used = read("crates/pfaff/Cargo.toml");
    assert!(used.contains("\nscene-codegen.workspace = true\n"));
    let manifest = read("Cargo.toml");
    let mut stated = manifest
        .lines()
        .filter(|l| l.starts_with("scene-codegen = "));
    assert!(stated.all(|l| l.contains("default-features = false")));
}

/// References of the product are not part of it. Its tests need scenes with known results, but not
/// the laboratory, which depends on the product.
#[test]
fn the_product_depends_on_no_crate_of_the_laboratory() {
    const LABORATORY: [&str; 3] = ["exact", "lab", "suite"];
    for name in crates() {
        if LABORATORY.contains(&name.as_str()) {
            continue;
        }
        let uses = dependencies(&name);
        let judges = LABORATORY.iter().find(|judge| uses.contains(**judge));
        assert_eq!(judges, None, "{name} depends on it");
        let manifest = read(format!("crates/{name}/Cargo.toml"));
        let tests_by_it = manifest
            .lines()
            .any(|l| l.starts_with("lab.") || l.starts_with("lab "));
        assert!(!tests_by_it || name == "bench", "{name} is tested by it");
    }
}

/// The crate `report` writes documents; `scene` writes the schema of its own format, and `web` its
/// replies.
#[test]
fn json_is_written_by_report_alone() {
    const WRITERS: [&str; 4] = ["lab", "report", "scene", "web"];
    for name in crates() {
        let manifest = read(format!("crates/{name}/Cargo.toml"));
        let own = manifest.split("[dev-dependencies]").next();
        let writes = own.is_some_and(|text| text.contains("serde_json"));
        assert_eq!(writes, WRITERS.contains(&name.as_str()), "{name}");
    }
}

/// The test command in the README must be the one that is checked before each change.
#[test]
fn the_test_command_of_the_readme_is_that_of_the_checks() {
    let readme = read("README.md");
    let checkout = readme.split("## In a checkout").nth(1).expect("a section");
    let test = checkout.lines().find(|line| line.starts_with("cargo test"));
    let test = test.expect("a command");
    let checks = read(".ci/run");
    let steps: Vec<&str> = checks
        .lines()
        .filter_map(|line| line.trim_start().strip_prefix("step "))
        .filter(|step| step.starts_with("cargo test"))
        .collect();
    assert_eq!(steps, [test]);
}

#[test]
fn every_crate_has_a_readme_and_what_a_registry_asks_for() {
    for name in crates() {
        assert!(
            root().join(format!("crates/{name}/README.md")).exists(),
            "{name} has no README.md"
        );
        let text = read(format!("crates/{name}/Cargo.toml"));
        let has = |line: &str| text.lines().any(|l| l.starts_with(line));
        assert!(has("license.workspace = true"), "{name}");
        // A crate is published with the metadata to find it, or its manifest states that it is not
        // published.
        let stays = has("publish.workspace = true");
        let parts = ["publish = true", "keywords = [", "categories = ["];
        assert!(stays || parts.iter().all(|part| has(part)), "{name}");
        let shows_all = has("[package.metadata.docs.rs]");
        assert!(stays || shows_all == has("[features]"), "{name}");
    }
}

#[test]
fn every_module_says_what_it_is_for() {
    let mut files = Vec::new();
    sources(root(), &mut files);
    for path in files {
        let text = fs::read_to_string(&path).expect("readable");
        let described = text.starts_with("//!") || text.starts_with("#![doc");
        assert!(described, "{} does not begin with `//!`", path.display());
    }
}

/// Largest width of a comment line (columns); tables, addresses and example code may be wider.
const COLUMNS: usize = 100;

/// Cargo does not strip a program whose package has separate settings in the profile.
#[test]
fn the_program_is_stripped() {
    let manifest = read("Cargo.toml");
    let (_, release) = manifest
        .split_once("[profile.release]\n")
        .expect("a profile");
    assert!(release.starts_with("strip = true\n"));
    let packages = release.split("[profile.release.package]").nth(1);
    let packages = packages
        .and_then(|text| text.split("\n[").next())
        .expect("levels of packages");
    assert!(!packages.contains("pfaff-cli"), "{packages}");
}

#[test]
fn comments_are_read_without_scrolling() {
    let mut files = Vec::new();
    sources(root(), &mut files);
    let mut wide = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).expect("readable");
        let mut is_code = false;
        for (k, line) in text.lines().enumerate() {
            let Some(comment) = line.trim_start().strip_prefix("//") else {
                is_code = false;
                continue;
            };
            let comment = comment.trim_start_matches(['/', '!']).trim_start();
            is_code ^= comment.starts_with("```");
            let may_be_wide = is_code || comment.starts_with('|') || comment.contains("://");
            if !may_be_wide && line.chars().count() > COLUMNS {
                wide.push(format!("{}:{}", path.display(), k + 1));
            }
        }
    }
    assert!(
        wide.is_empty(),
        "comments wider than {COLUMNS} columns: {wide:#?}"
    );
}

/// Lists Markdown files of the repository that are written by hand.
fn pages(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("readable").flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        if path.is_dir()
            && !["node_modules", "target"].contains(&name.as_str())
            && !name.starts_with('.')
        {
            pages(&path, out);
        } else if name.ends_with(".md") && !WRITTEN_BY_PROGRAMS.contains(&name.as_str()) {
            out.push(path);
        }
    }
}

/// Pages that a command writes.
const WRITTEN_BY_PROGRAMS: [&str; 5] = [
    "THIRD-PARTY.md",
    "table.md",
    "tables.md",
    "settings.md",
    "report.md",
];

#[test]
fn pages_are_wrapped() {
    let mut files = Vec::new();
    pages(root(), &mut files);
    let mut wide = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).expect("readable");
        let mut is_code = false;
        for (k, line) in text.lines().enumerate() {
            let own = line.trim_start();
            is_code ^= own.starts_with("```");
            // Tables, headings, HTML, links and code spans cannot be broken.
            let may_be_wide = is_code || own.starts_with(['|', '#', '<']) || own.contains("](");
            let ends_in_code = line
                .rsplit(' ')
                .next()
                .is_some_and(|word| word.contains('`'));
            if !may_be_wide && !ends_in_code && line.chars().count() > COLUMNS {
                wide.push(format!("{}:{}", path.display(), k + 1));
            }
        }
    }
    assert!(
        wide.is_empty(),
        "lines wider than {COLUMNS} columns: {wide:#?}"
    );
}
