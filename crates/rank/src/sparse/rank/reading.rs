//! Evaluates the evidence of a sparse rank, for the rank and for each row.

use super::{SparseEvidence, SparseRank};
use crate::decision::{coefficient_noise, required, shown, tolerance};
use crate::{CoefficientReading, Doubt, RankStatus, Readings};
use linalg::kernels;

impl SparseRank {
    /// Returns whether the rank is decided.
    pub fn is_decided(&self) -> bool {
        self.status == RankStatus::Decided
    }

    /// Returns an estimate of the norm of row i of an orthonormal basis Z of the left null space.
    /// The norm is zero iff the multiplier of the row is unique, and one iff the row alone is
    /// dependent (a row of zeros).
    ///
    /// # Panics
    /// Panics if `i` is not a row.
    pub fn margin(&self, i: usize) -> f64 {
        kernels::norm(self.sketch.row(i))
    }

    /// Classifies the margin of row i, which shows whether the multiplier of the row is unique.
    /// Margins within the noise are zero if they are smaller than all other margins by a factor of
    /// 10⁴. Otherwise they are unclear.
    ///
    /// # Panics
    /// Panics if `i` is not a row.
    pub fn read_row(&self, i: usize) -> CoefficientReading {
        self.readings().read(self.margin(i), self.noise())
    }

    /// Rules by which margins are classified.
    pub fn readings(&self) -> Readings {
        Readings {
            is_certified: false,
            has_tolerance: false,
            smallest: self.evidence.smallest_margin,
        }
    }

    /// Returns a bound on the error (norm) of a row of W. The part of W outside the left null space
    /// is at most ‖Cᵀ·W‖/σ_r. In addition, W differs from the W of the intended matrix by the
    /// uncertainty divided by σ_r.
    pub fn noise(&self) -> f64 {
        let e = &self.evidence;
        let known = e.sigma_next.max(tolerance(1, 1, e.uncertainty));
        coefficient_noise(known, e.sigma_r)
    }

    /// Returns the largest margin within the noise, and the smallest margin above the noise.
    pub(super) fn margins(&self) -> (f64, f64) {
        let noise = self.noise();
        let (mut zero, mut other) = (0.0_f64, f64::INFINITY);
        for margin in (0..self.sketch.nrows()).map(|i| self.margin(i)) {
            if margin <= noise {
                zero = zero.max(margin);
            } else {
                other = other.min(margin);
            }
        }
        (zero, other)
    }

    /// Applies the rule of rank decisions to the evidence; `norm` is ‖C‖ (Frobenius).
    pub(super) fn read(&self, norm: f64) -> RankStatus {
        let SparseEvidence {
            sigma_r,
            sigma_next,
            tolerance,
            ..
        } = self.evidence;
        let required = required(tolerance);
        let unclear = |lower: usize, upper: usize, sigma: f64| {
            RankStatus::Undecided(Doubt::NoClearGap {
                lower,
                upper,
                sigma,
                tolerance,
                required,
            })
        };
        let (fewer, more) = (
            self.rank.min(self.kept.len()),
            self.rank.max(self.kept.len()),
        );
        if more == 0 && norm > 0.0 {
            RankStatus::Undecided(Doubt::NotPolished {
                sigma_max: norm,
                tolerance,
            })
        } else if fewer < more {
            unclear(fewer, more, sigma_r)
        } else if sigma_next > tolerance {
            unclear(self.rank, self.rank + 1, sigma_next)
        } else if sigma_r < required {
            unclear(self.rank.saturating_sub(1), self.rank, sigma_r)
        } else {
            shown(sigma_next, tolerance)
        }
    }
}
