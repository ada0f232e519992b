//! `work_precision.csv`, written row by row when a run ends.

use std::io::Write;

use super::WorkPrecisionRow;
use crate::tables::{Table, TableError};

/// The columns; further columns may be added after `status`.
const HEADER: [&str; 21] = [
    "scene",
    "formulation",
    "method",
    "stabilisation",
    "tolerance",
    "error_position",
    "error_velocity",
    "error_acceleration",
    "error_reaction",
    "constraint_residual",
    "evaluations",
    "projections",
    "factorisations",
    "steps",
    "seconds",
    "status",
    "rejected",
    "repetitions",
    "energy_error",
    "error_state",
    "reference_limit",
];

/// The table has one line for each run. Each line is passed to the writer immediately, so an
/// interruption loses no finished run.
pub struct WorkPrecisionTable<W: Write> {
    table: Table<W>,
}

impl<W: Write> WorkPrecisionTable<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(out: W) -> Result<Self, TableError> {
        let header = HEADER.map(str::to_owned);
        let mut table = Self {
            table: Table::new("work_precision.csv", out, &header)?,
        };
        table.table.flush()?;
        Ok(table)
    }

    /// Writes a run. Unknown values are `NaN`.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, row: &WorkPrecisionRow) -> Result<(), TableError> {
        let curve = &row.curve;
        self.table.record((
            (
                &row.scene,
                curve.formulation,
                curve.method,
                curve.stabilisation,
            ),
            row.tolerance,
            row.errors,
            row.constraint_residual,
            [
                row.evaluations,
                row.projections,
                row.factorisations,
                row.steps,
            ],
            row.seconds,
            &row.status,
            (row.rejected, row.repetitions),
            [row.energy_error, row.error_state, row.reference_limit],
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
