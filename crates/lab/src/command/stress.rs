//! The command `lab stress`: runs the stiff and extreme cases and compares each with its known
//! answer.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crate::stress::{
    self, Family, StressDocument, StressFamily, StressRow, StressTable, Tally, extremes,
    stress_page,
};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use pfaff::report::{OutputDirectory, OutputFile, TableError, write_json};

use pfaff::words::{self, Block};
use pfaff_cli::console::Console;
use pfaff_cli::input::unknown;
use pfaff_cli::interrupt::Interrupt;
use pfaff_cli::output::{Failure, Outcome, count, wrapped};
use pfaff_cli::provenance::provenance;

#[derive(Args)]
pub(super) struct Stress {
    /// Directory for the results
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    out: Option<PathBuf>,
    /// Only cases of this family; may be given several times
    #[arg(long, value_name = "NAME")]
    family: Vec<String>,
    /// List the families
    #[arg(long, conflicts_with = "json")]
    list: bool,
    /// All results as one JSON document on standard output
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &Stress, console: &Console<'_>) -> Outcome {
    let families = families(arguments)?;
    if arguments.list {
        return console.print(&list(&families));
    }
    let stopped = |e: &dyn std::error::Error| Failure::stopped(e.to_string());
    let Some(out) = &arguments.out else {
        return Err(Failure::input("--out DIR is needed, or --list".to_owned()));
    };
    let directory = OutputDirectory::create(out).map_err(|e| stopped(&e))?;
    let file = directory.file("stress.csv").map_err(|e| stopped(&e))?;
    let table = StressTable::new(file).map_err(|e| stopped(&e))?;
    let (document, table) = make(&families, table)?;
    let file = table.finish().map_err(|e| stopped(&e))?;
    let finished = if document.partial {
        file.finish_partial()
    } else {
        file.finish()
    };
    finished.map_err(|e| stopped(&e))?;
    let mut json = Vec::new();
    write_json(&mut json, &document).map_err(|e| stopped(&e))?;
    let figure = extremes(&document.families);
    let page = stress_page(&document, &figure);
    for (name, text) in [
        ("stress.json", json.as_slice()),
        ("stress.svg", figure.as_bytes()),
        ("report.html", page.as_bytes()),
    ] {
        directory.write(name, text).map_err(|e| stopped(&e))?;
    }
    if arguments.json {
        console.print(&String::from_utf8_lossy(&json))?;
    } else {
        console.print(&describe(&document, &out.display().to_string()))?;
    }
    if document.partial || document.tally.failing > 0 {
        Err(Failure::Incomplete)
    } else {
        Ok(())
    }
}

/// Returns the requested families, or all families.
fn families(arguments: &Stress) -> Result<Vec<Family>, Failure> {
    if arguments.family.is_empty() {
        return Ok(stress::families());
    }
    let known = |name: &String| {
        stress::find(name).ok_or_else(|| {
            let names: Vec<&str> = stress::families().iter().map(|f| f.name).collect();
            unknown("family", name, &names)
        })
    };
    arguments.family.iter().map(known).collect()
}

fn list(families: &[Family]) -> String {
    let lines = families.iter().map(|f| [f.name, f.about]);
    words::text(&[Block::table(["family", "about"], lines)], false)
}

/// Runs all cases; if a stop is requested, returns the results so far.
fn make(
    families: &[Family],
    mut table: StressTable<OutputFile>,
) -> Result<(StressDocument, StressTable<OutputFile>), Failure> {
    let interrupt = Interrupt::listen()?;
    let cases: usize = families.iter().map(|f| (f.cases)().len()).sum();
    // The bar is hidden if standard error is not a terminal.
    let bar = ProgressBar::new(cases as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} cases{msg}, {eta} left") {
        bar.set_style(style);
    }
    let threads = thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let full = AtomicBool::new(false);
    let interrupted = || interrupt.is_asked() || full.load(Ordering::Relaxed);
    let (mut failing, mut unwritten) = (0, None::<TableError>);
    let rows = stress::run(families, threads, &interrupted, |row| {
        bar.inc(1);
        if !row.judgement.passes() {
            failing += 1;
            bar.set_message(format!(", {failing} not passed"));
        }
        if let Err(e) = table.row(row) {
            unwritten = Some(e);
            full.store(true, Ordering::Relaxed);
        }
    });
    bar.finish_and_clear();
    if let Some(e) = unwritten {
        return Err(Failure::stopped(e.to_string()));
    }
    let document = StressDocument {
        provenance: provenance(),
        partial: rows.len() < cases,
        tally: tally(&rows),
        families: families.iter().map(|f| family(f, &rows)).collect(),
    };
    Ok((document, table))
}

fn tally(rows: &[StressRow]) -> Tally {
    Tally::of(rows.iter().map(|row| row.judgement))
}

fn family(family: &Family, rows: &[StressRow]) -> StressFamily {
    let own = rows.iter().filter(|row| row.family == family.name);
    let rows: Vec<StressRow> = own.cloned().collect();
    StressFamily {
        name: family.name,
        about: family.about,
        tally: tally(&rows),
        rows,
    }
}

/// Describes the results: the cases that fail, and the number of outcomes of each kind.
fn describe(document: &StressDocument, out: &str) -> String {
    let mut text = String::new();
    for row in document.families.iter().flat_map(|f| &f.rows) {
        if row.judgement.passes() {
            continue;
        }
        let lead = format!(
            "{}: {}, {} {}: {}\n",
            row.family,
            row.case,
            row.method,
            row.formulation,
            row.judgement.words()
        );
        text.push_str(&lead);
        text.push_str(&wrapped("  right is ", &row.expected));
        let found = if row.error.is_nan() {
            row.outcome.clone()
        } else {
            format!("off by {:.1e}; {}", row.error, row.outcome)
        };
        text.push_str(&wrapped("  it came out ", &found));
    }
    if document.partial {
        text.push_str("interrupted, partial\n");
    }
    if document.tally.failing > 0 {
        let cases = count(document.tally.failing, "case does", "cases do");
        text.push_str(&format!("{cases} not pass\n"));
    }
    text.push_str(&format!(
        "written to {out}\n{}\n",
        document.tally.last_line()
    ));
    text
}
