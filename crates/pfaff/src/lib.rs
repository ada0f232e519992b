#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! All crates of the house under one roof, by their own names, and a scene from its text, or from a
//! description in code, to its results:
//!
//! | module | content |
//! | --- | --- |
//! | [`prelude`] | the names that a program needs first |
//! | [`assembled`] | a scene with its mechanism |
//! | [`study`] | its consistent start, its motion, its files |
//! | `report_builder`, `comparison` | its report, and several choices for reactions that are not unique |
//! | [`configuration`] | one configuration, and everything that can be asked of its reactions |
//! | [`along_motion`] | the verdicts along its motion |
//! | [`difference`] | two scenes side by side |
//! | [`mod@sweep`] | many runs with other numbers |
//! | [`mod@work_precision`] | error against run time |
//! | [`memory`] | what work on a scene takes |
//! | [`error`] | why there are no results |

pub mod along_motion;
pub mod assembled;
mod comparison;
pub mod configuration;
pub mod difference;
pub mod error;
pub mod memory;
pub mod prelude;
mod report_builder;
pub mod study;
pub mod sweep;
pub mod work_precision;

pub use dynamics;
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
pub use solvability::Numbers;
pub use study::{Overrides, Study};

/// So many threads at most for all that this program computes in parallel from now on; runs of
/// several components have an option of their own, [`dynamics::MotionOptions::threads`].
///
/// # Errors
/// If threads have been started already, or cannot be.
pub fn limit_threads(threads: std::num::NonZeroUsize) -> Result<(), rayon::ThreadPoolBuildError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.get());
    pool.build_global()
}

/// What two computations find, side by side where there are threads for both, else one after the
/// other.
pub fn both<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    rayon::join(a, b)
}

/// Threads on which this program computes in parallel.
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
