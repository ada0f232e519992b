//! Which results does a run compute and which does it omit, and why?

mod answer;
mod words;

use serde::Deserialize;

pub use answer::{PlanAnswer, PlannedComponent, PlannedDecision, PlannedSaving};

use crate::question::{Answer, Control, Question};
use crate::refusal::Refusal;
use crate::run_options::RunOptions;
use crate::start::Start;
use crate::sweep::{Axis, Sweep, SweepError};
use crate::words::Block;

/// Report what a run computes and omits, with reasons
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("plan/examples.txt")))]
pub struct Plan {
    /// Also report how a sweep with these values evaluates its runs
    #[cfg_attr(feature = "command", arg(long, value_name = "KEY=VALUES"))]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<String>"))]
    pub vary: Vec<Axis>,
    /// The run
    #[cfg_attr(feature = "command", command(flatten))]
    pub run: RunOptions,
}

impl Question for Plan {
    const NAME: &'static str = "plan";
    const SCHEMA: &'static str = include_str!("plan/answer.schema.json");
    type Subject<'s> = &'s Start<'s>;
    type Answer = PlanAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<PlanAnswer, Refusal> {
        let study = of.prepared(&self.run, control)?;
        let plan = study.plan().map_err(|e| of.refusal(e))?;
        let memory = study.memory(of.text.len()).map_err(|e| of.refusal(e))?;
        let sweep = match self.vary.as_slice() {
            [] => None,
            axes => {
                let sweep = Sweep::read(&of.name, &of.text, of.registry, axes.to_vec());
                let sweep = sweep.map_err(|e| match e {
                    SweepError::Study(e) => of.refusal(e),
                    other => other.into(),
                })?;
                Some(sweep.evaluation())
            }
        };
        Ok(PlanAnswer::new(&plan, memory, sweep))
    }
}

impl Answer for PlanAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(self)
    }
}
