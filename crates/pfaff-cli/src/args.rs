//! What may be written on the command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Mechanisms with redundant constraints: how they move, and which of their joint reactions may be believed.
#[derive(Parser)]
#[command(
    name = "pfaff",
    version,
    about,
    after_help = "Exit codes: 0 done, 1 the computation stopped, 2 the input is wrong."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Rank, redundancy, and the verdict of every reaction
    #[command(after_help = "Example: pfaff analyze robot-trolley.toml --at-time 1.5 --json")]
    Analyze(Analyze),
    /// Motion and reactions, written into a directory
    #[command(after_help = "Example: pfaff simulate robot-trolley.toml --out run --drop 6,21")]
    Simulate(Simulate),
    /// Read and assemble only: every problem of the file, with its place
    #[command(after_help = "Example: pfaff check robot-trolley.toml")]
    Check(Check),
}

impl Command {
    /// How it answers.
    pub(crate) fn answer(&self) -> Answer {
        let (Self::Analyze(Analyze { json, .. })
        | Self::Simulate(Simulate { json, .. })
        | Self::Check(Check { json, .. })) = self;
        match json {
            true => Answer::Json,
            false => Answer::Words,
        }
    }
}

/// For whom a command answers.
#[derive(Clone, Copy)]
pub(crate) enum Answer {
    /// For people
    Words,
    /// For programs: one document, and nothing else
    Json,
}

#[derive(Args)]
pub(crate) struct Analyze {
    /// Scene file, or - for standard input
    pub(crate) scene: PathBuf,
    /// Time of the motion at which to look (s)
    #[arg(
        long,
        value_name = "T",
        default_value_t = 0.0,
        allow_hyphen_values = true
    )]
    pub(crate) at_time: f64,
    /// Rows that carry the dependencies, counted from 1
    #[arg(long, value_name = "ROWS", value_delimiter = ',')]
    pub(crate) drop: Option<Vec<usize>>,
    /// A sum of components whose verdict is wanted, as "W3.N + W4.N"; may be given several times
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub(crate) combine: Vec<String>,
    /// One JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Simulate {
    /// Scene file, or - for standard input
    pub(crate) scene: PathBuf,
    /// Directory for the results
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Last time (s)
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub(crate) t_end: Option<f64>,
    /// Relative tolerance
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) rtol: Option<f64>,
    /// Absolute tolerance
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    pub(crate) atol: Option<f64>,
    /// Integrator
    #[arg(long, value_name = "M")]
    pub(crate) method: Option<MethodName>,
    /// Treatment of redundant rows
    #[arg(long, value_name = "F")]
    pub(crate) formulation: Option<FormulationName>,
    /// Rows to eliminate, counted from 1
    #[arg(long, value_name = "ROWS", value_delimiter = ',')]
    pub(crate) drop: Option<Vec<usize>>,
    /// The summary as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Check {
    /// Scene file, or - for standard input
    pub(crate) scene: PathBuf,
    /// Problems, or what was read, as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

/// Integrators that are there.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum MethodName {
    /// The best one for the scene
    Auto,
    /// Dormand–Prince 5(4), MATLAB's ode45
    Dopri5,
}

/// Treatments of redundancy that are there.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum FormulationName {
    /// Independent rows are kept, the others monitored
    KeptRows,
}
