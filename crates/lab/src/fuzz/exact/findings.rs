//! The errors in an answer, and functions that read values from a document.

use serde_json::Value;

use super::expected::Verdict;

/// The severity of a finding, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The scene was rejected, so no answer exists.
    Refused,
    /// The program reports that a result is undecided.
    Undecided,
    /// A dependency or a sentence that is wrong.
    Sentence,
    /// The force or torque of a joint in a dependency is wrong.
    Load,
    /// A wrong verdict.
    Verdict,
    /// A wrong rank, redundancy, or set of independent rows.
    Rank,
    /// The program panicked.
    Panic,
}

impl Kind {
    /// Whether the finding means that an answer is wrong.
    #[must_use]
    pub fn is_wrong(self) -> bool {
        !matches!(self, Self::Refused | Self::Undecided)
    }

    /// Returns a description of the kind.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Refused => "refused",
            Self::Undecided => "undecided",
            Self::Rank => "rank wrong",
            Self::Verdict => "verdict wrong",
            Self::Sentence => "sentence wrong",
            Self::Load => "load wrong",
            Self::Panic => "panic",
        }
    }
}

/// One error or undecided result.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Severity of the finding.
    pub kind: Kind,
    /// The output of the program, and the correct result.
    pub text: String,
}

/// All findings for an answer.
#[derive(Debug, Default)]
pub struct Findings(pub Vec<Finding>);

impl Findings {
    /// Adds one finding.
    pub fn note(&mut self, kind: Kind, text: String) {
        self.0.push(Finding { kind, text });
    }

    /// Compares a number and adds a finding if it is wrong.
    pub(in crate::fuzz) fn number(&mut self, kind: Kind, what: &str, answer: &Value, right: usize) {
        if answer.as_u64() != Some(right as u64) {
            self.note(kind, format!("{what}: answer {answer}, right {right}"));
        }
    }

    /// Compares a verdict and adds a finding if it is wrong.
    pub(in crate::fuzz) fn verdict(
        &mut self,
        what: &str,
        answer: &Value,
        right: impl Into<Verdict>,
    ) {
        let right = match right.into() {
            Verdict::Open => return,
            Verdict::Unique => "unique",
            Verdict::NotUnique => "not_unique",
        };
        match answer.as_str() {
            Some("undecided") => self.note(Kind::Undecided, format!("{what}: undecided")),
            Some(answer) if answer == right => {}
            _ => self.note(
                Kind::Verdict,
                format!("{what}: answer {answer}, right {right}"),
            ),
        }
    }
}

/// Returns the entries of an array.
#[must_use]
pub fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Converts row numbers of the program, which start at 1, to indices from 0.
pub(super) fn rows(value: &Value) -> Vec<usize> {
    let row = |x: &Value| x.as_u64().and_then(|x| x.checked_sub(1));
    list(value)
        .iter()
        .filter_map(row)
        .map(|x| x as usize)
        .collect()
}

/// Returns the largest scalar product of a self-stress wrench and a direction, relative to the
/// lengths of both. Returns `None` if no product is larger than the rounding error.
pub(super) fn share_of_free(
    free: &[Vec<f64>],
    axes: &[usize],
    direction: &[f64],
    rounding: f64,
) -> Option<f64> {
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let shares = free.iter().map(|w| {
        let w: Vec<f64> = axes.iter().map(|&axis| w[axis]).collect();
        let product: f64 = w.iter().zip(direction).map(|(a, b)| a * b).sum();
        match norm(&w) * norm(direction) {
            0.0 => 0.0,
            size => product.abs() / size,
        }
    });
    // Directions are printed with all digits, sentences with four.
    shares.fold(None, |worst: Option<f64>, share| {
        if share <= rounding {
            worst
        } else {
            Some(worst.map_or(share, |worst| worst.max(share)))
        }
    })
}
