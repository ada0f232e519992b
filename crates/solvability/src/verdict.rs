//! Verdicts and the numbers behind them.

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

/// A margin is certainly not rounding above this multiple of the tolerance, the clearance of rank decisions.
const CLEARANCE: f64 = 1e3;

impl Judgement {
    /// Judges a margin against the rounding noise of margins.
    pub(crate) fn of(margin: f64, tolerance: f64) -> Self {
        let verdict = match margin {
            m if m <= tolerance => Verdict::Unique,
            m if m > CLEARANCE * tolerance => Verdict::NotUnique,
            _ => Verdict::Undecided {
                reason: format!(
                    "margin {margin:.3e} lies between {tolerance:.3e} (rounding) and {:.3e} (certainly not zero)",
                    CLEARANCE * tolerance
                ),
            },
        };
        Self { verdict, margin }
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
