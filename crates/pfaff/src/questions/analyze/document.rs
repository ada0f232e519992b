//! The document of one configuration, with the results that the options request.

use crate::documents::{AnalysisDocument, loads_at};
use crate::documents::{
    DistributionDocument, EliminationsDocument, MakeUniqueDocument, ValuesDocument,
};
use model::System;
use rank::{DeletionError, Limits};
use solvability::{DeletableRows, EliminationError, State, Verdict};

use super::additions::ADDITIONS;
use super::deletions::HINTS;
use super::options::Analyze;
use super::remedies;
use crate::choice;
use crate::configuration::ConfigurationAnalysis;
use crate::contacts::violated;
use crate::error::StudyError;
use crate::question::Control;
use crate::refusal::Refusal;
use crate::start::Start;

/// Number of sets that are tried for a hint without a request.
const HINT_TRIALS: usize = 5_000;

/// Computes all results except those along the motion.
pub(super) fn of(
    asked: &Analyze,
    of: &Start<'_>,
    configuration: &ConfigurationAnalysis<'_>,
    control: &Control<'_>,
) -> Result<AnalysisDocument, Refusal> {
    let failure = |e: StudyError| of.refusal(e);
    let layout = configuration.mechanism.layout();
    // Names are checked first, because that is cheap.
    let allowed = choice::allowed(&asked.allow.0, layout.rows())?;
    let wanted = asked.make_unique.iter();
    let wanted: Result<Vec<_>, _> = wanted.map(|name| configuration.reaction(name)).collect();
    let wanted = wanted.map_err(failure)?;
    let reaction = |name: &str| configuration.reaction(name).map_err(failure);
    let choices = choice::choices(&asked.choose, (layout.space, layout.rows(), &reaction))?;
    for addition in ADDITIONS {
        addition.check(asked, configuration)?;
    }
    let mut document = configuration.document(&asked.combine).map_err(failure)?;
    if let Some(n) = asked.eliminations {
        let sets = configuration.elimination_sets(n);
        document.answers.eliminations = Some(EliminationsDocument::new(
            configuration.eliminations(),
            Some(sets),
        ));
    }
    for (name, id) in asked.make_unique.iter().zip(wanted) {
        let found = configuration.make_unique(id, &allowed, Limits::default());
        document
            .answers
            .make_unique
            .push(MakeUniqueDocument::new(name, &allowed, found));
    }
    for addition in ADDITIONS {
        let added = addition.add(asked, configuration, &mut document);
        added.map_err(failure)?;
    }
    if asked.remedies || control.wants_words {
        remedies::add(asked, of, configuration, &mut document).map_err(failure)?;
    }
    for choice in &choices {
        let distribution = configuration.distribution(choice).map_err(failure)?;
        let mut made = DistributionDocument::new(&distribution);
        let sums = configuration.chosen(&asked.combine, &distribution);
        let sums = document.groups.iter().zip(sums.map_err(failure)?);
        made.groups = sums
            .filter(|(_, values)| !values.is_empty())
            .map(|(group, values)| ValuesDocument::of_group(&group.name, &values))
            .collect();
        match violated(configuration, &distribution) {
            Ok(conditions) => made.not_permitted = conditions,
            Err(why) => made.permission_undecided = Some(why),
        }
        document.answers.choices.push(made);
    }
    if !choices.is_empty() {
        let (time, State { q, v }) = (document.configuration.time, &configuration.state);
        document.answers.loads = loads_at(configuration.mechanism, time, q, v);
    }
    Ok(document)
}

/// Results that only the text contains.
#[derive(Clone, Debug, Default)]
pub(super) struct Hints {
    /// The deletions that would make reactions unique, for reactions that are not unique.
    pub(super) ways: Vec<MakeUniqueDocument>,
    /// Sentences of the optional parts.
    pub(super) sentences: Vec<String>,
}

/// Computes the results that only the text contains.
pub(super) fn hints(
    configuration: &ConfigurationAnalysis<'_>,
    document: &AnalysisDocument,
    control: &Control<'_>,
) -> Result<Hints, Refusal> {
    if !control.wants_words {
        return Ok(Hints::default());
    }
    Ok(Hints {
        ways: ways(configuration, document)?,
        sentences: ADDITIONS
            .iter()
            .filter_map(|addition| addition.sentence(configuration, document))
            .collect(),
    })
}

fn ways(
    configuration: &ConfigurationAnalysis<'_>,
    document: &AnalysisDocument,
) -> Result<Vec<MakeUniqueDocument>, Refusal> {
    let limits = Limits {
        trials: HINT_TRIALS,
        ..Limits::default()
    };
    let reactions = configuration.analysis.reactions.iter();
    // There is no hint to delete a joint if a change of the type of the joint is sufficient.
    let open = reactions
        .filter(|r| r.wrench.verdict == Verdict::NotUnique && !document.has_remedy(&r.name));
    // One additional reaction is computed, to determine whether there are more reactions than the
    // text lists.
    open.take(HINTS + 1)
        .map(
            |r| match configuration.make_unique(r.id, &DeletableRows::Sensible, limits) {
                Err(EliminationError::Deletion(
                    e @ (DeletionError::TargetShape { .. } | DeletionError::NonFinite { .. }),
                )) => Err(Refusal::stopped(e.to_string())),
                found => Ok(MakeUniqueDocument::new(
                    &r.name,
                    &DeletableRows::Sensible,
                    found,
                )),
            },
        )
        .collect()
}
