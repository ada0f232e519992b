//! Whether one-sided joints can all stay closed along a motion whose rows are factored.

use linalg::kernels::{dot, max_abs};
use model::{ConstraintId, Mechanism, Scratch, System};

use crate::polyhedra::Unclear;
use crate::polyhedra::polyhedron::{Emptiness, Extremum, HalfSpace, Polyhedron};

/// The one-sided joints of a mechanism.
pub struct CarriedContacts {
    /// Each joint with its row and the sign of its open gap.
    joints: Vec<(ConstraintId, usize, f64)>,
}

/// Whether one-sided joints can all stay closed at a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closure {
    /// Whether no solution presses on all joints, beyond rounding.
    pub is_open: bool,
    /// The joints that take part in opening, if these are clear.
    pub opening: Vec<ConstraintId>,
}

/// Returns the force of a one-sided joint for a multiplier of 1 of its gap. The row of C that
/// belongs to the gap, multiplied by this number, is the rate of the gap.
pub(super) fn pressing_force(mechanism: &Mechanism, scratch: &Scratch, id: ConstraintId) -> f64 {
    let map = mechanism.reactions(scratch).wrench_map(id);
    let force = mechanism.space().forces().map(|c| map[(c, 0)].powi(2));
    force.sum::<f64>().sqrt()
}

impl CarriedContacts {
    /// Returns the one-sided joints, or `None` if there are no such joints.
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

    /// Returns whether one solution presses on all joints at the state of the scratch, so that no
    /// search is needed.
    #[must_use]
    pub fn are_pressed(&self, mechanism: &Mechanism, s: &Scratch, multipliers: &[f64]) -> bool {
        let presses = |&(id, row, sign): &(ConstraintId, usize, f64)| {
            -sign * pressing_force(mechanism, s, id) * multipliers[row] >= 0.0
        };
        self.joints.iter().all(presses)
    }

    /// Returns the loads that the joints permit at the state of the scratch, in which C has been
    /// evaluated. `multipliers` is one solution (m + h) for forces or impulses, with the size of
    /// the loads, and `dependencies` contains one dependency of the rows of C for each redundant
    /// row (m + h each).
    #[must_use]
    pub fn permitted<'a>(
        &'a self,
        (mechanism, scratch): (&Mechanism, &Scratch),
        (multipliers, loads): (&'a [f64], f64),
        dependencies: &'a [Vec<f64>],
    ) -> CarriedLoads<'a> {
        // Every direction of y has the same largest entry.
        let directions = dependencies.iter().map(|z| (&z[..], max_abs(z)));
        let directions: Vec<(&[f64], f64)> = directions.collect();
        let half_space = |&(id, row, sign): &(ConstraintId, usize, f64)| {
            let pressing = -sign * pressing_force(mechanism, scratch, id);
            let along = directions.iter();
            HalfSpace {
                row: along.map(|(z, scale)| pressing * z[row] / scale).collect(),
                value: pressing * multipliers[row],
            }
        };
        let halves: Vec<HalfSpace> = self.joints.iter().map(half_space).collect();
        let pressed = halves.iter().map(|half| half.value.abs());
        let size = pressed.fold(loads, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };
        CarriedLoads {
            joints: &self.joints,
            multipliers,
            polyhedron: Polyhedron::new(directions.len(), &halves, size),
            directions,
        }
    }
}

/// The loads that one-sided joints permit at a state, whether or not contacts slip.
pub struct CarriedLoads<'a> {
    joints: &'a [(ConstraintId, usize, f64)],
    multipliers: &'a [f64],
    /// The dependencies, each with its largest entry.
    directions: Vec<(&'a [f64], f64)>,
    polyhedron: Polyhedron,
}

impl CarriedLoads<'_> {
    /// Returns whether the joints can stay closed.
    #[must_use]
    pub fn closure(&self) -> Closure {
        let (is_open, weights) = match self.polyhedron.emptiness() {
            Ok(Emptiness::Empty { weights, .. }) => (true, &weights[..]),
            Err(Unclear::Depth(_)) => (true, &[][..]),
            Ok(Emptiness::Points { .. }) | Err(_) => (false, &[][..]),
        };
        let opening = self.joints.iter().zip(weights);
        let opening = opening.filter(|(_, w)| **w > 0.0);
        Closure {
            is_open,
            opening: opening.map(|((id, ..), _)| *id).collect(),
        }
    }

    /// Returns the lowest and the highest value of a number with these coefficients of the
    /// multipliers, infinite without a limit; `None` if the joints open, or if the answer is not
    /// clear.
    #[must_use]
    pub fn range(&self, coefficients: &[f64]) -> Option<[f64; 2]> {
        let along = self.directions.iter();
        let row: Vec<f64> = along
            .map(|(z, scale)| dot(coefficients, z) / scale)
            .collect();
        let value = dot(coefficients, self.multipliers);
        let found = self.polyhedron.range(&row, value).ok()??;
        let [lowest, highest] = found.ends.map(|end| match end {
            Extremum::Finite { value, .. } => Some(value),
            Extremum::Infinite { .. } => None,
        });
        Some([
            lowest.unwrap_or(f64::NEG_INFINITY),
            highest.unwrap_or(f64::INFINITY),
        ])
    }
}
