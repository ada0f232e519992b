#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`tables`] | `trajectory.csv` and `reactions.csv`, row by row |
//! | [`json`] | documents as JSON with a header, and objects whose keys are names |
//! | [`figures`] | the mechanism with its verdicts, histories, paths in the plane: SVG, PNG |
//! | [`mod@work_precision`] | error against run time: table, figure, page |
//! | [`mod@sweep`] | many runs: shards and journals that survive interruptions, CSV and Parquet |
//! | [`page`] | common parts of pages: start, end, style, format of numbers |
//! | [`files`] | an output directory without incomplete files under final names |

pub mod channel;
pub mod figures;
pub mod files;
pub mod json;
pub mod page;
pub mod peaks;
mod recording;
pub mod sweep;
pub mod tables;
pub mod work_precision;

pub use figures::{FigureError, Panel, Path, PathRecorder, Pattern, Png, PngError, Series, Style};
pub use files::{
    Family, FileError, OutputDirectory, OutputFile, PROVENANCE, Replaces, file_stems, is_ours,
};
pub use json::{ByName, part_as_json, read_json, write_json};
pub use peaks::{Peak, PeakRecorder};
pub use recording::{Frame, Recording};
pub use sweep::{SweepDocument, SweepPlan, SweepRow, SweepStatus};
pub use tables::{
    BoundsTable, Column, LoadTable, MoreColumns, Quantity, ReactionColumn, ReactionTable,
    Selection, Table, TableError, Trajectory, TrajectoryTable, columns_of_reactions, load_columns,
    load_numbers, matrix_table, numbers_of_columns, reaction_columns, reaction_component,
    write_chosen, write_determined, write_open_bounds,
};
pub use work_precision::{
    CurveName, Place, Provenance, RankingLine, ReferenceDocument, WorkPrecisionDocument,
    WorkPrecisionRow, WorkPrecisionScene, WorkPrecisionTable, work_precision_page,
};
