//! Straight-line code as a list of instructions on storage places. The list is executed for several
//! states at once, so that each instruction is read only once for all states. The results for a
//! state do not depend on the values of the other states, not even in the last bit.
//!
//! If a product is used only once, in a sum or a difference, the two operations become one
//! instruction. Each operation is rounded separately. A storage place is used again when its value
//! is no longer needed, so that all values fit in the nearest cache.

use std::array::from_fn;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

use model::record::Input;
use symbolic::{Binary, Function, Number as _, Op, Program, Value};

use crate::equations::Source;

/// Index of a storage place. An index cannot exceed [`PLACES`], so indices are not checked.
pub(super) type Place = u16;

/// Number of storage places. A list uses the first places.
pub(super) const PLACES: usize = 1 << 16;

/// Operands and result of `c ± a·b`. The expression is rounded after the product and after the sum.
/// Each sum, difference and product of a program has this form. A sum has the factor b = 1, and a
/// product has c = −0; neither changes any bit.
#[derive(Clone, Copy, Debug)]
struct Sum {
    a: Place,
    b: Place,
    c: Place,
    to: Place,
}

/// The signs of the terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Signs {
    /// `c + a·b`
    Plus,
    /// `c − a·b`
    Minus,
    /// `a·b − c`
    Reversed,
}

/// Instructions that are executed in sequence.
#[derive(Clone, Debug)]
enum Do {
    Sums(Signs, Vec<Sum>),
    Div { a: Place, b: Place, to: Place },
    Call { f: Function, a: Place, to: Place },
}

/// One function as a list of instructions.
#[derive(Default)]
pub(super) struct List {
    /// Coordinates, each with its storage place. The next two lists contain the entries of the
    /// second argument, and the inputs of an operation list.
    pub(super) coordinates: Vec<(usize, Place)>,
    pub(super) with: Vec<(usize, Place)>,
    pub(super) numbers: Vec<(usize, Place)>,
    /// Functions of time, each with the storage places of its value and derivatives.
    pub(super) functions: Vec<(usize, Vec<(usize, Place)>)>,
    /// Coordinates, each with the storage places of its cosine and sine.
    pub(super) angles: Vec<(usize, [Option<Place>; 2])>,
    /// Bodies in space. For each body, the list contains entries of the rotation matrix (by rows)
    /// and the storage places of these entries.
    pub(super) rotations: Vec<(usize, Vec<(usize, Place)>)>,
    constants: Vec<(f64, Place)>,
    steps: Vec<Do>,
    /// Storage places of the results.
    pub(super) out: Vec<Place>,
    /// Storage places of the relative sizes of divisors.
    pub(super) shares: Vec<Place>,
}

impl List {
    /// Creates the list of a program. The first `n_out` outputs are results, and the other outputs
    /// are relative sizes of divisors; `sources` contains the sources of the inputs. Returns `None`
    /// if the list needs too many storage places.
    pub(super) fn new(program: &Program, sources: &[Source], n_out: usize) -> Option<Self> {
        let mut made = Maker::new(program)?;
        let mut list = Self::default();
        // Inputs and constants are set before the first step, so each input and each constant needs
        // a separate storage place.
        for (k, op) in program.ops().iter().enumerate() {
            match op {
                Op::Input(s) => {
                    let place = made.take(k)?;
                    list.input(sources[s.index()], place);
                }
                Op::Number(bits) => {
                    let place = made.take(k)?;
                    list.constants.push((f64::from_bits(*bits), place));
                }
                _ => {}
            }
        }
        list.constants.extend([(1.0, ONE), (-0.0, NOTHING)]);
        for k in order(program, &made.joined) {
            made.step(k, &mut list.steps)?;
        }
        let outputs = program.outputs().iter();
        list.out = outputs.map(|v| made.of(*v)).collect();
        list.shares = list.out.split_off(n_out);
        Some(list)
    }

    fn input(&mut self, source: Source, place: Place) {
        match source {
            Source::Mechanism(Input::Coordinate(k)) => self.coordinates.push((k, place)),
            Source::Mechanism(Input::Velocity(k)) | Source::Rhs(k) => self.with.push((k, place)),
            Source::Number(k) => self.numbers.push((k, place)),
            Source::Mechanism(Input::Function {
                function,
                derivative,
            }) => of(&mut self.functions, function).push((derivative, place)),
            Source::Mechanism(Input::Cos(k)) => of(&mut self.angles, k)[0] = Some(place),
            Source::Mechanism(Input::Sin(k)) => of(&mut self.angles, k)[1] = Some(place),
            Source::Mechanism(Input::Rotation { body, row, column }) => {
                of(&mut self.rotations, body).push((3 * row + column, place));
            }
        }
    }

    /// Executes all steps for L states. The storage places of the inputs must contain the values of
    /// the inputs.
    #[inline(always)]
    pub(super) fn execute<const L: usize>(&self, places: &mut [[f64; L]; PLACES]) {
        for &(x, to) in &self.constants {
            places[usize::from(to)] = [x; L];
        }
        for step in &self.steps {
            match step {
                Do::Sums(Signs::Plus, sums) => each(sums, places, |ab, c| c + ab),
                Do::Sums(Signs::Minus, sums) => each(sums, places, |ab, c| c - ab),
                Do::Sums(Signs::Reversed, sums) => each(sums, places, |ab, c| ab - c),
                &Do::Div { a, b, to } => {
                    let [a, b] = [a, b].map(|k| places[usize::from(k)]);
                    places[usize::from(to)] = from_fn(|l| a[l] / b[l]);
                }
                &Do::Call { f, a, to } => {
                    places[usize::from(to)] = places[usize::from(a)].map(|a| a.call(f));
                }
            }
        }
    }
}

/// Returns the entry of a key in the list; adds a new entry if the key is missing.
fn of<T: Default>(list: &mut Vec<(usize, T)>, key: usize) -> &mut T {
    let known = list.iter().position(|(at, _)| *at == key);
    let known = known.unwrap_or_else(|| {
        list.push((key, T::default()));
        list.len() - 1
    });
    &mut list[known].1
}

/// Executes sums with the same signs in sequence.
#[inline(always)]
fn each<const L: usize>(
    sums: &[Sum],
    places: &mut [[f64; L]; PLACES],
    f: impl Fn(f64, f64) -> f64,
) {
    for sum in sums {
        let [a, b, c] = [sum.a, sum.b, sum.c].map(|k| places[usize::from(k)]);
        places[usize::from(sum.to)] = from_fn(|l| f(a[l] * b[l], c[l]));
    }
}

/// The storage place of the constant 1.
const ONE: Place = 0;
/// The storage place of the constant −0.
const NOTHING: Place = 1;

/// State of the conversion of a program to a list.
struct Maker<'p> {
    program: &'p Program,
    /// For each value, its storage place, if it has one.
    places: Vec<Option<Place>>,
    /// For each value, the number of remaining uses in later operations and as an output.
    reads: Vec<usize>,
    /// For each product, whether it is combined with the sum that uses it.
    joined: Vec<bool>,
    free: Vec<Place>,
    /// Number of storage places used so far.
    count: usize,
}

impl<'p> Maker<'p> {
    fn new(program: &'p Program) -> Option<Self> {
        let ops = program.ops();
        let reads = program.uses();
        let mut joined = vec![false; ops.len()];
        for op in ops {
            if let Op::Binary(Binary::Add | Binary::Sub, a, b) = *op {
                let is_own = |v: &Value| reads[v.index()] == 1 && factors(program, *v).is_some();
                if let Some(product) = [a, b].into_iter().find(is_own) {
                    joined[product.index()] = true;
                }
            }
        }
        Some(Self {
            program,
            places: vec![None; ops.len()],
            reads,
            joined,
            free: Vec::new(),
            count: usize::from(NOTHING) + 1,
        })
    }

    /// Assigns a free storage place to a value; returns `None` if there is no free one.
    fn take(&mut self, k: usize) -> Option<Place> {
        let place = match self.free.pop() {
            Some(place) => place,
            None => {
                self.count += 1;
                Place::try_from(self.count - 1).ok()?
            }
        };
        self.places[k] = Some(place);
        Some(place)
    }

    fn of(&self, v: Value) -> Place {
        self.places[v.index()].expect("operands precede their uses")
    }

    /// Returns the storage place of a value for reading; the place becomes free after the last use.
    fn read(&mut self, v: Value) -> Place {
        let place = self.of(v);
        self.reads[v.index()] -= 1;
        let is_constant = self.program.as_number(v).is_some();
        if self.reads[v.index()] == 0 && !is_constant {
            self.free.push(place);
        }
        place
    }

    /// Adds the step for an operation. Returns `None` if there is no free storage place.
    fn step(&mut self, k: usize, steps: &mut Vec<Do>) -> Option<()> {
        let signs = signs(self.program, &self.joined, k);
        let (a, b, c) = match self.program.ops()[k] {
            Op::Input(_) | Op::Number(_) => return Some(()),
            Op::Call(f, a) => {
                let a = self.read(a);
                let to = self.take(k)?;
                steps.push(Do::Call { f, a, to });
                return Some(());
            }
            Op::Binary(Binary::Div, a, b) => {
                let (a, b) = (self.read(a), self.read(b));
                let to = self.take(k)?;
                steps.push(Do::Div { a, b, to });
                return Some(());
            }
            Op::Neg(a) => (self.read(a), ONE, NOTHING),
            Op::Binary(Binary::Mul, a, b) => (self.read(a), self.read(b), NOTHING),
            Op::Binary(_, a, b) => {
                let (product, other) = if self.joined[a.index()] {
                    (a, b)
                } else {
                    (b, a)
                };
                let (a, b) = match factors(self.program, product) {
                    Some((a, b)) if self.joined[product.index()] => (self.read(a), self.read(b)),
                    _ => (self.read(product), ONE),
                };
                (a, b, self.read(other))
            }
        };
        let to = self.take(k)?;
        let sum = Sum { a, b, c, to };
        match steps.last_mut() {
            Some(Do::Sums(last, sums)) if *last == signs => sums.push(sum),
            _ => steps.push(Do::Sums(signs, vec![sum])),
        }
        Some(())
    }
}

/// Returns the signs of a sum, difference or product.
fn signs(program: &Program, joined: &[bool], k: usize) -> Signs {
    match program.ops()[k] {
        Op::Binary(Binary::Sub, a, _) if joined[a.index()] => Signs::Reversed,
        Op::Binary(Binary::Sub, ..) | Op::Neg(_) => Signs::Minus,
        _ => Signs::Plus,
    }
}

/// Number of instructions until the result of an instruction is available in a processor. Other
/// instructions should be executed during this time.
const LATENCY: usize = 5;

/// Returns the operations in an order in which operations of the same kind are adjacent and as few
/// operations as possible wait for the result of another operation. Among the operations that need
/// not wait, the operation with the longest chain of dependent operations comes first. Inputs,
/// constants and products that are combined with sums are omitted.
fn order(program: &Program, joined: &[bool]) -> Vec<usize> {
    let ops = program.ops();
    let is_step = |k: usize| !joined[k] && !matches!(ops[k], Op::Input(_) | Op::Number(_));
    let operands = |k: usize| {
        let own = ops[k].operands();
        let opened = own.flat_map(|v| {
            let (a, b) = match factors(program, v) {
                Some((a, b)) if joined[v.index()] => (a, Some(b)),
                _ => (v, None),
            };
            [Some(a), b].into_iter().flatten()
        });
        opened.map(Value::index).filter(|k| is_step(*k))
    };
    let mut chain = vec![0_usize; ops.len()];
    let mut readers: Vec<Vec<usize>> = vec![Vec::new(); ops.len()];
    let mut missing = vec![0_usize; ops.len()];
    for k in (0..ops.len()).rev().filter(|k| is_step(*k)) {
        for of in operands(k) {
            chain[of] = chain[of].max(chain[k] + 1);
            readers[of].push(k);
            missing[k] += 1;
        }
    }
    let kind = |k: usize| match ops[k] {
        Op::Binary(Binary::Div, ..) => 3,
        Op::Call(..) => 4,
        _ => signs(program, joined, k) as usize,
    };
    let steps: Vec<usize> = (0..ops.len()).filter(|k| is_step(*k)).collect();
    let mut ready: [BinaryHeap<(usize, Reverse<usize>)>; 5] = Default::default();
    // Operations whose operands are not yet available, with the time at which the operands become
    // available.
    let mut waiting: BinaryHeap<Reverse<(usize, usize)>> = BinaryHeap::new();
    let mut from = vec![0_usize; ops.len()];
    waiting.extend(
        steps
            .iter()
            .filter(|k| missing[**k] == 0)
            .map(|k| Reverse((0, *k))),
    );
    let (mut now, mut last) = (0, 0);
    let mut order = Vec::with_capacity(steps.len());
    while order.len() < steps.len() {
        while let Some(&Reverse((time, k))) = waiting.peek()
            && (time <= now || ready.iter().all(BinaryHeap::is_empty))
        {
            waiting.pop();
            now = now.max(time);
            ready[kind(k)].push((chain[k], Reverse(k)));
        }
        if ready[last].is_empty() {
            let longest = (0..ready.len()).max_by_key(|kind| ready[*kind].peek().map(|(c, _)| *c));
            last = longest.unwrap_or(0);
        }
        let Some((_, Reverse(k))) = ready[last].pop() else {
            break;
        };
        order.push(k);
        now += 1;
        for &reader in &readers[k] {
            from[reader] = from[reader].max(now - 1 + LATENCY);
            missing[reader] -= 1;
            if missing[reader] == 0 {
                waiting.push(Reverse((from[reader], reader)));
            }
        }
    }
    order
}

/// Returns the factors of a product; `None` for other operations.
fn factors(program: &Program, v: Value) -> Option<(Value, Value)> {
    match program.op(v) {
        Op::Binary(Binary::Mul, a, b) => Some((a, b)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use symbolic::Graph;

    use super::*;

    /// Returns a program of 400 operations of all kinds on 12 inputs, from pseudo-random numbers.
    /// It contains sums of products, products that are used twice, constants, roots, and results
    /// that are inputs.
    fn program(seed: u64) -> (Program, Vec<Source>) {
        let mut state = seed;
        let mut draw = |n: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % n
        };
        let (mut names, mut p) = (Graph::new(), Program::empty());
        let mut values = Vec::new();
        for k in 0..12 {
            let name = names.symbol(&format!("x{k}"));
            values.push(p.input(names.as_symbol(name).expect("a symbol")));
        }
        let sources = (0..12).map(|k| Source::Mechanism(Input::Coordinate(k)));
        for _ in 0..400 {
            // Recent values are preferred, so that chains are long.
            let mut of = |values: &[Value]| {
                let last = values.len().min(20);
                values[values.len() - 1 - draw(last)]
            };
            let (a, b) = (of(&values), of(&values));
            let made = match draw(12) {
                0..4 => p.mul(a, b),
                4..7 => p.add(a, b),
                7..9 => p.sub(a, b),
                9 => {
                    let (x, one) = (p.mul(b, b), p.number(1.5));
                    let below = p.add(x, one);
                    p.div(a, below)
                }
                10 => {
                    let x = p.mul(a, a);
                    p.call(Function::Sqrt, x)
                }
                _ => {
                    let x = p.number(0.25);
                    let product = p.mul(x, a);
                    p.neg(product)
                }
            };
            // Values are reduced to a similar size, so that no value overflows.
            let (one, square) = (p.number(1.0), p.mul(made, made));
            let size = p.add(one, square);
            values.push(p.div(made, size));
        }
        let outputs: Vec<Value> = values.iter().rev().step_by(3).copied().collect();
        (p.with_outputs(&outputs), sources.collect())
    }

    /// The references are single evaluations of the operations of the program. The values of the
    /// inputs differ from state to state.
    #[test]
    fn lists_are_their_programs_bit_for_bit() {
        const L: usize = 8;
        for seed in 0..50 {
            let (program, sources) = program(seed);
            let n_out = program.outputs().len();
            let list = List::new(&program, &sources, n_out).expect("places");
            let input = |k: usize, l: usize| (1.3 * k as f64 + 0.7 * l as f64 + seed as f64).sin();
            let mut places: Box<[[f64; L]; PLACES]> = vec![[0.0; L]; PLACES]
                .into_boxed_slice()
                .try_into()
                .expect("so many");
            for (k, place) in &list.coordinates {
                places[usize::from(*place)] = from_fn(|l| input(*k, l));
            }
            list.execute(&mut places);
            for l in 0..L {
                let expected = program.run(|s| input(s.index(), l));
                let found = list.out.iter().map(|place| places[usize::from(*place)][l]);
                for (found, expected) in found.zip(expected) {
                    assert_eq!(
                        found.to_bits(),
                        expected.to_bits(),
                        "{seed}: {found} {expected}"
                    );
                }
            }
        }
    }

    /// Each operation comes after its operands, no operation is missing, and no storage place is
    /// used again while its value is needed.
    #[test]
    fn places_are_used_again() {
        let (program, sources) = program(7);
        let list = List::new(&program, &sources, program.outputs().len()).expect("places");
        let sums = list.steps.iter().filter_map(|step| match step {
            Do::Sums(_, sums) => Some(sums.len()),
            _ => None,
        });
        let places = list.steps.iter().flat_map(|step| match step {
            Do::Sums(_, sums) => sums.iter().map(|sum| sum.to).collect(),
            Do::Div { to, .. } | Do::Call { to, .. } => vec![*to],
        });
        let most = places.max().map_or(0, usize::from);
        let counts = program.counts();
        let sums: usize = sums.sum();
        assert!(most < counts.total() / 2, "{most} places for {counts}");
        assert!(
            sums <= counts.mul + counts.add + counts.neg,
            "{sums} for {counts}"
        );
        assert!(sums >= counts.mul.max(counts.add), "{sums} for {counts}");
    }
}
