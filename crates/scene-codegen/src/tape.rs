//! The same code without a compiler: lists of instructions that are executed for one state, or for
//! several states at once. These states may belong to runs with different values of the inputs.
//! Operation lists are used for scenes that are read at run time, for sweeps, and for tests of runs
//! with generated code.

mod list;

use std::array::from_fn;
use std::cell::RefCell;
use std::sync::Arc;

use dynamics::code::{CodeFunction, CodeInput, CodeInputs, CodeSpec, SharedCode};
use dynamics::{CodeMismatch, SceneCode};
use model::record::TimeFunction;
use model::{Mechanism, SpaceKind, System};

use crate::error::CodeError;
use crate::functions::{Functions, LIMIT};
use crate::subject::Subject;
use list::{List, PLACES, Place};

include!("support/cos_sin.in");
include!("support/rotation.in");

/// Number of states that are evaluated together (a SIMD batch). The values of one batch have the
/// length of one cache line.
pub const LANES: usize = 8;

/// The code of one mechanism as lists of operations.
///
/// ```
/// use std::sync::Arc;
/// use pfaff::{RunOptions, Study};
/// use pfaff_scene_codegen::{Subject, Tape};
/// let scene = r#"
/// scene = { name = "pendulum", space = "plane", gravity = [0.0, -10.0] }
/// body = [{ name = "bob", mass = 1.0, inertia = 0.0, position = [2.0, 0.0] }]
/// joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] }]
/// "#;
/// let registry = pfaff::model::Registry::standard();
/// let mut study = Study::read("pendulum.toml", scene, &registry, &RunOptions::default())?;
/// let tape = Tape::of(&Subject::at_start(&study.prepared))?;
/// study.prepared = study.prepared.with_code(Arc::new(tape))?; // its runs are on the tape from now on
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Tape {
    spec: Arc<CodeSpec>,
    /// Lists in the order of [`CodeFunction::ALL`].
    lists: Arc<[List]>,
    times: Arc<[TimeFunction]>,
    /// For each parameter of each function of time, the index of the input that replaces it.
    numbers_of_times: Arc<[Vec<Option<usize>>]>,
    /// The values of the mechanism that are inputs, and their current values.
    inputs: Option<Arc<CodeInputs>>,
    values: Arc<[f64]>,
    space: SpaceKind,
}

/// A call of a function of an operation list for one of several runs, with the values of its
/// inputs. The next call overwrites the arrays.
pub struct TapeCall {
    /// The operation list.
    pub tape: Tape,
    /// Time (s).
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities or residuals, depending on the function.
    pub with: Vec<f64>,
    /// The results.
    pub out: Vec<f64>,
    /// Smallest relative size of the divisors, for functions with divisions.
    pub health: f64,
}

impl TapeCall {
    /// Creates a call of an operation list; the arguments are set later.
    #[must_use]
    pub fn new(tape: Tape) -> Self {
        Self {
            tape,
            t: 0.0,
            q: Vec::new(),
            with: Vec::new(),
            out: Vec::new(),
            health: f64::NAN,
        }
    }

    /// Sets the arguments, and allocates memory for this number of results.
    pub fn set(&mut self, t: f64, q: &[f64], with: &[f64], results: usize) {
        self.t = t;
        for (to, from) in [(&mut self.q, q), (&mut self.with, with)] {
            to.clear();
            to.extend_from_slice(from);
        }
        self.out.clear();
        self.out.resize(results, f64::NAN);
    }
}

/// A state with memory for the results.
trait Evaluation {
    fn tape(&self) -> &Tape;
    fn t(&self) -> f64;
    fn q(&self) -> &[f64];
    fn with(&self) -> &[f64];
    fn take(&mut self, health: f64, out: impl Iterator<Item = f64>);
}

impl Evaluation for Box<TapeCall> {
    fn tape(&self) -> &Tape {
        &self.tape
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn q(&self) -> &[f64] {
        &self.q
    }

    fn with(&self) -> &[f64] {
        &self.with
    }

    fn take(&mut self, health: f64, out: impl Iterator<Item = f64>) {
        self.health = health;
        self.out.iter_mut().zip(out).for_each(|(to, x)| *to = x);
    }
}

/// A single evaluation that uses arrays of the caller.
struct Alone<'a> {
    tape: &'a Tape,
    t: f64,
    q: &'a [f64],
    with: &'a [f64],
    out: &'a mut [f64],
    health: f64,
}

impl Evaluation for Alone<'_> {
    fn tape(&self) -> &Tape {
        self.tape
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn q(&self) -> &[f64] {
        self.q
    }

    fn with(&self) -> &[f64] {
        self.with
    }

    fn take(&mut self, health: f64, out: impl Iterator<Item = f64>) {
        self.health = health;
        self.out.iter_mut().zip(out).for_each(|(to, x)| *to = x);
    }
}

/// Storage places of a list, for L states. Storage places that are not used need no memory.
type Places<const L: usize> = Box<[[f64; L]; PLACES]>;

/// Allocates zeros directly on the heap.
fn places<const L: usize>() -> Places<L> {
    let all = vec![[0.0; L]; PLACES].into_boxed_slice();
    all.try_into()
        .unwrap_or_else(|_| unreachable!("of this length"))
}

thread_local! {
    static ONE: RefCell<Places<1>> = RefCell::new(places());
    static MANY: RefCell<Places<LANES>> = RefCell::new(places());
}

impl Tape {
    /// Generates the code of a subject.
    ///
    /// # Errors
    /// Returns the same errors as [`crate::generate`].
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
        let lists = CodeFunction::ALL.iter().filter_map(|function| {
            let f = list.iter().find(|f| f.signature.name == function.name())?;
            let made = List::new(&f.program, &equations.sources, f.n_out);
            Some(made.ok_or_else(|| CodeError::TooLong {
                operations: f.program.counts().total(),
                limit: LIMIT,
            }))
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
        let numbers_of_times = equations.recording.beside.functions.iter();
        let list_of_inputs = inputs.list.iter().map(|p| CodeInput {
            name: p.name.clone().into(),
            described: p.described,
            places: p.places.clone().into(),
        });
        Ok(Self {
            spec: Arc::new(spec),
            lists: lists.collect::<Result<_, _>>()?,
            times: times.cloned().collect(),
            numbers_of_times: numbers_of_times
                .map(|numbers| numbers.iter().map(|r| inputs.at(r.place())).collect())
                .collect(),
            values: inputs.described().into(),
            inputs: (!inputs.list.is_empty()).then(|| {
                Arc::new(CodeInputs {
                    shape: inputs.shape,
                    list: list_of_inputs.collect(),
                })
            }),
            space: prepared.mechanism.space(),
        })
    }

    /// Returns the same operation list with these values of its inputs; `None` if the number of
    /// values differs.
    #[must_use]
    pub fn with_values(&self, values: &[f64]) -> Option<Self> {
        if self.values.len() != values.len() {
            return None;
        }
        let mut tape = self.clone();
        tape.values = values.into();
        let times = self.times.iter().zip(self.numbers_of_times.iter());
        let times = times.map(|(f, places)| {
            let mut numbers = f.numbers();
            for (number, input) in numbers.iter_mut().zip(places) {
                if let Some(k) = input {
                    *number = values[*k];
                }
            }
            f.with_numbers(&numbers)
        });
        tape.times = times.collect::<Option<_>>()?;
        Some(tape)
    }

    /// Returns the operation list with the values of a mechanism; these values are then no longer
    /// inputs.
    ///
    /// # Errors
    /// [`CodeMismatch`]: the mechanism has other equations.
    pub fn of_mechanism(&self, mechanism: &Mechanism) -> Result<Self, CodeMismatch> {
        let name = &self.spec.name;
        let Some(inputs) = &self.inputs else {
            return Ok(self.clone());
        };
        let values = inputs.of(name, mechanism)?;
        let found = values.len();
        let own = self.with_values(&values).map(|own| Self {
            inputs: None,
            ..own
        });
        own.ok_or_else(|| CodeMismatch::Inputs {
            name: name.to_string(),
            found,
        })
    }

    /// Evaluates a function of one operation list for several runs, each with its own values of the
    /// inputs. The results are bitwise equal to the results of single evaluations. If the operation
    /// list of a call is not a clone of the first one (with other values of the inputs), its health
    /// is NaN.
    pub fn evaluate_all(function: CodeFunction, calls: &mut [Box<TapeCall>]) {
        let Some(lists) = calls.first().map(|call| Arc::clone(&call.tape.lists)) else {
            return;
        };
        let Some(list) = lists.get(function.index()) else {
            return;
        };
        for calls in calls.chunks_mut(LANES) {
            if calls.len() == 1 {
                ONE.with_borrow_mut(|places| evaluate(list, places, calls));
            } else {
                MANY.with_borrow_mut(|places| wide(list, places, calls));
            }
            for call in calls.iter_mut() {
                if !Arc::ptr_eq(&call.tape.lists, &lists) {
                    call.health = f64::NAN;
                }
            }
        }
    }

    /// Evaluates one function and returns the smallest relative size of its divisors.
    fn run(
        &self,
        function: CodeFunction,
        t: f64,
        (q, with): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> f64 {
        let mut call = Alone {
            tape: self,
            t,
            q,
            with,
            out,
            health: f64::NAN,
        };
        if let Some(list) = self.lists.get(function.index()) {
            let calls = std::slice::from_mut(&mut call);
            ONE.with_borrow_mut(|places| evaluate(list, places, calls));
        }
        call.health
    }

    /// Returns value and derivatives of a function of time; NaN if the function does not exist.
    fn jet(&self, function: usize, t: f64) -> [f64; 3] {
        self.times.get(function).map_or([f64::NAN; 3], |f| f.jet(t))
    }
}

/// Works like [`evaluate`], with the vector instructions of the current processor.
fn wide(list: &List, places: &mut [[f64; LANES]; PLACES], calls: &mut [Box<TapeCall>]) {
    struct Task<'t> {
        list: &'t List,
        places: &'t mut [[f64; LANES]; PLACES],
        calls: &'t mut [Box<TapeCall>],
    }
    impl pulp::NullaryFnOnce for Task<'_> {
        type Output = ();

        #[inline(always)]
        fn call(self) {
            evaluate(self.list, self.places, self.calls);
        }
    }
    pulp::Arch::new().dispatch(Task {
        list,
        places,
        calls,
    });
}

/// Evaluates a list for at least one call and at most L calls. Unused places of the batch repeat
/// the first call.
#[inline(always)]
fn evaluate<const L: usize>(
    list: &List,
    places: &mut [[f64; L]; PLACES],
    calls: &mut [impl Evaluation],
) {
    let of = |x: &[f64], k: usize| x.get(k).copied().unwrap_or(f64::NAN);
    let call = |l: usize| calls.get(l).unwrap_or(&calls[0]);
    for l in 0..L {
        let call = call(l);
        let arrays = [
            (call.q(), &list.coordinates),
            (call.with(), &list.with),
            (&*call.tape().values, &list.numbers),
        ];
        for (x, read) in arrays {
            for &(k, place) in read {
                places[usize::from(place)][l] = of(x, k);
            }
        }
        for (function, derivatives) in &list.functions {
            let jet = call.tape().jet(*function, call.t());
            for &(derivative, place) in derivatives {
                places[usize::from(place)][l] = of(&jet, derivative);
            }
        }
    }
    for &(k, [cos, sin]) in &list.angles {
        let x: [f64; L] = from_fn(|l| of(call(l).q(), k));
        let (mut c, mut s) = ([0.0; L], [0.0; L]);
        if x.iter().all(|x| x.abs() < 1e6) {
            for l in 0..L {
                [c[l], s[l]] = cos_sin_of_small(x[l]);
            }
        } else {
            for l in 0..L {
                [c[l], s[l]] = cos_sin(x[l]);
            }
        }
        for (place, value) in [(cos, c), (sin, s)] {
            if let Some(place) = place {
                places[usize::from(place)] = value;
            }
        }
    }
    for (body, entries) in &list.rotations {
        let first = calls[0].tape().space.coordinates(*body).start + 3;
        let e: [[f64; L]; 4] = std::array::from_fn(|i| from_fn(|l| of(call(l).q(), first + i)));
        let mut all = [[0.0; L]; 9];
        for l in 0..L {
            let one = rotation([e[0][l], e[1][l], e[2][l], e[3][l]]);
            for (all, x) in all.iter_mut().zip(one) {
                all[l] = x;
            }
        }
        for &(entry, place) in entries {
            places[usize::from(place)] = all[entry];
        }
    }
    list.execute(places);
    for (l, call) in calls.iter_mut().enumerate() {
        let at = |&place: &Place| places[usize::from(place)][l];
        let shares = list.shares.iter().map(at);
        let health = shares.fold(f64::INFINITY, least);
        call.take(health, list.out.iter().map(at));
    }
}

/// Returns the smaller number; NaN if one of the two is NaN.
fn least(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

impl SceneCode for Tape {
    fn spec(&self) -> &CodeSpec {
        &self.spec
    }

    fn inputs(&self) -> Option<&CodeInputs> {
        self.inputs.as_deref()
    }

    fn with_inputs(&self, values: &[f64]) -> Option<Arc<SharedCode>> {
        self.inputs.as_ref()?;
        Some(Arc::new(self.with_values(values)?))
    }

    fn acceleration(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> f64 {
        self.run(CodeFunction::Acceleration, t, (q, v), a)
    }

    fn multipliers(&self, t: f64, q: &[f64], v: &[f64], lambda: &mut [f64]) -> f64 {
        self.run(CodeFunction::Multipliers, t, (q, v), lambda)
    }

    fn phi(&self, t: f64, q: &[f64], phi: &mut [f64]) {
        self.run(CodeFunction::Phi, t, (q, &[]), phi);
    }

    fn velocity_residual(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.run(CodeFunction::VelocityResidual, t, (q, v), out);
    }

    fn position_correction(&self, t: f64, q: &[f64], phi: &[f64], dq: &mut [f64]) -> f64 {
        self.run(CodeFunction::PositionCorrection, t, (q, phi), dq)
    }

    fn velocity_correction(&self, t: f64, q: &[f64], residual: &[f64], dv: &mut [f64]) -> f64 {
        self.run(CodeFunction::VelocityCorrection, t, (q, residual), dv)
    }
}
