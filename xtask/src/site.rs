//! `cargo xtask site`: the playground and the book as one folder of static files. The module of the
//! playground is compiled for WebAssembly with the system interface WASI, so that clocks and files
//! need no code of ours. The functions of the module are sorted by their names, because similar
//! functions next to each other are compressed better.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::platforms::install;
use crate::tree::{cargo, root, run, said_by, target};

/// The target of the compiler.
const TARGET: &str = "wasm32-wasip1";

/// Settings of the profile for all crates. Those of `Cargo.toml` for single crates are for the
/// command.
const SMALL: [&str; 4] = [
    "profile.web.package.pfaff-import.opt-level='z'",
    "profile.web.package.pfaff-scene.opt-level='z'",
    "profile.web.package.'*'.opt-level='z'",
    "profile.web.strip='none'",
];

/// Features of WebAssembly that all browsers since 2023 have.
const FEATURES: [&str; 5] = [
    "--enable-bulk-memory",
    "--enable-mutable-globals",
    "--enable-nontrapping-float-to-int",
    "--enable-sign-ext",
    "--enable-simd",
];

/// How the module is compiled.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Build {
    /// Small, as it is published.
    Small,
    /// In a short time, for tests.
    Quick,
}

/// Returns what is missing on this machine, or nothing. What can be installed for the project is
/// installed.
pub(crate) fn missing() -> Result<String, String> {
    let browser = crate::browser::missing()?;
    let lacks = if browser.is_empty() {
        install(TARGET).and_then(|()| packages(&root().join("crates/web/page")))
    } else {
        Err(browser)
    };
    Ok(lacks.err().unwrap_or_default())
}

/// Installs the packages of the page if they are missing.
fn packages(page: &Path) -> Result<(), String> {
    if page.join("node_modules").is_dir() {
        return Ok(());
    }
    let mut npm = Command::new("npm");
    npm.args(["ci", "--silent", "--no-audit", "--no-fund"]);
    said_by(npm.current_dir(page)).map(drop)
}

/// Writes the site, and returns where it is.
pub(crate) fn write(build: Build) -> Result<String, String> {
    let root = root();
    let target = target(&root)?;
    let page = root.join("crates/web/page");
    packages(&page)?;
    let module = module(&root, &target, build)?;
    let out = Path::new(&target).join("site");
    let book = match Command::new("mdbook").arg("--version").output() {
        Ok(_) => {
            run(Command::new("mdbook")
                .env("MDBOOK_OUTPUT__HTML__ADDITIONAL_JS", r#"["playground.js"]"#)
                .args(["build", "docs", "--dest-dir"])
                .arg(out.join("book"))
                .current_dir(&root))?;
            ""
        }
        Err(_) => "; without the book, because mdBook is not installed",
    };
    // The page has a link to the book if the book is there.
    run(Command::new("node")
        .arg(page.join("build.mjs"))
        .args([&out, &module]))?;
    Ok(format!("written to {}{book}", out.display()))
}

/// Writes the site and tests it in Node and in Chromium. The answers of the module are compared
/// with those of the program that `cargo test` built.
pub(crate) fn check() -> Result<String, String> {
    let written = write(Build::Quick)?;
    tested(Build::Quick, &[])?;
    Ok(written)
}

/// Writes the site as it is published, and also tests the times until the first verdict and between
/// the steps of a drag.
pub(crate) fn measure() -> Result<String, String> {
    let written = write(Build::Small)?;
    tested(Build::Small, &["--times"])?;
    Ok(written)
}

fn tested(build: Build, options: &[&str]) -> Result<(), String> {
    let root = root();
    let target = target(&root)?;
    let tests = root.join("crates/web/page/tests");
    let program = Path::new(&target).join("debug/pfaff");
    run(Command::new("node")
        .arg(tests.join("native.mjs"))
        .args([module_of(&target, build), program]))?;
    run(Command::new("node")
        .arg(tests.join("all.mjs"))
        .arg(Path::new(&target).join("site"))
        .args(options))
}

/// Compiles the module and returns its path.
fn module(root: &Path, target: &str, build: Build) -> Result<PathBuf, String> {
    install(TARGET)?;
    let mut cargo = cargo(root);
    cargo.args(["build", "--locked", "-p", "pfaff-web", "--target", TARGET]);
    let compiled = module_of(target, build);
    if build == Build::Quick {
        run(cargo.args(["--profile", "web-quick"]))?;
        return Ok(compiled);
    }
    // The paths of sources are in the module, and say nothing to a reader of the page.
    let home =
        std::env::var("CARGO_HOME").or_else(|_| std::env::var("HOME").map(|home| home + "/.cargo"));
    if let Ok(home) = home {
        cargo.env(
            "CARGO_TARGET_WASM32_WASIP1_RUSTFLAGS",
            format!("--remap-path-prefix={home}/registry/src="),
        );
    }
    run(cargo
        .args(["--profile", "web"])
        .args(SMALL.iter().flat_map(|own| ["--config", own])))?;
    let sorted = compiled.with_extension("sorted.wasm");
    run(
        Command::new(root.join("crates/web/page/node_modules/.bin/wasm-opt"))
            .args(FEATURES)
            .args(["--merge-similar-functions", "--reorder-functions-by-name"])
            .args(["--strip-debug", "--strip-producers"])
            .arg(&compiled)
            .arg("-o")
            .arg(&sorted),
    )?;
    Ok(sorted)
}

fn module_of(target: &str, build: Build) -> PathBuf {
    let profile = match build {
        Build::Small => "web",
        Build::Quick => "web-quick",
    };
    let folder = Path::new(target).join(TARGET).join(profile);
    folder.join("pfaff_web.wasm")
}
