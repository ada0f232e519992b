//! The recorded equations of a mechanism as one program; the values stored by the mechanism are
//! constants of the program.
//!
//! The kernels are recorded; their equations are not derived a second time from the definitions.
//! Therefore each equation has only one source, joints outside the library are included, and zeros
//! and ones of the scene simplify the program.

use std::collections::HashMap;

use joints::recorded::{Operation, RecordedNumber};
use model::record::Input;
use model::{RecordedEquations, System};
use symbolic::{Function, Graph, Program, Value};

use crate::sampled::SampledProgram;
use crate::subject::{State, Subject};

/// Number of states at which equations are compared. These states do not belong to the motion.
pub(crate) const ANYWHERE: usize = 8;

/// The meaning of an input of the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    /// An input of the mechanism.
    Mechanism(Input),
    /// An entry of a right-hand side, with the index of its row.
    Rhs(usize),
    /// A stored value of the mechanism, with its index among the inputs.
    Number(usize),
}

/// A stored value of the mechanism in a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Number {
    /// The value as a constant.
    Known(f64),
    /// An input of the program.
    Input(Value),
}

impl Number {
    pub(crate) fn value(self, p: &mut Program) -> Value {
        match self {
            Self::Known(x) => p.number(x),
            Self::Input(v) => v,
        }
    }
}

/// The equations as values of a program.
#[cfg_attr(
    not(feature = "modules"),
    allow(dead_code, reason = "only modules say it")
)]
pub(crate) struct Equations {
    pub(crate) code: SampledProgram,
    /// Names of the inputs, and their meanings.
    pub(crate) names: Graph,
    pub(crate) sources: Vec<Source>,
    inputs: Vec<Value>,
    pub(crate) recording: RecordedEquations,
    /// The values that are inputs, by their indices in the recording.
    pub(crate) numbers: HashMap<usize, Value>,
    pub(crate) phi: Vec<Value>,
    /// The rows of C as dense rows; zero entries are the constant 0.
    pub(crate) c: Vec<Vec<Value>>,
    pub(crate) b: Vec<Value>,
    pub(crate) gamma: Vec<Value>,
    pub(crate) force: Vec<Value>,
    pub(crate) rate: Vec<Value>,
}

impl Equations {
    pub(crate) fn new(subject: &Subject<'_>) -> Self {
        let mechanism = &subject.prepared.mechanism;
        let layout = mechanism.layout();
        let recording = RecordedEquations::of(mechanism);
        let sources: Vec<Source> = recording
            .inputs
            .iter()
            .map(|&i| Source::Mechanism(i))
            .chain((0..layout.rows()).map(Source::Rhs))
            .chain((0..subject.inputs.list.len()).map(Source::Number))
            .collect();
        let samples = (0..subject.states.len()).map(|state| {
            let value = |source: &Source| match *source {
                Source::Mechanism(input) => subject.input_at(input, state),
                Source::Rhs(_) => 0.0,
                Source::Number(k) => subject.number(k, state),
            };
            sources.iter().map(value).collect()
        });
        let anywhere = (0..ANYWHERE).map(|k| {
            let state = anywhere(subject, k);
            let value = |(i, source): (usize, &Source)| match *source {
                Source::Mechanism(Input::Function { .. }) | Source::Rhs(_) => shift(i, k),
                Source::Mechanism(input) => subject.input(input, &state),
                // The value in the described mechanism is used, because a property that is true for
                // all values is also true for this value.
                Source::Number(n) => match subject.inputs.list[n].described {
                    0.0 => shift(i, k),
                    x => x * (1.0 + 0.5 * shift(i, k)),
                },
            };
            sources.iter().enumerate().map(value).collect()
        });
        let mut code = SampledProgram::new(samples.collect(), anywhere.collect());
        let mut names = Graph::new();
        let mut inputs = Vec::with_capacity(sources.len());
        for source in &sources {
            let symbol = names.symbol(&name(*source));
            if let Some(symbol) = names.as_symbol(symbol) {
                inputs.push(code.program.input(symbol));
            }
        }
        let known = recording.inputs.len() + layout.rows();
        let places = subject.inputs.list.iter().zip(&inputs[known..]);
        let places = places.flat_map(|(p, v)| p.places.iter().map(|place| (*place, *v)));
        let numbers: HashMap<usize, Value> = places.collect();
        let values = replay(&mut code, &recording, &inputs, &numbers);
        let (c, of) = results(&mut code, &recording, &values);
        Self {
            numbers,
            phi: of(&recording.phi),
            c,
            b: of(&recording.b),
            gamma: of(&recording.gamma),
            force: of(&recording.force),
            rate: of(&recording.rate),
            code,
            names,
            sources,
            inputs,
            recording,
        }
    }

    /// Returns the input with this meaning; all inputs are created at the beginning.
    pub(crate) fn input(&self, source: Source) -> Option<Value> {
        let at = self.sources.iter().position(|&s| s == source)?;
        self.inputs.get(at).copied()
    }

    /// Returns the diagonal of M.
    pub(crate) fn mass(&self) -> Vec<Number> {
        let mass = self.recording.beside.mass.iter();
        let mass = mass.map(|r| number(&self.recording, &self.numbers, *r));
        mass.collect()
    }

    /// Returns the generalised force of gravity.
    pub(crate) fn weight(&mut self) -> Vec<Value> {
        let weight = self.recording.weight.iter();
        let weight = weight.map(|r| number(&self.recording, &self.numbers, *r));
        weight.map(|w| w.value(&mut self.code.program)).collect()
    }

    /// Returns row `i` of `C·x`.
    pub(crate) fn row_times(&mut self, i: usize, x: &[Value]) -> Value {
        let p = &mut self.code.program;
        let zero = p.number(0.0);
        self.c[i].iter().zip(x).fold(zero, |sum, (c, x)| {
            let product = p.mul(*c, *x);
            p.add(sum, product)
        })
    }
}

/// Returns a state that does not satisfy the constraints, far from the k-th state of the motion.
pub(crate) fn anywhere(subject: &Subject<'_>, k: usize) -> State {
    let State { t, mut q, mut v } = subject.states[k % subject.states.len()].clone();
    let mechanism = &subject.prepared.mechanism;
    let size = subject.prepared.assembly.size;
    let away: Vec<f64> = (0..v.len())
        .map(|j| shift(j, k) * mechanism.space().unit(j, size))
        .collect();
    mechanism.displace(&mut q, &away);
    for (j, v) in v.iter_mut().enumerate() {
        *v += shift(j + 7, k) * mechanism.space().unit(j, size);
    }
    State { t, q, v }
}

/// Returns values between −1 and 1 that do not correspond to a symmetry of a mechanism.
fn shift(i: usize, k: usize) -> f64 {
    (1.3 * (i + 1) as f64 + 2.3 * (k + 1) as f64).sin()
}

/// Returns C of a replayed recording as dense rows, and a function that returns the other results.
pub(crate) fn results<'v>(
    code: &mut SampledProgram,
    recording: &RecordedEquations,
    values: &'v [Value],
) -> (
    Vec<Vec<Value>>,
    impl Fn(&[RecordedNumber]) -> Vec<Value> + use<'v>,
) {
    let zero = code.program.number(0.0);
    let row = |entries: &Vec<(usize, RecordedNumber)>| {
        let mut row = vec![zero; recording.force.len()];
        for (column, r) in entries {
            row[*column] = code.program.add(row[*column], values[r.place()]);
        }
        row
    };
    let c = recording.c.iter().map(row).collect();
    let of = |list: &[RecordedNumber]| list.iter().map(|r| values[r.place()]).collect();
    (c, of)
}

/// Returns a value of a recording, as a constant or as an input.
fn number(
    recording: &RecordedEquations,
    numbers: &HashMap<usize, Value>,
    at: RecordedNumber,
) -> Number {
    let known = || Number::Known(recording.number(at.place()).unwrap_or(f64::NAN));
    numbers
        .get(&at.place())
        .map_or_else(known, |v| Number::Input(*v))
}

/// Repeats the operations of an operation list in a program. The program evaluates operations on
/// constants. The values at some indices are inputs.
pub(crate) fn replay(
    code: &mut SampledProgram,
    recording: &RecordedEquations,
    inputs: &[Value],
    numbers: &HashMap<usize, Value>,
) -> Vec<Value> {
    let p = &mut code.program;
    let mut values: Vec<Value> = Vec::with_capacity(recording.beside.first);
    for (place, operation) in recording.tape[..recording.beside.first].iter().enumerate() {
        let of = |r: RecordedNumber| values[r.place()];
        let value = match *operation {
            Operation::Number(x) => match numbers.get(&place) {
                Some(input) => *input,
                None => p.number(x),
            },
            Operation::Input(k) => inputs[k],
            Operation::Add(a, b) => p.add(of(a), of(b)),
            Operation::Sub(a, b) => p.sub(of(a), of(b)),
            Operation::Mul(a, b) => p.mul(of(a), of(b)),
            Operation::Div(a, b) => p.div(of(a), of(b)),
            Operation::Neg(a) => p.neg(of(a)),
            Operation::Sqrt(a) => p.call(Function::Sqrt, of(a)),
            Operation::RecipOrZero(a) => p.call(Function::RecipOrZero, of(a)),
            Operation::AngleOverSine(a, order) => p.call(Function::AngleOverSine(order), of(a)),
        };
        values.push(value);
    }
    values
}

fn name(source: Source) -> String {
    match source {
        Source::Mechanism(Input::Coordinate(k)) => format!("q{k}"),
        Source::Mechanism(Input::Cos(k)) => format!("cos{k}"),
        Source::Mechanism(Input::Sin(k)) => format!("sin{k}"),
        Source::Mechanism(Input::Rotation { body, row, column }) => {
            format!("rot{body}_{row}{column}")
        }
        Source::Mechanism(Input::Velocity(k)) => format!("v{k}"),
        Source::Mechanism(Input::Function {
            function,
            derivative,
        }) => format!("{}{function}", ["f", "df", "ddf"][derivative.min(2)]),
        Source::Rhs(k) => format!("r{k}"),
        Source::Number(k) => format!("p{k}"),
    }
}
