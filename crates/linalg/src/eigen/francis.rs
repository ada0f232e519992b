//! Computes the real Schur form `A = Z·T·Zᵀ`, in which T is upper triangular except for 2 × 2
//! blocks of complex pairs. Reflections transform the matrix to Hessenberg form, followed by steps
//! of the QR algorithm with double shifts (J. G. F. Francis, The QR transformation, Computer
//! Journal 4 (1961/62) 265–271 and 332–345; G. H. Golub, C. F. Van Loan, Matrix Computations, 4th
//! ed. 2013, sections 7.4 and 7.5).

use crate::Matrix;
use crate::limits::{EXCEPTIONAL_EVERY, FRANCIS_STEPS};

/// The factors of a real Schur form.
pub(super) struct RealSchur {
    /// The matrix T; entries below its blocks are exactly zero.
    pub(super) t: Matrix,
    /// The orthogonal matrix Z.
    pub(super) z: Matrix,
}

impl RealSchur {
    /// Computes the form of a square matrix with entries of about one. Returns `None` if the steps
    /// do not converge.
    pub(super) fn of(a: Matrix) -> Option<Self> {
        let n = a.nrows();
        let mut form = Self {
            t: a,
            z: Matrix::identity(n),
        };
        form.reduce_to_hessenberg();
        let mut end = n;
        let mut steps = 0;
        while end > 0 {
            let begin = form.active(end);
            match end - begin {
                1 => (end, steps) = (end - 1, 0),
                2 => {
                    form.split(begin);
                    (end, steps) = (end - 2, 0);
                }
                _ if steps == FRANCIS_STEPS => return None,
                _ => {
                    steps += 1;
                    let shifts = form.shifts(begin, end, steps);
                    form.step(begin, end, shifts);
                }
            }
        }
        Some(form)
    }

    /// Makes all entries below the first subdiagonal zero.
    fn reduce_to_hessenberg(&mut self) {
        let n = self.t.nrows();
        for k in 1..n.saturating_sub(1) {
            let below: Vec<f64> = (k..n).map(|i| self.t[(i, k - 1)]).collect();
            if let Some((reflection, first)) = Reflection::of(&below) {
                self.reflect(&reflection, k, k - 1, n);
                self.t[(k, k - 1)] = first;
                (k + 1..n).for_each(|i| self.t[(i, k - 1)] = 0.0);
            }
        }
    }

    /// Returns the first row of the block before `end` whose subdiagonal entries are not zero. The
    /// subdiagonal entry of this row is set to zero if it is not larger than rounding errors.
    fn active(&mut self, end: usize) -> usize {
        let t = &mut self.t;
        for k in (1..end).rev() {
            let beside = t[(k, k)].abs() + t[(k - 1, k - 1)].abs();
            let size = if beside > 0.0 { beside } else { t.max_abs() };
            if t[(k, k - 1)].abs() <= f64::EPSILON * size {
                t[(k, k - 1)] = 0.0;
                return k;
            }
        }
        0
    }

    /// Returns the sum and the product of the two shifts, which are the eigenvalues of the last 2 ×
    /// 2 block. If all eigenvalues have equal absolute values, as for a permutation, a step may
    /// leave the matrix unchanged. Therefore other shifts are used every few steps.
    fn shifts(&self, begin: usize, end: usize, steps: usize) -> [f64; 2] {
        let t = &self.t;
        if !steps.is_multiple_of(EXCEPTIONAL_EVERY) {
            let (a, d) = (t[(end - 2, end - 2)], t[(end - 1, end - 1)]);
            let (b, c) = (t[(end - 2, end - 1)], t[(end - 1, end - 2)]);
            return [a + d, a * d - b * c];
        }
        // The shifts use the first and the last entry alternately, like `dlahqr` of LAPACK.
        let (size, centre) = if (steps / EXCEPTIONAL_EVERY).is_multiple_of(2) {
            let size = t[(end - 1, end - 2)].abs() + t[(end - 2, end - 3)].abs();
            (size, t[(end - 1, end - 1)])
        } else {
            let size = t[(begin + 1, begin)].abs() + t[(begin + 2, begin + 1)].abs();
            (size, t[(begin, begin)])
        };
        let half = 0.75 * size + centre;
        [2.0 * half, half * half + 0.4375 * size * size]
    }

    /// Performs one step with two shifts on the rows `begin..end`. The first reflection introduces
    /// the shifts, and the other reflections restore the Hessenberg form.
    fn step(&mut self, begin: usize, end: usize, [sum, product]: [f64; 2]) {
        let n = self.t.nrows();
        let t = &self.t;
        let [h, next] = [t[(begin, begin)], t[(begin + 1, begin)]];
        let mut column = vec![
            h * h + t[(begin, begin + 1)] * next - sum * h + product,
            next * (h + t[(begin + 1, begin + 1)] - sum),
            next * t[(begin + 2, begin + 1)],
        ];
        for k in begin..end - 1 {
            if let Some((reflection, first)) = Reflection::of(&column) {
                let rows = (k + 4).min(end);
                if k > begin {
                    self.t[(k, k - 1)] = first;
                    (k + 1..k + column.len()).for_each(|i| self.t[(i, k - 1)] = 0.0);
                }
                self.reflect_within(&reflection, k, k..n, rows);
            }
            let below = k + 1..(k + 4).min(end);
            column = below.map(|i| self.t[(i, k)]).collect();
        }
    }

    /// Makes a 2 × 2 block at row k triangular if its eigenvalues are real.
    fn split(&mut self, k: usize) {
        let n = self.t.nrows();
        let (a, d) = (self.t[(k, k)], self.t[(k + 1, k + 1)]);
        let (b, c) = (self.t[(k, k + 1)], self.t[(k + 1, k)]);
        let half = 0.5 * (a - d);
        let square = half * half + b * c;
        if c == 0.0 || square < 0.0 {
            return;
        }
        // For the eigenvalue λ that is farther from d, x = λ − d, and (x, c) is an eigenvector.
        let x = half + square.sqrt().copysign(half);
        let length = x.hypot(c);
        let (cos, sin) = (x / length, c / length);
        for j in k..n {
            let (p, q) = (self.t[(k, j)], self.t[(k + 1, j)]);
            self.t[(k, j)] = cos * p + sin * q;
            self.t[(k + 1, j)] = cos * q - sin * p;
        }
        for (matrix, rows) in [(&mut self.t, k + 2), (&mut self.z, n)] {
            for i in 0..rows {
                let (p, q) = (matrix[(i, k)], matrix[(i, k + 1)]);
                matrix[(i, k)] = cos * p + sin * q;
                matrix[(i, k + 1)] = cos * q - sin * p;
            }
        }
        self.t[(k + 1, k)] = 0.0;
    }

    /// Replaces T by `H·T·H` and Z by `Z·H` for a reflection of the rows from `first` onwards.
    fn reflect(&mut self, reflection: &Reflection, first: usize, columns_from: usize, rows: usize) {
        let n = self.t.nrows();
        self.reflect_within(reflection, first, columns_from..n, rows);
    }

    /// Works like [`Self::reflect`] for a T that is zero left of `columns` and below the first
    /// `rows` rows.
    fn reflect_within(
        &mut self,
        reflection: &Reflection,
        first: usize,
        columns: std::ops::Range<usize>,
        rows: usize,
    ) {
        let Reflection { v, factor } = reflection;
        for j in columns {
            let along: f64 = v
                .iter()
                .enumerate()
                .map(|(i, v)| v * self.t[(first + i, j)])
                .sum();
            for (i, v) in v.iter().enumerate() {
                self.t[(first + i, j)] -= factor * along * v;
            }
        }
        let all = self.z.nrows();
        for (matrix, rows) in [(&mut self.t, rows), (&mut self.z, all)] {
            for i in 0..rows {
                let row = &mut matrix.row_mut(i)[first..first + v.len()];
                let along: f64 = row.iter().zip(v).map(|(x, v)| x * v).sum();
                row.iter_mut()
                    .zip(v)
                    .for_each(|(x, v)| *x -= factor * along * v);
            }
        }
    }
}

/// A reflection `H = I − factor·v·vᵀ`.
struct Reflection {
    v: Vec<f64>,
    factor: f64,
}

impl Reflection {
    /// Returns the reflection of x onto the first axis, and the first entry of `H·x`. Returns
    /// `None` if x already has this direction.
    fn of(x: &[f64]) -> Option<(Self, f64)> {
        let largest = x.iter().skip(1).fold(0.0_f64, |a, x| a.max(x.abs()));
        if largest == 0.0 {
            return None;
        }
        let size = largest.max(x[0].abs());
        let mut v: Vec<f64> = x.iter().map(|x| x / size).collect();
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let first = -length.copysign(v[0]);
        v[0] -= first;
        // The product is vᵀ·v = 2·length·(length + |x₀|).
        let factor = (length * v[0].abs()).recip();
        Some((Self { v, factor }, first * size))
    }
}
