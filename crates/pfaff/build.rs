//! Passes the folder of the included scenes to the library.

use std::path::Path;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    scenes("PFAFF_EXAMPLES", "../../examples", "scenes");
    let robot = "robot-trolley.toml";
    scenes("PFAFF_ROBOT", &format!("../robot-trolley/{robot}"), robot);
}

/// Sets a variable to a path. In a checkout of the repository, it is the path of the original
/// files. In a package, it is the path of the copies. In a checkout, the copies are links, and some
/// systems do not follow links.
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
