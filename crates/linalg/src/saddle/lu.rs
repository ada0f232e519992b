//! LU of the tall Cᵀ, one row of C after the other: `P·Cᵀ = L·U`, `L = [L₁; L₂]` unit lower
//! trapezoidal, with the entries only that can be other than zero.
//!
//! A row is solved for one of its large remaining entries, in a coordinate in which few later rows
//! have entries: only these are eliminated with it. Which entries can be other than zero depends on
//! these choices, so the first factorisation finds both ([`TallLu::search`]). Later ones repeat
//! them ([`TallLu::repeat`]) up to the first row in which the entry that was chosen has fallen
//! below a share of the present largest, and search from there on. Sources: J. R.
//! Gilbert, T. Peierls, Sparse partial pivoting in time proportional to arithmetic operations,
//! SIAM J. Sci. Stat. Comput. 9 (1988) 862–874; T. A. Davis, E. Palamadai Natarajan, Algorithm
//! 907: KLU, ACM Trans. Math. Softw. 37 (2010) 36, for the repetition.

use super::error::{SaddleError, check_length};
use super::lists::{Entries, Entry, Lists};
use super::order::Order;
use crate::limits::{CANDIDATE, LARGEST_REPEATED, PIVOT_CHOSEN, PIVOT_REPEATED, RESERVED};

/// Factors of the rows that are used.
#[derive(Debug, Clone)]
pub(super) struct TallLu {
    pub(super) n: usize,
    /// Columns outside which each row of C is zero.
    pub(super) columns: Lists,
    /// Coordinates that may be solved for; all if `None`.
    solvable: Option<Vec<bool>>,
    /// Whether rows are solved for smaller entries to spare others. Not where nothing is gained by
    /// that, nor where pivots have to tell how good given coordinates are.
    spares: bool,
    pub(super) order: Order,
    /// The place of each row in the order, none before it is chosen, and for each coordinate the
    /// places of the rows that can have entries there, ascending.
    place: Vec<u32>,
    touching: Lists,
    /// Number of rows in use: all rows without the skipped ones.
    pub(super) r: usize,
    /// The row of C for each row in use, and the coordinate that it is solved for. Of
    /// the last factorisation while the next one repeats it.
    used: Vec<usize>,
    is_used: Vec<bool>,
    pivot: Vec<usize>,
    /// The row in use that is solved for each coordinate, `u32::MAX` for none.
    row_of: Vec<u32>,
    /// Row j: `U_kj` of the rows k < j that it is eliminated with, ascending.
    upper: Entries,
    /// Row j: column j of L below its unit diagonal, by coordinates.
    lower: Entries,
    /// U_jj of each row in use, and 1/U_jj: a product is cheaper than a quotient.
    diagonal: Vec<f64>,
    inverse: Vec<f64>,
    /// Coordinates that no row is solved for.
    pub(super) free: Vec<usize>,
    is_changed: bool,
    /// Smallest `largest entry left / largest entry` of a row, rows left out included.
    pub(super) pivot_ratio: f64,
    work: Work,
}

/// The row that is being eliminated.
#[derive(Debug, Clone)]
struct Work {
    /// Its entries by coordinates; zero between rows.
    x: Vec<f64>,
    /// Coordinates in which it can have entries, in any order, and whether each is among them.
    touched: Vec<usize>,
    is_touched: Vec<bool>,
    /// Set of rows that are still to be eliminated with.
    rows: Vec<u64>,
    /// Its entries of U.
    upper: Vec<Entry>,
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

/// What decides which entry a row is solved for: its size, and masses if they are graded, or else
/// the number of later rows in its coordinate.
#[derive(Clone, Copy)]
struct Choice<'a> {
    solvable: Option<&'a [bool]>,
    graded: Option<&'a [f64]>,
    spares: bool,
}

/// The coordinate that a row is solved for, and the size by which it is compared with others: the
/// largest entry, or its own where masses are graded.
type Chosen = (usize, f64);

impl Choice<'_> {
    /// The coordinate to be solved for, `None` if no entry can be: the wished one if its entry is
    /// large enough, or else the one in which the fewest later rows can have entries.
    fn best(
        self,
        x: &[f64],
        among: impl Iterator<Item = usize> + Clone,
        (wish, later): (Option<usize>, impl Fn(usize) -> usize),
    ) -> Option<Chosen> {
        let among = among.filter(|&i| self.solvable.is_none_or(|solvable| solvable[i]));
        let larger = |a: usize, b: usize| {
            let is_larger = x[b].abs() > x[a].abs() || x[b].abs() == x[a].abs() && b < a;
            if is_larger || x[a].is_nan() { b } else { a }
        };
        let largest = among.clone().reduce(larger)?;
        let size = x[largest].abs();
        if self.graded.is_some() {
            let at = self.lightest(x, among, size)?;
            return Some((at, x[at].abs()));
        }
        let least = if self.spares { PIVOT_CHOSEN } else { 1.0 } * size;
        let candidates = among.filter(|&i| x[i].abs() >= least);
        if let Some(at) = candidates.clone().find(|i| Some(*i) == wish) {
            return Some((at, size));
        }
        let rarer = |a: (usize, usize), b: (usize, usize)| {
            let [rows, other] = [a.1, b.1];
            if other < rows || other == rows && larger(a.0, b.0) == b.0 {
                b
            } else {
                a
            }
        };
        let rarest = candidates.map(|i| (i, later(i))).reduce(rarer);
        Some((rarest.map_or(largest, |(at, _)| at), size))
    }

    /// The coordinate with the largest c²/m among the large entries of graded masses.
    fn lightest(
        self,
        x: &[f64],
        among: impl Iterator<Item = usize>,
        largest: f64,
    ) -> Option<usize> {
        let mass = self.graded?;
        let candidates = among.filter(|&i| x[i].abs() >= CANDIDATE * largest);
        // Compares c²/m without quotients: masses may be zero.
        let lighter = |a: usize, b: usize| {
            let [of_a, of_b] = [x[a] * x[a] * mass[b], x[b] * x[b] * mass[a]];
            if of_b > of_a || of_b == of_a && b < a {
                b
            } else {
                a
            }
        };
        candidates.reduce(lighter)
    }

    /// Size of the largest entry that can be solved for, if the one of this coordinate is still as
    /// good as the best one, except for the share [`PIVOT_REPEATED`].
    fn largest(
        self,
        x: &[f64],
        at: usize,
        others: impl Iterator<Item = usize> + Clone,
    ) -> Option<f64> {
        let pivot = x[at].abs();
        let larger = |m: f64, i: usize| if x[i].abs() > m { x[i].abs() } else { m };
        let Some(mass) = self.graded else {
            let largest = match self.solvable {
                None => others.fold(pivot, larger),
                Some(solvable) => others.filter(|&i| solvable[i]).fold(pivot, larger),
            };
            // False for NaN, too.
            let share = if self.spares {
                PIVOT_REPEATED
            } else {
                LARGEST_REPEATED
            };
            return (pivot >= share * largest).then_some(largest);
        };
        let others = others.filter(|&i| self.solvable.is_none_or(|solvable| solvable[i]));
        let all = others.chain([at]);
        let largest = all.clone().fold(0.0, larger);
        let best = self.lightest(x, all, largest)?;
        let share = LARGEST_REPEATED * x[best];
        let is_light = x[at] * x[at] * mass[best] >= share * share * mass[at];
        // Compared with others, a row solved for a light coordinate has its own pivot.
        (pivot >= CANDIDATE * largest && is_light).then_some(pivot)
    }
}

/// Sum of entries times the values at their places.
#[inline(always)]
fn product(entries: &[Entry], x: &[f64]) -> f64 {
    entries.iter().map(|l| l.value * x[l.index()]).sum()
}

impl TallLu {
    /// For n coordinates and rows with entries in these columns, all below n.
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
            order: Order::default(),
            place: Vec::with_capacity(rows),
            touching: Lists::with_capacity(n, entries),
            solvable: None,
            spares: false,
            r: 0,
            used: Vec::with_capacity(rows),
            is_used: vec![false; rows],
            pivot: Vec::with_capacity(rows),
            row_of: vec![u32::MAX; n],
            upper: Entries::with_capacity(rows, reserved),
            lower: Entries::with_capacity(rows, reserved),
            diagonal: vec![0.0; rows],
            inverse: vec![0.0; rows],
            free: (0..n).collect(),
            is_changed: true,
            pivot_ratio: f64::INFINITY,
            work: Work {
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
        [&self.upper, &self.lower].map(Entries::n_entries)
    }

    /// From now on rows are solved for these coordinates only; for any if `None`.
    pub(super) fn solve_for(&mut self, solvable: Option<Vec<bool>>) {
        self.solvable = solvable;
        self.place.clear();
        self.keep(0);
    }

    /// Removes all rows. Their order is chosen, by these values, if that has not been done.
    pub(super) fn begin<'c>(&mut self, row: impl Fn(usize) -> &'c [f64]) {
        self.pivot_ratio = f64::INFINITY;
        self.r = 0;
        if self.place.len() < self.n_rows() {
            self.choose_order(row);
        }
    }

    fn choose_order<'c>(&mut self, row: impl Fn(usize) -> &'c [f64]) {
        let entries = |k: usize| {
            let entries = self.columns.of(k).iter().zip(row(k));
            entries.map(|(&i, &c)| Entry::new(i as usize, c)).collect()
        };
        let rows = (0..self.n_rows()).map(entries).collect();
        self.order = Order::new(self.n, rows, self.solvable.as_deref());
        self.spares = self.solvable.is_none() && self.order.is_planned();
        self.place.resize(self.n_rows(), 0);
        let mut touching = vec![Vec::new(); self.n];
        for (place, &row) in self.order.rows.iter().enumerate() {
            self.place[row] = place as u32;
            for &column in self.columns.of(row) {
                touching[column as usize].push(place as u32);
            }
        }
        self.touching.clear();
        touching
            .into_iter()
            .for_each(|list| self.touching.push(list));
    }

    /// The rows of C in use.
    pub(super) fn used(&self) -> &[usize] {
        &self.used[..self.r]
    }

    /// Whether row k of C is in use.
    pub(super) fn uses(&self, k: usize) -> bool {
        self.is_used[k]
    }

    /// The coordinate that each row in use is solved for.
    pub(super) fn pivots(&self) -> &[usize] {
        &self.pivot[..self.r]
    }

    /// Computes the next column of U and of L from the values of a row of C in its columns:
    /// scatter, eliminate with the rows before, pivot. `graded` contains the masses if they affect
    /// which coordinate is solved for.
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
        if self.used.get(j) == Some(&row) {
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
                self.used.push(row);
                self.pivot.push(at);
                self.row_of[at] = j as u32;
                self.upper.push(self.work.upper.iter().copied());
                let Work { x, touched, .. } = &self.work;
                let row_of = &self.row_of;
                let below = touched.iter().filter(|&&i| row_of[i] == u32::MAX);
                let inverse = 1.0 / pivot;
                let entry = |&i: &usize| Entry::new(i, x[i] * inverse);
                self.lower.push(below.map(entry));
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

    /// Eliminates the row in the scratch with the rows and entries of the last factorisation.
    /// Returns its pivot, the inverse of it, and the size of the largest entry, or nothing if
    /// another coordinate should be solved for; the scratch is zero in either case.
    fn repeat(&mut self, graded: Option<&[f64]>, least: f64) -> Option<[f64; 3]> {
        let j = self.r;
        let x = &mut self.work.x[..];
        for entry in self.upper.of_mut(j) {
            let u_kj = std::mem::take(&mut x[entry.at()]);
            entry.value = u_kj;
            // Entries of a joint along the axes of the ground are often zero.
            if u_kj != 0.0 {
                for l in self.lower.of(entry.index()) {
                    x[l.index()] -= u_kj * l.value;
                }
            }
        }
        let at = self.pivot[j];
        let choice = Choice {
            solvable: self.solvable.as_deref(),
            graded,
            spares: self.spares,
        };
        let below = self.lower.of_mut(j);
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

    /// Eliminates a row with the rows before it, wherever it can have entries, and leaves the
    /// result in the scratch. Returns the coordinate that it is best solved for.
    fn search(&mut self, (row, c_j): (usize, &[f64]), graded: Option<&[f64]>) -> Option<Chosen> {
        let j = self.r as u32;
        let Work {
            x,
            touched,
            is_touched,
            rows,
            upper,
        } = &mut self.work;
        let row_of = &self.row_of;
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
            // Elimination with a row adds later rows only.
            while rows[word] != 0 {
                let bit = rows[word].trailing_zeros();
                rows[word] &= rows[word] - 1;
                let k = 64 * word + bit as usize;
                let at = self.pivot[k];
                let u_kj = x[at];
                upper.push(Entry::of_row(k, at, u_kj));
                for l in self.lower.of(k) {
                    x[l.index()] -= u_kj * l.value;
                    touch(l.index(), rows);
                }
            }
        }
        touched.sort_unstable();
        let choice = Choice {
            solvable: self.solvable.as_deref(),
            graded,
            spares: self.spares,
        };
        let left = touched.iter().copied().filter(|&i| row_of[i] >= j);
        let place = self.place[row];
        let later = |i: usize| {
            let places = self.touching.of(i);
            places.len() - places.partition_point(|&p| p <= place)
        };
        choice.best(x, left, (self.order.wish[place as usize], later))
    }

    /// Clears the scratch of a row.
    fn clear(&mut self) {
        let Work {
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

    /// Forgets what the last factorisation did with all but its first rows.
    fn keep(&mut self, rows: usize) {
        if rows >= self.used.len() {
            return;
        }
        self.is_changed = true;
        for &coordinate in &self.pivot[rows..] {
            self.row_of[coordinate] = u32::MAX;
        }
        self.used.truncate(rows);
        self.pivot.truncate(rows);
        self.upper.truncate(rows);
        self.lower.truncate(rows);
    }

    fn accept(&mut self, pivot: f64, inverse: f64) {
        self.diagonal[self.r] = pivot;
        self.inverse[self.r] = inverse;
        self.r += 1;
    }

    fn note(&mut self, left: f64, scale: f64) {
        if scale > 0.0 {
            self.pivot_ratio = self.pivot_ratio.min(left.abs() / scale);
        }
    }

    /// Ends a factorisation; returns whether other coordinates are solved for than before.
    pub(super) fn finish(&mut self) -> bool {
        self.keep(self.r);
        let is_changed = std::mem::take(&mut self.is_changed);
        if is_changed {
            let row_of = &self.row_of;
            self.free.clear();
            self.free
                .extend((0..self.n).filter(|&i| row_of[i] == u32::MAX));
            self.is_used.fill(false);
            self.used.iter().for_each(|&row| self.is_used[row] = true);
        }
        is_changed
    }

    /// For each row in use, the last one first, the coordinate that it is solved for, and the
    /// column of L below its diagonal.
    #[inline(always)]
    pub(super) fn backward(&self) -> impl Iterator<Item = (usize, &[Entry])> {
        let pivots = self.pivot[..self.r].iter().enumerate().rev();
        pivots.map(|(j, &at)| (at, self.lower.of(j)))
    }

    /// The entries of y that are solved for, such that `C·y = γ` with the others that are there:
    /// `Uᵀ·s = γ`, `L₁ᵀ·y₁ = s − L₂ᵀ·y₂`.
    pub(super) fn determine(&self, gamma: &[f64], y: &mut [f64]) {
        for (j, (&row, &at)) in self.used.iter().zip(&self.pivot).enumerate() {
            let upper = self.upper.of(j).iter();
            let sum: f64 = upper.map(|u| u.value * y[u.at()]).sum();
            y[at] = (gamma[row] - sum) * self.inverse[j];
        }
        for (j, &at) in self.pivot.iter().enumerate().rev() {
            y[at] -= product(self.lower.of(j), y);
        }
    }

    /// λ of the rows in use with `L·U·λ = g`, whose rows all hold if those of L₁ do; uses up g,
    /// which is by coordinates.
    pub(super) fn solve_for_multipliers(&self, g: &mut [f64], lambda: &mut [f64]) {
        for (j, &at) in self.pivot.iter().enumerate() {
            let g_j = g[at];
            for l in self.lower.of(j) {
                g[l.index()] -= g_j * l.value;
            }
        }
        for (j, &at) in self.pivot.iter().enumerate().rev() {
            let lambda_j = g[at] * self.inverse[j];
            lambda[self.used[j]] = lambda_j;
            for u in self.upper.of(j) {
                g[u.at()] -= lambda_j * u.value;
            }
        }
    }

    /// Sign and logarithm of `sign(P)·Π u_jj`, where P takes the coordinates that are solved for
    /// first, and then the free ones.
    pub(super) fn determinant(&self) -> (f64, f64) {
        let order: Vec<usize> = self.pivot.iter().chain(&self.free).copied().collect();
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
        let diagonal = &self.diagonal[..self.r];
        (
            sign * diagonal.iter().map(|u| u.signum()).product::<f64>(),
            diagonal.iter().map(|u| u.abs().ln()).sum(),
        )
    }
}
