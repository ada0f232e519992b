//! Which reactions are determined, and why are the others not?

mod along;
mod counts;
mod data;
mod deletions;
mod document;
mod numbers;
mod rank;
mod words;

use std::str::FromStr;

use model::System;
use report::AnalysisDocument;
use report::documents::MakeUniqueDocument;
use serde::{Deserialize, Serialize};

use crate::along_motion::{self, VerdictsAlongMotion};
use crate::error::StudyError;
use crate::question::{Answer, Control, Ending, Progress, Question};
use crate::refusal::Refusal;
use crate::run_options::RunOptions;
use crate::start::{JudgedStart, Start};
use crate::study::Study;
use crate::words::Block;

/// Rank, redundancy, and the verdict of every reaction
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("analyze/examples.txt")))]
pub struct Analyze {
    /// Time of the motion at which the mechanism is analysed (s)
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
    /// Rows to take as the dependent ones, counted from 1
    // In the program they are counted from 0.
    #[serde(deserialize_with = "crate::run_options::rows")]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "Option<Vec<std::num::NonZeroUsize>>")
    )]
    #[cfg_attr(feature = "command", arg(long, value_name = "ROWS", value_delimiter = ',', value_parser = crate::run_options::row))]
    pub drop: Option<Vec<usize>>,
    /// A sum of components to judge, as "W3.N + W4.N"; may be given several times
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "EXPR", allow_hyphen_values = true)
    )]
    pub combine: Vec<String>,
    /// Find the smallest sets of rows to delete so that this reaction becomes unique; may be given
    /// several times
    #[cfg_attr(feature = "command", arg(long, value_name = "NAME"))]
    pub make_unique: Vec<String>,
    /// What may be deleted for --make-unique: sensible (no joint of several rows loses all of
    /// them), whole (joints and drives as a whole), rows (any), or rows:4,6,21 (these)
    #[cfg_attr(feature = "command", arg(long, value_name = "WHAT", default_value = SENSIBLE))]
    pub allow: String,
    /// List at most N sets of rows that can be eliminated without a change of the motion
    #[cfg_attr(feature = "command", arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "100"))]
    pub eliminations: Option<usize>,
    /// Also judge the components in the frames of the first body, of the edge and of the joint
    #[cfg_attr(feature = "command", arg(long))]
    pub frames: bool,
    /// Also judge moments about this point: X,Y in the plane, X,Y,Z in space (m, ground axes), or
    /// the name of a marker
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "POINT", allow_hyphen_values = true)
    )]
    pub about: Option<String>,
    /// Run the motion, for the duration that the scene states or to T_END (s): the verdict that
    /// holds along it, and the intervals with other verdicts
    #[cfg_attr(feature = "command", arg(long, value_name = "T_END", num_args = 0..=1, default_missing_value = STATED, allow_negative_numbers = true))]
    pub along: Option<Along>,
    /// Compute the reactions for a choice: minimum-norm, minimum-norm:length=L (a torque counts as
    /// a force on an arm of length L), compliance:W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds rad/(N·m)),
    /// drop:6,21; may be given several times
    #[cfg_attr(feature = "command", arg(long, value_name = "CHOICE"))]
    pub choose: Vec<String>,
}

impl Default for Analyze {
    fn default() -> Self {
        Self {
            at_time: 0.0,
            drop: None,
            combine: Vec::new(),
            make_unique: Vec::new(),
            allow: SENSIBLE.to_owned(),
            eliminations: None,
            frames: false,
            about: None,
            along: None,
            choose: Vec::new(),
        }
    }
}

const SENSIBLE: &str = "sensible";
const STATED: &str = "stated";

/// How far the motion is judged.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(try_from = "TimeOrWord")]
pub enum Along {
    /// As far as the scene states.
    Stated,
    /// To this time (s).
    To(f64),
}

impl FromStr for Along {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            _ if text == STATED => Ok(Self::Stated),
            Ok(time) => Ok(Self::To(time)),
            Err(e) => Err(format!("`{text}`: {e}")),
        }
    }
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum TimeOrWord {
    Time(f64),
    Word(String),
}

impl TryFrom<TimeOrWord> for Along {
    type Error = String;

    fn try_from(read: TimeOrWord) -> Result<Self, String> {
        match read {
            TimeOrWord::Time(time) => Ok(Self::To(time)),
            TimeOrWord::Word(word) => word.parse(),
        }
    }
}

impl Question for Analyze {
    const NAME: &'static str = "analyze";
    const SCHEMA: &'static str = include_str!("analyze/answer.schema.json");
    type Subject<'s> = &'s Start<'s>;
    type Answer = AnalyzeAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<AnalyzeAnswer, Refusal> {
        if !(self.at_time >= 0.0 && self.at_time.is_finite()) {
            let time = self.at_time;
            return Err(Refusal::input(format!(
                "--at-time is {time}, need a time ≥ 0"
            )));
        }
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
        match judged {
            JudgedStart::Moves(study) => self.of_study(of, (judged, study), control),
            // A mechanism that cannot move can still be judged at the start.
            JudgedStart::Stands(stands) if self.at_time == 0.0 && self.along.is_none() => {
                let start = of
                    .configuration(judged, |_| ())
                    .map_err(|e| of.refusal(e))?;
                let mut document = document::of(self, of, &start)?;
                document.warnings.insert(0, stands.warning.clone());
                Ok(AnalyzeAnswer {
                    document,
                    hints: document::hints(&start, control)?,
                })
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
        control: &Control<'_>,
    ) -> Result<AnalyzeAnswer, Refusal> {
        let description = &study.scene.description;
        let joints = description.joints().chain(description.drives()).count();
        let drop = self.drop.as_deref();
        let of_configuration = || {
            let progress = |done| (control.progress)(Progress::Count("joints", done, joints));
            let found = match (self.at_time, drop) {
                (0.0, None) => of.configuration(judged, progress),
                (time, drop) => study.analyse_with_progress(time, drop, progress),
            };
            let configuration = found.map_err(|e| of.refusal(e))?;
            let document = document::of(self, of, &configuration)?;
            Ok::<_, Refusal>((configuration, document))
        };
        // A motion is computed step by step, so the verdicts of the start can run in another
        // thread.
        let (of_configuration, along) = match self.along {
            Some(along) => crate::both(of_configuration, || Some(judge(of, study, along, control))),
            None => (of_configuration(), None),
        };
        let (configuration, mut document) = of_configuration?;
        if self.at_time == 0.0 {
            let warned = study.add_warnings(&mut document);
            warned.map_err(|e| of.refusal(e))?;
        }
        if let Some(found) = along.transpose()? {
            found.add_to(&mut document, configuration.mechanism.layout());
        }
        let hints = document::hints(&configuration, control)?;
        Ok(AnalyzeAnswer { document, hints })
    }
}

/// Runs and judges the motion.
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
    let found = study.verdicts_along_motion(t_end, |progress| {
        let (what, t) = match progress {
            along_motion::MotionProgress::Moving(t) => ("moving", t),
            along_motion::MotionProgress::Judging(t) => ("judging", t),
        };
        (control.progress)(Progress::Motion(what, t, end));
    });
    found.map_err(|e| of.refusal(e))
}

/// An analysed configuration.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AnalyzeAnswer {
    /// Ranks, verdicts, reasons, and answers to the options.
    #[serde(flatten)]
    pub document: AnalysisDocument,
    /// What would make reactions unique: in words only.
    #[serde(skip)]
    hints: Vec<MakeUniqueDocument>,
}

impl Answer for AnalyzeAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(&self.document, &self.hints)
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
