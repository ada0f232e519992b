//! LU factorisation of the tall Cᵀ, one row of C after the other: `P·Cᵀ = L·U`, with a unit lower
//! trapezoidal `L = [L₁; L₂]`. Only entries that can be nonzero are stored.
//!
//! The pivot of a row is one of its large remaining entries. The coordinate of the pivot is one in
//! which few later rows have entries, because only these rows are eliminated with the pivot. The
//! positions of nonzero entries depend on the pivot coordinates, so the first factorisation finds
//! both ([`TallLu::search`]). Later factorisations repeat both ([`TallLu::repeat`]) up to the first
//! row in which the chosen entry is below a share of the present largest entry. Later
//! factorisations search again from this row onwards. Sources: J. R. Gilbert, T. Peierls, Sparse
//! partial pivoting in time proportional to arithmetic operations, SIAM J. Sci. Stat. Comput. 9
//! (1988) 862–874; T. A. Davis, E. Palamadai Natarajan, Algorithm 907: KLU, ACM Trans. Math. Softw.
//! 37 (2010) 36, for the repetition.

use super::error::{SaddleError, check_length};
use super::lists::{Entries, Entry, Lists};
use super::order::Order;
use super::plan::{Plan, RowPivot};
use crate::limits::RESERVED;

/// Factors of the rows that are used.
#[derive(Debug, Clone)]
pub(super) struct TallLu {
    pub(super) n: usize,
    /// The columns in which each row of C can have nonzero entries.
    pub(super) columns: Lists,
    plan: Plan,
    /// Number of rows in use: all rows except the skipped rows.
    pub(super) r: usize,
    solved: PivotRows,
    factors: LuFactors,
    /// Coordinates that are not pivots.
    pub(super) free: Vec<usize>,
    is_changed: bool,
    /// Smallest ratio `largest remaining entry / largest entry` of a row, including skipped rows.
    pub(super) pivot_ratio: f64,
    work: EliminationRow,
}

/// Rows in use and their pivot coordinates. While a factorisation repeats the previous
/// factorisation, these rows and coordinates are those of the previous factorisation.
#[derive(Debug, Clone)]
struct PivotRows {
    /// Index in C of each row in use. `pivot` contains the pivot coordinate of the row.
    used: Vec<usize>,
    pivot: Vec<usize>,
    /// Whether each row of C is in use.
    is_used: Vec<bool>,
    /// The row in use whose pivot is at each coordinate, or `u32::MAX`.
    row_of: Vec<u32>,
}

/// Entries of L and U.
#[derive(Debug, Clone)]
struct LuFactors {
    /// Row j contains `U_kj` for the rows k < j with which row j is eliminated, ascending.
    upper: Entries,
    /// Row j contains column j of L below its unit diagonal, by coordinates.
    lower: Entries,
    /// U_jj of each row in use, and 1/U_jj. A product with 1/U_jj is cheaper than a quotient.
    diagonal: Vec<f64>,
    inverse: Vec<f64>,
}

/// The row that is being eliminated.
#[derive(Debug, Clone)]
struct EliminationRow {
    /// Entries of the row by coordinates; zero between rows.
    x: Vec<f64>,
    /// Coordinates in which the row can have entries, in any order. A second list states for each
    /// coordinate whether it is in the first list.
    touched: Vec<usize>,
    is_touched: Vec<bool>,
    /// Set of rows with which the row must still be eliminated.
    rows: Vec<u64>,
    /// Entries of U in this row.
    upper: Vec<Entry>,
}

/// Result of the elimination of a row.
pub(super) enum Elimination {
    Used,
    /// The row depends on the previous rows. The values are its largest remaining entry and its
    /// largest initial entry.
    Dependent {
        pivot: f64,
        scale: f64,
    },
}

/// Returns the sum of entries times the values at their positions.
#[inline(always)]
fn product(entries: &[Entry], x: &[f64]) -> f64 {
    entries.iter().map(|l| l.value * x[l.index()]).sum()
}

impl TallLu {
    /// Creates the factors for n coordinates and rows with entries in these columns, all below n.
    pub(super) fn new(n: usize, columns: &[Vec<usize>]) -> Self {
        let rows = columns.len();
        let entries = columns.iter().map(Vec::len).sum();
        let mut lists = Lists::with_capacity(rows, entries);
        for list in columns {
            lists.push(list.iter().map(|&column| column as u32));
        }
        let reserved = (rows * n).min(RESERVED);
        Self {
            n,
            columns: lists,
            plan: Plan::new(n, rows, entries),
            r: 0,
            solved: PivotRows {
                used: Vec::with_capacity(rows),
                pivot: Vec::with_capacity(rows),
                is_used: vec![false; rows],
                row_of: vec![u32::MAX; n],
            },
            factors: LuFactors {
                upper: Entries::with_capacity(rows, reserved),
                lower: Entries::with_capacity(rows, reserved),
                diagonal: vec![0.0; rows],
                inverse: vec![0.0; rows],
            },
            free: (0..n).collect(),
            is_changed: true,
            pivot_ratio: f64::INFINITY,
            work: EliminationRow {
                x: vec![0.0; n],
                touched: Vec::with_capacity(n),
                is_touched: vec![false; n],
                rows: vec![0; rows.div_ceil(64)],
                upper: Vec::with_capacity(rows),
            },
        }
    }

    pub(super) fn n_rows(&self) -> usize {
        self.columns.len()
    }

    /// Numbers of entries of U and of L below their diagonals.
    #[cfg(test)]
    pub(super) fn n_entries(&self) -> [usize; 2] {
        [&self.factors.upper, &self.factors.lower].map(Entries::n_entries)
    }

    /// Permits only these coordinates as pivots from the next factorisation on; `None` permits all.
    pub(super) fn solve_for(&mut self, solvable: Option<Vec<bool>>) {
        self.plan.solve_for(solvable);
        self.keep(0);
    }

    /// Returns the order of the rows.
    pub(super) fn order(&self) -> &Order {
        &self.plan.order
    }

    /// Removes all rows. The values of the rows determine the order of elimination, unless the
    /// order has already been chosen.
    pub(super) fn begin<'c>(&mut self, row: impl Fn(usize) -> &'c [f64]) {
        self.pivot_ratio = f64::INFINITY;
        self.r = 0;
        if self.plan.is_due(&self.columns) {
            self.plan.choose(self.n, &self.columns, row);
        }
    }

    /// Returns the rows of C in use.
    pub(super) fn used(&self) -> &[usize] {
        &self.solved.used[..self.r]
    }

    /// Returns whether row k of C is in use.
    pub(super) fn uses(&self, k: usize) -> bool {
        self.solved.is_used[k]
    }

    /// Returns the pivot coordinate of each row in use.
    pub(super) fn pivots(&self) -> &[usize] {
        &self.solved.pivot[..self.r]
    }

    /// Computes the next column of U and of L from the values of a row of C in its columns. The
    /// steps are: scatter, eliminate with the previous rows, pivot. `graded` contains the masses if
    /// they affect the choice of the pivot coordinate.
    pub(super) fn eliminate(
        &mut self,
        (row, c_j): (usize, &[f64]),
        graded: Option<&[f64]>,
        floor: f64,
    ) -> Result<Elimination, SaddleError> {
        let columns = self.columns.of(row);
        check_length("row of C", c_j, columns.len())?;
        let x = &mut self.work.x[..];
        // x·0 is NaN exactly for NaN and infinities.
        let (mut scale, mut zero) = (0.0_f64, 0.0);
        for (&i, &c) in columns.iter().zip(c_j) {
            x[i as usize] = c;
            zero += c * 0.0;
            scale = if c.abs() > scale { c.abs() } else { scale };
        }
        if zero != 0.0 {
            columns.iter().for_each(|&i| x[i as usize] = 0.0);
            let at = c_j.iter().position(|c| !c.is_finite()).unwrap_or(0);
            return Err(SaddleError::NonFinite {
                argument: "C",
                index: row * self.n + columns[at] as usize,
                value: c_j[at],
            });
        }
        let least = floor * scale;
        let j = self.r;
        if self.solved.used.get(j) == Some(&row) {
            if let Some([pivot, inverse, largest]) = self.repeat(graded, least) {
                self.note(largest, scale);
                self.accept(pivot, inverse);
                return Ok(Elimination::Used);
            }
            self.keep(j);
        }
        let found = self.search((row, c_j), graded);
        let size = found.map_or(0.0, |(_, size)| size);
        match found {
            Some((at, _)) if size > least => {
                let pivot = self.work.x[at];
                self.keep(j);
                self.is_changed = true;
                self.solved.used.push(row);
                self.solved.pivot.push(at);
                self.solved.row_of[at] = j as u32;
                self.factors.upper.push(self.work.upper.iter().copied());
                let EliminationRow { x, touched, .. } = &self.work;
                let row_of = &self.solved.row_of;
                let below = touched.iter().filter(|&&i| row_of[i] == u32::MAX);
                let inverse = 1.0 / pivot;
                let entry = |&i: &usize| Entry::new(i, x[i] * inverse);
                self.factors.lower.push(below.map(entry));
                self.clear();
                self.note(size, scale);
                self.accept(pivot, inverse);
                Ok(Elimination::Used)
            }
            _ => {
                self.clear();
                self.note(size, scale);
                Ok(Elimination::Dependent { pivot: size, scale })
            }
        }
    }

    /// Eliminates the row in the buffer with the rows and entries of the last factorisation.
    /// Returns its pivot, the inverse of the pivot, and the size of the largest entry. Returns
    /// `None` if another coordinate should be the pivot. After the call, all values of the buffer
    /// are zero.
    fn repeat(&mut self, graded: Option<&[f64]>, least: f64) -> Option<[f64; 3]> {
        let j = self.r;
        let x = &mut self.work.x[..];
        for entry in self.factors.upper.of_mut(j) {
            let u_kj = std::mem::take(&mut x[entry.at()]);
            entry.value = u_kj;
            // Entries of a joint along the axes of the ground are often zero.
            if u_kj != 0.0 {
                for l in self.factors.lower.of(entry.index()) {
                    x[l.index()] -= u_kj * l.value;
                }
            }
        }
        let at = self.solved.pivot[j];
        let choice = self.plan.choice(graded);
        let below = self.factors.lower.of_mut(j);
        let pivot = x[at];
        let largest = choice.largest(x, at, below.iter().map(Entry::index));
        let largest = largest.filter(|_| pivot.abs() > least);
        x[at] = 0.0;
        let inverse = 1.0 / pivot;
        for entry in below {
            entry.value = std::mem::take(&mut x[entry.index()]) * inverse;
        }
        Some([pivot, inverse, largest?])
    }

    /// Eliminates a row with the previous rows at all possible entries, and leaves the result in
    /// the buffer. Returns the best pivot coordinate.
    fn search(&mut self, (row, c_j): (usize, &[f64]), graded: Option<&[f64]>) -> Option<RowPivot> {
        let j = self.r as u32;
        let EliminationRow {
            x,
            touched,
            is_touched,
            rows,
            upper,
        } = &mut self.work;
        let row_of = &self.solved.row_of;
        let mut touch = |i: usize, rows: &mut [u64]| {
            if !std::mem::replace(&mut is_touched[i], true) {
                touched.push(i);
                let k = row_of[i];
                if k < j {
                    rows[k as usize / 64] |= 1 << (k % 64);
                }
            }
        };
        for (&i, &c) in self.columns.of(row).iter().zip(c_j) {
            x[i as usize] = c;
            touch(i as usize, rows);
        }
        for word in 0..rows.len() {
            // Elimination with a row adds only later rows.
            while rows[word] != 0 {
                let bit = rows[word].trailing_zeros();
                rows[word] &= rows[word] - 1;
                let k = 64 * word + bit as usize;
                let at = self.solved.pivot[k];
                let u_kj = x[at];
                upper.push(Entry::of_row(k, at, u_kj));
                for l in self.factors.lower.of(k) {
                    x[l.index()] -= u_kj * l.value;
                    touch(l.index(), rows);
                }
            }
        }
        touched.sort_unstable();
        let left = touched.iter().copied().filter(|&i| row_of[i] >= j);
        self.plan
            .choice(graded)
            .best(x, left, self.plan.of_row(row))
    }

    /// Clears the buffer of a row.
    fn clear(&mut self) {
        let EliminationRow {
            x,
            touched,
            is_touched,
            upper,
            ..
        } = &mut self.work;
        for i in touched.drain(..) {
            x[i] = 0.0;
            is_touched[i] = false;
        }
        upper.clear();
    }

    /// Removes the results of the last factorisation except for its first rows.
    fn keep(&mut self, rows: usize) {
        if rows >= self.solved.used.len() {
            return;
        }
        self.is_changed = true;
        for &coordinate in &self.solved.pivot[rows..] {
            self.solved.row_of[coordinate] = u32::MAX;
        }
        self.solved.used.truncate(rows);
        self.solved.pivot.truncate(rows);
        self.factors.upper.truncate(rows);
        self.factors.lower.truncate(rows);
    }

    fn accept(&mut self, pivot: f64, inverse: f64) {
        self.factors.diagonal[self.r] = pivot;
        self.factors.inverse[self.r] = inverse;
        self.r += 1;
    }

    fn note(&mut self, left: f64, scale: f64) {
        if scale > 0.0 {
            self.pivot_ratio = self.pivot_ratio.min(left.abs() / scale);
        }
    }

    /// Ends a factorisation. Returns whether its pivot coordinates differ from the pivot
    /// coordinates of the previous factorisation.
    pub(super) fn finish(&mut self) -> bool {
        self.keep(self.r);
        let is_changed = std::mem::take(&mut self.is_changed);
        if is_changed {
            let row_of = &self.solved.row_of;
            self.free.clear();
            self.free
                .extend((0..self.n).filter(|&i| row_of[i] == u32::MAX));
            self.solved.is_used.fill(false);
            self.solved
                .used
                .iter()
                .for_each(|&row| self.solved.is_used[row] = true);
        }
        is_changed
    }

    /// Returns, for each row in use, its pivot coordinate and the column of L below its diagonal.
    /// The last row comes first.
    #[inline(always)]
    pub(super) fn backward(&self) -> impl Iterator<Item = (usize, &[Entry])> {
        let pivots = self.solved.pivot[..self.r].iter().enumerate().rev();
        pivots.map(|(j, &at)| (at, self.factors.lower.of(j)))
    }

    /// Computes the pivot entries of y such that `C·y = γ`, where the other entries of y are given:
    /// `Uᵀ·s = γ`, `L₁ᵀ·y₁ = s − L₂ᵀ·y₂`.
    pub(super) fn determine(&self, gamma: &[f64], y: &mut [f64]) {
        for (j, (&row, &at)) in self.solved.used.iter().zip(&self.solved.pivot).enumerate() {
            let upper = self.factors.upper.of(j).iter();
            let sum: f64 = upper.map(|u| u.value * y[u.at()]).sum();
            y[at] = (gamma[row] - sum) * self.factors.inverse[j];
        }
        for (j, &at) in self.solved.pivot.iter().enumerate().rev() {
            y[at] -= product(self.factors.lower.of(j), y);
        }
    }

    /// Computes λ of the rows in use from `L·U·λ = g`. If the equations of L₁ are satisfied, all
    /// equations are satisfied. The function overwrites g, whose entries belong to coordinates.
    pub(super) fn solve_for_multipliers(&self, g: &mut [f64], lambda: &mut [f64]) {
        for (j, &at) in self.solved.pivot.iter().enumerate() {
            let g_j = g[at];
            for l in self.factors.lower.of(j) {
                g[l.index()] -= g_j * l.value;
            }
        }
        for (j, &at) in self.solved.pivot.iter().enumerate().rev() {
            let lambda_j = g[at] * self.factors.inverse[j];
            lambda[self.solved.used[j]] = lambda_j;
            for u in self.factors.upper.of(j) {
                g[u.at()] -= lambda_j * u.value;
            }
        }
    }

    /// Returns the sign and the logarithm of `sign(P)·Π u_jj`. The permutation P puts the pivot
    /// coordinates first, followed by the free coordinates.
    pub(super) fn determinant(&self) -> (f64, f64) {
        let order: Vec<usize> = self
            .solved
            .pivot
            .iter()
            .chain(&self.free)
            .copied()
            .collect();
        let mut is_seen = vec![false; self.n];
        let mut sign = 1.0;
        for first in 0..self.n {
            let (mut i, mut length) = (first, 0);
            while !std::mem::replace(&mut is_seen[i], true) {
                i = order[i];
                length += 1;
            }
            // A cycle of even length is an odd permutation.
            if length > 0 && length % 2 == 0 {
                sign = -sign;
            }
        }
        let diagonal = &self.factors.diagonal[..self.r];
        (
            sign * diagonal.iter().map(|u| u.signum()).product::<f64>(),
            diagonal.iter().map(|u| u.abs().ln()).sum(),
        )
    }
}
