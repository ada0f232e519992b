//! `tolerance.csv`: a row for each sample.

use std::io::Write;

use super::{Table, TableError};

/// Writes `tolerance.csv` with these columns and rows.
///
/// # Errors
/// - [`TableError::Write`]: the writer failed.
pub fn tolerance_table<W: Write>(
    header: &[String],
    rows: impl Iterator<Item = Vec<String>>,
    out: W,
) -> Result<W, TableError> {
    let mut table = Table::new("tolerance.csv", out, header)?;
    for row in rows {
        table.record(&row)?;
    }
    table.finish()
}
