//! The command `lab fuzz`: passes random, damaged and degenerate scenes through check, analyze and
//! simulate.

use std::fs;
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use pfaff_cli::console::Console;
use pfaff_cli::input::unreadable;
use pfaff_cli::output::{Failure, Outcome};

use crate::fuzz::campaign::{self, Campaign};
use crate::fuzz::exact::tally::{Suite, Tally};
use crate::fuzz::scenes::Space;
use crate::fuzz::watch::Limits;
use crate::fuzz::{forms, input, numbers, passages, trial};

#[derive(Subcommand)]
pub(super) enum Fuzz {
    /// Tests many inputs; exit code 1 if one of them fails
    Run {
        /// The space of all inputs
        #[arg(long = "suite", value_enum, default_value_t)]
        space: Space,
        /// Number of inputs
        #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
        inputs: u64,
        /// Seed of all inputs
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The first input
        #[arg(long, default_value_t = 0)]
        from: u64,
        /// Number of processes at the same time
        #[arg(long, default_value_t = 2)]
        threads: usize,
        /// Longest time for one input (s)
        #[arg(long, default_value_t = 10)]
        deadline: u64,
        /// Largest memory of a process (MiB)
        #[arg(long, default_value_t = 2048)]
        memory: u64,
        /// Directory for the inputs that fail
        #[arg(long, default_value = "found")]
        found: PathBuf,
    },
    /// Tests one text, or standard input for -
    Try {
        /// The file
        file: PathBuf,
    },
    /// Writes the text of an input
    Show {
        /// The space of all inputs
        #[arg(long = "suite", value_enum, default_value_t)]
        space: Space,
        /// Seed
        seed: u64,
        /// Number of the input
        number: u64,
    },
    /// Tests degenerate scenes by exact arithmetic; exit code 1 if an answer is wrong
    Exact {
        /// Which scenes
        #[arg(long, value_enum, default_value_t)]
        suite: Suite,
        #[command(flatten)]
        scenes: Scenes,
    },
    /// Tests scenes with 3 … 16 significant digits; exit code 1 if an answer is wrong
    Rounded {
        /// The space of all scenes
        #[arg(long = "suite", value_enum, default_value_t)]
        space: Space,
        #[command(flatten)]
        drawings: Drawings,
    },
    /// Tests scenes of full rank near a lower rank, with tolerances below a third of their distance
    /// from it; exit code 1 if one is called redundant
    FullRank(Drawings),
    /// Turns parallelograms through their flat poses at 1 … 10 rad/s; exit code 1 if one is wrong
    /// or stops late, or if fewer than 97 of 100 pass
    Passages {
        /// How many
        #[arg(long, default_value_t = 150, value_parser = clap::value_parser!(u64).range(1..))]
        runs: u64,
        /// Seed of all runs
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The first run
        #[arg(long, default_value_t = 0)]
        from: u64,
    },
    /// Compares numbers on random motions with other solutions; exit code 1 if one that is called
    /// determined differs, or a mechanism that moves is refused
    Numbers(Scenes),
    /// Decides whether quadratic forms have a common zero; exit code 1 if one decision is wrong, or
    /// if too many are open
    Forms {
        /// How many sets
        #[arg(long, default_value_t = 2000, value_parser = clap::value_parser!(u64).range(1..))]
        sets: u64,
        /// Seed of all sets
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The first set
        #[arg(long, default_value_t = 0)]
        from: u64,
    },
    /// Tries inputs one after the other and answers each with a letter: what `run` begins
    #[command(hide = true)]
    Work {
        /// The space of all inputs
        #[arg(long = "suite", value_enum, default_value_t)]
        space: Space,
        /// Seed
        seed: u64,
        /// The first input
        from: u64,
        /// The input after the last one
        to: u64,
    },
}

/// A range of scenes.
#[derive(Args)]
pub(super) struct Scenes {
    /// Number of scenes
    #[arg(long, default_value_t = 20_000, value_parser = clap::value_parser!(u64).range(1..))]
    scenes: u64,
    /// Seed of all scenes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The first scene
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// Writes one scene with the correct answer and that of the program, then ends
    #[arg(long, value_name = "NUMBER")]
    show: Option<u64>,
    /// Directory for scenes with a wrong answer, the shortest of each kind
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
}

impl Scenes {
    /// Examines motions.
    fn examine_numbers(&self, console: &Console<'_>) -> Outcome {
        let Self { scenes, seed, .. } = *self;
        if let Some(number) = self.show {
            let (scene, findings) = numbers::tally::outcome(seed, number);
            let mut page = format!("# {}\n", scene.family);
            for finding in &findings.all {
                page.push_str(&format!("# {}: {}\n", finding.kind.name(), finding.text));
            }
            for (what, count) in &findings.counts {
                page.push_str(&format!("# {count} {}\n", what.name()));
            }
            return console.print(&(page + &scene.text));
        }
        let clock = Instant::now();
        let bar = progress(scenes);
        let tally = numbers::tally::Tally::of(seed, self.from, scenes, || bar.inc(1));
        bar.finish_and_clear();
        let seconds = clock.elapsed().as_secs_f64();
        let head = format!("seed {seed}: {scenes} mechanisms in {seconds:.1} s\n");
        console.print(&(head + &tally.describe()))?;
        if let Some(folder) = &self.keep {
            tally.keep(seed, folder).map_err(stopped)?;
        }
        passed(tally.passes())
    }

    fn examine(&self, suite: Suite, console: &Console<'_>) -> Outcome {
        let Self { scenes, seed, .. } = *self;
        if let Some(number) = self.show {
            return console.print(&suite.page(seed, number));
        }
        let clock = Instant::now();
        let bar = progress(scenes);
        let tally = Tally::of(suite, seed, self.from, scenes, || bar.inc(1));
        bar.finish_and_clear();
        let seconds = clock.elapsed().as_secs_f64();
        let head = format!("seed {seed}: {scenes} scenes in {seconds:.1} s\n");
        console.print(&(head + &tally.describe()))?;
        if let Some(folder) = &self.keep {
            tally.keep(seed, folder).map_err(stopped)?;
        }
        passed(tally.passes())
    }
}

/// A range of drawings, each of which is written in several ways.
#[derive(Args)]
pub(super) struct Drawings {
    /// Number of drawings
    #[arg(long, default_value_t = 1_000, value_parser = clap::value_parser!(u64).range(1..))]
    drawings: u64,
    /// Seed of all scenes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The first drawing
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// Writes one scene with the correct answer and that of the program, then ends
    #[arg(long, value_name = "NUMBER")]
    show: Option<u64>,
    /// Directory for scenes with a wrong answer, the shortest of each kind
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
}

impl Drawings {
    fn examine(&self, suite: Suite, console: &Console<'_>) -> Outcome {
        let ways = suite.ways() as u64;
        let scenes = Scenes {
            scenes: self.drawings * ways,
            seed: self.seed,
            from: self.from * ways,
            show: self.show,
            keep: self.keep.clone(),
        };
        scenes.examine(suite, console)
    }
}

/// Creates a progress bar; it is hidden if standard error is not a terminal.
fn progress(all: u64) -> ProgressBar {
    let bar = ProgressBar::new(all);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len}, {per_sec}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// Returns exit code 1 if a test failed; the failures have already been printed.
fn passed(all: bool) -> Outcome {
    if all {
        Ok(())
    } else {
        Err(Failure::Incomplete)
    }
}

fn stopped(e: io::Error) -> Failure {
    Failure::stopped(e.to_string())
}

pub(super) fn run(arguments: &Fuzz, console: &Console<'_>) -> Outcome {
    match arguments {
        Fuzz::Run {
            space,
            inputs,
            seed,
            from,
            threads,
            deadline,
            memory,
            found,
        } => {
            let limits = Limits {
                program: std::env::current_exe().map_err(stopped)?,
                deadline: Duration::from_secs(*deadline),
                memory: *memory,
            };
            let campaign = Campaign {
                space: *space,
                seed: *seed,
                from: *from,
                inputs: *inputs,
                threads: *threads,
                limits,
                found: found.clone(),
            };
            let clock = Instant::now();
            let bar = progress(*inputs);
            let tally = campaign
                .run(|done| bar.set_position(done))
                .map_err(stopped)?;
            bar.finish_and_clear();
            let seconds = clock.elapsed().as_secs_f64();
            console.print(&describe(&tally, *seed, *inputs, seconds))?;
            passed(tally.faults.is_empty())
        }
        Fuzz::Try { file } => {
            let mut bytes = Vec::new();
            let read = if file.as_os_str() == "-" {
                io::stdin().read_to_end(&mut bytes).map(drop)
            } else {
                fs::read(file).map(|read| bytes = read)
            };
            read.map_err(|e| unreadable(file, &e))?;
            let text = String::from_utf8_lossy(&bytes);
            console.write(|mut out| answer(&mut out, &text))
        }
        Fuzz::Exact { suite, scenes } => scenes.examine(*suite, console),
        Fuzz::Numbers(scenes) => scenes.examine_numbers(console),
        Fuzz::Rounded { space, drawings } => {
            let suite = match space {
                Space::Plane => Suite::RoundedInPlane,
                Space::Space => Suite::RoundedInSpace,
            };
            drawings.examine(suite, console)
        }
        Fuzz::FullRank(drawings) => drawings.examine(Suite::FullRank, console),
        Fuzz::Passages { runs, seed, from } => {
            let clock = Instant::now();
            let bar = progress(*runs);
            let tally = passages::Tally::of(*seed, *from, *runs, || bar.inc(1));
            bar.finish_and_clear();
            let seconds = clock.elapsed().as_secs_f64();
            let head = format!("seed {seed}: {runs} runs in {seconds:.1} s\n");
            console.print(&(head + &tally.describe()))?;
            passed(tally.passes())
        }
        Fuzz::Forms { sets, seed, from } => {
            let clock = Instant::now();
            let bar = progress(*sets);
            let tally = forms::Tally::of(*seed, *from, *sets, || bar.inc(1));
            bar.finish_and_clear();
            let seconds = clock.elapsed().as_secs_f64();
            let head = format!("seed {seed}: {sets} sets in {seconds:.1} s\n");
            console.print(&(head + &tally.describe()))?;
            passed(tally.passes())
        }
        Fuzz::Show {
            space,
            seed,
            number,
        } => console.print(&input::text(*space, *seed, *number)),
        Fuzz::Work {
            space,
            seed,
            from,
            to,
        } => console.write(|mut out| {
            (*from..*to)
                .try_for_each(|number| answer(&mut out, &input::text(*space, *seed, number)))
        }),
    }
}

/// Tests a text: writes one letter for each stage that begins, and one letter for the last stage
/// reached.
fn answer(out: &mut impl Write, text: &str) -> io::Result<()> {
    let mut written = Ok(());
    let mut say = |letter: char| {
        if written.is_ok() {
            written = write!(out, "{letter}").and_then(|()| out.flush());
        }
    };
    let reach = trial::of(text, |stage| say(stage.letter()));
    say(reach.letter());
    written
}

/// Describes the tally as text.
fn describe(tally: &campaign::Tally, seed: u64, inputs: u64, seconds: f64) -> String {
    let mut text = format!(
        "\nseed {seed}: {inputs} inputs in {seconds:.1} s, {:.0} each second\n",
        inputs as f64 / seconds
    );
    for (reach, count) in &tally.reached {
        text.push_str(&format!("{count:>10} {reach}\n"));
    }
    for (place, found) in &tally.faults {
        text.push_str(&format!(
            "{:>10} FAILED at {place}: first input {}, {}\n",
            found.count,
            found.first,
            found.file.display()
        ));
    }
    text.push_str(&format!("{} places of failure\n", tally.faults.len()));
    text
}
