//! Helpers of several tests: pseudo-random numbers, and the mechanisms of `lab`. Test data are in
//! this package; the tests are in `all/`.

pub use lab::mechanisms::{cranks, revolute, robot, rod, sketch};
pub use suite::numbers;

/// Examples of pages that belong to no library, compiled as doc tests.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../README.md")]
    mod readme {}
    #[doc = include_str!("../crates/robot-trolley/README.md")]
    mod robot_trolley {}
}

/// The book, in the order of its contents: every Rust block is a doc test.
#[cfg(doctest)]
mod book;

/// Returns the largest absolute value.
pub fn largest(x: impl IntoIterator<Item = f64>) -> f64 {
    x.into_iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}
