//! Bounds over the analysed motion.

use std::ops::ControlFlow;

use dynamics::{MotionOptions, OutputRequest};
use solvability::Elasticity;

use super::super::addition::AnalysedMotion;
use super::super::refused::refused;
use crate::bounds_of_run::largest_loads;
use crate::documents::{AlongDocument, AlongReactionDocument, ByName};
use crate::question::Progress;
use crate::refusal::Refusal;
use crate::words::Block;

/// Runs the motion with bounds of the reactions, and adds them.
pub(super) fn add(
    elasticity: &Elasticity,
    of: &AnalysedMotion<'_>,
    along: &mut AlongDocument,
) -> Result<(), Refusal> {
    let (study, control, t_end) = (of.study, of.control, along.to);
    let stated = study.options.clone();
    let options = MotionOptions {
        t_end,
        ..stated.unwrap_or_else(|| MotionOptions::to(t_end))
    };
    let wanted = OutputRequest::default();
    let elastic = Some(elasticity);
    let run = study.show_bounded(&options, &wanted, elastic, &control.stop, |s, _| {
        (control.progress)(Progress::Motion("bounding", s.t, t_end));
        ControlFlow::Continue(())
    });
    let run = run.map_err(|e| refused(of.of, e))?.document;
    along.bounds = run.bounds;
    for (name, reaction) in &mut along.reactions.0 {
        let Some((_, own)) = run.reactions.0.iter().find(|(known, _)| known == name) else {
            continue;
        };
        reaction.magnitude_at_most = own.magnitude_at_most;
        let bounds = own.components.0.iter();
        let bounds = bounds.filter_map(|(name, c)| Some((name.clone(), c.bounds?)));
        reaction.bounds = ByName(bounds.collect());
    }
    Ok(())
}

/// Lists the largest loads over the motion.
pub(super) fn words(along: &AlongDocument) -> Vec<Block> {
    let Some(bounds) = &along.bounds else {
        return Vec::new();
    };
    let most =
        |(name, r): &(String, AlongReactionDocument)| Some((name.clone(), r.magnitude_at_most?));
    let loads = along.reactions.0.iter().filter_map(most);
    largest_loads(bounds, loads.collect())
}
