//! Verdicts on rows with a given left null space. The rows are all rows of a matrix, or the rows of
//! one joint in a large mechanism.
//!
//! This module does not compute the null space.

use crate::limits::ROUNDING_OF_MAP;

use linalg::{Matrix, PivotedQr};
use rank::{CoefficientReading, ExactNullSpace, RankStatus, Readings};

use super::MultiplierMap;
use super::error::QueryError;
use crate::verdict::{Judgement, Verdict, worst};

/// Rows, vectors that span the part of the left null space in these rows, and the accuracy of both.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    /// The equilibrated rows, m × n. Columns without an entry may be omitted.
    pub(crate) c: Matrix,
    /// The rows of an orthonormal basis of the left null space, or of random combinations of the
    /// basis, m × p.
    pub(crate) z: Matrix,
    /// Accuracy of `c` and `z`.
    pub(crate) known: RowAccuracy,
    /// The left null space modulo primes, if the entries are exact.
    pub(crate) exact: Option<ExactNullSpace>,
}

/// Accuracy of rows of C and Z according to the evidence of a rank.
#[derive(Clone, Debug)]
pub(crate) struct RowAccuracy {
    /// Whether the rank is decided.
    pub(crate) status: RankStatus,
    /// Row factors of the equilibration, D_r.
    pub(crate) row_factor: Vec<f64>,
    /// Uncertainty of each row of Z (norm).
    pub(crate) row_noise: Vec<f64>,
    /// Part of `row_noise` that does not come from the tolerance stated by the scene. The list is
    /// empty if the scene states no tolerance.
    pub(crate) row_rounding: Vec<f64>,
    /// Uncertainty of any single coefficient.
    pub(crate) tolerance: f64,
    /// Uncertainty of the rows of C (Frobenius norm).
    pub(crate) spread: f64,
    /// Uncertainty of an entry of C.
    pub(crate) uncertainty: f64,
    /// For each row, the angle (rad) by which its force rotates and the length (m) by which its
    /// force shifts within a stated tolerance; `None` without a tolerance.
    pub(crate) row_turn: Option<Vec<[f64; 2]>>,
    /// Rules by which margins are classified.
    pub(crate) readings: Readings,
}

impl Basis {
    /// Returns the verdict on the multiplier of one row. The multiplier is unique iff `Z_i = 0`.
    ///
    /// # Errors
    /// Returns an error if the row does not exist.
    pub(crate) fn row(&self, i: usize) -> Result<Judgement, QueryError> {
        self.multipliers([i])
    }

    /// Returns the verdict on all multipliers of a group of rows. The multipliers are unique iff
    /// `Z_X = 0`. If the rows depend on each other, this condition is stronger than the condition
    /// of [`Basis::group`].
    ///
    /// # Errors
    /// Returns an error if a row does not exist.
    pub(crate) fn multipliers(
        &self,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Judgement, QueryError> {
        let rows = self.set(rows)?.into_iter();
        let judged = rows.map(|i| {
            let noise = self.noise(std::iter::once((i, 1.0)));
            self.judge(norm(self.z.row(i)), noise, |z| z.annihilates([(i, 1.0)]))
        });
        // Each row has its own noise. A large noise of one row must not hide a certain result of
        // another row.
        let judged: Vec<Judgement> = judged.collect();
        let margin = judged.iter().map(|j| j.margin).fold(0.0, f64::hypot);
        let unique = Judgement::new(Verdict::Unique, 0.0);
        let worst = worst(judged.into_iter()).unwrap_or(unique);
        Ok(Judgement { margin, ..worst })
    }

    /// Returns `B_X = C_Xᵀ·Z_X` (n × p) of a group of equilibrated rows.
    ///
    /// # Errors
    /// Returns an error if a row does not exist.
    pub(crate) fn b_x(&self, rows: impl IntoIterator<Item = usize>) -> Result<Matrix, QueryError> {
        Ok(self.product(&self.set(rows)?))
    }

    /// Returns the verdict on the reaction of a group of rows. The reaction is unique iff `B_X =
    /// 0`, and the margin is ‖B_X‖ (Frobenius).
    ///
    /// # Errors
    /// Returns an error if a row does not exist.
    pub(crate) fn group(
        &self,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Judgement, QueryError> {
        let rows = self.set(rows)?;
        // Rows of C cancel only to the accuracy of the entries of C.
        let cancelled = rows.iter().map(|&i| norm(self.z.row(i)));
        let spread = self.known.spread * cancelled.fold(0.0, f64::hypot);
        let noise = self
            .noise(rows.iter().map(|&i| (i, norm(self.c.row(i)))))
            .with(spread);
        let margin = self.product(&rows).frobenius_norm();
        Ok(self.judge(margin, noise, |z| z.wrench_vanishes(&rows)))
    }

    /// Returns the verdict on a linear combination `ℓᵀ·λ` of all multipliers. The combination is
    /// unique iff `ℓᵀ·Z = 0`. The margin is relative to ‖ℓ‖. Both values are computed for
    /// equilibrated rows.
    ///
    /// # Errors
    /// Returns an error if the number of coefficients is not m, or if a coefficient is not finite.
    pub(crate) fn combination(&self, l: &[f64]) -> Result<Judgement, QueryError> {
        let rows: Vec<usize> = (0..self.c.nrows()).collect();
        check_coefficients(l, rows.len())?;
        let mut image = vec![0.0; self.z.ncols()];
        let size = self.scaled_row(l, &rows, &mut image);
        let noise = self.noise_of_row(l, &rows, size);
        Ok(self.judge(norm(&image), noise, |z| {
            z.annihilates(combination(l, &rows))
        }))
    }

    /// Returns the reaction `W·λ_X`. Column l of W belongs to row l of the list.
    ///
    /// # Errors
    /// Returns an error if a row does not exist, if W does not have a column for each row, or if W
    /// is not finite.
    pub(crate) fn mapped<'a>(
        &'a self,
        map: &'a Matrix,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<MultiplierMap<'a>, QueryError> {
        MultiplierMap::new(self, map, self.list(rows)?)
    }

    /// Returns whether no dependency contains these rows. In this case, all numbers that are
    /// computed from their multipliers are unique.
    pub(crate) fn is_free_of(&self, rows: &[usize]) -> bool {
        let size = rows.iter().map(|&i| norm(self.z.row(i)));
        let size = size.fold(0.0, f64::hypot);
        let noise = rows.iter().map(|&i| self.known.row_noise[i]);
        let (least, most) = noise.fold((f64::INFINITY, 0.0_f64), |(least, most), noise| {
            (least.min(noise), most.max(noise))
        });
        let reading = self.known.readings.read(size, most);
        let is_known = self.exact.is_none() && self.known.status == RankStatus::Decided;
        is_known && size <= least && reading == CoefficientReading::Zero
    }

    /// Returns the rank of some of the rows (ascending) from the dependencies of all rows. The
    /// number of dependencies without other rows (`z = 0` in the other rows) is `p − rank Z_other`.
    /// Returns `None` if the rank of all rows is undecided, or if the rank of Z_other is unclear.
    pub(crate) fn rank_of(&self, rows: &[usize]) -> Option<usize> {
        if self.known.status != RankStatus::Decided {
            return None;
        }
        let is_other = |i: &usize| rows.binary_search(i).is_err();
        let other: Vec<usize> = (0..self.z.nrows()).filter(is_other).collect();
        let tied = match &self.exact {
            Some(z) => {
                let rows: Vec<_> = other.iter().map(|&i| vec![(i, 1.0)]).collect();
                z.rank_of(&rows)
            }
            None => {
                let noise = self.noise(other.iter().map(|&i| (i, 1.0))).known;
                let qr = PivotedQr::of_rows(self.z.select_rows(&other));
                self.clear_rank(&qr, noise).ok()?
            }
        };
        Some(self.z.nrows() - other.len() + tied - self.z.ncols())
    }

    /// Returns the accuracy of a map. The result is the accuracy of the entries of C, because the
    /// map and C are evaluated at the same configuration.
    pub(super) fn rounding_of_map(&self) -> f64 {
        (rank::NOISE_FACTOR * self.known.uncertainty).max(ROUNDING_OF_MAP)
    }

    /// Returns the number of pivots that are certainly not zero. All other pivots must certainly be
    /// zero.
    pub(super) fn clear_rank(&self, qr: &PivotedQr, noise: f64) -> Result<usize, QueryError> {
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

    /// Returns the rows in the given order. The function first checks that they exist.
    fn list(&self, rows: impl IntoIterator<Item = usize>) -> Result<Vec<usize>, QueryError> {
        let m = self.c.nrows();
        rows.into_iter()
            .map(|row| {
                if row < m {
                    Ok(row)
                } else {
                    Err(QueryError::RowOutOfRange { row, rows: m })
                }
            })
            .collect()
    }

    /// Returns the rows in ascending order without repetition. The function first checks that they
    /// exist.
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

    /// Adds `wᵀ·D_r·Z_X / ‖wᵀ·D_r‖` to a row of p numbers and returns the norm. The row does not
    /// change if w = 0.
    pub(super) fn scaled_row(&self, w: &[f64], rows: &[usize], out: &mut [f64]) -> f64 {
        let weights = || {
            rows.iter()
                .zip(w)
                .map(|(&i, w)| (i, w * self.known.row_factor[i]))
        };
        let size = weights().map(|(_, w)| w * w).sum::<f64>().sqrt();
        if size > 0.0 {
            for (i, w) in weights().filter(|(_, w)| *w != 0.0) {
                for (o, z) in out.iter_mut().zip(self.z.row(i)) {
                    *o += w / size * z;
                }
            }
        }
        size
    }

    /// Returns the noise of a combination of rows of Z with these weights. In the basis Z = `[−T̃,
    /// I]`, no row is longer than in Z.
    fn noise(&self, weights: impl Iterator<Item = (usize, f64)>) -> Noise {
        let rounding = &self.known.row_rounding;
        weights.fold(Noise::default(), |noise, (i, weight)| Noise {
            known: noise.known.hypot(self.known.row_noise[i] * weight.abs()),
            rounding: rounding.get(i).map_or(f64::INFINITY, |known| {
                noise.rounding.hypot(known * weight.abs())
            }),
        })
    }

    /// Returns the noise of `wᵀ·D_r·Z_X / size`.
    pub(super) fn noise_of_row(&self, w: &[f64], rows: &[usize], size: f64) -> Noise {
        if size == 0.0 {
            return Noise::default();
        }
        let scaled = |(&i, w): (&usize, &f64)| (i, w * self.known.row_factor[i] / size);
        self.noise(rows.iter().zip(w).map(scaled))
    }

    /// Returns the verdict on a margin that consists of coefficients of Z with this noise.
    pub(super) fn judge(
        &self,
        margin: f64,
        noise: Noise,
        vanishes: impl FnOnce(&ExactNullSpace) -> bool,
    ) -> Judgement {
        match (&self.exact, &self.known.status) {
            (Some(z), _) => Judgement::exact(margin, vanishes(z)),
            (None, RankStatus::Undecided(doubt)) => Judgement::without_rank(margin, doubt),
            // If the rows are independent, every verdict is certain.
            (None, _) if self.z.ncols() == 0 => Judgement::new(Verdict::Unique, 0.0),
            (None, _) => {
                let reading = self.known.readings.read(margin, noise.known);
                Judgement::of(margin, reading, margin > noise.rounding)
            }
        }
    }
}

/// Bounds on the error of a margin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Noise {
    /// Bound with the whole uncertainty of the data.
    pub(super) known: f64,
    /// Bound without the tolerance stated by the scene. The bound is infinite if the scene states
    /// no tolerance.
    pub(super) rounding: f64,
}

impl Noise {
    /// Adds a source of error that exists only within the stated tolerance.
    pub(super) fn within_tolerance(self, other: f64) -> Self {
        Self {
            known: self.known.hypot(other),
            ..self
        }
    }

    /// Adds a source of error.
    fn with(self, other: f64) -> Self {
        Self {
            known: self.known.hypot(other),
            rounding: self.rounding.hypot(other),
        }
    }
}

pub(super) fn check_coefficients(l: &[f64], expected: usize) -> Result<(), QueryError> {
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

pub(super) fn combination(w: &[f64], rows: &[usize]) -> Vec<(usize, f64)> {
    rows.iter().copied().zip(w.iter().copied()).collect()
}

pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
