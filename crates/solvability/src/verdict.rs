//! Verdicts and the numbers that justify them.

use model::words::short;
use rank::CoefficientReading;

/// Whether a reaction is determined by the model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Verdict {
    /// The reaction is the same for every solution of the equations.
    Unique,
    /// The reaction can change without any effect on the motion.
    NotUnique,
    /// The numbers are not sufficient to decide between unique and not unique.
    Undecided {
        /// Reason, with the relevant numbers.
        reason: String,
    },
}

impl Verdict {
    /// Returns the word for the verdict in output files.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Unique => "unique",
            Self::NotUnique => "not_unique",
            Self::Undecided { .. } => "undecided",
        }
    }

    /// Returns the rank of a verdict by its severity: unique, undecided, not unique.
    pub(crate) fn severity(&self) -> u8 {
        match self {
            Self::Unique => 0,
            Self::Undecided { .. } => 1,
            Self::NotUnique => 2,
        }
    }

    /// Returns the verdict with the higher severity.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        if other.severity() > self.severity() {
            other
        } else {
            self
        }
    }

    /// Returns whether the verdict is decided.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        !matches!(self, Self::Undecided { .. })
    }

    /// Returns whether the verdict is [`Verdict::Unique`].
    #[must_use]
    pub fn is_unique(&self) -> bool {
        *self == Self::Unique
    }
}

/// A verdict with its margin.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// Distance of the reaction from uniqueness, dimensionless; 0 for a unique reaction.
    pub margin: f64,
    /// Whether the reaction is unique only within the tolerance that the scene states. In this
    /// case, the margin is larger than the rounding of the data.
    pub within_tolerance: bool,
}

impl Judgement {
    /// Creates a judgement without a stated tolerance.
    #[must_use]
    pub fn new(verdict: Verdict, margin: f64) -> Self {
        Self {
            verdict,
            margin,
            within_tolerance: false,
        }
    }

    /// Converts a margin that [`rank::RankDecision::read_coefficient`] has classified. A margin
    /// that counts as zero may be zero only within the tolerance of the scene. The margin is zero
    /// only within the tolerance if it exceeds the rounding.
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
                    "margin {margin}: rounding and uncertainty reach up to {tolerance}, certainly not zero is {required}",
                    margin = short(margin),
                    tolerance = short(tolerance),
                    required = short(required)
                ),
            },
        };
        Self {
            verdict,
            margin,
            within_tolerance,
        }
    }

    /// Returns the judgement for exact data. The margin is zero if the value vanishes. Otherwise it
    /// is the given margin, even if this margin is very small.
    pub(crate) fn exact(margin: f64, vanishes: bool) -> Self {
        if vanishes {
            Self::new(Verdict::Unique, 0.0)
        } else {
            Self::new(Verdict::NotUnique, margin.max(f64::MIN_POSITIVE))
        }
    }

    /// Returns the judgement for an undecided rank.
    pub(crate) fn without_rank(margin: f64, doubt: &rank::Doubt) -> Self {
        let reason = format!("rank undecided: {doubt}");
        Self::new(Verdict::Undecided { reason }, margin)
    }
}

/// Returns the common verdict. The common verdict is not unique if one of the verdicts is not
/// unique, and otherwise undecided if one verdict is undecided. Among equal verdicts, the verdict
/// with the largest margin counts (NaN is the largest margin). Margins of different verdicts cannot
/// be compared, because each margin was compared with its own noise.
pub(crate) fn worst(judgements: impl Iterator<Item = Judgement>) -> Option<Judgement> {
    let severity = |j: &Judgement| j.verdict.severity();
    let mut within_tolerance = false;
    let judgements = judgements.inspect(|j| within_tolerance |= j.within_tolerance);
    let worst = judgements.max_by(|a, b| {
        let margins = a.margin.total_cmp(&b.margin);
        severity(a).cmp(&severity(b)).then(margins)
    })?;
    let within_tolerance = within_tolerance && worst.verdict.is_unique();
    Some(Judgement {
        within_tolerance,
        ..worst
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The noise differs from row to row. A small margin may be certain although a larger margin of
    /// another row is rounding.
    #[test]
    fn one_part_that_is_not_unique_decides_whatever_the_margins() {
        let judged = Judgement::new;
        let unclear = Verdict::Undecided {
            reason: String::new(),
        };
        let parts = [
            judged(Verdict::Unique, 1e-8),
            judged(Verdict::NotUnique, 1e-12),
            judged(unclear, 1e-7),
        ];
        let verdict = |parts: &[Judgement]| worst(parts.iter().cloned()).map(|j| j.verdict);
        assert_eq!(verdict(&parts), Some(Verdict::NotUnique));
        let rest = [parts[2].clone(), parts[0].clone()];
        assert_eq!(verdict(&rest), Some(rest[0].verdict.clone()));
        assert_eq!(verdict(&[]), None);
    }
}
