//! Questions about rows of which a left null space is known: all rows of a matrix, or those of one joint in a large one.
//!
//! Not here: where the null space comes from.

use std::ops::Range;

use linalg::{CoefficientReading, ExactNullSpace, Matrix, PivotedQr, RankStatus, Readings};

use super::QueryError;
use crate::verdict::Judgement;

/// Entries of the map from multipliers to a reaction are products of a few numbers near one; below this share of the
/// largest row a row is their rounding.
const ROUNDING_OF_MAP: f64 = 1e-14;

/// The same in multiples of what the entries of C are known to.
const MAP_FACTOR: f64 = 10.0;

/// Rows, what spans their part of the left null space, and how well both are known.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    /// The equilibrated rows, m × n. Columns in which no row has an entry may be left out.
    pub(crate) c: Matrix,
    /// Their rows of an orthonormal basis of the left null space, or of random combinations of one, m × p.
    pub(crate) z: Matrix,
    /// How well.
    pub(crate) known: Known,
    /// The left null space modulo primes, if the entries are meant exactly.
    pub(crate) exact: Option<ExactNullSpace>,
}

/// What the evidence of a rank says of rows of C and Z.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    /// Whether the rank is decided.
    pub(crate) status: RankStatus,
    /// D_r
    pub(crate) row_factor: Vec<f64>,
    /// How far each row of Z may be off (norm).
    pub(crate) row_noise: Vec<f64>,
    /// How far any coefficient may be off.
    pub(crate) tolerance: f64,
    /// What the rows of C are known to (Frobenius norm).
    pub(crate) spread: f64,
    /// What an entry of C is known to.
    pub(crate) uncertainty: f64,
    /// How margins are read.
    pub(crate) readings: Readings,
}

impl Basis {
    /// The multiplier of one row: unique iff `Z_i = 0`.
    ///
    /// # Errors
    /// If there is no such row.
    pub(crate) fn row(&self, i: usize) -> Result<Judgement, QueryError> {
        self.multipliers([i])
    }

    /// All multipliers of a group of rows: unique iff `Z_X = 0`. Stronger than [`Basis::group`] where the rows
    /// depend on each other.
    ///
    /// # Errors
    /// If a row does not exist.
    pub(crate) fn multipliers(
        &self,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Judgement, QueryError> {
        let rows = self.set(rows)?;
        let margin = rows
            .iter()
            .map(|&i| norm(self.z.row(i)))
            .fold(0.0, f64::hypot);
        let noise = self.noise(rows.iter().map(|&i| (i, 1.0)));
        Ok(self.judge(margin, noise, |z| {
            rows.iter().all(|&i| z.annihilates([(i, 1.0)]))
        }))
    }

    /// `B_X = C_Xᵀ·Z_X` (n × p) of a group of rows, equilibrated.
    ///
    /// # Errors
    /// If a row does not exist.
    pub(crate) fn b_x(&self, rows: impl IntoIterator<Item = usize>) -> Result<Matrix, QueryError> {
        Ok(self.product(&self.set(rows)?))
    }

    /// The reaction of a group of rows: unique iff `B_X = 0`; the margin is ‖B_X‖ (Frobenius).
    ///
    /// # Errors
    /// If a row does not exist.
    pub(crate) fn group(
        &self,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Judgement, QueryError> {
        let rows = self.set(rows)?;
        // Rows that cancel in C do so to what its entries are known to.
        let cancelled = rows.iter().map(|&i| norm(self.z.row(i)));
        let noise = self
            .noise(rows.iter().map(|&i| (i, norm(self.c.row(i)))))
            .hypot(self.known.spread * cancelled.fold(0.0, f64::hypot));
        let margin = self.product(&rows).frobenius_norm();
        Ok(self.judge(margin, noise, |z| z.wrench_vanishes(&rows)))
    }

    /// A linear combination `ℓᵀ·λ` of all multipliers: unique iff `ℓᵀ·Z = 0`; the margin is relative to ‖ℓ‖, both
    /// for equilibrated rows.
    ///
    /// # Errors
    /// If there are not m coefficients, or one is not finite.
    pub(crate) fn combination(&self, l: &[f64]) -> Result<Judgement, QueryError> {
        let rows: Vec<usize> = (0..self.c.nrows()).collect();
        check_coefficients(l, rows.len())?;
        let (image, size) = self.scaled_row(l, &rows);
        let noise = self.noise_of_row(l, &rows, size);
        Ok(self.judge(norm(&image), noise, |z| {
            z.annihilates(combination(l, &rows))
        }))
    }

    /// Component `k` of a reaction `W·λ_X`: unique iff row k of `W·Z_X` is zero; the margin is relative to the largest row of W.
    /// A row that is rounding beside the others is zero, unless the entries are meant exactly. Column l of W belongs to row l of the list.
    ///
    /// # Errors
    /// If a row or the component does not exist, or W does not have a column for each row, or is not finite.
    pub(crate) fn component(
        &self,
        map: &Matrix,
        k: usize,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Judgement, QueryError> {
        let rows = self.list(rows)?;
        check_map(map, &rows)?;
        if k >= map.nrows() {
            return Err(QueryError::ComponentOutOfRange {
                component: k,
                components: map.nrows(),
            });
        }
        let (images, sizes) = self.images(map, &rows);
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        // Zero over zero: a map of zeros has no reaction.
        let share = if largest == 0.0 {
            0.0
        } else {
            sizes[k] / largest
        };
        let margin = norm(images.row(k)) * share;
        let noise = self.noise_of_row(map.row(k), &rows, largest);
        Ok(self.judge(margin, noise, |z| {
            z.annihilates(combination(map.row(k), &rows))
        }))
    }

    /// Whether component `k` of a reaction `W·λ_X` is zero for all multipliers: row k of W is so small beside the largest one that the component
    /// is unique for this reason alone.
    ///
    /// # Errors
    /// As [`Basis::component`].
    pub(crate) fn is_zero(
        &self,
        map: &Matrix,
        k: usize,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<bool, QueryError> {
        let rows = self.list(rows)?;
        let (images, sizes) = self.images(map, &rows);
        if sizes[k] == 0.0 {
            return Ok(true);
        }
        let whole = norm(images.row(k));
        let noise = self.noise_of_row(map.row(k), &rows, sizes[k]);
        let judged = self.component(map, k, rows)?;
        let own = self.known.readings.read(whole, noise);
        Ok(
            self.exact.is_none()
                && judged.verdict.is_unique()
                && own == CoefficientReading::NonZero,
        )
    }

    /// Directions in which a reaction is unique: a basis of the left null space of `W·Z_X` for the map W
    /// (k × |X|) from multipliers to components. Unit vectors with k entries; the largest entry is positive.
    ///
    /// # Errors
    /// As [`Basis::component`], and where the numbers do not decide how many there are.
    pub(crate) fn unique_directions(
        &self,
        map: &Matrix,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Vec<f64>>, QueryError> {
        let rows = self.list(rows)?;
        check_map(map, &rows)?;
        if let RankStatus::Undecided(doubt) = self.known.status {
            return Err(QueryError::Rank(doubt));
        }
        let k = map.nrows();
        let (images, sizes) = self.images(map, &rows);
        let qr = PivotedQr::of_columns(&images);
        let rank = match &self.exact {
            Some(z) => z.rank_of(
                &(0..k)
                    .map(|i| combination(map.row(i), &rows))
                    .collect::<Vec<_>>(),
            ),
            None => {
                let noise = (0..k)
                    .map(|i| self.noise_of_row(map.row(i), &rows, sizes[i]))
                    .fold(0.0, f64::max);
                self.clear_rank(&qr, noise)?
            }
        };
        if rank == 0 {
            return Ok((0..k).map(|i| unit(k, i)).collect());
        }
        let basis = qr.q_columns(rank..k);
        Ok((0..k - rank)
            .map(|j| {
                // Back from components of equal size to the units of the map.
                let scaled = |i: usize| if sizes[i] == 0.0 { 1.0 } else { sizes[i] };
                let direction = (0..k).map(|i| basis[(i, j)] / scaled(i)).collect();
                normalised(direction, self.known.tolerance)
            })
            .collect())
    }

    /// The rank of some of the rows, from the dependencies of all: those that need no other row, `z = 0` there, are as many as `p − rank Z_other`.
    /// Nothing where the rank of all is undecided, or that of Z_other unclear.
    pub(crate) fn rank_of(&self, rows: Range<usize>) -> Option<usize> {
        if self.known.status != RankStatus::Decided {
            return None;
        }
        let other: Vec<usize> = (0..self.z.nrows()).filter(|i| !rows.contains(i)).collect();
        let tied = match &self.exact {
            Some(z) => {
                let rows: Vec<_> = other.iter().map(|&i| vec![(i, 1.0)]).collect();
                z.rank_of(&rows)
            }
            None => {
                let noise = self.noise(other.iter().map(|&i| (i, 1.0)));
                let qr = PivotedQr::of_rows(self.z.select_rows(&other));
                self.clear_rank(&qr, noise).ok()?
            }
        };
        Some(rows.len() + tied - self.z.ncols())
    }

    /// Those of the unique directions that say something: perpendicular to the ones along which the reaction is zero for all multipliers.
    ///
    /// # Errors
    /// As [`Basis::component`].
    pub(crate) fn live_directions(
        &self,
        unique: &[Vec<f64>],
        map: &Matrix,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Vec<f64>>, QueryError> {
        let rows = self.list(rows)?;
        check_map(map, &rows)?;
        let k = map.nrows();
        let (_, sizes) = self.images(map, &rows);
        let idle = self.idle_directions(map, &rows, &sizes);
        let live = unique.len().saturating_sub(idle.ncols());
        if idle.ncols() == 0 || live == 0 {
            return Ok(unique[..live].to_vec());
        }
        let unique = Matrix::from_fn(k, unique.len(), |i, j| unique[j][i]);
        let along = idle.transpose().product(&unique);
        let idle_part = idle.product(&along);
        let rest = Matrix::from_fn(k, unique.ncols(), |i, j| unique[(i, j)] - idle_part[(i, j)]);
        let basis = PivotedQr::of_columns(&rest).q_columns(0..live);
        let column = |j: usize| (0..k).map(|i| basis[(i, j)]).collect();
        Ok((0..live)
            .map(|j| normalised(column(j), self.known.tolerance.max(ROUNDING_OF_MAP)))
            .collect())
    }

    /// Orthonormal basis of the left null space of W, one vector in each column. Whether a component is nothing is told from rows of equal size.
    fn idle_directions(&self, map: &Matrix, rows: &[usize], sizes: &[f64]) -> Matrix {
        let k = map.nrows();
        let equal = Matrix::from_fn(k, rows.len(), |i, j| match sizes[i] {
            0.0 => 0.0,
            size => map[(i, j)] * self.known.row_factor[rows[j]] / size,
        });
        let qr = PivotedQr::of_columns(&equal);
        let rounding = self.rounding_of_map();
        let rank = qr.r_diagonal().filter(|r| r.abs() > rounding).count();
        let idle = qr.q_columns(rank..k);
        let back = |i: usize| if sizes[i] == 0.0 { 1.0 } else { sizes[i] };
        let idle = Matrix::from_fn(k, k - rank, |i, j| idle[(i, j)] / back(i));
        PivotedQr::of_columns(&idle).q_columns(0..k - rank)
    }

    /// A map is known as well as the entries of C, which stand at the same poses.
    fn rounding_of_map(&self) -> f64 {
        (MAP_FACTOR * self.known.uncertainty).max(ROUNDING_OF_MAP)
    }

    /// How many pivots are certainly not zero, if the others certainly are.
    fn clear_rank(&self, qr: &PivotedQr, noise: f64) -> Result<usize, QueryError> {
        let mut rank = 0;
        for pivot in qr.r_diagonal().map(f64::abs) {
            match self.known.readings.read(pivot, noise) {
                CoefficientReading::NonZero => rank += 1,
                CoefficientReading::Zero => {}
                CoefficientReading::Unclear {
                    tolerance,
                    required,
                } => {
                    return Err(QueryError::Directions {
                        margin: pivot,
                        tolerance,
                        required,
                    });
                }
            }
        }
        Ok(rank)
    }

    /// Rows in the order given, all of which exist.
    fn list(&self, rows: impl IntoIterator<Item = usize>) -> Result<Vec<usize>, QueryError> {
        let m = self.c.nrows();
        rows.into_iter()
            .map(|row| match row < m {
                true => Ok(row),
                false => Err(QueryError::RowOutOfRange { row, rows: m }),
            })
            .collect()
    }

    /// The same, each row once.
    fn set(&self, rows: impl IntoIterator<Item = usize>) -> Result<Vec<usize>, QueryError> {
        let mut rows = self.list(rows)?;
        rows.sort_unstable();
        rows.dedup();
        Ok(rows)
    }

    fn product(&self, rows: &[usize]) -> Matrix {
        let mut b = Matrix::zeros(self.c.ncols(), self.z.ncols());
        for &i in rows {
            for (k, &c) in self.c.row(i).iter().enumerate().filter(|(_, c)| **c != 0.0) {
                for (b, z) in b.row_mut(k).iter_mut().zip(self.z.row(i)) {
                    *b += c * z;
                }
            }
        }
        b
    }

    /// `W·Z_X` with rows divided by the norms of those of `W·D_r⁻¹`, and these norms; zero where a row is rounding beside the others.
    fn images(&self, map: &Matrix, rows: &[usize]) -> (Matrix, Vec<f64>) {
        let (mut images, mut sizes): (Vec<_>, Vec<_>) = (0..map.nrows())
            .map(|i| self.scaled_row(map.row(i), rows))
            .unzip();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        if self.exact.is_none() {
            let rounding = self.rounding_of_map();
            for (image, size) in images.iter_mut().zip(&mut sizes) {
                if *size <= rounding * largest {
                    image.fill(0.0);
                    *size = 0.0;
                }
            }
        }
        let images = Matrix::from_fn(map.nrows(), self.z.ncols(), |i, j| images[i][j]);
        (images, sizes)
    }

    /// `wᵀ·D_r·Z_X / ‖wᵀ·D_r‖` and the norm that was divided by; zeros for w = 0.
    fn scaled_row(&self, w: &[f64], rows: &[usize]) -> (Vec<f64>, f64) {
        let scaled: Vec<f64> = rows
            .iter()
            .zip(w)
            .map(|(&i, w)| w * self.known.row_factor[i])
            .collect();
        let size = norm(&scaled);
        let mut out = vec![0.0; self.z.ncols()];
        if size > 0.0 {
            for (&i, w) in rows.iter().zip(&scaled) {
                for (o, z) in out.iter_mut().zip(self.z.row(i)) {
                    *o += w / size * z;
                }
            }
        }
        (out, size)
    }

    /// Noise of a combination of rows of Z with these weights; Z is `[−T̃, I]` in a basis that makes no row longer.
    fn noise(&self, weights: impl Iterator<Item = (usize, f64)>) -> f64 {
        let term = |(i, weight): (usize, f64)| self.known.row_noise[i] * weight.abs();
        weights.map(term).fold(0.0, f64::hypot)
    }

    /// Noise of `wᵀ·D_r·Z_X / size`.
    fn noise_of_row(&self, w: &[f64], rows: &[usize], size: f64) -> f64 {
        if size == 0.0 {
            return 0.0;
        }
        let scaled = |(&i, w): (&usize, &f64)| (i, w * self.known.row_factor[i] / size);
        self.noise(rows.iter().zip(w).map(scaled))
    }

    /// Judges a margin made of coefficients of Z with this noise.
    fn judge(
        &self,
        margin: f64,
        noise: f64,
        vanishes: impl FnOnce(&ExactNullSpace) -> bool,
    ) -> Judgement {
        match (&self.exact, &self.known.status) {
            (Some(z), _) => Judgement::exact(margin, vanishes(z)),
            (None, RankStatus::Undecided(doubt)) => Judgement::without_rank(margin, doubt),
            (None, _) => Judgement::of(margin, self.known.readings.read(margin, noise)),
        }
    }
}

fn check_coefficients(l: &[f64], expected: usize) -> Result<(), QueryError> {
    if l.len() != expected {
        return Err(QueryError::Length {
            found: l.len(),
            expected,
        });
    }
    match l.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(QueryError::NonFinite {
            index,
            value: l[index],
        }),
        None => Ok(()),
    }
}

fn check_map(map: &Matrix, rows: &[usize]) -> Result<(), QueryError> {
    (0..map.nrows()).try_for_each(|i| check_coefficients(map.row(i), rows.len()))
}

fn combination(w: &[f64], rows: &[usize]) -> Vec<(usize, f64)> {
    rows.iter().copied().zip(w.iter().copied()).collect()
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn unit(n: usize, i: usize) -> Vec<f64> {
    (0..n).map(|k| if k == i { 1.0 } else { 0.0 }).collect()
}

/// The unit vector along x, the largest entry positive, rounding set to zero.
fn normalised(mut x: Vec<f64>, rounding: f64) -> Vec<f64> {
    let largest = x
        .iter()
        .fold(0.0_f64, |a, &b| if b.abs() > a.abs() { b } else { a });
    let size = norm(&x) * largest.signum();
    for x in &mut x {
        *x /= size;
        if x.abs() <= rounding {
            *x = 0.0;
        }
    }
    x
}
