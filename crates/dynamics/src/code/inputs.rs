//! Numbers of a mechanism that generated code takes as inputs: code that was generated for one
//! mechanism serves every other one that differs in these numbers only.
//!
//! A number is known by its place in the recorded equations, never by its value, so two equal ones
//! are not confused. Numbers that were equal in all mechanisms that the code was generated from are
//! one input; a mechanism in which they differ is refused.

use std::borrow::Cow;

/// The inputs of generated code beside time, coordinates and velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeInputs {
    /// [`model::RecordedEquations::shape`] of the mechanism that the code was generated for.
    pub shape: u64,
    /// The numbers, in their order.
    pub list: Cow<'static, [CodeInput]>,
}

/// One number.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeInput {
    /// What it is, and the keys of the scene that change it.
    pub name: Cow<'static, str>,
    /// Its value in the mechanism that the code was generated for.
    pub described: f64,
    /// Its places in the recorded equations, at least one.
    pub places: Cow<'static, [usize]>,
}
