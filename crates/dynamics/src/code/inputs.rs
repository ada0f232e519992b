//! Parameters of a mechanism that generated code takes as inputs. Code that was generated for one
//! mechanism can be used for every other mechanism that differs only in the values of these
//! parameters.
//!
//! A parameter is identified by its position in the recorded equations, not by its value. Therefore
//! two parameters with equal values are not confused. Parameters that were equal in all mechanisms
//! from which the code was generated share one input. A mechanism in which such parameters differ
//! is rejected.

use std::borrow::Cow;

/// The inputs of generated code in addition to time, coordinates and velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeInputs {
    /// The [`model::RecordedEquations::shape`] of the mechanism for which the code was generated.
    pub shape: u64,
    /// The inputs, in the order of their values.
    pub list: Cow<'static, [CodeInput]>,
}

/// One input: a parameter of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeInput {
    /// Description of the parameter, with the keys of the scene that change it.
    pub name: Cow<'static, str>,
    /// Value in the mechanism for which the code was generated.
    pub described: f64,
    /// Positions of the parameter in the recorded equations. There is at least one position.
    pub places: Cow<'static, [usize]>,
}
