//! Is a coefficient of the dependencies zero? The tolerance for T, Z and what is made of them, from
//! the evidence of the rank.

use super::outcome::RankDecision;
use crate::limits::{
    AS_READ, BEYOND_DOUBT, CERTAIN, COEFFICIENT_CLEARANCE, COMBINATION_SPREAD, NOISE_FACTOR,
    POSE_FACTOR, SOLVE_FACTOR, STATED_MAX, STATED_ZERO, TOLERANCE_MAX, VANISHED,
};

/// How a coefficient of the equilibrated dependencies reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CoefficientReading {
    /// Certainly zero.
    Zero,
    /// Certainly not zero.
    NonZero,
    /// The evidence does not tell.
    Unclear {
        /// Rounding and uncertainty reach up to here.
        tolerance: f64,
        /// Above this it would certainly not be zero.
        required: f64,
    },
}

impl CoefficientReading {
    /// Reads the size of a number known to `tolerance`.
    pub(crate) fn of(size: f64, tolerance: f64) -> Self {
        let required = (COEFFICIENT_CLEARANCE * tolerance).max(CERTAIN);
        if size <= tolerance && tolerance <= TOLERANCE_MAX {
            Self::Zero
        } else if size > required {
            Self::NonZero
        } else {
            Self::Unclear {
                tolerance,
                required,
            }
        }
    }
}

/// How far a coefficient may be from its true value where singular values are known to `tolerance`:
/// `10·τ/σ_r`.
pub(crate) fn coefficient_noise(tolerance: f64, sigma_r: f64) -> f64 {
    SOLVE_FACTOR * tolerance / sigma_r.min(1.0)
}

impl RankDecision {
    /// Whether coefficients are read to a tolerance that the scene states.
    #[must_use]
    pub fn has_tolerance(&self) -> bool {
        let certificate = self.evidence.certificate.as_ref();
        certificate.is_some_and(|c| c.has_tolerance)
    }

    /// Whether the entries of the matrix are meant exactly as they stand, so that T is zero exactly
    /// where it is zero.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.evidence
            .certificate
            .as_ref()
            .is_some_and(|c| c.uncertainty == 0.0)
    }

    /// How far a coefficient of T̃ or Z may be from its true value, absolute: `10·τ/σ_r`, or, for a
    /// certified rank of a matrix known to s (Frobenius norm), `s/σ_r`.
    ///
    /// For exact entries, rounding alone. For a nearly redundant matrix, that of the matrix as it
    /// was read, `10·‖C_D − T·C_K‖/σ_r`: what the uncertainty of the data does there is told by
    /// [`RankDecision::nearly_redundant`].
    #[must_use]
    pub fn coefficient_tolerance(&self) -> f64 {
        let e = &self.evidence;
        let (m, n) = (self.scaling.rows.len(), self.scaling.cols.len());
        let rounding = NOISE_FACTOR * f64::EPSILON * (m as f64 * n as f64).sqrt();
        if self.redundancy == 0 || self.is_exact() {
            return rounding;
        }
        match &e.certificate {
            Some(_) if e.sigma_r < AS_READ => {
                rounding.max(SOLVE_FACTOR * e.dependence_residual / e.sigma_r)
            }
            // T is right to double-double; what remains is the data: ‖δT‖ ≤ ‖δC‖·‖[T, I]‖/σ_r.
            // A rank that only data within their uncertainty have leaves σ_{r+1} of it.
            Some(certificate) => {
                let by_data = certificate.row_data.iter().flatten().copied();
                by_data
                    .fold(rounding, f64::max)
                    .max(certificate.spread.max(e.sigma_next) / e.sigma_r.min(1.0))
            }
            None => coefficient_noise(e.tolerance, e.sigma_r),
        }
    }

    /// How far row i of `[−T̃, I]` may be from its true value (norm): that of the entries it
    /// depends on, that of dependencies which hold within the data only, `10·‖C_D − T·C_K‖/σ_r`,
    /// and rounding; or what the data make of it, where that is known and more. At most about
    /// [`RankDecision::coefficient_tolerance`], in a matrix of mixed sizes much less.
    #[must_use]
    pub fn row_noise(&self, i: usize) -> f64 {
        let tolerance = self.coefficient_tolerance();
        let e = &self.evidence;
        let certificate = e.certificate.as_ref();
        let by_data = certificate.and_then(|c| c.row_data.as_ref());
        let by_data = by_data.map_or(0.0, |known| known[i]);
        let by_entries = match certificate.and_then(|c| c.row_noise.get(i)) {
            Some(noise) if e.sigma_r >= AS_READ => {
                let inexact = SOLVE_FACTOR * e.dependence_residual / e.sigma_r.min(1.0);
                (POSE_FACTOR * NOISE_FACTOR * (f64::EPSILON + noise) + inexact).min(tolerance)
            }
            _ => tolerance,
        };
        by_entries.max(by_data)
    }

    /// What of [`RankDecision::row_noise`] is there without a stated tolerance: a row that is
    /// shorter than that vanishes by itself, a longer one within the tolerance only.
    #[must_use]
    pub fn row_rounding(&self, i: usize) -> f64 {
        let certificate = self.evidence.certificate.as_ref();
        let noise = certificate.and_then(|c| c.row_noise.get(i));
        POSE_FACTOR * NOISE_FACTOR * (f64::EPSILON + noise.copied().unwrap_or(0.0))
    }

    /// Reads the size of a coefficient, or of a norm of some, of which the noise is known.
    #[must_use]
    pub fn read_coefficient(&self, size: f64, noise: f64) -> CoefficientReading {
        self.readings().read(size, noise)
    }

    /// Up to here a coefficient with this noise is left out of a dependency.
    pub(crate) fn largest_zero(&self, noise: f64) -> f64 {
        if self.has_tolerance() {
            noise.min(STATED_ZERO)
        } else {
            noise
        }
    }

    /// How its coefficients are read.
    #[must_use]
    pub fn readings(&self) -> Readings {
        Readings {
            is_certified: self.evidence.certificate.is_some(),
            has_tolerance: self.has_tolerance(),
            smallest: f64::INFINITY,
        }
    }
}

/// How coefficients are read: what is known of all of them beyond the noise of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Readings {
    /// Whether they came out in double-double.
    pub(crate) is_certified: bool,
    /// Noise is what a stated tolerance makes of the coefficients, as large as that may be.
    pub(crate) has_tolerance: bool,
    /// The smallest one that is not zero, where the noise is estimated from it; infinite otherwise.
    pub(crate) smallest: f64,
}

impl Readings {
    /// Reads the size of a coefficient, or of a norm of some, of which the noise is known.
    #[must_use]
    pub fn read(&self, size: f64, noise: f64) -> CoefficientReading {
        if self.has_tolerance {
            let required = (BEYOND_DOUBT * noise).max(CERTAIN);
            return match size {
                _ if size <= noise.min(STATED_ZERO) && noise <= STATED_MAX => {
                    CoefficientReading::Zero
                }
                _ if size > required => CoefficientReading::NonZero,
                _ => CoefficientReading::Unclear {
                    tolerance: noise,
                    required,
                },
            };
        }
        let far_below = self.smallest / COMBINATION_SPREAD;
        match CoefficientReading::of(size, noise) {
            CoefficientReading::Zero if size > far_below => CoefficientReading::Unclear {
                tolerance: far_below,
                required: noise,
            },
            CoefficientReading::Unclear { .. }
                if size <= VANISHED.min(noise) && self.is_certified =>
            {
                CoefficientReading::Zero
            }
            reading => reading,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tenth of a reaction is not left out because data within the tolerance could make it zero.
    #[test]
    fn within_a_tolerance_only_what_is_small_is_zero() {
        let within = Readings {
            is_certified: true,
            has_tolerance: true,
            smallest: f64::INFINITY,
        };
        assert_eq!(within.read(5e-4, 0.02), CoefficientReading::Zero);
        assert_eq!(within.read(0.3, 0.095), CoefficientReading::NonZero);
        for (size, noise) in [(0.093, 0.095), (5e-3, 0.02), (5e-4, 0.2), (0.03, 0.02)] {
            let reading = within.read(size, noise);
            let is_open = matches!(reading, CoefficientReading::Unclear { .. });
            assert!(is_open, "{size}, {noise}: {reading:?}");
        }
    }

    fn is_unclear(reading: CoefficientReading) -> bool {
        matches!(reading, CoefficientReading::Unclear { .. })
    }

    /// Not zero is what exceeds ten times its tolerance and a billionth; nothing is zero where the
    /// tolerance is above 1e-5.
    #[test]
    fn a_coefficient_has_to_clear_its_tolerance() {
        use CoefficientReading::{NonZero, Zero};
        assert!(is_unclear(CoefficientReading::of(0.8e-9, 1e-12)));
        assert_eq!(CoefficientReading::of(1.2e-9, 1e-12), NonZero);
        assert!(is_unclear(CoefficientReading::of(0.8e-6, 1e-7)));
        assert_eq!(CoefficientReading::of(1.2e-6, 1e-7), NonZero);
        assert_eq!(CoefficientReading::of(1e-7, 0.8e-5), Zero);
        assert!(is_unclear(CoefficientReading::of(1e-7, 1.2e-5)));
    }

    /// In double-double a zero comes out as 1e-13 and less, whatever the data are known to; what
    /// random combinations call zero is ten thousand times smaller than what they do not.
    #[test]
    fn what_vanishes_is_zero_and_what_is_near_the_smallest_is_not() {
        let mut readings = Readings {
            is_certified: true,
            has_tolerance: false,
            smallest: f64::INFINITY,
        };
        assert_eq!(readings.read(0.8e-13, 1e-4), CoefficientReading::Zero);
        assert!(is_unclear(readings.read(1.2e-13, 1e-4)));
        readings.smallest = 1e-5;
        assert_eq!(readings.read(0.8e-9, 1e-8), CoefficientReading::Zero);
        assert!(is_unclear(readings.read(1.2e-9, 1e-8)));
        readings.is_certified = false;
        assert!(is_unclear(readings.read(0.8e-13, 1e-4)));
    }
}
