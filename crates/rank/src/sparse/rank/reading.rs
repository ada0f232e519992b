//! What the evidence of a sparse rank says: of the rank, and of each row.

use super::{SparseEvidence, SparseRank};
use crate::decision::{coefficient_noise, required, shown, tolerance};
use crate::{CoefficientReading, Doubt, RankStatus, Readings};
use linalg::kernels;

impl SparseRank {
    /// Whether the rank is decided.
    pub fn is_decided(&self) -> bool {
        self.status == RankStatus::Decided
    }

    /// An estimate of the norm of row i of an orthonormal basis Z of the left null space: zero iff
    /// the multiplier of the row is unique, one iff the row depends on nothing else.
    ///
    /// # Panics
    /// If `i` is not a row.
    pub fn margin(&self, i: usize) -> f64 {
        kernels::norm(self.sketch.row(i))
    }

    /// Reads the margin of row i: whether its multiplier is unique. Margins within the noise are
    /// zero if they are smaller than all others by a factor of 10⁴, unclear otherwise.
    ///
    /// # Panics
    /// If `i` is not a row.
    pub fn read_row(&self, i: usize) -> CoefficientReading {
        self.readings().read(self.margin(i), self.noise())
    }

    /// How margins are read.
    pub fn readings(&self) -> Readings {
        Readings {
            is_certified: false,
            has_tolerance: false,
            smallest: self.evidence.smallest_margin,
        }
    }

    /// How far a row of W may be from its true value (norm). The part of W outside the left null
    /// space is at most ‖Cᵀ·W‖/σ_r; that of the matrix meant is off by the uncertainty over σ_r
    /// besides.
    pub fn noise(&self) -> f64 {
        let e = &self.evidence;
        let known = e.sigma_next.max(tolerance(1, 1, e.uncertainty));
        coefficient_noise(known, e.sigma_r)
    }

    /// The largest margin within the noise, and the smallest beyond it.
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

    /// The rule of rank decisions on what is known; `norm` is ‖C‖ (Frobenius).
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
