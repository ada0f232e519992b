#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | step |
//! | --- | --- |
//! | [`graph`] | expressions as hash-consed nodes, simplified during construction |
//! | `order` | the canonical order of terms and factors |
//! | [`differentiate`] | exact derivatives along any derivation |
//! | [`evaluate`] | direct evaluation, for tests and constants |
//! | [`program`] | straight-line code: common subexpressions and operation counts |
//! | `build` | straight-line code, built operation by operation, with known values folded |
//! | `lower` | translation of expressions to straight-line code |
//! | [`mod@print`] | output as Rust tokens |
//!
//! This crate contains no mechanics: bodies, joints and frames belong to the crate `codegen`.

mod build;
pub mod differentiate;
pub mod evaluate;
pub mod graph;
mod lower;
mod order;
#[cfg(feature = "print")]
pub mod print;
pub mod program;
mod substitute;

pub use differentiate::Derivation;
pub use evaluate::Number;
pub use graph::{Expr, Function, Graph, Node, Symbol};
#[cfg(feature = "print")]
pub use print::{Printer, Scalar};
pub use program::{Binary, Counts, Op, Program, Value};
