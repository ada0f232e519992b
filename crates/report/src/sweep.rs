//! Many runs of one scene with other numbers in it: a row for each, a journal while they are made,
//! tables at the end.
//!
//! A journal is a text that only grows, one line for each finished run, behind a line that says
//! what the sweep is. Tables are made of journals, whole and in the order of the grid, whoever did
//! the runs and when.
//!
//! Journals are read back here and nowhere else.
//!
//! Not here: grids, runs and threads.

mod cell;
mod document;
mod journal;
#[cfg(feature = "parquet")]
mod parquet;
mod row;
mod tables;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use cell::{Cell, Column, Kind};
pub use document::{SweepDocument, SweepFailure};
pub use journal::{Journal, JournalError, Journals, digest};
pub use row::{Extreme, SweepMotion, SweepRow, SweepStatus};
pub use tables::write_sweep;

/// What a sweep is: all that its rows depend on, and what they are called.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SweepPlan {
    /// Name of the scene.
    pub scene: String,
    /// Digest of its text.
    pub digest: String,
    /// The program that makes the runs.
    pub version: String,
    /// Keys with their values, as they were asked for.
    pub vary: Vec<String>,
    /// Number of runs in all shards.
    pub runs: u64,
    /// Whether each run keeps its trajectory.
    pub keep_rows: bool,
    /// Keys of the varied numbers.
    pub keys: Vec<String>,
    /// Bodies, in their order.
    pub bodies: Vec<String>,
    /// Joints and drives whose reactions are wanted, in the order of their rows.
    pub reactions: Vec<String>,
}

/// Cells of finished runs, by the number of the run (from 1).
pub type SweepRows = BTreeMap<u64, Vec<Cell>>;
