#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! This crate contains all other crates under their own names. It computes results from the text of
//! a scene, or from a description in code:
//!
//! | module | content |
//! | --- | --- |
//! | [`question`], [`questions`] | the definition of a question, and all questions: options, answers, texts |
//! | [`mod@start`] | the scene that is the subject of a question |
//! | [`words`] | sentences and tables, laid out as text |
//! | [`documents`], [`mod@page`] | the answers of an analysis, a run and samples as data; the page of a run |
//! | [`view`], [`template`], [`mod@explain`] | the start as a picture; scenes to begin with; codes of errors |
//! | [`prelude`] | the most frequently used names |
//! | [`assembled`] | a scene with its mechanism |
//! | [`study`] | the consistent start, the motion and the files of a scene |
//! | `report_builder`, `comparison` | the report, and several choices for reactions that are not unique |
//! | [`run_options`] | options of a run that replace options of the scene |
//! | [`choice`] | choices of reactions that are not unique, in the syntax of the command |
//! | [`configuration`] | one configuration, and the results for its reactions |
//! | [`along_motion`] | the verdicts along a motion |
//! | [`mod@rows`] | consumers of the rows of a run: one value for each file or array |
//! | [`mod@sweep`] | many runs with different numbers |
//! | [`mod@tolerance`] | many mechanisms with data within their tolerances |
//! | [`mod@work_precision`] | error against run time |
//! | [`memory`], `workers` | estimated memory; threads |
//! | `command` (feature `command`) | values of options on a command line |
//! | [`forked`] | parallel work in a process that was forked |
//! | [`error`] | reasons why there are no results |
//! | [`refusal`], [`source`] | these reasons as text (feature `messages`) and as documents; texts of files |

pub mod along_motion;
pub mod assembled;
mod body_loads;
mod bounds_of_run;
pub mod choice;
#[cfg(feature = "command")]
pub mod command;
mod comparison;
pub mod configuration;
pub mod contact_fault;
pub mod contacts;
pub mod documents;
pub mod elasticity;
pub mod error;
pub mod explain;
pub mod forked;
mod loads_of_run;
pub mod memory;
pub mod page;
mod peaks_of_run;
mod plots;
pub mod prelude;
mod pulls;
pub mod question;
pub mod questions;
pub mod refusal;
mod report_builder;
pub mod rows;
pub mod run_options;
#[cfg(feature = "schema")]
pub mod schema;
pub mod source;
mod spread;
pub mod start;
pub mod study;
pub mod sweep;
mod tables_of_run;
pub mod template;
pub mod tolerance;
pub mod view;
mod within;
pub mod words;
pub mod work_precision;
mod workers;

pub use dynamics;
pub use import;
pub use integrators;
pub use joints;
pub use linalg;
pub use model;
pub use rank;
pub use report;
pub use scene;
pub use solvability;

pub use along_motion::{MotionProgress, VerdictsAlongMotion};
pub use assembled::AssembledScene;
pub use configuration::ConfigurationAnalysis;
pub use error::StudyError;
pub use report_builder::written_scene;
pub use run_options::RunOptions;
pub use solvability::Numbers;
pub use study::Study;
pub use workers::{MOST_THREADS, start_threads, threads};

/// Returns the results of two computations. The computations run in parallel if two threads are
/// available, and otherwise one after the other.
pub fn both<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    let own = model::words::units();
    rayon::join(
        || model::words::in_units(own, a),
        || model::words::in_units(own, b),
    )
}

#[cfg(feature = "macros")]
#[doc(hidden)]
pub use joint_macro as __macros;

/// Defines a joint; see the crate `joint-macro`.
#[cfg(feature = "macros")]
#[macro_export]
macro_rules! joint {
    ($($definition:tt)*) => {
        $crate::__macros::joint! { #![runtime = $crate::joints] $($definition)* }
    };
}

/// Defines a force; see the crate `joint-macro`.
#[cfg(feature = "macros")]
#[macro_export]
macro_rules! force {
    ($($definition:tt)*) => {
        $crate::__macros::force! { #![runtime = $crate::joints] $($definition)* }
    };
}
