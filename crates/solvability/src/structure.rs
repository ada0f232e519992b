//! What the shape of a mechanism settles before any rank: reactions that are unique because of where they act, and parts that can
//! be judged alone. No verdict needs this; it says why some are no surprise, and where the work is.

use linalg::{RankError, RowGroup, Settled, Structure};
use model::start::scene_size;
use model::{Mechanism, Scratch, System};

use crate::explain::ExplanationError;
use crate::matrices::{QueryError, Solvability};
use crate::mechanism::{dimensionless, uncertainty};
use crate::verdict::Judgement;

/// Groups of the structure are joints and drives in the order of their rows, blocks are bodies. The scratch must hold Φ and C at
/// coordinates q.
///
/// # Errors
/// If C is not finite.
pub fn structure(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> Result<Structure, RankError> {
    let layout = mechanism.layout();
    let size = scene_size(mechanism, q);
    let group = |id: model::ConstraintId| RowGroup {
        rows: layout.groups[id.0].rows.clone(),
        ground: mechanism.acts_on_ground(id, s),
    };
    let groups: Vec<RowGroup> = mechanism.constraint_ids().map(group).collect();
    let bodies = 0..mechanism.bodies().len();
    let blocks: Vec<_> = bodies.map(|b| layout.columns(b)).collect();
    linalg::structure(
        &dimensionless(mechanism, s, size),
        &uncertainty(mechanism, s, q, size),
        &groups,
        &blocks,
    )
}

/// The wrench of every joint and drive, each judged in its own open part; `None` where the structure settles it, as unique.
///
/// # Errors
/// If C is not finite.
pub fn judge_parts(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    structure: &Structure,
) -> Result<Vec<Option<Judgement>>, ExplanationError> {
    let size = scene_size(mechanism, q);
    let c = dimensionless(mechanism, s, size);
    let known = uncertainty(mechanism, s, q, size);
    let parts: Vec<Solvability> = structure
        .open
        .iter()
        .map(|part| Solvability::of(&c.select_rows(&part.rows), &known.select_rows(&part.rows)))
        .collect::<Result<_, RankError>>()?;
    let judge = |group: usize| match structure.groups[group] {
        Settled::Open(k) => {
            let rows = &structure.open[k].rows;
            let own = &mechanism.layout().groups[group].rows;
            // Rows of a part ascend, so those of one group stand together.
            let first = rows.partition_point(|row| *row < own.start);
            let end = rows.partition_point(|row| *row < own.end);
            parts[k].group(first..end).map(Some)
        }
        Settled::Peeled | Settled::Bridge => Ok(None),
    };
    let judged = (0..structure.groups.len()).map(judge);
    Ok(judged.collect::<Result<_, QueryError>>()?)
}
