#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! All crates of the house under one roof, by their own names, and [`study`]: a scene from its text to its results.

pub mod study;

pub use dynamics;
pub use integrators;
pub use joints;
pub use linalg;
pub use model;
pub use report;
pub use scene;
pub use solvability;

pub use study::{Findings, Overrides, Study, StudyError};

#[doc(hidden)]
pub use joint_macro as __macros;

/// Defines a joint; see the crate `joint-macro`.
#[macro_export]
macro_rules! joint {
    ($($definition:tt)*) => {
        $crate::__macros::joint! { #![runtime = $crate::joints] $($definition)* }
    };
}

/// Defines a force; see the crate `joint-macro`.
#[macro_export]
macro_rules! force {
    ($($definition:tt)*) => {
        $crate::__macros::force! { #![runtime = $crate::joints] $($definition)* }
    };
}
