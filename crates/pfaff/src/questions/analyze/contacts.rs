//! The loads that contacts permit, for scenes with one-sided joints or grip.

use std::iter;

use super::addition::Addition;
use super::options::Analyze;
use crate::configuration::ConfigurationAnalysis;
use crate::contacts::{add, blocks};
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::words::Block;

/// The loads that contacts permit.
pub(super) struct ContactsOfScene;

impl Addition for ContactsOfScene {
    fn add(
        &self,
        asked: &Analyze,
        of: &ConfigurationAnalysis<'_>,
        document: &mut AnalysisDocument,
    ) -> Result<(), StudyError> {
        add(&asked.combine, of, document)
    }

    fn words(&self, d: &AnalysisDocument) -> Vec<Block> {
        let heading = Block::Heading("Contacts:".to_owned());
        let blocks = blocks(d).map(|own| iter::once(heading).chain(own).collect());
        blocks.unwrap_or_default()
    }
}
