//! Compares the verdicts at an instant with the verdicts of the time intervals that contain the
//! instant.

use model::{Layout, Mechanism, System};

use super::data::Difference;
use super::path::{Path, Sample};
use crate::stretches::{Stretches, worst};
use crate::verdict::{Judgement, Verdict};

/// Lists the verdicts at an instant that differ from the verdicts on the adjacent time intervals.
/// For each reaction, the verdict on all components together comes first, followed by the verdicts
/// on single components. `judged` contains the verdicts on all components, in the order of joints
/// and drives.
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

/// Replaces the special instants of a simulation by the special instants that the samples show. The
/// states of the simulation are less accurate, and near a special instant its verdicts do not
/// differ from those of the samples. If several adjacent samples have verdicts that differ only by
/// rounding, one of these samples is the instant. This sample is the first sample of the motion, or
/// otherwise the sample with the smallest margin.
pub(super) fn look_at_samples<F>(verdicts: &mut Stretches, path: &Path<'_, F>) {
    let samples = &path.samples;
    for (k, track) in verdicts.components_mut().enumerate() {
        let is_special = |place: usize| {
            let here = &samples[place].judged[k].verdict;
            here.word() != track.at(samples[place].t).word()
        };
        let margin = |place: usize| samples[place].judged[k].margin;
        let is_instant = |place: usize| {
            let after = (place + 1 < samples.len()).then_some(place + 1);
            let mut neighbours = place.checked_sub(1).into_iter().chain(after);
            let is_nearer = |other: usize| {
                is_special(other) && (other == 0 || place > 0 && margin(other) < margin(place))
            };
            let Sample { decision, .. } = &samples[place];
            let has_rank = decision.is_decided() && decision.rank == path.rank;
            has_rank && is_special(place) && !neighbours.any(is_nearer)
        };
        let instants = (0..samples.len()).filter(|place| is_instant(*place));
        let instants: Vec<usize> = instants.collect();
        track.forget_special();
        for place in instants {
            let Sample { t, judged, .. } = &samples[place];
            track.look(*t, &judged[k].verdict);
        }
    }
}

fn name_of(layout: &Layout, group: usize) -> String {
    layout.groups[group].name.clone()
}

/// Adds the verdicts at an instant to the verdicts along the motion. The instant is special for
/// verdicts that are decided and differ from the verdict on their interval.
pub(super) fn look(verdicts: &mut Stretches, (time, judged): (f64, &[Judgement])) {
    for (track, here) in verdicts.components_mut().zip(judged) {
        track.look(time, &here.verdict);
    }
}
