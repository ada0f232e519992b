//! A program with its values at sampled states, by which an elimination chooses pivots that are
//! suitable for a whole motion.

use symbolic::{Program, Value};

/// Straight-line code and the values of its operations at some states.
pub(crate) struct Sampled {
    pub(crate) program: Program,
    /// Values of the inputs, state by state.
    inputs: Vec<Vec<f64>>,
    /// Values of the operations evaluated so far, operation by operation.
    values: Vec<Vec<f64>>,
}

impl Sampled {
    /// An empty program; `inputs` contains the values of all inputs for each state.
    pub(crate) fn new(inputs: Vec<Vec<f64>>) -> Self {
        Self {
            program: Program::empty(),
            inputs,
            values: Vec::new(),
        }
    }

    /// Number of states.
    pub(crate) fn states(&self) -> usize {
        self.inputs.len()
    }

    /// The values of an operation at all states.
    pub(crate) fn at(&mut self, v: Value) -> &[f64] {
        for k in self.values.len()..=v.index() {
            let op = self.program.op(self.program.value_at(k));
            let values = &self.values;
            let value = |state: usize| {
                op.evaluate(
                    |v| values[v.index()][state],
                    |s| self.inputs[state][s.index()],
                )
            };
            let values = (0..self.inputs.len()).map(value).collect();
            self.values.push(values);
        }
        &self.values[v.index()]
    }
}
