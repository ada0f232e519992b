#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`comparators`] | other formulations of redundancy and other methods, to compare the product's with |
//! | [`mod@work_precision`] | error against run time: the product's methods and the comparators |

#![forbid(unsafe_code)]

pub mod comparators;
pub mod work_precision;

pub use work_precision::work_precision;
