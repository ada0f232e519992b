#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! Contains all other crates under their own names, and leads from the text of a scene, or from a
//! description in code, to its results:
//!
//! | module | content |
//! | --- | --- |
//! | [`prelude`] | the names that a program needs most often |
//! | [`assembled`] | a scene with its mechanism |
//! | [`study`] | its consistent start, its motion, its files |
//! | `report_builder`, `comparison` | its report, and several choices for reactions that are not unique |
//! | [`configuration`] | one configuration, and the results for its reactions |
//! | [`along_motion`] | the verdicts along its motion |
//! | [`difference`] | comparison of two scenes |
//! | [`mod@rows`] | what takes the rows of a run: one value for each file or array |
//! | [`mod@sweep`] | many runs with different numbers |
//! | [`mod@tolerance`] | many mechanisms with data within their tolerances |
//! | [`mod@work_precision`] | error against run time |
//! | [`memory`] | estimated memory |
//! | [`forked`] | parallel work in a process that was forked |
//! | [`error`] | reasons why there are no results |
//! | `refusal`, `source` (feature `messages`) | these reasons in words for people; texts of files |

use std::num::NonZeroUsize;

pub mod along_motion;
pub mod assembled;
mod comparison;
pub mod configuration;
pub mod difference;
pub mod error;
pub mod forked;
pub mod memory;
pub mod prelude;
#[cfg(feature = "messages")]
pub mod refusal;
mod report_builder;
pub mod rows;
#[cfg(feature = "messages")]
pub mod source;
mod spread;
pub mod study;
pub mod sweep;
mod tables_of_run;
pub mod tolerance;
mod within;
pub mod work_precision;

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

pub use along_motion::{Progress, VerdictsAlongMotion};
pub use assembled::AssembledScene;
pub use configuration::ConfigurationAnalysis;
pub use difference::Comparison;
pub use error::StudyError;
pub use report_builder::written_scene;
pub use solvability::Numbers;
pub use study::{Overrides, Study};

/// Most threads of parallel computations.
pub const MOST_THREADS: usize = 256;

/// Starts the threads of all parallel computations of this program: as many as given, up to
/// [`MOST_THREADS`], or one for each core. If the system does not allow so many, everything is
/// computed on the thread that calls. Does nothing if they have been started already. Runs with
/// several components have a separate option, [`dynamics::MotionOptions::threads`].
pub fn start_threads(threads: Option<NonZeroUsize>) {
    // rayon asks for its pool once: whether it can be had is tried before.
    let pool = || rayon::ThreadPoolBuilder::new().num_threads(most(threads));
    let global = match pool().build() {
        Ok(_) => pool().build_global(),
        Err(_) => alone().build_global(),
    };
    // It fails if there is a pool already.
    drop(global);
}

/// A pool of its own for a part of a program, like that of [`start_threads`].
pub(crate) fn pool(
    threads: Option<NonZeroUsize>,
) -> Result<rayon::ThreadPool, rayon::ThreadPoolBuildError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(most(threads));
    pool.build().or_else(|_| alone().build())
}

fn most(threads: Option<NonZeroUsize>) -> usize {
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    threads.map_or(cores, NonZeroUsize::get).min(MOST_THREADS)
}

fn alone() -> rayon::ThreadPoolBuilder {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
}

/// The results of two computations, run in parallel if there are threads for both, otherwise one
/// after the other.
pub fn both<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    rayon::join(a, b)
}

/// Number of threads of parallel computations.
#[must_use]
pub fn threads() -> usize {
    rayon::current_num_threads()
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
