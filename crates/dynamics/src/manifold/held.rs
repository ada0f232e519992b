//! Independent rotations of bodies that also have dependent ones.
//!
//! A quaternion has no entry for one of them: the integrator carries a whole orientation, of which
//! the dependent part is a guess, and a correction of that part about two axes of a body turns it
//! about the third one, too. So the independent part is what the Jacobian of an implicit method
//! reads of an orientation ([`crate::run`]): a linear function of the quaternion, twice its part
//! along the axis against the orientation at the beginning of a step. A completion keeps it: the
//! rows and these functions together are solved for all rotations.

use std::ops::Range;

use linalg::kernels::norm;
use linalg::{Lu, Matrix};
use model::{Mechanism, System};

use crate::error::MotionFault;
use crate::solve::{Evaluation, KeptRows};

/// Such rotations, and what a completion keeps of them.
#[derive(Default)]
pub(super) struct Held {
    /// Their columns of C.
    columns: Vec<usize>,
    /// How each is read: indices into q with coefficients.
    reads: Vec<Vec<(usize, f64)>>,
    /// The quaternion of each body in q, and the length of that against which it is read: the
    /// motion does not change lengths, while what an integrator carries for dependent parts does.
    quaternions: Vec<(Range<usize>, f64)>,
    /// The values that are kept.
    values: Vec<f64>,
    /// Row j: motion that keeps the rows and turns along column j alone among the independent ones,
    /// n_v.
    tangents: Matrix,
    /// Entry (i, j): what is read at i of the tangent j, factored.
    system: Option<Lu>,
    /// Shares of the tangents in a correction.
    shares: Vec<f64>,
    /// A rate of q, n_q.
    rate: Vec<f64>,
}

impl Held {
    /// Those among independent columns.
    pub(super) fn among(mechanism: &Mechanism, independent: &[usize], q: &[f64]) -> Self {
        let space = mechanism.space();
        let mut held = Self::default();
        for &column in independent {
            let body = space.body_of(column);
            let rotations = space.columns_of(body).filter(|&j| space.is_rotation(j));
            let mut dependent = rotations.filter(|j| !independent.contains(j));
            let mut terms = Vec::new();
            space.read_velocity(q, column, &mut terms);
            if space.is_rotation(column) && dependent.next().is_some() {
                held.columns.push(column);
                held.reads.push(terms);
                let own = space.coordinates(body);
                let own = own.start + space.forces().len()..own.end;
                held.quaternions.push((own.clone(), norm(&q[own])));
            }
        }
        let k = held.columns.len();
        if k > 0 {
            held.values.resize(k, 0.0);
            held.shares.resize(k, 0.0);
            held.tangents = Matrix::zeros(k, mechanism.layout().n_v);
            held.system = Some(Lu::new(k));
            held.rate.resize(mechanism.layout().n_q, 0.0);
        }
        held
    }

    /// Reads orientations against these ones from now on.
    pub(super) fn read_from(&mut self, mechanism: &Mechanism, q: &[f64]) {
        for (terms, &column) in self.reads.iter_mut().zip(&self.columns) {
            mechanism.space().read_velocity(q, column, terms);
        }
        for (own, length) in &mut self.quaternions {
            *length = norm(&q[own.clone()]);
        }
    }

    /// Keeps the values of this configuration, and gives its quaternions their lengths.
    pub(super) fn keep(&mut self, q: &mut [f64]) {
        for (value, terms) in self.values.iter_mut().zip(&self.reads) {
            *value = read(terms, q);
        }
        for (own, length) in &self.quaternions {
            let own = &mut q[own.clone()];
            let factor = length / norm(own);
            own.iter_mut().for_each(|e| *e *= factor);
        }
    }

    /// The largest difference of this configuration from what is kept, in radians.
    pub(super) fn off(&self, q: &[f64]) -> f64 {
        let of = |(value, terms): (&f64, &Vec<_>)| (value - read(terms, q)).abs();
        let off = self.values.iter().zip(&self.reads).map(of);
        // NaN is worse than any number.
        off.fold(0.0, |a: f64, x| if x <= a { a } else { x })
    }

    /// Computes the tangents with freshly factored rows; leaves their right-hand side zero.
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
            for (i, terms) in self.reads.iter().enumerate() {
                entries[(i, j)] = read(terms, &self.rate);
            }
        }
        system
            .factor(|i, j| entries[(i, j)])
            .map_err(|source| MotionFault::IterationMatrix {
                time: at.s.t,
                source,
            })
    }

    /// Adds tangents to a correction of q, so that it keeps the values.
    pub(super) fn hold(&mut self, mechanism: &Mechanism, q: &[f64], delta: &mut [f64]) {
        let Some(system) = &mut self.system else {
            return;
        };
        mechanism.rate(q, delta, &mut self.rate);
        for (k, (share, terms)) in self.shares.iter_mut().zip(&self.reads).enumerate() {
            *share = self.values[k] - read(terms, q) - read(terms, &self.rate);
        }
        system.solve(&mut self.shares);
        for (j, share) in self.shares.iter().enumerate() {
            for (delta, tangent) in delta.iter_mut().zip(self.tangents.row(j)) {
                *delta += share * tangent;
            }
        }
    }
}

fn read(terms: &[(usize, f64)], q: &[f64]) -> f64 {
    terms.iter().map(|&(at, factor)| factor * q[at]).sum()
}
