//! Writes `stress.csv` row by row as the cases end.

use std::io::Write;

use super::document::StressRow;
use report::tables::{Table, TableError};

/// Columns of the table; future versions may add columns after them.
const HEADER: [&str; 12] = [
    "family",
    "case",
    "varied",
    "value",
    "method",
    "formulation",
    "expected",
    "bound",
    "error",
    "judgement",
    "outcome",
    "seconds",
];

/// Writes one line per case. Each line is passed to the writer immediately, so that no line is lost
/// if the program is interrupted.
pub struct StressTable<W: Write> {
    table: Table<W>,
}

impl<W: Write> StressTable<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(out: W) -> Result<Self, TableError> {
        let mut table = Table::new("stress.csv", out, &HEADER.map(str::to_owned))?;
        table.flush()?;
        Ok(Self { table })
    }

    /// Writes a case. A missing number is written as `NaN`; other missing values are empty.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, row: &StressRow) -> Result<(), TableError> {
        let (varied, value) = row.varied.unwrap_or(("", f64::NAN));
        self.table.record((
            (row.family, &row.case, varied, value),
            (&row.method, &row.formulation),
            (&row.expected, row.bound),
            (row.error, row.judgement.words(), &row.outcome),
            row.seconds,
        ))?;
        self.table.flush()
    }

    /// Returns the writer.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn finish(self) -> Result<W, TableError> {
        self.table.finish()
    }
}
