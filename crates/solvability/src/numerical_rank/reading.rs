//! Decides the rank from C and the uncertainty of its data.
//!
//! Singular values below the uncertainty of the entries are zero, and singular values far above it
//! are not zero. Between these bounds, the decision uses the error of the data that the lower rank
//! requires. This error is compared with the uncertainty of the data.

use crate::limits::{CLEAR_OF_NOISE, CLEAR_OF_ROUNDING, CONFIRMED, NEAR_TOLD};
use linalg::Scaling;
use rank::{Doubt, Grounds, RankReading, RankStatus, Spectrum};

use super::UncertainMatrix;
use super::near::{Certainty, Nearness};
use super::share::{Question, StatedTolerance};

/// Result of the decision.
pub(crate) struct Reading {
    pub(crate) rank: RankReading,
    /// Distance of the data from one rank less, if a tolerance is stated and the distance is small
    /// enough to be reported.
    pub(crate) nearness: Option<Nearness>,
    /// Whether the scene states a tolerance.
    pub(crate) has_tolerance: bool,
}

impl UncertainMatrix {
    /// Returns the evidence for a rank from another source, or `None` if the uncertainty hides this
    /// rank.
    pub(crate) fn of_rank(&self, rank: usize) -> Option<RankReading> {
        let scaling = self.scaling();
        let scaled = Spectrum::of(scaling.apply(&self.c));
        let noise = self.noise(&scaling);
        let sigma_r = rank.checked_sub(1).map(|r| scaled.values()[r]);
        let is_seen = sigma_r.is_none_or(|sigma_r| sigma_r > noise);
        is_seen.then(|| RankReading {
            rank,
            status: RankStatus::Decided,
            scaling,
            matrix: scaled,
            noise,
            separation: sigma_r.map_or(0.0, |sigma_r| CONFIRMED * sigma_r),
            grounds: Grounds::WithinData,
        })
    }

    /// Returns the uncertainty of all scaled entries together.
    fn noise(&self, scaling: &Scaling) -> f64 {
        let (m, n) = (self.c.nrows() as f64, self.c.ncols() as f64);
        let rounding = rank::NOISE_FACTOR * f64::EPSILON * (m * n).sqrt();
        let uncertainty = scaling.apply(&self.uncertainty);
        uncertainty.frobenius_norm().max(rounding)
    }

    /// Determines the rank and records its evidence.
    pub(crate) fn read(&self, question: &Question<'_>) -> Reading {
        let scaling = self.scaling();
        let scaled = Spectrum::of(scaling.apply(&self.c));
        let sigma = scaled.values();
        let noise = self.noise(&scaling);
        let above = |limit: f64| sigma.partition_point(|&s| s > limit);
        let upper = above(noise);
        let clear = above(CLEAR_OF_ROUNDING.max(CLEAR_OF_NOISE * noise)).min(upper);
        let (mut rank, mut status) = (upper, RankStatus::Decided);
        // The loop searches for the lowest rank that the data allow.
        for lower in clear..upper {
            let share = question.share_of_rounding(scaled.matrix(), &scaling, lower);
            if share.high < (1.0 / rank::BEYOND_DOUBT) {
                rank = lower;
                break;
            }
            // Rounding is irrelevant if a tolerance is stated; the continuation then decides.
            if share.low <= rank::BEYOND_DOUBT && question.tolerance().is_none() {
                status = RankStatus::Undecided(Doubt::WithinRounding {
                    lower,
                    upper,
                    sigma: sigma[lower],
                    share: share.high,
                });
                break;
            }
        }
        let hidden = sigma.get(rank).copied().unwrap_or(0.0);
        if rank == 0 && hidden > noise {
            status = RankStatus::Undecided(Doubt::NotPolished {
                sigma_max: hidden,
                tolerance: noise,
            });
        } else if noise > rank::HIDDEN
            && hidden > rank::NOT_ROUNDING
            && status == RankStatus::Decided
        {
            status = RankStatus::Undecided(Doubt::Hidden {
                sigma: hidden,
                tolerance: noise,
            });
        }
        let (mut nearness, mut grounds) = (None, Grounds::WithinData);
        let tolerance = question.tolerance();
        if let (RankStatus::Decided, Some(tolerance)) = (status, tolerance) {
            let limit = (NEAR_TOLD * question.size).max(rank::BEYOND_DOUBT * tolerance.metres);
            let least = question.least_rank(rank, tolerance, limit);
            nearness = least.nearness;
            if least.rank < rank {
                grounds = Grounds::WithinTolerance;
            }
            rank = least.rank;
            let from = match least.certainty {
                Certainty::From(length) => Some(length),
                _ => None,
            };
            if least.certainty != Certainty::Decided {
                status = open(question, tolerance, rank, from);
            }
        }
        // A redundancy within a tolerance refers to lengths in one common unit. A short lever must
        // not be scaled up to norm one.
        let (scaling, scaled) = match grounds {
            Grounds::WithinTolerance => {
                let (scaled, scaling) = question.uniform(question.s);
                (scaling, Spectrum::of(scaled))
            }
            _ => (scaling, scaled),
        };
        let sigma_r = rank.checked_sub(1).map(|r| scaled.values()[r]);
        Reading {
            rank: RankReading {
                rank,
                status,
                scaling,
                matrix: scaled,
                noise,
                // A nonzero value is the same in double-double, except for the rounding in `f64`.
                separation: sigma_r.map_or(0.0, |sigma_r| CONFIRMED * sigma_r),
                grounds,
            },
            nearness,
            has_tolerance: tolerance.is_some(),
        }
    }
}

/// Returns the status that it is undecided whether the rank is one less. The cause is a change of
/// length `from` (m), or other configurations that could not be examined.
fn open(
    question: &Question<'_>,
    stated: StatedTolerance,
    upper: usize,
    from: Option<f64>,
) -> RankStatus {
    let (one, unit) = if stated.by_angles {
        (question.size, "rad")
    } else {
        (1.0, "m")
    };
    let (lower, tolerance) = (upper - 1, stated.metres / one);
    RankStatus::Undecided(match from {
        Some(from) => Doubt::WithinTolerance {
            lower,
            upper,
            from: from / one,
            tolerance,
            unit,
        },
        None => Doubt::OtherPoses {
            lower,
            upper,
            tolerance,
            unit,
        },
    })
}
