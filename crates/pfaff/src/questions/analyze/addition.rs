//! Optional parts of an analysis.

use report::TableError;
use solvability::ComponentVerdict;

use super::options::Analyze;
use crate::configuration::ConfigurationAnalysis;
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::refusal::Refusal;
use crate::words::Block;

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

    /// Returns the same results as text.
    fn words(&self, d: &AnalysisDocument) -> Vec<Block>;

    /// Returns files with the same results.
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
