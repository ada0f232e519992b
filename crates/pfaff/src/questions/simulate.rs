//! How does the mechanism move, and what do its joints carry on the way?

mod words;

pub use words::TRUSTED_BALANCE;

use std::ops::ControlFlow;

use model::System;
use report::RunDocument;
use serde::{Deserialize, Serialize};

use crate::choice::choices;
use crate::error::StudyError;
use crate::question::{Answer, Control, Ending, Output, Progress, Question};
use crate::refusal::Refusal;
use crate::run_options::RunOptions;
use crate::start::Start;
use crate::study::FAMILY;
use crate::words::Block;

/// Motion and reactions, written into a directory with a report for any browser
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("simulate/examples.txt")))]
pub struct Simulate {
    /// The run
    #[cfg_attr(feature = "command", command(flatten))]
    pub run: RunOptions,
    /// Choose the numbers of choice.csv (choice_2.csv, …): as of analyze; repeatable
    #[cfg_attr(feature = "command", arg(long, value_name = "CHOICE"))]
    pub choose: Vec<String>,
}

impl Question for Simulate {
    const NAME: &'static str = "simulate";
    const SCHEMA: &'static str = include_str!("simulate/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: FAMILY,
        contents: "the results",
        streams: Some("summary.json"),
    });
    type Subject<'s> = &'s Start<'s>;
    type Answer = SimulateAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<SimulateAnswer, Refusal> {
        let Some(directory) = control.directory else {
            let message = "a run is written into a directory; none was given";
            return Err(Refusal::input(message.to_owned()));
        };
        let run = RunOptions {
            threads: control.threads,
            ..self.run.clone()
        };
        let mut study = of.prepared(&run, control)?;
        let rows = study.prepared.mechanism.layout().rows();
        let reaction = |name: &str| study.reaction(name);
        study.choices = choices(&self.choose, of, (rows, &reaction))?;
        let memory = study.memory(of.text.len()).map_err(|e| of.refusal(e))?;
        of.budget.allow(memory, "this run")?;
        let Some(options) = &study.options else {
            return Err(of.refusal(StudyError::NoEnd));
        };
        let t_end = options.t_end;
        let scene = study.scene.name().to_owned();
        (control.progress)(Progress::Writing(scene.clone()));
        let origin = control.provenance.into();
        let document = study.simulate_as(&origin, directory, &control.stop, |t| {
            (control.progress)(Progress::Motion("moving", t, t_end));
            ControlFlow::Continue(())
        });
        Ok(SimulateAnswer {
            document: document.map_err(|e| of.refusal(e))?,
            scene,
            t_end,
            has_report: study.scene.output.report,
        })
    }
}

/// A run.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SimulateAnswer {
    /// Its summary.
    #[serde(flatten)]
    pub document: RunDocument,
    /// Name of the scene.
    #[serde(skip)]
    scene: String,
    /// Last time that was asked for (s).
    #[serde(skip)]
    t_end: f64,
    #[serde(skip)]
    has_report: bool,
}

impl Answer for SimulateAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(self)
    }

    fn ending(&self) -> Ending {
        if self.document.partial {
            Ending::Stopped
        } else {
            Ending::Complete
        }
    }
}
