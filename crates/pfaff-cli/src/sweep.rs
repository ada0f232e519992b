//! `pfaff sweep`: many runs of one scene with other numbers, in parallel, in shards, resumable;
//! with progress on a terminal.

use std::num::NonZeroUsize;

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::model::codes::Code;
use pfaff::report::sweep::{FAMILY, Records, Runs};
use pfaff::report::{OutputDirectory, SweepDocument, SweepStatus};
use pfaff::sweep::{
    Axis, Merged, Shard, Sweep, SweepError, SweepProgress, SweepSettings, Tables, end_attempts,
    merge,
};

use crate::args;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, Refusal, Shortfall, beside, count, json_or, wrapped};
use crate::resources::{Resources, start_threads};
use pfaff::questions::simulate::TRUSTED_BALANCE;

pub(crate) fn run(arguments: &args::Sweep, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    start_threads(arguments.threads, console);
    check_place(arguments)?;
    let (document, ending) = match &arguments.scene {
        Some(scene) => make(
            arguments,
            &Source::read(scene, &arguments.settings, console)?,
        )?,
        None => {
            let merged = merge(&arguments.merge, &arguments.place.out);
            let Merged { document, shards } = merged.map_err(Refusal::from)?;
            let ending = if document.partial {
                Ending::Missing { shards }
            } else {
                Ending::Whole(Tables::Written)
            };
            (document, ending)
        }
    };
    let shortfall = shortfall(&document, ending);
    let text = if arguments.json {
        json_or(shortfall.as_ref(), &document)?
    } else {
        let out = arguments.place.out.display().to_string();
        let place = OutputDirectory::create(&arguments.place.out);
        let others = place.map_or_else(|_| String::new(), |place| beside(&place, FAMILY));
        describe(&document, arguments.shard, ending, &out) + &others
    };
    match shortfall {
        None => console.print(&text),
        Some(_) => Err(console.incomplete(&text)),
    }
}

/// Why a sweep is not done, if it is not.
fn shortfall(d: &SweepDocument, ending: Ending) -> Option<Shortfall> {
    let failed = |error| {
        let code = const { Code::new(514) };
        Some(Shortfall { code, error })
    };
    let made = format!("{} of {} runs have been made", d.finished, d.runs);
    match ending {
        Ending::Interrupted => Some(Shortfall::interrupted(format!(
            "interrupted; {made}: the same command resumes the sweep"
        ))),
        Ending::Missing { .. } => failed(made),
        Ending::Whole(_) if d.done == d.finished => None,
        Ending::Whole(_) => {
            let first = d.failures.first();
            let first = first.map_or_else(String::new, |first| {
                format!("; run {} {}: {}", first.run, first.status, first.error)
            });
            failed(format!(
                "{} of {} runs are not done{first}",
                d.finished - d.done,
                d.finished
            ))
        }
    }
}

/// Refuses a directory in which tables of somebody else would be replaced.
fn check_place(arguments: &args::Sweep) -> Outcome {
    let place = OutputDirectory::create(&arguments.place.out)?;
    if arguments.place.force {
        return Ok(());
    }
    Ok(place.check_ours(FAMILY)?)
}

/// How a sweep ended.
#[derive(Clone, Copy)]
enum Ending {
    /// All requested runs are finished.
    Whole(Tables),
    /// A stop was requested.
    Interrupted,
    /// Some runs have not been made by any shard.
    Missing {
        /// The number of shards, if it is known.
        shards: Option<u64>,
    },
}

/// Reads the scene of a sweep.
pub(crate) fn read<'s>(source: &'s Source, axes: Vec<Axis>) -> Result<Sweep<'s>, Failure> {
    let sweep = Sweep::read(&source.name, &source.text, source.registry, axes);
    sweep.map_err(|e| match e {
        SweepError::Study(e) => source.clone().start(Resources::default()).refusal(e).into(),
        other => Refusal::from(other).into(),
    })
}

/// Makes the runs.
fn make(arguments: &args::Sweep, source: &Source) -> Result<(SweepDocument, Ending), Failure> {
    let mut sweep = read(source, arguments.vary.clone())?;
    if arguments.keep_rows {
        sweep = sweep.keeping_rows();
    }
    let settings = SweepSettings {
        shard: arguments.shard,
        threads: arguments.threads.map_or(0, NonZeroUsize::get),
    };
    let out = arguments.place.out.clone();
    let is_whole = arguments.shard == Shard::WHOLE;
    let interrupt = Interrupt::listen_with(move || {
        end_attempts(&out);
        // Whatever is finished is in the journals, from which the tables are made.
        let place = out.display();
        let directory = [out.as_path()];
        let kept = if is_whole {
            let merged = merge(&directory, &out).map(|merged| merged.document);
            merged
                .map(|document| (document.finished, document.runs))
                .ok()
        } else {
            let records = Records::merged(&directory).ok();
            records.map(|records| (records.rows.len() as u64, records.plan.runs))
        };
        match kept {
            Some((finished, runs)) => format!(
                "interrupted; kept: {finished} of {runs} runs in `{place}`; the same command resumes the sweep"
            ),
            None => format!("interrupted; no run is finished in `{place}`"),
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
    let outcome = outcome.map_err(Refusal::from)?;
    let ending = if interrupted() {
        Ending::Interrupted
    } else if outcome.document.partial {
        Ending::Missing { shards: None }
    } else {
        Ending::Whole(outcome.tables)
    };
    Ok((outcome.document, ending))
}

/// Most gaps and shards that are named.
const NAMED: usize = 10;

/// The summary in words.
fn describe(d: &SweepDocument, shard: Shard, ending: Ending, out: &str) -> String {
    let all = count(d.runs as usize, "run", "runs");
    let mut text = match d.shard {
        None if shard == Shard::WHOLE => format!("{}: {} of {all}", d.scene, d.finished),
        None => format!("{}, shard {shard} of {all}: none", d.scene),
        Some(runs) => {
            let own = count(runs.count() as usize, "run", "runs");
            format!(
                "{}, shard {shard} of {all}: {} of {own}",
                d.scene, d.finished
            )
        }
    };
    text.push_str(&format!(
        ": {} done, {} stopped, {} refused",
        d.done, d.stopped, d.refused
    ));
    if d.crashed > 0 {
        text.push_str(&format!(", {} crashed", d.crashed));
    }
    text.push('\n');
    if d.repeated > 0 {
        let repeated = count(d.repeated as usize, "run was", "runs were");
        text.push_str(&format!("{repeated} made twice, with the same results\n"));
    }
    match ending {
        Ending::Whole(_) => {}
        Ending::Interrupted => text.push_str("interrupted; the same command resumes it\n"),
        Ending::Missing { shards } => text.push_str(&gaps(d, shards)),
    }
    for failure in &d.failures {
        let lead = format!("run {} {}: ", failure.run, failure.status);
        text.push_str(&wrapped(&lead, &failure.error));
    }
    let named = d.failures.len() as u64;
    let failed = d.stopped + d.refused + d.crashed;
    if named < failed {
        let more = failed - named;
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
    let place = match (d.shard, ending) {
        (Some(_), Ending::Whole(Tables::NotYet)) => {
            format!("kept in {out}; the shard that ends last writes the tables\n")
        }
        (Some(_), Ending::Whole(Tables::Written)) => {
            format!("all runs are there: tables written to {out}\n")
        }
        (Some(_), _) => format!("kept in {out}\n"),
        (None, _) => format!("written to {out}\n"),
    };
    text.push_str(&place);
    text
}

/// The runs that are missing, with the shards that make them.
fn gaps(d: &SweepDocument, shards: Option<u64>) -> String {
    let mut text = String::new();
    let option = |shard: &Shard| format!("`--shard {shard}`");
    let known = |runs: &Runs| Shard::of(*runs, d.runs, shards?);
    for runs in d.missing.iter().take(NAMED) {
        let verb = if runs.count() == 1 { "run" } else { "runs" };
        let is = if runs.count() == 1 { "is" } else { "are" };
        let makers = match known(runs) {
            Some(shards) => {
                let mut options: Vec<String> = shards.iter().take(NAMED).map(option).collect();
                if shards.len() > NAMED {
                    options.push(format!("and {} more", shards.len() - NAMED));
                }
                options.join(", ")
            }
            None => "the command without `--shard` makes what is missing".to_owned(),
        };
        text.push_str(&format!("{verb} {runs} {is} missing: {makers}\n"));
    }
    if d.missing.len() > NAMED {
        text.push_str(&format!("and {} more gaps\n", d.missing.len() - NAMED));
    }
    text
}
