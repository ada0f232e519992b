//! The files that are derived from the list of questions. A separate program that contains the
//! product writes these files, so that xtask itself compiles without the product.

use std::env;
use std::process::Command;

use crate::tree::root;

/// Runs this program with these arguments.
pub(crate) fn run(words: &[&str]) -> Result<String, String> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["run", "--quiet", "--package", "questions", "--"]);
    let ended = command.args(words).current_dir(root()).status();
    match ended {
        Ok(status) if status.success() => Ok(String::new()),
        Ok(status) => Err(format!("`questions` has ended with {status}")),
        Err(e) => Err(format!("cannot start cargo: {e}")),
    }
}
