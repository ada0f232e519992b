#![doc = include_str!("../README.md")]

pub mod options;

pub use options::{Formulation, Method, MotionOptions, RowChoice, Stabilisation};
