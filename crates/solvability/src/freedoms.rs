//! Degrees of freedom. This module determines rank, redundancy and mobility of the rows without
//! drives, and describes the free motions as text and as velocity components.
//!
//! A drive adds to the rank like any other row. With its drive, a four-bar has mobility 0, like a
//! truss. Without drives, the two mechanisms differ, and the remaining motions show the difference.
//! The ranks come from [`crate::analyse`]; this module does not decide ranks. Free motions are
//! motions of first order at one configuration: velocities v with `C·v = 0`.
//!
//! The basis of these velocities is not unique. Bodies that no joint connects move separately. For
//! connected bodies, a search finds motions that move as few joints as possible, and then as few
//! bodies as possible. A body without joints is reported as free.

mod basis;
mod component;
mod connected;
mod motions;
mod movement;
mod ranks;
mod words;

use model::{ConstraintId, Mechanism, System};

use crate::analysis::Analysis;
use crate::limits::ROWS_MAX;
use crate::pose::{decide, evaluated};
use crate::second_order::{SecondOrder, is_locked, restrictions};
use crate::state::{StateError, check_configuration};
use connected::ConnectedSets;
use motions::PartRank;

pub use motions::{FreeMotion, FreeMotions, LeftOut};
pub(crate) use ranks::PartialRanks;
pub use ranks::WithoutDrives;

/// The possible motions at a configuration, with and without the drives.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Freedoms {
    /// Mobility n_v − r.
    pub mobility: usize,
    /// Motions that are possible while the drives are locked.
    pub motions: FreeMotions,
    /// A basis of the motions that are excluded at second order, as far as this is decided. Such a
    /// motion is free only at first order, and no finite motion has its velocity.
    pub blocked: Vec<FreeMotion>,
    /// A basis of the motions for which the second order neither excludes nor proves a finite
    /// motion.
    pub undecided: Vec<FreeMotion>,
    /// The possible motions if the drives are removed. `None` if there are no drives.
    pub without_drives: Option<FreedomsWithoutDrives>,
    /// Whether no motion is possible. No motion is possible in three cases: no velocity is free
    /// without the drives, the second order excludes every velocity that is free without the
    /// drives, or the second order excludes every free velocity while the drives do not move.
    /// `None` if this is not decided.
    pub cannot_move: Option<bool>,
    /// Joints with nonholonomic rows, such as wheels, if these rows prevent every motion. Without
    /// these rows a velocity would be free.
    pub prevented_by: Vec<ConstraintId>,
}

/// The possible motions if the drives are removed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FreedomsWithoutDrives {
    /// Number of drives that are removed.
    pub drives: usize,
    /// Rank and redundancy of the other rows.
    pub ranks: WithoutDrives,
    /// Mobility n_v − r of these rows.
    pub mobility: usize,
    /// Possible motions without the drives.
    pub motions: FreeMotions,
}

/// Describes velocities (n_v values each) that the rows at q allow. The description is a list of
/// motions that span the velocities.
///
/// # Errors
/// The function returns an error if q is not a configuration of this mechanism.
pub fn motions_among(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    velocities: &[Vec<f64>],
) -> Result<Vec<FreeMotion>, StateError> {
    check_configuration(mechanism, t, q)?;
    let connected = ConnectedSets::new(mechanism, true);
    let mut described = connected.among(t, q, velocities);
    described.extend(connected.alone(q, velocities));
    Ok(described)
}

impl Analysis {
    /// Determines the possible motions at the configuration q of the analysis.
    ///
    /// # Errors
    /// The function returns an error if q is not a configuration of this mechanism.
    pub fn freedoms(&self, mechanism: &Mechanism, q: &[f64]) -> Result<Freedoms, StateError> {
        let decided = self.parts.iter().map(|part| PartRank {
            rows: (0..part.rows()).map(|k| part.extent.row(k)).collect(),
            rank: part.decision.rank(),
            without_drives: part.without_drives,
        });
        let is_decided = self.decision.is_decided();
        let mut found = Freedoms::of(mechanism, self.time, q, is_decided, decided.collect())?;
        if found.cannot_move == Some(true) && self.rank_holonomic < mechanism.layout().n_v {
            found.prevented_by = rolling(mechanism);
        }
        if found.cannot_move == Some(true) || !is_decided {
            return Ok(found);
        }
        found.cannot_move = match (found.mobility, &found.without_drives) {
            _ if self.decision.redundancy == 0 => Some(false),
            (0, None) => Some(false),
            (0, Some(without)) if without.ranks.redundancy == 0 => Some(false),
            (0, Some(_)) => blocked_without_drives(mechanism, self.time, q)?,
            _ => self.restrict(&mut found, mechanism, q)?,
        };
        Ok(found)
    }

    /// Adds the second-order results on the free motions. Returns whether no free motion remains.
    fn restrict(
        &self,
        found: &mut Freedoms,
        mechanism: &Mechanism,
        q: &[f64],
    ) -> Result<Option<bool>, StateError> {
        let Some(decision) = self.whole() else {
            return Ok(None);
        };
        let restricted = restrictions(mechanism, self.time, q, &decision)?;
        let connected = ConnectedSets::new(mechanism, true);
        let described = |which: SecondOrder| {
            let velocities = restricted.velocities(which);
            connected.among(self.time, q, &velocities)
        };
        found.blocked = described(SecondOrder::Blocked);
        found.undecided = described(SecondOrder::Undecided);
        let mut ids = mechanism.layout().constraint_ids();
        let moves = ids.any(|id| mechanism.prescribes_motion(id));
        // The second-order test does not apply to the motion that functions of time prescribe.
        Ok(restricted.exclude_all().filter(|all| !all || !moves))
    }
}

/// Returns whether the second order excludes every velocity of the mechanism without its drives.
/// The drives prevent these velocities at first order.
fn blocked_without_drives(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
) -> Result<Option<bool>, StateError> {
    let groups = mechanism.layout().groups.iter().enumerate();
    let joints: Vec<usize> = groups
        .filter(|(_, group)| !group.is_drive())
        .map(|(k, _)| k)
        .collect();
    if mechanism.layout().rows() > ROWS_MAX {
        return Ok(None);
    }
    let part = mechanism.part_of_groups(&joints);
    let own: Vec<f64> = part.places.coordinates.iter().map(|&k| q[k]).collect();
    let s = evaluated(&part.mechanism, t, &own);
    match decide(&part.mechanism, &s, &own) {
        Ok(decision) => is_locked(&part.mechanism, t, &own, &decision),
        Err(_) => Ok(None),
    }
}

impl Freedoms {
    /// Computes the free motions from the ranks of all rows, separately for each part.
    fn of(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        is_decided: bool,
        mut decided: Vec<PartRank>,
    ) -> Result<Self, StateError> {
        check_configuration(mechanism, t, q)?;
        let layout = mechanism.layout();
        let of = |drives: bool, decided: &[PartRank]| {
            let rank: usize = decided.iter().map(|part| part.rank).sum();
            let mobility = layout.n_v - rank;
            let motions = match (mobility, is_decided) {
                (0, _) => FreeMotions::default(),
                (_, true) => ConnectedSets::new(mechanism, drives).motions(t, q, decided),
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
            blocked: Vec::new(),
            undecided: Vec::new(),
            without_drives,
            cannot_move: (is_decided && least == 0 && !moves_joints).then_some(true),
            prevented_by: Vec::new(),
        })
    }
}

/// Returns the joints with nonholonomic rows.
fn rolling(mechanism: &Mechanism) -> Vec<ConstraintId> {
    let layout = mechanism.layout();
    let rolls = |id: &ConstraintId| layout.groups[id.0].rows.iter().any(|row| row >= layout.m);
    layout.constraint_ids().filter(rolls).collect()
}

#[cfg(test)]
mod tests;
