//! The verdict on a component of a reaction.

use model::Layout;
use serde::Serialize;
use solvability::{ComponentVerdict, Sensitivity};

use crate::contacts;
use crate::documents::{SensitivityDocument, VerdictDocument};
use crate::questions::analyze::bounds;

/// The verdict of a component of a reaction or of a sum.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ComponentDocument {
    /// `Fx`, `Fy` or `T`; in space `Fx` to `Tz`; or the named component of a definition.
    pub name: &'static str,
    /// Verdict on the component.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
    /// Whether the component is zero at this configuration under any load. It is then unique.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub zero: bool,
    /// The verdict at nearly all configurations, as for the reaction; absent for components in
    /// other frames, components of moments and components of sums.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub generic_verdict: Option<Option<&'static str>>,
    /// Range of the component for joints of any stiffness, if requested.
    #[serde(flatten)]
    pub elastic: bounds::RangeDocument,
    /// The range of the component over the loads that contacts permit, if it is not unique and the
    /// scene has one-sided joints or grip.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<contacts::PermittedRangeDocument>,
    /// Sensitivity of the component to the data, if it is unique.
    #[serde(flatten)]
    pub data: SensitivityDocument,
}

impl ComponentDocument {
    /// Adds the sensitivities of unique components. The sensitivities are given with the names of
    /// the reactions.
    pub(crate) fn add_sensitivities<'d>(
        all: impl Iterator<Item = (&'d String, &'d mut Self)>,
        found: Vec<Option<Sensitivity>>,
        layout: &Layout,
    ) {
        let unique = all.filter(|(_, c)| c.verdict.verdict == "unique");
        for ((reaction, c), found) in unique.zip(found) {
            let name = format!("{reaction}.{}", c.name);
            c.data = SensitivityDocument::of_number(found.as_ref(), &name, layout);
        }
    }
}

impl From<&ComponentVerdict> for ComponentDocument {
    fn from(component: &ComponentVerdict) -> Self {
        Self {
            name: component.name,
            verdict: (&component.judgement).into(),
            zero: false,
            generic_verdict: None,
            elastic: bounds::RangeDocument::default(),
            range: None,
            data: SensitivityDocument::default(),
        }
    }
}
