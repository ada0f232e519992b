//! The tables of a sweep, computed from its finished shards and journals in the order of the grid.
//! The tables do not depend on which processes performed the runs.

use super::document::Extent;
use super::{Records, SweepDocument};
use crate::files::{Family, FileError, OutputDirectory};
use crate::json::write_json;
use crate::tables::{Table, TableError};

/// The tables of a sweep.
pub const FAMILY: Family = Family(&[TABLE, PARQUET, SUMMARY]);

const TABLE: &str = "sweep.csv";
const PARQUET: &str = "sweep.parquet";
const SUMMARY: &str = "summary.json";

/// The tables that this program writes.
const WRITTEN: &[&str] = if cfg!(feature = "parquet") {
    FAMILY.0
} else {
    &[TABLE, SUMMARY]
};

/// Writes `sweep.csv`, `summary.json`, and with the feature `parquet` also `sweep.parquet`. Each
/// file is written next to its final path and renamed. Several processes may write the files at the
/// same time; the last result remains.
///
/// # Errors
/// Returns an error if a file could not be written. Complete older tables are kept.
pub fn write_sweep<E: From<FileError> + From<TableError>>(
    directory: &OutputDirectory,
    records: &Records,
) -> Result<SweepDocument, E> {
    let columns = records.plan.columns();
    let names: Vec<String> = columns.iter().map(|c| c.name.clone()).collect();
    let mut table = Table::new(TABLE, directory.file(TABLE)?, &names)?;
    for cells in records.rows.values() {
        table.record(cells)?;
    }
    table.finish()?.finish()?;
    #[cfg(feature = "parquet")]
    {
        let file = directory.file(PARQUET)?;
        let rows: Vec<&[super::Cell]> = records.rows.values().map(Vec::as_slice).collect();
        super::parquet::write(file, &records.plan, &columns, &rows)?.finish()?;
    }
    let document = SweepDocument::new(records, Extent::Whole);
    let mut text = Vec::new();
    write_json(&mut text, &document).map_err(|source| TableError::Write {
        table: SUMMARY,
        source,
    })?;
    directory.write(SUMMARY, &text)?;
    directory.keep(FAMILY, WRITTEN)?;
    Ok(document)
}
