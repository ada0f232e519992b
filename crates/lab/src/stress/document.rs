//! Expected and actual outcomes of stiff and extreme cases, as a document.
//!
//! The cases and their judgement are not part of this module.

#[cfg(test)]
mod tests;

use report::Provenance;
use serde::Serialize;

/// The judgement of one outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Judgement {
    /// An answer within its bound.
    Right,
    /// A correct error message that names the fault.
    Refused,
    /// An error message although an answer exists. This is a limit of the program.
    Limit,
    /// A correct error message that does not name the fault.
    Misnamed,
    /// A wrong answer, a panic, or no result within the time limit.
    SilentlyWrong,
}

impl Judgement {
    /// Returns the judgement as text.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Refused => "refused by name",
            Self::Limit => "refused, though there is an answer",
            Self::Misnamed => "refused, without saying what is wrong",
            Self::SilentlyWrong => "silently wrong",
        }
    }

    /// Whether the outcome needs no correction of the program.
    #[must_use]
    pub fn passes(self) -> bool {
        matches!(self, Self::Right | Self::Refused)
    }
}

/// One case by one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StressRow {
    /// The family of the case.
    pub family: &'static str,
    /// The case.
    pub case: String,
    /// The quantity that was varied, and its value in this case; `None` if no quantity is varied.
    pub varied: Option<(&'static str, f64)>,
    /// Integrator, or the examined question if the case has no integration.
    pub method: String,
    /// Treatment of redundancy.
    pub formulation: String,
    /// The correct outcome, in words.
    pub expected: String,
    /// The largest accepted error; NaN if only an error message is correct.
    pub bound: f64,
    /// The error of the answer; NaN if there is no answer.
    pub error: f64,
    /// The outcome as text; the whole text of an error message.
    pub outcome: String,
    /// The judgement.
    pub judgement: Judgement,
    /// The run time (s).
    pub seconds: f64,
}

/// Cases of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StressFamily {
    /// Name of the family.
    pub name: &'static str,
    /// The question that the family examines.
    pub about: &'static str,
    /// Outcomes of the family.
    pub tally: Tally,
    /// Cases of the family, in their order.
    pub rows: Vec<StressRow>,
}

/// All results of `lab stress`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StressDocument {
    /// Provenance of the results.
    pub provenance: Provenance,
    /// Whether cases are missing because a stop was requested.
    pub partial: bool,
    /// All outcomes.
    pub tally: Tally,
    /// All families.
    pub families: Vec<StressFamily>,
}

/// Number of outcomes of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Answers within their bounds.
    pub right: usize,
    /// Error messages of all kinds.
    pub refused: usize,
    /// Outcomes that are wrong without an error message.
    pub silently_wrong: usize,
    /// Number of outcomes that do not pass.
    pub failing: usize,
}

impl Tally {
    /// Counts the outcomes.
    ///
    /// ```
    /// use lab::stress::{Judgement, Tally};
    ///
    /// let tally = Tally::of([Judgement::Right, Judgement::Refused, Judgement::Limit]);
    /// assert_eq!(tally.last_line(), "right 1, refused by name 2, silently wrong 0");
    /// assert_eq!(tally.failing, 1);
    /// ```
    #[must_use]
    pub fn of(judgements: impl IntoIterator<Item = Judgement>) -> Self {
        let mut tally = Self::default();
        for judgement in judgements {
            match judgement {
                Judgement::Right => tally.right += 1,
                Judgement::Refused | Judgement::Limit | Judgement::Misnamed => tally.refused += 1,
                Judgement::SilentlyWrong => tally.silently_wrong += 1,
            }
            tally.failing += usize::from(!judgement.passes());
        }
        tally
    }

    /// Returns the last line of a summary.
    #[must_use]
    pub fn last_line(&self) -> String {
        format!(
            "right {}, refused by name {}, silently wrong {}",
            self.right, self.refused, self.silently_wrong
        )
    }
}
