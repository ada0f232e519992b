//! Whether one-sided joints can all stay closed, along a motion whose rows are factored.

use linalg::kernels::max_abs;
use model::{ConstraintId, Mechanism, Scratch, System};

use crate::polyhedra::Unclear;
use crate::polyhedra::polyhedron::{Emptiness, HalfSpace, Polyhedron};

/// The one-sided joints of a mechanism.
pub struct CarriedContacts {
    /// Each joint with its row and the sign of its open gap.
    joints: Vec<(ConstraintId, usize, f64)>,
}

/// Whether one-sided joints can all stay closed at a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closure {
    /// The largest value of the smallest pressing force over all solutions (N, or N·s for
    /// impulses), negative if some joint must open; `None` if it has no limit or is not clear.
    pub depth: Option<f64>,
    /// Whether no solution presses on all joints, beyond rounding.
    pub is_open: bool,
    /// The joints that take part in opening, if they are clear.
    pub opening: Vec<ConstraintId>,
}

/// Returns the force of a one-sided joint for a multiplier of 1 of its gap. Its row of C is the
/// rate of the gap, multiplied by this number.
pub(super) fn pressing_force(mechanism: &Mechanism, scratch: &Scratch, id: ConstraintId) -> f64 {
    let map = mechanism.reactions(scratch).wrench_map(id);
    let force = mechanism.space().forces().map(|c| map[(c, 0)].powi(2));
    force.sum::<f64>().sqrt()
}

impl CarriedContacts {
    /// Returns the one-sided joints; `None` if there are none.
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Option<Self> {
        let layout = mechanism.layout();
        let joints = layout.constraint_ids().filter_map(|id| {
            let group = &layout.groups[id.0];
            Some((id, group.rows.row(0), group.limits.open_side?.sign()))
        });
        let joints: Vec<_> = joints.collect();
        (!joints.is_empty()).then_some(Self { joints })
    }

    /// Decides whether the joints can stay closed at the state of the scratch, in which C has been
    /// evaluated. `multipliers` is one solution (m + h) for forces or impulses, with the size of
    /// the loads, and `dependencies` contains one dependency of the rows of C for each redundant
    /// row (m + h each).
    #[must_use]
    pub fn closure(
        &self,
        (mechanism, scratch): (&Mechanism, &Scratch),
        (multipliers, loads): (&[f64], f64),
        dependencies: &[Vec<f64>],
    ) -> Closure {
        let p = dependencies.len();
        // Every direction of y has the same largest entry.
        let scales: Vec<f64> = dependencies.iter().map(|z| max_abs(z)).collect();
        let half_space = |&(id, row, sign): &(ConstraintId, usize, f64)| {
            let pressing = -sign * pressing_force(mechanism, scratch, id);
            let along = dependencies.iter().zip(&scales);
            HalfSpace {
                row: along.map(|(z, scale)| pressing * z[row] / scale).collect(),
                value: pressing * multipliers[row],
            }
        };
        let halves: Vec<HalfSpace> = self.joints.iter().map(half_space).collect();
        let pressed = halves.iter().map(|half| half.value.abs());
        let size = pressed.fold(loads, f64::max);
        let polyhedron = Polyhedron::new(p, &halves, if size > 0.0 { size } else { 1.0 });
        let (depth, is_open, weights) = match polyhedron.emptiness() {
            Ok(Emptiness::Points { depth }) => (*depth, false, &[][..]),
            Ok(Emptiness::Empty { weights, depth }) => (Some(*depth), true, &weights[..]),
            Err(Unclear::Depth(depth)) => (Some(depth), true, &[][..]),
            Err(_) => (None, false, &[][..]),
        };
        let opening = self.joints.iter().zip(weights);
        let opening = opening.filter(|(_, w)| **w > 0.0);
        Closure {
            depth,
            is_open,
            opening: opening.map(|((id, ..), _)| *id).collect(),
        }
    }
}
