//! The second-order equations at a configuration. A motion with velocities w needs accelerations
//! that satisfy all rows, so `zᵀ·Γ(w) = 0` for every z in the left null space of C, including
//! drives.

use model::start::scene_size;
use model::{Mechanism, Scratch, System};
use nalgebra::{DMatrix, DVector};

use super::decomposition::Decomposition;
use super::oracle::{inverse, units};
use suite::numbers::Numbers;

/// Singular values below this fraction of the largest singular value count as zero.
const ZERO: f64 = 1e-9;

/// The equations count as satisfied if the residual is below this fraction of their largest term.
/// The residual is 1e-13 at regular configurations and 1e-2 at singular configurations.
const HOLDS: f64 = 1e-8;

/// Number of free motions that are tried.
const TRIES: usize = 6;

/// The decomposition of C at a configuration, with rows of length one.
pub(super) struct SecondOrder<'m> {
    mechanism: &'m Mechanism,
    s: Scratch,
    range: Decomposition,
    row_scale: Vec<f64>,
    units: Vec<f64>,
}

impl<'m> SecondOrder<'m> {
    /// Decomposes C at a configuration; returns `None` if C is not finite.
    pub(super) fn at(mechanism: &'m Mechanism, (t, q): (f64, &[f64])) -> Option<Self> {
        let layout = mechanism.layout();
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        let units = units(mechanism, scene_size(mechanism, q));
        let dense = layout.dense(&s);
        let (m, n) = (layout.rows(), layout.n_v);
        let mut c = DMatrix::from_fn(m, n, |i, j| dense[(i, j)] * units[j]);
        if c.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let row_scale: Vec<f64> = (0..m).map(|i| inverse(c.row(i).norm())).collect();
        for i in 0..m {
            c.row_mut(i).scale_mut(row_scale[i]);
        }
        Some(Self {
            mechanism,
            s,
            range: Decomposition::of(&c).above(ZERO),
            row_scale,
            units,
        })
    }

    /// Returns the smallest nonzero singular value, divided by the largest singular value.
    pub(super) fn sigma(&self) -> f64 {
        let values = &self.range.values;
        let largest = values.first().copied().unwrap_or(1.0);
        values.last().map_or(1.0, |least| least / largest)
    }

    /// Whether the equations exclude some of the motions that all rows allow to first order.
    pub(super) fn is_restricted(&mut self, numbers: &mut Numbers) -> bool {
        let n = self.units.len();
        (0..TRIES).any(|_| {
            let mut x = DVector::from_fn(n, |_, _| numbers.unit());
            x -= &self.range.right * (self.range.right.transpose() * &x);
            let w: Vec<f64> = x.iter().zip(&self.units).map(|(x, d)| x * d).collect();
            !self.holds(&w)
        })
    }

    /// Whether the equations are satisfied for these velocities or, from rest, these accelerations.
    pub(super) fn holds(&mut self, w: &[f64]) -> bool {
        let [along, rest] = [w, &vec![0.0; w.len()]].map(|v| {
            self.mechanism.twist(v, &mut self.s);
            self.mechanism.gamma(&mut self.s);
            self.s.gamma.clone()
        });
        let m = self.row_scale.len();
        let asked = DVector::from_fn(m, |i, _| self.row_scale[i] * (along[i] - rest[i]));
        let missed = &asked - &self.range.left * (self.range.left.transpose() * &asked);
        missed.amax() <= HOLDS * asked.amax()
    }
}
