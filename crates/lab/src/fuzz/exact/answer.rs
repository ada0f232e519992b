//! Computes the answer of `pfaff analyze` for a text, as its document.

use pfaff::documents::DistributionDocument;
use pfaff::documents::MakeUniqueDocument;
use pfaff::model::Registry;
use pfaff::rank::Limits;
use pfaff::solvability::{Choice, DeletableRows, NormWeights, Verdict};
use pfaff::{AssembledScene, ConfigurationAnalysis, RunOptions, StudyError};
use serde_json::Value;

/// Number of reactions for which the test requests the deletions of rows that make the reaction
/// unique.
const ASKED: usize = 2;

/// Limits for the number of sets of rows that are tried.
const LIMITS: Limits = Limits {
    trials: 5_000,
    sets: 1_000,
};

/// Returns the document for the initial state. It is computed as by the command, with reactions of
/// minimum norm and with `--make-unique` for the first reactions that are not unique.
///
/// # Errors
/// Returns the error message if the scene is rejected.
pub fn answer(text: &str) -> Result<Value, String> {
    answer_of(|| AssembledScene::read("scene.toml", text, &Registry::standard()))
}

/// Returns the same document for a scene that `assembled` creates.
///
/// # Errors
/// Returns the error message if the scene is rejected.
pub fn answer_of(
    assembled: impl Fn() -> Result<AssembledScene, StudyError>,
) -> Result<Value, String> {
    match assembled().and_then(|scene| scene.prepare(&RunOptions::default())) {
        Ok(study) => document(study.analyse(0.0, None)),
        Err(e) if e.only_motion().is_some() => match assembled() {
            Ok(mut scene) => document(scene.analyse(None)),
            Err(e) => Err(e.to_string()),
        },
        Err(e) => Err(e.to_string()),
    }
}

fn document(configuration: Result<ConfigurationAnalysis<'_>, StudyError>) -> Result<Value, String> {
    let configuration = configuration.map_err(|e| e.to_string())?;
    let mut document = configuration.document(&[]).map_err(|e| e.to_string())?;
    let reactions = configuration.analysis.reactions.iter();
    let open = reactions.filter(|r| r.wrench.verdict == Verdict::NotUnique);
    document.answers.make_unique = open
        .take(ASKED)
        .map(|r| {
            let found = configuration.make_unique(r.id, &DeletableRows::Sensible, LIMITS);
            MakeUniqueDocument::new(&r.name, &DeletableRows::Sensible, found)
        })
        .collect();
    if configuration.analysis.decision.is_decided() {
        let choice = Choice::MinimumNorm(NormWeights::NEWTON_METRE);
        let chosen = configuration.distribution(&choice);
        let chosen = chosen.iter().map(DistributionDocument::new);
        document.answers.choices = chosen.collect();
    }
    serde_json::to_value(document).map_err(|e| e.to_string())
}
