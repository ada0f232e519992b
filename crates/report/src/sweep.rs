//! Files of many runs of one scene with different parameter values: a journal during the runs, and
//! tables with a row for each run at the end.
//!
//! During the sweep, a line is appended to a journal for each finished run. When all runs of a
//! shard have rows, the rows are written into one file, and the journals are removed. Tables are
//! computed completely from journals and shards, in the order of the grid. The tables do not depend
//! on the processes that performed the runs, or on the time of the runs.
//!
//! Only this module reads these files.
//!
//! The crate `pfaff` contains the grids, runs and threads.

mod cell;
mod document;
mod error;
mod journal;
mod line;
mod merged;
#[cfg(feature = "parquet")]
mod parquet;
mod records;
mod row;
mod runs;
mod shards;
mod tables;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use model::SpaceKind;
use serde::{Deserialize, Serialize};

pub use cell::{Cell, Column, Kind};
pub use document::{Extent, SweepDocument, SweepFailure};
pub use error::{Difference, JournalError};
pub use journal::Journal;
pub use line::digest;
pub use records::Records;
pub use row::{BoundsOfRun, SweepMotion, SweepRow, SweepStatus};
pub use runs::Runs;
pub use shards::{Shards, end_attempts};
pub use tables::{FAMILY, write_sweep};

/// Description of a sweep: all data on which the rows depend, and the names in the rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SweepPlan {
    /// Name of the scene.
    pub scene: String,
    /// Digest of the text of the scene.
    pub digest: String,
    /// Version of the program that makes the runs.
    pub version: String,
    /// Keys with their values, as given by the user.
    pub vary: Vec<String>,
    /// Number of runs in all shards.
    pub runs: u64,
    /// Whether each run stores its trajectory.
    pub keep_rows: bool,
    /// Keys of the varied values.
    pub keys: Vec<String>,
    /// Names of the bodies, in their order.
    pub bodies: Vec<String>,
    /// Names of the state variables of a body ([`model::SpaceKind::columns`]).
    #[serde(default = "planar")]
    pub state: Vec<String>,
    /// Joints and drives whose reactions are requested, in the order of their rows.
    pub reactions: Vec<String>,
    /// Whether the rows contain upper bounds of the reactions that are not unique.
    #[serde(default)]
    pub bounds: bool,
}

/// The names of the state variables in the plane. Early journals did not contain these names.
fn planar() -> Vec<String> {
    let columns = SpaceKind::Plane.columns().iter();
    columns.map(|name| (*name).to_owned()).collect()
}

/// Cells of finished runs, by the index of the run (from 1).
pub type SweepRows = BTreeMap<u64, Vec<Cell>>;
