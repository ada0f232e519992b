//! `scene-codegen SCENE --out FILE`: generates one module for one scene.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use model::Registry;
use pfaff_scene_codegen::{Choices, CodeError, scene};

/// Generate one Rust module for one scene, with its numbers as constants and its independent rows
/// eliminated in an order suitable for its whole motion
#[derive(Parser)]
struct Arguments {
    /// Scene file
    scene: PathBuf,
    /// Output file
    #[arg(long)]
    out: PathBuf,
    /// Rows to treat as redundant (1-based, comma-separated); default: those of the scene
    #[arg(long, value_delimiter = ',', value_name = "ROWS")]
    drop: Option<Vec<usize>>,
    /// Path of the crate `dynamics`; implements its trait `SceneCode`
    #[arg(long)]
    dynamics: Option<String>,
    /// Use sines and roots of `libm` (no standard library)
    #[arg(long)]
    libm: bool,
    /// Scene keys of the input numbers (comma-separated), as in `pfaff sweep --vary`:
    /// `body.cart.mass,joint.A.at,L`. Functions of the module take the affected numbers as an
    /// argument, and `SceneCode` reads them from the mechanism of a run.
    #[arg(long, value_delimiter = ',', value_name = "KEYS")]
    inputs: Vec<String>,
    /// Compare with the file instead of writing it
    #[arg(long)]
    check: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(said) => {
            #[expect(clippy::print_stdout, reason = "a program prints its actions")]
            {
                println!("{said}");
            }
            ExitCode::SUCCESS
        }
        Err(e) => {
            #[expect(
                clippy::print_stderr,
                reason = "a program prints the actions that failed"
            )]
            {
                eprintln!("error: {e}");
            }
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Result<String, CodeError> {
    let choices = Choices {
        dynamics: arguments.dynamics.clone(),
        libm: arguments.libm,
        inputs: arguments.inputs.clone(),
    };
    let drop = match &arguments.drop {
        Some(rows) if rows.contains(&0) => return Err(CodeError::RowZero),
        rows => rows
            .as_ref()
            .map(|rows| rows.iter().map(|row| row - 1).collect::<Vec<_>>()),
    };
    let module = scene(
        &arguments.scene,
        &Registry::standard(),
        drop.as_deref(),
        &choices,
    )?;
    let file = |path: &Path, source| CodeError::File {
        path: path.display().to_string(),
        source,
    };
    let out = &arguments.out;
    let text = module.as_file(&format!("`{}`", command(arguments)));
    if arguments.check {
        let found = std::fs::read_to_string(out).map_err(|source| CodeError::Unwritten {
            path: out.display().to_string(),
            source,
        })?;
        return if found == text {
            Ok(format!("{} agrees with its scene", out.display()))
        } else {
            Err(CodeError::Stale {
                path: out.display().to_string(),
            })
        };
    }
    std::fs::write(out, text).map_err(|e| file(out, e))?;
    Ok(format!("{} written", out.display()))
}

/// Returns the command line that writes the file.
fn command(arguments: &Arguments) -> String {
    let (scene, out) = (arguments.scene.display(), arguments.out.display());
    let mut command = format!("cargo xtask codegen --scene {scene} --out {out}");
    if let Some(rows) = &arguments.drop {
        let rows: Vec<String> = rows.iter().map(usize::to_string).collect();
        command += &format!(" --drop {}", rows.join(","));
    }
    if let Some(path) = &arguments.dynamics {
        command += &format!(" --dynamics {path}");
    }
    if arguments.libm {
        command += " --libm";
    }
    if !arguments.inputs.is_empty() {
        command += &format!(" --inputs {}", arguments.inputs.join(","));
    }
    command
}
