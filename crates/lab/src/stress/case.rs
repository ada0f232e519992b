//! A case with its known answer. The answer comes from a closed form, exact arithmetic, another
//! derivation or a published value, never from the code under test.

use std::fmt::Display;
use std::time::Duration;

/// The correct outcome of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Expected {
    /// An answer with an error of at most `bound`.
    Answer {
        /// The largest accepted error.
        bound: f64,
        /// The source of the correct answer and of the bound.
        source: &'static str,
    },
    /// An error whose text contains all these parts.
    Refusal {
        /// Names and words in the error text.
        parts: Vec<String>,
    },
    /// An answer or an error, because of a documented limit of the program.
    AnswerOrRefusal {
        /// The largest accepted error.
        bound: f64,
        /// The source of the correct answer and of the bound.
        source: &'static str,
        /// Names and words that the error text must contain.
        parts: Vec<String>,
    },
}

impl Expected {
    /// Creates the expectation of an answer with an error of at most `bound`.
    #[must_use]
    pub fn answer(bound: f64, source: &'static str) -> Self {
        Self::Answer { bound, source }
    }

    /// Creates the expectation of an error that contains all these parts.
    #[must_use]
    pub fn refusal(parts: &[&str]) -> Self {
        Self::Refusal {
            parts: parts.iter().map(|&part| part.to_owned()).collect(),
        }
    }

    /// Returns the largest accepted error; NaN if only an error message is correct.
    #[must_use]
    pub fn bound(&self) -> f64 {
        match self {
            Self::Answer { bound, .. } | Self::AnswerOrRefusal { bound, .. } => *bound,
            Self::Refusal { .. } => f64::NAN,
        }
    }

    /// Describes the expectation as text.
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

/// The outcome of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// An answer.
    Answer {
        /// Error of the answer.
        error: f64,
        /// Description of the answer.
        detail: String,
    },
    /// An error, with its text.
    Refused {
        /// The whole text.
        text: String,
    },
}

impl Outcome {
    /// Creates an answer with this error.
    #[must_use]
    pub fn answer(error: f64, detail: impl Into<String>) -> Self {
        Self::Answer {
            error,
            detail: detail.into(),
        }
    }

    /// Creates an outcome from an error.
    #[must_use]
    pub fn refused(error: impl Display) -> Self {
        Self::Refused {
            text: error.to_string(),
        }
    }

    /// Creates an answer that is either correct or wrong, with an error of 0 or infinity.
    #[must_use]
    pub fn fact(right: bool, detail: impl Into<String>) -> Self {
        Self::answer(if right { 0.0 } else { f64::INFINITY }, detail)
    }
}

/// The function that runs a case.
pub type Run = Box<dyn Fn() -> Outcome + Send + Sync>;

/// One case by one method.
pub struct Case {
    /// Name of the case in its family.
    pub name: String,
    /// The integrator, or the examined question if the case has no integration.
    pub method: String,
    /// Treatment of redundancy; `-` if the case has no treatment of redundancy.
    pub formulation: String,
    /// The correct outcome.
    pub expected: Expected,
    /// The varied quantity and its value in this case, if the cases of a family can be plotted over
    /// a quantity.
    pub varied: Option<(&'static str, f64)>,
    /// Time limit, after which the case counts as an endless loop.
    pub limit: Duration,
    /// Runs the case.
    pub run: Run,
}

impl Case {
    /// Default time limit.
    pub const LIMIT: Duration = Duration::from_secs(60);

    /// Creates a case with the usual time limit.
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

    /// Makes the case a point of a figure; `what` is the name of the horizontal axis.
    #[must_use]
    pub fn at(self, what: &'static str, value: f64) -> Self {
        Self {
            varied: Some((what, value)),
            ..self
        }
    }

    /// Sets another time limit.
    #[must_use]
    pub fn within(self, limit: Duration) -> Self {
        Self { limit, ..self }
    }
}

/// Cases of one kind, which form one section of the report.
#[derive(Clone, Copy)]
pub struct Family {
    /// Name of the family on the command line.
    pub name: &'static str,
    /// The question that the family examines, in one sentence.
    pub about: &'static str,
    /// Creates the cases.
    pub cases: fn() -> Vec<Case>,
}
