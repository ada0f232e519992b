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
    /// Whether the verdict belongs to a component that is zero under any load.
    pub(super) is_zero: bool,
}

/// The part of a reaction that a verdict belongs to: like [`Part`], with the number of a row.
#[derive(Clone, Copy)]
pub(super) enum Place {
    Wrench,
    Component(&'static str),
    Row(usize),
}

/// Iterates over all verdicts of an analysis. Analyses of the same mechanism give them in the same
/// order, whatever the verdicts are.
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

/// Lists the verdicts that differ between two analyses of one mechanism. Whether a component is
/// identically zero is not compared: it does not say whether the reaction is determined.
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
