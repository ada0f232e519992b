//! Reactions that are unique because of the structure of the mechanism, independent of any rank
//! decision. Verdicts do not use this analysis, but the analysis contains the reasons of some
//! verdicts.

use crate::pose::{dimensionless, uncertainty};
use model::start::scene_size;
use model::{Mechanism, Scratch, System};
use rank::{RankError, RowGroup, Structure};

/// Analyses the structure. The groups of the structure are joints and drives in the order of the
/// layout, and its blocks are bodies. The scratch must contain Φ and C at coordinates q.
///
/// # Errors
/// Returns an error if C is not finite.
pub fn structure(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> Result<Structure, RankError> {
    let layout = mechanism.layout();
    let size = scene_size(mechanism, q);
    let group = |id: model::ConstraintId| RowGroup {
        rows: layout.groups[id.0].rows.iter().collect(),
        ground: mechanism.reactions(s).acts_on_ground(id),
    };
    let groups: Vec<RowGroup> = mechanism.layout().constraint_ids().map(group).collect();
    let bodies = 0..mechanism.bodies().len();
    let blocks: Vec<_> = bodies.map(|b| layout.columns(b)).collect();
    rank::structure(
        &dimensionless(mechanism, s, size),
        &uncertainty(mechanism, s, size),
        &groups,
        &blocks,
    )
}
