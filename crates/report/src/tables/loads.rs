//! `loads.csv`: the force and torque of each force element on its first body, and the measure of
//! the element.

use std::io::Write;

use model::{ForceMeasure, Load, Loads, SpaceKind};

use super::{Column, Table, TableError};
use model::words::SceneUnits;

/// Name of the table.
const NAME: &str = "loads.csv";

/// Returns the columns of a force element: the components of the wrench, then the measure and the
/// rate of the measure.
pub fn load_columns(
    space: SpaceKind,
    name: &str,
    measure: Option<ForceMeasure>,
) -> impl Iterator<Item = Column> {
    let components = space.components().iter();
    let components = components.map(move |own| (*own, space.load_unit(own).unwrap_or_default()));
    let measured = measure.map(|of| of.names().into_iter().zip(of.units()));
    let owner = name.to_owned();
    let column = move |(number, unit)| Column {
        owner: owner.clone(),
        kind: "force",
        number,
        unit,
    };
    let all = components.chain(measured.into_iter().flatten());
    all.map(column)
}

/// The values of a load in the order of [`load_columns`].
pub fn load_numbers(space: SpaceKind, load: &Load) -> impl Iterator<Item = f64> {
    let components = load.wrench.components(space);
    components.chain(load.measure.into_iter().flatten())
}

/// `t`, then for each force element `<name>.Fx, .Fy, .T`, in space
/// `.Fx, .Fy, .Fz, .Tx, .Ty, .Tz` (s, N, N·m), and, for an element with a measure, `.length` (m) or
/// `.angle` (rad), and `.rate` (m/s or rad/s).
pub struct LoadTable<W: Write> {
    table: Table<W>,
    space: SpaceKind,
    /// Buffer for one row, reused.
    values: Vec<f64>,
}

impl<W: Write> LoadTable<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(
        out: W,
        space: SpaceKind,
        loads: &Loads<'_>,
        units: Option<SceneUnits>,
    ) -> Result<Self, TableError> {
        let all = loads.forces();
        let columns = all.flat_map(|(name, measure)| load_columns(space, name, measure));
        let columns = columns.map(|column| (column.to_string(), column.unit));
        Ok(Self {
            table: Table::over_time(NAME, out, columns, units)?,
            space,
            values: Vec::new(),
        })
    }

    /// Writes the loads at time t. A number that does not exist is an empty cell.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, t: f64, loads: &[Load]) -> Result<(), TableError> {
        self.values.clear();
        self.values.push(t);
        let numbers = loads.iter().flat_map(|load| load_numbers(self.space, load));
        self.values.extend(numbers);
        self.table.row_with_gaps(&self.values)
    }

    /// Writes the buffer and returns the writer.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn finish(self) -> Result<W, TableError> {
        self.table.finish()
    }
}
