//! Sinks that write the rows of a run to tables.
//!
//! The verdict of a stretch is known only at the end of the stretch. Therefore a run first writes
//! all numbers of one choice, and `reactions.csv` is a copy of this table without the numbers that
//! are not determined. If a cell of the copy is empty, the first table is stored as `choice.csv`.
//! In tables of other choices, numbers that the model determines are replaced by the numbers of the
//! run.

use std::fs::File;
use std::io::{BufReader, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;

use crate::documents::Ending;
use crate::documents::{Gap, choice_file};
use dynamics::{MotionFault, Plan, Sample};
use model::words::SceneUnits;
use model::{Mechanism, System};
use report::{
    FileError, MoreColumns, OutputDirectory, OutputFile, ReactionColumn, ReactionTable, Selection,
    TableError, TrajectoryTable, write_chosen, write_determined,
};
use scene::{Output, OutputUnits, Scene, WantedReactions};
use solvability::{ChoiceError, ChosenValues, GroupNumbers, Stretches};

use crate::error::StudyError;
use crate::peaks_of_run::{FoundPeaks, PeaksOfRun};
use crate::rows::{RowFault, RowSink};

/// Selects the rows of a run that belong to its tables. An animation may need more rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TableRows {
    /// The rows of the tables are the rows whose index is a multiple of this number, and the last
    /// row.
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

    /// Whether the next row, at time t, belongs to the tables.
    pub(crate) fn take(&mut self, t: f64) -> bool {
        let is_one = self.seen.is_multiple_of(self.between) || t >= self.t_end;
        self.seen += 1;
        is_one
    }
}

/// Returns the units of the tables of a run. Returns `None` for SI units.
pub(crate) fn table_units(scene: &Scene) -> Option<SceneUnits> {
    match scene.output.units {
        OutputUnits::Si => None,
        OutputUnits::Scene => Some(scene.units.printed()),
    }
}

/// Returns the columns of the trajectory that the output requests.
#[must_use]
pub fn more_columns(output: &Output) -> MoreColumns {
    MoreColumns {
        accelerations: output.accelerations,
        angles: output.rpy,
    }
}

/// Returns the reactions in a table. Returns `None` if no table is requested.
pub(crate) fn selection(wanted: &WantedReactions) -> Option<Selection> {
    match wanted {
        WantedReactions::All => Some(Selection::All),
        WantedReactions::Of(names) => Some(Selection::Names(names.clone())),
        WantedReactions::None => None,
    }
}

/// Gives a file its final name. The run may have ended early.
pub(crate) fn finished(file: OutputFile, ending: &Ending<'_>) -> Result<PathBuf, FileError> {
    match ending {
        Ending::Complete => file.finish(),
        Ending::Interrupted | Ending::Stopped(_) => file.finish_partial(),
    }
}

/// Writer of `trajectory.csv`.
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
            let a = acceleration(table, sample)?;
            table.row(sample.t, (sample.q, sample.v), a.as_deref())?;
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

/// Returns the accelerations of a row, if the table contains them.
pub(crate) fn acceleration<W: Write>(
    table: &TrajectoryTable<'_, W>,
    sample: &mut Sample<'_, '_>,
) -> Result<Option<Vec<f64>>, MotionFault> {
    let has_accelerations = table.has_accelerations();
    has_accelerations.then(|| sample.acceleration()).transpose()
}

/// Writer of `reactions.csv`. If a cell of this table is empty, tables of choices are also written.
/// Before the end of the run, all values belong to one choice. The values for the independent rows
/// of the run are in `choice.csv`. If other choices are requested, these values are in a file that
/// is removed at the end.
pub(crate) struct ReactionFiles<'m> {
    directory: &'m OutputDirectory,
    mechanism: &'m Mechanism,
    table: Option<ReactionTable<OutputFile>>,
    /// The values for each requested choice, with the rows at which the choice selects no solution.
    chosen: Vec<(ReactionTable<OutputFile>, Option<Gap>)>,
    /// Whether every number is determined at all times.
    is_plain: bool,
    rows: TableRows,
    numbers: GroupNumbers<'m>,
    peaks: PeaksOfRun,
    columns: Vec<ReactionColumn>,
    /// The peaks, available after the end.
    pub(crate) found: FoundPeaks,
    /// The tables of choices, available after the end. The list is empty if no cell is empty.
    pub(crate) choice_files: Vec<String>,
    /// The rows at which each choice selects no solution, available after the end.
    pub(crate) gaps: Vec<Option<Gap>>,
}

/// File name of the table of all values of one choice.
const CHOICE: &str = "choice.csv";
const REACTIONS: &str = "reactions.csv";

/// File name of the values on the independent rows of the run, if other choices are requested.
const KEPT_ROWS: &str = "choice_0.csv";

impl<'m> ReactionFiles<'m> {
    /// Creates the files. `is_plain` states whether no row is redundant.
    pub(crate) fn begin(
        directory: &'m OutputDirectory,
        (mechanism, q): (&'m Mechanism, &[f64]),
        (columns, units): (Vec<ReactionColumn>, Option<SceneUnits>),
        plan: &Plan<'_>,
        rows: TableRows,
        is_plain: bool,
    ) -> Result<Self, StudyError> {
        let table = |name, file| ReactionTable::new(name, file, mechanism, columns.clone(), units);
        let choices = if is_plain { 0 } else { plan.choices.len() };
        let own = match (is_plain, choices) {
            (true, _) => table(REACTIONS, directory.file(REACTIONS)?)?,
            (false, 0) => table(CHOICE, directory.file(CHOICE)?)?,
            (false, _) => table(REACTIONS, directory.scratch(KEPT_ROWS)?)?,
        };
        let chosen = (0..choices).map(|k| {
            let file = directory.file(choice_file(k))?;
            Ok::<_, StudyError>((table(CHOICE, file)?, None))
        });
        Ok(Self {
            directory,
            mechanism,
            table: Some(own),
            chosen: chosen.collect::<Result<_, _>>()?,
            is_plain,
            rows,
            numbers: GroupNumbers::new(mechanism, q, &plan.groups),
            peaks: PeaksOfRun::new(mechanism, columns.clone()),
            columns,
            found: FoundPeaks::default(),
            choice_files: Vec::new(),
            gaps: Vec::new(),
        })
    }

    /// Writes `reactions.csv` from all values of the run. If a cell is empty, also writes the
    /// tables of the requested choices from their values.
    fn end_of_choices(
        &mut self,
        mut all: OutputFile,
        stretches: &Stretches,
        ending: &Ending<'_>,
    ) -> Result<(), StudyError> {
        let mut out = self.directory.file(REACTIONS)?;
        let (columns, read) = (&self.columns, BufReader::new);
        let write = |source| TableError::Write {
            table: CHOICE,
            source,
        };
        let has_choice = write_determined(read(all.written()?), &mut out, columns, stretches)?;
        finished(out, ending)?;
        for (k, (table, gap)) in std::mem::take(&mut self.chosen).into_iter().enumerate() {
            let (file, _) = table.finish()?;
            if !has_choice {
                continue;
            }
            // For determined numbers, the values of a choice differ from the values of the run only
            // by rounding.
            let own = File::open(finished(file, ending)?).map_err(write)?;
            let name = choice_file(k);
            let mut out = self.directory.file(&name)?;
            write_chosen(
                read(all.written()?),
                read(own),
                &mut out,
                columns,
                stretches,
            )?;
            finished(out, ending)?;
            self.choice_files.push(name);
            self.gaps.push(gap);
        }
        Ok(())
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
        self.peaks.row(sample.t, values, reactions.as_chosen());
        if self.chosen.is_empty() {
            return Ok(ControlFlow::Continue(()));
        }
        for ((table, gap), found) in self.chosen.iter_mut().zip(sample.chosen()?) {
            let groups = numbers_of(&mut self.numbers, sample, &found.multipliers)?;
            table.row(sample.t, &found.reactions, &groups)?;
            note_gap(gap, sample.t, found.refused.as_ref());
        }
        Ok(ControlFlow::Continue(()))
    }

    fn end(&mut self, verdicts: Option<&Stretches>, ending: &Ending<'_>) -> Result<(), StudyError> {
        let Some(table) = self.table.take() else {
            return Ok(());
        };
        let nothing;
        let stretches = if let Some(verdicts) = verdicts {
            verdicts
        } else {
            // No joint or drive is written, so every cell is determined.
            nothing = Stretches::unique(
                self.mechanism,
                [self.mechanism.layout().start_time; 2],
                self.numbers.groups(),
            );
            &nothing
        };
        self.found = self.peaks.finish(stretches);
        let (file, columns) = table.finish()?;
        if !self.chosen.is_empty() {
            return self.end_of_choices(file, stretches, ending);
        }
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
        let has_choice = write_determined(all, &mut out, &columns, stretches)?;
        finished(out, ending)?;
        // Without a choice, the list of kept files does not contain this file.
        if has_choice {
            self.choice_files.push(CHOICE.to_owned());
        }
        Ok(())
    }
}

/// Counts a row at which a choice selects no solution.
pub(crate) fn note_gap(gap: &mut Option<Gap>, t: f64, refused: Option<&ChoiceError>) {
    if let Some(error) = refused {
        let first = || Gap::at(t, error.to_string());
        gap.get_or_insert_with(first).rows += 1;
    }
}

/// Returns the values of groups at a row.
pub(crate) fn group_numbers(
    numbers: &mut GroupNumbers<'_>,
    sample: &mut Sample<'_, '_>,
) -> Result<ChosenValues<f64>, RowFault> {
    if numbers.groups().is_empty() {
        return Ok(ChosenValues::new(Vec::new(), sample.dropped.to_vec()));
    }
    let multipliers = sample.multipliers()?;
    numbers_of(numbers, sample, &multipliers)
}

/// Returns the values of groups at a row for these multipliers.
pub(crate) fn numbers_of(
    numbers: &mut GroupNumbers<'_>,
    sample: &Sample<'_, '_>,
    multipliers: &ChosenValues<f64>,
) -> Result<ChosenValues<f64>, RowFault> {
    let found = numbers.at(sample.t, sample.q, multipliers);
    // Groups were analysed before the run began; the remaining error is a value that is not finite.
    found.map_err(|e| {
        RowFault::Table(TableError::Write {
            table: REACTIONS,
            source: std::io::Error::other(e),
        })
    })
}
