//! Stiffness along free motions, `K = −Zᵀ·∂(Q − Cᵀ·λ)/∂q·Z` with constant multipliers λ, and steps
//! that are computed from the stiffness.

use linalg::kernels::norm;
use linalg::{Matrix, SymmetricEigen, small_svd, symmetric_eigen};
use model::System;

use super::balance::{Balance, Statics};
use super::error::EquilibriumError;
use crate::differences::ORDER_8;
use crate::limits::{ASYMMETRIC, IDLE, REST_BISECTIONS, STIFFNESS_STEP};

/// The stiffness at a configuration.
pub(super) struct Stiffness {
    pub(super) k: Matrix,
    /// Eigenvalues of the symmetric part.
    eigen: SymmetricEigen,
    /// Largest entry of the stiffness.
    pub(super) largest: f64,
    /// Values below this value are rounding errors.
    nothing: f64,
    /// Whether the stiffness is symmetric.
    pub(super) has_potential: bool,
}

/// Method by which a step was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Newton's method.
    Newton,
    /// A step of the maximum allowed length.
    Short,
}

impl Statics<'_> {
    /// Returns the stiffness at a configuration.
    pub(super) fn stiffness(&mut self, at: &Balance) -> Result<Stiffness, EquilibriumError> {
        let d = at.free.len();
        let mut k = Matrix::zeros(d, d);
        for column in 0..d {
            let shift: Vec<f64> = (0..self.units.len())
                .map(|j| at.z[(j, column)] * self.units[j])
                .collect();
            let mut change = vec![0.0; shift.len()];
            for (steps, weight) in ORDER_8.into_iter().enumerate() {
                for sign in [1.0, -1.0] {
                    let way = sign * (steps + 1) as f64 * STIFFNESS_STEP;
                    let q = self.mechanism.space().displaced(&at.q, way, &shift);
                    let forces = self.unbalanced(&q, at);
                    for (change, force) in change.iter_mut().zip(forces) {
                        *change += sign * weight * force / STIFFNESS_STEP;
                    }
                }
            }
            for (i, x) in at.z.transpose_times(&change).into_iter().enumerate() {
                k[(i, column)] = -x;
            }
        }
        if let Some((_, column, _)) = k.first_non_finite() {
            let shift = self.velocity(at, &unit(d, column));
            let body = (0..shift.len()).fold(0, |a, b| {
                if shift[b].abs() > shift[a].abs() {
                    b
                } else {
                    a
                }
            });
            return Err(EquilibriumError::NotFinite {
                what: "a force".to_owned(),
                body: self.mechanism.coordinate(body).0.to_owned(),
            });
        }
        let largest = k.max_abs();
        let skew = Matrix::from_fn(d, d, |i, j| 0.5 * (k[(i, j)] - k[(j, i)])).max_abs();
        Ok(Stiffness {
            eigen: symmetric_eigen(&k),
            nothing: IDLE * largest.max(at.scale),
            // Away from an equilibrium, the rotation of the axes adds a skew part that is
            // proportional to the remaining forces.
            has_potential: skew <= ASYMMETRIC * largest.max(at.scale) + 2.0 * norm(&at.free),
            largest,
            k,
        })
    }

    /// Returns `Q − Cᵀ·λ` at a configuration with the multipliers of another configuration.
    fn unbalanced(&mut self, q: &[f64], at: &Balance) -> Vec<f64> {
        self.evaluate(q);
        let mut force = self.s.force.clone();
        let layout = self.mechanism.layout();
        for &(row, lambda) in &at.multipliers {
            for (column, c) in layout.row(&self.s, row) {
                force[column] -= c * lambda;
            }
        }
        force.iter_mut().zip(&self.units).for_each(|(f, u)| *f *= u);
        force
    }
}

/// Returns a unit vector.
fn unit(n: usize, k: usize) -> Vec<f64> {
    let mut unit = vec![0.0; n];
    unit[k] = 1.0;
    unit
}

impl Stiffness {
    fn vector(&self, i: usize) -> Vec<f64> {
        let vectors = &self.eigen.vectors;
        (0..vectors.nrows()).map(|k| vectors[(k, i)]).collect()
    }

    /// Returns the unstable motions, the most unstable motion first.
    pub(super) fn falling(&self) -> Vec<Vec<f64>> {
        let values = self.eigen.values.iter().enumerate().rev();
        let falling = values.filter(|(_, value)| **value < -self.nothing);
        falling.map(|(i, _)| self.vector(i)).collect()
    }

    /// Returns the motions along which the forces are constant.
    pub(super) fn idle(&self) -> Vec<Vec<f64>> {
        if self.has_potential {
            let values = self.eigen.values.iter().enumerate();
            let idle = values.filter(|(_, value)| value.abs() <= self.nothing);
            return idle.map(|(i, _)| self.vector(i)).collect();
        }
        let svd = small_svd(&self.k);
        let column = |i: usize| (0..svd.v.nrows()).map(|k| svd.v[(k, i)]).collect();
        let values = svd.sigma.iter().enumerate();
        let idle = values.filter(|(_, value)| **value <= self.nothing);
        idle.map(|(i, _)| column(i)).collect()
    }

    /// Returns a step along the forces `free`. The step is at most as long as `radius`. Forces of
    /// at most `rounding` count as zero.
    pub(super) fn step(&self, free: &[f64], radius: f64, rounding: f64) -> (Vec<f64>, Way) {
        let newton = if self.has_potential {
            self.newton(free, rounding)
        } else {
            self.inverse(free, rounding)
        };
        if let Some(y) = newton.filter(|y| norm(y) <= radius) {
            return (y, Way::Newton);
        }
        let least = self.eigen.values.last().copied().unwrap_or_default();
        let (mut low, mut high) = ((-least).max(0.0), 0.0);
        high += low + norm(free) / radius;
        for _ in 0..REST_BISECTIONS {
            let middle = 0.5 * (low + high);
            if norm(&self.shifted(free, middle, rounding)) > radius {
                low = middle;
            } else {
                high = middle;
            }
        }
        (self.shifted(free, high, rounding), Way::Short)
    }

    /// Returns `K⁻¹·f` without the components along idle motions, for a K without negative
    /// eigenvalues. Returns `None` if forces act along idle motions, or if they point away from the
    /// equilibrium.
    fn newton(&self, free: &[f64], rounding: f64) -> Option<Vec<f64>> {
        let mut y = vec![0.0; free.len()];
        for (i, &value) in self.eigen.values.iter().enumerate() {
            let along = self.vector(i);
            let force = linalg::kernels::dot(&along, free);
            if value.abs() <= self.nothing || force.abs() <= rounding {
                if value.abs() <= self.nothing && force.abs() > rounding {
                    return None;
                }
                continue;
            }
            if value < 0.0 {
                return None;
            }
            linalg::kernels::axpy(force / value, &along, &mut y);
        }
        Some(y)
    }

    /// Returns `K⁻¹·f` without the components along idle motions, or `None` if forces act along
    /// idle motions.
    fn inverse(&self, free: &[f64], rounding: f64) -> Option<Vec<f64>> {
        let svd = small_svd(&self.k);
        let mut y = vec![0.0; free.len()];
        for (i, &sigma) in svd.sigma.iter().enumerate() {
            let column =
                |of: &Matrix| -> Vec<f64> { (0..of.nrows()).map(|k| of[(k, i)]).collect() };
            let force = linalg::kernels::dot(&column(&svd.u), free);
            if sigma > self.nothing {
                linalg::kernels::axpy(force / sigma, &column(&svd.v), &mut y);
            } else if force.abs() > rounding {
                return None;
            }
        }
        Some(y)
    }

    /// Returns `(K + μ·I)⁻¹·f` with the symmetric part of K.
    fn shifted(&self, free: &[f64], mu: f64, rounding: f64) -> Vec<f64> {
        let mut y = vec![0.0; free.len()];
        for (i, value) in self.eigen.values.iter().enumerate() {
            let along = self.vector(i);
            let force = linalg::kernels::dot(&along, free);
            if force.abs() > rounding {
                linalg::kernels::axpy(force / (value + mu), &along, &mut y);
            }
        }
        y
    }
}
