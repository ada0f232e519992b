//! The same code without a compiler: a list of operations, executed in sequence. For scenes that
//! are read at run time, and for tests of runs on generated code; a compiled module is about five
//! times faster.

use std::cell::RefCell;

use std::sync::Arc;

use dynamics::SceneCode;
use dynamics::code::{CodeInput, CodeInputs, CodeSpec};
use model::record::{Input, TimeFunction};
use model::{SpaceKind, System};
use symbolic::{Op, Program};

use crate::equations::Source;
use crate::error::CodeError;
use crate::functions::{Function, Functions};
use crate::subject::{Subject, rotation};

/// The code of one mechanism as lists of operations.
///
/// ```
/// use std::sync::Arc;
/// use pfaff::{Overrides, Study};
/// use scene_codegen::{Subject, Tape};
/// let scene = r#"
/// scene = { name = "pendulum", space = "plane", gravity = [0.0, -10.0] }
/// body = [{ name = "bob", mass = 1.0, inertia = 0.0, position = [2.0, 0.0] }]
/// joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] }]
/// "#;
/// let registry = pfaff::model::Registry::standard();
/// let mut study = Study::read("pendulum.toml", scene, &registry, &Overrides::default())?;
/// let tape = Tape::of(&Subject::at_start(&study.prepared))?;
/// study.prepared = study.prepared.with_code(Arc::new(tape))?; // its runs are on the tape from now on
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Tape {
    spec: CodeSpec,
    functions: Arc<[(&'static str, List)]>,
    times: Vec<TimeFunction>,
    /// For each number of each function of time, the input that it is.
    numbers_of_times: Vec<Vec<Option<usize>>>,
    /// The numbers of the mechanism that are inputs, and their values.
    inputs: Option<CodeInputs>,
    values: Vec<f64>,
    /// Bodies with quaternions.
    spatial: usize,
}

/// One function: the sources of its inputs, and its operations.
struct List {
    sources: Vec<Source>,
    program: Program,
    n_out: usize,
}

/// The arguments of a function.
#[derive(Clone, Copy, Default)]
struct Arguments<'a> {
    t: f64,
    q: &'a [f64],
    v: &'a [f64],
    rhs: &'a [f64],
}

thread_local! {
    /// Values of all operations of the last function that ran in this thread.
    static VALUES: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    /// The rotations of its bodies in space.
    static ROTATIONS: RefCell<Vec<[[f64; 3]; 3]>> = const { RefCell::new(Vec::new()) };
}

impl Tape {
    /// The code of a subject.
    ///
    /// # Errors
    /// As [`crate::generate`].
    pub fn of(subject: &Subject<'_>) -> Result<Self, CodeError> {
        let functions = Functions::new(subject)?;
        let prepared = subject.prepared;
        let layout = prepared.mechanism.layout();
        let Functions {
            equations, list, ..
        } = functions;
        let operations = list
            .iter()
            .map(|f| format!("{}: {}", f.signature.name, f.program.counts()));
        let operations: Vec<String> = operations.collect();
        let list = list.into_iter().map(|f: Function| {
            let list = List {
                sources: equations.sources.clone(),
                program: f.program,
                n_out: f.n_out,
            };
            (f.signature.name, list)
        });
        let spec = CodeSpec {
            name: prepared.mechanism.name().to_owned().into(),
            n_q: layout.n_q,
            n_v: layout.n_v,
            m: layout.m,
            h: layout.h,
            kept: prepared.decision.kept.clone().into(),
            position_kept: prepared.position_decision.kept.clone().into(),
            break_times: layout.break_times.clone().into(),
            operations: operations.join("; ").into(),
        };
        let times = prepared.mechanism.functions();
        let inputs = &subject.inputs;
        let numbers_of_times = equations.recording.functions.iter();
        let list_of_inputs = inputs.list.iter().map(|p| CodeInput {
            name: p.name.clone().into(),
            described: p.described,
            places: p.places.clone().into(),
        });
        Ok(Self {
            spec,
            functions: list.collect(),
            times: times.cloned().collect(),
            numbers_of_times: numbers_of_times
                .map(|numbers| numbers.iter().map(|r| inputs.at(r.place())).collect())
                .collect(),
            values: inputs.described(),
            inputs: (!inputs.list.is_empty()).then(|| CodeInputs {
                shape: inputs.shape,
                list: list_of_inputs.collect(),
            }),
            spatial: match prepared.mechanism.space() {
                SpaceKind::Space3 => prepared.mechanism.bodies().len(),
                _ => 0,
            },
        })
    }

    /// Executes one function and returns the health.
    fn run(&self, name: &str, arguments: Arguments<'_>, out: &mut [f64]) -> f64 {
        let Some((_, list)) = self.functions.iter().find(|(n, _)| *n == name) else {
            return f64::NAN;
        };
        let mut jets = [[0.0; 3]; 1];
        let jets: &[[f64; 3]] = match self.times.as_slice() {
            [] => &[],
            [one] => {
                jets[0] = one.jet(arguments.t);
                &jets
            }
            several => &several
                .iter()
                .map(|f| f.jet(arguments.t))
                .collect::<Vec<_>>(),
        };
        let mut rotations = ROTATIONS.take();
        rotations.clear();
        rotations.extend((0..self.spatial).map(|body| rotation(arguments.q, body)));
        let health = VALUES.with_borrow_mut(|values| {
            values.clear();
            for op in list.program.ops() {
                let value = match op {
                    Op::Input(s) => match list.sources[s.index()] {
                        Source::Number(k) => self.values.get(k).copied().unwrap_or(f64::NAN),
                        source => read(source, arguments, jets, &rotations),
                    },
                    op => op.evaluate(|v| values[v.index()], |_| f64::NAN),
                };
                values.push(value);
            }
            let outputs = list.program.outputs();
            for (out, v) in out.iter_mut().zip(&outputs[..list.n_out]) {
                *out = values[v.index()];
            }
            let shares = outputs[list.n_out..].iter();
            shares.fold(f64::INFINITY, |health, v| least(health, values[v.index()]))
        });
        ROTATIONS.set(rotations);
        health
    }
}

/// The smaller one; NaN if one is.
fn least(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The value of an input; NaN if the caller's arrays are too short.
fn read(source: Source, a: Arguments<'_>, jets: &[[f64; 3]], rotations: &[[[f64; 3]; 3]]) -> f64 {
    let of = |x: &[f64], k: usize| x.get(k).copied().unwrap_or(f64::NAN);
    match source {
        Source::Mechanism(Input::Coordinate(k)) => of(a.q, k),
        Source::Mechanism(Input::Cos(k)) => of(a.q, k).cos(),
        Source::Mechanism(Input::Sin(k)) => of(a.q, k).sin(),
        Source::Mechanism(Input::Rotation { body, row, column }) => {
            rotations.get(body).map_or(f64::NAN, |rot| rot[row][column])
        }
        Source::Mechanism(Input::Velocity(k)) => of(a.v, k),
        Source::Mechanism(Input::Function {
            function,
            derivative,
        }) => jets.get(function).map_or(f64::NAN, |jet| jet[derivative]),
        Source::Rhs(k) => of(a.rhs, k),
        Source::Number(_) => f64::NAN,
    }
}

impl SceneCode for Tape {
    fn spec(&self) -> &CodeSpec {
        &self.spec
    }

    fn inputs(&self) -> Option<&CodeInputs> {
        self.inputs.as_ref()
    }

    fn with_inputs(&self, values: &[f64]) -> Option<Arc<dyn SceneCode>> {
        if self.inputs.as_ref()?.list.len() != values.len() {
            return None;
        }
        let mut tape = self.clone();
        tape.values = values.to_vec();
        for (f, places) in tape.times.iter_mut().zip(&self.numbers_of_times) {
            let mut numbers = f.numbers();
            for (number, input) in numbers.iter_mut().zip(places) {
                if let Some(k) = input {
                    *number = values[*k];
                }
            }
            *f = f.with_numbers(&numbers)?;
        }
        Some(Arc::new(tape))
    }

    fn acceleration(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> f64 {
        let arguments = Arguments {
            t,
            q,
            v,
            ..Arguments::default()
        };
        self.run("acceleration", arguments, a)
    }

    fn multipliers(&self, t: f64, q: &[f64], v: &[f64], lambda: &mut [f64]) -> f64 {
        let arguments = Arguments {
            t,
            q,
            v,
            ..Arguments::default()
        };
        self.run("multipliers", arguments, lambda)
    }

    fn phi(&self, t: f64, q: &[f64], phi: &mut [f64]) {
        let arguments = Arguments {
            t,
            q,
            ..Arguments::default()
        };
        self.run("phi", arguments, phi);
    }

    fn velocity_residual(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        let arguments = Arguments {
            t,
            q,
            v,
            ..Arguments::default()
        };
        self.run("velocity_residual", arguments, out);
    }

    fn position_correction(&self, t: f64, q: &[f64], phi: &[f64], dq: &mut [f64]) -> f64 {
        let arguments = Arguments {
            t,
            q,
            rhs: phi,
            ..Arguments::default()
        };
        self.run("position_correction", arguments, dq)
    }

    fn velocity_correction(&self, t: f64, q: &[f64], residual: &[f64], dv: &mut [f64]) -> f64 {
        let arguments = Arguments {
            t,
            q,
            rhs: residual,
            ..Arguments::default()
        };
        self.run("velocity_correction", arguments, dv)
    }
}
