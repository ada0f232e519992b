//! A program together with its values at sampled states. With the values at states of the motion,
//! the elimination chooses pivots that are suitable for the whole motion. The values at states that
//! do not belong to the motion show which values are equal.
//!
//! Numerical values are compared, because symbolic simplification does not find all equal
//! expressions. For example, `Rᵀ·R = 1` is true for rotation matrices, but not for polynomials in
//! their entries. In addition, joints that are defined outside the library need no second, symbolic
//! kernel. The tests and `with_code` compare every result with the result of the interpreter.

use symbolic::{Program, Value};

/// Two values are equal if, at all states outside of the motion, their difference is at most this
/// fraction of the terms of one of the values. Both values have rounding errors.
const SAME: f64 = 1e-13;

/// Straight-line code and the values of its operations at some states.
pub(crate) struct SampledProgram {
    pub(crate) program: Program,
    motion: Samples,
    /// States that do not satisfy the constraints, with arbitrary values of the functions of time.
    anywhere: Samples,
}

/// Values of a program at some states.
struct Samples {
    /// Values of the inputs, in the order of the states.
    inputs: Vec<Vec<f64>>,
    /// Values of the operations that were evaluated, in the order of the operations.
    values: Vec<Vec<f64>>,
}

impl Samples {
    fn new(inputs: Vec<Vec<f64>>) -> Self {
        Self {
            inputs,
            values: Vec::new(),
        }
    }

    /// Returns the values of an operation at all states.
    fn at(&mut self, program: &Program, v: Value) -> &[f64] {
        for k in self.values.len()..=v.index() {
            let op = program.op(program.value_at(k));
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

impl SampledProgram {
    /// Creates an empty program; `motion` and `anywhere` contain the values of all inputs for each
    /// state.
    pub(crate) fn new(motion: Vec<Vec<f64>>, anywhere: Vec<Vec<f64>>) -> Self {
        Self {
            program: Program::empty(),
            motion: Samples::new(motion),
            anywhere: Samples::new(anywhere),
        }
    }

    /// Number of states.
    pub(crate) fn states(&self) -> usize {
        self.motion.inputs.len()
    }

    /// Returns the values of an operation at all states of the motion.
    pub(crate) fn at(&mut self, v: Value) -> &[f64] {
        self.motion.at(&self.program, v)
    }

    /// Σ aᵢ·bᵢ
    pub(crate) fn sum(&mut self, products: &[(Value, Value)]) -> Value {
        let p = &mut self.program;
        let zero = p.number(0.0);
        products.iter().fold(zero, |sum, (a, b)| {
            let product = p.mul(*a, *b);
            p.add(sum, product)
        })
    }

    /// Returns the same sum. If it is equal to a constant or to an existing value of the program at
    /// all states outside the motion, the result is this constant or value.
    pub(crate) fn simplest_sum(&mut self, products: &[(Value, Value)]) -> Value {
        let is_zero = |p: &Program, (a, b): &(Value, Value)| p.is_zero(*a) || p.is_zero(*b);
        if products.iter().all(|pair| is_zero(&self.program, pair)) {
            return self.program.number(0.0);
        }
        let states = self.anywhere.inputs.len();
        let (mut values, mut sizes) = (vec![0.0; states], vec![0.0; states]);
        for &(a, b) in products {
            let a = self.anywhere.at(&self.program, a).to_vec();
            let b = self.anywhere.at(&self.program, b);
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                values[k] += a * b;
                sizes[k] += (a * b).abs();
            }
        }
        let equals = |other: &dyn Fn(usize) -> f64| {
            (0..states).all(|k| (values[k] - other(k)).abs() <= SAME * sizes[k])
        };
        for number in [0.0, 1.0, -1.0, short(values[0])] {
            if equals(&|_| number) {
                return self.program.number(number);
            }
        }
        for k in 0..self.program.ops().len() {
            let v = self.program.value_at(k);
            let other = self.anywhere.at(&self.program, v);
            if equals(&|k| other[k]) {
                return v;
            }
            if equals(&|k| -other[k]) {
                return self.program.neg(v);
            }
        }
        self.sum(products)
    }
}

/// Rounds a number to fifteen digits, because the last digit of a rounded value depends on the
/// machine.
fn short(x: f64) -> f64 {
    format!("{x:.14e}").parse().unwrap_or(x)
}
