//! Determines which rows may be deleted without changing the motion. The sets of rows of the parts
//! are combined.

use model::codes::Code;
use std::borrow::Cow;

use model::{ConstraintId, System};
use rank::{DeletionError, Limits, count_deletions, deletions};

use super::Questions;
use crate::groups::RequestError;
use crate::make_unique::{DeletableRows, Proposals, make_unique};
use crate::parts::ListedRows;

/// Reason why the deletable rows cannot be determined.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EliminationError {
    /// The error of a part.
    #[error(transparent)]
    Deletion(#[from] DeletionError),
    /// A part is too large.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// The number of sets, which is a product over the parts, is too large.
    #[error(
        "{parts} parts of the mechanism have their own sets, and the product of their numbers is more than 3.4e38"
    )]
    TooMany {
        /// Number of parts with dependent rows.
        parts: usize,
    },
}

impl EliminationError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Request(e) => e.code(),
            Self::Deletion { .. } | Self::TooMany { .. } => const { Code::new(315) },
        }
    }
}

impl Questions<'_> {
    /// Returns the number of sets of rows that can be deleted without changing the motion. The
    /// number of rows in each set is the degree of redundancy.
    ///
    /// # Errors
    /// Returns an error if the rank of a part or one of its sets is undecided, if a part is too
    /// large, or if the number of sets is too large.
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

    /// Returns the parts that have dependent rows or an undecided rank.
    fn redundant(&self) -> impl Iterator<Item = usize> {
        let parts = self.parts().iter().enumerate();
        parts
            .filter(|(_, part)| {
                let is_decided = part.decision.status() == rank::RankStatus::Decided;
                part.decision.redundancy() > 0 || !is_decided
            })
            .map(|(k, _)| k)
    }

    /// Returns the first `limit` sets of [`Self::eliminations`], with rows counted from 0. The sets
    /// of the parts are combined like the digits of a number.
    ///
    /// # Errors
    /// Returns an error if the rank of a part or one of its sets is undecided, or if a part is too
    /// large.
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

    /// Returns the smallest deletions that make a reaction unique without changing the motion. The
    /// deleted rows are in the part of the reaction.
    ///
    /// # Errors
    /// Returns an error if the rank of the part or the effect of a deletion is undecided, if an
    /// allowed row does not exist, or if the part is too large.
    pub fn make_unique(
        &self,
        id: ConstraintId,
        allowed: &DeletableRows,
        limits: Limits,
    ) -> Result<Proposals, EliminationError> {
        let (k, own) = self.place(id)?;
        let extent = &self.parts()[k].extent;
        let allowed = match (allowed, extent.is_whole()) {
            (DeletableRows::Rows(all), false) => {
                let rows = self.mechanism.layout().rows();
                if let Some(&row) = all.iter().find(|&&row| row >= rows) {
                    return Err(DeletionError::RowOutOfRange { row, rows }.into());
                }
                Cow::Owned(DeletableRows::Rows(extent.own_rows(&ListedRows::new(all))))
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
