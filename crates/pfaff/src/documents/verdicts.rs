//! Verdicts of a run: on joints and drives, on their components and on groups, by stretches of
//! time, with the peaks of the determined numbers.

use model::words::rounded;
use model::{ConstraintId, Layout, System};
use serde::Serialize;
use solvability::{
    GroupSensitivities, GroupStretches, ReactionStretches, ReactionVerdict, Sensitivities,
    Sensitivity, Stretches, Value, Verdict, VerdictTrack,
};

use super::{
    ByName, MagnitudeOfRunDocument, RangeOfRunDocument, SensitivityDocument, VerdictDocument,
};
use crate::peaks_of_run::FoundPeaks;
use report::peaks::Peak;
use report::tables::Quantity;

/// The verdict of a number over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TrackDocument {
    /// `unique` if the number is unique on all stretches; `not_unique` if it is not unique on at
    /// least one stretch; otherwise `undecided`.
    pub verdict: &'static str,
    /// Reason why the verdict is undecided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The intervals of time on which the number is determined (s), if it is determined on only
    /// some.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub determined: Vec<[f64; 2]>,
}

impl TrackDocument {
    /// Returns, as text, the intervals on which the number is determined, such as `0 … 1 s`. The
    /// text is empty if there are no such intervals, or if the number is determined throughout.
    #[must_use]
    pub fn on_intervals(&self) -> String {
        let each = self.determined.iter();
        let each = each.map(|[from, to]| format!("{} … {} s", rounded(*from), rounded(*to)));
        each.collect::<Vec<_>>().join(", ")
    }
}

impl From<&VerdictTrack> for TrackDocument {
    fn from(track: &VerdictTrack) -> Self {
        let verdict = track.of_run();
        let determined = match verdict {
            Verdict::Unique => Vec::new(),
            _ => track.determined(),
        };
        Self {
            verdict: verdict.word(),
            reason: match verdict {
                Verdict::Undecided { reason } => Some(reason.clone()),
                _ => None,
            },
            determined,
        }
    }
}

/// The verdict of a joint or drive over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RunReactionDocument {
    /// The verdict over the run; absent if no reactions were requested.
    #[serde(flatten)]
    pub of_run: Option<TrackDocument>,
    /// What the joint cannot do: it is one-sided, or grips with a coefficient of friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<String>,
    /// Sensitivity of the reaction to the data at the start.
    #[serde(flatten)]
    pub data: SensitivityDocument,
    /// The verdict at the start alone.
    pub at_start: VerdictDocument,
    /// Components by name that are not identically zero, and the named component of the definition;
    /// empty if no reactions were requested.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub components: ByName<RunNumberDocument>,
    /// The largest magnitudes over the determined rows of the table; absent if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak: Option<MagnitudePeakDocument>,
    /// Upper bounds of the magnitudes over the run, if bounds were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub magnitude_at_most: Option<MagnitudeOfRunDocument>,
}

impl RunReactionDocument {
    /// Returns the verdict over the run as a word. If no verdict over the run was requested,
    /// returns the verdict at the start.
    #[must_use]
    pub fn verdict(&self) -> &'static str {
        let of_run = self.of_run.as_ref().map(|run| run.verdict);
        of_run.unwrap_or(self.at_start.verdict)
    }
}

/// A component of a reaction, or a number of a group, over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RunNumberDocument {
    /// The verdict over the run.
    #[serde(flatten)]
    pub of_run: TrackDocument,
    /// Sensitivity of the number to the data at the start.
    #[serde(flatten)]
    pub data: SensitivityDocument,
    /// The largest value over the determined cells of the table; absent if there is no such cell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak: Option<PeakDocument>,
    /// The range of the bounds over the run, if bounds were requested and the number is not
    /// determined throughout.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<RangeOfRunDocument>,
}

/// The peak of a number over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PeakDocument {
    /// The value with its sign (N, N·m), and its verdict at that time.
    #[serde(flatten)]
    pub value: Value,
    /// The first time at which the value occurs (s).
    pub time: f64,
    /// The intervals on which the number is determined (s).
    pub over: Vec<[f64; 2]>,
}

/// The peaks of the magnitudes of a reaction over a run. A magnitude is determined if all its
/// components are.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MagnitudePeakDocument {
    /// The largest force (N); `null` if the reaction has no force, or none that is determined.
    pub force: Option<PeakDocument>,
    /// The largest moment about the reference point (N·m); `null` if the reaction has no moment, or
    /// none that is determined.
    pub moment: Option<PeakDocument>,
}

/// The verdict of a group over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RunGroupDocument {
    /// The verdict over the run.
    #[serde(flatten)]
    pub of_run: TrackDocument,
    /// Sensitivity to the data at the start: the largest sensitivity of the numbers of the group.
    #[serde(flatten)]
    pub data: SensitivityDocument,
    /// The components of a sum of wrenches.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub components: ByName<RunNumberDocument>,
    /// The peak of a sum that is a single number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak: Option<PeakDocument>,
    /// The range of the bounds of such a sum over the run, if bounds were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<RangeOfRunDocument>,
}

/// An instant at which a verdict differs from the verdict of its stretch.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SpecialDocument {
    /// Time (s).
    pub time: f64,
    /// Name of the joint, drive or group.
    pub name: String,
    /// Name of the component; absent for a sum that is a single number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<&'static str>,
    /// The verdict at this instant.
    pub verdict: &'static str,
}

/// Verdicts and peaks of the reactions of a run.
#[derive(Clone, Copy)]
pub struct RunVerdicts<'a> {
    /// Verdicts on each stretch of time of the run.
    pub stretches: &'a Stretches,
    /// The groups of the scene by name, and the sensitivities of their numbers to the data at the
    /// start.
    pub groups: &'a [(String, GroupSensitivities)],
    /// Peaks of the determined numbers.
    pub(crate) peaks: &'a FoundPeaks,
}

impl RunVerdicts<'_> {
    fn peak(&self, quantity: Quantity, known: Option<&Sensitivity>) -> Option<PeakDocument> {
        let mut columns = self.peaks.columns.iter();
        let (_, peak) = columns.find(|(column, _)| column.quantity == quantity)?;
        let mut document = PeakDocument::from(peak.as_ref()?);
        document.value.add_sensitivity(known.cloned());
        Some(document)
    }

    /// Returns the peaks of the magnitudes of a joint or drive with this sensitivity.
    fn magnitude(
        &self,
        id: ConstraintId,
        known: Option<&Sensitivity>,
    ) -> Option<MagnitudePeakDocument> {
        let mut all = self.peaks.magnitudes.iter();
        let (_, found) = all.find(|(own, _)| *own == id)?;
        let document = |peak: &Option<Peak>| {
            let mut document = PeakDocument::from(peak.as_ref()?);
            document.value.add_sensitivity(known.cloned());
            Some(document)
        };
        let [force, moment] = found.each_ref().map(document);
        (force.is_some() || moment.is_some()).then_some(MagnitudePeakDocument { force, moment })
    }

    /// Builds the document of a number. The name is used in sentences. If the number is unique only
    /// at the instant of the start, and not on the following stretch, the sensitivity at the start
    /// is omitted.
    fn number(
        &self,
        quantity: Quantity,
        track: &VerdictTrack,
        known: Option<&Sensitivity>,
        (name, layout): (&str, &Layout),
    ) -> RunNumberDocument {
        let known = known.filter(|_| track.at(self.stretches.extent[0]).is_unique());
        RunNumberDocument {
            of_run: track.into(),
            data: SensitivityDocument::of_number(known, name, layout),
            peak: self.peak(quantity, known),
            bounds: None,
        }
    }

    fn components(
        &self,
        found: &ReactionStretches,
        sensitivities: &Sensitivities,
        layout: &Layout,
    ) -> ByName<RunNumberDocument> {
        let owner = &layout.groups[found.id.0].name;
        let own = found.components.iter();
        let own = own.map(|(name, track)| {
            let known = sensitivities.component(found.id, name);
            let quantity = Quantity::Component(found.id, name);
            let full_name = format!("{owner}.{name}");
            let number = self.number(quantity, track, known, (&full_name, layout));
            ((*name).to_owned(), number)
        });
        ByName(own.collect())
    }

    /// Whether a column of the table of reactions contains a number that is not determined.
    pub(super) fn has_choice(&self) -> bool {
        let tracks = self.peaks.columns.iter();
        let mut tracks = tracks.filter_map(|(c, _)| c.quantity.verdicts(self.stretches));
        tracks.any(|track| !track.of_run().is_unique())
    }

    /// Returns the groups by name.
    pub(super) fn groups(&self, layout: &Layout) -> ByName<RunGroupDocument> {
        let all = self.groups.iter().zip(&self.stretches.groups).enumerate();
        let document = |(k, ((name, known), found)): (usize, (&(String, _), _))| {
            (name.clone(), self.group(k, (name, known), found, layout))
        };
        ByName(all.map(document).collect())
    }

    fn group(
        &self,
        k: usize,
        (name, known): (&str, &GroupSensitivities),
        found: &GroupStretches,
        layout: &Layout,
    ) -> RunGroupDocument {
        let numbers = found.numbers.iter().map(|(number, track)| {
            let full_name = SensitivityDocument::name_in_group(name, number);
            let quantity = Quantity::Group(k, number);
            let known = known.number(number);
            let document = self.number(quantity, track, known, (&full_name, layout));
            ((*number).to_owned(), document)
        });
        let numbers: Vec<(String, RunNumberDocument)> = numbers.collect();
        let is_sum = numbers.len() == 1;
        let peak = numbers.first().filter(|_| is_sum);
        RunGroupDocument {
            of_run: (&found.whole).into(),
            data: SensitivityDocument::of_group(known, name, layout),
            peak: peak.and_then(|(_, number)| number.peak.clone()),
            bounds: None,
            components: ByName(if is_sum { Vec::new() } else { numbers }),
        }
    }
}

impl SpecialDocument {
    /// Returns the instants at which a verdict differs from the verdict of its stretch, in the
    /// order of time. The caller gives the names of the groups.
    pub(super) fn all<T>(
        stretches: &Stretches,
        groups: &[(String, T)],
        layout: &Layout,
    ) -> Vec<Self> {
        let mut all = Vec::new();
        let mut add = |owner: &str, component: Option<&'static str>, track: &VerdictTrack| {
            all.extend(track.special().iter().map(|special| Self {
                time: special.time,
                name: owner.to_owned(),
                component,
                verdict: special.verdict.word(),
            }));
        };
        for found in &stretches.reactions {
            let owner = &layout.groups[found.id.0].name;
            for (name, track) in &found.components {
                add(owner, Some(name), track);
            }
        }
        for ((owner, _), found) in groups.iter().zip(&stretches.groups) {
            for (name, track) in &found.numbers {
                add(owner, (*name != "sum").then_some(name), track);
            }
        }
        all.sort_by(|a, b| a.time.total_cmp(&b.time));
        all
    }
}

impl RunReactionDocument {
    /// Builds the verdict of a joint or drive, with the verdict of the run if there is one.
    pub(super) fn new(
        at_start: &ReactionVerdict,
        run: Option<&RunVerdicts<'_>>,
        sensitivities: &Sensitivities,
        mechanism: &model::Mechanism,
    ) -> Self {
        let found = run.and_then(|run| run.stretches.reactions.get(at_start.id.0));
        Self {
            of_run: found.map(|found| (&found.whole).into()),
            contact: mechanism.layout().groups[at_start.id.0].limits.in_words(),
            data: SensitivityDocument::of(sensitivities, at_start.id, mechanism.layout()),
            at_start: (&at_start.wrench).into(),
            components: match (run, found) {
                (Some(run), Some(found)) => {
                    run.components(found, sensitivities, mechanism.layout())
                }
                _ => ByName(Vec::new()),
            },
            peak: run
                .and_then(|run| run.magnitude(at_start.id, sensitivities.reaction(at_start.id))),
            magnitude_at_most: None,
        }
    }
}

impl From<&Peak> for PeakDocument {
    fn from(peak: &Peak) -> Self {
        Self {
            value: peak.value.clone(),
            time: peak.time,
            over: peak.over.clone(),
        }
    }
}
