//! `pfaff sweep`: many runs of one scene with other numbers, in parallel, in shards, resumable;
//! with progress on a terminal.

use std::num::NonZeroUsize;

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::report::sweep::FILES;
use pfaff::report::{FileError, SweepDocument, SweepStatus, is_ours};
use pfaff::sweep::{Sweep, SweepError, SweepProgress, SweepSettings, merge};

use crate::args;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, count, json, unwritten, wrapped};
use crate::simulate::TRUSTED_BALANCE;

pub(crate) fn run(arguments: &args::Sweep, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    pfaff::start_threads(arguments.threads);
    check_place(arguments)?;
    let (document, ending) = match &arguments.scene {
        Some(scene) => make(
            arguments,
            &Source::read(scene, &arguments.settings, console)?,
        )?,
        None => {
            let document =
                merge(&arguments.merge, &arguments.place.out).map_err(|e| failure(&e))?;
            let ending = if document.partial {
                Ending::Missing
            } else {
                Ending::Whole
            };
            (document, ending)
        }
    };
    let text = if arguments.json {
        json(&document)?
    } else {
        describe(
            &document,
            ending,
            &arguments.place.out.display().to_string(),
        )
    };
    match ending {
        Ending::Whole if document.done == document.finished => console.print(&text),
        _ => Err(console.incomplete(&text)),
    }
}

/// Refuses a directory in which tables of somebody else would be replaced.
fn check_place(arguments: &args::Sweep) -> Outcome {
    let paths = FILES.map(|name| arguments.place.out.join(name));
    let foreign: Vec<_> = paths.into_iter().filter(|path| !is_ours(path)).collect();
    if arguments.place.force || foreign.is_empty() {
        return Ok(());
    }
    Err(unwritten(&FileError::Foreign { paths: foreign }))
}

/// How a sweep ended.
#[derive(Clone, Copy)]
enum Ending {
    /// All requested runs are finished.
    Whole,
    /// A stop was requested.
    Interrupted,
    /// Some runs have not been made by any shard.
    Missing,
}

/// Makes the runs.
fn make(arguments: &args::Sweep, source: &Source) -> Result<(SweepDocument, Ending), Failure> {
    let sweep = Sweep::read(
        &source.name,
        &source.text,
        source.registry,
        arguments.vary.clone(),
    );
    let mut sweep = sweep.map_err(|e| match e {
        SweepError::Study(e) => source.failure(e),
        other => failure(&other),
    })?;
    if arguments.keep_rows {
        sweep = sweep.keeping_rows();
    }
    let settings = SweepSettings {
        shard: arguments.shard,
        threads: arguments.threads.map_or(0, NonZeroUsize::get),
    };
    let out = arguments.place.out.clone();
    let interrupt = Interrupt::listen_with(move || {
        // Whatever is finished is in the journals, from which the tables are made.
        let place = out.display();
        match merge(&[out.as_path()], &out) {
            Ok(document) => format!(
                "interrupted; kept: {} of {} runs in `{place}`; the same command resumes the sweep",
                document.finished, document.runs
            ),
            Err(_) => format!("interrupted; no run is finished in `{place}`"),
        }
    })?;
    let interrupted = || interrupt.is_asked();
    // It hides itself if standard error is not a terminal.
    let bar = ProgressBar::new(0);
    let template = "{bar:40} {pos}/{len} runs, {per_sec}, {eta} left{msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    let mut failed: u64 = 0;
    let outcome =
        sweep.run_into(
            &arguments.place.out,
            &settings,
            interrupted,
            |progress| match progress {
                SweepProgress::Begin { runs, finished } => {
                    bar.set_length(runs);
                    bar.set_position(finished);
                    bar.reset_eta();
                }
                SweepProgress::Finished(row) => {
                    bar.inc(1);
                    if row.status != SweepStatus::Done {
                        failed += 1;
                        bar.set_message(format!(", {failed} not done"));
                    }
                }
            },
        );
    bar.finish_and_clear();
    let ending = if interrupted() {
        Ending::Interrupted
    } else {
        Ending::Whole
    };
    Ok((outcome.map_err(|e| failure(&e))?, ending))
}

fn failure(error: &SweepError) -> Failure {
    let failure = if error.is_input() {
        Failure::input(error.to_string())
    } else {
        Failure::stopped(error.to_string())
    };
    failure.coded(error.code())
}

/// The summary in words.
fn describe(d: &SweepDocument, ending: Ending, out: &str) -> String {
    let mut text = format!(
        "{}: {} of {}: {} done, {} stopped, {} refused\n",
        d.scene,
        d.finished,
        count(d.runs as usize, "run", "runs"),
        d.done,
        d.stopped,
        d.refused,
    );
    text.push_str(match ending {
        Ending::Whole => "",
        Ending::Interrupted => "interrupted; the same command resumes it\n",
        Ending::Missing => "runs are missing: shards that were not made, or not to their end\n",
    });
    for failure in &d.failures {
        let lead = format!("run {} {}: ", failure.run, failure.status);
        text.push_str(&wrapped(&lead, &failure.error));
    }
    let named = d.failures.len() as u64;
    if named < d.stopped + d.refused {
        let more = d.stopped + d.refused - named;
        text.push_str(&format!("and {more} more: see the column `error`\n"));
    }
    if let (Some(balance), Some(run)) = (d.max_energy_balance, d.max_energy_balance_run)
        && balance > TRUSTED_BALANCE
    {
        text.push_str(&format!(
            "warning: the energy balance of run {run} is off by {balance:.1e} of its largest kinetic energy: do not trust it, \
             nor others above {TRUSTED_BALANCE:.0e} in the column `energy_balance`\n"
        ));
    }
    text.push_str(&format!("written to {out}\n"));
    text
}
