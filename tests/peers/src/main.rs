//! Compares our methods with those of other crates on the same right-hand sides:
//! `cargo run --release -- DIRECTORY` in `tests/peers`.

mod equal_error;
mod figure;
mod libraries;
mod machine;
mod measure;
mod problem;
mod problems;
mod runs;
mod tables;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use measure::{Row, measure};
use problems::mechanism::{MovingCase, VelocityScale};

fn main() -> ExitCode {
    let directory = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("."), PathBuf::from);
    match run(&directory) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(directory: &std::path::Path) -> Result<(), Box<dyn Error>> {
    if cfg!(debug_assertions) {
        return Err("times of a debug build mean nothing: use --release".into());
    }
    let robot = MovingCase::find("robot-trolley", VelocityScale::One)?;
    let andrews = MovingCase::find("andrews", VelocityScale::Largest)?;
    let mut runs = Vec::new();
    runs.extend(runs::of_mechanism("robot-trolley", &robot)?);
    runs.extend(runs::of_mechanism("andrews", &andrews)?);
    runs.extend(runs::of_arenstorf());
    runs.extend(runs::of_robertson());
    let rows = measure(&runs);
    std::fs::create_dir_all(directory)?;

    let mut text = format!(
        "# Tables\n\nWritten by `tests/peers`. What they mean: [README](README.md).\n\n{}",
        machine::describe()
    );
    let titles = [
        ("robot-trolley", "Robot with trolley, 10 s"),
        ("andrews", "Andrews' squeezing mechanism, 0.03 s"),
        ("arenstorf", "Arenstorf orbit, one period"),
        ("robertson", "Robertson's reaction to t = 10¹¹"),
    ];
    for (name, title) in titles {
        let of_problem: Vec<&Row> = rows
            .iter()
            .filter(|row| row.series.problem == name)
            .collect();
        text += "\n";
        text += &tables::problem(title, &of_problem)?;
        let figure = figure::draw(title, &of_problem)?;
        std::fs::write(directory.join(format!("{name}.svg")), figure)?;
    }
    std::fs::write(directory.join("tables.md"), text)?;
    std::fs::write(directory.join("peers.csv"), tables::csv(&rows)?)?;
    Ok(())
}
