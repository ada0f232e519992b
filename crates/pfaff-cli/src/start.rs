//! The assembled start with its verdicts, for mechanisms of any size: the basis of a picture and of
//! a comparison.

use pfaff::model::{Mechanism, System};
use pfaff::report::AnalysisDocument;
use pfaff::scene::Scene;
use pfaff::solvability::ReactionVerdict;
use pfaff::{AssembledScene, StudyError};

use crate::input::Source;
use crate::output::Failure;
use crate::resources::Resources;

/// A start and the verdicts of its reactions.
pub(crate) struct Start {
    pub(crate) scene: Scene,
    pub(crate) mechanism: Mechanism,
    /// Its coordinates.
    pub(crate) q: Vec<f64>,
    /// Joints and drives in the order of their rows.
    pub(crate) reactions: Vec<ReactionVerdict>,
    pub(crate) document: AnalysisDocument,
}

impl Start {
    /// Assembles the start of a scene and judges it, also if no motion can begin there.
    pub(crate) fn of(source: &Source, resources: Resources) -> Result<Self, Failure> {
        let mut assembled = resources.assembled(source)?;
        let failure = |e: StudyError| source.failure(e);
        let (reactions, document) = judged(&mut assembled).map_err(failure)?;
        let q = assembled.assemble().map_err(failure)?.q;
        let AssembledScene {
            scene, mechanism, ..
        } = assembled;
        Ok(Self {
            q,
            scene,
            mechanism,
            reactions,
            document,
        })
    }
}

fn judged(
    assembled: &mut AssembledScene,
) -> Result<(Vec<ReactionVerdict>, AnalysisDocument), StudyError> {
    let configuration = assembled.analyse(None)?;
    let mut document =
        AnalysisDocument::new(configuration.scene.name(), &configuration.analysis, None)
            .with_freedoms(&configuration.freedoms()?, configuration.mechanism);
    if let Some(explanation) = configuration.explanation()? {
        document.explain(&explanation, configuration.mechanism.layout());
    }
    document.add_sensitivities(
        &configuration.sensitivities()?,
        configuration.mechanism.layout(),
    );
    Ok((configuration.analysis.reactions.clone(), document))
}
