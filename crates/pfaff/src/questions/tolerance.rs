//! How much do verdicts, reactions and positions vary if the data vary within their tolerances?

mod page;
mod words;

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::documents::ToleranceDocument;
use model::System;
use report::{Family, Table};
use serde::{Deserialize, Serialize};

use crate::configuration::requests;
use crate::elasticity::{BoundsOptions, elasticity};
use crate::question::{Answer, Control, Ending, Output, Place, Progress, Question, Writing};
use crate::refusal::{Refusal, json};
use crate::start::{Start, asked_time};
use crate::tolerance::{
    SAMPLES, ToleranceError, ToleranceOptions, ToleranceResult, ToleranceStudy, Variation,
    VariedText,
};
use crate::words::Block;

/// Run a Monte-Carlo analysis of the tolerances
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("tolerance/examples.txt")))]
pub struct Tolerance {
    /// Number of samples
    #[cfg_attr(feature = "command", arg(long, value_name = "N", default_value_t = SAMPLES))]
    pub runs: usize,
    /// Also vary a parameter or number: KEY=±VALUE or KEY=±P%; repeatable
    #[cfg_attr(feature = "command", arg(long, value_name = "KEY=±VALUE"))]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<String>"))]
    pub vary: Vec<Variation>,
    /// Random seed
    #[cfg_attr(feature = "command", arg(long, value_name = "S", default_value_t = 1))]
    pub seed: u64,
    /// Analyse the samples at this time (s)
    #[cfg_attr(
        feature = "command",
        arg(
            long,
            value_name = "T",
            default_value_t = 0.0,
            allow_hyphen_values = true
        )
    )]
    pub at_time: f64,
    /// The bounds
    #[cfg_attr(feature = "command", command(flatten))]
    pub elastic: BoundsOptions,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self {
            runs: SAMPLES,
            vary: Vec::new(),
            seed: 1,
            at_time: 0.0,
            elastic: BoundsOptions::default(),
        }
    }
}

const TABLE: &str = "tolerance.csv";
const DOCUMENT: &str = "tolerance.json";
const PAGE: &str = "tolerance.html";

impl Question for Tolerance {
    const NAME: &'static str = "tolerance";
    const SCHEMA: &'static str = include_str!("tolerance/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: Family(&[TABLE, DOCUMENT, PAGE]),
        contents: "samples, JSON document and page",
        writing: Writing::AtEnd,
    });
    type Subject<'s> = &'s Start<'s>;
    type Answer = ToleranceAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<ToleranceAnswer, Refusal> {
        let refused = |e: ToleranceError| match e {
            ToleranceError::Study(e) => of.refusal(e),
            e if e.is_input() => Refusal::input(e.to_string()).coded(e.code()),
            e => Refusal::stopped(e.to_string()).coded(e.code()),
        };
        let assembled = of.assembled(control)?;
        let wanted = self.elastic.requested()?;
        let (scene, mechanism) = (&assembled.scene, &assembled.mechanism);
        let reaction = |name: &str| {
            let found = requests::reaction(scene, mechanism, name);
            found.map_err(|e| of.refusal(e))
        };
        let bounds = wanted.map(|wanted| elasticity(&wanted, mechanism.layout(), &reaction));
        let bounds = bounds.transpose()?;
        let start_time = assembled.mechanism.layout().start_time;
        let at_time = asked_time(self.at_time, start_time)?;
        let described = assembled.scene.clone();
        let vary = (!self.vary.is_empty()).then(|| {
            let text = (of.name.as_str(), of.text.as_str());
            VariedText::new(text, of.registry, of.tolerance, self.vary.clone())
        });
        let vary = vary.transpose().map_err(refused)?;
        let study = ToleranceStudy::varying(assembled, at_time, vary).map_err(refused)?;
        let study = study.with_bounds(described, bounds);
        let memory = study.memory(self.runs);
        of.budget.allow(memory, "keeping these samples")?;
        let options = ToleranceOptions {
            samples: self.runs,
            seed: self.seed,
            threads: control.threads,
        };
        let made = AtomicUsize::new(0);
        let found = study.run(&options, control.stop, |_| {
            let done = made.fetch_add(1, Ordering::Relaxed) + 1;
            let of = self.runs;
            (control.progress)(Progress::Count("samples", done, of));
        });
        let ToleranceResult { samples, document } = found.map_err(refused)?;
        let mut files = Vec::new();
        if control.wants_files {
            let mut table = Table::new(TABLE, Vec::new(), &study.columns())?;
            for sample in &samples {
                table.record(study.row(sample))?;
            }
            let page = page::of(&document, &study.clouds(&samples), control.provenance);
            files = vec![
                (TABLE, table.finish()?),
                (DOCUMENT, json(&document)?.into_bytes()),
                (PAGE, page.into_bytes()),
            ];
        }
        Ok(ToleranceAnswer {
            document,
            wanted: self.runs,
            files,
        })
    }
}

/// Combined results of all samples.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ToleranceAnswer {
    /// Verdicts, and ranges of reactions and positions.
    #[serde(flatten)]
    pub document: ToleranceDocument,
    /// Number of requested samples.
    #[serde(skip)]
    wanted: usize,
    #[serde(skip)]
    files: Vec<(&'static str, Vec<u8>)>,
}

impl Answer for ToleranceAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(&self.document)
    }

    fn ending(&self) -> Ending {
        if !self.document.partial {
            return Ending::Complete;
        }
        let (made, all) = (self.document.samples, self.wanted);
        Ending::interrupted(format!("interrupted after {made} of {all} samples"))
    }

    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal> {
        for (name, content) in &self.files {
            place.put(name, content)?;
        }
        Ok(())
    }
}
