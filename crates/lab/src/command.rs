//! The command `lab`: what judges the product, from a terminal.

mod examples;
mod fuzz;
mod generate;
mod stress;
mod work_precision;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use pfaff::model::Registry;
use pfaff_cli::console::Console;
use pfaff_cli::output::{Answer, Outcome};
use pfaff_cli::{CommandLine, Stream, named, serve};

use crate::generate::Kind;

/// The laboratory of pfaff: extreme cases, scenes of any size, other ways to move a mechanism.
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
    /// The stiff and extreme cases, each with its right answer and what came out
    #[command(after_help = examples::STRESS)]
    Stress(Stress),
    /// Write a large scene whose answer is known
    #[command(after_help = examples::GENERATE)]
    Generate(Generate),
    /// Random, damaged and degenerate scenes through check, analyze and simulate
    #[command(subcommand, after_help = examples::FUZZ)]
    Fuzz(fuzz::Fuzz),
    /// Error against run time: the product's methods, and others, at many tolerances
    #[command(after_help = examples::WORK_PRECISION)]
    WorkPrecision(WorkPrecision),
}

#[derive(Args)]
pub(super) struct Stress {
    /// Directory for the results
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    pub(super) out: Option<PathBuf>,
    /// Cases of this family only; may be given several times
    #[arg(long, value_name = "NAME")]
    pub(super) family: Vec<String>,
    /// Name the families
    #[arg(long, conflicts_with = "json")]
    pub(super) list: bool,
    /// All results as one JSON document on standard output
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Args)]
pub(super) struct Generate {
    /// Family of mechanisms
    #[arg(value_parser = named(Kind::ALL, Kind::name))]
    pub(super) kind: Kind,
    /// How large: loops, cells, cells along each side, robots, modules
    #[arg(long, value_name = "N")]
    pub(super) n: usize,
    /// Seed of what is drawn at random (parallelograms, random); 1 where it is not given
    #[arg(long, value_name = "SEED")]
    pub(super) seed: Option<u64>,
    /// Share of the cells, blocks or modules that are redundant, 0 to 1
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub(super) redundant: Option<f64>,
    /// File for the scene; standard output where it is not given
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// What is known of the scene as one JSON document on standard output
    #[arg(long, requires = "out")]
    pub(super) json: bool,
}

#[derive(Args)]
pub(super) struct WorkPrecision {
    /// Scene files, - for standard input, or names of cases of the suite; none: the suite
    pub(super) scenes: Vec<PathBuf>,
    /// Directory for the results
    #[arg(long, value_name = "DIR")]
    pub(super) out: PathBuf,
    /// Three tolerances, for a first look
    #[arg(long, conflicts_with = "all")]
    pub(super) quick: bool,
    /// Every method of the product with every stabilisation
    #[arg(long)]
    pub(super) all: bool,
    /// The product's methods only
    #[arg(long)]
    pub(super) own: bool,
    /// All results as one JSON document on standard output
    #[arg(long)]
    pub(super) json: bool,
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

/// Runs one command of the laboratory: `arguments` begin with the name of the program. Answers and
/// exit codes as [`pfaff_cli::run`].
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
