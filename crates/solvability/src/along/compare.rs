//! The verdicts of an instant, compared with those of the stretches that contain it.

use model::{Layout, Mechanism, System};

use super::data::Difference;
use super::path::Sample;
use crate::stretches::{Stretches, worst};
use crate::verdict::{Judgement, Verdict};

/// Lists the verdicts at an instant that differ from those of its stretches: of each reaction as a
/// whole, then of its components. `judged` has those on all components, in the order of joints and
/// drives.
pub(super) fn differences(
    mechanism: &Mechanism,
    verdicts: &Stretches,
    (time, judged): (f64, &[Judgement]),
) -> Vec<Difference> {
    let mut found = Vec::new();
    let mut judged = judged.iter().map(|j| &j.verdict);
    for reaction in &verdicts.reactions {
        let own: Vec<&Verdict> = judged.by_ref().take(reaction.components.len()).collect();
        let tracks = reaction.components.iter().zip(&own);
        let components = tracks.map(|((name, track), here)| (Some(*name), track.at(time), *here));
        let whole = (None, reaction.whole.at(time), worst(own.iter().copied()));
        let all = std::iter::once(whole).chain(components);
        let differing = all.filter(|(_, generic, here)| generic.word() != here.word());
        found.extend(differing.map(|(component, generic, here)| Difference {
            reaction: name_of(mechanism.layout(), reaction.id.0),
            component,
            generic: generic.clone(),
            here: here.clone(),
        }));
    }
    found
}

/// Leaves out special instants of a run at which the verdicts of the motion itself are others: the
/// states of a run are less accurate, and near such an instant they do not differ from it.
pub(super) fn confirm(verdicts: &mut Stretches, samples: &[Sample]) {
    for (k, track) in verdicts.components_mut().enumerate() {
        track.confirm(|special| {
            let place = samples.binary_search_by(|s| s.t.total_cmp(&special.time));
            let here = place.map(|place| samples[place].judged[k].verdict.word());
            here.is_ok_and(|word| word == special.verdict.word())
        });
    }
}

fn name_of(layout: &Layout, group: usize) -> String {
    layout.groups[group].name.clone()
}

/// Adds decided verdicts at an instant to those along the motion: where they differ from their
/// stretch they are special.
pub(super) fn look(verdicts: &mut Stretches, (time, judged): (f64, &[Judgement])) {
    for (track, here) in verdicts.components_mut().zip(judged) {
        if here.verdict.is_decided() {
            track.look(time, &here.verdict);
        }
    }
}
