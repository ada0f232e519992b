#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`mod@case`] | a case with its right answer; a family of cases |
//! | [`mod@judge`] | what is to be thought of an outcome |
//! | [`mod@run`] | many cases on some threads, each with a time limit |
//! | [`mechanisms`] | mechanisms that cases and tests use |
//! | [`motion`] | scenes to the last row of their motion, by every method |
//! | [`mod@families`] | the list of families, each in a file of its own |

pub mod case;
pub mod families;
pub mod judge;
pub mod mechanisms;
pub mod motion;
pub mod run;

pub use case::{Case, Expected, Family, Outcome};
pub use families::{families, find};
pub use judge::judge;
pub use run::run;
