//! Numbers of a mechanism that generated code takes as inputs: code that was generated for one
//! mechanism serves every other one that differs in these numbers only.
//!
//! A number is known by its place in the recorded equations, never by its value, so two equal ones
//! are not confused. Numbers that were equal in all mechanisms that the code was generated from are
//! one input; a mechanism in which they differ is refused.

use std::borrow::Cow;
use std::sync::Arc;

use model::{Mechanism, RecordedEquations, SpaceKind, System};

use super::{CodeMismatch, SceneCode};
use crate::limits::SAME_VALUES;

/// The inputs of generated code beside time, coordinates and velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeInputs {
    /// [`RecordedEquations::shape`] of the mechanism that the code was generated for.
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

impl CodeInputs {
    /// The values in a mechanism, in their order; `code` is the name of the code in messages.
    ///
    /// # Errors
    /// - [`CodeMismatch::Shape`]: the equations of the mechanism are not those of the code.
    /// - [`CodeMismatch::Parts`]: what is one number in the code is several in the mechanism.
    pub fn of(&self, code: &str, mechanism: &Mechanism) -> Result<Vec<f64>, CodeMismatch> {
        let shape = || CodeMismatch::Shape {
            name: code.to_owned(),
        };
        let is_recorded = matches!(mechanism.space(), SpaceKind::Plane | SpaceKind::Space3);
        if !is_recorded || mechanism.layout().turns > 0 {
            return Err(shape());
        }
        let recording = RecordedEquations::of(mechanism);
        if recording.shape() != self.shape {
            return Err(shape());
        }
        let value = |input: &CodeInput| {
            let mut all = input.places.iter().map(|&place| recording.number(place));
            let first = all.next().flatten().ok_or_else(shape)?;
            for other in all {
                let other = other.ok_or_else(shape)?;
                let size = f64::max(first.abs(), other.abs());
                if (first - other).abs() > SAME_VALUES * size {
                    return Err(CodeMismatch::Parts {
                        name: code.to_owned(),
                        input: input.name.to_string(),
                        values: [first, other],
                    });
                }
            }
            Ok(first)
        };
        self.list.iter().map(value).collect()
    }
}

/// The code with the numbers of a mechanism, if it takes any.
pub(super) fn for_mechanism(
    code: Arc<dyn SceneCode>,
    mechanism: &Mechanism,
) -> Result<Arc<dyn SceneCode>, CodeMismatch> {
    let name = &code.spec().name;
    let Some(inputs) = code.inputs() else {
        return Ok(code);
    };
    let values = inputs.of(name, mechanism)?;
    let own = code.with_inputs(&values);
    own.ok_or_else(|| CodeMismatch::Inputs {
        name: name.to_string(),
        found: values.len(),
    })
}
