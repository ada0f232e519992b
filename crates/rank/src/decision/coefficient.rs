//! Decides whether a coefficient of the dependencies is zero. The tolerance for T, Z and values
//! derived from T and Z follows from the evidence of the rank.

use super::Grounds;
use super::outcome::RankDecision;
use crate::limits::{
    AS_READ, BEYOND_DOUBT, CERTAIN, COEFFICIENT_CLEARANCE, COMBINATION_SPREAD, NOISE_FACTOR,
    POSE_FACTOR, SOLVE_FACTOR, STATED_MAX, STATED_ZERO, TOLERANCE_MAX, VANISHED,
};

/// Classification of a coefficient of the equilibrated dependencies.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum CoefficientReading {
    /// The coefficient is certainly zero.
    Zero,
    /// The coefficient is certainly not zero.
    NonZero,
    /// The evidence does not decide whether the coefficient is zero.
    Unclear {
        /// Largest size that rounding and uncertainty can cause.
        tolerance: f64,
        /// Smallest size that is certainly not zero.
        required: f64,
    },
}

impl CoefficientReading {
    /// Classifies a value of this size with the uncertainty `tolerance`.
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

/// Returns a bound on the error of a coefficient if singular values are accurate to `tolerance`:
/// `10·τ/σ_r`.
pub(crate) fn coefficient_noise(tolerance: f64, sigma_r: f64) -> f64 {
    SOLVE_FACTOR * tolerance / sigma_r.min(1.0)
}

impl RankDecision {
    /// Returns whether coefficients are compared with a tolerance that the scene states.
    #[must_use]
    pub fn has_tolerance(&self) -> bool {
        let certificate = self.evidence.certificate.as_ref();
        certificate.is_some_and(|c| c.has_tolerance)
    }

    /// Returns whether rows are redundant only within a stated tolerance. Other data within this
    /// tolerance have a higher rank.
    #[must_use]
    pub fn is_within_tolerance(&self) -> bool {
        let certificate = self.evidence.certificate.as_ref();
        certificate.is_some_and(|c| c.grounds == Grounds::WithinTolerance)
    }

    /// Returns whether the entries of the matrix are exact, so that zeros of T are exact as well.
    /// The entries are not exact if the rank belongs to other data within the accuracy of the given
    /// data.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        let certificate = self.evidence.certificate.as_ref();
        certificate.is_some_and(|c| c.uncertainty == 0.0 && c.grounds != Grounds::WithinData)
    }

    /// Returns a bound on the absolute error of a coefficient of T̃ or Z: `10·τ/σ_r`, or `s/σ_r`
    /// for a certified rank of a matrix with uncertainty s (Frobenius norm).
    ///
    /// For exact entries the noise consists only of rounding errors. For a nearly redundant matrix
    /// the noise is the error for the stored matrix, `10·‖C_D − T·C_K‖/σ_r`. In this case,
    /// [`RankDecision::nearly_redundant`] contains the effect of the uncertainty of the data.
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
            // T is accurate to double-double. The remaining error comes from the data, so ‖δT‖ ≤
            // ‖δC‖·‖[T, I]‖/σ_r. If the rank is valid only for data within their uncertainty,
            // σ_{r+1} remains as a residual.
            Some(certificate) => {
                let by_data = certificate.row_data.iter().flatten().copied();
                by_data
                    .fold(rounding, f64::max)
                    .max(certificate.spread.max(e.sigma_next) / e.sigma_r.min(1.0))
            }
            None => coefficient_noise(e.tolerance, e.sigma_r),
        }
    }

    /// Returns a bound on the error (norm) of row i of `[−T̃, I]`. The bound is the sum of three
    /// parts: the uncertainty of the entries on which the row depends, the residual `10·‖C_D −
    /// T·C_K‖/σ_r` of dependencies that exist only within the data, and rounding. If the effect of
    /// the data is known and larger, the function returns this effect instead. The bound is at most
    /// about [`RankDecision::coefficient_tolerance`], and much smaller in a matrix of mixed sizes.
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

    /// Returns the part of [`RankDecision::row_noise`] that does not come from a stated tolerance.
    /// A row below this part is zero for all data. A row above it is zero only within the
    /// tolerance.
    #[must_use]
    pub fn row_rounding(&self, i: usize) -> f64 {
        let certificate = self.evidence.certificate.as_ref();
        let noise = certificate.and_then(|c| c.row_noise.get(i));
        POSE_FACTOR * NOISE_FACTOR * (f64::EPSILON + noise.copied().unwrap_or(0.0))
    }

    /// Classifies the size of a coefficient, or the norm of several coefficients, given its noise.
    #[must_use]
    pub fn read_coefficient(&self, size: f64, noise: f64) -> CoefficientReading {
        self.readings().read(size, noise)
    }

    /// Returns the largest coefficient with this noise that is omitted from a dependency.
    pub(crate) fn largest_zero(&self, noise: f64) -> f64 {
        if self.has_tolerance() {
            noise.min(STATED_ZERO)
        } else {
            noise
        }
    }

    /// Returns the rules by which the coefficients of the decision are classified.
    #[must_use]
    pub fn readings(&self) -> Readings {
        Readings {
            is_certified: self.evidence.certificate.is_some(),
            has_tolerance: self.has_tolerance(),
            smallest: f64::INFINITY,
        }
    }
}

/// Rules by which coefficients are classified, common to all coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Readings {
    /// Whether the coefficients were computed in double-double.
    pub(crate) is_certified: bool,
    /// Whether the noise includes a stated tolerance of any size.
    pub(crate) has_tolerance: bool,
    /// The smallest coefficient that is not zero, if the noise is estimated from this coefficient;
    /// otherwise infinite.
    pub(crate) smallest: f64,
}

impl Readings {
    /// Classifies the size of a coefficient, or the norm of several coefficients, given its noise.
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

    /// A coefficient of a tenth does not count as zero only because data within the tolerance could
    /// make it zero.
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

    /// A coefficient is nonzero if it exceeds ten times its tolerance and a billionth. No
    /// coefficient is zero if the tolerance is above 1e-5.
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

    /// In double-double, a zero appears as 1e-13 or less, for any accuracy of the data. Zeros of
    /// random combinations are ten thousand times smaller than nonzero values.
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
