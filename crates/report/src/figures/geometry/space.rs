//! The kind of relative motion that a joint in space allows, derived from the forces and torques of
//! its rows.

#[cfg(test)]
mod tests;

use linalg::Matrix;
use model::ConstraintKind;
use model::reaction::ConstraintGroup;
use model::space::{cross, norm};

use crate::figures::projection::unit;
use crate::figures::symbol::Symbol;

/// Components of unit forces and torques below this value are rounding errors. In the rows of joint
/// definitions, forces are along unit vectors and torques are about unit vectors. The lever arms
/// are accurate to ten digits.
const ROUNDING: f64 = 1e-6;

/// The symbol of a joint or drive whose rows have these wrenches (N, N·m) about the reference
/// point. `arm` is the vector to the second point, about which the joint rotates.
pub(super) fn symbol(group: &ConstraintGroup, wrenches: &Matrix, arm: [f64; 3]) -> Symbol {
    let rows = 0..group.rows.len();
    let part = |first: usize, row: usize| [0, 1, 2].map(|k| wrenches[(first + k, row)]);
    let forces = Span::of(rows.clone().map(|row| part(0, row)));
    let torques = Span::of(rows.map(|row| {
        let (about, carried) = (part(3, row), cross(arm, part(0, row)));
        [0, 1, 2].map(|k| about[k] - carried[k])
    }));
    let is_held = group.rows.len() >= 6;
    match (group.kind, &forces.0[..], &torques.0[..]) {
        (ConstraintKind::Drive, &[force, ..], _) => Symbol::Drive { axis: Some(force) },
        (ConstraintKind::Drive, [], &[axis]) => Symbol::Turn { axis },
        (ConstraintKind::Drive, ..) => Symbol::Drive { axis: None },
        _ if group.spec.nonholonomic() > 0 => Symbol::Pin,
        (_, [], _) => Symbol::Rotation,
        (_, &[a, b], [_, _, _]) => Symbol::Block { axis: cross(a, b) },
        (_, &[a, b], _) => Symbol::Slot { axis: cross(a, b) },
        (_, _, &[a, b]) => Symbol::Hinge { axis: cross(a, b) },
        (_, [_, _, _], [_, _, _]) if is_held => Symbol::Weld,
        _ => Symbol::Pin,
    }
}

/// Orthogonal unit vectors that span a set of directions.
struct Span(Vec<[f64; 3]>);

impl Span {
    fn of(vectors: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut span: Vec<[f64; 3]> = Vec::new();
        for v in vectors {
            let mut rest = v;
            for known in &span {
                let along: f64 = (0..3).map(|k| known[k] * rest[k]).sum();
                rest = [0, 1, 2].map(|k| rest[k] - along * known[k]);
            }
            if norm(&rest) > ROUNDING * norm(&v).max(1.0) {
                span.extend(unit(rest));
            }
        }
        Self(span)
    }
}
