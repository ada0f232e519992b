//! Commands for developers. `cargo xtask codegen` writes the kernels of all joints and forces from their
//! definitions; with `--check` it compares and changes nothing. With `--scene` it writes one mechanism as one module.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod codegen;
mod scene;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask codegen [--check]
       cargo xtask codegen --scene FILE --out FILE.rs [--drop ROWS] [--dynamics PATH] [--libm] [--check]";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match args
        .iter()
        .map(String::as_str)
        .collect::<Vec<_>>()
        .as_slice()
    {
        ["codegen"] => codegen::write(),
        ["codegen", "--check"] => codegen::check(),
        ["codegen", "--scene", scene, rest @ ..] => scene::generate(scene, rest),
        _ => Err(USAGE.to_owned()),
    };
    match outcome {
        Ok(summary) => {
            println!("{summary}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
