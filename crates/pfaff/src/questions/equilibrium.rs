//! Where is the static equilibrium of the mechanism?

mod answer;
mod words;

use dynamics::equilibrium::EquilibriumOptions;
use model::System;
use report::{Family, PROVENANCE};
use serde::Deserialize;

use answer::Reactions;
pub use answer::{EquilibriumAnswer, ReactionAtRest, RestingBody};

use crate::configuration::ConfigurationAnalysis;
use crate::error::StudyError;
use crate::question::{Answer, Control, Output, Place, Question, Writing};
use crate::refusal::{Refusal, json};
use crate::run_options::RunOptions;
use crate::start::Start;
use crate::study::Study;
use crate::words::Block;

/// Find a static equilibrium near the start
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("equilibrium/examples.txt")))]
pub struct Equilibrium {
    /// Skip unstable equilibria: perturb and continue
    #[cfg_attr(feature = "command", arg(long))]
    pub stable: bool,
}

/// The scene that starts at the equilibrium.
const SCENE: &str = "at-rest.toml";

/// File name of the document.
const DOCUMENT: &str = "equilibrium.json";

impl Question for Equilibrium {
    const NAME: &'static str = "equilibrium";
    const SCHEMA: &'static str = include_str!("equilibrium/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: Family(&[SCENE, DOCUMENT]),
        contents: "a scene that starts at the equilibrium",
        writing: Writing::AtEnd,
    });
    type Subject<'s> = &'s Start<'s>;
    type Answer = EquilibriumAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<EquilibriumAnswer, Refusal> {
        let study = of.study(control)?;
        let options = EquilibriumOptions {
            stable: self.stable,
        };
        let (found, there) = study.equilibrium(&options).map_err(|e| of.refusal(e))?;
        let rest = there.held_at(found.time);
        let rest = rest
            .analyse(rest.start_time(), None)
            .and_then(|rest| at_rest(&rest));
        let mut answer = EquilibriumAnswer::new(&study, &found, rest.map_err(|e| e.to_string()));
        if control.wants_files {
            let text = study.text_at_rest(&found.q);
            let text = text.map_err(|e| Refusal::input(e.to_string()).coded(e.code()))?;
            // The written scene must start at the configuration that it contains.
            Study::read(SCENE, &text, of.registry, &RunOptions::default()).map_err(|e| {
                Refusal::stopped(format!(
                    "the scene that starts at the equilibrium cannot be read: {e}"
                ))
            })?;
            let head = "equilibrium: `start` contains the positions of the bodies at rest";
            answer.text_at_rest = format!("{PROVENANCE} {head}\n{text}");
            answer.file = Some(SCENE);
        }
        Ok(answer)
    }
}

impl Answer for EquilibriumAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(self)
    }

    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal> {
        place.put(SCENE, self.text_at_rest.as_bytes())?;
        place.put(DOCUMENT, json(self)?.as_bytes())?;
        Ok(())
    }
}

/// Returns the reactions at a configuration.
fn at_rest(of: &ConfigurationAnalysis<'_>) -> Result<Reactions, StudyError> {
    let reactions = ReactionAtRest::all(
        &of.analysis.reactions,
        &of.determined_reactions()?,
        &of.sensitivities()?,
        of.mechanism.layout(),
    );
    Ok((reactions, of.pulls()))
}
