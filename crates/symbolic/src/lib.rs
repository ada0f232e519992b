#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | step |
//! | --- | --- |
//! | [`graph`] | expressions as hash-consed nodes, simplified while they are built |
//! | `order` | the canonical order of terms and factors |
//! | [`differentiate`] | exact derivatives along any derivation |
//! | [`evaluate`] | direct evaluation, for tests and constants |
//! | [`lower`] | common subexpressions and operation counts |
//! | [`mod@print`] | Rust tokens |
//!
//! No mechanics here: bodies, joints and frames belong to the crate `codegen`.

pub mod differentiate;
pub mod evaluate;
pub mod graph;
pub mod lower;
mod order;
pub mod print;
mod substitute;

pub use differentiate::Derivation;
pub use evaluate::Number;
pub use graph::{Expr, Function, Graph, Node, Symbol};
pub use lower::{Binary, Counts, Op, Program, Value};
pub use print::{Printer, Scalar};
