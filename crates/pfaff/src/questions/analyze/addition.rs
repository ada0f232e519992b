//! Optional parts of an analysis.

use report::TableError;
use solvability::ComponentVerdict;

use super::options::Analyze;
use crate::configuration::ConfigurationAnalysis;
use crate::documents::{AlongDocument, AnalysisDocument};
use crate::error::StudyError;
use crate::question::Control;
use crate::refusal::Refusal;
use crate::start::Start;
use crate::study::Study;
use crate::words::Block;

/// The analysed motion of a scene.
pub(super) struct AnalysedMotion<'a> {
    /// The scene.
    pub(super) of: &'a Start<'a>,
    /// The scene with its mechanism.
    pub(super) study: &'a Study,
    /// The configuration at the requested time.
    pub(super) configuration: &'a ConfigurationAnalysis<'a>,
    /// Progress and interrupts.
    pub(super) control: &'a Control<'a>,
}

/// An optional part of an analysis.
pub(super) trait Addition: Sync {
    /// Rejects invalid requests before the computation.
    fn check(&self, _asked: &Analyze, _of: &ConfigurationAnalysis<'_>) -> Result<(), Refusal> {
        Ok(())
    }

    /// Adds the requested results to the document.
    fn add(
        &self,
        asked: &Analyze,
        of: &ConfigurationAnalysis<'_>,
        document: &mut AnalysisDocument,
    ) -> Result<(), StudyError>;

    /// Adds the requested results along the motion.
    fn add_along(
        &self,
        _asked: &Analyze,
        _of: &AnalysedMotion<'_>,
        _document: &mut AlongDocument,
    ) -> Result<(), Refusal> {
        Ok(())
    }

    /// Returns a sentence with results that the text contains even without a request.
    fn sentence(
        &self,
        _of: &ConfigurationAnalysis<'_>,
        _document: &AnalysisDocument,
    ) -> Option<String> {
        None
    }

    /// Returns the requested results as text.
    fn words(&self, d: &AnalysisDocument) -> Vec<Block>;

    /// Returns the requested results over the motion as text.
    fn words_along(&self, _along: &AlongDocument) -> Vec<Block> {
        Vec::new()
    }

    /// Returns files with the requested results.
    fn files(&self, _d: &AnalysisDocument) -> Result<Vec<(&'static str, Vec<u8>)>, TableError> {
        Ok(Vec::new())
    }
}

/// Iterates over the indices of unique components.
pub(super) fn unique(components: &[ComponentVerdict]) -> impl Iterator<Item = usize> + '_ {
    let all = components.iter().enumerate();
    all.filter(|(_, c)| c.judgement.verdict.is_unique())
        .map(|(k, _)| k)
}
