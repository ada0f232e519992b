//! What differs between two scenes?

mod answer;
mod comparison;
mod words;

use serde::Deserialize;

pub use answer::{DiffAnswer, DiffBody, DiffChange, DiffLoad, DiffMotion, DiffReaction, DiffSide};

use crate::question::{Answer, Control, Question};
use crate::refusal::Refusal;
use crate::start::{JudgedStart, Start, document_of};
use crate::words::Block;

/// Compare ranks, verdicts, dependencies and motion of two scenes
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("diff/examples.txt")))]
pub struct Diff {}

impl Question for Diff {
    const NAME: &'static str = "diff";
    const SCHEMA: &'static str = include_str!("diff/answer.schema.json");
    type Subject<'s> = [&'s Start<'s>; 2];
    type Answer = DiffAnswer;

    fn answer(&self, of: [&Start<'_>; 2], control: &Control<'_>) -> Result<DiffAnswer, Refusal> {
        let judged = [of[0].judged(control)?, of[1].judged(control)?];
        let document = |k: usize| {
            let start = of[k].configuration(&judged[k], judged[k].start_time(), control, |_| ());
            let document = start.and_then(|start| document_of(&start));
            document.map_err(|e| of[k].refusal(e))
        };
        let documents = [document(0)?, document(1)?];
        let names = [0, 1].map(|k| of[k].name.as_str());
        let motion = motion(names, [&judged[0], &judged[1]]);
        Ok(DiffAnswer::new(names, &documents, motion))
    }
}

impl Answer for DiffAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(self)
    }
}

/// Compares the motions, or returns the reason why they are not compared.
fn motion(names: [&str; 2], judged: [&JudgedStart; 2]) -> Result<DiffMotion, String> {
    for (name, judged) in names.iter().zip(judged) {
        if judged.parts().0.simulate.is_none() {
            return Err(format!("`{name}` has no [simulate]"));
        }
    }
    let study = |k: usize| {
        let refused =
            |e: Refusal| format!("`{}` cannot be moved: {}", names[k], e.document().error);
        judged[k].study().map_err(refused)
    };
    match comparison::motions(study(0)?, study(1)?) {
        Ok(Some(motion)) => Ok(motion),
        Ok(None) => Err("one of the scenes has no [simulate]".to_owned()),
        Err(e) => Err(format!("one of them stopped: {e}")),
    }
}
