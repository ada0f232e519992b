//! The verdict on a joint or drive, with all requested results.

use model::{ConstraintId, Layout, SpaceKind};
use rank::StructureVerdict;
use serde::Serialize;
use solvability::{
    Explanation, FreeDirection, GenericVerdict, GroupSensitivities, GroupVerdict, NoFiniteReaction,
    ReactionVerdict, Sensitivities, Value, Verdict,
};

use super::{ComponentDocument, ValueDocument};
use crate::contacts;
use crate::documents::{SensitivityDocument, VerdictDocument};
use crate::questions::analyze::{about, bounds, frames};

/// The verdict on a joint or drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ReactionDocument {
    /// Name of the joint or drive.
    pub name: String,
    /// Type of the joint or drive in scene files.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// What the joint cannot do: it is one-sided, or grips with a coefficient of friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<String>,
    /// Rows of C that belong to the joint or drive.
    pub rows: Vec<usize>,
    /// Verdict on force and torque together, with ‖B_X‖ as margin.
    #[serde(flatten)]
    pub wrench: VerdictDocument,
    /// The verdict at nearly all configurations. If a motion is run, it is the verdict on the
    /// stretch of the motion that contains the instant. Otherwise it is the verdict at the other
    /// configurations that were compared. `null` if no other configuration could be reached.
    pub generic_verdict: Option<&'static str>,
    /// Sensitivity of the reaction to the data; [`super::AnalysisDocument::add_sensitivities`] adds
    /// it, and the sensitivities of components and directions.
    #[serde(flatten)]
    pub data: SensitivityDocument,
    /// Verdict on all multipliers of the joint or drive together.
    pub multipliers: &'static str,
    /// Verdict on the multiplier of each row.
    pub row_verdicts: Vec<RowDocument>,
    /// Verdicts on the components that are not identically zero, and on the `load` of a coupling.
    pub components: Vec<ComponentDocument>,
    /// Basis of the unique directions, without the directions along which the reaction is zero
    /// under any load. In the plane a direction has these components; in space it has six numbers,
    /// a force and a moment about the reference point. `null` if the number of directions is
    /// undecided.
    pub unique_directions: Option<Vec<Vec<f64>>>,
    /// Sensitivity of the reaction along each of these directions to the data; absent if unknown.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub direction_sensitivities: Vec<SensitivityDocument>,
    /// The largest component, in the unit of margins, that counts as zero within the stated
    /// tolerance for these directions; absent if there is no such component.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unique_directions_within_tolerance: Option<f64>,
    /// Reason why the reaction is unique by the structure of the mechanism alone, without numbers:
    /// `peeled` or `bridge`.
    pub settled: Option<&'static str>,
    /// Explanation if the reaction is not unique.
    pub explanation: Option<String>,
    /// Load of the reaction in each self-stress in which it takes part.
    pub free_directions: Vec<FreeDirectionDocument>,
    /// Verdicts on the reaction in other frames, if requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frames: Vec<frames::FrameDocument>,
    /// Verdicts on the moment of the reaction about another point, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<about::MomentAboutDocument>,
    /// The nearest point (m) about which the moment is unique, if the moment about the reference
    /// point is not unique.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment_unique_about: Option<Vec<f64>>,
    /// Upper bounds of force and moment for joints of any stiffness, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub magnitude_at_most: Option<bounds::MagnitudeDocument>,
    /// Reason why the reaction has no finite value in the motion, whatever its verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_finite_reaction: Option<NoFiniteReaction>,
}

/// The verdict of a multiplier.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RowDocument {
    /// Row of C.
    pub row: usize,
    /// Verdict on the multiplier.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
}

/// Load on a joint in a self-stress, scaled for drawing: the largest force of the self-stress is 1
/// N, or its largest torque is 1 N·m if there is no force.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FreeDirectionDocument {
    /// Index of the self-stress in `dependencies`, from 0.
    pub dependency: usize,
    /// Point at which it acts on the first body (m), with the components of the space.
    pub place: Vec<f64>,
    /// Force on the first body.
    pub force: Vec<f64>,
    /// Torque about the reference point.
    pub torque: TorqueDocument,
}

/// A torque: a number in the plane, in which torques have only one direction.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum TorqueDocument {
    /// The torque T.
    Number(f64),
    /// The torque components Tx, Ty, Tz.
    Vector([f64; 3]),
}

/// Returns the components that a vector has in a space.
pub(crate) fn components(space: SpaceKind, vector: [f64; 3]) -> Vec<f64> {
    vector[..space.n_translations()].to_vec()
}

/// The verdict of a combination of reactions.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct GroupDocument {
    /// Name or expression of the combination.
    pub name: String,
    /// Verdict on the combination.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
    /// Sensitivity to the data: the largest sensitivity of its unique numbers or members.
    #[serde(flatten)]
    pub data: SensitivityDocument,
    /// Verdicts on force and torque of a sum of wrenches.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub components: Vec<ComponentDocument>,
    /// The point (m, global components) about which the torque of a sum of wrenches is taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub about: Option<Vec<f64>>,
    /// Range of the sum of components for joints of any stiffness, if requested.
    #[serde(flatten)]
    pub elastic: bounds::RangeDocument,
    /// The range of the sum over the loads that contacts permit, as for components.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<contacts::PermittedRangeDocument>,
    /// Unit of the sum of components; absent if its terms have different units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// Numbers of the combination with their verdicts (N, N·m): the `sum` of components, or the
    /// force and torque; numbers that are not determined have no value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<ValueDocument>,
}

impl ReactionDocument {
    /// Returns the components to which the numbers of the unique directions belong.
    #[must_use]
    pub fn direction_components(&self) -> Vec<&'static str> {
        let own = self.components.iter().map(|c| c.name);
        let numbers = self.unique_directions.iter().flatten().map(Vec::len).next();
        match numbers {
            Some(n) if n == SpaceKind::Space3.n_v() => SpaceKind::Space3.components().to_vec(),
            numbers => own.take(numbers.unwrap_or(usize::MAX)).collect(),
        }
    }

    /// Returns the names of ill-determined items: the reaction, if it is ill-determined as a whole,
    /// and otherwise its ill-determined components.
    #[must_use]
    pub fn fragile_names(&self) -> Vec<String> {
        if !self.data.fragile {
            return Vec::new();
        }
        let components = self.components.iter().filter(|c| c.data.fragile);
        let named: Vec<String> = components
            .map(|c| format!("{}.{}", self.name, c.name))
            .collect();
        let is_all = |c: &ComponentDocument| c.data.fragile || c.data.sensitivity == Some(0.0);
        let is_whole = self.wrench.verdict == "unique" && self.components.iter().all(is_all);
        // If no component is listed, the named component of the definition is ill-determined.
        if is_whole || named.is_empty() {
            vec![self.name.clone()]
        } else {
            named
        }
    }

    /// Returns the verdict as one line of text; the line states whether the verdict depends on the
    /// last digits or on the tolerance of the scene.
    #[must_use]
    pub fn said(&self) -> String {
        let verdict = self.wrench.verdict.replace('_', " ");
        let within = if self.wrench.within_tolerance {
            " within the tolerance"
        } else {
            ""
        };
        let fragile = match (self.data.fragile, self.wrench.verdict) {
            (false, _) => "",
            (true, "unique") => ", FRAGILE",
            (true, _) => ", unique parts FRAGILE",
        };
        format!("{verdict}{within}{fragile}")
    }

    /// Adds the verdicts that are valid at nearly all configurations.
    pub(super) fn add_generic(&mut self, generic: &GenericVerdict) {
        self.generic_verdict = Some(generic.whole.word());
        for component in &mut self.components {
            component.generic_verdict = Some(generic.component(component.name).map(Verdict::word));
        }
    }

    /// Returns the verdict at this configuration and the generic verdict, by name, if the two
    /// differ. The name is the name of the reaction, or the names of its components.
    #[must_use]
    pub fn differing(&self) -> Vec<(String, [&'static str; 2])> {
        let own = self.components.iter().filter_map(|c| {
            let verdicts = [c.verdict.verdict, c.generic_verdict.flatten()?];
            let name = || format!("{}.{}", self.name, c.name);
            (verdicts[0] != verdicts[1]).then(|| (name(), verdicts))
        });
        let own: Vec<(String, [&'static str; 2])> = own.collect();
        let whole = self.generic_verdict.filter(|generic| {
            let all_differ = own.len() == self.components.len();
            *generic != self.wrench.verdict && all_differ
        });
        match whole {
            Some(generic) if own.iter().all(|(_, words)| words[1] == generic) => {
                vec![(self.name.clone(), [self.wrench.verdict, generic])]
            }
            _ => own,
        }
    }

    /// Returns the nonzero components of the load that the reaction has in a self-stress, by name.
    /// The load acts on the first body.
    pub(crate) fn loads_in(&self, dependency: usize) -> impl Iterator<Item = (String, f64)> + '_ {
        let loads = self.free_directions.iter();
        let loads = loads.filter(move |load| load.dependency == dependency);
        loads.flat_map(move |load| {
            let components = load.components().into_iter();
            components.map(move |(name, value)| (format!("{}.{name}", self.name), value))
        })
    }

    /// Adds the sensitivities of the components and directions of the reaction.
    pub(super) fn add_sensitivities(
        &mut self,
        all: &Sensitivities,
        id: ConstraintId,
        layout: &Layout,
    ) {
        self.data = SensitivityDocument::of(all, id, layout);
        for c in &mut self.components {
            let name = format!("{}.{}", self.name, c.name);
            let found = all.component(id, c.name);
            c.data = SensitivityDocument::of_number(found, &name, layout);
        }
        let name = format!("a direction of {}", self.name);
        let directions = all.each.get(id.0).map(|own| &own.directions);
        let directions = directions.into_iter().flatten();
        self.direction_sensitivities = directions
            .map(|found| SensitivityDocument::of_number(found.as_ref(), &name, layout))
            .collect();
    }

    /// Adds the explanations of all reactions, in the order of joints and drives.
    pub(super) fn explain_all(all: &mut [Self], explanation: &Explanation) {
        for (ConstraintId(k), why) in &explanation.settled {
            all[*k].settled = match why {
                StructureVerdict::Peeled => Some("peeled"),
                StructureVerdict::Bridge => Some("bridge"),
                StructureVerdict::Open(_) => None,
            };
        }
        for told in &explanation.reactions {
            all[told.id.0].explanation = Some(told.text.clone());
        }
        for (dependency, stress) in explanation.stresses.iter().enumerate() {
            for direction in &stress.directions {
                let own = FreeDirectionDocument::new(dependency, direction);
                all[direction.joint.0].free_directions.push(own);
            }
        }
    }
}

impl FreeDirectionDocument {
    /// Returns the components that are not zero, by name.
    fn components(&self) -> Vec<(&'static str, f64)> {
        let (space, torques) = match &self.torque {
            TorqueDocument::Number(torque) => (SpaceKind::Plane, std::slice::from_ref(torque)),
            TorqueDocument::Vector(torque) => (SpaceKind::Space3, torque.as_slice()),
        };
        let values = self.force.iter().chain(torques).copied();
        let named = space.components().iter().copied().zip(values);
        named.filter(|(_, value)| *value != 0.0).collect()
    }

    fn new(dependency: usize, direction: &FreeDirection) -> Self {
        Self {
            dependency,
            place: components(direction.space, direction.place),
            force: components(direction.space, direction.force),
            torque: match direction.space.n_rotations() {
                1 => TorqueDocument::Number(direction.torque[2]),
                _ => TorqueDocument::Vector(direction.torque),
            },
        }
    }
}

impl From<&ReactionVerdict> for ReactionDocument {
    fn from(r: &ReactionVerdict) -> Self {
        let rows = r.rows.iter().map(|row| RowDocument {
            row: row.row + 1,
            verdict: (&row.judgement).into(),
        });
        Self {
            name: r.name.clone(),
            kind: r.kind,
            contact: None,
            rows: r.rows.iter().map(|row| row.row + 1).collect(),
            wrench: (&r.wrench).into(),
            generic_verdict: None,
            data: SensitivityDocument::default(),
            multipliers: r.multipliers.verdict.word(),
            row_verdicts: rows.collect(),
            components: (r.components.iter())
                .map(|component| ComponentDocument {
                    generic_verdict: Some(None),
                    zero: r.zero_components.contains(&component.name),
                    ..component.into()
                })
                .collect(),
            unique_directions: r.live_directions.as_ref().map(|directions| {
                let written = directions.iter().map(|direction| written(r, direction));
                written.collect()
            }),
            direction_sensitivities: Vec::new(),
            unique_directions_within_tolerance: (r.directions_left_out > 0.0)
                .then_some(r.directions_left_out),
            settled: None,
            explanation: None,
            free_directions: Vec::new(),
            frames: Vec::new(),
            moment: None,
            moment_unique_about: None,
            magnitude_at_most: None,
            no_finite_reaction: None,
        }
    }
}

/// Returns a direction of a reaction in its written form. In space, all six components are written.
fn written(r: &ReactionVerdict, direction: &[f64]) -> Vec<f64> {
    if r.space.n_rotations() == 1 {
        return direction.to_vec();
    }
    let mut all = vec![0.0; r.space.n_v()];
    for (component, x) in r.components.iter().zip(direction) {
        if let Some(k) = r.space.component(component.name) {
            all[k] = *x;
        }
    }
    all
}

impl GroupDocument {
    /// Builds the document of the verdict on a group, with its name.
    #[must_use]
    pub fn new(name: &str, verdict: &GroupVerdict) -> Self {
        Self {
            name: name.to_owned(),
            verdict: (&verdict.judgement).into(),
            data: SensitivityDocument::default(),
            components: verdict.components.iter().map(Into::into).collect(),
            about: verdict.about.map(|point| components(verdict.space, point)),
            elastic: bounds::RangeDocument::default(),
            range: None,
            unit: None,
            values: Vec::new(),
        }
    }

    /// Adds the sensitivities of the unique numbers of the group to the data.
    pub fn add_sensitivities(&mut self, found: &GroupSensitivities, layout: &Layout) {
        for ValueDocument { name, value, .. } in &mut self.values {
            let own = name.and_then(|name| found.number(name));
            value.add_sensitivity(own.cloned());
        }
        for c in &mut self.components {
            c.data = SensitivityDocument::of_group_number(found, &self.name, c.name, layout);
        }
        self.data = SensitivityDocument::of_group(found, &self.name, layout);
    }

    /// Adds the numbers of the group.
    #[must_use]
    pub fn with_values(mut self, values: &[(&'static str, Value)]) -> Self {
        self.values = ValueDocument::named(values);
        self
    }
}
