//! Computes C and Γ of the robot with dual numbers. Each joint computes Φ, or the velocity that a
//! knife edge prevents, and `num-dual` differentiates this value. This is the best case for the
//! method: it differentiates with respect to the six coordinates of one joint instead of all
//! coordinates, the compiler has all sizes, and no heap is used.

use model::{Function, Mechanism};
use nalgebra::SVector;
use num_dual::{Dual2_64, Dual64, DualNum, gradient, jacobian};

/// Number types for the equations of joints.
trait Number: DualNum<Primitive = f64> + Copy {}
impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

/// Bodies and positions of the revolute joints A … G at the initial state, at which all frames are
/// parallel.
const REVOLUTES: [(usize, usize, [f64; 2]); 7] = [
    (0, 6, [-0.4, 0.0]),
    (0, 1, [0.3, 0.0]),
    (0, 2, [-0.3, 0.0]),
    (1, 3, [0.21, 0.05]),
    (2, 4, [-0.21, 0.05]),
    (3, 5, [0.2, -0.2]),
    (4, 5, [-0.2, -0.2]),
];

/// Body and position of each of the knife edges W1 … W5. The normal of a knife edge is the y-axis
/// of its body.
const EDGES: [(usize, [f64; 2]); 5] = [
    (1, [0.3, 0.0]),
    (2, [-0.3, 0.0]),
    (0, [0.0, -0.2]),
    (0, [0.0, 0.2]),
    (6, [-0.8, 0.0]),
];

/// Platform, slider, and the point at which the joint H and its drive connect them.
const SLIDE: (usize, usize, [f64; 2]) = (0, 5, [0.0, -0.2]);

/// Number of columns and number of rows of C.
const COLUMNS: usize = 21;
const ROWS: usize = 22;

/// The robot with its joints in body frames.
pub(crate) struct DualRobot {
    revolutes: [(usize, usize, [[f64; 2]; 2]); 7],
    slide: (usize, usize, [[f64; 2]; 2]),
    edges: [(usize, [f64; 2]); 5],
    drive: Function,
}

impl DualRobot {
    /// Reads the initial positions of the bodies from the mechanism.
    pub(crate) fn new(mechanism: &Mechanism, drive: Function) -> Self {
        let (q, _) = mechanism.described_state();
        let local = |body: usize, [x, y]: [f64; 2]| [x - q[3 * body], y - q[3 * body + 1]];
        let pair = |(i, j, at)| (i, j, [local(i, at), local(j, at)]);
        Self {
            revolutes: REVOLUTES.map(pair),
            slide: pair(SLIDE),
            edges: EDGES.map(|(body, at)| (body, local(body, at))),
            drive,
        }
    }

    /// Writes C by rows, then Γ.
    pub(crate) fn c_and_gamma(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        let (c, gamma) = out.split_at_mut(ROWS * COLUMNS);
        c.fill(0.0);
        let along = |b: usize| -> [Dual2_64; 3] {
            std::array::from_fn(|k| Dual2_64::new(q[3 * b + k], v[3 * b + k], 0.0))
        };
        let mut row = 0;
        for &(i, j, s) in &self.revolutes {
            let (_, d) = jacobian(|x| SVector::from(revolute(&halves(&x), s)), &both(q, i, j));
            for (k, r) in d.row_iter().enumerate() {
                spread(r.iter(), [i, j], &mut c[(row + k) * COLUMNS..][..COLUMNS]);
            }
            let phi = revolute(&[along(i), along(j)], s);
            phi.iter()
                .zip(&mut gamma[row..])
                .for_each(|(phi, gamma)| *gamma = -phi.v2);
            row += 2;
        }
        let (i, j, s) = self.slide;
        let [f, fd, fdd] = self.drive.jet(t);
        let (_, d) = jacobian(
            |x| SVector::from(slide(&halves(&x), s, f.into())),
            &both(q, i, j),
        );
        for (k, r) in d.row_iter().enumerate() {
            spread(r.iter(), [i, j], &mut c[(row + k) * COLUMNS..][..COLUMNS]);
        }
        let phi = slide(&[along(i), along(j)], s, Dual2_64::new(f, fd, fdd));
        phi.iter()
            .zip(&mut gamma[row..])
            .for_each(|(phi, gamma)| *gamma = -phi.v2);
        row += 3;
        for &(i, s) in &self.edges {
            let fixed = |k: usize| q[3 * i + k];
            let velocity = SVector::<f64, 3>::from_fn(|k, _| v[3 * i + k]);
            let (_, d) = gradient(|v| sideways(fixed(2).into(), &v.into(), s), &velocity);
            c[row * COLUMNS + 3 * i..][..3].copy_from_slice(d.as_slice());
            let turning = Dual64::new(fixed(2), v[3 * i + 2]);
            let velocity = velocity.map(Dual64::from);
            gamma[row] = -sideways(turning, &velocity.into(), s).eps;
            row += 1;
        }
    }
}

/// Returns the coordinates of two bodies.
fn both(q: &[f64], i: usize, j: usize) -> SVector<f64, 6> {
    SVector::from_fn(|k, _| {
        if k < 3 {
            q[3 * i + k]
        } else {
            q[3 * j + k - 3]
        }
    })
}

fn halves<D: Number>(x: &SVector<D, 6>) -> [[D; 3]; 2] {
    [[x[0], x[1], x[2]], [x[3], x[4], x[5]]]
}

/// Writes six derivatives into a row of C.
fn spread<'d>(d: impl Iterator<Item = &'d f64>, bodies: [usize; 2], row: &mut [f64]) {
    for (k, d) in d.enumerate() {
        row[3 * bodies[k / 3] + k % 3] = *d;
    }
}

fn point<D: Number>(x: &[D; 3], s: [f64; 2]) -> [D; 2] {
    let (sin, cos) = x[2].sin_cos();
    [
        x[0] + cos * s[0] - sin * s[1],
        x[1] + sin * s[0] + cos * s[1],
    ]
}

/// Requires that the two points coincide.
fn revolute<D: Number>(x: &[[D; 3]; 2], s: [[f64; 2]; 2]) -> [D; 2] {
    let (i, j) = (point(&x[0], s[0]), point(&x[1], s[1]));
    [i[0] - j[0], i[1] - j[1]]
}

/// Requires that the second point is on the y-axis of the first body, both bodies are parallel, and
/// the displacement is f.
fn slide<D: Number>(x: &[[D; 3]; 2], s: [[f64; 2]; 2], f: D) -> [D; 3] {
    let (i, j) = (point(&x[0], s[0]), point(&x[1], s[1]));
    let (sin, cos) = x[0][2].sin_cos();
    let d = [j[0] - i[0], j[1] - i[1]];
    [
        -(cos * d[0] + sin * d[1]),
        x[1][2] - x[0][2],
        cos * d[1] - sin * d[0] - f,
    ]
}

/// Returns the velocity of a point along the y-axis of its body.
fn sideways<D: Number>(angle: D, v: &[D; 3], s: [f64; 2]) -> D {
    let (sin, cos) = angle.sin_cos();
    cos * v[1] - sin * v[0] + v[2] * s[0]
}
