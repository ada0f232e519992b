//! Components in the frames of the first body, of the edge and of the joint.

mod answer;

use model::System;
use model::words::digits;
use solvability::ReactionNumber;

pub use answer::FrameDocument;

use super::addition::{Addition, unique};
use super::options::Analyze;
use super::phrases::{each, spoken};
use crate::configuration::ConfigurationAnalysis;
use crate::documents::{AnalysisDocument, ComponentDocument};
use crate::error::StudyError;
use crate::words::Block;

/// Components in other frames.
pub(super) struct OtherFrames;

impl Addition for OtherFrames {
    fn add(
        &self,
        asked: &Analyze,
        of: &ConfigurationAnalysis<'_>,
        document: &mut AnalysisDocument,
    ) -> Result<(), StudyError> {
        if !asked.frames {
            return Ok(());
        }
        let layout = of.mechanism.layout();
        let mut numbers = Vec::new();
        for (id, reaction) in layout.constraint_ids().zip(&mut document.reactions) {
            let frames = of.frames(id)?;
            for found in &frames {
                let number = |k: usize| ReactionNumber::in_frame(id, found.frame, k);
                numbers.extend(unique(&found.components).map(number));
            }
            reaction.frames = frames.iter().map(Into::into).collect();
        }
        let found = of.sensitivities_of(&numbers)?;
        let components = document.reactions.iter_mut().flat_map(|r| {
            let name = &r.name;
            let frames = r.frames.iter_mut();
            frames.flat_map(move |f| f.components.iter_mut().map(move |c| (name, c)))
        });
        ComponentDocument::add_sensitivities(components, found, layout);
        Ok(())
    }

    /// The text lists only reactions that are not unique. All other reactions are unique in every
    /// frame.
    fn words(&self, d: &AnalysisDocument) -> Vec<Block> {
        let open = d.reactions.iter().filter(|r| r.wrench.verdict != "unique");
        let lines = open.flat_map(|r| {
            r.frames.iter().map(|f| {
                let axis = f.axes[0].iter().map(|x| digits(*x, 3));
                let axis = axis.collect::<Vec<_>>().join(", ");
                [
                    r.name.clone(),
                    spoken(f.frame),
                    format!("({axis})"),
                    each(&f.components),
                ]
            })
        });
        let lines: Vec<_> = lines.collect();
        if lines.is_empty() {
            return Vec::new();
        }
        let header = ["reaction", "frame", "first axis", "components"];
        let heading = Block::Heading("In other frames:".to_owned());
        vec![heading, Block::table(header, lines)]
    }
}
