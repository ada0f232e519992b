//! How does the mechanism move, and which reactions do its joints have during the motion?

mod words;

use std::ops::ControlFlow;

use crate::documents::EndedDocument;
use crate::documents::RunDocument;
use model::System;
use report::{Family, OutputDirectory};
use scene::PrintStyle;
use serde::{Deserialize, Deserializer, Serialize};
use solvability::Choice;

use crate::choice::choices;
use crate::elasticity::{BoundsOptions, elasticity};
use crate::error::StudyError;
use crate::question::{
    Answer, Control, Ending, INTERRUPTED, NOTHING_WRITTEN, Output, Progress, Question, Writing,
};
use crate::questions::analyze::remedies;
use crate::refusal::{Refusal, json};
use crate::run_options::{RunOptions, named};
use crate::start::Start;
use crate::study::FAMILY;
use crate::words::Block;

/// The file that states whether the other files are complete.
pub(super) const SUMMARY: &str = "summary.json";

/// Simulate the motion; write tables and a report for the browser
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("simulate/examples.txt")))]
pub struct Simulate {
    /// The run
    #[cfg_attr(feature = "command", command(flatten))]
    pub run: RunOptions,
    /// Write choice.csv (choice_2.csv, …) for a choice, as in analyze; repeatable
    #[cfg_attr(feature = "command", arg(long, value_name = "CHOICE"))]
    pub choose: Vec<String>,
    /// Style of report.html; customer is a short report for print
    #[serde(deserialize_with = "print_style")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    #[cfg_attr(feature = "command", arg(long, value_name = "STYLE", value_parser = crate::command::named(PrintStyle::ALL, PrintStyle::name)))]
    pub print: Option<PrintStyle>,
    /// The bounds
    #[cfg_attr(feature = "command", command(flatten))]
    pub elastic: BoundsOptions,
}

impl Question for Simulate {
    const NAME: &'static str = "simulate";
    const SCHEMA: &'static str = include_str!("simulate/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: FAMILY,
        contents: "tables and report",
        writing: Writing::Meanwhile { shared: false, cut },
    });
    type Subject<'s> = &'s Start<'s>;
    type Answer = SimulateAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<SimulateAnswer, Refusal> {
        let Some(directory) = control.directory else {
            let message = "a run needs an output directory";
            return Err(Refusal::input(message.to_owned()));
        };
        let run = RunOptions {
            threads: control.threads,
            ..self.run.clone()
        };
        let mut study = of.prepared(&run, control)?;
        if let Some(style) = self.print {
            let output = &mut study.scene.output;
            (output.print, output.report) = (style, true);
        }
        let mechanism = &study.prepared.mechanism;
        let scope = (mechanism.space(), mechanism.layout().rows());
        let reaction = |name: &str| study.reaction(name).map_err(|e| of.refusal(e));
        let choices = choices(&self.choose, (scope.0, scope.1, &reaction))?;
        let has_misfit = |choice: &Choice| matches!(choice, Choice::Compliance(supports) if !supports.misfits.is_empty());
        if choices.iter().any(has_misfit) {
            let message = "a misfit is stated in ground axes at one instant: use `analyze --at-time T --choose …`";
            return Err(Refusal::input(message.to_owned()));
        }
        let of_scene = study.scene.centres.first();
        let has_compliance = |choice: &Choice| matches!(choice, Choice::Compliance(_));
        if let Some(centre) = of_scene.filter(|_| choices.iter().any(has_compliance)) {
            let message = format!(
                "the centre of stiffness of `{}` moves, which --choose compliance does not follow: use `analyze --at-time T --choose …`, or --bounds",
                centre.joint
            );
            return Err(Refusal::input(message));
        }
        let wanted = self.elastic.combined(study.scene.output.bounds.as_ref())?;
        let bounds = wanted.map(|wanted| elasticity(&wanted, mechanism.layout(), &reaction));
        let bounds = bounds.transpose()?;
        (study.choices, study.bounds) = (choices, bounds);
        let memory = study.memory(of.text.len()).map_err(|e| of.refusal(e))?;
        of.budget.allow(memory, "this run")?;
        if study.scene.output.report && run.drop.is_none() {
            // A search that fails must not prevent the run.
            study.remedies = remedies::of_run(of, &study).unwrap_or_default();
        }
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

fn print_style<'d, D: Deserializer<'d>>(reader: D) -> Result<Option<PrintStyle>, D::Error> {
    named(reader, PrintStyle::ALL, PrintStyle::name)
}

fn cut(directory: &OutputDirectory, begun: Option<&str>) -> String {
    let kept = format!("whole rows of the tables in `{{}}`; {SUMMARY} marks them as partial");
    cut_tables(directory, begun, FAMILY, &kept)
}

/// Gives the tables, with their complete rows, their final names, and writes a summary which states
/// that the tables are partial. `kept` describes the files that remain in the directory `{}`.
pub(super) fn cut_tables(
    directory: &OutputDirectory,
    begun: Option<&str>,
    family: Family,
    kept: &str,
) -> String {
    let Some(scene) = begun else {
        return NOTHING_WRITTEN.to_owned();
    };
    let document = json(&EndedDocument {
        scene: scene.to_owned(),
        partial: true,
        code: INTERRUPTED,
        error: "interrupted",
    });
    let document = document.unwrap_or_default();
    let place = directory.path().display().to_string();
    if directory.abandon_as(SUMMARY, document.as_bytes(), family) {
        format!("interrupted; kept: {}", kept.replace("{}", &place))
    } else {
        format!("interrupted; nothing was written into `{place}`")
    }
}

/// A run with its results.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SimulateAnswer {
    /// Summary of the run.
    #[serde(flatten)]
    pub document: RunDocument,
    /// Name of the scene.
    #[serde(skip)]
    scene: String,
    /// Requested end time (s).
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
