//! Contacts that pull although the scene does not describe them as one-sided. There is one warning
//! for a run or a configuration.

use std::fmt;
use std::ops::ControlFlow;

use dynamics::Sample;
use model::codes::Code;
use model::words::{listed, quantity, rounded};
use model::{Mechanism, System};
use report::PeakRecorder;
use scene::{Diagnostic, Scene};
use solvability::{ReactionStretches, Stretches, TwoSidedContacts, VerdictTrack};

use crate::configuration::ConfigurationAnalysis;
use crate::documents::PullDocument;
use crate::peaks_of_run::together;
use crate::rows::{RowFault, RowSink};
use crate::tables_of_run::TableRows;

/// Code of the warning.
const PULLS: Code = Code::new(186);

/// Largest number of joints that the warning names.
const NAMED: usize = 4;

/// Returns the contacts that are examined. Returns `None` if the warning is suppressed.
fn examined(scene: &Scene, mechanism: &Mechanism) -> Option<TwoSidedContacts> {
    let is_silenced = scene.is_silenced(PULLS);
    TwoSidedContacts::of(mechanism).filter(|_| !is_silenced)
}

/// Recorder of the contacts that pull during a run.
pub(crate) struct PullsOfRun<'m> {
    mechanism: &'m Mechanism,
    contacts: TwoSidedContacts,
    /// For each contact, two values: 1 while the contact pulls, and the force with which the
    /// contact pulls (N).
    peaks: PeakRecorder,
    rows: TableRows,
}

impl<'m> PullsOfRun<'m> {
    /// Creates a sink. Returns `None` if there is nothing to examine.
    pub(crate) fn begin(scene: &Scene, mechanism: &'m Mechanism, rows: TableRows) -> Option<Self> {
        let contacts = examined(scene, mechanism)?;
        let cuts = &mechanism.layout().break_times;
        Some(Self {
            peaks: PeakRecorder::new(2 * contacts.joints().len(), cuts),
            mechanism,
            contacts,
            rows,
        })
    }

    /// Returns the contacts that pull, with the values at times at which the force is determined.
    /// The contacts are in the order of time.
    pub(crate) fn found(&self, stretches: Option<&Stretches>) -> Vec<PullDocument> {
        let Some(stretches) = stretches else {
            return Vec::new();
        };
        let groups = &self.mechanism.layout().groups;
        let of = |found: &ReactionStretches| match groups[found.id.0].spec.component {
            Some(name) => found.component(name).cloned(),
            None => {
                let space = self.mechanism.space();
                together(found, &space.components()[space.forces()])
            }
        };
        let joints = self.contacts.joints().iter();
        let tracks = joints.map(|id| of(stretches.reactions.get(id.0)?));
        let tracks: Vec<Option<VerdictTrack>> = tracks.collect();
        let both = tracks.iter().flat_map(|track| [track.as_ref(); 2]);
        let peaks = self
            .peaks
            .finish(&both.collect::<Vec<_>>(), stretches.extent);
        let joints = self.contacts.joints().iter();
        let pairs = joints.zip(peaks.chunks_exact(2));
        let found = pairs.filter_map(|(id, peaks)| {
            let [pulls, force] = peaks else { return None };
            let pulls = pulls
                .as_ref()
                .filter(|p| p.value.determined() == Some(1.0))?;
            let force = force.as_ref()?;
            Some(PullDocument {
                joint: groups[id.0].name.clone(),
                from: pulls.time,
                force: force.value.determined()?,
                time: force.time,
            })
        });
        let mut found: Vec<PullDocument> = found.collect();
        found.sort_by(|a, b| a.from.total_cmp(&b.from));
        found
    }
}

impl RowSink for PullsOfRun<'_> {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        let cuts = sample.events.iter().filter(|event| event.kind.cuts());
        cuts.for_each(|event| self.peaks.cut(event.time));
        if !self.rows.take(sample.t) {
            return Ok(ControlFlow::Continue(()));
        }
        let multipliers = sample.multipliers()?;
        let t = self.mechanism.layout().before_break(sample.t);
        let state = (t, sample.q, sample.v);
        let pulls = (self.contacts).pulls(self.mechanism, state, multipliers.as_chosen());
        let values = pulls.into_iter().flat_map(|pull| {
            let is_pulling = if pull > 0.0 { 1.0 } else { 0.0 };
            [is_pulling, pull]
        });
        self.peaks.row(sample.t, values);
        Ok(ControlFlow::Continue(()))
    }
}

impl ConfigurationAnalysis<'_> {
    /// Returns the contacts that pull at this configuration with a determined force.
    pub(crate) fn pulls(&self) -> Vec<PullDocument> {
        let Some(contacts) = examined(self.scene, self.mechanism) else {
            return Vec::new();
        };
        let Ok(solution) = self.solution() else {
            return Vec::new();
        };
        let t = self.analysis.time;
        let state = (t, &self.state.q[..], &self.state.v[..]);
        let lambda = solution.multipliers.as_chosen();
        let pulls = contacts.pulls(self.mechanism, state, lambda);
        let groups = &self.mechanism.layout().groups;
        let is_unique = |id: model::ConstraintId| {
            let forces = self.mechanism.space().forces();
            let names = &self.mechanism.space().components()[forces];
            let own = groups[id.0].spec.component;
            let mut components = self.analysis.reactions[id.0].components.iter();
            components.all(|c| {
                let counts = own.map_or_else(|| names.contains(&c.name), |own| c.name == own);
                !counts || c.judgement.verdict.is_unique()
            })
        };
        let each = contacts.joints().iter().zip(pulls);
        let pulling = each.filter(|(id, pull)| *pull > 0.0 && is_unique(**id));
        let document = |(id, force): (&model::ConstraintId, f64)| PullDocument {
            joint: groups[id.0].name.clone(),
            from: t,
            force,
            time: t,
        };
        pulling.map(document).collect()
    }
}

/// The times to which pulls refer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PullTimes {
    /// A run.
    Run,
    /// A configuration.
    Instant,
}

/// The warning about contacts that pull.
pub(crate) struct PullWarning<'p> {
    pulls: &'p [PullDocument],
    message: String,
    help: String,
}

impl<'p> PullWarning<'p> {
    /// Creates the warning. Returns `None` if no contact pulls.
    pub(crate) fn new(pulls: &'p [PullDocument], over: PullTimes) -> Option<Self> {
        let [first, others @ ..] = pulls else {
            return None;
        };
        let own = |pull: &PullDocument| {
            let (force, from) = (quantity(pull.force, "N"), rounded(pull.from));
            let joint = match others {
                [] => String::new(),
                _ => format!("`{}` ", pull.joint),
            };
            match over {
                PullTimes::Run => format!("{joint}from t = {from} s on (up to {force})"),
                PullTimes::Instant => format!("{joint}at t = {from} s ({force})"),
            }
        };
        let mut named: Vec<String> = pulls.iter().take(NAMED).map(own).collect();
        if pulls.len() > NAMED {
            named.push(format!("{} more contacts", pulls.len() - NAMED));
        }
        let (joints, pull) = match others {
            [] => (format!("`{}`", first.joint), "pulls "),
            _ => ("contacts".to_owned(), "pull: "),
        };
        Some(Self {
            pulls,
            message: format!("{joints} {pull}{}", listed(&named)),
            help: format!(
                "if a contact only pushes, add `one_sided = \"pushes\"`, and the run stops where it opens; if it can \
                 pull, `silence = [\"{PULLS}\"]` in `[scene]`"
            ),
        })
    }

    /// Returns the introduction of the warning in a text.
    pub(crate) fn lead() -> String {
        format!("warning[{PULLS}]: ")
    }

    /// Returns the warning with the positions of the joints. Returns `None` if the scene has no
    /// text.
    pub(crate) fn located(&self, scene: &Scene) -> Option<Diagnostic> {
        let joints = self.pulls.iter().map(|pull| pull.joint.as_str());
        scene.warning_about(PULLS, joints, (&self.message, &self.help))
    }
}

impl fmt::Display for PullWarning<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.message, self.help)
    }
}
