//! Verdicts and the numbers behind them.

use linalg::CoefficientReading;

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
}

impl Judgement {
    /// Judges a margin as [`linalg::RankDecision::read_coefficient`] reads it.
    pub(crate) fn of(margin: f64, reading: CoefficientReading) -> Self {
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
        Self { verdict, margin }
    }

    /// The judgement of data that are meant exactly: what vanishes has no margin, what does not has one, however small.
    pub(crate) fn exact(margin: f64, vanishes: bool) -> Self {
        if vanishes {
            Self {
                verdict: Verdict::Unique,
                margin: 0.0,
            }
        } else {
            Self {
                verdict: Verdict::NotUnique,
                margin: margin.max(f64::MIN_POSITIVE),
            }
        }
    }

    /// The judgement where the rank itself is undecided.
    pub(crate) fn without_rank(margin: f64, doubt: &linalg::Doubt) -> Self {
        Self {
            verdict: Verdict::Undecided {
                reason: format!("rank undecided: {doubt}"),
            },
            margin,
        }
    }
}
