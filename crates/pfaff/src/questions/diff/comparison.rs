//! Comparison of two scenes: changes of ranks, verdicts and dependencies, and the distance between
//! the motions. Objects correspond to each other if their names are equal.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use crate::documents::{
    AnalysisDocument, DependencyDocument, ExtremeDocument, LoadPeak, ReactionDocument,
};
use dynamics::{MotionOptions, OutputRequest, Sample};
use model::{FrameState, Mechanism};

use super::answer::{DiffBody, DiffLoad, DiffMotion};
use crate::error::StudyError;
use crate::study::Study;

/// Differences between the verdicts at two starts.
#[derive(Clone, Debug)]
pub(super) struct Comparison<'a> {
    /// Joints and drives that only the first scene has.
    pub(super) removed: Vec<&'a ReactionDocument>,
    /// Joints and drives that only the second scene has.
    pub(super) added: Vec<&'a ReactionDocument>,
    /// Joints and drives whose type, number of rows, contact or verdicts differ, or with a
    /// component that is ill-determined in only one scene; in the order of the first scene.
    pub(super) verdicts: Vec<VerdictChange<'a>>,
    /// Dependencies of the first scene that the second scene does not have.
    pub(super) gone: Vec<&'a DependencyDocument>,
    /// Dependencies of the second scene that the first scene does not have.
    pub(super) new: Vec<&'a DependencyDocument>,
}

/// A joint or drive that both scenes have, with a different type, contact or verdict, or
/// ill-determined in only one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct VerdictChange<'a> {
    /// Name of the joint or drive.
    pub(super) name: &'a str,
    /// The reactions in the first scene and in the second scene.
    pub(super) sides: [&'a ReactionDocument; 2],
}

impl<'a> Comparison<'a> {
    /// Compares the documents of two starts.
    pub(super) fn of(first: &'a AnalysisDocument, second: &'a AnalysisDocument) -> Self {
        let by_name = |document: &'a AnalysisDocument| -> BTreeMap<&'a str, &'a ReactionDocument> {
            let reactions = document.reactions.iter();
            reactions.map(|r| (r.name.as_str(), r)).collect()
        };
        let (in_first, in_second) = (by_name(first), by_name(second));
        let only = |document: &'a AnalysisDocument, other: &BTreeMap<&str, _>| {
            let reactions = document.reactions.iter();
            reactions
                .filter(|r| !other.contains_key(r.name.as_str()))
                .collect()
        };
        let both = first.reactions.iter().filter_map(|a| {
            let b = *in_second.get(a.name.as_str())?;
            Some(VerdictChange {
                name: &a.name,
                sides: [a, b],
            })
        });
        let unmatched = |from: &'a AnalysisDocument, other: &AnalysisDocument| {
            let mut left: Vec<Vec<&str>> = other.reasons.dependencies.iter().map(joints).collect();
            let mut rest = Vec::new();
            for dependency in &from.reasons.dependencies {
                match left.iter().position(|known| *known == joints(dependency)) {
                    Some(at) => drop(left.swap_remove(at)),
                    None => rest.push(dependency),
                }
            }
            rest
        };
        Self {
            removed: only(first, &in_second),
            added: only(second, &in_first),
            verdicts: both.filter(VerdictChange::is_one).collect(),
            gone: unmatched(first, second),
            new: unmatched(second, first),
        }
    }
}

impl VerdictChange<'_> {
    fn is_one(&self) -> bool {
        let [a, b] = self.sides.map(|r| {
            let components = r.components.iter();
            let components = components.map(|c| (c.name, c.verdict.verdict, c.data.fragile));
            let components: Vec<_> = components.collect();
            (
                r.kind,
                &r.contact,
                r.rows.len(),
                r.wrench.verdict,
                r.data.fragile,
                components,
            )
        });
        a != b
    }
}

/// Returns the joints of a dependency, in any order.
fn joints(dependency: &DependencyDocument) -> Vec<&str> {
    let mut names: Vec<&str> = dependency.joints.iter().map(String::as_str).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Number of times at which motions are compared, in addition to the start.
const TIMES: f64 = 200.0;

/// Runs both scenes with their own options and compares 201 states, body by body. Returns `None` if
/// one of the scenes has no `[simulate]`.
///
/// # Errors
/// [`StudyError::Motion`]: one of the motions stopped.
pub(super) fn motions(first: &Study, second: &Study) -> Result<Option<DiffMotion>, StudyError> {
    let (Some(a), Some(b)) = (&first.options, &second.options) else {
        return Ok(None);
    };
    let t_end = a.t_end.min(b.t_end);
    let pairs = common(&first.prepared.mechanism, &second.prepared.mechanism);
    let mut expected: Vec<Vec<FrameState>> = Vec::new();
    let frame = |study: &Study, sample: &Sample<'_, '_>, body: usize| {
        study
            .prepared
            .mechanism
            .frames()
            .body(body, sample.q, sample.v)
    };
    let loads = run(first, a, t_end, |sample| {
        let own = pairs.iter().map(|[i, _]| frame(first, sample, *i));
        expected.push(own.collect());
    })?;
    let names = first.prepared.mechanism.bodies();
    let mut bodies: Vec<DiffBody> = pairs
        .iter()
        .map(|[i, _]| DiffBody {
            body: names[*i].name.clone(),
            ..DiffBody::default()
        })
        .collect();
    let mut row = 0;
    let others = run(second, b, t_end, |sample| {
        let Some(states) = expected.get(row) else {
            return;
        };
        row += 1;
        for ((body, [_, j]), a) in bodies.iter_mut().zip(&pairs).zip(states) {
            let b = frame(second, sample, *j);
            let [distance, angle] = a.apart(&b);
            if distance > body.distance {
                (body.distance, body.t_distance) = (distance, sample.t);
            }
            if angle > body.angle {
                (body.angle, body.t_angle) = (angle, sample.t);
            }
        }
    })?;
    Ok(Some(DiffMotion {
        t_end,
        bodies,
        loads: paired(loads, others),
    }))
}

/// Pairs the loads of two motions by their names. Loads that are zero in both motions are omitted.
fn paired(first: Vec<LoadPeak>, second: Vec<LoadPeak>) -> Vec<DiffLoad> {
    let mut all: Vec<DiffLoad> = Vec::new();
    let mut add = |peak: LoadPeak, is_second: bool| {
        let LoadPeak {
            name,
            load,
            unit,
            peak,
        } = peak;
        let known = all
            .iter()
            .position(|own| (&own.name, &own.load) == (&name, &load));
        let known = known.unwrap_or_else(|| {
            let (a, b) = (None, None);
            all.push(DiffLoad {
                name,
                load,
                unit,
                a,
                b,
            });
            all.len() - 1
        });
        let own = &mut all[known];
        *(if is_second { &mut own.b } else { &mut own.a }) = peak;
    };
    first.into_iter().for_each(|peak| add(peak, false));
    second.into_iter().for_each(|peak| add(peak, true));
    let is_load = |peak: Option<ExtremeDocument>| peak.is_some_and(|peak| peak.value != 0.0);
    all.retain(|own| is_load(own.a) || is_load(own.b));
    all
}

/// Returns the indices of the bodies that both mechanisms have.
fn common(first: &Mechanism, second: &Mechanism) -> Vec<[usize; 2]> {
    let others = second.bodies().iter().enumerate();
    let others: BTreeMap<&str, usize> = others.map(|(j, b)| (b.name.as_str(), j)).collect();
    let bodies = first.bodies().iter().enumerate();
    bodies
        .filter_map(|(i, body)| Some([i, *others.get(body.name.as_str())?]))
        .collect()
}

/// Runs a scene to this time, passes its rows to a function, and returns its peak loads.
fn run(
    study: &Study,
    options: &MotionOptions,
    t_end: f64,
    mut row: impl FnMut(&Sample<'_, '_>),
) -> Result<Vec<LoadPeak>, StudyError> {
    let options = MotionOptions {
        t_end,
        output_step: if t_end > 0.0 {
            t_end / TIMES
        } else {
            options.output_step
        },
        ..options.clone()
    };
    let wanted = OutputRequest::default();
    let ended = study.show(&options, &wanted, &|| false, |sample, _| {
        row(sample);
        ControlFlow::Continue(())
    })?;
    match ended.stopped {
        Some(error) => Err(error.into()),
        None => Ok(LoadPeak::all(&ended.document, &ended.columns)),
    }
}
