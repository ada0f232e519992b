//! Tables of a run as CSV: one header, then one line per instant. Each line is written when its
//! values have been computed. A number is written as the shortest text that is read as the same
//! bits. A value that does not exist is `NaN`.
//!
//! The caller chooses the times and the destination of rows.

mod bounds;
mod loads;
mod reactions;
#[cfg(test)]
mod tests;
mod trajectory;

use std::io::{self, BufWriter, Write};
use std::iter;

use model::codes::Code;
use serde::Serialize;

use model::words::SceneUnits;

pub use bounds::{BoundsTable, write_open_bounds};
pub use loads::{LoadTable, load_columns, load_numbers};
pub use reactions::{
    Quantity, ReactionColumn, ReactionTable, Selection, columns_of_reactions, numbers_of_columns,
    reaction_columns, reaction_component, write_chosen, write_determined,
};
pub use trajectory::{Column, MoreColumns, Trajectory, TrajectoryTable};

/// Reason why a table or a row cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// The underlying writer failed.
    #[error("{table}: {source}")]
    Write {
        /// Name of the table.
        table: &'static str,
        /// The error of the writer.
        source: std::io::Error,
    },
    /// The row belongs to another mechanism.
    #[error("{table}: {found} {what} at t = {t} s, the mechanism has {expected}")]
    Length {
        /// Name of the table.
        table: &'static str,
        /// "coordinates", "velocities" or "reactions".
        what: &'static str,
        /// Time of the row (s).
        t: f64,
        /// Number of values given.
        found: usize,
        /// Number of values of the table.
        expected: usize,
    },
    /// No joint or drive has this name.
    #[error("no joint or drive is called `{name}`; there are: {known}")]
    UnknownReaction {
        /// The unknown name.
        name: String,
        /// All existing names.
        known: String,
    },
}

impl TableError {
    /// Error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Write { .. } | Self::Length { .. } => const { Code::new(6) },
            Self::UnknownReaction { .. } => const { Code::new(404) },
        }
    }
}

/// Writes a matrix as CSV: a header with the name of the matrix and the names of its columns, then
/// each row after its name.
///
/// # Errors
/// - [`TableError::Write`]: the writer failed.
pub fn matrix_table<'m>(
    name: &'static str,
    columns: &[String],
    rows: impl IntoIterator<Item = (&'m String, &'m [f64])>,
) -> Result<Vec<u8>, TableError> {
    let header = iter::once(name).chain(columns.iter().map(String::as_str));
    let header: Vec<String> = header.map(str::to_owned).collect();
    let mut table = Table::new(name, Vec::new(), &header)?;
    for (label, row) in rows {
        let numbers = row.iter().map(f64::to_string);
        table.record(iter::once(label.clone()).chain(numbers).collect::<Vec<_>>())?;
    }
    table.finish()
}

/// A CSV writer with a fixed number of columns.
pub struct Table<W: Write> {
    name: &'static str,
    out: BufWriter<W>,
    /// The units of the columns, each as a value in SI units. The list is empty for SI units.
    units: Vec<f64>,
    /// Buffer for one line, reused.
    line: Vec<u8>,
}

impl<W: Write> Table<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(name: &'static str, out: W, header: &[String]) -> Result<Self, TableError> {
        let mut table = Self {
            name,
            out: BufWriter::new(out),
            units: Vec::new(),
            line: Vec::new(),
        };
        table.record(header)?;
        Ok(table)
    }

    /// Writes the header of a table over time: `t`, then these names with their SI units. If a
    /// scene chooses other units, the numbers are in these units, and the header contains the
    /// units, as in `crank.x (mm)`.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn over_time(
        name: &'static str,
        out: W,
        columns: impl IntoIterator<Item = (String, &'static str)>,
        units: Option<SceneUnits>,
    ) -> Result<Self, TableError> {
        let columns = iter::once(("t".to_owned(), "s")).chain(columns);
        let Some(chosen) = units else {
            let names: Vec<String> = columns.map(|(name, _)| name).collect();
            return Self::new(name, out, &names);
        };
        let in_unit = |(name, si): (String, &str)| {
            let (unit, value) = chosen.unit(si).unwrap_or_else(|| (si.to_owned(), 1.0));
            let name = match si {
                "" => name,
                _ => format!("{name} ({unit})"),
            };
            (name, value)
        };
        let (names, values): (Vec<String>, Vec<f64>) = columns.map(in_unit).unzip();
        Ok(Self {
            units: values,
            ..Self::new(name, out, &names)?
        })
    }

    /// Writes a row of numbers. Numbers need no quotes.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, values: &[f64]) -> Result<(), TableError> {
        self.numbers(values, |_| true)
    }

    /// Writes a row of numbers. A number that does not exist is an empty cell.
    fn row_with_gaps(&mut self, values: &[f64]) -> Result<(), TableError> {
        self.numbers(values, |value| !value.is_nan())
    }

    fn numbers(
        &mut self,
        values: &[f64],
        is_written: impl Fn(f64) -> bool,
    ) -> Result<(), TableError> {
        self.line.clear();
        let mut text = zmij::Buffer::new();
        for (k, &value) in values.iter().enumerate() {
            if is_written(value) {
                let value = value / self.units.get(k).copied().unwrap_or(1.0);
                self.line.extend_from_slice(text.format(value).as_bytes());
            }
            self.line.push(b',');
        }
        if let Some(last) = self.line.last_mut() {
            *last = b'\n';
        }
        let written = self.out.write_all(&self.line);
        self.checked(written)
    }

    /// Writes a row of plain values of any type.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn record(&mut self, values: impl Serialize) -> Result<(), TableError> {
        let mut csv = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(Vec::new());
        let written = csv.serialize(values).map_err(io::Error::other);
        let line = written.and_then(|()| csv.into_inner().map_err(|e| e.into_error()));
        let written = line.and_then(|line| self.out.write_all(&line));
        self.checked(written)
    }

    /// Writes the buffer to the writer.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn flush(&mut self) -> Result<(), TableError> {
        let written = self.out.flush();
        self.checked(written)
    }

    /// Returns the writer after all content is written.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn finish(self) -> Result<W, TableError> {
        let table = self.name;
        self.out.into_inner().map_err(|e| TableError::Write {
            table,
            source: e.into_error(),
        })
    }

    /// Errors are returned unchanged, so that callers can distinguish a closed pipe from a full
    /// disk.
    fn checked(&self, written: io::Result<()>) -> Result<(), TableError> {
        written.map_err(|source| TableError::Write {
            table: self.name,
            source,
        })
    }

    fn check_length(
        &self,
        t: f64,
        what: &'static str,
        found: usize,
        expected: usize,
    ) -> Result<(), TableError> {
        if found == expected {
            return Ok(());
        }
        Err(TableError::Length {
            table: self.name,
            what,
            t,
            found,
            expected,
        })
    }
}
