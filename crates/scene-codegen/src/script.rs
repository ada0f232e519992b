//! Functions for build scripts, which generate modules again when scenes change.

use std::path::{Path, PathBuf};

use model::Registry;

use crate::error::CodeError;
use crate::module::Choices;

/// Generates the module of a scene file and writes it as `NAME.rs` to the directory that cargo
/// provides for build scripts. The file can be included as an item. Returns the lines that the
/// build script must print for cargo.
///
/// ```no_run
/// // build.rs
/// let choices = pfaff_scene_codegen::Choices { dynamics: Some("pfaff::dynamics".into()), ..Default::default() };
/// let joints = model::Registry::standard();
/// let said = pfaff_scene_codegen::to_out_dir("scenes/robot.toml".as_ref(), "robot", &joints, &choices);
/// println!("{}", said.unwrap());
/// // src/main.rs: include!(concat!(env!("OUT_DIR"), "/robot.rs")); with `pub mod robot { … }` in it
/// ```
///
/// # Errors
/// Returns the same errors as [`crate::scene()`], and an error if the file cannot be written.
pub fn to_out_dir(
    scene: &Path,
    name: &str,
    registry: &Registry,
    choices: &Choices,
) -> Result<String, CodeError> {
    let folder = std::env::var_os("OUT_DIR").map_or_else(PathBuf::new, PathBuf::from);
    let module = crate::scene(scene, registry, None, choices)?.named(name);
    let path = folder.join(format!("{name}.rs"));
    std::fs::write(&path, module.as_item()).map_err(|source| CodeError::File {
        path: path.display().to_string(),
        source,
    })?;
    Ok(format!("cargo:rerun-if-changed={}", scene.display()))
}
