//! Verdicts of one configuration, and how they differ from those of another.

use model::{Mechanism, System};

use super::data::{Difference, Part};
use crate::analysis::Analysis;
use crate::judged::ReactionVerdict;
use crate::verdict::Judgement;

/// A verdict of an analysis.
pub(super) struct VerdictOf<'a> {
    /// Name of the joint or drive.
    pub(super) reaction: &'a str,
    pub(super) place: Place,
    pub(super) judgement: &'a Judgement,
    /// Whether it is that of a component which is zero under any load.
    pub(super) is_zero: bool,
}

/// What a verdict is of, as [`Part`], with the number of a row.
#[derive(Clone, Copy)]
pub(super) enum Place {
    Wrench,
    Component(&'static str),
    Row(usize),
}

/// Every verdict of an analysis; those of one mechanism come in the same order whatever they say.
pub(super) fn verdicts<'a>(analysis: &'a Analysis) -> impl Iterator<Item = VerdictOf<'a>> {
    let of_reaction = |r: &'a ReactionVerdict| {
        let components = r.components.iter();
        let components = components.map(|c| (Place::Component(c.name), &c.judgement));
        let rows = r.rows.iter();
        let rows = rows.map(|row| (Place::Row(row.row), &row.judgement));
        std::iter::once((Place::Wrench, &r.wrench))
            .chain(components)
            .chain(rows)
            .map(move |(place, judgement)| VerdictOf {
                reaction: &r.name,
                is_zero: matches!(place, Place::Component(c) if r.zero_components.contains(&c)),
                place,
                judgement,
            })
    };
    analysis.reactions.iter().flat_map(of_reaction)
}

/// Verdicts that are not the same in two analyses of one mechanism. That a component is zero says
/// nothing of what is determined.
pub(super) fn differences(
    mechanism: &Mechanism,
    generic: &Analysis,
    here: &Analysis,
) -> Vec<Difference> {
    let labels = &mechanism.layout().labels;
    let part = |place: Place| match place {
        Place::Wrench => Part::Wrench,
        Place::Component(name) => Part::Component(name),
        Place::Row(row) => Part::Row(labels[row].clone()),
    };
    let word = |v: &VerdictOf<'_>| v.judgement.verdict.word();
    verdicts(generic)
        .zip(verdicts(here))
        .filter(|(a, b)| word(a) != word(b) && !a.is_zero && !b.is_zero)
        .map(|(generic, here)| Difference {
            reaction: generic.reaction.to_owned(),
            part: part(generic.place),
            generic: generic.judgement.verdict.clone(),
            here: here.judgement.verdict.clone(),
        })
        .collect()
}
