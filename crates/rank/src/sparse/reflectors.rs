//! Q stored as a product of Householder reflections. Each reflection involves a few rows.
//!
//! `Q = H₁·H₂⋯H_s` with `H = I − v·vᵀ`, `‖v‖² = 2`, and v sparse. Several vectors are reflected at
//! the same time, so the rows of v are looked up only once.

use crate::limits::REFLECTORS_WIDTH;

/// A row of [`REFLECTORS_WIDTH`] vectors.
pub(super) type Lanes = [f64; REFLECTORS_WIDTH];

/// Reflections in the order in which they were applied to the rows of C.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Reflectors {
    /// Index after the last entry of each v.
    end: Vec<usize>,
    row: Vec<usize>,
    value: Vec<f64>,
}

impl Reflectors {
    /// Adds `I − v·vᵀ` for the entries (row, value) of v.
    pub(super) fn push(&mut self, v: impl Iterator<Item = (usize, f64)>) {
        for (row, value) in v {
            self.row.push(row);
            self.value.push(value);
        }
        self.end.push(self.row.len());
    }

    /// Computes `X ← Q·X`.
    pub(super) fn apply(&self, x: &mut [Lanes]) {
        (0..self.end.len()).rev().for_each(|k| self.reflect(k, x));
    }

    fn reflect(&self, k: usize, x: &mut [Lanes]) {
        let entries = k.checked_sub(1).map_or(0, |k| self.end[k])..self.end[k];
        let (rows, values) = (&self.row[entries.clone()], &self.value[entries]);
        let mut product = [0.0; REFLECTORS_WIDTH];
        for (&i, &v_i) in rows.iter().zip(values) {
            for (p, x) in product.iter_mut().zip(&x[i]) {
                *p += v_i * x;
            }
        }
        for (&i, &v_i) in rows.iter().zip(values) {
            for (p, x) in product.iter().zip(&mut x[i]) {
                *x -= v_i * p;
            }
        }
    }

    /// Returns the memory (bytes).
    pub(super) fn bytes(&self) -> usize {
        size_of::<usize>() * (self.end.len() + self.row.len()) + size_of::<f64>() * self.value.len()
    }
}
