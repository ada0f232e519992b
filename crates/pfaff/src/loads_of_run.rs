//! Loads of force elements during a run: `loads.csv`, and the extreme values over the run.

use std::ops::ControlFlow;

use dynamics::Sample;
use model::space::norm;
use model::words::SceneUnits;
use model::{Load, Loads, Mechanism, SpaceKind, System};
use report::{LoadTable, OutputDirectory, OutputFile, load_columns, load_numbers};
use solvability::Stretches;

use crate::documents::{
    Ending, ExtremeDocument, LoadOfRunDocument, MagnitudeOfRunDocument, RangeOfRunDocument,
};
use crate::error::StudyError;
use crate::rows::{RowFault, RowSink};
use crate::tables_of_run::{TableRows, finished};
use report::ByName;

/// File name of the table.
pub(crate) const LOADS: &str = "loads.csv";

/// Writer of `loads.csv`.
pub(crate) struct LoadsOfRun<'m> {
    mechanism: &'m Mechanism,
    loads: Loads<'m>,
    table: Option<LoadTable<OutputFile>>,
    rows: TableRows,
    found: Vec<FoundLoad>,
}

/// The extreme values of a load.
#[derive(Clone, Default)]
struct FoundLoad {
    columns: Vec<Option<RangeOfRunDocument>>,
    force: Option<ExtremeDocument>,
    moment: Option<ExtremeDocument>,
}

impl<'m> LoadsOfRun<'m> {
    /// Creates a sink. Returns `None` if the mechanism has no force elements. With a directory, the
    /// sink writes the table in these units.
    pub(crate) fn begin(
        directory: Option<(&OutputDirectory, Option<SceneUnits>)>,
        mechanism: &'m Mechanism,
        rows: TableRows,
    ) -> Result<Option<Self>, StudyError> {
        if mechanism.applied_forces().is_empty() {
            return Ok(None);
        }
        let loads = mechanism.loads();
        let table = match directory {
            None => None,
            Some((directory, units)) => {
                let file = directory.file(LOADS)?;
                Some(LoadTable::new(file, mechanism.space(), &loads, units)?)
            }
        };
        Ok(Some(Self {
            mechanism,
            table,
            rows,
            found: vec![FoundLoad::default(); loads.forces().count()],
            loads,
        }))
    }

    /// Returns the loads at a row, and updates the extreme values with these loads.
    pub(crate) fn see(&mut self, sample: &Sample<'_, '_>) -> Vec<Load> {
        let t = self.mechanism.layout().before_break(sample.t);
        let loads = self.loads.at(t, sample.q, sample.v);
        for (found, load) in self.found.iter_mut().zip(&loads) {
            found.note(sample.t, self.mechanism.space(), load);
        }
        loads
    }

    fn documents(&self) -> ByName<LoadOfRunDocument> {
        let space = self.mechanism.space();
        let each = self.loads.forces().zip(&self.found);
        let each = each.map(|((name, measure), found)| {
            let columns = load_columns(space, name, measure).zip(&found.columns);
            let components =
                columns.filter_map(|(column, range)| Some((column.number.to_owned(), (*range)?)));
            let document = LoadOfRunDocument {
                peak: MagnitudeOfRunDocument::new(found.force, found.moment),
                components: ByName(components.collect()),
            };
            (name.to_owned(), document)
        });
        ByName(each.collect())
    }
}

/// Returns the extreme values of each force element.
pub(crate) fn documents(loads: Option<&LoadsOfRun<'_>>) -> ByName<LoadOfRunDocument> {
    loads.map_or_else(|| ByName(Vec::new()), LoadsOfRun::documents)
}

impl FoundLoad {
    fn note(&mut self, t: f64, space: SpaceKind, load: &Load) {
        let numbers = load_numbers(space, load).enumerate();
        for (k, number) in numbers {
            if self.columns.len() == k {
                self.columns.push(None);
            }
            if !number.is_nan() {
                let at = RangeOfRunDocument::at(t, [number; 2]);
                self.columns[k].get_or_insert(at).include(at);
            }
        }
        let sizes = [load.wrench.force, load.wrench.torque].map(|part| norm(&part));
        for (own, size) in [&mut self.force, &mut self.moment].into_iter().zip(sizes) {
            if own.map_or(size > 0.0, |own| size > own.value) {
                *own = Some(ExtremeDocument::new(size, t));
            }
        }
    }
}

impl RowSink for LoadsOfRun<'_> {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        if !self.rows.take(sample.t) {
            return Ok(ControlFlow::Continue(()));
        }
        let loads = self.see(sample);
        if let Some(table) = &mut self.table {
            table.row(sample.t, &loads)?;
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
