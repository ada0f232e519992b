//! The tables of a run as sinks of its rows.

use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::PathBuf;

use dynamics::Sample;
use model::{Mechanism, System};
use report::{
    Ending, FileError, OutputDirectory, OutputFile, Peak, PeakRecorder, ReactionColumn,
    ReactionTable, TableError, TrajectoryTable, write_determined,
};
use solvability::{Chosen, Group, GroupNumbers, Stretches};

use crate::error::StudyError;
use crate::rows::{RowFault, RowSink};

/// Which rows of a run are those of its tables: an animation may need more of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TableRows {
    /// One in this many, and the last.
    between: usize,
    t_end: f64,
    seen: usize,
}

impl TableRows {
    pub(crate) fn new(between: usize, t_end: f64) -> Self {
        Self {
            between,
            t_end,
            seen: 0,
        }
    }

    /// Whether the next row, at time t, is one.
    pub(crate) fn take(&mut self, t: f64) -> bool {
        let is_one = self.seen.is_multiple_of(self.between) || t >= self.t_end;
        self.seen += 1;
        is_one
    }
}

/// Gives a file its final name; it may end early.
fn finished(file: OutputFile, ending: &Ending<'_>) -> Result<PathBuf, FileError> {
    match ending {
        Ending::Complete => file.finish(),
        Ending::Interrupted | Ending::Stopped(_) => file.finish_partial(),
    }
}

/// `trajectory.csv`.
pub(crate) struct TrajectoryFile<'m> {
    table: Option<TrajectoryTable<'m, OutputFile>>,
    rows: TableRows,
}

impl<'m> TrajectoryFile<'m> {
    pub(crate) fn new(table: TrajectoryTable<'m, OutputFile>, rows: TableRows) -> Self {
        Self {
            table: Some(table),
            rows,
        }
    }
}

impl RowSink for TrajectoryFile<'_> {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        if self.rows.take(sample.t)
            && let Some(table) = &mut self.table
        {
            table.row(sample.t, sample.q, sample.v)?;
        }
        Ok(ControlFlow::Continue(()))
    }

    fn end(&mut self, _: Option<&Stretches>, ending: &Ending<'_>) -> Result<(), StudyError> {
        if let Some(table) = self.table.take() {
            finished(table.finish()?, ending)?;
        }
        Ok(())
    }
}

/// `reactions.csv`, and `choice.csv` where a cell of it is empty: until the run has ended, all
/// numbers are those of one choice.
pub(crate) struct ReactionFiles<'m> {
    directory: &'m OutputDirectory,
    table: Option<ReactionTable<OutputFile>>,
    /// Whether every number is determined, whatever comes.
    is_plain: bool,
    rows: TableRows,
    numbers: GroupNumbers<'m>,
    peaks: PeakRecorder,
    columns: Vec<ReactionColumn>,
    /// The peaks of the columns, after the end.
    found: Vec<Option<Peak>>,
    /// Whether a cell is empty, after the end.
    pub(crate) has_choice: bool,
}

/// The table of all numbers of one choice.
const CHOICE: &str = "choice.csv";
const REACTIONS: &str = "reactions.csv";

impl<'m> ReactionFiles<'m> {
    /// Begins the files. `is_plain` states whether no row is dropped.
    pub(crate) fn begin(
        directory: &'m OutputDirectory,
        (mechanism, q): (&'m Mechanism, &[f64]),
        columns: Vec<ReactionColumn>,
        groups: &[Group],
        rows: TableRows,
        is_plain: bool,
    ) -> Result<Self, StudyError> {
        let name = if is_plain { REACTIONS } else { CHOICE };
        let file = directory.file(name)?;
        let cuts = &mechanism.layout().break_times;
        Ok(Self {
            directory,
            table: Some(ReactionTable::new(name, file, mechanism, columns.clone())?),
            is_plain,
            rows,
            numbers: GroupNumbers::new(mechanism, q, groups),
            peaks: PeakRecorder::new(columns.len(), cuts),
            columns,
            found: Vec::new(),
            has_choice: false,
        })
    }

    /// The columns of the tables and their peaks, after the end.
    pub(crate) fn peaks(&self) -> (&[ReactionColumn], &[Option<Peak>]) {
        (&self.columns, &self.found)
    }
}

impl RowSink for ReactionFiles<'_> {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        let cuts = sample.events.iter().filter(|event| event.kind.cuts());
        cuts.for_each(|event| self.peaks.cut(event.time));
        if !self.rows.take(sample.t) {
            return Ok(ControlFlow::Continue(()));
        }
        let Some(table) = &mut self.table else {
            return Ok(ControlFlow::Continue(()));
        };
        let reactions = sample.reactions()?;
        let groups = group_numbers(&mut self.numbers, sample)?;
        let values = table.row(sample.t, &reactions, &groups)?;
        self.peaks.row(sample.t, values);
        Ok(ControlFlow::Continue(()))
    }

    fn end(&mut self, verdicts: Option<&Stretches>, ending: &Ending<'_>) -> Result<(), StudyError> {
        let (Some(table), Some(stretches)) = (self.table.take(), verdicts) else {
            return Ok(());
        };
        self.found = self.peaks.finish(&self.columns, stretches);
        let (file, columns) = table.finish()?;
        let path = finished(file, ending)?;
        if self.is_plain {
            return Ok(());
        }
        let write = |source| TableError::Write {
            table: REACTIONS,
            source,
        };
        let all = BufReader::new(File::open(path).map_err(write)?);
        let mut out = self.directory.file(REACTIONS)?;
        self.has_choice = write_determined(all, &mut out, &columns, stretches)?;
        finished(out, ending)?;
        if !self.has_choice {
            self.directory.remove_stale(&[CHOICE])?;
        }
        Ok(())
    }
}

/// The numbers of groups at a row.
pub(crate) fn group_numbers(
    numbers: &mut GroupNumbers<'_>,
    sample: &mut Sample<'_, '_>,
) -> Result<Chosen<f64>, RowFault> {
    if numbers.groups().is_empty() {
        return Ok(Chosen::new(Vec::new(), sample.dropped.to_vec()));
    }
    let multipliers = sample.multipliers()?;
    let found = numbers.at(sample.t, sample.q, &multipliers);
    // Groups were judged before the run began; what is left is a number that is not finite.
    found.map_err(|e| {
        RowFault::Table(TableError::Write {
            table: REACTIONS,
            source: std::io::Error::other(e),
        })
    })
}
