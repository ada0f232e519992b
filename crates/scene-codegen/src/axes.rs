//! The axes for the components of velocities of spatial bodies in the elimination. In the
//! equations, angular velocities are in the principal axes of each body, in which the mass matrix
//! is constant. In these axes, all entries of C for a rotating hinge may become zero at the same
//! state. In the axes of the ground, or of one body (for a vehicle), most entries are zeros,
//! constants, or arms and directions that are already computed.
//!
//! The columns and the rows of C are rotated, for any joints. Products that are zero, constant or
//! already computed are found by their values, up to rounding. These values are computed at states
//! that do not satisfy the constraints, with arbitrary values of the functions of time.

use model::record::Input;
use model::{BodyRef, Mechanism, SpaceKind, System};
use symbolic::Value;

use crate::equations::{Equations, Source};
use crate::sampled::SampledProgram;
use crate::subject::Subject;

/// A matrix, by rows.
type Matrix = [[Value; 3]; 3];

/// Axes for the components of velocities in the elimination of the rows.
#[derive(Clone, Default)]
pub(crate) struct Axes {
    /// Rotation of the velocities of points, if they are not in ground axes.
    points: Option<Matrix>,
    /// Rotation of the angular velocity of each body, if it is not in principal axes.
    rotations: Vec<Option<Matrix>>,
    /// Sets of three rows that are the components x, y and z of one vector.
    rows: Vec<[usize; 3]>,
}

impl Axes {
    /// Returns ground axes for the velocities of points and of all bodies.
    pub(crate) fn of_ground(e: &Equations, subject: &Subject<'_>) -> Option<Self> {
        let bodies = 0..subject.prepared.mechanism.bodies().len();
        let rotations = bodies.map(|body| rotation(e, body).map(Some));
        Some(Self {
            points: None,
            rotations: rotations.collect::<Option<_>>()?,
            rows: Vec::new(),
        })
    }

    /// Returns axes for each body. In these axes, the rows of the joint that supports the body are
    /// constant. They are the axes of the first body of this joint. The supporting joints are those
    /// on the shortest paths from the ground.
    pub(crate) fn of_joints(e: &mut Equations, subject: &Subject<'_>) -> Option<Self> {
        let mechanism = &subject.prepared.mechanism;
        let carriers = carriers(mechanism);
        let rotations = carriers
            .into_iter()
            .enumerate()
            .map(|(body, carrier)| match carrier {
                Carrier::Itself => Some(None),
                Carrier::First(BodyRef::Ground) => rotation(e, body).map(Some),
                Carrier::First(BodyRef::Body(first)) => relative(e, first, body).map(Some),
            });
        Some(Self {
            points: None,
            rotations: rotations.collect::<Option<_>>()?,
            rows: Vec::new(),
        })
    }

    /// Returns the axes of one body for all velocities.
    pub(crate) fn of_body(e: &mut Equations, subject: &Subject<'_>, body: usize) -> Option<Self> {
        let mechanism = &subject.prepared.mechanism;
        let own = transposed(rotation(e, body)?);
        let rotations = (0..mechanism.bodies().len()).map(|other| {
            if other == body {
                Some(None)
            } else {
                relative(e, body, other).map(Some)
            }
        });
        let rotations = rotations.collect::<Option<Vec<_>>>()?;
        let labels = &mechanism.layout().labels;
        let is_vector = |i: &usize| {
            let [a, b, c] = [&labels[*i], &labels[i + 1], &labels[i + 2]];
            a.joint == b.joint && a.joint == c.joint && (a.row, b.row, c.row) == ("x", "y", "z")
        };
        let rows = (0..labels.len().saturating_sub(2)).filter(is_vector);
        Some(Self {
            points: Some(own),
            rotations,
            rows: rows.map(|i| [i, i + 1, i + 2]).collect(),
        })
    }

    /// Returns whether, for each vector, the independent rows contain either all components or no
    /// component.
    pub(crate) fn keeps_vectors(&self, kept: &[usize]) -> bool {
        let all_or_none = |rows: &[usize; 3]| {
            let [first, others @ ..] = rows.map(|i| kept.contains(&i));
            others == [first; 2]
        };
        self.rows.iter().all(all_or_none)
    }

    /// Returns the rows of C for velocities along these axes.
    pub(crate) fn rows_of(&self, code: &mut SampledProgram, c: &[Vec<Value>]) -> Vec<Vec<Value>> {
        let mut c = c.to_vec();
        for row in &mut c {
            for (block, matrix) in self.blocks(row.len()) {
                let of = block.map(|k| row[k]);
                for (k, axis) in block.into_iter().zip(matrix) {
                    row[k] = code.simplest_sum(&pairs(axis, of));
                }
            }
        }
        if let Some(matrix) = self.points {
            for &rows in &self.rows {
                for j in 0..c[rows[0]].len() {
                    let of = rows.map(|i| c[i][j]);
                    for (i, axis) in rows.into_iter().zip(matrix) {
                        c[i][j] = code.simplest_sum(&pairs(axis, of));
                    }
                }
            }
        }
        c
    }

    /// Converts velocities along these axes to the velocities of the equations.
    pub(crate) fn velocities_out(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        let mut turned = x.to_vec();
        for (block, matrix) in self.blocks(x.len()) {
            turn(code, &mut turned, block, transposed(matrix));
        }
        turned
    }

    /// Converts forces of the equations to forces along these axes.
    pub(crate) fn forces_in(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        let mut turned = x.to_vec();
        for (block, matrix) in self.blocks(x.len()) {
            turn(code, &mut turned, block, matrix);
        }
        turned
    }

    /// Converts quantities of the rows from ground components to components along these axes.
    pub(crate) fn rows_in(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        let mut turned = x.to_vec();
        if let Some(matrix) = self.points {
            self.rows
                .iter()
                .for_each(|&rows| turn(code, &mut turned, rows, matrix));
        }
        turned
    }

    /// Converts quantities of the rows from components along these axes to ground components.
    pub(crate) fn rows_out(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        let mut turned = x.to_vec();
        if let Some(matrix) = self.points.map(transposed) {
            self.rows
                .iter()
                .for_each(|&rows| turn(code, &mut turned, rows, matrix));
        }
        turned
    }

    /// Returns sets of three velocity components, with the rotation of each set.
    fn blocks(&self, columns: usize) -> Vec<([usize; 3], Matrix)> {
        let space = SpaceKind::Space3;
        let bodies = 0..columns / space.n_v();
        let blocks = bodies.flat_map(|body| {
            let at = |first: usize| [first, first + 1, first + 2];
            let points = self
                .points
                .map(|matrix| (at(space.translations_of(body).start), matrix));
            let turn = self.rotations.get(body).copied().flatten();
            let turn = turn.map(|matrix| (at(space.rotations_of(body).start), matrix));
            points.into_iter().chain(turn)
        });
        blocks.collect()
    }
}

/// The body that supports another body.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Carrier {
    /// The body is not supported, or the directions of the joint are fixed in the body itself.
    Itself,
    /// The first body of a joint, in which the directions of the joint are fixed.
    First(BodyRef),
}

/// Returns the support of each body on the shortest paths from the ground. For bodies without a
/// connection to the ground, the paths start at the first of these bodies.
fn carriers(mechanism: &Mechanism) -> Vec<Carrier> {
    let n = mechanism.bodies().len();
    let mut found: Vec<Option<Carrier>> = vec![None; n];
    let roots = std::iter::once(BodyRef::Ground).chain((0..n).map(BodyRef::Body));
    for root in roots {
        if let BodyRef::Body(body) = root {
            if found[body].is_some() {
                continue;
            }
            found[body] = Some(Carrier::Itself);
        }
        let mut reached = vec![root];
        while !reached.is_empty() {
            let mut next = Vec::new();
            for group in &mechanism.layout().groups {
                let &[first, second] = group.bodies.as_slice() else {
                    continue;
                };
                let ways = [
                    (first, second, Carrier::First(first)),
                    (second, first, Carrier::Itself),
                ];
                for (from, to, carrier) in ways {
                    if let (true, BodyRef::Body(body)) = (reached.contains(&from), to)
                        && found[body].is_none()
                    {
                        found[body] = Some(carrier);
                        next.push(to);
                    }
                }
            }
            reached = next;
        }
    }
    found
        .into_iter()
        .map(|carrier| carrier.unwrap_or(Carrier::Itself))
        .collect()
}

/// Returns the rotation from the axes of one body to the axes of another body.
fn relative(e: &mut Equations, to: usize, from: usize) -> Option<Matrix> {
    let [to, from] = [rotation(e, to)?, rotation(e, from)?].map(transposed);
    let code = &mut e.code;
    Some(to.map(|axis| from.map(|column| code.simplest_sum(&pairs(axis, column)))))
}

/// Returns the rotation matrix of a body.
fn rotation(e: &Equations, body: usize) -> Option<Matrix> {
    let mut matrix = Vec::with_capacity(9);
    for row in 0..3 {
        for column in 0..3 {
            let entry = Input::Rotation { body, row, column };
            matrix.push(e.input(Source::Mechanism(entry))?);
        }
    }
    let row = |k: usize| [matrix[3 * k], matrix[3 * k + 1], matrix[3 * k + 2]];
    Some([row(0), row(1), row(2)])
}

fn transposed(matrix: Matrix) -> Matrix {
    [0, 1, 2].map(|k| matrix.map(|row| row[k]))
}

fn pairs(a: [Value; 3], b: [Value; 3]) -> [(Value, Value); 3] {
    [0, 1, 2].map(|k| (a[k], b[k]))
}

/// Replaces three entries by the product of a matrix and these entries.
fn turn(code: &mut SampledProgram, x: &mut [Value], at: [usize; 3], matrix: Matrix) {
    let of = at.map(|k| x[k]);
    for (k, row) in at.into_iter().zip(matrix) {
        x[k] = code.sum(&pairs(row, of));
    }
}
