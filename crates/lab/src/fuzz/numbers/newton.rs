//! Newton's method for constraint rows. The smallest corrections of positions and velocities, and
//! accelerations with multipliers, are computed from symmetric systems
//! `[W Jᵀ; J 0]·[x; μ] = [f; g]` with scaled rows and columns.

use model::{Mechanism, Scratch, System};
use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::oracle::{inverse, units};

/// Independent rows of a mechanism, with scaled columns.
pub(super) struct Kept<'a> {
    pub(super) mechanism: &'a Mechanism,
    rows: &'a [usize],
    scale: Vec<f64>,
}

/// A factored system.
pub(super) struct Factored {
    lu: LU<f64, Dyn, Dyn>,
    row_scale: Vec<f64>,
    n: usize,
}

impl<'a> Kept<'a> {
    pub(super) fn new(mechanism: &'a Mechanism, rows: &'a [usize], size: f64) -> Self {
        Self {
            mechanism,
            rows,
            scale: units(mechanism, size),
        }
    }

    /// Returns the number of holonomic rows, which come first.
    fn holonomic(&self) -> usize {
        let m = self.mechanism.layout().m;
        self.rows.partition_point(|&row| row < m)
    }

    /// Factors the system of the first `count` rows at the pose in `s`, in which C must be up to
    /// date. `mass` is the diagonal of W; if it is `None`, W is the identity.
    pub(super) fn factored(&self, s: &Scratch, count: usize, mass: Option<&[f64]>) -> Factored {
        let layout = self.mechanism.layout();
        let n = layout.n_v;
        let mut all = DMatrix::zeros(n + count, n + count);
        for j in 0..n {
            all[(j, j)] = mass.map_or(1.0, |m| m[j] * self.scale[j] * self.scale[j]);
        }
        let mut row_scale = vec![1.0; count];
        for (k, &row) in self.rows[..count].iter().enumerate() {
            for (j, value) in layout.row(s, row) {
                all[(n + k, j)] += value * self.scale[j];
            }
            row_scale[k] = inverse(all.row(n + k).norm());
            for j in 0..n {
                let value = all[(n + k, j)] * row_scale[k];
                all[(n + k, j)] = value;
                all[(j, n + k)] = value;
            }
        }
        Factored {
            lu: all.lu(),
            row_scale,
            n,
        }
    }

    /// Factors the system of all rows, with the identity as W.
    pub(super) fn of_velocities(&self, s: &Scratch) -> Factored {
        self.factored(s, self.rows.len(), None)
    }

    /// Factors the system of the holonomic rows, with the identity as W.
    pub(super) fn of_positions(&self, s: &Scratch) -> Factored {
        self.factored(s, self.holonomic(), None)
    }

    /// Computes the smallest displacement that corrects Φ of the independent rows; `s.phi` must be
    /// up to date. Returns the length of the displacement in scaled units.
    pub(super) fn correct(&self, s: &Scratch, by: &Factored, q: &mut [f64]) -> Option<f64> {
        let missing = self.rows[..self.holonomic()].iter().map(|&i| -s.phi[i]);
        let (x, _) = by.solve(None, missing)?;
        let step: Vec<f64> = x.iter().zip(&self.scale).map(|(x, d)| x * d).collect();
        self.mechanism.displace(q, &step);
        Some(x.norm())
    }

    /// Computes the smallest change of the velocities after which `C·v = b`.
    pub(super) fn correct_velocities(
        &self,
        s: &Scratch,
        by: &Factored,
        v: &mut [f64],
    ) -> Option<()> {
        let layout = self.mechanism.layout();
        let missing = self
            .rows
            .iter()
            .map(|&i| -layout.velocity_residual(s, i, v));
        let (x, _) = by.solve(None, missing)?;
        for ((v, x), d) in v.iter_mut().zip(x.iter()).zip(&self.scale) {
            *v += x * d;
        }
        Some(())
    }

    /// Returns the multipliers of all rows of the mechanism under these forces. The multipliers of
    /// redundant rows are zero; `s.gamma` must be up to date.
    pub(super) fn multipliers(&self, s: &Scratch, force: &[f64]) -> Option<Vec<f64>> {
        let by = self.factored(s, self.rows.len(), Some(self.mechanism.mass()));
        let load = DVector::from_fn(force.len(), |j, _| force[j] * self.scale[j]);
        let required = self.rows.iter().map(|&i| s.gamma[i]);
        let (_, own) = by.solve(Some(load), required)?;
        let mut lambda = vec![0.0; self.mechanism.layout().rows()];
        for (k, &row) in self.rows.iter().enumerate() {
            lambda[row] = own[k];
        }
        Some(lambda)
    }
}

impl Factored {
    /// Returns x and μ. The multipliers μ belong to the unscaled rows. Returns `None` if the system
    /// is singular.
    fn solve(
        &self,
        load: Option<DVector<f64>>,
        required: impl Iterator<Item = f64>,
    ) -> Option<(DVector<f64>, Vec<f64>)> {
        let mut right = DVector::zeros(self.n + self.row_scale.len());
        if let Some(load) = load {
            right.rows_mut(0, self.n).copy_from(&load);
        }
        for (k, value) in required.enumerate() {
            right[self.n + k] = value * self.row_scale[k];
        }
        let x = self.lu.solve(&right)?;
        let own = (0..self.row_scale.len()).map(|k| x[self.n + k] * self.row_scale[k]);
        x.iter()
            .all(|x| x.is_finite())
            .then(|| (x.rows(0, self.n).into_owned(), own.collect()))
    }
}
