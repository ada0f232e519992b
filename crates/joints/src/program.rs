//! The rows of a constraint as programs. A program is a list of additions and multiplications that
//! runs in any number type. The programs are recorded once for each kind of constraint.
//!
//! For the motion, the kernels compiled for `f64` are used. All other calculations need the rows
//! only once for each configuration: in double-double precision, with the sizes of their terms,
//! with derivatives, or as operations of generated code. These calculations use the programs, so
//! that kernels need not be compiled for them.
//!
//! The arguments of a program are in this order: the values stored by the constraint
//! ([`crate::ConstraintKernels::stored`]), the poses of the bodies, the functions of time with two
//! derivatives each, and the twists of the bodies.

use crate::element::Element;
use crate::recorded::{Operation, RecordedNumber, record};
use crate::ring::Ring;
use crate::space::Space;

/// Converts an index into the values of a program.
fn place_of(k: usize) -> u32 {
    u32::try_from(k).unwrap_or(u32::MAX)
}

/// One operation. Its operands are indices of values: first the arguments of the program, then the
/// results of the operations.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Number(f64),
    Add(u32, u32),
    Sub(u32, u32),
    Mul(u32, u32),
    Neg(u32),
}

/// One kernel as a polynomial in its arguments.
#[derive(Clone, Debug, Default, PartialEq)]
struct Program {
    given: usize,
    steps: Vec<Step>,
    /// Entries of the output that the program writes, each with the index of its value.
    written: Vec<(usize, u32)>,
}

impl Program {
    /// Creates the program of an operation list whose first operations are `given` inputs. Entries
    /// of `out` that still have the value `unwritten` do not belong to the kernel.
    fn new(
        given: usize,
        tape: &[Operation],
        out: &[RecordedNumber],
        unwritten: RecordedNumber,
    ) -> Self {
        let mut steps = Vec::new();
        let mut places: Vec<u32> = Vec::with_capacity(tape.len());
        for operation in tape {
            let at = |r: &RecordedNumber| places[r.place()];
            let step = match operation {
                Operation::Input(k) => {
                    places.push(place_of(*k));
                    continue;
                }
                Operation::Number(x) => Step::Number(*x),
                Operation::Add(a, b) => Step::Add(at(a), at(b)),
                Operation::Sub(a, b) => Step::Sub(at(a), at(b)),
                Operation::Mul(a, b) => Step::Mul(at(a), at(b)),
                Operation::Neg(a) => Step::Neg(at(a)),
                Operation::Div(..)
                | Operation::Sqrt(_)
                | Operation::RecipOrZero(_)
                | Operation::AngleOverSine(..) => {
                    unreachable!(
                        "rows are polynomials: their number types support no other functions"
                    )
                }
            };
            places.push(place_of(given + steps.len()));
            steps.push(step);
        }
        let entries = out.iter().enumerate();
        let written = entries.filter(|(_, r)| **r != unwritten);
        let written = written.map(|(k, r)| (k, places[r.place()])).collect();
        let program = Self {
            given,
            steps,
            written,
        };
        program.without_idle_steps()
    }

    /// Returns the same program without the steps that are not needed for any output.
    fn without_idle_steps(self) -> Self {
        let mut needed = vec![false; self.steps.len()];
        let step_of = |place: u32| (place as usize).checked_sub(self.given);
        for (_, place) in &self.written {
            if let Some(k) = step_of(*place) {
                needed[k] = true;
            }
        }
        for k in (0..self.steps.len()).rev() {
            if !needed[k] {
                continue;
            }
            let operands = match self.steps[k] {
                Step::Number(_) => [None, None],
                Step::Neg(a) => [Some(a), None],
                Step::Add(a, b) | Step::Sub(a, b) | Step::Mul(a, b) => [Some(a), Some(b)],
            };
            for k in operands.into_iter().flatten().filter_map(step_of) {
                needed[k] = true;
            }
        }
        let mut places: Vec<u32> = Vec::with_capacity(self.steps.len());
        let mut next = place_of(self.given);
        for &is_needed in &needed {
            places.push(next);
            next += u32::from(is_needed);
        }
        let moved = |place: u32| step_of(place).map_or(place, |k| places[k]);
        let kept = self.steps.iter().zip(&needed).filter(|(_, n)| **n);
        let steps = kept.map(|(step, _)| match *step {
            Step::Number(x) => Step::Number(x),
            Step::Add(a, b) => Step::Add(moved(a), moved(b)),
            Step::Sub(a, b) => Step::Sub(moved(a), moved(b)),
            Step::Mul(a, b) => Step::Mul(moved(a), moved(b)),
            Step::Neg(a) => Step::Neg(moved(a)),
        });
        Self {
            given: self.given,
            steps: steps.collect(),
            written: self
                .written
                .iter()
                .map(|&(k, place)| (k, moved(place)))
                .collect(),
        }
    }

    /// Runs the program with these arguments.
    fn run<T: Ring>(&self, mut values: Vec<T>, out: &mut [T]) {
        assert_eq!(values.len(), self.given, "what a program is given");
        for step in &self.steps {
            let at = |place: u32| values[place as usize];
            let value = match *step {
                Step::Number(x) => T::from(x),
                Step::Add(a, b) => at(a) + at(b),
                Step::Sub(a, b) => at(a) - at(b),
                Step::Mul(a, b) => at(a) * at(b),
                Step::Neg(a) => -at(a),
            };
            values.push(value);
        }
        for &(k, place) in &self.written {
            out[k] = values[place as usize];
        }
    }
}

/// The programs of one kind of constraint.
#[derive(Clone, Debug)]
pub struct Programs {
    /// Number of functions of time (values with derivatives) that the programs need. The caller may
    /// pass more functions.
    jets: usize,
    phi: Program,
    c_constant: Program,
    c: Program,
    b: Program,
    gamma: Program,
    component: Program,
}

/// Arguments of a program: poses, functions of time, and twists if the program depends on them.
type KernelInputs<'a, S, T> = (
    &'a [<S as Space>::Pose<T>],
    &'a [[T; 3]],
    &'a [<S as Space>::Twist<T>],
);

/// A kernel during its recording.
type Write<'w, S> = &'w dyn Fn(KernelInputs<'_, S, RecordedNumber>, &mut [RecordedNumber]);

impl Programs {
    /// Records the kernels of a constraint that stores this number of values.
    #[must_use]
    pub fn record<S: Space>(element: &impl Element<RecordedNumber, S>, stored: usize) -> Self {
        let spec = element.spec();
        let (slots, rows) = (spec.common.slots.len(), spec.rows.len());
        let functions = spec.n_jets();
        let at_rest = stored + slots * S::N_POSE + 3 * functions;
        let kernel = |given: usize, outputs: usize, write: Write<'_, S>| {
            let (tape, (out, unwritten)) = record(|| {
                let given: Vec<RecordedNumber> = (0..given).map(RecordedNumber::input).collect();
                let poses = given[stored..].chunks_exact(S::N_POSE).take(slots);
                let x: Vec<_> = poses.map(S::pose).collect();
                let jets = given[stored + slots * S::N_POSE..].chunks_exact(3);
                let jets = jets.take(functions);
                let f: Vec<[RecordedNumber; 3]> =
                    jets.map(|jet| [jet[0], jet[1], jet[2]]).collect();
                let twists = given.get(at_rest..).unwrap_or_default();
                let v: Vec<_> = twists.chunks_exact(S::N_DOF).map(S::twist).collect();
                let unwritten = RecordedNumber::from(f64::NAN);
                let mut out = vec![unwritten; outputs];
                write((&x, &f, &v), &mut out);
                (out, unwritten)
            });
            Program::new(given, &tape, &out, unwritten)
        };
        let (n_c, moving) = (spec.c.len(), at_rest + slots * S::N_DOF);
        let component = if spec.component.is_some() { rows } else { 0 };
        Self {
            jets: functions,
            phi: kernel(at_rest, spec.holonomic, &|(x, f, _), o| {
                element.phi(x, f, o);
            }),
            c_constant: kernel(at_rest, n_c, &|_, o| element.c_constant(o)),
            c: kernel(at_rest, n_c, &|(x, f, _), o| element.c(x, f, o)),
            b: kernel(at_rest, rows, &|(x, f, _), o| element.b(x, f, o)),
            gamma: kernel(moving, rows, &|(x, f, v), o| element.gamma(x, v, f, o)),
            component: kernel(at_rest, component, &|(x, f, _), o| {
                element.component(x, f, o);
            }),
        }
    }

    /// Returns the rows of a constraint that stores these values.
    #[must_use]
    pub fn of<'p, T: Ring>(&'p self, stored: &'p [T]) -> Rows<'p, T> {
        Rows {
            programs: self,
            stored,
        }
    }
}

/// The rows of one constraint in any number type, with the same outputs as the kernels of
/// [`Element`].
#[derive(Clone, Copy, Debug)]
pub struct Rows<'p, T> {
    programs: &'p Programs,
    stored: &'p [T],
}

impl<T: Ring> Rows<'_, T> {
    /// Computes Φ of the holonomic rows.
    pub fn phi<S: Space>(self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.run::<S>(&self.programs.phi, (x, f, &[]), out);
    }

    /// Computes the entries of C that depend only on parameters. The other entries do not change.
    pub fn c_constant<S: Space>(self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.run::<S>(&self.programs.c_constant, (x, f, &[]), out);
    }

    /// Computes the other entries of C.
    pub fn c<S: Space>(self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.run::<S>(&self.programs.c, (x, f, &[]), out);
    }

    /// Computes b. Scleronomic constraints write nothing.
    pub fn b<S: Space>(self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.run::<S>(&self.programs.b, (x, f, &[]), out);
    }

    /// Computes Γ.
    pub fn gamma<S: Space>(self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        self.run::<S>(&self.programs.gamma, (x, f, v), out);
    }

    /// Computes the coefficients of the named component. Writes nothing if the definition names no
    /// component.
    pub fn component<S: Space>(self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.run::<S>(&self.programs.component, (x, f, &[]), out);
    }

    fn run<S: Space>(self, program: &Program, (x, f, v): KernelInputs<'_, S, T>, out: &mut [T]) {
        if program.written.is_empty() {
            return;
        }
        let mut values = Vec::with_capacity(program.given + program.steps.len());
        values.extend_from_slice(self.stored);
        x.iter()
            .for_each(|pose| S::numbers_of_pose(pose, &mut values));
        values.extend(f.iter().take(self.programs.jets).flatten());
        values.extend(v.iter().flat_map(S::velocities));
        program.run(values, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Magnitude;

    /// The program for y = x₀·x₁ − x₁ + 2, with one step that is not needed for the output.
    fn program() -> Program {
        let (tape, (out, unwritten)) = record(|| {
            let [a, b] = [0, 1].map(RecordedNumber::input);
            let unwritten = RecordedNumber::from(f64::NAN);
            let mut out = [unwritten; 3];
            let _idle = a * a;
            out[2] = a * b - b + RecordedNumber::from(2.0);
            (out, unwritten)
        });
        Program::new(2, &tape, &out, unwritten)
    }

    #[test]
    fn a_program_runs_in_any_ring_and_writes_its_own_entries_alone() {
        let mut out = [7.0; 3];
        program().run(vec![3.0, 5.0], &mut out);
        assert_eq!(out, [7.0, 7.0, 12.0]);
        let mut sizes = [Magnitude::from(7.0); 3];
        program().run([3.0, 5.0].map(Magnitude::from).to_vec(), &mut sizes);
        assert_eq!(sizes.map(Magnitude::value), [7.0, 7.0, 22.0]);
    }

    #[test]
    fn steps_that_no_output_needs_are_left_out() {
        // The needed steps are a product, a difference, a constant and a sum.
        assert_eq!(program().steps.len(), 4);
    }
}
