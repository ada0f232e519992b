//! What can move: rank, redundancy and mobility of the rows without those of drives, and free
//! motions in words and numbers.
//!
//! A drive fills the rank like any row: with its drive a four-bar has mobility 0, as a truss has.
//! Without drives the two differ, and the motions that are left say how. Ranks are those of
//! [`crate::analyse`] and its machinery; nothing is decided here. Free motions are those of first
//! order at one configuration: velocities v with `C·v = 0`.
//!
//! A basis of these velocities is a matter of choice. Bodies that no joint connects move apart; of
//! connected ones each motion moves as few joints as a search finds, and as few bodies; a body that
//! nothing holds is told as free.

mod basis;
mod component;
mod connected;
mod motions;
mod ranks;
mod words;

use model::{Mechanism, System};

use crate::analysis::Analysis;
use crate::state::{StateError, check_configuration};
use connected::Connected;
use motions::Decided;

pub use motions::{FreeMotion, FreeMotions, LeftOut};
pub(crate) use ranks::PartialRanks;
pub use ranks::WithoutDrives;

/// What can move at a configuration, with the drives and without them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Freedoms {
    /// n_v − r
    pub mobility: usize,
    /// What moves while the drives stand still.
    pub motions: FreeMotions,
    /// The same without the drives. `None` if there are none.
    pub without_drives: Option<FreedomsWithoutDrives>,
    /// Whether nothing moves whatever the drives do: no velocity is left without them, and no joint
    /// follows a function of time.
    pub cannot_move: bool,
}

/// What can move where nothing is driven.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FreedomsWithoutDrives {
    /// How many drives are left out.
    pub drives: usize,
    /// Rank and redundancy of the other rows.
    pub ranks: WithoutDrives,
    /// Their n_v − r.
    pub mobility: usize,
    /// What moves.
    pub motions: FreeMotions,
}

impl Analysis {
    /// What can move at the configuration q of the analysis.
    ///
    /// # Errors
    /// If q is no configuration of this mechanism.
    pub fn freedoms(&self, mechanism: &Mechanism, q: &[f64]) -> Result<Freedoms, StateError> {
        let decided = self.parts.iter().map(|part| Decided {
            rows: (0..part.rows()).map(|k| part.extent.row(k)).collect(),
            rank: part.decision.rank(),
            without_drives: part.without_drives,
        });
        let is_decided = self.decision.is_decided();
        Freedoms::of(mechanism, self.time, q, is_decided, decided.collect())
    }
}

impl Freedoms {
    /// From the ranks of all rows, part by part.
    fn of(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        is_decided: bool,
        mut decided: Vec<Decided>,
    ) -> Result<Self, StateError> {
        check_configuration(mechanism, t, q)?;
        let layout = mechanism.layout();
        let of = |drives: bool, decided: &[Decided]| {
            let rank: usize = decided.iter().map(|part| part.rank).sum();
            let mobility = layout.n_v - rank;
            let motions = match (mobility, is_decided) {
                (0, _) => FreeMotions::default(),
                (_, true) => Connected::new(mechanism, drives).motions(t, q, decided),
                (freedoms, false) => FreeMotions {
                    motions: Vec::new(),
                    left_out: Some(LeftOut {
                        freedoms,
                        reason: "the rank is undecided".to_owned(),
                    }),
                },
            };
            (mobility, motions)
        };
        let (mobility, motions) = of(true, &decided);
        let rows_of_drives = layout.drive_rows();
        let drives = layout
            .groups
            .iter()
            .filter(|group| group.is_drive())
            .count();
        let without_drives = (drives > 0).then(|| {
            for part in &mut decided {
                if let Some(ranks) = part.without_drives {
                    part.rows
                        .retain(|row| rows_of_drives.binary_search(row).is_err());
                    part.rank = ranks.rank;
                }
            }
            let (mobility, motions) = of(false, &decided);
            FreedomsWithoutDrives {
                drives,
                ranks: WithoutDrives {
                    rank: decided.iter().map(|part| part.rank).sum(),
                    redundancy: decided.iter().map(|part| part.rows.len() - part.rank).sum(),
                },
                mobility,
                motions,
            }
        });
        let least = without_drives.as_ref().map_or(mobility, |d| d.mobility);
        let mut joints = layout.groups.iter().filter(|group| !group.is_drive());
        let moves_joints = joints.any(|group| group.spec.rheonomic);
        Ok(Self {
            mobility,
            motions,
            without_drives,
            cannot_move: is_decided && least == 0 && !moves_joints,
        })
    }
}

#[cfg(test)]
mod tests;
