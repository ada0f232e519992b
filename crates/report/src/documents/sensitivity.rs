//! How much a unique reaction hangs on the data.

use model::{ConstraintId, Layout};
use serde::Serialize;
use solvability::Sensitivities;

/// How much a unique reaction hangs on the data, and whether it is made of their last digits.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SensitivityDocument {
    /// Largest change of the reaction when one point moves by 1e-4 of the size, or by its
    /// tolerance, relative to the larger of the reaction and of the largest load, to three digits;
    /// `null` if the reaction is not unique, or if nobody asked.
    pub sensitivity: Option<f64>,
    /// Whether that is above 10 %.
    pub fragile: bool,
    /// What changes it, in words; absent if it is not fragile.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hangs_on: Option<String>,
}

impl SensitivityDocument {
    /// That of the joint or drive of this number.
    #[must_use]
    pub fn of(all: &Sensitivities, id: ConstraintId, layout: &Layout) -> Self {
        let Some(own) = all.each.get(id.0).and_then(Option::as_ref) else {
            return Self::default();
        };
        let fragile = own.is_fragile();
        Self {
            sensitivity: Some(three_digits(own.change)),
            fragile,
            hangs_on: fragile.then(|| own.sentence(&layout.groups[id.0].name, layout)),
        }
    }
}

/// An estimate of the first order has no more.
fn three_digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
