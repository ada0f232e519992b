//! Can the scene be read and assembled?

mod answer;

use crate::documents::{DataDocument, SensitivityDocument};
use model::System;
use serde::Deserialize;

pub use answer::CheckAnswer;

use crate::configuration::{ConfigurationAnalysis, requests};
use crate::elasticity::elasticity;
use crate::error::StudyError;
use crate::plots;
use crate::pulls::{PullTimes, PullWarning};
use crate::question::{Control, Question};
use crate::refusal::Refusal;
use crate::start::{JudgedStart, Start};

/// Read and assemble the scene; report all errors
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("check/examples.txt")))]
pub struct Check {}

/// Largest number of ill-determined reactions with a separate warning.
const FRAGILE_TOLD: usize = 10;

impl Question for Check {
    const NAME: &'static str = "check";
    const SCHEMA: &'static str = include_str!("check/answer.schema.json");
    type Subject<'s> = &'s Start<'s>;
    type Answer = CheckAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<CheckAnswer, Refusal> {
        let judged = of.judged(control)?;
        let (scene, mechanism) = judged.parts();
        if let Some(wanted) = &scene.output.bounds {
            let reaction =
                |name: &str| requests::reaction(scene, mechanism, name).map_err(|e| of.refusal(e));
            elasticity(wanted, mechanism.layout(), &reaction)?;
        }
        plots::check(scene, mechanism).map_err(|e| of.refusal(e))?;
        let answered = match judged.as_ref() {
            JudgedStart::Moves(study) => study.check_drives().and_then(|()| {
                let start = of.configuration(&judged, judged.start_time(), control, |_| ())?;
                let prepared = &study.prepared;
                let answer = CheckAnswer::new(judged.parts(), &prepared.assembly.correction);
                let mut answer = answer.moving(start.freedoms()?, &prepared.mechanism);
                answer.start_velocity_correction =
                    Some(answer::largest(&prepared.velocity_correction));
                let hanging = fragile(&start)?;
                let more = hanging.len().saturating_sub(FRAGILE_TOLD);
                let warnings = &mut answer.warnings;
                warnings.extend(hanging.into_iter().take(FRAGILE_TOLD));
                let data = DataDocument::new(&start.analysis);
                warnings.extend(data.warning(start.analysis.mobility()));
                warnings.extend(study.cannot_begin());
                if more > 0 {
                    warnings.push(
                        "more reactions are unique but fragile: `pfaff analyze` names all"
                            .to_owned(),
                    );
                }
                let pulls = start.pulls();
                if let Some(warning) = PullWarning::new(&pulls, PullTimes::Instant) {
                    answer = answer.warned(warning.located(scene), &warning);
                }
                Ok(answer)
            }),
            // The error concerns the motion only, so the start can still be analysed.
            JudgedStart::Stands(stands) => {
                let mechanism = &stands.assembled.mechanism;
                let (described, _) = mechanism.described_state();
                let correction = mechanism.difference_of(&stands.kept.state.q, &described);
                let mut answer = CheckAnswer::new(judged.parts(), &correction);
                answer.warnings.push(stands.warning.clone());
                Ok(answer)
            }
        };
        answered.map_err(|e| of.refusal(e))
    }
}

/// Returns sentences about ill-determined reactions, then about ill-determined sums.
fn fragile(start: &ConfigurationAnalysis<'_>) -> Result<Vec<String>, StudyError> {
    let layout = start.mechanism.layout();
    let reactions = start.sensitivities()?;
    let mut sentences = reactions.sentences(layout);
    for (name, found) in start.group_sensitivities(&reactions)? {
        // Separate reactions have separate sentences.
        if !found.numbers.is_empty() {
            sentences.extend(SensitivityDocument::of_group(&found, &name, layout).hangs_on);
        }
    }
    Ok(sentences)
}
