//! One front at a time: put together, triangularised, and its rest left for the front above.

use super::SparseMatrix;
use super::factor::{OutsidePattern, SparseQr, Wanted};
use super::reflectors::Reflectors;
use super::symbolic::{Front, Symbolic};
use super::trapezoid::Trapezoid;

/// Not a column of the front.
const OUTSIDE: usize = usize::MAX;

/// The front in work, the rests that wait, and what is finished.
pub(super) struct Workspace {
    tolerance: f64,
    wanted: Wanted,
    /// Columns of C of the front, in the order of its columns.
    columns: Vec<usize>,
    /// Rows of QᵀC of the front.
    rows: Vec<usize>,
    /// Values, row by row.
    values: Vec<f64>,
    /// Where a column of C stands in the front.
    position: Vec<usize>,
    /// Rests of fronts that are not taken over yet, the latest last.
    waiting: Vec<Rest>,
    waiting_rows: Vec<usize>,
    waiting_columns: Vec<usize>,
    waiting_values: Vec<f64>,
    /// The vector v of the reflection in work: (row of the front, value).
    v: Vec<(usize, f64)>,
    product: Vec<f64>,
    q: Reflectors,
    r: Trapezoid,
    is_live: Vec<bool>,
    /// ‖E‖².
    dropped: f64,
}

/// What is left of a front: so many rows and columns of those that wait.
struct Rest {
    rows: usize,
    columns: usize,
}

impl Workspace {
    pub(super) fn new(symbolic: &Symbolic, tolerance: f64, wanted: Wanted) -> Self {
        Self {
            tolerance,
            wanted,
            columns: Vec::new(),
            rows: Vec::new(),
            values: Vec::new(),
            position: vec![OUTSIDE; symbolic.ncols],
            waiting: Vec::new(),
            waiting_rows: Vec::new(),
            waiting_columns: Vec::new(),
            waiting_values: Vec::new(),
            v: Vec::new(),
            product: Vec::new(),
            q: Reflectors::default(),
            r: Trapezoid::default(),
            is_live: vec![false; symbolic.nrows],
            dropped: 0.0,
        }
    }

    pub(super) fn finish(self) -> SparseQr {
        SparseQr {
            q: self.q,
            r: self.r,
            rank: self.is_live.iter().filter(|live| **live).count(),
            is_live: self.is_live,
            dropped: self.dropped.sqrt(),
        }
    }

    /// Rows of C that are met here first, and the rests of the children.
    pub(super) fn assemble(
        &mut self,
        front: &Front,
        c: &SparseMatrix,
    ) -> Result<(), OutsidePattern> {
        self.columns.clone_from(&front.columns);
        for (at, &column) in self.columns.iter().enumerate() {
            self.position[column] = at;
        }
        let width = self.columns.len();
        self.rows.clear();
        self.values.clear();
        for &row in &front.rows {
            let base = self.values.len();
            self.values.resize(base + width, 0.0);
            self.rows.push(row);
            for (column, value) in c.entries(row) {
                match self.position[column] {
                    OUTSIDE => return Err(OutsidePattern { row, column }),
                    at => self.values[base + at] = value,
                }
            }
        }
        for _ in 0..front.children {
            let Some(rest) = self.waiting.pop() else {
                break;
            };
            let columns = self.waiting_columns.len() - rest.columns;
            let rows = self.waiting_rows.len() - rest.rows;
            let values = self.waiting_values.len() - rest.rows * rest.columns;
            let places = &mut self.waiting_columns[columns..];
            places.iter_mut().for_each(|j| *j = self.position[*j]);
            for k in 0..rest.rows {
                let base = self.values.len();
                self.values.resize(base + width, 0.0);
                let from = &self.waiting_values[values + k * rest.columns..][..rest.columns];
                for (&at, &value) in places.iter().zip(from) {
                    self.values[base + at] = value;
                }
            }
            self.rows.extend_from_slice(&self.waiting_rows[rows..]);
            self.waiting_columns.truncate(columns);
            self.waiting_rows.truncate(rows);
            self.waiting_values.truncate(values);
        }
        for column in &self.columns {
            self.position[*column] = OUTSIDE;
        }
        Ok(())
    }

    /// Triangularises the front: rows of R for its pivots, and a rest without rows of zeros.
    pub(super) fn eliminate(&mut self, front: &Front) {
        let width = self.columns.len();
        let mut top = 0;
        let mut start = 0;
        for &end in &front.ends {
            for at in start..end {
                let Some(norm) = self.largest_first(top, at, end) else {
                    break;
                };
                self.reflect(top, at, norm);
                self.is_live[self.rows[top]] = true;
                if self.wanted == Wanted::R {
                    let row = &self.values[top * width..][at..width];
                    let entries = self.columns[at..].iter().copied().zip(row.iter().copied());
                    self.r.push(entries.filter(|(_, value)| *value != 0.0));
                }
                top += 1;
            }
            start = end;
        }
        let pivots = start;
        let first = top;
        for at in pivots..width {
            if let Some(norm) = self.largest_first(top, at, at + 1) {
                self.reflect(top, at, norm);
                top += 1;
            }
        }
        if top > first {
            for i in first..top {
                let row = &self.values[i * width..][pivots..width];
                self.waiting_values.extend_from_slice(row);
            }
            self.waiting_rows.extend_from_slice(&self.rows[first..top]);
            self.waiting_columns
                .extend_from_slice(&self.columns[pivots..]);
        }
        if pivots < width {
            self.waiting.push(Rest {
                rows: top - first,
                columns: if top > first { width - pivots } else { 0 },
            });
        }
    }

    /// Brings that of the columns `at..end` to `at` of which most is left from row `top` on, and gives its norm. If none has more than the
    /// tolerance, what is left of them becomes zero.
    fn largest_first(&mut self, top: usize, at: usize, end: usize) -> Option<f64> {
        let width = self.columns.len();
        let mut largest = (0.0, at);
        let mut total = 0.0;
        for j in at..end {
            let column = self.values[top * width..].iter().skip(j).step_by(width);
            let square: f64 = column.map(|a| a * a).sum();
            total += square;
            if square > largest.0 {
                largest = (square, j);
            }
        }
        let (square, j) = largest;
        if square.sqrt() > self.tolerance {
            if j != at {
                self.columns.swap(at, j);
                for row in self.values[top * width..].chunks_exact_mut(width) {
                    row.swap(at, j);
                }
            }
            return Some(square.sqrt());
        }
        self.dropped += total;
        if total > 0.0 {
            for row in self.values[top * width..].chunks_exact_mut(width) {
                row[at..end].fill(0.0);
            }
        }
        None
    }

    /// Turns column `at`, of which `norm` is left from row `top` on, into that row; the rows in which it is zero stay as they are.
    fn reflect(&mut self, top: usize, at: usize, norm: f64) {
        let width = self.columns.len();
        let entry = |i: usize| (i, self.values[i * width + at]);
        self.v.clear();
        let rows = top..self.rows.len();
        self.v
            .extend(rows.map(entry).filter(|(_, value)| *value != 0.0));
        let (first, head) = self.v[0];
        if first != top {
            let (upper, lower) = self.values.split_at_mut(first * width);
            upper[top * width..][..width].swap_with_slice(&mut lower[..width]);
            self.rows.swap(top, first);
            self.v[0].0 = top;
        }
        if self.v.len() == 1 {
            return;
        }
        // v = (a − r·e₁)·√β with r = −sign(a₁)·‖a‖ and β = 1/(‖a‖·(‖a‖ + |a₁|)), so that ‖v‖² = 2.
        let diagonal = -norm.copysign(head);
        let scale = (norm * (norm + head.abs())).sqrt().recip();
        self.v[0].1 = head - diagonal;
        self.v.iter_mut().for_each(|(_, value)| *value *= scale);
        if self.wanted == Wanted::Q {
            let rows = &self.rows;
            self.q.push(self.v.iter().map(|&(i, v_i)| (rows[i], v_i)));
        }

        let rest = at + 1..width;
        self.product.clear();
        self.product.resize(rest.len(), 0.0);
        for &(i, v_i) in &self.v {
            let row = &self.values[i * width..][rest.clone()];
            crate::kernels::axpy(v_i, row, &mut self.product);
        }
        for &(i, v_i) in &self.v {
            let row = &mut self.values[i * width..][at..width];
            row[0] = 0.0;
            crate::kernels::axpy(-v_i, &self.product, &mut row[1..]);
        }
        self.values[top * width + at] = diagonal;
    }
}
