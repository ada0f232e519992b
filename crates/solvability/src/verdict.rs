//! Verdicts and the numbers behind them.

use rank::CoefficientReading;

/// Whether a reaction is determined by the model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Verdict {
    /// The same for every solution of the equations.
    Unique,
    /// Free to change without any effect on the motion.
    NotUnique,
    /// The numbers do not decide.
    Undecided {
        /// Why, with the numbers.
        reason: String,
    },
}

impl Verdict {
    /// Its word in results.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Unique => "unique",
            Self::NotUnique => "not_unique",
            Self::Undecided { .. } => "undecided",
        }
    }

    /// Whether it is [`Verdict::Unique`].
    #[must_use]
    pub fn is_unique(&self) -> bool {
        *self == Self::Unique
    }
}

/// A verdict with its margin.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// How far the reaction is from unique, dimensionless: 0 is unique.
    pub margin: f64,
    /// Whether it is unique within the tolerance that the scene states only: rounding of the data
    /// does not explain the margin.
    pub within_tolerance: bool,
}

impl Judgement {
    /// Without a stated tolerance.
    #[must_use]
    pub fn new(verdict: Verdict, margin: f64) -> Self {
        Self {
            verdict,
            margin,
            within_tolerance: false,
        }
    }

    /// Judges a margin as [`rank::RankDecision::read_coefficient`] reads it; what reads as zero
    /// does so within the tolerance of the scene only if it is above the rounding.
    pub(crate) fn of(margin: f64, reading: CoefficientReading, is_above_rounding: bool) -> Self {
        let within_tolerance = is_above_rounding && reading == CoefficientReading::Zero;
        let verdict = match reading {
            CoefficientReading::Zero => Verdict::Unique,
            CoefficientReading::NonZero => Verdict::NotUnique,
            CoefficientReading::Unclear {
                tolerance,
                required,
            } => Verdict::Undecided {
                reason: format!(
                    "margin {margin:.3e}: rounding and uncertainty reach up to {tolerance:.3e}, certainly not zero is {required:.3e}"
                ),
            },
        };
        Self {
            verdict,
            margin,
            within_tolerance,
        }
    }

    /// The judgement of data that are meant exactly: what vanishes has no margin, what does not has
    /// one, however small.
    pub(crate) fn exact(margin: f64, vanishes: bool) -> Self {
        if vanishes {
            Self::new(Verdict::Unique, 0.0)
        } else {
            Self::new(Verdict::NotUnique, margin.max(f64::MIN_POSITIVE))
        }
    }

    /// The judgement where the rank itself is undecided.
    pub(crate) fn without_rank(margin: f64, doubt: &rank::Doubt) -> Self {
        let reason = format!("rank undecided: {doubt}");
        Self::new(Verdict::Undecided { reason }, margin)
    }
}
