#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`comparators`] | other formulations of redundancy and other methods, to compare the product's with |

#![forbid(unsafe_code)]

pub mod comparators;
