//! Whether contacts can all stay closed and hold, along a motion whose rows are factored.

use linalg::kernels::{dot, max_abs, norm};
use model::{ConstraintId, GripLoad, Mechanism, Scratch, System};

use super::conditions::{GripConditions, LoadNumber, Polygon, slip_terms};
use crate::polyhedra::Unclear;
use crate::polyhedra::polyhedron::{Emptiness, Extremum, HalfSpace, Polyhedron};

/// The one-sided joints of a mechanism, and its contacts that grip.
pub struct CarriedContacts {
    /// Each one-sided joint with its row and the sign of its open gap.
    joints: Vec<(ConstraintId, usize, f64)>,
    grips: Vec<CarriedGrip>,
}

/// A contact that grips.
struct CarriedGrip {
    joint: ConstraintId,
    friction: f64,
    /// The force N that presses the contact: a constant, or that of a one-sided joint.
    load: Result<f64, usize>,
}

/// Whether contacts can all stay closed and hold at a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closure {
    /// Whether no solution keeps all contacts closed and holding, beyond rounding.
    pub is_lost: bool,
    /// The one-sided joints that take part in opening, if these are clear.
    pub opening: Vec<ConstraintId>,
    /// The contacts that take part in slipping, if these are clear and no joint opens.
    pub slipping: Vec<ConstraintId>,
}

impl Closure {
    /// Returns whether the contacts that open or slip are clear.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        !self.opening.is_empty() || !self.slipping.is_empty()
    }
}

/// Returns the force of a one-sided joint for a multiplier of 1 of its gap. The row of C that
/// belongs to the gap, multiplied by this number, is the rate of the gap.
pub(super) fn pressing_force(mechanism: &Mechanism, scratch: &Scratch, id: ConstraintId) -> f64 {
    let map = mechanism.reactions(scratch).wrench_map(id);
    let force = mechanism.space().forces().map(|c| map[(c, 0)].powi(2));
    force.sum::<f64>().sqrt()
}

impl CarriedContacts {
    /// Returns the contacts with a condition, or `None` if there are no such contacts.
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Option<Self> {
        let layout = mechanism.layout();
        let joints = layout.constraint_ids().filter_map(|id| {
            let group = &layout.groups[id.0];
            Some((id, group.rows.row(0), group.limits.open_side?.sign()))
        });
        let joints: Vec<_> = joints.collect();
        let presser =
            |is: &dyn Fn(ConstraintId) -> bool| joints.iter().position(|(id, ..)| is(*id));
        let grips = layout.constraint_ids().filter_map(|joint| {
            let grip = layout.groups[joint.0].limits.grip.as_ref()?;
            let load = match &grip.load {
                GripLoad::Constant(load) => Ok(*load),
                GripLoad::Own => Err(presser(&|id| id == joint)?),
                GripLoad::Joint(name) => Err(presser(&|id| layout.groups[id.0].name == *name)?),
            };
            Some(CarriedGrip {
                joint,
                friction: grip.friction,
                load,
            })
        });
        let grips: Vec<CarriedGrip> = grips.collect();
        let is_any = !joints.is_empty() || !grips.is_empty();
        is_any.then_some(Self { joints, grips })
    }

    /// Returns whether one solution presses on all joints and makes no contact slip at the state of
    /// the scratch, so that no search is needed.
    #[must_use]
    pub fn are_kept(&self, mechanism: &Mechanism, s: &Scratch, multipliers: &[f64]) -> bool {
        let pressing = |&(id, row, sign): &(ConstraintId, usize, f64)| {
            -sign * pressing_force(mechanism, s, id) * multipliers[row]
        };
        let holds = |grip: &CarriedGrip| {
            let load = grip.load.unwrap_or_else(|k| pressing(&self.joints[k]));
            let along = slip_terms(mechanism, s, grip.joint);
            let along = along.iter().map(|terms| value(terms, multipliers));
            norm(&along.collect::<Vec<_>>()) <= grip.friction * load
        };
        self.joints.iter().all(|joint| pressing(joint) >= 0.0) && self.grips.iter().all(holds)
    }

    /// Returns the loads that the joints permit at the state of the scratch, in which C has been
    /// evaluated. `multipliers` is one solution (m + h) for forces or impulses, with the size of
    /// the loads, and `dependencies` contains one dependency of the rows of C for each redundant
    /// row (m + h each).
    #[must_use]
    pub fn permitted<'a>(
        &'a self,
        (mechanism, scratch): (&'a Mechanism, &'a Scratch),
        (multipliers, loads): (&'a [f64], f64),
        dependencies: &'a [Vec<f64>],
    ) -> CarriedLoads<'a> {
        // Every direction of y has the same largest entry.
        let directions = dependencies.iter().map(|z| (&z[..], max_abs(z)));
        let mut carried = CarriedLoads {
            contacts: self,
            at: (mechanism, scratch),
            multipliers,
            directions: directions.collect(),
            presses: Vec::new(),
            size: 1.0,
            polyhedron: Polyhedron::new(0, &[], 1.0),
        };
        let press = |&(id, row, sign): &(ConstraintId, usize, f64)| {
            carried.number(&[(row, -sign * pressing_force(mechanism, scratch, id))])
        };
        carried.presses = self.joints.iter().map(press).collect();
        let pressed = carried.presses.iter().map(|press| press.value.abs());
        let size = pressed.fold(loads, f64::max);
        carried.size = if size > 0.0 { size } else { 1.0 };
        let halves: Vec<HalfSpace> = carried
            .presses
            .iter()
            .map(LoadNumber::as_half_space)
            .collect();
        carried.polyhedron = Polyhedron::new(carried.directions.len(), &halves, carried.size);
        carried
    }
}

/// Returns a number with these coefficients of the multipliers.
fn value(terms: &[(usize, f64)], multipliers: &[f64]) -> f64 {
    terms.iter().map(|(row, c)| c * multipliers[*row]).sum()
}

/// The loads that one-sided joints permit at a state, whether or not contacts slip.
pub struct CarriedLoads<'a> {
    contacts: &'a CarriedContacts,
    at: (&'a Mechanism, &'a Scratch),
    multipliers: &'a [f64],
    /// The dependencies, each with its largest entry.
    directions: Vec<(&'a [f64], f64)>,
    /// The forces with which the joints press.
    presses: Vec<LoadNumber>,
    size: f64,
    polyhedron: Polyhedron,
}

impl CarriedLoads<'_> {
    /// Returns a number with these coefficients of the multipliers.
    fn number(&self, terms: &[(usize, f64)]) -> LoadNumber {
        let along = self.directions.iter();
        LoadNumber {
            row: along.map(|(z, scale)| value(terms, z) / scale).collect(),
            value: value(terms, self.multipliers),
        }
    }

    /// Returns whether the joints can stay closed.
    #[must_use]
    pub fn opening(&self) -> Closure {
        let (is_lost, weights) = lost(&self.polyhedron);
        let opening = self.contacts.joints.iter().zip(weights);
        let opening = opening.filter(|(_, w)| **w > 0.0);
        Closure {
            is_lost,
            opening: opening.map(|((id, ..), _)| *id).collect(),
            slipping: Vec::new(),
        }
    }

    /// Returns whether the joints can stay closed, and the contacts that grip can hold.
    #[must_use]
    pub fn closure(&self) -> Closure {
        let opening = self.opening();
        let grips = &self.contacts.grips;
        if opening.is_lost || grips.is_empty() {
            return opening;
        }
        let mut halves: Vec<HalfSpace> =
            self.presses.iter().map(LoadNumber::as_half_space).collect();
        let mut of_half = vec![None; halves.len()];
        for grip in grips {
            let conditions = self.conditions(grip);
            let mut own = conditions.half_spaces(grip.friction, Polygon::Outer);
            own.extend(conditions.tangent());
            of_half.extend(vec![Some(grip.joint); own.len()]);
            halves.extend(own);
        }
        let polyhedron = Polyhedron::new(self.directions.len(), &halves, self.size);
        let (is_lost, weights) = lost(&polyhedron);
        let slipping = of_half.iter().zip(weights).filter(|(_, w)| **w > 0.0);
        let mut slipping: Vec<ConstraintId> = slipping.filter_map(|(id, _)| *id).collect();
        slipping.dedup();
        Closure {
            is_lost,
            opening: Vec::new(),
            slipping,
        }
    }

    /// Returns the conditions of a contact that grips.
    fn conditions(&self, grip: &CarriedGrip) -> GripConditions {
        let (mechanism, s) = self.at;
        let constant = |value| LoadNumber {
            row: vec![0.0; self.directions.len()],
            value,
        };
        let slip = slip_terms(mechanism, s, grip.joint);
        GripConditions {
            joint: grip.joint,
            friction: grip.friction,
            load: grip.load.map_or_else(|k| self.presses[k].clone(), constant),
            slip: slip.iter().map(|terms| self.number(terms)).collect(),
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

/// Returns whether half spaces have no common point, or perhaps no common point, with the weights
/// that prove it.
fn lost(of: &Polyhedron) -> (bool, &[f64]) {
    match of.emptiness() {
        Ok(Emptiness::Empty { weights, .. }) => (true, weights),
        Err(Unclear::Depth(_)) => (true, &[]),
        Ok(Emptiness::Points { .. }) | Err(_) => (false, &[]),
    }
}
