//! LU with partial pivoting of the tall Cᵀ, one row of C after the other: `P·Cᵀ = L·U`,
//! `L = [L₁; L₂]` unit lower trapezoidal.

use super::error::{SaddleError, check_finite, check_length};
use super::order::Order;
use crate::kernels::{axpy, dot, max_abs};
use crate::limits::CANDIDATE;

/// Factors of the rows that are used.
#[derive(Debug, Clone)]
pub(super) struct TallLu {
    pub(super) n: usize,
    /// Number of rows in use: all rows without the skipped ones.
    pub(super) r: usize,
    /// The row of C for each row in use, ascending.
    used: Vec<usize>,
    /// Row j: `U_0j … U_jj`, then column j of L below its unit diagonal. r×n, row-major.
    factors: Vec<f64>,
    /// 1/U_jj of each row in use: a product is cheaper than a quotient.
    inverse: Vec<f64>,
    /// Position i of P·x is coordinate `permutation[i]`, coordinate j is at `place[j]`.
    pub(super) permutation: Vec<usize>,
    place: Vec<usize>,
    /// Sign of P.
    parity: f64,
    /// Whether each row was solved for the coordinate that the order has for it.
    is_in_order: bool,
    /// Smallest `|pivot| / largest entry of its row`, rows left out included.
    pub(super) pivot_ratio: f64,
}

/// Result of the elimination of a row.
pub(super) enum Elimination {
    Used,
    /// It depends on the rows before: its largest remaining entry, and its largest entry at first.
    Dependent {
        pivot: f64,
        scale: f64,
    },
}

impl TallLu {
    pub(super) fn new(n: usize, rows: usize) -> Self {
        Self {
            n,
            r: rows,
            used: (0..rows).collect(),
            factors: vec![0.0; rows * n],
            inverse: vec![0.0; rows],
            permutation: (0..n).collect(),
            place: (0..n).collect(),
            parity: 1.0,
            is_in_order: true,
            pivot_ratio: f64::INFINITY,
        }
    }

    /// Removes all rows; coordinates are used in this order.
    pub(super) fn begin(&mut self, order: &Order) {
        self.permutation.copy_from_slice(&order.coordinates);
        for (i, &coordinate) in order.coordinates.iter().enumerate() {
            self.place[coordinate] = i;
        }
        self.is_in_order = true;
        self.parity = order.parity;
        self.pivot_ratio = f64::INFINITY;
        self.r = 0;
    }

    /// The rows of C in use, ascending.
    pub(super) fn used(&self) -> &[usize] {
        &self.used[..self.r]
    }

    /// Row j of the factors, see [`TallLu::factors`].
    pub(super) fn row(&self, j: usize) -> &[f64] {
        &self.factors[j * self.n..(j + 1) * self.n]
    }

    /// Computes the next column of U and of L from a row of C: gather, eliminate with the rows
    /// before, pivot. `graded` contains the masses if they affect which coordinate is solved for.
    pub(super) fn eliminate(
        &mut self,
        order: &Order,
        (row, c_j): (usize, &[f64]),
        graded: Option<&[f64]>,
        floor: f64,
    ) -> Result<Elimination, SaddleError> {
        let (n, j) = (self.n, self.r);
        check_length("row of C", c_j, n)?;
        let (before, rest) = self.factors.split_at_mut(j * n);
        let x = &mut rest[..n];
        x.fill(0.0);
        // x·0 is NaN exactly for NaN and infinities.
        let (mut scale, mut zero) = (0.0_f64, 0.0);
        for &column in order.columns.of(row) {
            let c = c_j[column];
            x[self.place[column]] = c;
            zero += c * 0.0;
            scale = if c.abs() > scale { c.abs() } else { scale };
        }
        if zero != 0.0 {
            check_finite("C", c_j, row * n)?;
        }
        // As long as rows are solved for the coordinates of the order, their entries are those of
        // the lists.
        let below = if row == j && self.is_in_order {
            for &k in order.fill.upper.of(j) {
                let (u_kj, l_k) = (x[k], &before[k * n..(k + 1) * n]);
                // Entries of a joint along the axes of the ground are often zero.
                if u_kj != 0.0 {
                    for &i in order.fill.lower.of(k) {
                        x[i] -= u_kj * l_k[i];
                    }
                }
            }
            Some(order.fill.lower.of(j))
        } else {
            for (k, l_k) in before.chunks_exact(n).enumerate() {
                let u_kj = x[k];
                if u_kj != 0.0 {
                    axpy(-u_kj, &l_k[k + 1..], &mut x[k + 1..]);
                }
            }
            None
        };

        let solvable = order.solvable;
        let at = match (graded, below) {
            (None, Some(below)) => {
                let (mut at, mut largest) = (j, max_abs(&x[j..=j]));
                for &i in below {
                    if i < solvable && x[i].abs() > largest {
                        (at, largest) = (i, x[i].abs());
                    }
                }
                Some(at)
            }
            (None, None) => {
                // No entry is the largest one if all are NaN.
                let largest = max_abs(&x[j..solvable]);
                (j..solvable).find(|&i| x[i].abs() == largest)
            }
            (Some(mass), _) => {
                let largest = max_abs(&x[j..solvable]);
                let candidates = (j..solvable).filter(|&i| x[i].abs() >= CANDIDATE * largest);
                let mass = |i: usize| mass[self.permutation[i]];
                // Compares c²/m without quotients: masses may be zero.
                candidates.reduce(|a, b| {
                    if x[b] * x[b] * mass(a) > x[a] * x[a] * mass(b) {
                        b
                    } else {
                        a
                    }
                })
            }
        };
        let at = at.unwrap_or(j);
        let pivot = x[at];
        if scale > 0.0 {
            self.pivot_ratio = self.pivot_ratio.min(pivot.abs() / scale);
        }
        if pivot.is_nan() || pivot.abs() <= floor * scale {
            return Ok(Elimination::Dependent {
                pivot: pivot.abs(),
                scale,
            });
        }
        self.used[j] = row;
        self.r += 1;
        if at != j {
            self.permutation.swap(at, j);
            self.place[self.permutation[at]] = at;
            self.place[self.permutation[j]] = j;
            x.swap(at, j);
            for l_k in before.chunks_exact_mut(n) {
                l_k.swap(at, j);
            }
            self.is_in_order = false;
            self.parity = -self.parity;
        }
        let inverse = 1.0 / pivot;
        self.inverse[j] = inverse;
        for l in &mut x[j + 1..] {
            *l *= inverse;
        }
        Ok(Elimination::Used)
    }

    /// y₁ such that `C·a = γ` with the y₂ that is there: `Uᵀ·s = γ`, `L₁ᵀ·y₁ = s − L₂ᵀ·y₂`.
    pub(super) fn determine(&self, gamma: &[f64], y: &mut [f64]) {
        let rows = self.factors[..self.r * self.n].chunks_exact(self.n.max(1));
        let rows = rows.enumerate();
        for (j, row) in rows.clone() {
            y[j] = (gamma[self.used[j]] - dot(&row[..j], &y[..j])) * self.inverse[j];
        }
        for (j, row) in rows.rev() {
            y[j] -= dot(&row[j + 1..], &y[j + 1..]);
        }
    }

    /// g[..r] ← λ with `L₁·U·λ = g₁`; the other rows of `L·U·λ = g` then hold as well.
    pub(super) fn solve_for_multipliers(&self, g: &mut [f64]) {
        let r = self.r;
        for j in 0..r {
            let g_j = g[j];
            axpy(-g_j, &self.row(j)[j + 1..r], &mut g[j + 1..r]);
        }
        for j in (0..r).rev() {
            let row = self.row(j);
            g[j] *= self.inverse[j];
            let g_j = g[j];
            axpy(-g_j, &row[..j], &mut g[..j]);
        }
    }

    /// Sign and logarithm of `sign(P)·Π u_jj`.
    pub(super) fn pivots(&self) -> (f64, f64) {
        let pivots = || (0..self.r).map(|j| self.factors[j * self.n + j]);
        (
            self.parity * pivots().map(f64::signum).product::<f64>(),
            pivots().map(|u| u.abs().ln()).sum(),
        )
    }
}
