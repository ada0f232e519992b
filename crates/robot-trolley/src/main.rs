//! The robot with its trolley of Wojtyra and Frączek (2013), section 4: prints the published
//! results, draws the published figures and writes the report of a run, for the dimensions of
//! `robot-trolley.toml`.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod figures;
mod text;
mod variants;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use pfaff::RunOptions;
use pfaff::report::OutputDirectory;
use pfaff::solvability::analyse;

/// The published results for the robot with its trolley: ranks, verdicts, three elimination
/// variants, figures, and the report of a run
#[derive(Parser)]
#[command(version, about)]
struct Arguments {
    /// Directory for the figures and the report
    #[arg(long, value_name = "DIR", default_value = "figures")]
    out: PathBuf,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("error: {e}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn std::error::Error>> {
    let study = variants::read(&RunOptions::default())?;
    let mechanism = &study.prepared.mechanism;
    let start = analyse(mechanism, 0.0, &study.prepared.q)?;
    println!("{}", text::structure(&start));

    let variants = variants::run()?;
    let mut agreeing = 0;
    for instant in &variants[0].rows {
        let analysis = analyse(mechanism, instant.t, &instant.q)?;
        agreeing += usize::from(text::same_verdicts(&start, &analysis));
    }
    let instants = variants[0].rows.len();
    println!("{}", text::verdicts(&start, agreeing, instants));
    println!("{}", text::variants(mechanism, &variants));
    println!("{}", text::generated(&variants[0], &variants::generated()?));

    let directory = OutputDirectory::create(&arguments.out)?;
    for path in figures::write(mechanism, &start, &variants, &directory)? {
        println!("written: {}", path.display());
    }
    study.simulate_into(&directory, |_| ControlFlow::Continue(()))?;
    let report = arguments.out.join("report.html");
    println!(
        "report: {} (opens in any browser), with its tables in the same folder",
        report.display()
    );
    Ok(())
}
