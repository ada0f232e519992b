//! The numbers of the equations that a module takes as inputs.

use std::collections::HashMap;

use model::record::TimeFunction;

/// One number of the equations.
#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    /// Description of the number, with the keys that change it.
    pub(crate) name: String,
    pub(crate) described: f64,
    /// Indices of the number in the recording.
    pub(crate) places: Vec<usize>,
}

/// The numbers that a module takes as inputs, and mechanisms in which they have other values.
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

/// Other values of the inputs, and the functions of time with these values.
#[derive(Clone)]
pub(crate) struct Variant {
    pub(crate) values: Vec<f64>,
    pub(crate) functions: Vec<TimeFunction>,
}

impl Inputs {
    /// An empty list of inputs, for equations of this shape and these keys.
    pub(crate) fn new(shape: u64, keys: Vec<String>) -> Self {
        Self {
            shape,
            keys,
            ..Self::default()
        }
    }

    /// The index of the number at an index of the recording, if it is an input.
    pub(crate) fn at(&self, place: usize) -> Option<usize> {
        self.of_place.get(&place).copied()
    }

    /// Adds an index in the recording to a number.
    pub(crate) fn add_place(&mut self, parameter: usize, place: usize) {
        self.list[parameter].places.push(place);
        self.of_place.insert(place, parameter);
    }

    /// The values in the described mechanism.
    pub(crate) fn described(&self) -> Vec<f64> {
        self.list.iter().map(|p| p.described).collect()
    }
}
