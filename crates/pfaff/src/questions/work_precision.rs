//! How accurate is a run, and how long does it take?

mod words;

use report::figures::{self, check_png};
use report::{Family, WorkPrecisionDocument, WorkPrecisionTable, work_precision_page};
use serde::{Deserialize, Serialize};

use crate::error::StudyError;
use crate::question::{Answer, Control, Ending, Output, Place, Progress, Question, Writing};
use crate::refusal::Refusal;
use crate::run_options::RunOptions;
use crate::start::Start;
use crate::words::Block;
use crate::work_precision::{ComparisonPlan, Rival, Subject, overview};

/// Measure error against run time of all methods
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("work_precision/examples.txt")))]
pub struct WorkPrecision {
    /// Use only three tolerances
    #[cfg_attr(feature = "command", arg(long, conflicts_with = "all"))]
    pub quick: bool,
    /// Measure every method with every stabilisation
    #[cfg_attr(feature = "command", arg(long))]
    pub all: bool,
    /// Also write the figure as PNG (feature `png`)
    #[cfg_attr(feature = "command", arg(long))]
    pub png: bool,
}

const TABLE: &str = "work_precision.csv";
const FIGURE: &str = "work_precision.svg";
const PAGE: &str = "report.html";
const PNG: &str = "work_precision.png";

impl Question for WorkPrecision {
    const NAME: &'static str = "work-precision";
    const SCHEMA: &'static str = include_str!("work_precision/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: Family(&[TABLE, FIGURE, PAGE, PNG]),
        contents: "table, figure and page",
        writing: Writing::AtEnd,
    });
    type Subject<'s> = Vec<&'s Start<'s>>;
    type Answer = WorkPrecisionAnswer;

    fn answer(
        &self,
        of: Vec<&Start<'_>>,
        control: &Control<'_>,
    ) -> Result<WorkPrecisionAnswer, Refusal> {
        let subject = |of: &&Start<'_>| {
            let study = of.prepared(&RunOptions::default(), control)?;
            Subject::of_study(study).map_err(|e| of.refusal(e))
        };
        // All scenes are read before the first run.
        let subjects = of.iter().map(subject).collect::<Result<Vec<_>, _>>()?;
        self.compared(&subjects, &[], control)
    }
}

impl WorkPrecision {
    /// Performs the runs of these scenes, also with methods that are not part of pfaff. If a run is
    /// stopped, the answer contains all earlier runs.
    ///
    /// # Errors
    /// Returns an error if no scene can be compared.
    pub fn compared(
        &self,
        subjects: &[Subject],
        rivals: &[&dyn Rival],
        control: &Control<'_>,
    ) -> Result<WorkPrecisionAnswer, Refusal> {
        let plan = match (self.quick, self.all) {
            (true, true) => {
                let message = "either --quick or --all, not both";
                return Err(Refusal::input(message.to_owned()));
            }
            (true, false) => ComparisonPlan::quick(),
            (false, true) => ComparisonPlan::everything(),
            (false, false) => ComparisonPlan::standard(),
        };
        if self.png {
            check_png(None)?;
        }
        let curves = plan.curves.len() + rivals.len();
        let runs = (curves * plan.tolerances.len() * subjects.len()) as u64;
        let (mut done, mut scenes) = (0, Vec::with_capacity(subjects.len()));
        let mut ending = Ending::Complete;
        for (k, subject) in subjects.iter().enumerate() {
            let compared = subject.compare(&plan, rivals, &control.stop, |row| {
                done += 1;
                let (scene, method) = (&row.scene, row.curve.method);
                let note = format!(", {scene}: {method} at {:.0e}", row.tolerance);
                (control.progress)(Progress::Runs(done, runs, note));
                Ok::<_, StudyError>(())
            });
            match compared {
                Ok(compared) => {
                    scenes.push(compared.scene);
                    if compared.interrupted {
                        let (made, all) = (k + 1, subjects.len());
                        ending = Ending::interrupted(format!(
                            "interrupted during scene {made} of {all}"
                        ));
                        break;
                    }
                }
                // The runs of the preceding scenes are kept.
                Err(e) if k > 0 => {
                    let (code, error) = (e.code(), e.to_string());
                    ending = Ending::Partial { code, error };
                    break;
                }
                Err(e) => return Err(Refusal::stopped(e.to_string()).coded(e.code())),
            }
        }
        Ok(WorkPrecisionAnswer {
            document: WorkPrecisionDocument {
                provenance: control.provenance.clone(),
                partial: ending != Ending::Complete,
                summary: overview(&scenes),
                scenes,
            },
            ending,
            png: self.png,
        })
    }
}

/// Errors and run times.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WorkPrecisionAnswer {
    /// References, runs and rankings.
    #[serde(flatten)]
    pub document: WorkPrecisionDocument,
    #[serde(skip)]
    #[cfg_attr(feature = "schema", schemars(skip))]
    ending: Ending,
    #[serde(skip)]
    png: bool,
}

impl Answer for WorkPrecisionAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(&self.document, &self.ending)
    }

    fn ending(&self) -> Ending {
        self.ending.clone()
    }

    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal> {
        let mut table = WorkPrecisionTable::new(Vec::new())?;
        for row in self.document.scenes.iter().flat_map(|scene| &scene.rows) {
            table.row(row)?;
        }
        place.put(TABLE, &table.finish()?)?;
        let figure = figures::work_precision(&self.document.scenes);
        place.put(FIGURE, figure.as_bytes())?;
        let page = work_precision_page(&self.document, &figure);
        place.put(PAGE, page.as_bytes())?;
        if self.png {
            place.put(PNG, &figures::png(&figure, None)?.bytes)?;
        }
        Ok(())
    }
}
