//! The command `lab`: tests and comparisons of pfaff on the command line.

mod examples;
mod fuzz;
mod generate;
mod stress;
mod work_precision;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use pfaff::model::Registry;
use pfaff_cli::console::Console;
use pfaff_cli::output::{Answer, Outcome};
use pfaff_cli::{CommandLine, Stream, serve};

/// The laboratory of pfaff: extreme cases, generated scenes of any size, other methods to compute
/// motions.
#[derive(Parser)]
#[command(
    name = "lab",
    version,
    after_help = "Exit codes: 0 done, 1 something failed or stopped, 2 the input is wrong."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run the stiff and extreme cases, each compared with its known answer
    #[command(after_help = examples::STRESS)]
    Stress(stress::Stress),
    /// Write a large scene with a known answer
    #[command(after_help = examples::GENERATE)]
    Generate(generate::Generate),
    /// Test random, damaged and degenerate scenes with check, analyze and simulate
    #[command(subcommand, after_help = examples::FUZZ)]
    Fuzz(fuzz::Fuzz),
    /// Error versus run time: the methods of pfaff and others, at many tolerances
    #[command(after_help = examples::WORK_PRECISION)]
    WorkPrecision(work_precision::WorkPrecision),
}

impl CommandLine for Arguments {
    fn answer(&self) -> Answer {
        let json = match &self.command {
            Command::Stress(a) => a.json,
            Command::Generate(a) => a.json,
            Command::WorkPrecision(a) => a.json,
            Command::Fuzz(_) => false,
        };
        if json { Answer::Json } else { Answer::Words }
    }

    fn run(&self, console: &Console<'_>) -> Outcome {
        match &self.command {
            Command::Stress(a) => stress::run(a, console),
            Command::Generate(a) => generate::run(a, console),
            Command::WorkPrecision(a) => work_precision::run(a, console),
            Command::Fuzz(a) => fuzz::run(a, console),
        }
    }
}

/// Runs one command of the laboratory: `arguments` begins with the name of the program. Outcomes
/// and exit codes are the same as for [`pfaff_cli::run`].
pub fn run<'a, I>(
    registry: &'a Registry,
    arguments: I,
    out: Stream<'a>,
    err: Stream<'a>,
) -> ExitCode
where
    I: IntoIterator<Item: Into<OsString> + Clone>,
{
    serve::<Arguments, _>(registry, arguments, out, err)
}
