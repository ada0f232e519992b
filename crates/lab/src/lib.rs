#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`comparators`] | other formulations of redundancy and other methods, for comparison with pfaff |
//! | [`mod@work_precision`] | error and run time of the reference methods and of pfaff |
//! | [`fuzz`] | random, damaged and degenerate scenes, tested for consistency and by exact arithmetic |
//! | [`stress`] | stiff and extreme cases, each with its known answer |
//! | [`mechanisms`] | mechanisms that cases and tests use |
//! | [`command`] | the command `lab` |

#![forbid(unsafe_code)]

pub mod command;
pub mod comparators;
pub mod fuzz;
pub mod mechanisms;
pub mod stress;
pub mod work_precision;
