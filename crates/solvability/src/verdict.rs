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
    /// The numbers do not decide between the two.
    Undecided {
        /// Reason, with the numbers.
        reason: String,
    },
}

impl Verdict {
    /// The word for the verdict in output files.
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
    /// Distance of the reaction from being unique, dimensionless; 0 for a unique reaction.
    pub margin: f64,
    /// Whether it is unique only within the tolerance that the scene states: rounding of the data
    /// does not explain the margin.
    pub within_tolerance: bool,
}

impl Judgement {
    /// A judgement without a stated tolerance.
    #[must_use]
    pub fn new(verdict: Verdict, margin: f64) -> Self {
        Self {
            verdict,
            margin,
            within_tolerance: false,
        }
    }

    /// Converts a margin classified by [`rank::RankDecision::read_coefficient`]. A margin that
    /// counts as zero counts so within the tolerance of the scene only if it is above the rounding.
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

    /// The judgement for exact data: the margin is zero if the value vanishes, otherwise the given
    /// margin, however small.
    pub(crate) fn exact(margin: f64, vanishes: bool) -> Self {
        if vanishes {
            Self::new(Verdict::Unique, 0.0)
        } else {
            Self::new(Verdict::NotUnique, margin.max(f64::MIN_POSITIVE))
        }
    }

    /// The judgement if the rank itself is undecided.
    pub(crate) fn without_rank(margin: f64, doubt: &rank::Doubt) -> Self {
        let reason = format!("rank undecided: {doubt}");
        Self::new(Verdict::Undecided { reason }, margin)
    }
}
