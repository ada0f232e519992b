//! The sensitivity of a unique number of a reaction to the data.

use model::{ConstraintId, Layout};
use serde::Serialize;
use solvability::{GroupSensitivities, Sensitivities, Sensitivity};

/// How strongly a unique reaction, component, direction, sum or moment depends on the data, and
/// whether it is ill-determined.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SensitivityDocument {
    /// Largest change of the number when one point moves by 1e-4 of the size, or by its tolerance.
    /// The change is relative to the number or to the largest load, whichever is larger, and has
    /// three digits. The value for a reaction is the largest value of its unique components. `null`
    /// if no number is unique, or if not requested.
    pub sensitivity: Option<f64>,
    /// Whether the sensitivity is above 10 %.
    pub fragile: bool,
    /// The datum that changes the number most, as text; absent if the number is not ill-determined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hangs_on: Option<String>,
}

impl SensitivityDocument {
    /// Returns the sensitivity of the joint or drive with this index.
    #[must_use]
    pub fn of(all: &Sensitivities, id: ConstraintId, layout: &Layout) -> Self {
        let text = || all.sentences_of(id, layout).join("; ");
        all.reaction(id)
            .map_or_else(Self::default, |own| Self::with(own, text))
    }

    /// Returns the sensitivity of a number with this name.
    #[must_use]
    pub fn of_number(found: Option<&Sensitivity>, name: &str, layout: &Layout) -> Self {
        found.map_or_else(Self::default, |own| {
            Self::with(own, || own.sentence(name, layout))
        })
    }

    fn with(own: &Sensitivity, text: impl FnOnce() -> String) -> Self {
        let fragile = own.is_fragile();
        Self {
            sensitivity: Some(own.stated()),
            fragile,
            hangs_on: fragile.then(text),
        }
    }

    /// Returns the sensitivity of the group `name`, which is the largest sensitivity of its
    /// components. If the group has several components, the text names the most sensitive
    /// component.
    #[must_use]
    pub fn of_group(found: &GroupSensitivities, name: &str, layout: &Layout) -> Self {
        let whole = found.whole.as_ref();
        let mut numbers = found.numbers.iter();
        match numbers.find(|(_, s)| Some(s) == whole) {
            Some((number, _)) => Self::of_group_number(found, name, number, layout),
            None => Self::of_number(whole, name, layout),
        }
    }

    /// Returns the sensitivity of one component of a group; `number` is the name of the component,
    /// or `sum`.
    #[must_use]
    pub fn of_group_number(
        found: &GroupSensitivities,
        group: &str,
        number: &str,
        layout: &Layout,
    ) -> Self {
        let name = Self::name_in_group(group, number);
        Self::of_number(found.number(number), &name, layout)
    }

    /// Returns the name of a component of a group for use in sentences.
    pub(super) fn name_in_group(group: &str, number: &str) -> String {
        match number {
            "sum" => group.to_owned(),
            component => format!("{group}.{component}"),
        }
    }
}
