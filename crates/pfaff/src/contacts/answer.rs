//! Documents of the loads that contacts permit.

use model::{ConstraintId, Layout};
use report::ByName;
use serde::Serialize;
use solvability::{
    ConditionKind, ContactCondition, GripVerdict, Holds, PermittedEnd, PermittedRange,
};

/// The range of a number over the loads that the contacts permit.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PermittedRangeDocument {
    /// `point` (one value, unique by the signs of the forces), `interval`, `half_line`, `line`, or
    /// `empty` if the contacts cannot all stay closed.
    pub kind: &'static str,
    /// The lowest value (N, N·m); `null` if there is none.
    pub lowest: Option<f64>,
    /// The highest value (N, N·m); `null` if there is none.
    pub highest: Option<f64>,
    /// The proof of both ends; absent for an empty range.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<[CertificateDocument; 2]>,
}

/// The proof of an end of a range. A finite end has conditions: for every permitted sharing, the
/// distance of the number from the end is the sum of their margins (N), multiplied by their
/// weights. An end without limit has a preload.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CertificateDocument {
    /// The conditions that limit the number.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub conditions: Vec<ConditionDocument>,
    /// The forces with which one-sided joints press in a sharing that reaches the end (N).
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub pressing: ByName<f64>,
    /// Changes of components (N, N·m) without an external load, which the contacts permit in any
    /// multiple, and which change the number by 1.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub preload: ByName<f64>,
}

/// A condition of a contact, with its weight.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConditionDocument {
    /// The joint.
    pub joint: String,
    /// `presses`: the joint stays closed. `grips`: the contact does not slip.
    pub condition: &'static str,
    /// The weight, > 0.
    pub weight: f64,
}

/// What contacts do that only push or pull, or that grip.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ContactsDocument {
    /// The one-sided joints that open, if they cannot all stay closed: those whose gaps accelerate
    /// by Gauss' principle.
    pub lifts: Vec<String>,
    /// The accelerations of these gaps (m/s²).
    pub gap_accelerations: ByName<f64>,
    /// The motion along which the loads do work, if the one-sided joints cannot all stay closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tips: Option<String>,
    /// The proof that no sharing of the loads is permitted: in every solution, the weighted sum of
    /// the margins of these conditions is negative. The weights of one-sided joints are the
    /// relative rates at which their gaps open in the motion.
    pub impossible: Vec<ConditionDocument>,
    /// Contacts that grip and depend on each other.
    pub grips: Vec<GripDocument>,
    /// Reactions without a range, with the reason.
    pub without: ByName<String>,
    /// Reason why there are no ranges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// The verdict on contacts that grip and depend on each other.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct GripDocument {
    /// The joints.
    pub joints: Vec<String>,
    /// `always`: no sharing of the loads makes a contact slip. `sometimes`: some sharing makes none
    /// slip, others do. `never`: every sharing makes a contact slip. `undecided`: the friction is
    /// within the accuracy of the answer. `null` if one-sided joints cannot all stay closed.
    pub holds: Option<&'static str>,
    /// Bounds of the least coefficient of friction, equal for all joints, with which some sharing
    /// of the loads makes no contact slip; `null` if no coefficient is large enough.
    pub least_grip: Option<[f64; 2]>,
}

impl PermittedRangeDocument {
    /// Builds the document of a range.
    pub(super) fn new(range: &PermittedRange, layout: &Layout) -> Self {
        let [lowest, highest] = match &range.ends {
            Some([lowest, highest]) => [Some(lowest), Some(highest)],
            None => [None; 2],
        };
        let name = |id: &ConstraintId| layout.groups[id.0].name.clone();
        let certificate = |end: &PermittedEnd| match end {
            PermittedEnd::Reached {
                weights, pressing, ..
            } => CertificateDocument {
                conditions: documents(weights, layout),
                pressing: ByName(pressing.iter().map(|(id, n)| (name(id), *n)).collect()),
                preload: ByName(Vec::new()),
            },
            PermittedEnd::Unlimited { preload } => {
                let change = |(id, component, x): &(ConstraintId, &str, f64)| {
                    (format!("{}.{component}", name(id)), *x)
                };
                CertificateDocument {
                    preload: ByName(preload.iter().map(change).collect()),
                    ..CertificateDocument::default()
                }
            }
        };
        Self {
            kind: range.kind.word(),
            lowest: lowest.and_then(PermittedEnd::value),
            highest: highest.and_then(PermittedEnd::value),
            certificate: range
                .ends
                .as_ref()
                .map(|ends| ends.each_ref().map(certificate)),
        }
    }
}

/// Builds the documents of conditions with their weights.
pub(super) fn documents(
    weights: &[(ContactCondition, f64)],
    layout: &Layout,
) -> Vec<ConditionDocument> {
    let document = |(condition, weight): &(ContactCondition, f64)| ConditionDocument {
        joint: layout.groups[condition.joint.0].name.clone(),
        condition: match condition.kind {
            ConditionKind::Presses => "presses",
            ConditionKind::Grips => "grips",
        },
        weight: *weight,
    };
    weights.iter().map(document).collect()
}

impl GripDocument {
    /// Builds the document of a verdict.
    pub(super) fn new(verdict: &GripVerdict, layout: &Layout) -> Self {
        let joints = verdict.joints.iter();
        Self {
            joints: joints.map(|id| layout.groups[id.0].name.clone()).collect(),
            holds: verdict.holds.map(Holds::word),
            least_grip: verdict.least,
        }
    }
}
