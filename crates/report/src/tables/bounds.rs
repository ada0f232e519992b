//! `bounds.csv`: the smallest and the largest value of each reaction that the model does not
//! determine. It is not known until the end of the run which reactions are determined, so a run
//! first writes the bounds of all columns.

use std::io::{self, BufRead, Write};

use solvability::{Stretches, VerdictTrack};

use super::{ReactionColumn, Table, TableError};
use model::words::SceneUnits;

/// Name of the table.
const NAME: &str = "bounds.csv";

/// `t`, then for each column of reactions `<name>.lowest` and `<name>.highest` (s, N, N·m).
pub struct BoundsTable<W: Write> {
    table: Table<W>,
    /// Buffer for one row, reused.
    values: Vec<f64>,
}

impl<W: Write> BoundsTable<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(
        out: W,
        columns: &[ReactionColumn],
        units: Option<SceneUnits>,
    ) -> Result<Self, TableError> {
        let columns = columns.iter().flat_map(|column| {
            let name = column.name();
            ["lowest", "highest"].map(|end| (format!("{name}.{end}"), column.column.unit))
        });
        Ok(Self {
            table: Table::over_time(NAME, out, columns, units)?,
            values: Vec::new(),
        })
    }

    /// Writes the bounds of all columns at time t. NaN becomes an empty cell.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, t: f64, bounds: &[[f64; 2]]) -> Result<(), TableError> {
        self.values.clear();
        self.values.push(t);
        self.values.extend(bounds.iter().flatten());
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

/// Copies the bounds of each column that is not determined on at least one interval. On intervals
/// on which the column is determined, the cells are empty.
///
/// # Errors
/// [`TableError::Write`]: reading or writing failed.
pub fn write_open_bounds(
    all: impl BufRead,
    out: impl Write,
    columns: &[ReactionColumn],
    stretches: &Stretches,
) -> Result<(), TableError> {
    let open = columns.iter().map(|column| column.quantity.open(stretches));
    copy(all, out, &open.collect::<Vec<_>>()).map_err(|source| TableError::Write {
        table: NAME,
        source,
    })
}

fn copy(all: impl BufRead, out: impl Write, open: &[Option<&VerdictTrack>]) -> io::Result<()> {
    let mut out = io::BufWriter::new(out);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(all);
    let mut writer = csv::Writer::from_writer(&mut out);
    for (line, record) in reader.records().enumerate() {
        let record = record?;
        let time = record.get(0).unwrap_or_default();
        let t: f64 = time.parse().unwrap_or(f64::NAN);
        writer.write_field(time)?;
        for (k, track) in open.iter().enumerate() {
            let Some(track) = track else { continue };
            let is_written = line == 0 || !track.at(t).is_unique();
            for place in [2 * k + 1, 2 * k + 2] {
                let cell = record.get(place).filter(|_| is_written);
                writer.write_field(cell.unwrap_or_default())?;
            }
        }
        writer.write_record(None::<&[u8]>)?;
    }
    writer.flush()?;
    drop(writer);
    out.flush()
}
