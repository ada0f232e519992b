//! Independent rotations of bodies that also have dependent rotations.
//!
//! A quaternion has no entry for one independent rotation. The integrator stores the complete
//! orientation, of which the dependent part is an estimate. A correction of this part about two
//! axes of a body also rotates the body about the third axis. Therefore the independent part is
//! defined as the twist about the axis relative to the orientation at the start of a step. For a
//! relative quaternion (w, x, y, z) and the third axis, the twist is `2·atan2(z, w)`, which does
//! not depend on x and y. To first order the twist is the coordinate in the Jacobian of an implicit
//! method ([`crate::run`]). A completion does not change the twist, because the rows and the twist
//! functions are solved together for all rotations.

use std::f64::consts::TAU;
use std::ops::Range;

use linalg::kernels::norm;
use linalg::{Lu, Matrix};
use model::{Mechanism, System};

use crate::error::MotionFault;
use crate::solve::{Evaluation, KeptRows};

/// Computation of a twist from q.
struct Twist {
    /// The quaternion of the body in q, and the length of the reference quaternion. The motion does
    /// not change lengths, but the integrator's values of dependent parts may change them.
    own: Range<usize>,
    length: f64,
    /// Twice the sine of half the angle, and the cosine of half the angle, up to a common factor.
    /// Both are linear forms, given as indices into q with coefficients.
    sine: Vec<(usize, f64)>,
    cosine: Vec<(usize, f64)>,
}

/// Independent rotations of bodies that also have dependent rotations, and their values during a
/// completion.
#[derive(Default)]
pub(super) struct IndependentRotations {
    /// Columns of these rotations in C.
    columns: Vec<usize>,
    /// Computation of each rotation from q.
    twists: Vec<Twist>,
    /// Values that a completion does not change.
    values: Vec<f64>,
    /// Row j is the motion (n_v values) that satisfies the rows and rotates along column j, but not
    /// along any other independent column.
    tangents: Matrix,
    /// Entry (i, j) is the rate of rotation i for tangent j. The matrix is factored.
    system: Option<Lu>,
    /// Shares of the tangents in a correction.
    shares: Vec<f64>,
    /// A rate of q, n_q values.
    rate: Vec<f64>,
}

impl IndependentRotations {
    /// Finds the independent columns that rotate a body which also has dependent rotations.
    pub(super) fn among(mechanism: &Mechanism, independent: &[usize], q: &[f64]) -> Self {
        let space = mechanism.space();
        let mut held = Self::default();
        for &column in independent {
            let body = space.body_of(column);
            let rotations = space.columns_of(body).filter(|&j| space.is_rotation(j));
            let mut dependent = rotations.filter(|j| !independent.contains(j));
            if space.is_rotation(column) && dependent.next().is_some() {
                let own = space.coordinates(body);
                held.columns.push(column);
                held.twists.push(Twist {
                    own: own.start + space.forces().len()..own.end,
                    length: 1.0,
                    sine: Vec::new(),
                    cosine: Vec::new(),
                });
            }
        }
        let k = held.columns.len();
        if k > 0 {
            held.values.resize(k, 0.0);
            held.shares.resize(k, 0.0);
            held.tangents = Matrix::zeros(k, mechanism.layout().n_v);
            held.system = Some(Lu::new(k));
            held.rate.resize(mechanism.layout().n_q, 0.0);
            held.read_from(mechanism, q);
        }
        held
    }

    /// Returns whether there are no independent rotations that a completion must preserve.
    pub(super) fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// Uses these orientations as the reference from now on.
    pub(super) fn read_from(&mut self, mechanism: &Mechanism, q: &[f64]) {
        for (twist, &column) in self.twists.iter_mut().zip(&self.columns) {
            mechanism.space().read_velocity(q, column, &mut twist.sine);
            let base = &q[twist.own.clone()];
            twist.length = norm(base);
            let square = twist.length * twist.length;
            let along = base.iter().map(|e| e / square);
            twist.cosine.clear();
            twist.cosine.extend(twist.own.clone().zip(along));
        }
    }

    /// Stores the rotations of this configuration, and scales its quaternions to the lengths of the
    /// reference.
    pub(super) fn keep(&mut self, q: &mut [f64]) {
        for (value, twist) in self.values.iter_mut().zip(&self.twists) {
            *value = twist.angle(q);
        }
        for twist in &self.twists {
            let own = &mut q[twist.own.clone()];
            let factor = twist.length / norm(own);
            own.iter_mut().for_each(|e| *e *= factor);
        }
    }

    /// Returns the largest difference of this configuration from the stored values, in radians.
    pub(super) fn off(&self, q: &[f64]) -> f64 {
        let of = |(value, twist): (&f64, &Twist)| twist.behind(*value, q).abs();
        let off = self.values.iter().zip(&self.twists).map(of);
        // NaN counts as larger than any other value.
        off.fold(0.0, |a: f64, x| if x <= a { a } else { x })
    }

    /// Computes the tangents with freshly factored rows. The right-hand side of the rows is then
    /// zero.
    pub(super) fn find_tangents(
        &mut self,
        at: &Evaluation<'_>,
        rows: &mut KeptRows,
        q: &[f64],
    ) -> Result<(), MotionFault> {
        let Some(system) = &mut self.system else {
            return Ok(());
        };
        rows.rhs.fill(0.0);
        let k = self.columns.len();
        let mut entries = Matrix::zeros(k, k);
        for (j, &column) in self.columns.iter().enumerate() {
            let tangent = self.tangents.row_mut(j);
            tangent.fill(0.0);
            tangent[column] = 1.0;
            rows.complete(at, tangent)?;
            at.mechanism.rate(q, tangent, &mut self.rate);
            for (i, twist) in self.twists.iter().enumerate() {
                entries[(i, j)] = twist.rate(q, &self.rate);
            }
        }
        system
            .factor(|i, j| entries[(i, j)])
            .map_err(|source| MotionFault::IterationMatrix {
                time: at.s.t,
                source,
            })
    }

    /// Adds tangents to a correction of q, so that the correction does not change the stored
    /// values.
    pub(super) fn hold(&mut self, mechanism: &Mechanism, q: &[f64], delta: &mut [f64]) {
        let Some(system) = &mut self.system else {
            return;
        };
        mechanism.rate(q, delta, &mut self.rate);
        for (k, (share, twist)) in self.shares.iter_mut().zip(&self.twists).enumerate() {
            *share = twist.behind(self.values[k], q) - twist.rate(q, &self.rate);
        }
        system.solve(&mut self.shares);
        for (j, share) in self.shares.iter().enumerate() {
            for (delta, tangent) in delta.iter_mut().zip(self.tangents.row(j)) {
                *delta += share * tangent;
            }
        }
    }
}

impl Twist {
    /// Returns sine and cosine of half the angle, up to a common factor.
    fn half(&self, q: &[f64]) -> [f64; 2] {
        [0.5 * read(&self.sine, q), read(&self.cosine, q)]
    }

    /// Returns the angle (rad), between −π and π.
    fn angle(&self, q: &[f64]) -> f64 {
        let [sine, cosine] = self.half(q);
        2.0 * (sine / cosine).atan()
    }

    /// Returns another angle minus the angle of q (rad), between −π and π.
    fn behind(&self, angle: f64, q: &[f64]) -> f64 {
        let off = angle - self.angle(q);
        off - TAU * (off / TAU).round()
    }

    /// Returns the rate of the angle at q if q changes at the given rate.
    fn rate(&self, q: &[f64], rate: &[f64]) -> f64 {
        let ([s, c], [s_rate, c_rate]) = (self.half(q), self.half(rate));
        2.0 * (c * s_rate - s * c_rate) / (s * s + c * c)
    }
}

fn read(terms: &[(usize, f64)], q: &[f64]) -> f64 {
    terms.iter().map(|&(at, factor)| factor * q[at]).sum()
}
