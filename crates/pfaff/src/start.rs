//! The text of a scene, with the assembled scene and the analysed start. These results are computed
//! at the first access.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use crate::documents::AnalysisDocument;
use model::words::read_in;
use model::{Mechanism, Registry, System, Tolerance};
use scene::Scene;

use crate::assembled::AssembledScene;
use crate::configuration::{ConfigurationAnalysis, KeptAnalysis};
use crate::error::StudyError;
use crate::memory::Budget;
use crate::question::{Control, Progress};
use crate::refusal::Refusal;
use crate::run_options::RunOptions;
use crate::study::Study;

/// A scene that is the subject of questions.
pub struct Start<'r> {
    /// Name of the scene in messages.
    pub name: String,
    /// Text of the scene.
    pub text: String,
    /// The load case whose values the text contains.
    pub case: Option<String>,
    /// Tolerance that takes precedence over the tolerance that the scene states.
    pub tolerance: Tolerance,
    /// The joints and forces that the scene may use.
    pub registry: &'r Registry,
    /// Limit of the memory for computations with this scene.
    pub budget: Budget,
    judged: OnceLock<Arc<JudgedStart>>,
    /// The verdicts that were computed last, with their time (s).
    verdicts: Mutex<Option<(f64, KeptAnalysis)>>,
}

impl<'r> Start<'r> {
    /// Creates a scene with this name in messages and this text.
    #[must_use]
    pub fn new(name: String, text: String, registry: &'r Registry, budget: Budget) -> Self {
        Self {
            name,
            text,
            case: None,
            tolerance: Tolerance::default(),
            registry,
            budget,
            judged: OnceLock::new(),
            verdicts: Mutex::default(),
        }
    }

    /// Reuses the results of another instance with the same text and tolerance.
    #[must_use]
    pub fn knowing(self, other: &Self) -> Self {
        Self {
            judged: other.judged.clone(),
            verdicts: Mutex::new(other.verdicts().clone()),
            ..self
        }
    }

    /// Adds positions in the text to an error.
    #[must_use]
    pub fn refusal(&self, error: StudyError) -> Refusal {
        if let StudyError::NoEnd = error {
            let message = format!("{error}: write one after `--t-end`, or after `--along`");
            return Refusal::input(message).coded(error.code());
        }
        Refusal::of((&self.name, &self.text), error)
    }

    /// Reads the scene and builds its mechanism.
    ///
    /// # Errors
    /// Returns an error if the memory is not sufficient, and the errors of the scene.
    pub fn assembled(&self, control: &Control<'_>) -> Result<AssembledScene, Refusal> {
        (control.progress)(Progress::Stage("reading and building", self.text.len()));
        let of = (self.name.as_str(), self.text.as_str());
        self.budget.assembled(of, self.registry, self.tolerance)
    }

    /// Finds a consistent start and chooses rows. The options `with` replace the options of the
    /// scene.
    ///
    /// # Errors
    /// Returns the errors of [`Self::assembled`] and [`AssembledScene::prepare`].
    pub fn prepared(&self, with: &RunOptions, control: &Control<'_>) -> Result<Study, Refusal> {
        let assembled = self.assembled(control)?;
        self.prepare(assembled, with, control)
            .map_err(|e| self.refusal(e))
    }

    fn prepare(
        &self,
        assembled: AssembledScene,
        with: &RunOptions,
        control: &Control<'_>,
    ) -> Result<Study, StudyError> {
        let stage = "assembling and choosing rows";
        (control.progress)(Progress::Stage(stage, self.text.len()));
        let study = assembled.prepare(with)?;
        Ok(Study {
            case: self.case.clone(),
            ..study
        })
    }

    /// Analyses the start, also if no motion can begin at the start. The redundant rows may differ
    /// from the rows that the scene states.
    ///
    /// # Errors
    /// Returns the errors of [`Self::assembled`], and an error if there is no start.
    pub fn judged_with(
        &self,
        with: &RunOptions,
        control: &Control<'_>,
    ) -> Result<JudgedStart, Refusal> {
        let assembled = self.assembled(control)?;
        let error = match self.prepare(assembled, with, control) {
            Ok(study) => return Ok(JudgedStart::Moves(Arc::new(study))),
            Err(e) => e,
        };
        let Some(warning) = error.only_motion() else {
            return Err(self.refusal(error));
        };
        let refusal = self.refusal(error);
        let mut assembled = self.assembled(control)?;
        let kept = assembled.analyse(with.drop.as_deref());
        let kept = kept.map_err(|e| self.refusal(e))?.kept();
        Ok(JudgedStart::Stands(Box::new(Standing {
            assembled,
            kept,
            warning,
            refusal,
        })))
    }

    /// Returns the analysed start with the options of the scene. The analysis is performed once.
    ///
    /// # Errors
    /// Returns the errors of [`Self::judged_with`].
    pub fn judged(&self, control: &Control<'_>) -> Result<Arc<JudgedStart>, Refusal> {
        if let Some(judged) = self.judged.get() {
            // Stored results must not change which scenes a memory limit rejects.
            if self.budget.limit.is_some() {
                let of = (self.name.as_str(), self.text.as_str());
                self.budget.allow_scene(of, judged.parts().1)?;
            }
            // Texts have the same units as after the scene was read.
            read_in(judged.parts().0.units.printed());
            return Ok(Arc::clone(judged));
        }
        // Two threads may both compute the start. They obtain the same result.
        let judged = Arc::new(self.judged_with(&RunOptions::default(), control)?);
        Ok(Arc::clone(self.judged.get_or_init(|| judged)))
    }

    /// Returns the verdicts on [`Self::judged`] at a time of the motion (s). The verdicts computed
    /// last are stored. `progress` is called with the number of joints analysed so far.
    ///
    /// # Errors
    /// Returns an error if the motion does not reach that time, or if C cannot be analysed at that
    /// time.
    pub fn configuration<'j>(
        &self,
        judged: &'j JudgedStart,
        time: f64,
        control: &Control<'_>,
        progress: impl Fn(usize) + Sync,
    ) -> Result<ConfigurationAnalysis<'j>, StudyError> {
        let (scene, mechanism) = judged.parts();
        let again = |kept: &KeptAnalysis| ConfigurationAnalysis::again(scene, mechanism, kept);
        let study = match judged {
            JudgedStart::Stands(stands) => return Ok(again(&stands.kept)),
            JudgedStart::Moves(study) => study,
        };
        if let Some((of, kept)) = &*self.verdicts()
            && *of == time
        {
            return Ok(again(kept));
        }
        let found = study.analyse_until(time, None, &control.stop, progress)?;
        *self.verdicts() = Some((time, found.kept()));
        Ok(found)
    }

    fn verdicts(&self) -> MutexGuard<'_, Option<(f64, KeptAnalysis)>> {
        self.verdicts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the study with the options of the scene.
    ///
    /// # Errors
    /// Returns the errors of [`Self::judged`], and an error if no motion can begin.
    pub fn study(&self, control: &Control<'_>) -> Result<Arc<Study>, Refusal> {
        self.judged(control)?.study().map(Arc::clone)
    }
}

/// A start with its verdicts.
pub enum JudgedStart {
    /// The mechanism can move.
    Moves(Arc<Study>),
    /// The start can be analysed, but no motion begins at the start.
    Stands(Box<Standing>),
}

/// A start that can be analysed, although no motion begins at this start.
pub struct Standing {
    /// The assembled scene.
    pub assembled: AssembledScene,
    /// Verdicts at the start.
    pub kept: KeptAnalysis,
    /// Reason why the mechanism cannot move, as a warning.
    pub warning: String,
    /// Reason why the mechanism cannot move, as an error for requests that need a motion.
    pub refusal: Refusal,
}

impl JudgedStart {
    /// Returns the scene and its mechanism.
    #[must_use]
    pub fn parts(&self) -> (&Scene, &Mechanism) {
        match self {
            Self::Moves(study) => (&study.scene, &study.prepared.mechanism),
            Self::Stands(stands) => (&stands.assembled.scene, &stands.assembled.mechanism),
        }
    }

    /// Returns the time of the start (s).
    #[must_use]
    pub fn start_time(&self) -> f64 {
        self.parts().1.layout().start_time
    }

    /// Returns the study, if the mechanism can move.
    ///
    /// # Errors
    /// Returns the reason why the mechanism cannot move.
    pub fn study(&self) -> Result<&Arc<Study>, Refusal> {
        match self {
            Self::Moves(study) => Ok(study),
            Self::Stands(stands) => Err(stands.refusal.clone()),
        }
    }
}

/// Returns the time of a request (s). Zero requests the start.
///
/// # Errors
/// Returns an error if the time is before the start.
pub(crate) fn asked_time(asked: f64, start_time: f64) -> Result<f64, Refusal> {
    if asked == 0.0 {
        return Ok(start_time);
    }
    if asked >= start_time && asked.is_finite() {
        return Ok(asked);
    }
    Err(Refusal::input(format!(
        "--at-time is {asked}, need a time ≥ {start_time}"
    )))
}

/// Returns the document of a configuration. It has only the results of `analyze` without options.
///
/// # Errors
/// Returns an error if a verdict cannot be explained.
pub fn document_of(
    configuration: &ConfigurationAnalysis<'_>,
) -> Result<AnalysisDocument, StudyError> {
    let mut document = verdicts_of(configuration)?;
    let layout = configuration.mechanism.layout();
    document.add_sensitivities(&configuration.sensitivities()?, layout);
    Ok(document)
}

/// Works like [`document_of`], but without the sensitivity of the reactions to the data, which
/// takes most of the time near a singular configuration.
///
/// # Errors
/// Returns an error if a verdict cannot be explained.
pub fn verdicts_of(
    configuration: &ConfigurationAnalysis<'_>,
) -> Result<AnalysisDocument, StudyError> {
    let layout = configuration.mechanism.layout();
    let name = configuration.scene.name();
    let mut document = AnalysisDocument::new(name, &configuration.analysis, None)
        .with_freedoms(configuration.freedoms()?, configuration.mechanism);
    document.add_contacts(layout);
    if let Some(explanation) = configuration.explanation()? {
        document.explain(&explanation, layout);
    }
    Ok(document)
}
