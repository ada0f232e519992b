//! The equations of a mechanism as operation lists. Every kernel runs once on a number type that
//! records its operations. The result is valid only for this mechanism with its parameters and
//! initial values. Code generators for one scene use it as input.
//!
//! Every stored value of the mechanism has its own index in the recording, even if two values are
//! equal. Two mechanisms with the same [shape](RecordedEquations::shape) have the same operations
//! in the same order. Only some stored values differ, and corresponding values have the same index.

mod shape;

use joints::recorded::{Operation, RecordedNumber, record};

pub use crate::element::Input;
use crate::element::{PlacedConstraint, RecordedSlots};
pub use crate::mechanism::{FunctionForm, TimeFunction};
use crate::mechanism::{Mechanism, gyroscopic};
use crate::space::SpaceKind;
use crate::system::System;

/// The equations of one mechanism as operations on inputs.
#[derive(Clone, Debug)]
pub struct RecordedEquations {
    /// All operations. The values that are not part of the equations come last. The results below
    /// are indices of this list.
    pub tape: Vec<Operation>,
    /// Meaning of each input.
    pub inputs: Vec<Input>,
    /// Φ, m values.
    pub phi: Vec<RecordedNumber>,
    /// The rows of C, m + h; each entry has a column and a value. Entries with the same row and
    /// column must be added.
    pub c: Vec<Vec<(usize, RecordedNumber)>>,
    /// b, m + h values.
    pub b: Vec<RecordedNumber>,
    /// Γ, m + h values.
    pub gamma: Vec<RecordedNumber>,
    /// Q, n_v values, including the weight and, in space, −ω × J·ω.
    pub force: Vec<RecordedNumber>,
    /// q̇ = T(q)·v, n_q values.
    pub rate: Vec<RecordedNumber>,
    /// The generalised forces of gravity, n_v values, which are the first terms of Q.
    pub weight: Vec<RecordedNumber>,
    /// The values that are not part of the equations.
    pub beside: Beside,
    /// The form and the kind of each function of time.
    kinds: Vec<(FunctionForm, &'static str)>,
    /// The joints, drives and forces, each with the index of its first operation, in ascending
    /// order.
    pub owners: Vec<(usize, String)>,
}

/// The values of a mechanism that are not part of its equations: masses, principal axes, and
/// functions of time.
#[derive(Clone, Debug)]
pub struct Beside {
    /// The index of the first of these values in the recording.
    pub first: usize,
    /// The diagonal of M, n_v values.
    pub mass: Vec<RecordedNumber>,
    /// In space, for each body: the quaternion (w, x, y, z) from the principal axes to the axes of
    /// the body frame, if the two sets of axes differ.
    pub principal: Vec<Option<[RecordedNumber; 4]>>,
    /// The values of each function of time, in the order of [`TimeFunction::numbers`].
    pub functions: Vec<Vec<RecordedNumber>>,
}

/// Results collected while the kernels run.
struct Results {
    phi: Vec<RecordedNumber>,
    entries: Vec<RecordedNumber>,
    b: Vec<RecordedNumber>,
    gamma: Vec<RecordedNumber>,
    force: Vec<RecordedNumber>,
    rate: Vec<RecordedNumber>,
    weight: Vec<RecordedNumber>,
    owners: Vec<(usize, String)>,
}

impl Mechanism {
    /// Returns the functions of time of the joints, drives and forces, in the form used by the
    /// kernels.
    pub fn functions(&self) -> impl Iterator<Item = &TimeFunction> {
        self.elements.functions()
    }

    /// Returns the name of the first joint, drive or force whose function of time is an
    /// [expression](crate::Function::expression).
    #[must_use]
    pub fn expression_of_time(&self) -> Option<&str> {
        let elements = &self.elements;
        let groups = self.layout().groups.iter().map(|group| group.name.as_str());
        let constraints = groups.zip(elements.constraints.iter().map(|c| &c.site));
        let forces = elements.forces.iter().map(|f| (f.name.as_str(), &f.site));
        let is_expression = |k: usize| {
            let function = elements.given[k].function();
            let function = function.map(|f| f.parts().0.parts());
            matches!(function, Some(crate::function::Parts::Expression(_)))
        };
        let mut all = constraints.chain(forces);
        all.find_map(|(name, site)| site.functions.clone().any(is_expression).then_some(name))
    }
}

impl RecordedEquations {
    /// Records Φ, C, b, Γ, Q and q̇ of a mechanism in the plane or in space.
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Mechanism, RecordedEquations, record::Input};
    /// let stone = Description {
    ///     gravity: [0.0, -10.0],
    ///     bodies: vec![Body { name: "stone".into(), mass: 2.0, inertia: 1.0, ..Body::default() }],
    ///     ..Description::default()
    /// };
    /// let recording = RecordedEquations::of(&Mechanism::build(&stone).unwrap());
    /// assert_eq!(recording.inputs[3], Input::Cos(2));
    /// assert_eq!(recording.tape[recording.force[1].place()], joints::recorded::Operation::Number(-20.0));
    /// ```
    ///
    /// # Panics
    /// Panics if the space is neither [`SpaceKind::Plane`] nor [`SpaceKind::Space3`].
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Self {
        let space = mechanism.space();
        assert!(
            matches!(space, SpaceKind::Plane | SpaceKind::Space3),
            "the bodies of {space:?} have neither an angle nor a quaternion"
        );
        let layout = mechanism.layout();
        let n_functions = mechanism.elements.given.len();
        let (tape, (inputs, results, beside)) = record(|| {
            let mut list = Vec::new();
            let input = |what: Input| {
                list.push(what);
                RecordedNumber::input(list.len() - 1)
            };
            let slots = RecordedSlots::new(space, mechanism.bodies().len(), n_functions, input);
            let results = run_on(mechanism, &slots);
            (list, results, Beside::of(mechanism))
        });
        let row = |i: usize| {
            let entry = |k: usize| {
                (
                    layout.pattern.column[k],
                    results.entries[layout.pattern.entry[k]],
                )
            };
            layout.pattern.row(i).map(entry).collect()
        };
        Self {
            tape,
            inputs,
            c: (0..layout.rows()).map(row).collect(),
            phi: results.phi,
            b: results.b,
            gamma: results.gamma,
            force: results.force,
            rate: results.rate,
            weight: results.weight,
            owners: results.owners,
            beside,
            kinds: mechanism
                .functions()
                .map(|f| (f.form(), f.parts().0.parts().kind()))
                .collect(),
        }
    }

    /// Returns the value at an index, if the operation at this index is a constant.
    #[must_use]
    pub fn number(&self, place: usize) -> Option<f64> {
        match self.tape.get(place) {
            Some(Operation::Number(x)) => Some(*x),
            _ => None,
        }
    }
}

impl Beside {
    fn of(mechanism: &Mechanism) -> Self {
        let numbers = |x: &[f64]| -> Vec<RecordedNumber> { x.iter().map(|&x| x.into()).collect() };
        let first = RecordedNumber::from(0.0).place();
        let axes = mechanism.bodies().iter().map(|body| {
            let own = body.principal.as_ref()?;
            Some(own.quaternion().map(RecordedNumber::from))
        });
        Self {
            first,
            mass: numbers(mechanism.mass()),
            principal: axes.collect(),
            functions: mechanism
                .functions()
                .map(|f| numbers(&f.numbers()))
                .collect(),
        }
    }
}

fn run_on(mechanism: &Mechanism, inputs: &RecordedSlots) -> Results {
    let (layout, elements) = (mechanism.layout(), &mechanism.elements);
    let numbers = |x: &[f64]| -> Vec<RecordedNumber> { x.iter().map(|&x| x.into()).collect() };
    let zero = RecordedNumber::from(0.0);
    let mut r = Results {
        phi: vec![zero; layout.m],
        entries: numbers(&elements.entries),
        b: vec![zero; layout.rows()],
        gamma: vec![zero; layout.rows()],
        force: numbers(mechanism.weight()),
        rate: vec![zero; layout.n_q],
        weight: Vec::new(),
        owners: Vec::new(),
    };
    r.weight.clone_from(&r.force);
    let (q, v) = inputs.state();
    mechanism.space().rate(q, v, &mut r.rate);
    for (body, omega) in inputs.spins().enumerate() {
        let at = layout.space.rotations_of(body);
        let torques = gyroscopic(mechanism.moments(body), omega);
        for (force, torque) in r.force[at].iter_mut().zip(torques) {
            *force = *force + torque;
        }
    }
    let here = || RecordedNumber::from(0.0).place();
    for (c, group) in elements.constraints.iter().zip(&layout.groups) {
        r.owners.push((here(), group.name.clone()));
        record_constraint(c, inputs, &mut r);
    }
    for f in &elements.forces {
        r.owners.push((here(), f.name.clone()));
        let mut block = vec![zero; f.columns.len()];
        f.recorded_q(inputs, &mut block);
        for (column, value) in f.columns.iter().zip(block) {
            if let Some(column) = *column {
                r.force[column] = r.force[column] + value;
            }
        }
    }
    r
}

fn record_constraint(c: &PlacedConstraint, inputs: &RecordedSlots, r: &mut Results) {
    let mut own = Vec::new();
    inputs.phi(c, &mut r.phi[c.rows.holonomic.clone()]);
    if c.has_varying_entries() {
        inputs.c(c, &mut r.entries[c.entries.clone()]);
    }
    if c.depends_on_time() {
        c.rows.write(&mut r.b, &mut own, |b| inputs.b(c, b));
    }
    c.rows.write(&mut r.gamma, &mut own, |gamma| {
        inputs.gamma(c, gamma);
    });
}
