//! Forces along the free motions at one configuration, and multipliers of the constraints.
//!
//! All forces are in units of energy. Translations are divided by the size of the mechanism, and
//! forces are multiplied by this size. Rotations (rad) and torques are unchanged.

use linalg::{Matrix, RowBasis};
use model::start::{Metric, nearest_configuration};
use model::{Mechanism, Scratch, System};

use super::error::EquilibriumError;
use crate::limits::RESTING_RATE;
use crate::prepare::PreparedMechanism;

/// Statics of a mechanism at the time of its start.
pub(super) struct Statics<'m> {
    pub(super) mechanism: &'m Mechanism,
    pub(super) t: f64,
    /// Size of the mechanism (m).
    pub(super) size: f64,
    /// Unit of each velocity.
    pub(super) units: Vec<f64>,
    /// Ranks of C and of Φq.
    ranks: [usize; 2],
    pub(super) s: Scratch,
}

/// The forces at a configuration.
pub(super) struct Balance {
    pub(super) q: Vec<f64>,
    /// An orthonormal basis of the free motions, in columns, n_v × d.
    pub(super) z: Matrix,
    /// Forces along the free motions, d.
    pub(super) free: Vec<f64>,
    /// Independent rows of C and their multipliers, in units of the rows.
    pub(super) multipliers: Vec<(usize, f64)>,
    /// Independent rows of Φ.
    positions: Vec<usize>,
    /// The largest acting force, applied or transmitted.
    pub(super) scale: f64,
}

impl<'m> Statics<'m> {
    pub(super) fn new(prepared: &'m PreparedMechanism) -> Self {
        let mechanism = &prepared.mechanism;
        let size = prepared.assembly.size;
        Self {
            mechanism,
            t: prepared.start_time(),
            size,
            units: (0..mechanism.layout().n_v)
                .map(|j| mechanism.space().unit(j, size))
                .collect(),
            ranks: [prepared.decision.rank, prepared.position_decision.rank],
            s: mechanism.scratch(),
        }
    }

    pub(super) fn bodies(&self) -> usize {
        self.mechanism.bodies().len()
    }

    /// Evaluates C and Q at rest.
    pub(super) fn evaluate(&mut self, q: &[f64]) {
        let s = &mut self.s;
        self.mechanism.pose(self.t, q, s);
        self.mechanism.twist(&vec![0.0; self.units.len()], s);
        self.mechanism.c(s);
        self.mechanism.force(s);
    }

    /// Returns an error for rows that prescribe a velocity.
    pub(super) fn check_rest(&mut self, q: &[f64]) -> Result<(), EquilibriumError> {
        self.evaluate(q);
        self.mechanism.b(&mut self.s);
        let layout = self.mechanism.layout();
        for i in 0..layout.rows() {
            let is_angular = layout.is_angular(i);
            let unit = if is_angular { 1.0 } else { self.size };
            let rate = self.s.b[i];
            if rate.abs() > RESTING_RATE * unit || rate.is_nan() {
                let owner = layout.owner(i);
                return Err(EquilibriumError::Prescribed {
                    name: owner.name.clone(),
                    is_drive: owner.is_drive(),
                    rate,
                    unit: if is_angular { "rad/s" } else { "m/s" },
                });
            }
        }
        Ok(())
    }

    /// Returns the forces at a configuration.
    pub(super) fn balance(&mut self, q: Vec<f64>) -> Result<Balance, EquilibriumError> {
        self.evaluate(&q);
        let (mechanism, n) = (self.mechanism, self.units.len());
        let layout = mechanism.layout();
        if let Some(at) = self.s.force.iter().position(|f| !f.is_finite()) {
            let what = mechanism.applied_forces().undefined(&mut self.s);
            return Err(EquilibriumError::NotFinite {
                what: what.map_or_else(|| "a force".to_owned(), |force| force.to_string()),
                body: mechanism.coordinate(at).0.to_owned(),
            });
        }
        let mut c = layout.dense(&self.s);
        let mut lengths = vec![1.0; layout.rows()];
        for (i, length) in lengths.iter_mut().enumerate() {
            let row = c.row_mut(i);
            row.iter_mut().zip(&self.units).for_each(|(c, u)| *c *= u);
            let norm = linalg::kernels::norm(row);
            if norm > 0.0 {
                *length = norm;
                row.iter_mut().for_each(|c| *c /= norm);
            }
        }
        let [r, of_phi] = self.ranks;
        let holonomic: Vec<usize> = (0..layout.m).collect();
        let positions = RowBasis::most_independent(c.select_rows(&holonomic), of_phi);
        let positions = positions.kept().to_vec();
        let basis = RowBasis::most_independent(c, r);
        let qr = basis.factored();
        let mut x: Vec<f64> = self
            .s
            .force
            .iter()
            .zip(&self.units)
            .map(|(f, u)| f * u)
            .collect();
        let mut scale = self.largest_part();
        qr.q_transpose_mul(&mut x);
        let free = x.split_off(r);
        qr.solve_r(&mut x);
        let mut multipliers = Vec::with_capacity(r);
        for (lambda, &k) in x.iter().zip(qr.permutation()) {
            scale = scale.max(lambda.abs());
            let row = basis.kept()[k];
            multipliers.push((row, lambda / lengths[row]));
        }
        Ok(Balance {
            q,
            z: qr.q_columns(r..n),
            free,
            multipliers,
            positions,
            scale,
        })
    }

    /// Returns the largest entry of the weight or of an applied force at the last evaluated pose.
    fn largest_part(&mut self) -> f64 {
        let largest = |q: &[f64]| {
            let shares = q.iter().zip(&self.units).map(|(f, u)| (f * u).abs());
            shares.fold(0.0, f64::max)
        };
        let parts = self.mechanism.applied_forces().parts(&mut self.s);
        let parts = parts.map(|(_, q)| largest(&q)).fold(0.0, f64::max);
        parts.max(largest(self.mechanism.weight()))
    }

    /// Returns the dimensionless displacement of all bodies for a step along the free motions.
    pub(super) fn moved(&self, at: &Balance, y: &[f64]) -> Vec<f64> {
        at.z.times(y)
    }

    /// Expresses the forces along the free motions as forces along all velocities, n_v values.
    pub(super) fn scaled(&self, at: &Balance) -> Vec<f64> {
        at.z.times(&at.free)
    }

    /// Returns the velocities of all bodies for the velocities y along the free motions (m/s,
    /// rad/s).
    pub(super) fn velocity(&self, at: &Balance, y: &[f64]) -> Vec<f64> {
        let moved = self.moved(at, y);
        moved.iter().zip(&self.units).map(|(x, u)| x * u).collect()
    }

    /// Returns the configuration on the constraint manifold that is closest to a displaced
    /// configuration.
    pub(super) fn placed(&self, at: &Balance, moved: &[f64]) -> Result<Vec<f64>, EquilibriumError> {
        let step: Vec<f64> = moved.iter().zip(&self.units).map(|(x, u)| x * u).collect();
        let q = self.mechanism.space().displaced(&at.q, 1.0, &step);
        let rows = &at.positions;
        Ok(nearest_configuration(
            self.mechanism,
            self.t,
            rows,
            &q,
            Metric::Length,
        )?)
    }
}
