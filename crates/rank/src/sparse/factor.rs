//! The factorisation C = Q·R. The factorisation proceeds body by body and also determines the rank.
//!
//! Each front is triangularised by Householder reflections. A pivot column whose remaining norm is
//! below the tolerance is *dead* and skipped (Heath's rule). Columns are exchanged only with
//! columns of the same body. The part of the front below its pivots is also triangularised. The
//! front therefore has at most as many rows as columns when it is passed to the parent front. Rows
//! that become zero span the left null space. E collects all entries that are set to zero: `C + E =
//! Q·R` up to rounding, hence `σ_{r+1}(C) ≤ ‖E‖`. Dropping dead columns does not change the live
//! columns. Another module decides whether this rank is reliable: the live columns may be nearly
//! dependent although no single column indicates it.
//!
//! Source: M. T. Heath, Some extensions of an algorithm for sparse linear least squares problems,
//! SIAM J. Sci. Stat. Comput. 3 (1982) 223–237; T. A. Davis, Algorithm 915: SuiteSparseQR, ACM
//! Trans. Math. Softw. 38 (2011) 8.

use std::ops::Range;

use super::front::{Assembly, OutsidePattern};
use super::reflectors::Reflectors;
use super::symbolic::{Front, KeptFactor, Symbolic};
use super::trapezoid::Trapezoid;
use linalg::SparseMatrix;
use linalg::kernels;

#[cfg(test)]
mod tests;

/// Limits below which remainders count as zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tolerances {
    /// Limit for the remaining norm of a column when its body is eliminated.
    pub(super) dead: f64,
    /// Limit for the remaining norm of a column in the lower part of a front.
    pub(super) rest: f64,
}

/// C = Q·R, where R has r rows. One of the factors is empty.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SparseQr {
    pub(super) q: Reflectors,
    pub(super) r: Trapezoid,
    pub(super) rank: usize,
    /// Whether each row of QᵀC is a row of R; the other rows are zero.
    pub(super) is_live: Vec<bool>,
    /// ‖E‖, the Frobenius norm of the entries set to zero.
    pub(super) dropped: f64,
    /// The norm of the part of E in columns that were not dead when it was set to zero.
    pub(super) dropped_from_rest: f64,
}

impl SparseQr {
    /// Returns the memory of the factors (bytes).
    pub(super) fn bytes(&self) -> usize {
        self.q.bytes() + self.r.bytes()
    }
}

impl Symbolic {
    /// Factors a matrix whose entries all lie in the pattern.
    pub(super) fn factor(
        &self,
        c: &SparseMatrix,
        tolerances: Tolerances,
        wanted: KeptFactor,
    ) -> Result<SparseQr, OutsidePattern> {
        for &row in &self.empty_rows {
            if let Some(&column) = c.row(row).0.first() {
                return Err(OutsidePattern { row, column });
            }
        }
        let mut work = Householder {
            front: Assembly::new(self),
            tolerances,
            wanted,
            v: Vec::new(),
            product: Vec::new(),
            found: SparseQr {
                q: Reflectors::default(),
                r: Trapezoid::default(),
                rank: 0,
                is_live: vec![false; self.nrows],
                dropped: 0.0,
                dropped_from_rest: 0.0,
            },
        };
        for front in &self.fronts {
            work.front.assemble(front, c)?;
            work.eliminate(front);
        }
        let mut found = work.found;
        let dead = found.dropped.sqrt();
        found.dropped_from_rest = found.dropped_from_rest.sqrt();
        found.dropped = dead.hypot(found.dropped_from_rest);
        Ok(found)
    }
}

struct Householder {
    front: Assembly,
    tolerances: Tolerances,
    wanted: KeptFactor,
    /// The vector v of the current reflection: (row of the front, value).
    v: Vec<(usize, f64)>,
    product: Vec<f64>,
    /// The finished part. During the factorisation it contains squares in place of norms. The field
    /// `dropped` does not include the lower parts of fronts.
    found: SparseQr,
}

impl Householder {
    /// Triangularises the front into rows of R for its pivots and a remainder without zero rows.
    fn eliminate(&mut self, front: &Front) {
        let (mut top, mut start) = (0, 0);
        for &end in &front.ends {
            for at in start..end {
                let (norm, total) = self.largest_first(top, at, end);
                if norm <= self.tolerances.dead {
                    self.found.dropped += total;
                    self.clear(top, at..end);
                    break;
                }
                self.reflect(top, at, norm);
                self.finish_row(top, at);
                top += 1;
            }
            start = end;
        }
        let (pivots, first) = (start, top);
        for at in pivots..self.front.width() {
            let (norm, total) = self.largest_first(top, at, at + 1);
            if norm <= self.tolerances.rest {
                self.found.dropped_from_rest += total;
                self.clear(top, at..at + 1);
            } else {
                self.reflect(top, at, norm);
                top += 1;
            }
        }
        self.front.leave(pivots, first..top);
    }

    /// Moves the column among `at..end` with the largest norm from row `top` onwards to `at`.
    /// Returns the norm of this column, and the square of the norm of all these columns.
    fn largest_first(&mut self, top: usize, at: usize, end: usize) -> (f64, f64) {
        let width = self.front.width();
        let (mut square, mut largest, mut total) = (0.0, at, 0.0);
        for j in at..end {
            let column = self.front.values[top * width..]
                .iter()
                .skip(j)
                .step_by(width);
            let of_j: f64 = column.map(|a| a * a).sum();
            total += of_j;
            if of_j > square {
                (square, largest) = (of_j, j);
            }
        }
        self.front.swap_columns(top, at, largest);
        (square.sqrt(), total)
    }

    /// Sets these columns to zero from row `top` onwards.
    fn clear(&mut self, top: usize, columns: Range<usize>) {
        let width = self.front.width();
        for row in self.front.values[top * width..].chunks_exact_mut(width) {
            row[columns.clone()].fill(0.0);
        }
    }

    /// Reflects column `at` into row `top`. `norm` is the norm of the column from row `top`
    /// onwards. Rows in which the column is zero do not change.
    fn reflect(&mut self, top: usize, at: usize, norm: f64) {
        let width = self.front.width();
        let entry = |i: usize| (i, self.front.values[i * width + at]);
        let rows = top..self.front.rows.len();
        self.v.clear();
        self.v
            .extend(rows.map(entry).filter(|(_, value)| *value != 0.0));
        let (first, head) = self.v[0];
        self.front.swap_rows(top, first);
        self.v[0].0 = top;
        if self.v.len() == 1 {
            return;
        }
        // v = (a − r·e₁)·√β with r = −sign(a₁)·‖a‖ and β = 1/(‖a‖·(‖a‖ + |a₁|)), so that ‖v‖² = 2.
        let diagonal = -norm.copysign(head);
        let scale = (norm * (norm + head.abs())).sqrt().recip();
        self.v[0].1 = head - diagonal;
        self.v.iter_mut().for_each(|(_, value)| *value *= scale);
        if self.wanted == KeptFactor::Q {
            let rows = &self.front.rows;
            let entries = self.v.iter().map(|&(i, v_i)| (rows[i], v_i));
            self.found.q.push(entries);
        }
        self.product.clear();
        self.product.resize(width - at - 1, 0.0);
        for &(i, v_i) in &self.v {
            let row = &self.front.values[i * width..][at + 1..width];
            kernels::axpy(v_i, row, &mut self.product);
        }
        for &(i, v_i) in &self.v {
            let row = &mut self.front.values[i * width..][at..width];
            row[0] = 0.0;
            kernels::axpy(-v_i, &self.product, &mut row[1..]);
        }
        self.front.values[top * width + at] = diagonal;
    }

    /// Stores row `top` as the row of R with its pivot in column `at`.
    fn finish_row(&mut self, top: usize, at: usize) {
        self.found.rank += 1;
        self.found.is_live[self.front.rows[top]] = true;
        if self.wanted == KeptFactor::R {
            let width = self.front.width();
            let values = &self.front.values[top * width..][at..width];
            let columns = &self.front.columns[at..];
            let entries = columns.iter().copied().zip(values.iter().copied());
            self.found
                .r
                .push(entries.filter(|(_, value)| *value != 0.0));
        }
    }
}
