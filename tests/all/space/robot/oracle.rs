//! The constraints of the robot in space, derived again from its drawing, and the reactions that
//! they determine: no part of this module comes from the definitions of joints or from the solvers.
//!
//! A row is the wrench that a unit multiplier exerts on the second body, and the opposite wrench on
//! the first. Smooth contacts and hinges do no work in the motions that they allow. In a twist (v
//! of the mass centre r, ω) in ground axes a wrench (F; M about the origin) has the entries (F; M −
//! r × F). Ranks are computed from singular values (nalgebra). A combination ℓᵀλ is unique if and
//! only if ℓ is in the range of C: then complete elimination of the columns of C removes it.

use nalgebra::{DMatrix, Quaternion, UnitQuaternion, Vector3};

type Vector = Vector3<f64>;

/// Bodies of the drawing by name, with their positions at the start of the scene, without rotation.
const BODIES: [(&str, [f64; 3]); 12] = [
    ("platform", [0.0, 0.0, 0.12]),
    ("front-knuckle", [0.255, 0.025, 0.09]),
    ("rear-knuckle", [-0.255, 0.025, 0.09]),
    ("front-link", [0.205, -0.075, 0.14]),
    ("rear-link", [-0.205, -0.075, 0.14]),
    ("slider", [0.0, -0.2, 0.14]),
    ("trolley", [-0.75, 0.0, 0.12]),
    ("front-wheel", [0.3, 0.0, 0.08]),
    ("rear-wheel", [-0.3, 0.0, 0.08]),
    ("right-wheel", [0.0, -0.2, 0.08]),
    ("left-wheel", [0.0, 0.2, 0.08]),
    ("trolley-wheel", [-0.8, 0.0, 0.08]),
];

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const LEFT: [f64; 3] = [0.0, 1.0, 0.0];

/// Radius of the wheels.
const RADIUS: f64 = 0.08;

/// Kind of a joint. Directions are in ground axes at the initial state of the scene.
#[derive(Clone, Copy)]
enum Kind {
    Ball,
    /// Hinge about an axis.
    Hinge([f64; 3]),
    /// Cross with an axis in the first body and one in the second.
    Cross([f64; 3], [f64; 3]),
    /// Slide along an axis.
    Slide([f64; 3]),
    /// The axial force of a slide.
    Push([f64; 3]),
    /// A wheel on the ground.
    Wheel,
}

/// Name, kind, bodies, and position at the start of the scene. A wheel has no second body.
type Joint = (&'static str, Kind, [&'static str; 2], [f64; 3]);

/// The joints in the order of the scene; the drive is the last.
const JOINTS: [Joint; 19] = [
    (
        "A",
        Kind::Cross(UP, LEFT),
        ["platform", "trolley"],
        [-0.4, 0.0, 0.12],
    ),
    (
        "B",
        Kind::Hinge(UP),
        ["platform", "front-knuckle"],
        [0.3, 0.0, 0.12],
    ),
    (
        "C",
        Kind::Hinge(UP),
        ["platform", "rear-knuckle"],
        [-0.3, 0.0, 0.12],
    ),
    (
        "D",
        Kind::Ball,
        ["front-knuckle", "front-link"],
        [0.21, 0.05, 0.14],
    ),
    (
        "E",
        Kind::Ball,
        ["rear-knuckle", "rear-link"],
        [-0.21, 0.05, 0.14],
    ),
    (
        "F",
        Kind::Cross([25.0, -1.0, 0.0], UP),
        ["front-link", "slider"],
        [0.2, -0.2, 0.14],
    ),
    (
        "G",
        Kind::Cross([25.0, 1.0, 0.0], UP),
        ["rear-link", "slider"],
        [-0.2, -0.2, 0.14],
    ),
    (
        "H",
        Kind::Slide(LEFT),
        ["platform", "slider"],
        [0.0, -0.2, 0.14],
    ),
    (
        "hub-1",
        Kind::Hinge(LEFT),
        ["front-knuckle", "front-wheel"],
        [0.3, 0.0, 0.08],
    ),
    (
        "hub-2",
        Kind::Hinge(LEFT),
        ["rear-knuckle", "rear-wheel"],
        [-0.3, 0.0, 0.08],
    ),
    (
        "hub-3",
        Kind::Hinge(LEFT),
        ["platform", "right-wheel"],
        [0.0, -0.2, 0.08],
    ),
    (
        "hub-4",
        Kind::Hinge(LEFT),
        ["platform", "left-wheel"],
        [0.0, 0.2, 0.08],
    ),
    (
        "hub-5",
        Kind::Hinge(LEFT),
        ["trolley", "trolley-wheel"],
        [-0.8, 0.0, 0.08],
    ),
    ("W1", Kind::Wheel, ["front-wheel", ""], [0.3, 0.0, 0.08]),
    ("W2", Kind::Wheel, ["rear-wheel", ""], [-0.3, 0.0, 0.08]),
    ("W3", Kind::Wheel, ["right-wheel", ""], [0.0, -0.2, 0.08]),
    ("W4", Kind::Wheel, ["left-wheel", ""], [0.0, 0.2, 0.08]),
    ("W5", Kind::Wheel, ["trolley-wheel", ""], [-0.8, 0.0, 0.08]),
    (
        "steering",
        Kind::Push(LEFT),
        ["platform", "slider"],
        [0.0, -0.2, 0.14],
    ),
];

/// Joints that are pins in the plane.
const PINS: [&str; 7] = ["A", "B", "C", "D", "E", "F", "G"];

/// Model in space of the pins of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pins {
    /// Joints as in the scene.
    Drawn,
    /// All pins are hinges with vertical axes.
    Hinges,
}

/// A position and a rotation.
struct Pose {
    place: Vector,
    turn: UnitQuaternion<f64>,
}

/// Force, and moment about the origin.
#[derive(Clone, Copy)]
struct Wrench {
    force: Vector,
    moment: Vector,
}

impl Wrench {
    fn line(at: Vector, force: Vector) -> Self {
        Self {
            force,
            moment: at.cross(&force),
        }
    }

    fn couple(moment: Vector) -> Self {
        Self {
            force: Vector::zeros(),
            moment,
        }
    }

    /// Returns the six components of the wrench, with the moment about a point.
    fn about(&self, point: Vector) -> [f64; 6] {
        let moment = self.moment - point.cross(&self.force);
        let [f, m] = [self.force, moment].map(|v| [v.x, v.y, v.z]);
        [f[0], f[1], f[2], m[0], m[1], m[2]]
    }
}

struct Row {
    joint: usize,
    is_slip: bool,
    wrench: Wrench,
}

/// The determined components at a configuration.
#[derive(Debug)]
pub(super) struct Answer {
    pub(super) rows: usize,
    /// Ranks of the rows that restrict positions, of the rows that restrict only velocities, and of
    /// all rows.
    pub(super) ranks: [usize; 3],
    /// Name of each joint, with the uniqueness of its force and of its moment about its reference
    /// point in ground axes.
    pub(super) reactions: Vec<(&'static str, [bool; 6])>,
}

/// Singular values of this matrix below `NOTHING` times its largest one count as zero, and values
/// above `SOMETHING` do not; between them there must be no value.
const NOTHING: f64 = 1e-11;
const SOMETHING: f64 = 1e-7;

fn vanishes(value: f64, what: &str) -> bool {
    assert!(
        !(NOTHING..SOMETHING).contains(&value),
        "{what}: {value:e} is neither"
    );
    value < NOTHING
}

fn rank(c: &DMatrix<f64>) -> usize {
    let values = c.singular_values();
    let largest = values.max();
    let has = |v: &&f64| !vanishes(**v / largest, "a singular value");
    values.iter().filter(has).count()
}

/// Returns two directions across a unit vector.
fn across(w: Vector) -> [Vector; 2] {
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    let least = axes.into_iter().min_by(|a, b| {
        let along = [a, b].map(|e| e.dot(&w).abs());
        along[0].total_cmp(&along[1])
    });
    let u = w.cross(&least.expect("three axes")).normalize();
    [u, w.cross(&u)]
}

/// The rows of the robot; each body has 7 coordinates, its position and its quaternion (w, x, y,
/// z).
struct Table {
    rows: Vec<Row>,
    /// The matrix C, followed by the components of all reactions: the wrench of each row about the
    /// reference point of its joint.
    numbers: DMatrix<f64>,
}

/// Number of columns of C.
const N: usize = 6 * BODIES.len();

impl Table {
    fn c(&self) -> DMatrix<f64> {
        self.numbers.columns(0, N).into_owned()
    }
}

fn table(q: &[f64], pins: Pins) -> Table {
    let poses: Vec<Pose> = q
        .chunks_exact(7)
        .map(|q| Pose {
            place: Vector::new(q[0], q[1], q[2]),
            turn: UnitQuaternion::from_quaternion(Quaternion::new(q[3], q[4], q[5], q[6])),
        })
        .collect();
    assert_eq!(poses.len(), BODIES.len());
    let index = |name: &str| BODIES.iter().position(|b| b.0 == name);
    let kind = |(name, kind, ..): &Joint| match pins {
        Pins::Hinges if PINS.contains(name) => Kind::Hinge(UP),
        _ => *kind,
    };
    // Moves a point and a direction, given at the initial state of the scene, with a body.
    let carried = |body: usize, at: [f64; 3]| {
        poses[body].place + poses[body].turn * (Vector::from(at) - Vector::from(BODIES[body].1))
    };
    let turned = |body: usize, w: [f64; 3]| poses[body].turn * Vector::from(w).normalize();

    let mut rows = Vec::new();
    let mut places = Vec::new();
    for (joint, it) in JOINTS.iter().enumerate() {
        let (_, _, bodies, at) = it;
        let first = index(bodies[0]).expect("a body");
        let second = index(bodies[1]);
        let point = carried(second.unwrap_or(first), *at);
        let mut place = carried(first, *at);
        let axes = [Vector::x(), Vector::y(), Vector::z()];
        let ball = axes.map(|e| Wrench::line(point, e));
        let mut slips = Vec::new();
        let holds = match kind(it) {
            Kind::Ball => ball.to_vec(),
            Kind::Hinge(w) => {
                let couples = across(turned(first, w)).map(Wrench::couple);
                [ball.as_slice(), &couples].concat()
            }
            Kind::Cross(a, b) => {
                let second = second.expect("two bodies");
                let couple = turned(first, a).cross(&turned(second, b));
                [ball.as_slice(), &[Wrench::couple(couple)]].concat()
            }
            Kind::Slide(w) => {
                let guides = across(turned(first, w)).map(|u| Wrench::line(point, u));
                [guides.as_slice(), &axes.map(Wrench::couple)].concat()
            }
            Kind::Push(w) => vec![Wrench::line(point, turned(first, w))],
            Kind::Wheel => {
                let axle = turned(first, LEFT);
                // The lowest point of the rim is downwards in the plane of the wheel.
                let down = -(Vector::z() - axle * axle.z).normalize();
                place = point + down * RADIUS;
                let heading = axle.cross(&Vector::z()).normalize();
                let sideways = Vector::z().cross(&heading);
                slips.extend([heading, sideways].map(|e| Wrench::line(place, e)));
                vec![Wrench::line(place, Vector::z())]
            }
        };
        let held = holds.into_iter().map(|wrench| (false, wrench));
        let slips = slips.into_iter().map(|wrench| (true, wrench));
        rows.extend(held.chain(slips).map(|(is_slip, wrench)| Row {
            joint,
            is_slip,
            wrench,
        }));
        places.push(place);
    }

    let mut numbers = DMatrix::zeros(rows.len(), N + 6 * JOINTS.len());
    for (i, row) in rows.iter().enumerate() {
        let (_, _, bodies, _) = JOINTS[row.joint];
        for (body, sign) in [(index(bodies[0]), -1.0), (index(bodies[1]), 1.0)] {
            let Some(body) = body else {
                continue;
            };
            for (k, x) in row.wrench.about(poses[body].place).iter().enumerate() {
                numbers[(i, 6 * body + k)] += sign * x;
            }
        }
        let reaction = row.wrench.about(places[row.joint]);
        for (k, x) in reaction.iter().enumerate() {
            numbers[(i, N + 6 * row.joint + k)] = *x;
        }
    }
    Table { rows, numbers }
}

/// Returns the determined components at this configuration.
pub(super) fn answer(q: &[f64], pins: Pins) -> Answer {
    let table = table(q, pins);
    let (rows, c) = (&table.rows, table.c());
    let of = |is_slip: bool| {
        let own: Vec<usize> = (0..rows.len())
            .filter(|&i| rows[i].is_slip == is_slip)
            .collect();
        rank(&c.select_rows(&own))
    };
    let ranks = [of(false), of(true), rank(&c)];
    let left = eliminated(table.numbers, N, ranks[2]);
    let reactions = JOINTS.iter().enumerate().map(|(j, joint)| {
        let unique = |k: usize| {
            let column = left.column(N + 6 * j + k);
            vanishes(column.amax(), joint.0)
        };
        (joint.0, std::array::from_fn(unique))
    });
    Answer {
        rows: table.rows.len(),
        ranks,
        reactions: reactions.collect(),
    }
}

/// Returns a basis of all loads that need no force on a body: for each joint its force and its
/// moment about its reference point in ground axes.
pub(super) fn idle_loads(q: &[f64], pins: Pins) -> Vec<Vec<(&'static str, [f64; 6])>> {
    let table = table(q, pins);
    let c = table.c();
    // Multipliers z satisfy Cᵀ·z = 0.
    let eigen = (&c * c.transpose()).symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let squares = eigen.eigenvalues.iter().enumerate();
    let idle = squares.filter(|(_, square)| square.abs() < NOTHING * largest);
    let loads = idle.map(|(k, _)| eigen.eigenvectors.column(k).transpose() * &table.numbers);
    let of_joints = |load: nalgebra::RowDVector<f64>| {
        let joint = |(j, joint): (usize, &Joint)| {
            let of = |k: usize| load[N + 6 * j + k];
            (joint.0, std::array::from_fn(of))
        };
        JOINTS.iter().enumerate().map(joint).collect()
    };
    loads.map(of_joints).collect()
}

/// Returns the remaining rows of a table after this number of pivots in its first n columns; each
/// pivot is the largest entry of all. In the first n columns all remaining entries are zero.
fn eliminated(mut table: DMatrix<f64>, n: usize, rank: usize) -> DMatrix<f64> {
    for k in 0..rank {
        let (mut at, mut largest) = ((k, k), 0.0);
        for j in 0..n {
            for i in k..table.nrows() {
                if table[(i, j)].abs() > largest {
                    (at, largest) = ((i, j), table[(i, j)].abs());
                }
            }
        }
        table.swap_rows(k, at.0);
        let pivot = table.row(k).into_owned();
        for i in k + 1..table.nrows() {
            let factor = table[(i, at.1)] / pivot[at.1];
            if factor != 0.0 {
                let rest = table.row(i) - factor * &pivot;
                table.row_mut(i).copy_from(&rest);
                table[(i, at.1)] = 0.0;
            }
        }
    }
    let left = table.rows(rank, table.nrows() - rank).into_owned();
    assert!(vanishes(left.columns(0, n).amax(), "the rest of C"));
    left
}
