//! Answers the options of the command line for one configuration.

use pfaff::rank::{DeletionError, Limits};
use pfaff::report::AnalysisDocument;
use pfaff::report::documents::{
    DistributionDocument, EliminationsDocument, MakeUniqueDocument, ValuesDocument,
};
use pfaff::solvability::{Allowed, EliminationError, UnitError, Verdict};
use pfaff::{ConfigurationAnalysis, StudyError};

use super::deletions::HINTS;
use super::point;
use crate::args::Analyze;
use crate::choice;
use crate::input::Source;
use crate::output::Failure;

/// Number of sets that are tried for a hint that the command line did not request.
const HINT_TRIALS: usize = 5_000;

/// All answers except those along the motion.
pub(super) fn document(
    arguments: &Analyze,
    source: &Source,
    configuration: &ConfigurationAnalysis<'_>,
) -> Result<AnalysisDocument, Failure> {
    let failure = |e: StudyError| source.failure(e);
    let layout = pfaff::model::System::layout(configuration.mechanism);
    // Names are checked first, because that is cheap.
    let allowed = choice::allowed(&arguments.allow, layout.rows())?;
    let wanted = arguments.make_unique.iter();
    let wanted: Result<Vec<_>, _> = wanted.map(|name| configuration.reaction(name)).collect();
    let wanted = wanted.map_err(failure)?;
    let reaction = |name: &str| configuration.reaction(name);
    let choices = choice::choices(&arguments.choose, source, (layout.rows(), &reaction))?;
    let about = arguments.about.as_deref();
    let about = about.map(|text| point::point(text, configuration));
    let about = about.transpose()?;
    let mut document = configuration
        .document(&arguments.combine)
        .map_err(failure)?;
    if let Some(n) = arguments.eliminations {
        let sets = configuration.elimination_sets(n);
        document.answers.eliminations = Some(EliminationsDocument::new(
            configuration.eliminations(),
            Some(sets),
        ));
    }
    for (name, id) in arguments.make_unique.iter().zip(wanted) {
        let found = configuration.make_unique(id, &allowed, Limits::default());
        document
            .answers
            .make_unique
            .push(MakeUniqueDocument::new(name, &allowed, found));
    }
    if arguments.frames {
        configuration.add_frames(&mut document).map_err(failure)?;
    }
    if let Some(about) = about {
        let added = configuration.add_moments(&mut document, layout.constraint_ids(), about);
        added.map_err(failure)?;
    }
    if !choices.is_empty() {
        let facts = match configuration.facts() {
            Ok(facts) => facts,
            // The comparison of units uses double precision, the choices use the proved rank.
            Err(StudyError::Units(
                e @ (UnitError::RankChanges { .. } | UnitError::WithinTolerance),
            )) => {
                document.warnings.push(format!(
                    "a change of units does not distinguish facts from choices: {e}"
                ));
                Vec::new()
            }
            Err(e) => return Err(failure(e)),
        };
        for choice in &choices {
            let distribution = configuration.distribution(choice).map_err(failure)?;
            let mut made = DistributionDocument::new(&distribution, &facts);
            let sums = configuration.chosen(&arguments.combine, &distribution);
            let sums = document.groups.iter().zip(sums.map_err(failure)?);
            made.groups = sums
                .filter(|(_, values)| !values.is_empty())
                .map(|(group, values)| ValuesDocument::of_group(&group.name, &values))
                .collect();
            document.answers.choices.push(made);
        }
    }
    Ok(document)
}

/// For each reaction that is not unique, the deletions that would make it unique.
pub(super) fn hints(
    configuration: &ConfigurationAnalysis<'_>,
) -> Result<Vec<MakeUniqueDocument>, Failure> {
    let limits = Limits {
        trials: HINT_TRIALS,
        ..Limits::default()
    };
    let reactions = configuration.analysis.reactions.iter();
    let open = reactions.filter(|r| r.wrench.verdict == Verdict::NotUnique);
    // One more than is listed, to know whether there are more.
    open.take(HINTS + 1)
        .map(
            |r| match configuration.make_unique(r.id, &Allowed::Sensible, limits) {
                Err(EliminationError::Deletion(
                    e @ (DeletionError::TargetShape { .. } | DeletionError::NonFinite { .. }),
                )) => Err(Failure::stopped(e.to_string())),
                found => Ok(MakeUniqueDocument::new(&r.name, &Allowed::Sensible, found)),
            },
        )
        .collect()
}
