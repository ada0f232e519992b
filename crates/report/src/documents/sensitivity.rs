//! How strongly a unique reaction depends on the data.

use model::{ConstraintId, Layout};
use serde::Serialize;
use solvability::Sensitivities;

/// How strongly a unique reaction depends on the data, and whether it is fragile.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SensitivityDocument {
    /// Largest change of the reaction when one point moves by 1e-4 of the size, or by its
    /// tolerance, relative to the larger of the reaction and of the largest load, to three digits;
    /// `null` if the reaction is not unique, or if not requested.
    pub sensitivity: Option<f64>,
    /// Whether the change is above 10 %.
    pub fragile: bool,
    /// The datum that changes it most, as text; absent if it is not fragile.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hangs_on: Option<String>,
}

impl SensitivityDocument {
    /// The sensitivity of the joint or drive with this number.
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

/// An estimate of first order has no more accurate digits.
fn three_digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
