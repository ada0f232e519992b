//! What are the results of runs with different numbers?

mod words;

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::PoisonError;

use model::codes::Code;
use report::sweep::{FAMILY, Records};
use report::{OutputDirectory, SweepDocument};
use serde::{Deserialize, Serialize};

use crate::question::{Answer, Control, Ending, Output, Progress, Question, Writing};
use crate::refusal::Refusal;
use crate::start::Start;
use crate::sweep::{
    self, Axis, MergedSweep, Shard, SweepError, SweepProgress, SweepSettings, Tables, end_attempts,
    merge,
};
use crate::words::Block;

/// Run a parameter sweep (parallel, resumable, sharded)
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("sweep/examples.txt")))]
pub struct Sweep {
    /// Vary a parameter or number: KEY=FROM:TO:N, KEY=FROM:TO:N:log or KEY=A,B,C; repeatable
    #[cfg_attr(feature = "schema", schemars(with = "Vec<String>"))]
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "KEY=VALUES", required_unless_present = "merge")
    )]
    pub vary: Vec<Axis>,
    /// Run only part K of N; shards may share a directory
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    #[cfg_attr(feature = "command", arg(long, value_name = "K/N", default_value_t = Shard::WHOLE))]
    pub shard: Shard,
    /// Keep the trajectory of each run (runs/NUMBER/trajectory.csv)
    #[cfg_attr(feature = "command", arg(long))]
    pub keep_rows: bool,
    /// Merge the results of these directories instead of running
    #[cfg_attr(feature = "command", arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["vary", "shard", "keep_rows"]))]
    pub merge: Vec<PathBuf>,
}

impl Default for Sweep {
    fn default() -> Self {
        Self {
            vary: Vec::new(),
            shard: Shard::WHOLE,
            keep_rows: false,
            merge: Vec::new(),
        }
    }
}

/// Error code if a sweep ends with unfinished runs.
const NOT_DONE: Code = Code::new(514);

impl Question for Sweep {
    const NAME: &'static str = "sweep";
    const SCHEMA: &'static str = include_str!("sweep/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: FAMILY,
        contents: "tables and partial results",
        writing: Writing::Meanwhile { shared: true, cut },
    });
    type Subject<'s> = Option<&'s Start<'s>>;
    type Answer = SweepAnswer;

    fn answer(
        &self,
        of: Option<&Start<'_>>,
        control: &Control<'_>,
    ) -> Result<SweepAnswer, Refusal> {
        let Some(directory) = control.directory else {
            let message = "a sweep needs an output directory";
            return Err(Refusal::input(message.to_owned()));
        };
        match of {
            Some(_) if !self.merge.is_empty() => Err(Refusal::input(
                "either a scene, or directories after --merge, not both".to_owned(),
            )),
            Some(scene) => self.made(scene, directory, control),
            None if self.merge.is_empty() => Err(Refusal::input(
                "a sweep needs a scene, or directories after --merge".to_owned(),
            )),
            None => {
                let MergedSweep { document, shards } = merge(&self.merge, directory.path())?;
                let end = if document.partial {
                    SweepEnd::Missing { shards }
                } else {
                    SweepEnd::Whole(Tables::Written)
                };
                Ok(SweepAnswer {
                    document,
                    shard: Shard::WHOLE,
                    end,
                })
            }
        }
    }
}

impl Sweep {
    /// Performs the runs.
    fn made(
        &self,
        of: &Start<'_>,
        directory: &OutputDirectory,
        control: &Control<'_>,
    ) -> Result<SweepAnswer, Refusal> {
        let refused = |e: SweepError| match e {
            SweepError::Study(e) => of.refusal(e),
            e => e.into(),
        };
        let assembled = of.assembled(control)?;
        let sweep = sweep::Sweep::of(
            &assembled,
            &of.text,
            (of.registry, of.tolerance),
            self.vary.clone(),
        );
        let mut sweep = sweep.map_err(refused)?;
        let threads = control.threads.map_or(0, NonZeroUsize::get);
        if of.budget.limit.is_some() {
            // A scene without a consistent start may have a consistent start with other numbers.
            let study = of.study(control).ok();
            let of_run = study.and_then(|study| study.memory(of.text.len()).ok());
            let of_all = of_run.unwrap_or(0).saturating_mul(threads.max(1));
            of.budget.allow(of_all, "this sweep")?;
        }
        if self.keep_rows {
            sweep = sweep.keeping_rows();
        }
        let settings = SweepSettings {
            shard: self.shard,
            threads,
        };
        (control.progress)(Progress::Writing(self.shard.to_string()));
        // Number of finished runs, number of all runs, and number of failed runs.
        let counts = Mutex::new((0, 0, 0));
        let outcome = sweep.run_into(directory.path(), &settings, control.stop, |progress| {
            let mut counts = counts.lock().unwrap_or_else(PoisonError::into_inner);
            let (done, all, failed) = &mut *counts;
            match progress {
                SweepProgress::Begin { runs, finished } => (*done, *all) = (finished, runs),
                SweepProgress::Finished(row) => {
                    *done += 1;
                    *failed += u64::from(row.status.is_failure());
                }
            }
            let note = match failed {
                0 => String::new(),
                failed => format!(", {failed} not done"),
            };
            (control.progress)(Progress::Runs(*done, *all, note));
        });
        let outcome = outcome.map_err(refused)?;
        let end = if (control.stop)() {
            SweepEnd::Interrupted
        } else if outcome.document.partial {
            SweepEnd::Missing { shards: None }
        } else {
            SweepEnd::Whole(outcome.tables)
        };
        Ok(SweepAnswer {
            document: outcome.document,
            shard: self.shard,
            end,
        })
    }
}

/// Ends the attempt properly, so that no run of the attempt counts as the cause of a crash. Writes
/// the tables of the finished runs. `begun` is the name of the shard.
fn cut(directory: &OutputDirectory, begun: Option<&str>) -> String {
    let out = directory.path();
    end_attempts(out);
    let folder = [out];
    let kept = if begun.is_none_or(|shard| shard == Shard::WHOLE.to_string()) {
        let merged = merge(&folder, out).map(|merged| merged.document);
        merged
            .map(|document| (document.finished, document.runs))
            .ok()
    } else {
        let records = Records::merged(&folder).ok();
        records.map(|records| (records.rows.len() as u64, records.plan.runs))
    };
    let place = out.display();
    match kept {
        Some((finished, runs)) => format!(
            "interrupted; kept: {finished} of {runs} runs in `{place}`; the same command resumes the sweep"
        ),
        None => format!("interrupted; no run is finished in `{place}`"),
    }
}

/// How a sweep ended.
#[derive(Clone, Copy, Debug)]
enum SweepEnd {
    /// All requested runs are finished.
    Whole(Tables),
    /// A stop was requested.
    Interrupted,
    /// Some runs have not been performed by any shard.
    Missing {
        /// The number of shards, if it is known.
        shards: Option<u64>,
    },
}

/// The runs of a sweep.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SweepAnswer {
    /// Summary of the runs.
    #[serde(flatten)]
    pub document: SweepDocument,
    #[serde(skip)]
    shard: Shard,
    #[serde(skip)]
    end: SweepEnd,
}

impl Answer for SweepAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(self)
    }

    fn ending(&self) -> Ending {
        let d = &self.document;
        let failed = |error| Ending::Partial {
            code: NOT_DONE,
            error,
        };
        let made = format!("{} of {} runs have been made", d.finished, d.runs);
        match self.end {
            SweepEnd::Interrupted => Ending::interrupted(format!(
                "interrupted; {made}: the same command resumes the sweep"
            )),
            SweepEnd::Missing { .. } => failed(made),
            SweepEnd::Whole(_) if d.done + d.opened == d.finished => Ending::Complete,
            SweepEnd::Whole(_) => {
                let first = d.failures.first();
                let first = first.map_or_else(String::new, |first| {
                    format!("; run {} {}: {}", first.run, first.status, first.error)
                });
                let (failures, all) = (d.finished - d.done - d.opened, d.finished);
                failed(format!("{failures} of {all} runs failed{first}"))
            }
        }
    }

    fn written(&self, place: &str) -> String {
        match (self.document.shard, self.end) {
            (Some(_), SweepEnd::Whole(Tables::NotYet)) => {
                format!("kept in {place}; the shard that ends last writes the tables")
            }
            (Some(_), SweepEnd::Whole(Tables::Written)) => {
                format!("all runs are done: tables written to {place}")
            }
            (Some(_), _) => format!("kept in {place}"),
            (None, _) => format!("written to {place}"),
        }
    }
}
