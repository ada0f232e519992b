//! Classification of freshly factored independent rows by their pivots.

use crate::limits::{
    DELICATE, LARGE_COEFFICIENT, PARTITION_WORN, PIVOT_LOSS, PIVOT_RECOVERY, SOUND, WORTH_EXCHANGE,
};
use crate::options::RowChoice;
use crate::solve::{Evaluation, KeptEquations, KeptRows};

/// Returns whether the motion is so close to a singular configuration that stages must satisfy the
/// constraints. A constraint violation δ causes an acceleration error of δ divided by the relative
/// pivot.
pub(crate) fn are_delicate(rows: &KeptRows) -> bool {
    rows.relative_pivot() < DELICATE
}

/// Returns whether a new partition is needed.
pub(crate) fn are_worn(equations: &KeptEquations<'_>) -> bool {
    let worn = |rows: &KeptRows| {
        let chosen = rows.partition_pivot();
        chosen.is_some_and(|chosen| rows.pivot_ratio() < PARTITION_WORN * chosen)
    };
    worn(&equations.velocity) || worn(&equations.position) || equations.requested_rows.is_some()
}

/// Returns whether the pivots are so large that output rows satisfy the redundant rows accurately.
/// In this case no other independent rows are considered for the output rows.
pub(super) fn are_sound(rows: &KeptRows) -> bool {
    rows.relative_pivot() >= SOUND
}

/// Returns whether the requested rows are as well-conditioned as before.
pub(super) fn are_recovered(rows: &KeptRows) -> bool {
    rows.relative_pivot() > PIVOT_RECOVERY
}

/// Returns whether other independent rows should be considered. Rows chosen by the user are used as
/// long as possible.
pub(super) fn want_exchange(equations: &mut KeptEquations<'_>, choice: &RowChoice) -> bool {
    let (rows, at) = (&mut equations.velocity, &equations.at);
    are_lost(rows) || *choice == RowChoice::Automatic && are_poor(rows, at)
}

/// Works like [`want_exchange`], for the rows that determine the position. The user does not choose
/// these rows. A projection without corrections does not factor them.
pub(super) fn position_wants_exchange(equations: &mut KeptEquations<'_>) -> bool {
    let (rows, at) = (&mut equations.position, &equations.at);
    !rows.dropped.is_empty() && rows.factor(at).is_ok() && (are_lost(rows) || are_poor(rows, at))
}

/// Returns whether the rows have become ill-conditioned since they were chosen, and whether other
/// rows exist.
pub(super) fn are_lost(rows: &KeptRows) -> bool {
    !rows.dropped.is_empty() && rows.relative_pivot() < PIVOT_LOSS
}

/// Returns whether the coefficients of the rows in the redundant rows are large, and have become
/// larger since a search found no better rows.
fn are_poor(rows: &mut KeptRows, at: &Evaluation<'_>) -> bool {
    if rows.dropped.is_empty() {
        return false;
    }
    let largest = rows.largest_coefficient(at);
    rows.unavoidable = rows.unavoidable.min(largest);
    largest > LARGE_COEFFICIENT.max(WORTH_EXCHANGE * rows.unavoidable)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Method;
    use crate::prepare;
    use crate::solve::Evaluation;
    use joints::{Line, PointOnLine};
    use model::{Body, Description, Mechanism, StartOptions};

    /// A beam on rollers at 0, ε and 1. The last row is redundant: `row 2 = (1 − 1/ε)·row 0 +
    /// 1/ε·row 1`.
    #[test]
    fn rows_that_multiply_their_rounding_are_exchanged() {
        for (epsilon, wants) in [(0.2, false), (0.05, true)] {
            let mut d = Description::new("beam");
            let beam = d.body(Body::new("beam", 1.0, 1.0));
            let line = Line::new([0.0; 2], [1.0, 0.0]).expect("a line");
            for (name, x) in [("left", 0.0), ("middle", epsilon), ("right", 1.0)] {
                d.joint(name, &[beam], PointOnLine { s: [x, 0.0], line });
            }
            let mechanism = Mechanism::build(&d).expect("builds");
            let choice = RowChoice::Drop(vec![2]);
            let p = prepare(mechanism, &StartOptions::default(), &choice).expect("starts");
            let at = Evaluation::new(&p.mechanism, p.assembly.size);
            let [velocity, position] = [&p.decision, &p.position_decision]
                .map(|rows| KeptRows::new(&at, rows, p.solver_needs(Method::Auto)))
                .map(|rows| rows.expect("two rows"));
            let mut equations = KeptEquations::new(at, velocity, position);
            equations.factor_at(0.0, &p.q).expect("independent rows");
            let found = want_exchange(&mut equations, &RowChoice::Automatic);
            assert_eq!(found, wants, "{epsilon}");
            // A search without a result is not repeated immediately.
            let rows = &mut equations.velocity;
            rows.unavoidable = rows.largest_coefficient(&equations.at);
            assert!(!want_exchange(&mut equations, &RowChoice::Automatic));
        }
    }
}
