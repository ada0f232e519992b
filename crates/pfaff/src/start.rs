//! The text of a scene, and what is made of it when it is first needed: the assembled scene, and
//! the study of its start.

use std::sync::{Arc, OnceLock};

use model::{Registry, Tolerance};

use crate::assembled::AssembledScene;
use crate::error::StudyError;
use crate::memory::Budget;
use crate::question::{Control, Progress};
use crate::refusal::Refusal;
use crate::study::{Overrides, Study};

/// A scene that questions are asked about.
pub struct Start<'r> {
    /// Its name in messages.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Takes precedence over the tolerance that the scene states.
    pub tolerance: Tolerance,
    /// The joints and forces that it may use.
    pub registry: &'r Registry,
    /// What its computations may take of the memory.
    pub budget: Budget,
    study: OnceLock<Arc<Study>>,
}

impl<'r> Start<'r> {
    /// A scene with this name in messages and this text.
    #[must_use]
    pub fn new(name: String, text: String, registry: &'r Registry, budget: Budget) -> Self {
        Self {
            name,
            text,
            tolerance: Tolerance::default(),
            registry,
            budget,
            study: OnceLock::new(),
        }
    }

    /// The same, with the study that was made of it before.
    #[must_use]
    pub fn knowing(self, study: Arc<Study>) -> Self {
        Self {
            study: OnceLock::from(study),
            ..self
        }
    }

    /// An error with its places in the text.
    #[must_use]
    pub fn refusal(&self, error: StudyError) -> Refusal {
        Refusal::of((&self.name, &self.text), error)
    }

    /// Reads the scene and builds its mechanism.
    ///
    /// # Errors
    /// The memory does not suffice, or the errors of the scene.
    pub fn assembled(&self, control: &Control<'_>) -> Result<AssembledScene, Refusal> {
        (control.progress)(Progress::Stage("reading and building", self.text.len()));
        let of = (self.name.as_str(), self.text.as_str());
        self.budget.assembled(of, self.registry, self.tolerance)
    }

    /// Finds a consistent start, and chooses rows, with options in place of those of the scene.
    ///
    /// # Errors
    /// As [`Self::assembled`] and [`AssembledScene::prepare`].
    pub fn prepared(&self, with: &Overrides, control: &Control<'_>) -> Result<Study, Refusal> {
        let assembled = self.assembled(control)?;
        let stage = "assembling and choosing rows";
        (control.progress)(Progress::Stage(stage, self.text.len()));
        assembled.prepare(with).map_err(|e| self.refusal(e))
    }

    /// The study with the options of the scene, made once.
    ///
    /// # Errors
    /// As [`Self::prepared`].
    pub fn study(&self, control: &Control<'_>) -> Result<Arc<Study>, Refusal> {
        if let Some(study) = self.study.get() {
            return Ok(Arc::clone(study));
        }
        let study = Arc::new(self.prepared(&Overrides::default(), control)?);
        Ok(Arc::clone(self.study.get_or_init(|| study)))
    }
}
