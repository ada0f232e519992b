//! A case with its right answer. The answer comes from a closed form, exact arithmetic, another
//! derivation or a published value, never from the code that is judged.

use std::fmt::Display;
use std::time::Duration;

/// What is right.
#[derive(Clone, Debug, PartialEq)]
pub enum Expected {
    /// A number for "how far from right" of at most `bound`.
    Answer {
        /// The largest error that is right.
        bound: f64,
        /// Where the right answer and the bound are from.
        source: &'static str,
    },
    /// An error whose text has all these parts.
    Refusal {
        /// Names and words.
        parts: Vec<String>,
    },
    /// Either: a limit that the documentation states.
    AnswerOrRefusal {
        /// The largest error that is right.
        bound: f64,
        /// Where the right answer and the bound are from.
        source: &'static str,
        /// Names and words of the refusal.
        parts: Vec<String>,
    },
}

impl Expected {
    /// An answer off by at most `bound`.
    #[must_use]
    pub fn answer(bound: f64, source: &'static str) -> Self {
        Self::Answer { bound, source }
    }

    /// A refusal that says all this.
    #[must_use]
    pub fn refusal(parts: &[&str]) -> Self {
        Self::Refusal {
            parts: parts.iter().map(|&part| part.to_owned()).collect(),
        }
    }

    /// The largest error that is right; NaN where only a refusal is.
    #[must_use]
    pub fn bound(&self) -> f64 {
        match self {
            Self::Answer { bound, .. } | Self::AnswerOrRefusal { bound, .. } => *bound,
            Self::Refusal { .. } => f64::NAN,
        }
    }

    /// For people.
    #[must_use]
    pub fn words(&self) -> String {
        let named = |parts: &[String]| match parts {
            [] => "a refusal".to_owned(),
            _ => format!("a refusal that says `{}`", parts.join("`, `")),
        };
        match self {
            Self::Answer { bound, source } => format!("off by at most {bound:.1e}: {source}"),
            Self::Refusal { parts } => named(parts),
            Self::AnswerOrRefusal {
                bound,
                source,
                parts,
            } => format!("off by at most {bound:.1e}: {source}; or {}", named(parts)),
        }
    }
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// An answer.
    Answer {
        /// How far from right.
        error: f64,
        /// In words.
        detail: String,
    },
    /// An error, with its text.
    Refused {
        /// The whole text.
        text: String,
    },
}

impl Outcome {
    /// An answer off by `error`.
    #[must_use]
    pub fn answer(error: f64, detail: impl Into<String>) -> Self {
        Self::Answer {
            error,
            detail: detail.into(),
        }
    }

    /// An error.
    #[must_use]
    pub fn refused(error: impl Display) -> Self {
        Self::Refused {
            text: error.to_string(),
        }
    }

    /// An answer that is right or not: error 0, or infinite.
    #[must_use]
    pub fn fact(right: bool, detail: impl Into<String>) -> Self {
        Self::answer(if right { 0.0 } else { f64::INFINITY }, detail)
    }
}

/// What runs a case.
pub type Run = Box<dyn Fn() -> Outcome + Send + Sync>;

/// One case by one method.
pub struct Case {
    /// Its name in its family.
    pub name: String,
    /// The integrator, or the question if nothing moves.
    pub method: String,
    /// Treatment of redundancy; `-` where none is involved.
    pub formulation: String,
    /// What is right.
    pub expected: Expected,
    /// What is varied, with its value here, where cases of a family can be drawn over a number.
    pub varied: Option<(&'static str, f64)>,
    /// Time after which it counts as hanging.
    pub limit: Duration,
    /// Makes it.
    pub run: Run,
}

impl Case {
    /// Time limit where none is given.
    pub const LIMIT: Duration = Duration::from_secs(60);

    /// A case with the usual time limit.
    pub fn new(
        name: impl Into<String>,
        method: impl Into<String>,
        formulation: impl Into<String>,
        expected: Expected,
        run: impl Fn() -> Outcome + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            method: method.into(),
            formulation: formulation.into(),
            expected,
            varied: None,
            limit: Self::LIMIT,
            run: Box::new(run),
        }
    }

    /// The same as a point of a figure: `what` is the name of its axis.
    #[must_use]
    pub fn at(self, what: &'static str, value: f64) -> Self {
        Self {
            varied: Some((what, value)),
            ..self
        }
    }

    /// The same with another time limit.
    #[must_use]
    pub fn within(self, limit: Duration) -> Self {
        Self { limit, ..self }
    }
}

/// Cases of one kind: one page of the matrix.
#[derive(Clone, Copy)]
pub struct Family {
    /// As it is asked for on the command line.
    pub name: &'static str,
    /// What it asks, in one sentence.
    pub about: &'static str,
    /// Makes the cases.
    pub cases: fn() -> Vec<Case>,
}
