//! What are the largest loads in each load case?

mod answer;
mod words;

use model::codes::Code;
use report::{Family, OutputDirectory, Selection, columns_of_reactions, file_stems, write_json};
use scene::LoadCase;
use serde::Deserialize;

pub use answer::{CaseDocument, CasePeaks, CaseSet, CasesAnswer, PeakOfCase};
use answer::{SimulatedCase, TABLE};

use crate::assembled::AssembledScene;
use crate::configuration::requests;
use crate::question::{Answer, Control, Ending, Output, Progress, Question, Writing};
use crate::questions::simulate::{SUMMARY, Simulate, cut_tables};
use crate::refusal::Refusal;
use crate::run_options::RunOptions;
use crate::source;
use crate::start::Start;
use crate::study;
use crate::words::Block;

/// The files that are written next to the directories of the cases.
const FAMILY: Family = Family(&[TABLE, SUMMARY]);

/// Code of an answer with cases that did not reach their end.
const NOT_DONE: Code = Code::new(514);

/// Simulate all load cases; write a table of their peak loads
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("cases/examples.txt")))]
pub struct Cases {
    /// The runs
    #[cfg_attr(feature = "command", command(flatten))]
    pub run: RunOptions,
    /// Simulate only these load cases
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "NAMES", value_delimiter = ',')
    )]
    pub only: Vec<String>,
}

impl Question for Cases {
    const NAME: &'static str = "cases";
    const SCHEMA: &'static str = include_str!("cases/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: FAMILY,
        contents: "the table of peak loads and a directory for each case",
        writing: Writing::Meanwhile { shared: false, cut },
    });
    type Subject<'s> = &'s Start<'s>;
    type Answer = CasesAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<CasesAnswer, Refusal> {
        let Some(directory) = control.directory else {
            let message = "load cases need an output directory";
            return Err(Refusal::input(message.to_owned()));
        };
        if let Some(case) = &of.case {
            return Err(Refusal::input(format!(
                "`cases` simulates all load cases: omit `--case {case}`, or simulate this case alone with `simulate --case`"
            )));
        }
        let assembled = of.assembled(control)?;
        let scene = &assembled.scene;
        let cases = source::cases(scene, &self.only)?;
        let stems = file_stems(cases.iter().map(|case| case.name.as_str()));
        let mut answer = CasesAnswer::new(scene.name());
        (control.progress)(Progress::Writing(scene.name().to_owned()));
        for (k, (case, stem)) in cases.iter().zip(&stems).enumerate() {
            let note = format!(", `{}`", case.name);
            (control.progress)(Progress::Runs(k as u64, cases.len() as u64, note));
            if (control.stop)() {
                answer.interrupted = true;
                break;
            }
            let ended = self.simulated(case, of, (directory, stem), control);
            answer.add(case, stem, ended);
        }
        answer.interrupted |= (control.stop)();
        answer.finish();
        answer.write_table(directory.file(TABLE)?)?.finish()?;
        let mut text = Vec::new();
        write_json(&mut text, &answer).map_err(|e| Refusal::stopped(e.to_string()))?;
        directory.write(SUMMARY, &text)?;
        Ok(answer)
    }
}

impl Cases {
    /// Simulates one case.
    fn simulated(
        &self,
        case: &LoadCase,
        of: &Start<'_>,
        (directory, stem): (&OutputDirectory, &str),
        control: &Control<'_>,
    ) -> Result<SimulatedCase, Refusal> {
        let text = source::with_values_of(&of.text, case)?;
        let mut start = Start::new(of.name.clone(), text, of.registry, of.budget);
        (start.tolerance, start.case) = (of.tolerance, Some(case.name.clone()));
        let within = directory.within(stem)?;
        within.check_ours(study::FAMILY)?;
        let simulate = Simulate {
            run: self.run.clone(),
            ..Simulate::default()
        };
        let control = Control {
            progress: &|progress| match progress {
                Progress::Writing(_) => {}
                other => (control.progress)(other),
            },
            directory: Some(&within),
            ..*control
        };
        let run = simulate.answer(&start, &control)?;
        let AssembledScene {
            scene, mechanism, ..
        } = start.assembled(&control)?;
        let groups = requests::groups(&scene, &mechanism, &[]).map_err(|e| start.refusal(e))?;
        let columns = columns_of_reactions(&mechanism, &Selection::All, &groups, |_| false)?;
        Ok(SimulatedCase { run, columns })
    }
}

fn cut(directory: &OutputDirectory, begun: Option<&str>) -> String {
    let kept = "the directories of the started cases in `{}`";
    cut_tables(directory, begun, FAMILY, kept)
}

impl Answer for CasesAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(self)
    }

    fn ending(&self) -> Ending {
        if self.interrupted {
            let made = self.cases.len();
            return Ending::interrupted(format!("interrupted after {made} load cases"));
        }
        let Some(first) = self.cases.iter().find(|case| case.error.is_some()) else {
            return Ending::Complete;
        };
        let failed = self
            .cases
            .iter()
            .filter(|case| case.error.is_some())
            .count();
        let error = first.error.as_deref().unwrap_or_default();
        Ending::Partial {
            code: NOT_DONE,
            error: format!(
                "{failed} of {} load cases failed; `{}` {}: {error}",
                self.cases.len(),
                first.name,
                first.status
            ),
        }
    }
}
