//! `summary.json` of a sweep.

use serde::Serialize;

use super::{Cell, Column, Records, Runs, SweepStatus};

/// Largest number of failed runs that are listed.
const NAMED: usize = 10;

/// Summary of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepDocument {
    /// Name of the scene.
    pub scene: String,
    /// Keys with their values.
    pub vary: Vec<String>,
    /// Number of runs of the whole grid.
    pub runs: u64,
    /// The runs of the shard of this summary; `None` for all runs.
    pub shard: Option<Runs>,
    /// Number of runs that have a row.
    pub finished: u64,
    /// Whether the table lacks the rows of some runs.
    pub partial: bool,
    /// Runs that have no row.
    pub missing: Vec<Runs>,
    /// Number of repeated rows of runs that were made more than once, which is harmless.
    pub repeated: u64,
    /// Number of runs that reached their end.
    pub done: u64,
    /// Number of runs that ended when their one-sided joints opened.
    pub opened: u64,
    /// Number of runs that stopped before their end.
    pub stopped: u64,
    /// Number of runs that did not start.
    pub refused: u64,
    /// Number of runs during which their process ended.
    pub crashed: u64,
    /// The first runs that failed.
    pub failures: Vec<SweepFailure>,
    /// The largest energy balance of all runs; `None` if no run has an energy balance.
    pub max_energy_balance: Option<f64>,
    /// The run with this energy balance.
    pub max_energy_balance_run: Option<u64>,
}

/// The runs of a summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All runs.
    Whole,
    /// The runs of a shard. `None` if the shard has no runs because there are more shards than
    /// runs.
    Shard(Option<Runs>),
}

/// A run that failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepFailure {
    /// Index of the run, from 1.
    pub run: u64,
    /// `stopped`, `refused` or `crashed`.
    pub status: String,
    /// Reason of the failure.
    pub error: String,
}

impl SweepDocument {
    /// The summary of all runs, or of the runs of a shard.
    #[must_use]
    pub fn new(records: &Records, of: Extent) -> Self {
        let Records {
            plan,
            rows,
            repeated,
            ..
        } = records;
        let columns: &[Column] = &plan.columns();
        let asked = match of {
            Extent::Whole => Runs::new(1, plan.runs),
            Extent::Shard(runs) => runs,
        };
        let place = |name: &str| {
            // Varied keys come first and may have any names.
            let behind = 1 + plan.keys.len();
            let own = columns.iter().skip(behind);
            own.take_while(|c| c.name != name).count() + behind
        };
        let (status, error, balance) = (place("status"), place("error"), place("energy_balance"));
        let word = |cells: &[Cell], k: usize| match cells.get(k) {
            Some(Cell::Text(text)) => text.clone(),
            _ => String::new(),
        };
        let count = |wanted: SweepStatus| {
            let such = rows.values().filter(|c| word(c, status) == wanted.name());
            such.count() as u64
        };
        let good = [SweepStatus::Done, SweepStatus::Opened].map(SweepStatus::name);
        let is_good = |cells: &[Cell]| good.contains(&word(cells, status).as_str());
        let failures = rows.iter().filter(|(_, cells)| !is_good(cells));
        let mut worst: Option<(u64, f64)> = None;
        for (run, cells) in rows {
            if let Some(Cell::Number(x)) = cells.get(balance)
                && !x.is_nan()
                && worst.is_none_or(|(_, largest)| *x > largest)
            {
                worst = Some((*run, *x));
            }
        }
        let missing = asked.map_or_else(Vec::new, |runs| records.missing(runs));
        Self {
            scene: plan.scene.clone(),
            vary: plan.vary.clone(),
            runs: plan.runs,
            shard: match of {
                Extent::Whole => None,
                Extent::Shard(runs) => runs,
            },
            finished: rows.len() as u64,
            partial: !missing.is_empty(),
            missing,
            repeated: *repeated,
            done: count(SweepStatus::Done),
            opened: count(SweepStatus::Opened),
            stopped: count(SweepStatus::Stopped),
            refused: count(SweepStatus::Refused),
            crashed: count(SweepStatus::Crashed),
            failures: failures
                .take(NAMED)
                .map(|(run, cells)| SweepFailure {
                    run: *run,
                    status: word(cells, status),
                    error: word(cells, error),
                })
                .collect(),
            max_energy_balance: worst.map(|(_, x)| x),
            max_energy_balance_run: worst.map(|(run, _)| run),
        }
    }
}
