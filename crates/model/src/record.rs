//! The equations of a mechanism as operations: every kernel runs once on numbers that record the
//! operations applied to them. The result is valid for this mechanism with its parameters and
//! initial values only; generators of code for one scene start from it.

use joints::recorded::{Operation, Recorded, record};
use joints::{Pose, Twist};

use crate::description::BodyRef;
use crate::function::Function;
use crate::mechanism::{Mechanism, PlacedConstraint};
use crate::space::{Plane, Space};
use crate::system::{Site, System};

/// Meaning of an input of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// A coordinate, by its index in q.
    Coordinate(usize),
    /// The cosine of the coordinate with this index in q.
    Cos(usize),
    /// The sine of the coordinate with this index in q.
    Sin(usize),
    /// A velocity, by its index in v.
    Velocity(usize),
    /// A function of time as used by the mechanism, or a derivative of it.
    Function {
        /// Index of the function, in the order of [`Mechanism::functions`].
        function: usize,
        /// Order of the derivative: 0, 1 or 2.
        derivative: usize,
    },
}

/// The equations of one mechanism as operations on inputs.
#[derive(Clone, Debug)]
pub struct RecordedEquations {
    /// All operations; results are indices of it.
    pub tape: Vec<Operation>,
    /// Meaning of each input.
    pub inputs: Vec<Input>,
    /// Φ, m values.
    pub phi: Vec<Recorded>,
    /// C by rows, m + h: column and value; entries at the same place are to be added.
    pub c: Vec<Vec<(usize, Recorded)>>,
    /// b, m + h values.
    pub b: Vec<Recorded>,
    /// Γ, m + h values.
    pub gamma: Vec<Recorded>,
    /// Q, n_v values, including the weight.
    pub force: Vec<Recorded>,
}

/// Poses, twists and functions of time of one element.
type Arguments<'a> = (
    Vec<Pose<Recorded>>,
    Vec<Twist<Recorded>>,
    &'a [[Recorded; 3]],
);

/// Poses, twists and functions of time as inputs.
struct Inputs {
    list: Vec<Input>,
    poses: Vec<Pose<Recorded>>,
    twists: Vec<Twist<Recorded>>,
    jets: Vec<[Recorded; 3]>,
}

impl Inputs {
    fn new(bodies: usize, functions: usize) -> Self {
        let mut list = Vec::new();
        let mut input = |what: Input| {
            list.push(what);
            Recorded::input(list.len() - 1)
        };
        let poses = (0..bodies).map(|k| Pose {
            x: input(Input::Coordinate(Plane::N_V * k)),
            y: input(Input::Coordinate(Plane::N_V * k + 1)),
            angle: input(Input::Coordinate(Plane::N_V * k + 2)),
            cos: input(Input::Cos(Plane::N_V * k + 2)),
            sin: input(Input::Sin(Plane::N_V * k + 2)),
        });
        let poses = poses.collect();
        let twists = (0..bodies).map(|k| Twist {
            x: input(Input::Velocity(Plane::N_V * k)),
            y: input(Input::Velocity(Plane::N_V * k + 1)),
            omega: input(Input::Velocity(Plane::N_V * k + 2)),
        });
        let twists = twists.collect();
        let jets = (0..functions).map(|function| {
            [0, 1, 2].map(|derivative| {
                input(Input::Function {
                    function,
                    derivative,
                })
            })
        });
        let jets = jets.collect();
        Self {
            list,
            poses,
            twists,
            jets,
        }
    }

    /// Poses, twists and functions of time of an element.
    fn of(&self, site: &Site) -> Arguments<'_> {
        let twist = |b: &BodyRef| b.moving().map_or(Twist::zero(), |k| self.twists[k]);
        (
            site.poses(&self.poses),
            site.bodies.iter().map(twist).collect(),
            &self.jets[site.functions.clone()],
        )
    }
}

/// Results collected while the kernels run.
struct Results {
    phi: Vec<Recorded>,
    entries: Vec<Recorded>,
    b: Vec<Recorded>,
    gamma: Vec<Recorded>,
    force: Vec<Recorded>,
}

impl Mechanism {
    /// The functions of time of its joints, drives and forces, each with the value that is
    /// subtracted from it: f(0) for drives.
    pub fn functions(&self) -> impl Iterator<Item = (&Function, f64)> {
        self.elements.functions.iter().map(|f| f.parts())
    }
}

impl RecordedEquations {
    /// Records Φ, C, b, Γ and Q of a mechanism.
    ///
    /// ```
    /// use model::{Body, Description, Mechanism, RecordedEquations, record::Input};
    /// let stone = Description {
    ///     gravity: [0.0, -10.0],
    ///     bodies: vec![Body { name: "stone".into(), mass: 2.0, inertia: 1.0, ..Body::default() }],
    ///     ..Description::default()
    /// };
    /// let recording = RecordedEquations::of(&Mechanism::build(&stone).unwrap());
    /// assert_eq!(recording.inputs[3], Input::Cos(2));
    /// assert_eq!(recording.tape[recording.force[1].place()], joints::recorded::Operation::Number(-20.0));
    /// ```
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Self {
        let layout = mechanism.layout();
        let n_functions = mechanism.elements.functions.len();
        let (tape, (inputs, results)) = record(|| {
            let inputs = Inputs::new(mechanism.bodies().len(), n_functions);
            let results = run_on(mechanism, &inputs);
            (inputs.list, results)
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
        }
    }
}

fn run_on(mechanism: &Mechanism, inputs: &Inputs) -> Results {
    let (layout, elements) = (mechanism.layout(), &mechanism.elements);
    let numbers = |x: &[f64]| -> Vec<Recorded> { x.iter().map(|&x| x.into()).collect() };
    let zero = Recorded::from(0.0);
    let mut r = Results {
        phi: vec![zero; layout.m],
        entries: numbers(&elements.entries),
        b: vec![zero; layout.rows()],
        gamma: vec![zero; layout.rows()],
        force: numbers(mechanism.weight()),
    };
    for c in &elements.constraints {
        record_constraint(c, inputs, layout.m, &mut r);
    }
    for f in &elements.forces {
        let (x, v, jets) = inputs.of(&f.site);
        let mut block = vec![zero; f.columns.len()];
        f.element.recorded().q(&x, &v, jets, &mut block);
        for (column, value) in f.columns.iter().zip(block) {
            if let Some(column) = *column {
                r.force[column] = r.force[column] + value;
            }
        }
    }
    r
}

fn record_constraint(c: &PlacedConstraint, inputs: &Inputs, m: usize, r: &mut Results) {
    let element = c.element.recorded();
    let (x, v, f) = inputs.of(&c.site);
    let rows = c.rows.clone();
    if rows.start < m {
        element.phi(&x, f, &mut r.phi[rows.clone()]);
    }
    if !c.varying.is_empty() {
        element.c(&x, f, &mut r.entries[c.entries.clone()]);
    }
    if element.spec().rheonomic {
        element.b(&x, f, &mut r.b[rows.clone()]);
    }
    element.gamma(&x, &v, f, &mut r.gamma[rows]);
}
