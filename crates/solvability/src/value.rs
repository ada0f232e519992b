//! The value of a reaction component together with its verdict.

mod label;
mod no_finite;
mod sensitivity;

use std::fmt;
use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::verdict::Verdict;

pub use label::Label;
pub use no_finite::NoFiniteReaction;
pub(crate) use sensitivity::change_in_words;
pub use sensitivity::{Datum, Sensitivity};

/// The value of a reaction component, a sum or a multiplier, with its verdict and its sensitivity
/// to the data. If the value is not unique, it is stored together with the choice on which it
/// depends, or it is omitted.
///
/// The serialised form is `{ value, verdict, fragile, sensitivity, reason, choice,
/// no_finite_reaction }`. `value` is `null` if there is no number. `choice` is present if and only
/// if the number belongs to a choice. `reason` states why the verdict is undecided, or why a number
/// is missing for a reason other than its verdict.
///
/// ```
/// use pfaff_solvability::{Value, Verdict};
/// let open = Value::new(3.0, Verdict::NotUnique, None);
/// assert_eq!((open.determined(), open.of_choice()), (None, None));
/// assert_eq!(Value::unique(3.0).determined(), Some(3.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    verdict: Verdict,
    number: Number,
    sensitivity: Option<Sensitivity>,
}

/// Stored number, if there is one.
#[derive(Clone, Debug, PartialEq)]
enum Number {
    /// The number is the same in every solution.
    Determined(f64),
    /// The number belongs to one of many solutions.
    Chosen { value: f64, by: Label },
    /// The number is omitted, because it would belong to one of many solutions.
    Open,
    /// The number does not exist for any verdict or choice. The equations have solutions, but the
    /// motion does not have finite reactions, or it is undecided whether they exist.
    NotFinite(Arc<NoFiniteReaction>),
}

impl Value {
    /// Creates a number of a solution. If the number is not unique, `by` is the choice on which it
    /// depends. Without a choice, the number is omitted.
    #[must_use]
    pub fn new(value: f64, verdict: Verdict, by: Option<&Label>) -> Self {
        let number = match (verdict.is_unique(), by) {
            (true, _) => Number::Determined(value),
            (false, Some(by)) => Number::Chosen {
                value,
                by: by.clone(),
            },
            (false, None) => Number::Open,
        };
        Self {
            verdict,
            number,
            sensitivity: None,
        }
    }

    /// Creates a number that is the same in every solution.
    #[must_use]
    pub fn unique(value: f64) -> Self {
        Self::new(value, Verdict::Unique, None)
    }

    /// Creates a value without a number, for every verdict.
    #[must_use]
    pub fn not_finite(verdict: Verdict, why: Arc<NoFiniteReaction>) -> Self {
        Self {
            verdict,
            number: Number::NotFinite(why),
            sensitivity: None,
        }
    }

    /// Adds the sensitivity to data. Only a determined number has a sensitivity.
    pub fn add_sensitivity(&mut self, sensitivity: Option<Sensitivity>) {
        self.sensitivity = sensitivity.filter(|_| self.determined().is_some());
    }

    /// Returns the verdict.
    #[must_use]
    pub fn verdict(&self) -> &Verdict {
        &self.verdict
    }

    /// Returns the number if it is determined.
    #[must_use]
    pub fn determined(&self) -> Option<f64> {
        match self.number {
            Number::Determined(value) => Some(value),
            _ => None,
        }
    }

    /// Returns the number and the choice on which it depends. The result exists only if the number
    /// belongs to one of many solutions.
    #[must_use]
    pub fn of_choice(&self) -> Option<(f64, &Label)> {
        match &self.number {
            Number::Chosen { value, by } => Some((*value, by)),
            _ => None,
        }
    }

    /// Returns the number in the solution to which it belongs. The number may be determined or
    /// chosen.
    #[must_use]
    pub fn in_solution(&self) -> Option<f64> {
        self.determined()
            .or(self.of_choice().map(|(value, _)| value))
    }

    /// Returns the reason why there is no number although the verdict would allow one.
    #[must_use]
    pub fn no_finite_reaction(&self) -> Option<&NoFiniteReaction> {
        match &self.number {
            Number::NotFinite(why) => Some(why),
            _ => None,
        }
    }

    /// Returns the sensitivity of the number to data, if it is known.
    #[must_use]
    pub fn sensitivity(&self) -> Option<&Sensitivity> {
        self.sensitivity.as_ref()
    }

    /// Returns whether a small change of the data changes the number by more than the limit.
    #[must_use]
    pub fn is_fragile(&self) -> bool {
        self.sensitivity
            .as_ref()
            .is_some_and(Sensitivity::is_fragile)
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.number {
            Number::Determined(value) => fmt::Display::fmt(value, f),
            Number::Chosen { value, by } => {
                fmt::Display::fmt(value, f)?;
                write!(f, " ({by})")
            }
            Number::Open => f.write_str(self.verdict.word()),
            Number::NotFinite(why) => fmt::Display::fmt(why, f),
        }
    }
}

impl std::ops::Add for Value {
    type Output = Self;

    /// Returns the sum of numbers of different parts. The sum is unique if both numbers are unique,
    /// and chosen if one of the numbers is chosen. The sensitivity of a sum cannot be computed from
    /// the sensitivities of its terms.
    fn add(self, other: Self) -> Self {
        let verdict = self.verdict.worse(other.verdict);
        let number = match (self.number, other.number) {
            (Number::NotFinite(why), _) | (_, Number::NotFinite(why)) => Number::NotFinite(why),
            (Number::Open, _) | (_, Number::Open) => Number::Open,
            (Number::Determined(a), Number::Determined(b)) => Number::Determined(a + b),
            (Number::Determined(a), Number::Chosen { value, by })
            | (
                Number::Chosen { value, by },
                Number::Determined(a) | Number::Chosen { value: a, .. },
            ) => Number::Chosen {
                value: value + a,
                by,
            },
        };
        Self {
            verdict,
            number,
            sensitivity: None,
        }
    }
}

/// A number with its verdict.
#[derive(Serialize)]
#[cfg_attr(
    feature = "schema",
    derive(schemars::JsonSchema),
    schemars(rename = "Value")
)]
struct Data<'a> {
    /// The number; `null` if there is no number.
    value: Option<f64>,
    /// `unique`, `not_unique` or `undecided`.
    verdict: &'static str,
    /// Whether the number is unique, but sensitive to the data.
    fragile: bool,
    /// Largest relative change for a displacement of one point.
    sensitivity: Option<f64>,
    /// Reason why the verdict is undecided, or why no finite reaction exists.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// The choice on which the number depends.
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<&'a Label>,
    /// Reason why no finite reaction exists.
    #[serde(skip_serializing_if = "Option::is_none")]
    no_finite_reaction: Option<&'a NoFiniteReaction>,
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Value {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        Data::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Data::json_schema(generator)
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let reason = match (&self.number, &self.verdict) {
            (Number::NotFinite(why), _) => Some(why.to_string()),
            (_, Verdict::Undecided { reason }) => Some(reason.clone()),
            _ => None,
        };
        let data = Data {
            value: self.in_solution().filter(|value| value.is_finite()),
            verdict: self.verdict.word(),
            fragile: self.is_fragile(),
            sensitivity: self.sensitivity().map(Sensitivity::stated),
            reason,
            choice: self.of_choice().map(|(_, by)| by),
            no_finite_reaction: self.no_finite_reaction(),
        };
        data.serialize(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn undecided() -> Verdict {
        Verdict::Undecided {
            reason: "rounding".to_owned(),
        }
    }

    fn unreachable() -> Arc<NoFiniteReaction> {
        Arc::new(NoFiniteReaction {
            reactions: Vec::new(),
            rows: Vec::new(),
            freedom: "up".to_owned(),
            loads: vec!["gravity".to_owned()],
            decided: true,
        })
    }

    /// A number without a choice is present if and only if its verdict is unique.
    #[test]
    fn a_number_is_given_with_a_verdict_or_with_a_choice() {
        let by = Label::new("supports");
        for verdict in [Verdict::Unique, Verdict::NotUnique, undecided()] {
            let unique = verdict.is_unique();
            let alone = Value::new(2.0, verdict.clone(), None);
            assert_eq!(alone.determined().is_some(), unique);
            assert_eq!(alone.in_solution().is_some(), unique);
            let chosen = Value::new(2.0, verdict, Some(&by));
            assert_eq!(chosen.in_solution(), Some(2.0));
            assert_eq!(chosen.of_choice().is_some(), !unique);
        }
    }

    /// A sum has the worst verdict of its terms.
    #[test]
    fn a_sum_has_the_worst_verdict_and_the_label_of_a_chosen_term() {
        let by = Label::new("supports");
        let chosen = || Value::new(2.0, Verdict::NotUnique, Some(&by));
        let open = || Value::new(2.0, undecided(), None);
        let none = || Value::not_finite(Verdict::Unique, unreachable());
        let sum = Value::unique(1.0) + chosen();
        assert_eq!(sum.of_choice(), Some((3.0, &by)));
        assert_eq!((chosen() + chosen()).of_choice(), Some((4.0, &by)));
        assert_eq!(
            (Value::unique(1.0) + Value::unique(2.0)).determined(),
            Some(3.0)
        );
        for sum in [chosen() + open(), open() + chosen()] {
            assert_eq!(
                (sum.in_solution(), sum.verdict()),
                (None, &Verdict::NotUnique)
            );
        }
        for sum in [none() + chosen(), open() + none()] {
            assert!(sum.in_solution().is_none() && sum.no_finite_reaction().is_some());
        }
    }
}
