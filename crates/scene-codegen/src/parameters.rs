//! The values of the equations that are inputs of a module.

use std::collections::HashMap;

use model::record::TimeFunction;

/// One value of the equations.
#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    /// Description of the value, with the keys that change it.
    pub(crate) name: String,
    pub(crate) described: f64,
    /// Indices of the value in the recording.
    pub(crate) places: Vec<usize>,
}

/// The inputs of a module, and mechanisms in which the inputs have other values.
#[derive(Clone, Default)]
#[cfg_attr(
    not(feature = "modules"),
    allow(dead_code, reason = "only modules say it")
)]
pub(crate) struct Inputs {
    pub(crate) shape: u64,
    pub(crate) keys: Vec<String>,
    pub(crate) list: Vec<Parameter>,
    of_place: HashMap<usize, usize>,
    pub(crate) variants: Vec<Variant>,
}

/// Values of the inputs in another mechanism, and its functions of time.
#[derive(Clone)]
pub(crate) struct Variant {
    pub(crate) values: Vec<f64>,
    pub(crate) functions: Vec<TimeFunction>,
}

impl Inputs {
    /// Creates an empty list of inputs, for equations with this shape and for these keys.
    pub(crate) fn new(shape: u64, keys: Vec<String>) -> Self {
        Self {
            shape,
            keys,
            ..Self::default()
        }
    }

    /// Returns the index of the input whose value has the index `place` in the recording. Returns
    /// `None` if this value is not an input.
    pub(crate) fn at(&self, place: usize) -> Option<usize> {
        self.of_place.get(&place).copied()
    }

    /// Adds an index in the recording to an input.
    pub(crate) fn add_place(&mut self, parameter: usize, place: usize) {
        self.list[parameter].places.push(place);
        self.of_place.insert(place, parameter);
    }

    /// Returns the values in the described mechanism.
    pub(crate) fn described(&self) -> Vec<f64> {
        self.list.iter().map(|p| p.described).collect()
    }
}
