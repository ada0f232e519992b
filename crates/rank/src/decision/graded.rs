//! Chooses rows level by level, from large singular values to small ones, with double-double
//! residuals.
//!
//! On each level, the usual decision expresses the rows whose singular values are within 1e-6 of
//! the largest singular value. The matrix of the next level is the component of the other rows
//! outside the span of these rows, `S_D = C_D − T·C_K` in double-double. In this way, singular
//! values from 1 down to 1e-28 are each computed from a well-conditioned problem in `f64`. The
//! levels end when S is below a floor that the caller chooses.

use super::bound;
use super::spectrum::Spectrum;
use crate::limits::{CORRECTIONS_MAX, LEVEL_SPREAD};
use crate::strong_basis;
use linalg::{Dd, DdMatrix, Matrix, PivotedQr, RowBasis, kernels, powers, singular_values};

/// The rows of one level.
struct Level {
    /// Independent rows, as indices into the whole matrix.
    kept: Vec<usize>,
    /// S of these rows times 2^exponent (norm about one), and the factors of this matrix.
    rows: Matrix,
    factored: PivotedQr,
    exponent: i32,
    /// The matrix `(A⁺)ᵀ`. A contains the rows of all levels up to this level, each of size one.
    inverse: Matrix,
    /// Coefficients in S of all rows that remained when the level began, and the indices of these
    /// rows. Row `left[j]` of C is `coefficients_j·C_before` + `S_j`.
    coefficients: DdMatrix,
    before: Vec<usize>,
    /// Singular values of the equilibrated C that belong to the level.
    sigma: Vec<f64>,
    /// Bound on `‖C_K → S_K‖` for all kept rows up to this level.
    growth: f64,
    /// Bound on the rounding error of S (Frobenius norm).
    error: f64,
}

/// Rows by levels, and the remainder below the floor.
pub(super) struct RowLevels {
    levels: Vec<Level>,
    /// Rows that belong to no level, ascending.
    pub(super) left: Vec<usize>,
    /// Kept rows in the order of the levels.
    pub(super) kept: Vec<usize>,
    /// T (double-double) of the remaining rows in terms of the kept rows.
    coefficients: DdMatrix,
    /// Component of the remaining rows outside the span of the kept rows: `C_left − T·C_K`.
    outside: DdMatrix,
    /// Singular values that belong to the remaining rows.
    left_sigma: Vec<f64>,
}

impl RowLevels {
    /// Removes levels from the equilibrated matrix `c` while a singular value is above `floor`.
    pub(super) fn new(c: &DdMatrix, floor: f64) -> Self {
        Self::up_to(c, floor, c.ncols(), None)
    }

    /// Removes levels until `rank` rows are kept, even if these rows are very small. Fewer rows are
    /// kept if no non-zero row remains. `read` is the matrix in `f64` from which the rank was
    /// decided, or a nearby matrix.
    pub(super) fn of_rank(c: &DdMatrix, rank: usize, read: &Spectrum) -> Self {
        let first = read.of_neighbour(&c.hi());
        Self::up_to(c, 0.0, rank.min(c.ncols()), first)
    }

    /// Computes the levels. The singular values of `c` are computed unless they are known.
    fn up_to(c: &DdMatrix, floor: f64, most: usize, mut known: Option<&[f64]>) -> Self {
        let m = c.nrows();
        let mut g = Self {
            levels: Vec::new(),
            left: (0..m).collect(),
            kept: Vec::new(),
            coefficients: DdMatrix::zeros(m, 0),
            outside: c.clone(),
            left_sigma: Vec::new(),
        };
        let (mut growth, mut error) = (1.0, 0.0);
        loop {
            let exponent = powers::unit_exponent(g.outside.hi().as_slice());
            let normal = g.outside.times_power(exponent);
            let sigma = match known.take() {
                Some(known) => known.to_vec(),
                None => g.readings(exponent),
            };
            let significant = sigma
                .iter()
                .filter(|&&s| s > floor && s >= LEVEL_SPREAD * sigma[0])
                .count()
                .min(most - g.kept.len());
            if significant == 0 {
                g.left_sigma = sigma;
                return g;
            }
            let step = LevelReduction::new(&normal, significant);
            let rows_of = |local: &[usize]| local.iter().map(|&i| g.left[i]).collect::<Vec<_>>();
            let (kept, left) = (rows_of(&step.kept), rows_of(&step.dropped));
            let rows = normal.select_rows(&step.kept).hi();
            g.levels.push(Level {
                inverse: g.inverse_with(&rows, &step),
                factored: step.factored.clone(),
                rows,
                exponent,
                coefficients: g.coefficients.select_rows(&step.kept),
                before: g.kept.clone(),
                sigma: sigma[..significant].to_vec(),
                growth,
                error,
                kept: kept.clone(),
            });
            growth *= 1.0 + step.t.hi().frobenius_norm();
            error = error * (1.0 + step.t.hi().frobenius_norm())
                + step.error * powers::scale(1.0, -exponent);
            g.coefficients = step.coefficients(&g.coefficients);
            g.outside = step.outside.times_power(-exponent);
            g.left = left;
            g.kept.extend(kept);
        }
    }

    /// Returns the singular values of C that belong to the remainder. These values are the singular
    /// values of S in an orthonormal basis of the combinations `[−T, I]` that produced S.
    fn readings(&self, exponent: i32) -> Vec<f64> {
        let mut s = self.outside.times_power(exponent).hi();
        let count = s.nrows().min(s.ncols().saturating_sub(self.kept.len()));
        if !self.kept.is_empty() && !self.left.is_empty() {
            let w = Matrix::from_fn(
                self.left.len(),
                self.kept.len() + self.left.len(),
                |j, i| match i.checked_sub(self.kept.len()) {
                    None => -self.coefficients[(j, i)].to_f64(),
                    Some(l) => f64::from(u8::from(l == j)),
                },
            );
            // Wᵀ·P = Q·R, so R⁻ᵀ·Pᵀ·W is orthonormal.
            let qr = PivotedQr::of_rows(w);
            let mut columns = s.select_rows(qr.permutation()).transpose();
            for k in 0..columns.nrows() {
                qr.solve_r_transpose(columns.row_mut(k));
            }
            s = columns.transpose();
        }
        singular_values(&s)
            .into_iter()
            .take(count.max(1))
            .map(|sigma| powers::scale(sigma, -exponent))
            .collect()
    }

    /// Returns estimates of all `count` singular values, largest first.
    pub(super) fn singular_values(&self, count: usize) -> Vec<f64> {
        let levels = self.levels.iter().flat_map(|l| &l.sigma);
        let mut sigma: Vec<f64> = levels.chain(&self.left_sigma).copied().collect();
        sigma.resize(count, 0.0);
        sigma.sort_by(|a, b| b.total_cmp(a));
        sigma
    }

    /// Returns T of the remaining rows in terms of the kept rows, in the order of the levels.
    pub(super) fn dependence(&self) -> Matrix {
        self.coefficients.hi()
    }

    /// Returns the largest norm of a row of `C_left − T·C_K`.
    pub(super) fn residual(&self) -> f64 {
        let outside = self.outside.hi();
        (0..outside.nrows())
            .map(|i| kernels::norm(outside.row(i)))
            .fold(0.0, f64::max)
    }

    /// Returns the rows of all levels so far and of one further level, each of norm one.
    fn stacked(&self, levels: usize, last: &Matrix) -> Matrix {
        let before = self.levels[..levels].iter().map(|level| &level.rows);
        let all: Vec<&Matrix> = before.chain([last]).collect();
        let rows = all
            .iter()
            .flat_map(|rows| (0..rows.nrows()).map(|i| rows.row(i)));
        let rows: Vec<&[f64]> = rows.collect();
        Matrix::from_fn(rows.len(), last.ncols(), |i, j| rows[i][j])
    }

    /// Returns `(A⁺)ᵀ`. A contains the rows of all levels so far and of one further level.
    fn inverse_with(&self, rows: &Matrix, step: &LevelReduction) -> Matrix {
        match self.levels.len() {
            0 => step.inverse.clone(),
            n => PivotedQr::of_rows(self.stacked(n, rows)).transposed_pseudo_inverse(),
        }
    }

    /// Returns `(C_K⁺)ᵀ` of the rows `kept` of C (ascending), if they are the rows of a single
    /// level.
    pub(super) fn inverse_of(&self, kept: &[usize]) -> Option<Matrix> {
        let [level] = &self.levels[..] else {
            return None;
        };
        if level.kept != kept {
            return None;
        }
        let mut inverse = level.inverse.clone();
        for x in inverse.as_mut_slice() {
            *x = powers::scale(*x, level.exponent);
        }
        Some(inverse)
    }

    /// Returns two values for each level: the number r of rows kept up to this level, and a proved
    /// lower bound on σ_r of C.
    pub(super) fn bounds(&self) -> Vec<(usize, f64)> {
        let (mut count, mut perturbation, mut smallest) = (0, 0.0_f64, f64::INFINITY);
        let mut found = Vec::new();
        for (before, level) in self.levels.iter().enumerate() {
            let size = powers::scale(1.0, -level.exponent);
            count += level.kept.len();
            smallest = smallest.min(size);
            // Errors of rounding S to f64, and of S itself.
            perturbation += f64::EPSILON * level.rows.frobenius_norm() + level.error / size;
            let stacked = self.stacked(before, &level.rows);
            let sigma = bound::smallest_singular_value(&stacked, &level.inverse, perturbation);
            found.push((count, sigma * smallest / level.growth));
        }
        found
    }

    /// Returns unit weights of the rows of C (length m). The norm of the combination with these
    /// weights is about the smallest σ of the smallest level. The weights are a left singular
    /// vector except for a component in the left null space, which the caller removes.
    pub(super) fn smallest_direction(&self) -> Option<Vec<f64>> {
        let level = self.levels.last()?;
        // Two inverse iterations with S·Sᵀ = P·Rᵀ·R·Pᵀ; practically any initial vector has a
        // component along the smallest direction.
        let qr = &level.factored;
        let mut y: Vec<f64> = (0..level.kept.len())
            .map(|i| 1.0 + i as f64 / 7.0)
            .collect();
        for _ in 0..2 {
            qr.solve_r_transpose(&mut y);
            qr.solve_r(&mut y);
            let size = kernels::norm(&y);
            y.iter_mut().for_each(|y| *y /= size);
        }
        let mut direction = vec![0.0; self.kept.len() + self.left.len()];
        for (y, &k) in y.iter().zip(qr.permutation()) {
            direction[level.kept[k]] += y;
            for (t, &i) in level.coefficients.row(k).iter().zip(&level.before) {
                direction[i] -= y * t.to_f64();
            }
        }
        Some(direction)
    }

    /// Returns weights of the rows of C. The combination with these weights is the component of row
    /// `left[j]` outside the span of the kept rows.
    pub(super) fn left_direction(&self, j: usize) -> Vec<f64> {
        let mut direction = vec![0.0; self.kept.len() + self.left.len()];
        direction[self.left[j]] = 1.0;
        for (t, &i) in self.coefficients.row(j).iter().zip(&self.kept) {
            direction[i] = -t.to_f64();
        }
        direction
    }
}

/// One level: the dependent rows of a matrix scaled to unit size, expressed by its independent
/// rows.
struct LevelReduction {
    kept: Vec<usize>,
    dropped: Vec<usize>,
    /// Factors of `S_K`, and `(S_K⁺)ᵀ`.
    factored: PivotedQr,
    inverse: Matrix,
    t: DdMatrix,
    /// `S_D − T·S_K`.
    outside: DdMatrix,
    /// Bound on the rounding error of `outside` (Frobenius norm), for this T.
    error: f64,
}

impl LevelReduction {
    fn new(s: &DdMatrix, rank: usize) -> Self {
        let leading = s.hi();
        let rows = RowBasis::most_independent(leading.clone(), rank);
        let (basis, rows) = strong_basis::bounded(&leading, rows);
        let mut t = DdMatrix::from(&basis.t);
        let (s_kept, s_dropped) = (s.select_rows(&basis.kept), s.select_rows(&basis.dropped));
        let mut outside = residual(&s_dropped, &t, &s_kept);
        let factored = rows.into_factored();
        let inverse = factored.transposed_pseudo_inverse();
        let columns = inverse.transpose();
        for _ in 0..CORRECTIONS_MAX {
            let correction = outside.hi().product(&columns);
            for j in 0..basis.dropped.len() {
                for (t, &x) in t.row_mut(j).iter_mut().zip(correction.row(j)) {
                    *t += Dd::from(x);
                }
            }
            outside = residual(&s_dropped, &t, &s_kept);
            if correction.max_abs() <= Dd::EPSILON {
                break;
            }
        }
        let terms = (rank + 2) as f64 * Dd::EPSILON;
        let (t_norm, k_norm) = (t.hi().frobenius_norm(), s_kept.hi().frobenius_norm());
        Self {
            error: 2.0 * terms * (s_dropped.hi().frobenius_norm() + t_norm * k_norm)
                + f64::MIN_POSITIVE,
            kept: basis.kept,
            dropped: basis.dropped,
            factored,
            inverse,
            t,
            outside,
        }
    }

    /// Returns T of the dropped rows in terms of the kept rows of earlier levels and of this level.
    fn coefficients(&self, before: &DdMatrix) -> DdMatrix {
        let r = before.ncols();
        let (kept, dropped) = (
            before.select_rows(&self.kept),
            before.select_rows(&self.dropped),
        );
        let reduced = residual(&dropped, &self.t, &kept);
        DdMatrix::from_fn(self.dropped.len(), r + self.kept.len(), |j, i| {
            match i.checked_sub(r) {
                None => reduced[(j, i)],
                Some(k) => self.t[(j, k)],
            }
        })
    }
}

/// Returns A − T·B. Rows of B have few entries.
fn residual(a: &DdMatrix, t: &DdMatrix, b: &DdMatrix) -> DdMatrix {
    let entries = (0..b.nrows()).map(|k| {
        let row = b.row(k).iter().copied().enumerate();
        row.filter(|(_, b)| *b != Dd::ZERO).collect()
    });
    let entries: Vec<Vec<(usize, Dd)>> = entries.collect();
    let mut out = a.clone();
    for j in 0..a.nrows() {
        let out = out.row_mut(j);
        for (&t_jk, b) in t.row(j).iter().zip(&entries) {
            if t_jk == Dd::ZERO {
                continue;
            }
            for &(i, b) in b {
                out[i] -= t_jk * b;
            }
        }
    }
    out
}
