//! What an analysis says besides, if it is asked to.

use solvability::ComponentVerdict;

use super::options::Analyze;
use crate::configuration::ConfigurationAnalysis;
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::refusal::Refusal;
use crate::words::Block;

/// What an analysis also says if it is asked to.
pub(super) trait Addition: Sync {
    /// Refuses what cannot be answered, before anything is computed.
    fn check(&self, _asked: &Analyze, _of: &ConfigurationAnalysis<'_>) -> Result<(), Refusal> {
        Ok(())
    }

    /// Adds it to the document, if it is asked for.
    fn add(
        &self,
        asked: &Analyze,
        of: &ConfigurationAnalysis<'_>,
        document: &mut AnalysisDocument,
    ) -> Result<(), StudyError>;

    /// The same in words.
    fn words(&self, d: &AnalysisDocument) -> Vec<Block>;
}

/// The places of unique components.
pub(super) fn unique(components: &[ComponentVerdict]) -> impl Iterator<Item = usize> + '_ {
    let all = components.iter().enumerate();
    all.filter(|(_, c)| c.judgement.verdict.is_unique())
        .map(|(k, _)| k)
}
