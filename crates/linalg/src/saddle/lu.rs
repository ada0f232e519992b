//! LU with partial pivoting of the tall Cᵀ, one row of C after the other: `P·Cᵀ = L·U`,
//! `L = [L₁; L₂]` unit lower trapezoidal.

use std::mem;
use std::ops::Range;

use super::error::{SaddleError, check_finite, check_length};
use super::fill::Fill;
use super::order::Order;
use crate::limits::{AS_LARGE, CANDIDATE};

/// Factors of the rows that are used, without their zeros.
#[derive(Debug, Clone)]
pub(super) struct TallLu {
    pub(super) n: usize,
    /// Number of rows in use: all rows without the skipped ones.
    pub(super) r: usize,
    /// The row of C for each row in use, ascending.
    used: Vec<usize>,
    /// Where rows have entries, if they were not all solved for the coordinates of the order.
    own: Fill,
    has_own: bool,
    /// Row j: `U_0j … U_jj`, then column j of L below its unit diagonal.
    factors: Vec<f64>,
    /// 1/U_jj of each row in use: a product is cheaper than a quotient.
    inverse: Vec<f64>,
    /// A row on its way, zero between two of them; n.
    x: Vec<f64>,
    /// Position i of P·x is coordinate `permutation[i]`, coordinate j is at `place[j]`.
    pub(super) permutation: Vec<usize>,
    place: Vec<usize>,
    /// Sign of P.
    parity: f64,
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
            own: Fill::new(n, rows),
            has_own: false,
            factors: vec![0.0; rows * n],
            inverse: vec![0.0; rows],
            x: vec![0.0; n],
            permutation: (0..n).collect(),
            place: (0..n).collect(),
            parity: 1.0,
            pivot_ratio: f64::INFINITY,
        }
    }

    /// Removes all rows; coordinates are used in this order.
    pub(super) fn begin(&mut self, order: &Order) {
        self.permutation.copy_from_slice(&order.coordinates);
        self.place.copy_from_slice(&order.place);
        self.has_own = false;
        self.parity = order.parity;
        self.pivot_ratio = f64::INFINITY;
        self.r = 0;
    }

    /// The rows of C in use, ascending.
    pub(super) fn used(&self) -> &[usize] {
        &self.used[..self.r]
    }

    /// Whether rows were solved for other coordinates than those of the order, or left out.
    pub(super) fn has_turned(&self) -> bool {
        self.has_own
    }

    /// Where the factors have entries.
    pub(super) fn fill<'a>(&'a self, order: &'a Order) -> &'a Fill {
        if self.has_own { &self.own } else { &order.fill }
    }

    /// `start − Σ L_ij·y_i` over column j of L below its diagonal.
    pub(super) fn less_lower(&self, fill: &Fill, j: usize, start: f64, y: &[f64]) -> f64 {
        self.less(fill, fill.row(j).lower(), start, y)
    }

    fn less(&self, fill: &Fill, entries: Range<usize>, start: f64, y: &[f64]) -> f64 {
        let factors = self.factors[entries.clone()].iter();
        let terms = factors.zip(fill.positions(entries));
        terms.fold(start, |left, (factor, &i)| left - factor * y[i])
    }

    /// Subtracts a multiple of these entries from x.
    fn subtract(&self, fill: &Fill, entries: Range<usize>, by: f64, x: &mut [f64]) {
        let factors = self.factors[entries.clone()].iter();
        for (factor, &i) in factors.zip(fill.positions(entries)) {
            x[i] -= by * factor;
        }
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
        let j = self.r;
        check_length("row of C", c_j, self.n)?;
        let columns = &order.columns[row];
        if self.has_own {
            self.own.push(columns, &self.place);
        }
        let fill = if self.has_own { &self.own } else { &order.fill };
        let (x, place) = (&mut self.x[..], &self.place[..]);
        // It is not finite if an entry is not.
        let (mut scale, mut sum) = (0.0_f64, 0.0);
        for &column in columns {
            let c = c_j[column];
            x[place[column]] = c;
            sum += c.abs();
            scale = if c.abs() > scale { c.abs() } else { scale };
        }
        if !sum.is_finite()
            && let Err(error) = check_finite("C", c_j, row * self.n)
        {
            x.fill(0.0);
            return Err(error);
        }
        let own = fill.row(j);
        let (before, u_j) = self.factors.split_at_mut(own.start);
        for (&k, u_kj) in fill.positions(own.upper()).iter().zip(u_j) {
            let u = mem::take(&mut x[k]);
            *u_kj = u;
            let below = fill.row(k).lower();
            for (l_ik, &i) in before[below.clone()].iter().zip(fill.positions(below)) {
                x[i] -= u * l_ik;
            }
        }

        let below = fill.positions(own.lower());
        let solvable = order.solvable;
        let mut largest = if x[j].abs() > 0.0 { x[j].abs() } else { 0.0 };
        for &i in below {
            if x[i].abs() > largest && i < solvable {
                largest = x[i].abs();
            }
        }
        let enough = AS_LARGE * largest;
        let mut at = j;
        if !(order.is_chosen && x[j].abs() >= enough) {
            let as_large = |&i: &usize| i < solvable && x[i].abs() >= enough;
            let candidates = [j]
                .into_iter()
                .chain(below.iter().copied())
                .filter(as_large);
            let met = |&i: &usize| order.rows_of[self.permutation[i]];
            at = candidates.min_by_key(met).unwrap_or(j);
        }
        if let Some(mass) = graded {
            let candidates = [j].into_iter().chain(below.iter().copied());
            let candidates =
                candidates.filter(|&i| i < solvable && x[i].abs() >= CANDIDATE * largest);
            let mass = |i: usize| mass[self.permutation[i]];
            // Compares c²/m without quotients: masses may be zero.
            let lightest = candidates.reduce(|a, b| {
                if x[b] * x[b] * mass(a) > x[a] * x[a] * mass(b) {
                    b
                } else {
                    a
                }
            });
            at = lightest.unwrap_or(j);
        }
        x.swap(at, j);
        let pivot = mem::take(&mut x[j]);
        if scale > 0.0 {
            self.pivot_ratio = self.pivot_ratio.min(largest / scale);
        }
        let is_used = largest > floor * scale && !pivot.is_nan();
        let inverse = 1.0 / pivot;
        self.factors[own.diagonal] = pivot;
        for (l_ij, &i) in self.factors[own.lower()].iter_mut().zip(below) {
            *l_ij = mem::take(&mut x[i]) * inverse;
        }
        let known = if is_used { j + 1 } else { j };
        if self.has_own {
            self.own.truncate(known);
        } else if !is_used || at != j {
            self.own.copy_first(known, &order.fill);
            self.has_own = true;
        }
        if !is_used {
            let pivot = largest;
            return Ok(Elimination::Dependent { pivot, scale });
        }
        if at != j {
            self.own.swap(at);
            self.permutation.swap(at, j);
            self.place[self.permutation[at]] = at;
            self.place[self.permutation[j]] = j;
            self.parity = -self.parity;
        }
        (self.used[j], self.inverse[j]) = (row, inverse);
        self.r += 1;
        Ok(Elimination::Used)
    }

    /// y₁ such that `C·a = γ` with the y₂ that is there: `Uᵀ·s = γ`, `L₁ᵀ·y₁ = s − L₂ᵀ·y₂`.
    pub(super) fn determine(&self, order: &Order, gamma: &[f64], y: &mut [f64]) {
        let fill = self.fill(order);
        for (j, (&row, inverse)) in self.used().iter().zip(&self.inverse).enumerate() {
            y[j] = self.less(fill, fill.row(j).upper(), gamma[row], y) * inverse;
        }
        for j in (0..self.r).rev() {
            y[j] = self.less_lower(fill, j, y[j], y);
        }
    }

    /// g[..r] ← λ with `L₁·U·λ = g₁`; the other rows of `L·U·λ = g` then hold as well.
    pub(super) fn solve_for_multipliers(&self, order: &Order, g: &mut [f64]) {
        let fill = self.fill(order);
        for j in 0..self.r {
            self.subtract(fill, fill.row(j).lower(), g[j], g);
        }
        for j in (0..self.r).rev() {
            g[j] *= self.inverse[j];
            self.subtract(fill, fill.row(j).upper(), g[j], g);
        }
    }

    /// Sign and logarithm of `sign(P)·Π u_jj`.
    pub(super) fn pivots(&self, order: &Order) -> (f64, f64) {
        let fill = self.fill(order);
        let pivots = || (0..self.r).map(|j| self.factors[fill.row(j).diagonal]);
        (
            self.parity * pivots().map(f64::signum).product::<f64>(),
            pivots().map(|u| u.abs().ln()).sum(),
        )
    }
}
