//! The command `pfaff`: reads scenes, says which reactions are determined, moves mechanisms. It prints; everything else is
//! done by the library.
//!
//! Exit codes: 0 done (also when standard output is closed early), 1 the computation stopped or was interrupted, 2 the
//! input is wrong. With `--json` standard output has one document, whichever it is.

mod analyze;
mod args;
mod check;
mod diff;
mod generate;
mod input;
mod interrupt;
mod manual;
mod new;
mod output;
mod plan;
mod resources;
mod simulate;
mod start;
mod stress;
mod sweep;
mod template;
mod view;
mod watch;
mod work_precision;

use std::process::ExitCode;

use args::{Arguments, Command};
use clap::Parser;
use output::Failure;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(e) => return output::usage(&e),
    };
    let outcome = match &arguments.command {
        Command::Analyze(a) => analyze::run(a),
        Command::Simulate(a) => simulate::run(a),
        Command::Plan(a) => plan::run(a),
        Command::Sweep(a) => sweep::run(a),
        Command::Stress(a) => stress::run(a),
        Command::WorkPrecision(a) => work_precision::run(a),
        Command::Generate(a) => generate::run(a),
        Command::Check(a) => check::run(a),
        Command::New(a) => new::run(a),
        Command::View(a) => view::run(a),
        Command::Diff(a) => diff::run(a),
        Command::Schema => manual::schema(),
        Command::Completions(a) => manual::completions(a),
        Command::Man(a) => manual::page(a),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(arguments.command.answer()),
    }
}

/// What every command ends with.
type Outcome = Result<(), Failure>;
