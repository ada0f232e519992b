//! `cargo run --release -p fuzz -- run --inputs 1000000 --seed 1`: random and damaged scenes
//! through check, analyze and simulate. `cargo run --release -p fuzz -- exact`: 20 000 degenerate
//! scenes, judged by exact arithmetic.

use std::fs;
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::{Parser, Subcommand};
use fuzz::campaign::{Campaign, Tally};
use fuzz::exact;
use fuzz::exact::rounded::{self, Suite};
use fuzz::watch::Limits;
use fuzz::{input, trial};

/// Random and damaged scenes through check, analyze and simulate
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Tries many inputs; exit code 1 if one of them fails
    Run {
        /// How many
        #[arg(long)]
        inputs: u64,
        /// Seed of all inputs
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The first input
        #[arg(long, default_value_t = 0)]
        from: u64,
        /// Processes at the same time
        #[arg(long, default_value_t = 2)]
        threads: usize,
        /// Longest time for one input (s)
        #[arg(long, default_value_t = 10)]
        deadline: u64,
        /// Largest memory of a process (MiB)
        #[arg(long, default_value_t = 2048)]
        memory: u64,
        /// Where found texts are kept
        #[arg(long, default_value = "found")]
        found: PathBuf,
    },
    /// Tries one text, or standard input for -
    Try {
        /// The file
        file: PathBuf,
    },
    /// Writes the text of an input
    Show {
        /// Seed
        seed: u64,
        /// Number
        number: u64,
    },
    /// Examines degenerate scenes by exact arithmetic; exit code 1 if one is told wrong
    Exact {
        /// How many
        #[arg(long, default_value_t = 20_000)]
        scenes: u64,
        /// Seed of all scenes
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The first scene
        #[arg(long, default_value_t = 0)]
        from: u64,
        /// Writes one scene with what is so and what was told, and ends
        #[arg(long, value_name = "NUMBER")]
        show: Option<u64>,
        /// Where scenes that are told wrong are kept, the shortest of each kind
        #[arg(long, value_name = "DIR")]
        keep: Option<PathBuf>,
    },
    /// Examines scenes with 3 … 16 significant digits; exit code 1 if one is told wrong
    Rounded(Drawings),
    /// Examines scenes of full rank near a lower one, with tolerances below a third of what they
    /// are off by; exit code 1 if one is told redundant
    FullRank(Drawings),
    /// Tries inputs one after the other and answers each with a letter: what `run` begins
    #[command(hide = true)]
    Work {
        /// Seed
        seed: u64,
        /// The first one
        from: u64,
        /// The first one that is not tried
        to: u64,
    },
}

/// Which drawings, each of which is written down in several ways.
#[derive(clap::Args)]
struct Drawings {
    /// How many
    #[arg(long, default_value_t = 1_000)]
    drawings: u64,
    /// Seed of all scenes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The first drawing
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// Writes one scene with what is so and what was told, and ends
    #[arg(long, value_name = "NUMBER")]
    show: Option<u64>,
}

impl Drawings {
    fn examine(&self, suite: Suite, out: &mut impl Write) -> io::Result<ExitCode> {
        if let Some(number) = self.show {
            let (drawn, way) = (number / suite.ways(), number % suite.ways());
            let outcomes = rounded::outcomes(suite, self.seed, drawn);
            if let Some(outcome) = outcomes.get(way as usize) {
                out.write_all(outcome.page().as_bytes())?;
            }
            return Ok(ExitCode::SUCCESS);
        }
        let clock = Instant::now();
        let tally = rounded::Tally::of(suite, self.seed, self.from, self.drawings);
        let (seconds, scenes) = (clock.elapsed().as_secs_f64(), self.drawings * suite.ways());
        let head = format!("seed {}: {scenes} scenes in {seconds:.1} s\n", self.seed);
        out.write_all((head + &tally.describe()).as_bytes())?;
        Ok(match tally.passes() {
            true => ExitCode::SUCCESS,
            false => ExitCode::from(1),
        })
    }
}

fn main() -> ExitCode {
    match go() {
        Ok(code) => code,
        Err(e) => {
            let _ = writeln!(io::stderr(), "error: {e}");
            ExitCode::from(2)
        }
    }
}

fn go() -> io::Result<ExitCode> {
    let mut out = io::stdout().lock();
    match Arguments::parse().command {
        Command::Run {
            inputs,
            seed,
            from,
            threads,
            deadline,
            memory,
            found,
        } => {
            drop(out);
            let limits = Limits {
                program: std::env::current_exe()?,
                deadline: Duration::from_secs(deadline),
                memory,
            };
            let campaign = Campaign {
                seed,
                from,
                inputs,
                threads,
                limits,
                found,
            };
            let clock = Instant::now();
            let progress = |done: u64| {
                let _ = write!(
                    io::stderr(),
                    "\r{done} of {inputs}, {:.0} inputs/s",
                    done as f64 / clock.elapsed().as_secs_f64()
                );
            };
            let tally = campaign.run(progress)?;
            let seconds = clock.elapsed().as_secs_f64();
            io::stdout().write_all(describe(&tally, seed, inputs, seconds).as_bytes())?;
            return Ok(match tally.faults.is_empty() {
                true => ExitCode::SUCCESS,
                false => ExitCode::from(1),
            });
        }
        Command::Try { file } => {
            let mut bytes = Vec::new();
            match file.as_os_str() == "-" {
                true => io::stdin().read_to_end(&mut bytes)?,
                false => {
                    bytes = fs::read(file)?;
                    bytes.len()
                }
            };
            answer(&mut out, &String::from_utf8_lossy(&bytes))?;
        }
        Command::Exact {
            seed,
            show: Some(number),
            ..
        } => out.write_all(exact::tally::outcome(seed, number).page().as_bytes())?,
        Command::Exact {
            scenes,
            seed,
            from,
            show: None,
            keep,
        } => {
            let clock = Instant::now();
            let tally = exact::tally::Tally::of(seed, from, scenes);
            let seconds = clock.elapsed().as_secs_f64();
            let head = format!("seed {seed}: {scenes} scenes in {seconds:.1} s\n");
            out.write_all((head + &tally.describe()).as_bytes())?;
            if let Some(folder) = keep {
                tally.keep(seed, &folder)?;
            }
            if !tally.passes() {
                return Ok(ExitCode::from(1));
            }
        }
        Command::Rounded(drawings) => return drawings.examine(Suite::Rounded, &mut out),
        Command::FullRank(drawings) => return drawings.examine(Suite::FullRank, &mut out),
        Command::Show { seed, number } => out.write_all(input::text(seed, number).as_bytes())?,
        Command::Work { seed, from, to } => {
            for number in from..to {
                answer(&mut out, &input::text(seed, number))?;
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Tries a text: a letter for each stage that begins, and one for how far it came.
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

/// The tally in words.
fn describe(tally: &Tally, seed: u64, inputs: u64, seconds: f64) -> String {
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
