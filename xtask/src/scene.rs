//! `cargo xtask codegen --scene FILE --out FILE.rs`: starts `scene-codegen` as a separate program,
//! so that xtask depends only on the generator of kernels and can always be built.

use std::process::Command;

/// Passes the arguments to the program.
pub(crate) fn generate(scene: &str, rest: &[&str]) -> Result<String, String> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let status = Command::new(&cargo)
        .args([
            "run",
            "--quiet",
            "--release",
            "-p",
            "pfaff-scene-codegen",
            "--",
        ])
        .arg(scene)
        .args(rest)
        .status()
        .map_err(|e| format!("{cargo}: {e}"))?;
    if status.success() {
        Ok(String::new())
    } else {
        Err("`scene-codegen` stopped".to_owned())
    }
}
