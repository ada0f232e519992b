//! Stiff and extreme cases: what is right and what came out, as a document.
//!
//! Not here: the cases, and the judge.

#[cfg(test)]
mod tests;

use report::Provenance;
use serde::Serialize;

/// What is to be thought of one outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Judgement {
    /// An answer within its bound.
    Right,
    /// A refusal that is right and says what is wrong.
    Refused,
    /// A refusal where an answer exists: a limit of the program.
    Limit,
    /// A refusal that is right but does not say what is wrong.
    Misnamed,
    /// An answer that is none, a panic, or nothing at all within the time allowed.
    SilentlyWrong,
}

impl Judgement {
    /// For people.
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

    /// Whether nothing has to be mended.
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
    /// What was varied, and its value here; nothing where cases differ in kind.
    pub varied: Option<(&'static str, f64)>,
    /// Integrator, or what was asked where nothing moves.
    pub method: String,
    /// Treatment of redundancy.
    pub formulation: String,
    /// What is right, in words.
    pub expected: String,
    /// The largest error that is right; NaN where only a refusal is.
    pub bound: f64,
    /// How far the answer is from right; NaN where there is none.
    pub error: f64,
    /// What came out, in words; the whole text of a refusal.
    pub outcome: String,
    /// What is to be thought of it.
    pub judgement: Judgement,
    /// What it took (s).
    pub seconds: f64,
}

/// Cases of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StressFamily {
    /// Its name.
    pub name: &'static str,
    /// What it asks.
    pub about: &'static str,
    /// Its outcomes.
    pub tally: Tally,
    /// Its cases, in their order.
    pub rows: Vec<StressRow>,
}

/// Everything that `lab stress` has found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StressDocument {
    /// How it was made.
    pub provenance: Provenance,
    /// Whether cases are missing, because somebody asked to stop.
    pub partial: bool,
    /// All outcomes.
    pub tally: Tally,
    /// All families.
    pub families: Vec<StressFamily>,
}

/// How many outcomes there are of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Answers within their bounds.
    pub right: usize,
    /// Refusals of all kinds.
    pub refused: usize,
    /// The only unforgivable outcome.
    pub silently_wrong: usize,
    /// Those of all that do not pass.
    pub failing: usize,
}

impl Tally {
    /// Counts.
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

    /// The last line of a summary.
    #[must_use]
    pub fn last_line(&self) -> String {
        format!(
            "right {}, refused by name {}, silently wrong {}",
            self.right, self.refused, self.silently_wrong
        )
    }
}
