//! The records of all runs of a sweep whose shards are in several directories.

use std::path::{Path, PathBuf};

use super::error::same;
use super::records::RecordCollection;
use super::{JournalError, Records, Shards};

impl Records {
    /// Collects the records of all runs of a sweep in several directories.
    ///
    /// # Errors
    /// The errors of [`Shards::find`] and [`Shards::read`]; [`JournalError::Changed`] if the
    /// directories belong to different sweeps.
    pub fn merged<P: AsRef<Path>>(directories: &[P]) -> Result<Self, JournalError> {
        let mut all: Option<RecordCollection> = None;
        for directory in directories.iter().map(AsRef::as_ref) {
            let shards = Shards::find(directory)?;
            let gathered = all.get_or_insert_with(|| RecordCollection::new(shards.plan().clone()));
            same(directory, shards.plan(), &gathered.records.plan)?;
            if let Some(runs) = shards.all() {
                shards.gather(runs, gathered)?;
            }
        }
        let missing = || JournalError::Missing {
            directory: PathBuf::new(),
        };
        Ok(all.ok_or_else(missing)?.records())
    }
}
