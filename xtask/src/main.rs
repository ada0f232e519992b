//! Commands for developers. `cargo xtask codegen` writes the kernels of all joints and forces from
//! their definitions. With `--check`, it only compares the kernels; with `--scene`, it writes one
//! mechanism as one module. `house` measures the code. `licences` type-checks the command for all
//! systems and then lists the third-party crates of the command. `platforms` only type-checks the
//! command. The other commands measure run times and write `docs/reports`.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod api;
mod browser;
mod choices;
mod codegen;
mod cold_start;
mod guards;
mod house;
mod licences;
mod platforms;
mod questions;
mod right_hand_side;
mod scene;
mod site;
mod tree;

use std::process::ExitCode;

use browser::Program;

const USAGE: &str = "usage: cargo xtask COMMAND
  codegen [--check]   kernels of joints and forces from their definitions
  codegen --scene FILE --out FILE.rs [--drop ROWS] [--dynamics PATH] [--libm] [--inputs KEYS] [--check]
                      one mechanism as one module; what KEYS touch, numbers of the scene such as body.cart.mass,joint.A.at, is an argument of it
  api [--check]       what a user of each published crate can name, into docs/api
  questions [--check] what follows from the list of questions: schemas of answers, methods of Python, tables of the book
  right-hand-side     times and instructions of one right-hand side, into docs/reports/right-hand-side
  instructions        the same, told only
  choices             build time, size and dependencies of programs that use a part, into docs/reports/choices
  browser [--built]   reports of three scenes in headless Chromium, with pictures; written by a release build, or by what `cargo test` built
  browser --missing   what this machine lacks for it
  site                the playground and the book as static files, into target/site
  site --check        the same, compiled in a short time, with its tests in Node and Chromium
  site --times        the published site with all its tests, also those of times
  site --missing      what this machine lacks for it
  cold-start          times of the commands, process included
  guards              what monitors cost in a run: the same run with them and compiled without
  house [--json] [--check]
                      lines of code, large types, circles of modules, numeric constants; with --check the limits, as an error where one is exceeded
  licences [--check]  THIRD-PARTY.md: the crates that the command and the Python package link, with their licences; --check compares it with Cargo.lock
  platforms [--all]   type-checks the command for a system that is not Linux, or for all that are supported, where they can be installed";

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
        ["api"] => api::write(),
        ["api", "--check"] => api::check(),
        ["questions"] => questions::run(&[]),
        ["questions", "--check"] => questions::run(&["--check"]),
        ["right-hand-side"] => right_hand_side::report(),
        ["instructions"] => right_hand_side::instructions(),
        ["choices"] => choices::report(),
        ["browser"] => browser::check(Program::Release),
        ["browser", "--built"] => browser::check(Program::OfTests),
        ["browser", "--missing"] => browser::missing(),
        ["site"] => site::write(site::Build::Small),
        ["site", "--check"] => site::check(),
        ["site", "--times"] => site::measure(),
        ["site", "--missing"] => site::missing(),
        ["cold-start"] => cold_start::tell(),
        ["guards"] => guards::tell(),
        ["house", flags @ ..] if flags.iter().all(|f| ["--json", "--check"].contains(f)) => {
            house::tell(flags.contains(&"--json"), flags.contains(&"--check"))
        }
        // The third-party crates have changed, and a new version may not support every system.
        ["licences"] => platforms::check_all()
            .and_then(|checked| Ok(format!("{checked}\n{}", licences::write()?))),
        ["licences", "--check"] => licences::check(),
        ["platforms"] => platforms::check(),
        ["platforms", "--all"] => platforms::check_all(),
        ["help" | "--help" | "-h"] => Ok(USAGE.to_owned()),
        [] => Err(USAGE.to_owned()),
        other => Err(format!("no command `{}`\n{USAGE}", other.join(" "))),
    };
    match outcome {
        Ok(summary) => {
            if !summary.is_empty() {
                println!("{summary}");
            }
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
