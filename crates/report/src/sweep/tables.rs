//! The tables of a sweep, computed from its journals in the order of the grid, whichever processes
//! made the runs.

use std::fs::File;

use super::{Journals, SweepDocument};
use crate::documents::write_json;
use crate::files::{FileError, OutputDirectory};
use crate::tables::{Table, TableError};

/// Lock file held while tables are written, by one process at a time.
const LOCK: &str = "tables.lock";

/// The tables of a sweep.
pub const FILES: [&str; 3] = ["sweep.csv", "sweep.parquet", "summary.json"];

/// Writes `sweep.csv`, `sweep.parquet` if this is compiled in, and `summary.json`. `read` is called
/// to read the journals when no other process is writing tables: if several shards end at the same
/// time, the last one has all rows.
///
/// # Errors
/// Errors of `read`, and if something could not be written; complete older tables are kept.
pub fn write_sweep<E: From<FileError> + From<TableError>>(
    directory: &OutputDirectory,
    read: impl FnOnce() -> Result<Journals, E>,
) -> Result<SweepDocument, E> {
    let path = directory.path().join(LOCK);
    let lock = File::create(&path).map_err(FileError::refused("make", &path))?;
    lock.lock().map_err(FileError::refused("lock", &path))?;
    let Journals { plan, rows } = read()?;
    let columns = plan.columns();
    let names: Vec<String> = columns.iter().map(|c| c.name.clone()).collect();
    let mut table = Table::new("sweep.csv", directory.file("sweep.csv")?, &names)?;
    for cells in rows.values() {
        table.record(cells)?;
    }
    table.finish()?.finish()?;
    #[cfg(feature = "parquet")]
    {
        let file = directory.file("sweep.parquet")?;
        super::parquet::write(file, &plan, &columns, &rows)?.finish()?;
    }
    let document = SweepDocument::new(&plan, &columns, &rows);
    let mut text = Vec::new();
    write_json(&mut text, &document).map_err(|source| TableError::Write {
        table: "summary.json",
        source,
    })?;
    directory.write("summary.json", &text)?;
    Ok(document)
}
