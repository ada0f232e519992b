//! Passes to the program the version of the compiler, which it states in reports of run times, and
//! where the scenes are that come with it.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let answer = Command::new(compiler).arg("--version").output().ok();
    let version = answer
        .and_then(|a| String::from_utf8(a.stdout).ok())
        .unwrap_or_default();
    let profile = std::env::var("PROFILE").unwrap_or_default();
    println!(
        "cargo::rustc-env=PFAFF_COMPILER={}, {profile} profile",
        version.trim()
    );
    scenes("PFAFF_EXAMPLES", "../../examples", "scenes");
    let robot = "robot-trolley.toml";
    scenes("PFAFF_ROBOT", &format!("../robot-trolley/{robot}"), robot);
}

/// Sets a variable to a path: in a checkout of the repository that of the originals, in a package
/// that of their copies. In a checkout the copies are links, which some systems do not follow.
fn scenes(variable: &str, original: &str, copy: &str) {
    let root = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let originals = Path::new(&root).join(original);
    let path = if originals.exists() {
        originals
    } else {
        Path::new(&root).join(copy)
    };
    println!("cargo::rustc-env={variable}={}", path.display());
}
