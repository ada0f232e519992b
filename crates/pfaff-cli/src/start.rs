//! The assembled start with its verdicts, of mechanisms of any size: what a picture and a
//! comparison begin with.

use pfaff::model::{Mechanism, System};
use pfaff::report::AnalysisDocument;
use pfaff::scene::Scene;
use pfaff::solvability::ReactionVerdict;
use pfaff::{Blueprint, StudyError};

use crate::input::Source;
use crate::output::Failure;
use crate::resources::Resources;

/// A start and what is known of its reactions.
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
    /// Assembles the start of a scene and judges it, also where no motion begins there.
    pub(crate) fn of(source: &Source, resources: Resources) -> Result<Self, Failure> {
        let mut blueprint = resources.blueprint(source)?;
        let failure = |e: StudyError| source.failure(e);
        let (reactions, document) = judged(&mut blueprint).map_err(failure)?;
        let q = blueprint.assemble().map_err(failure)?.q;
        let Blueprint {
            scene, mechanism, ..
        } = blueprint;
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
    blueprint: &mut Blueprint,
) -> Result<(Vec<ReactionVerdict>, AnalysisDocument), StudyError> {
    let inquiry = blueprint.inquire(None)?;
    let mut document = AnalysisDocument::new(inquiry.scene.name(), &inquiry.analysis, None)
        .with_freedoms(&inquiry.freedoms()?, inquiry.mechanism);
    if let Some(explanation) = inquiry.explanation()? {
        document.explain(&explanation, inquiry.mechanism.layout());
    }
    document.add_sensitivities(&inquiry.sensitivities()?, inquiry.mechanism.layout());
    Ok((inquiry.analysis.reactions.clone(), document))
}
