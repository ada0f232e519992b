//! Which rows may be deleted without a change of motion: sets of those of the parts.

use std::borrow::Cow;

use model::{ConstraintId, System};
use rank::{DeletionError, Limits, count_deletions, deletions};

use super::Questions;
use crate::groups::RequestError;
use crate::make_unique::{Allowed, Proposals, make_unique};
use crate::parts::ListedRows;

/// Why it cannot be told what may be deleted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EliminationError {
    /// In a part.
    #[error(transparent)]
    Deletion(#[from] DeletionError),
    /// A part is too large.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// Every part has its number of sets, but their product is larger than any number that is
    /// counted with.
    #[error(
        "{parts} parts of the mechanism have their own sets, and the product of their numbers is more than 3.4e38"
    )]
    TooMany {
        /// Parts with dependent rows.
        parts: usize,
    },
}

impl Questions<'_> {
    /// The number of sets of rows that can be deleted without a change of motion, as many rows as
    /// the degree of redundancy.
    ///
    /// # Errors
    /// If the rank of a part or one of its sets is undecided, a part is too large, or they are too
    /// many.
    pub fn eliminations(&self) -> Result<u128, EliminationError> {
        let mut product = 1_u128;
        for k in self.redundant() {
            let own = count_deletions(self.configuration(k)?.solvability().decision())?;
            product = product.checked_mul(own).ok_or(EliminationError::TooMany {
                parts: self.redundant().count(),
            })?;
        }
        Ok(product)
    }

    /// Parts of which something has to be said before anything may be deleted.
    fn redundant(&self) -> impl Iterator<Item = usize> {
        let parts = self.parts().iter().enumerate();
        parts
            .filter(|(_, part)| {
                let is_decided = part.decision.status() == rank::RankStatus::Decided;
                part.decision.redundancy() > 0 || !is_decided
            })
            .map(|(k, _)| k)
    }

    /// The first of these sets, rows from 0: those of the parts combine like the digits of a
    /// number.
    ///
    /// # Errors
    /// If the rank of a part or one of its sets is undecided, or a part is too large.
    pub fn elimination_sets(&self, limit: usize) -> Result<Vec<Vec<usize>>, EliminationError> {
        let mut sets = vec![Vec::new()];
        sets.truncate(limit);
        for k in self.redundant() {
            let extent = &self.parts()[k].extent;
            let own = deletions(self.configuration(k)?.solvability().decision(), limit)?;
            let placed = |set: &Vec<usize>| set.iter().map(|&row| extent.row(row)).collect();
            let own: Vec<Vec<usize>> = own.iter().map(placed).collect();
            let both = |set: &Vec<usize>, own: &Vec<usize>| [set.as_slice(), own].concat();
            sets = sets
                .iter()
                .flat_map(|set| own.iter().map(move |own| both(set, own)))
                .take(limit)
                .collect();
        }
        sets.iter_mut()
            .for_each(|set: &mut Vec<usize>| set.sort_unstable());
        Ok(sets)
    }

    /// The smallest deletions that make a reaction unique without a change of motion. They are in
    /// its part.
    ///
    /// # Errors
    /// If the rank of the part or an answer is undecided, a row that is allowed does not exist, or
    /// the part is too large.
    pub fn make_unique(
        &self,
        id: ConstraintId,
        allowed: &Allowed,
        limits: Limits,
    ) -> Result<Proposals, EliminationError> {
        let (k, own) = self.place(id)?;
        let extent = &self.parts()[k].extent;
        let allowed = match (allowed, extent.is_whole()) {
            (Allowed::Rows(all), false) => {
                let rows = self.mechanism.layout().rows();
                if let Some(&row) = all.iter().find(|&&row| row >= rows) {
                    return Err(DeletionError::RowOutOfRange { row, rows }.into());
                }
                Cow::Owned(Allowed::Rows(extent.own_rows(&ListedRows::new(all))))
            }
            _ => Cow::Borrowed(allowed),
        };
        let configuration = self.configuration(k)?;
        let solvability = configuration.solvability();
        let mut found = make_unique(
            &configuration.reactions.mechanism,
            solvability,
            own,
            &allowed,
            limits,
        )?;
        for way in &mut found.ways {
            way.rows.iter_mut().for_each(|row| *row = extent.row(*row));
        }
        Ok(found)
    }
}
