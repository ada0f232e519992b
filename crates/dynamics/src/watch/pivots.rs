//! What the pivots of kept rows say of them, at freshly factored rows.

use crate::limits::{
    DELICATE, LARGE_COEFFICIENT, PARTITION_WORN, PIVOT_LOSS, PIVOT_RECOVERY, SOUND,
};
use crate::options::RowChoice;
use crate::solve::{Evaluation, KeptEquations, KeptRows};

/// Whether the motion is so near to a singular configuration that stages have to lie on the
/// constraints: off them by δ, accelerations are wrong by δ divided by the share of the reference
/// pivots that is left.
pub(crate) fn are_delicate(rows: &KeptRows) -> bool {
    rows.relative_pivot() < DELICATE
}

/// Whether another partition is due.
pub(crate) fn are_worn(equations: &KeptEquations<'_>) -> bool {
    let worn = |rows: &KeptRows| {
        let chosen = rows.partition_pivot();
        chosen.is_some_and(|chosen| rows.pivot_ratio() < PARTITION_WORN * chosen)
    };
    worn(&equations.velocity) || worn(&equations.position) || equations.requested_rows.is_some()
}

/// Whether rows of output are implied well: above this nobody looks for others.
pub(super) fn are_sound(rows: &KeptRows) -> bool {
    rows.relative_pivot() >= SOUND
}

/// Whether rows that were lost are as independent as before.
pub(super) fn are_recovered(rows: &KeptRows) -> bool {
    rows.relative_pivot() > PIVOT_RECOVERY
}

/// Whether other kept rows should be looked for. Rows that the user chose stay as long as they can.
pub(super) fn want_exchange(equations: &mut KeptEquations<'_>, choice: &RowChoice) -> bool {
    let (rows, at) = (&mut equations.velocity, &equations.at);
    are_lost(rows) || *choice == RowChoice::Automatic && are_poor(rows, at)
}

/// The same for the rows that hold the position, which nobody chooses. Projections that had nothing
/// to do have not factored them here.
pub(super) fn position_wants_exchange(equations: &mut KeptEquations<'_>) -> bool {
    let (rows, at) = (&mut equations.position, &equations.at);
    !rows.dropped.is_empty() && rows.factor(at).is_ok() && (are_lost(rows) || are_poor(rows, at))
}

/// Whether the rows have become nearly dependent since they were chosen, and there are others.
fn are_lost(rows: &KeptRows) -> bool {
    !rows.dropped.is_empty() && rows.relative_pivot() < PIVOT_LOSS
}

/// Whether the rows imply the dropped ones by large coefficients.
fn are_poor(rows: &mut KeptRows, at: &Evaluation<'_>) -> bool {
    !rows.dropped.is_empty() && rows.largest_coefficient(at) > LARGE_COEFFICIENT
}
