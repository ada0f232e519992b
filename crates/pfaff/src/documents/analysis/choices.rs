//! Reactions for several choices. Each number is unique, or it is given together with the choice on
//! which it depends.

use serde::Serialize;
use solvability::{Distribution, Value};

/// The reactions for one choice.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DistributionDocument {
    /// Name of the choice.
    pub label: String,
    /// Reactions of joints and drives in the order of their rows, as loads on the first body at its
    /// reference point.
    pub reactions: Vec<ValuesDocument>,
    /// Requested sums for the same choice.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<ValuesDocument>,
    /// The multiplier of each row.
    pub multipliers: Vec<ValueDocument>,
    /// Conditions of contacts that this choice violates: `JOINT pulls`, `JOINT slips`. The
    /// contacts do not permit these reactions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_permitted: Vec<String>,
    /// Reason why it is not decided whether the contacts permit these reactions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub permission_undecided: Option<String>,
}

/// The reaction of a joint or drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ValuesDocument {
    /// Name of the joint, drive or sum.
    pub name: String,
    /// Components that are not identically zero (N, N·m).
    pub components: Vec<ValueDocument>,
}

/// A number with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ValueDocument {
    /// Name of the component; absent for multipliers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<&'static str>,
    /// The number and its verdict.
    #[serde(flatten)]
    pub value: Value,
    /// For a component of a reaction: `fact` if it is unique, else `choice`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nature: Option<&'static str>,
}

impl DistributionDocument {
    /// The reactions for a choice.
    #[must_use]
    pub fn new(distribution: &Distribution) -> Self {
        let reaction = |r: &solvability::ReactionValues| {
            let component = |(name, value): &(&'static str, Value)| {
                let nature = if value.verdict().is_unique() {
                    "fact"
                } else {
                    "choice"
                };
                ValueDocument::new(Some(name), value, Some(nature))
            };
            ValuesDocument {
                name: r.name.clone(),
                components: r.components.iter().map(component).collect(),
            }
        };
        let multipliers = distribution.multipliers.iter();
        Self {
            label: distribution.label.to_string(),
            reactions: distribution.reactions.iter().map(reaction).collect(),
            groups: Vec::new(),
            multipliers: multipliers
                .map(|value| ValueDocument::new(None, value, None))
                .collect(),
            not_permitted: Vec::new(),
            permission_undecided: None,
        }
    }
}

impl ValuesDocument {
    /// Converts the numbers of a sum with this name.
    #[must_use]
    pub fn of_group(name: &str, values: &[(&'static str, Value)]) -> Self {
        Self {
            name: name.to_owned(),
            components: ValueDocument::named(values),
        }
    }
}

impl ValueDocument {
    pub(super) fn named(values: &[(&'static str, Value)]) -> Vec<Self> {
        let value = |(name, value): &(&'static str, Value)| Self::new(Some(name), value, None);
        values.iter().map(value).collect()
    }

    fn new(name: Option<&'static str>, value: &Value, nature: Option<&'static str>) -> Self {
        Self {
            name,
            value: value.clone(),
            nature,
        }
    }
}
