//! The records of the runs of a sweep, collected from finished shards and journals.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::error::Difference;
use super::{Cell, JournalError, Runs, SweepPlan, SweepRows, SweepStatus};

/// The records of some runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Records {
    /// The description of the sweep.
    pub plan: SweepPlan,
    /// The finished runs.
    pub rows: SweepRows,
    /// Number of additional rows, from runs that were made more than once.
    pub repeated: u64,
    /// Finished shards.
    pub sealed: Vec<Runs>,
    /// Runs without a row during which the process ended. For each run, the value is the number of
    /// times that the process ended while it made only this run.
    pub suspects: BTreeMap<u64, u64>,
}

impl Records {
    /// Empty records.
    #[must_use]
    pub fn none(plan: &SweepPlan) -> Self {
        RecordCollection::new(plan.clone()).records()
    }

    /// Whether at least one of the runs could start.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        let refused = Cell::Text(SweepStatus::Refused.name().to_owned());
        let status = Columns::of(&self.plan).status;
        let mut rows = self.rows.values();
        rows.any(|cells| cells.get(status) != Some(&refused))
    }

    /// The runs whose rows state that their process ended during the run.
    #[must_use]
    pub fn crashed(&self) -> Vec<u64> {
        let crashed = Cell::Text(SweepStatus::Crashed.name().to_owned());
        let status = Columns::of(&self.plan).status;
        let rows = self.rows.iter();
        rows.filter(|(_, cells)| cells.get(status) == Some(&crashed))
            .map(|(run, _)| *run)
            .collect()
    }

    /// The runs in `runs` that have no row.
    #[must_use]
    pub fn missing(&self, runs: Runs) -> Vec<Runs> {
        let known = self
            .rows
            .range(runs.first()..=runs.last())
            .map(|(run, _)| *run);
        runs.without(&Runs::among(known))
    }
}

/// Records during their collection.
pub(super) struct RecordCollection {
    pub(super) records: Records,
    pub(super) sealed: Vec<Runs>,
    columns: Columns,
    /// The files.
    paths: Vec<PathBuf>,
    /// The file of each row.
    of: BTreeMap<u64, usize>,
}

/// Indices of columns that have a meaning here.
struct Columns {
    seconds: usize,
    status: usize,
    names: Vec<String>,
}

impl Columns {
    fn of(plan: &SweepPlan) -> Self {
        let columns = plan.columns().into_iter();
        let names: Vec<String> = columns.map(|column| column.name).collect();
        // Varied keys come first and may have any names.
        let behind = 1 + plan.keys.len();
        let place = |name: &str| {
            let own = names.iter().skip(behind);
            own.take_while(|own| *own != name).count() + behind
        };
        Self {
            seconds: place("seconds"),
            status: place("status"),
            names,
        }
    }
}

impl RecordCollection {
    pub(super) fn new(plan: SweepPlan) -> Self {
        Self {
            columns: Columns::of(&plan),
            records: Records {
                plan,
                rows: SweepRows::new(),
                repeated: 0,
                sealed: Vec::new(),
                suspects: BTreeMap::new(),
            },
            sealed: Vec::new(),
            paths: Vec::new(),
            of: BTreeMap::new(),
        }
    }

    /// Adds a row of a file. A second row of the same run must be equal to the first row, except
    /// for the run time. As another exception, one of the two rows may state that the process
    /// ended.
    pub(super) fn take(
        &mut self,
        run: u64,
        cells: Vec<Cell>,
        path: &Path,
    ) -> Result<(), JournalError> {
        if self.paths.last().is_none_or(|last| last != path) {
            self.paths.push(path.to_owned());
        }
        let file = self.paths.len() - 1;
        let Some(known) = self.records.rows.get_mut(&run) else {
            self.records.rows.insert(run, cells);
            self.of.insert(run, file);
            return Ok(());
        };
        let Columns {
            seconds,
            status,
            names,
        } = &self.columns;
        let pairs = || known.iter().zip(&cells).enumerate();
        let differs = pairs().find(|(k, (a, b))| k != seconds && !a.is_same(b));
        let Some((k, (one, other))) = differs else {
            // A copy also has the same run time.
            let is_copy = pairs().all(|(_, (a, b))| a.is_same(b));
            self.records.repeated += u64::from(!is_copy);
            return Ok(());
        };
        let crashed = Cell::Text(SweepStatus::Crashed.name().to_owned());
        self.records.repeated += 1;
        if cells.get(*status) == Some(&crashed) {
            return Ok(());
        }
        if known.get(*status) == Some(&crashed) {
            *known = cells;
            self.of.insert(run, file);
            return Ok(());
        }
        let first = self.of.get(&run).map_or(file, |file| *file);
        Err(Box::new(Difference {
            run,
            column: names.get(k).cloned().unwrap_or_default(),
            values: [one.to_string(), other.to_string()],
            paths: [self.paths[first].clone(), path.to_owned()],
        })
        .into())
    }

    /// Records that a process ended during these runs. For each run, the value of the map is true
    /// if the process made no other run at that time.
    pub(super) fn blame(&mut self, begun: BTreeMap<u64, bool>) {
        for (run, was_alone) in begun {
            *self.records.suspects.entry(run).or_default() += u64::from(was_alone);
        }
    }

    pub(super) fn records(self) -> Records {
        let Self {
            mut records,
            sealed,
            ..
        } = self;
        records
            .suspects
            .retain(|run, _| !records.rows.contains_key(run));
        records.sealed = sealed;
        records
    }
}
