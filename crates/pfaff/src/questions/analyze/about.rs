//! Moments about a point other than the reference points of the joints.

mod answer;

use model::System;
use scene::in_si;
use solvability::ReactionNumber;

pub use answer::MomentAboutDocument;

use super::addition::{Addition, unique};
use super::options::Analyze;
use super::phrases::{coordinates, each};
use crate::configuration::ConfigurationAnalysis;
use crate::documents::analysis::components;
use crate::documents::{AnalysisDocument, ComponentDocument};
use crate::error::StudyError;
use crate::refusal::Refusal;
use crate::words::Block;

/// Axes of the ground.
const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Moments about the requested point.
pub(super) struct Moments;

impl Addition for Moments {
    fn check(&self, asked: &Analyze, of: &ConfigurationAnalysis<'_>) -> Result<(), Refusal> {
        let about = asked.about.as_deref();
        about.map_or(Ok(()), |text| point(text, of).map(|_| ()))
    }

    fn add(
        &self,
        asked: &Analyze,
        of: &ConfigurationAnalysis<'_>,
        document: &mut AnalysisDocument,
    ) -> Result<(), StudyError> {
        let about = asked.about.as_deref();
        let Some(about) = about.and_then(|text| point(text, of).ok()) else {
            return Ok(());
        };
        let layout = of.mechanism.layout();
        let space = layout.space;
        let mut numbers = Vec::new();
        for (id, reaction) in layout.constraint_ids().zip(&mut document.reactions) {
            let found = of.moment(id, about)?;
            let axis = |k: usize| UNITS[space.axis_of(space.torques().start + k)];
            let moment = |k: usize| ReactionNumber::moment(id, axis(k), about);
            numbers.extend(unique(&found.components).map(moment));
            reaction.moment = Some(MomentAboutDocument {
                about: components(space, found.about),
                components: found.components.iter().map(Into::into).collect(),
            });
        }
        let found = of.sensitivities_of(&numbers)?;
        let components = document.reactions.iter_mut().flat_map(|r| {
            let name = &r.name;
            let moments = r.moment.iter_mut();
            moments.flat_map(move |m| m.components.iter_mut().map(move |c| (name, c)))
        });
        ComponentDocument::add_sensitivities(components, found, layout);
        Ok(())
    }

    fn words(&self, d: &AnalysisDocument) -> Vec<Block> {
        let wanted = d.reactions.iter();
        let wanted = wanted.filter_map(|r| Some((r, r.moment.as_ref()?)));
        let wanted: Vec<_> = wanted.collect();
        let Some((_, first)) = wanted.first() else {
            return Vec::new();
        };
        let about = coordinates(&first.about);
        let lines = wanted.iter();
        let lines =
            lines.map(|(r, moment)| vec![r.name.clone().into(), each(&moment.components).into()]);
        vec![
            Block::Heading(format!("Moments about {about}:")),
            Block::Table(lines.collect()),
        ]
    }
}

/// Reads the point of `--about`: coordinates, or the position of a marker.
fn point(text: &str, configuration: &ConfigurationAnalysis<'_>) -> Result<[f64; 3], Refusal> {
    if let Some(place) = configuration.marker(text) {
        return Ok(place);
    }
    let n = configuration.mechanism.layout().space.n_translations();
    let numbers: Option<Vec<f64>> = text.split(',').map(|x| in_si(x, "1 m")).collect();
    let mut point = [0.0; 3];
    match numbers {
        Some(numbers) if numbers.len() == n => {
            point[..n].copy_from_slice(&numbers);
            Ok(point)
        }
        _ => {
            let form = ["X", "Y", "Z"][..n].join(",");
            Err(Refusal::input(format!(
                "--about is `{text}`, need {n} numbers as {form} (m, or with units, as 310mm), or the name of a marker"
            )))
        }
    }
}
