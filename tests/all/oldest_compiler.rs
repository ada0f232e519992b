//! The workspace states `rust-version` once, every member has it, no dependency requires a newer
//! compiler, and the present compiler has this version. See `docs/stability.md`.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ lies in the root")
}

/// A version; `1.95` and `1.95.0` are equal.
fn version(text: &str) -> [u64; 3] {
    let number = |part: Option<&str>| {
        let digits = part.unwrap_or("0").split(['-', '+']).next();
        let digits = digits.unwrap_or_default();
        digits.parse().unwrap_or_else(|e| panic!("`{text}`: {e}"))
    };
    let mut parts = text.split('.');
    std::array::from_fn(|_| number(parts.next()))
}

/// Returns the version in the root manifest.
fn stated() -> String {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).expect("readable");
    let line = manifest
        .lines()
        .find_map(|l| l.strip_prefix("rust-version = "));
    line.expect("the root states it")
        .trim_matches('"')
        .to_owned()
}

/// Returns a line of output of the present compiler.
fn rustc(argument: &str) -> String {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let output = Command::new(rustc).arg(argument).output();
    String::from_utf8(output.expect("it starts").stdout).expect("UTF-8")
}

/// Returns packages and members of the workspace on this platform, from the locally available
/// sources.
fn metadata() -> Value {
    let verbose = rustc("-vV");
    let host = verbose.lines().find_map(|l| l.strip_prefix("host: "));
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["metadata", "--format-version=1", "--offline", "--locked"])
        .args(["--filter-platform", host.expect("a host")])
        .current_dir(root())
        .output()
        .expect("cargo starts");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
fn versions_are_read_as_numbers() {
    assert_eq!(version("1.95"), version("1.95.0"));
    assert!(version("1.100") > version("1.95"));
    assert!(version("1.95.1-nightly") > version("1.95"));
}

#[test]
fn every_member_inherits_the_stated_version() {
    let (metadata, stated) = (metadata(), stated());
    let packages = metadata["packages"].as_array().expect("a list");
    let members = metadata["workspace_members"].as_array().expect("a list");
    let of_us: Vec<_> = packages
        .iter()
        .filter(|p| members.contains(&p["id"]))
        .collect();
    assert!(of_us.len() > 15, "{} members", of_us.len());
    for package in of_us {
        let path = package["manifest_path"].as_str().expect("a path");
        let manifest = std::fs::read_to_string(path).expect("readable");
        assert!(manifest.contains("rust-version.workspace = true"), "{path}");
        assert_eq!(package["rust_version"], stated.as_str(), "{path}");
    }
}

#[test]
fn no_dependency_asks_for_a_newer_compiler() {
    let (metadata, stated) = (metadata(), version(&stated()));
    let packages = metadata["packages"].as_array().expect("a list");
    let newer = packages.iter().filter(|package| {
        let asked = package["rust_version"].as_str();
        asked.is_some_and(|asked| version(asked) > stated)
    });
    let newer: Vec<String> = newer
        .map(|p| format!("{} {} needs {}", p["name"], p["version"], p["rust_version"]))
        .collect();
    assert!(newer.is_empty(), "{newer:#?}");
    // Most packages state their version; the version of the others is unknown.
    let told = packages.iter().filter(|p| p["rust_version"].is_string());
    assert!(2 * told.count() > packages.len());
}

/// Cargo rejects an older compiler before this test runs.
#[test]
#[expect(
    clippy::print_stderr,
    reason = "nothing else can say that a test could not judge"
)]
fn this_compiler_is_the_stated_one() {
    let text = rustc("--version");
    let here = text.split_whitespace().nth(1).expect("rustc VERSION");
    let (here, stated) = (version(here), version(&stated()));
    assert!(here >= stated, "{text}");
    if here[..2] != stated[..2] {
        // The test is skipped: an error would only show that a newer compiler is installed.
        eprintln!("{text} is newer than {stated:?}: the oldest compiler was not tried");
    }
}
