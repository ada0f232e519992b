//! Which reactions are determined, and why are the other reactions not determined?

pub mod about;
mod addition;
mod additions;
mod along;
pub mod bounds;
mod contacts;
mod counts;
mod data;
mod deletions;
mod document;
pub mod frames;
pub mod matrices;
mod numbers;
mod options;
mod phrases;
mod rank;
mod refused;
pub mod remedies;
mod words;

use model::System;
use serde::Serialize;

pub use options::{Along, Analyze, Permission};

use crate::along_motion::{self, VerdictsAlongMotion};
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::question::{Answer, Control, Ending, Output, Place, Progress, Question, Writing};
use crate::refusal::{Refusal, json};
use crate::run_options::RunOptions;
use crate::start::{JudgedStart, Start, asked_time};
use crate::study::Study;
use crate::words::Block;
use addition::AnalysedMotion;
use additions::ADDITIONS;
use refused::refused;
use report::Family;

/// File name of the document.
const DOCUMENT: &str = "analysis.json";

impl Question for Analyze {
    const NAME: &'static str = "analyze";
    const SCHEMA: &'static str = include_str!("analyze/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: Family(&["phi_q.csv", "psi.csv", "c.csv", "gamma.csv", DOCUMENT]),
        contents: "the JSON document and the matrices",
        writing: Writing::AtEnd,
    });
    type Subject<'s> = &'s Start<'s>;
    type Answer = AnalyzeAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<AnalyzeAnswer, Refusal> {
        let with = RunOptions {
            drop: self.drop.clone(),
            ..RunOptions::default()
        };
        let (known, own);
        let judged = match self.drop {
            None => {
                known = of.judged(control)?;
                known.as_ref()
            }
            Some(_) => {
                own = of.judged_with(&with, control)?;
                &own
            }
        };
        let start_time = judged.start_time();
        let at_time = asked_time(self.at_time, start_time)?;
        match judged {
            JudgedStart::Moves(study) => self.of_study(of, (judged, study), at_time, control),
            // A mechanism that cannot move can still be analysed at the start.
            JudgedStart::Stands(stands) if at_time == start_time && self.along.is_none() => {
                let start = of
                    .configuration(judged, start_time, control, |_| ())
                    .map_err(|e| of.refusal(e))?;
                let mut document = document::of(self, of, &start, control)?;
                document.warnings.insert(0, stands.warning.clone());
                let hints = document::hints(&start, &document, control)?;
                Ok(AnalyzeAnswer { document, hints })
            }
            JudgedStart::Stands(stands) => Err(stands.refusal.clone()),
        }
    }
}

impl Analyze {
    fn of_study(
        &self,
        of: &Start<'_>,
        (judged, study): (&JudgedStart, &Study),
        at_time: f64,
        control: &Control<'_>,
    ) -> Result<AnalyzeAnswer, Refusal> {
        let description = &study.scene.description;
        let joints = description.joints().chain(description.drives()).count();
        let drop = self.drop.as_deref();
        let of_configuration = || {
            let progress = |done| (control.progress)(Progress::Count("joints", done, joints));
            let found = match drop {
                None => of.configuration(judged, at_time, control, progress),
                drop => study.analyse_until(at_time, drop, &control.stop, progress),
            };
            let configuration = found.map_err(|e| refused(of, e))?;
            let document = document::of(self, of, &configuration, control)?;
            Ok::<_, Refusal>((configuration, document))
        };
        // A motion is computed step by step in one thread, so the verdicts at the start can be
        // computed in another thread.
        let (of_configuration, along) = match self.along {
            Some(along) => crate::both(of_configuration, || Some(judge(of, study, along, control))),
            None => (of_configuration(), None),
        };
        let (configuration, mut document) = of_configuration?;
        if at_time == study.start_time() {
            let warned = study.add_warnings(&mut document);
            warned.map_err(|e| of.refusal(e))?;
        }
        if let Some(found) = along.transpose()? {
            found.add_to(&mut document, configuration.mechanism.layout());
            if let Some(along) = &mut document.answers.along {
                let motion = AnalysedMotion {
                    of,
                    study,
                    configuration: &configuration,
                    control,
                };
                for addition in ADDITIONS {
                    addition.add_along(self, &motion, along)?;
                }
            }
        }
        let hints = document::hints(&configuration, &document, control)?;
        Ok(AnalyzeAnswer { document, hints })
    }
}

/// Runs and analyses the motion.
fn judge(
    of: &Start<'_>,
    study: &Study,
    along: Along,
    control: &Control<'_>,
) -> Result<VerdictsAlongMotion, Refusal> {
    let t_end = match along {
        Along::Stated => None,
        Along::To(time) => Some(time),
    };
    let own = study.options.as_ref().map(|options| options.t_end);
    let Some(end) = t_end.or(own) else {
        return Err(of.refusal(StudyError::NoEnd));
    };
    if !(end.is_finite() && end > 0.0) {
        let message = format!("--along goes to {end}, need a time > 0");
        return Err(Refusal::input(message));
    }
    let found = study.verdicts_along_motion_until(t_end, &control.stop, |progress| {
        let (what, t) = match progress {
            along_motion::MotionProgress::Moving(t) => ("moving", t),
            along_motion::MotionProgress::Judging(t) => ("judging", t),
        };
        (control.progress)(Progress::Motion(what, t, end));
    });
    found.map_err(|e| refused(of, e))
}

/// An analysed configuration.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AnalyzeAnswer {
    /// Ranks, verdicts, reasons, and answers to the options.
    #[serde(flatten)]
    pub document: AnalysisDocument,
    /// Results that only the text contains.
    #[serde(skip)]
    hints: document::Hints,
}

impl Answer for AnalyzeAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(&self.document, &self.hints)
    }

    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal> {
        for addition in ADDITIONS {
            for (name, text) in addition.files(&self.document)? {
                place.put(name, &text)?;
            }
        }
        place.put(DOCUMENT, json(self)?.as_bytes())?;
        Ok(())
    }

    fn ending(&self) -> Ending {
        let along = self.document.answers.along.as_ref();
        if along.is_some_and(|along| along.stopped.is_some()) {
            Ending::Stopped
        } else {
            Ending::Complete
        }
    }
}
