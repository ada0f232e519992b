//! What may be written on the command line.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use pfaff::dynamics::{Formulation, Method, Stabilisation};
use pfaff::suite::generate::Kind;
use pfaff::sweep::{Axis, Shard};

use crate::resources::Resources;

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

const ANALYZE_EXAMPLES: &str = "Examples:
  pfaff analyze robot.toml --at-time 1.5           verdicts at 1.5 s of the motion
  pfaff analyze robot.toml --make-unique W3        what to delete so that W3 is determined
  pfaff analyze robot.toml --combine \"W3.N + W4.N\"
  pfaff analyze robot.toml --along                 one verdict for the whole motion, and where another holds
  pfaff analyze robot.toml --choose minimum-norm --choose compliance:B=1e-6,W3=1e-6,W4=2e-6 --choose drop:6,21
  pfaff analyze robot.toml --json

Reactions that are not unique are never given a number without the choice it depends on.";

const SWEEP_EXAMPLES: &str = "Examples:
  pfaff sweep robot.toml --vary body.platform.mass=10:40:31 --out masses
  pfaff sweep robot.toml --vary drive.steering.motion.steps[0].by=0.01,0.02 --vary simulate.rtol=1e-4:1e-10:7:log --out grid
  pfaff sweep robot.toml --vary body.platform.mass=10:40:31 --out masses --shard 2/3    every third run, for one of three machines
  pfaff sweep --merge masses-1 masses-2 masses-3 --out masses                          one table of all

The same command again goes on where the last one was interrupted. Several --vary are a full grid; the last one runs fastest. Things go by their names or by
[0], [1], ...; a key that the scene leaves out is added to it. Exit code 1 if a run is not done; it has a row all the same.";

const WORK_PRECISION_EXAMPLES: &str = "Examples:
  pfaff work-precision --out wp                      the suite: scenes whose motion is known
  pfaff work-precision andrews sleigh --out wp       two of them
  pfaff work-precision mine.toml --out wp --quick    a scene of your own; two methods that agree are its reference

Build with --release, and keep the machine idle: seconds are compared.";

const STRESS_EXAMPLES: &str = "Examples:
  pfaff stress --list                                the families of cases
  pfaff stress --out stress                          all of them
  pfaff stress --family trivial --out stress         one; may be given several times

Each case has its right answer. Exit code 1 if something is silently wrong, or refused although there is an answer. Build with --release.";

const GENERATE_EXAMPLES: &str = "Examples:
  pfaff generate parallelograms --n 9000 --out chain.toml    48 000 revolutes, 6000 redundant rows
  pfaff generate random --n 100 --seed 7 | pfaff analyze -

Kinds, and what n counts:
  n-four-bar       loops of unit rods in a row, one freedom
  parallelograms   cells of a chain; with three cranks they are redundant (--redundant, two thirds of them)
  lattice          cells along each side of a square grid that hangs from a corner; blocks along its diagonal are braced
                   (--redundant, all of them)
  fleet            robots with trolleys side by side
  random           modules, each on an earlier body; some are doubled (--redundant, a third of them)

Ranks, redundancy and what is not unique are known, and stand at the head of the file. Same words, same bytes.";

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Rank, redundancy, and the verdict of every reaction
    #[command(after_help = ANALYZE_EXAMPLES)]
    Analyze(Analyze),
    /// Motion and reactions, written into a directory with a report for any browser
    #[command(after_help = "Example: pfaff simulate robot-trolley.toml --out run --drop 6,21")]
    Simulate(Simulate),
    /// What a run of the scene needs, what is left out, and why
    #[command(after_help = "Example: pfaff plan robot-trolley.toml --method radau5")]
    Plan(Plan),
    /// Many runs with other numbers in the scene: parallel, resumable, in shards
    #[command(after_help = SWEEP_EXAMPLES)]
    Sweep(Sweep),
    /// Error against run time, for every method and tolerance
    #[command(after_help = WORK_PRECISION_EXAMPLES)]
    WorkPrecision(WorkPrecision),
    /// The stiff and extreme cases, each with its right answer and what came out
    #[command(after_help = STRESS_EXAMPLES)]
    Stress(Stress),
    /// Write a large scene whose answer is known
    #[command(after_help = GENERATE_EXAMPLES)]
    Generate(Generate),
    /// Read and assemble only: every problem of the file, with its place
    #[command(after_help = "Example: pfaff check robot-trolley.toml")]
    Check(Check),
}

impl Command {
    /// How it answers.
    pub(crate) fn answer(&self) -> Answer {
        let (Self::Analyze(Analyze { json, .. })
        | Self::Simulate(Simulate { json, .. })
        | Self::Plan(Plan { json, .. })
        | Self::Sweep(Sweep { json, .. })
        | Self::WorkPrecision(WorkPrecision { json, .. })
        | Self::Stress(Stress { json, .. })
        | Self::Generate(Generate { json, .. })
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
    /// What to delete so that this reaction becomes unique, the smallest sets; may be given several times
    #[arg(long, value_name = "NAME")]
    pub(crate) make_unique: Vec<String>,
    /// What may be deleted for it: sensible (no joint of several rows loses all of them), whole (joints and drives as a whole),
    /// rows (any), or rows:4,6,21 (these)
    #[arg(long, value_name = "WHAT", default_value = "sensible")]
    pub(crate) allow: String,
    /// List the sets of rows that can be eliminated without a change of motion, N at most
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "100")]
    pub(crate) eliminations: Option<usize>,
    /// Verdicts in the frames of the first body and of the edge, too
    #[arg(long)]
    pub(crate) frames: bool,
    /// Run the motion, as long as the scene says or to T_END (s): one verdict, and where another holds
    #[arg(long, value_name = "T_END", num_args = 0..=1, allow_negative_numbers = true)]
    pub(crate) along: Option<Option<f64>>,
    /// Reactions by a choice: minimum-norm, minimum-norm:length=L (torques count as forces at this arm),
    /// compliance:W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds rad/(N·m)), drop:6,21; may be given several times
    #[arg(long, value_name = "CHOICE")]
    pub(crate) choose: Vec<String>,
    #[command(flatten)]
    pub(crate) resources: Resources,
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
    /// Largest step (s)
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub(crate) max_step: Option<f64>,
    /// Integrator
    #[arg(long, value_name = "M", value_parser = named(Method::ALL, Method::name))]
    pub(crate) method: Option<Method>,
    /// Treatment of redundant rows
    #[arg(long, value_name = "F", value_parser = named(Formulation::ALL, Formulation::name))]
    pub(crate) formulation: Option<Formulation>,
    /// Treatment of drift; baumgarte has the gains of the scene, or 5 and 5 (1/s)
    #[arg(long, value_name = "S", value_parser = named(Stabilisation::ALL, Stabilisation::name))]
    pub(crate) stabilisation: Option<Stabilisation>,
    /// Rows to eliminate, counted from 1
    #[arg(long, value_name = "ROWS", value_delimiter = ',')]
    pub(crate) drop: Option<Vec<usize>>,
    #[command(flatten)]
    pub(crate) resources: Resources,
    /// The summary as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Plan {
    /// Scene file, or - for standard input
    pub(crate) scene: PathBuf,
    /// Last time (s)
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub(crate) t_end: Option<f64>,
    /// Integrator
    #[arg(long, value_name = "M", value_parser = named(Method::ALL, Method::name))]
    pub(crate) method: Option<Method>,
    /// Treatment of redundant rows
    #[arg(long, value_name = "F", value_parser = named(Formulation::ALL, Formulation::name))]
    pub(crate) formulation: Option<Formulation>,
    /// Treatment of drift; baumgarte has the gains of the scene, or 5 and 5 (1/s)
    #[arg(long, value_name = "S", value_parser = named(Stabilisation::ALL, Stabilisation::name))]
    pub(crate) stabilisation: Option<Stabilisation>,
    /// Rows to eliminate, counted from 1
    #[arg(long, value_name = "ROWS", value_delimiter = ',')]
    pub(crate) drop: Option<Vec<usize>>,
    #[command(flatten)]
    pub(crate) resources: Resources,
    /// The plan as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Sweep {
    /// Scene file, or - for standard input
    #[arg(required_unless_present = "merge", conflicts_with = "merge")]
    pub(crate) scene: Option<PathBuf>,
    /// A number of the scene and its values: KEY=FROM:TO:N, KEY=FROM:TO:N:log or KEY=A,B,C; may be given several times
    #[arg(long, value_name = "KEY=VALUES", required_unless_present = "merge")]
    pub(crate) vary: Vec<Axis>,
    /// Directory for the results
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Every n-th run only, beginning with the i-th; shards may share a directory
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    pub(crate) shard: Shard,
    /// Runs at the same time; as many as there are cores where it is not given
    #[arg(long, value_name = "K")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Keep the trajectory of each run, in runs/NUMBER/trajectory.csv
    #[arg(long)]
    pub(crate) keep_rows: bool,
    /// Instead of runs: one table of what these directories have
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["vary", "shard", "threads", "keep_rows"])]
    pub(crate) merge: Vec<PathBuf>,
    /// The summary as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct WorkPrecision {
    /// Scene files, - for standard input, or names of cases of the suite; none: the suite
    pub(crate) scenes: Vec<PathBuf>,
    /// Directory for the results
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Three tolerances, for a first look
    #[arg(long, conflicts_with = "all")]
    pub(crate) quick: bool,
    /// Every method with every formulation and every stabilisation
    #[arg(long)]
    pub(crate) all: bool,
    /// All results as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Stress {
    /// Directory for the results
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    pub(crate) out: Option<PathBuf>,
    /// Cases of this family only; may be given several times
    #[arg(long, value_name = "NAME")]
    pub(crate) family: Vec<String>,
    /// Name the families
    #[arg(long, conflicts_with = "json")]
    pub(crate) list: bool,
    /// All results as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Generate {
    /// Family of mechanisms
    #[arg(value_parser = named(Kind::ALL, Kind::name))]
    pub(crate) kind: Kind,
    /// How large: loops, cells, cells along each side, robots, modules
    #[arg(long, value_name = "N")]
    pub(crate) n: usize,
    /// Seed of what is drawn at random (parallelograms, random); 1 where it is not given
    #[arg(long, value_name = "SEED")]
    pub(crate) seed: Option<u64>,
    /// Share of the cells, blocks or modules that are redundant, 0 to 1
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub(crate) redundant: Option<f64>,
    /// File for the scene; standard output where it is not given
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// What is known of the scene as one JSON document on standard output
    #[arg(long, requires = "out")]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Check {
    /// Scene file, or - for standard input
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) resources: Resources,
    /// Problems, or what was read, as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

/// Reads one of the names of an enum, and says what the names are where it is none.
fn named<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = all.iter().map(|value| name(*value));
    PossibleValuesParser::new(names).try_map(move |text| {
        let found = all.iter().find(|value| name(**value) == text);
        found.copied().ok_or("no such name")
    })
}
