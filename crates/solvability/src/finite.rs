//! Decides whether finite reactions exist.
//!
//! `M·a + Cᵀ·λ = Q` and `C·a = Γ` are equations of first order. Here a is the acceleration that the
//! loads cause along the velocities with `C·v = 0`. From rest, a motion begins as `q(t) = q +
//! ½·a·t² + …`, so its acceleration satisfies the equations of second order, `z·Γ(a) = 0` for every
//! z of the left null space. If the acceleration a does not satisfy these equations, no motion has
//! these reactions. For example, two bars in line between two pins cannot sag, and no finite force
//! supports a load across them. If the pins are slightly out of line, the bars support the load
//! with forces that grow without bound as the sag vanishes.
//!
//! The result applies to all joints of a set of connected bodies, because the acceleration of each
//! of these bodies is wrong. For moving bodies, and for bodies moved by functions of time, the
//! equations of second order contain further terms. The result for such bodies is undecided if a
//! freedom is restricted.

use model::{ConstraintId, InertiaAt, Mechanism, System};
use rank::RankDecision;

use crate::choices::{Solution, solution};
use crate::freedoms::motions_among;
use crate::limits::{AT_REST_SPEED, PUSHES, ROUNDING_PUSH};
use crate::pose::{evaluated, velocity_units};
use crate::row_decision::RowDecision;
use crate::second_order::{AccelerationVerdict, RestrictedVelocities, SecondOrder, restrictions};
use crate::state::{StateError, check_state};
use crate::value::NoFiniteReaction;

/// Returns the sets of connected bodies whose reactions have no finite value at time t, coordinates
/// q and velocities v, which must satisfy the constraints. The list is empty if the rank is
/// undecided, or if the equations of motion have no solution.
///
/// # Errors
/// The function returns an error if the state has the wrong number of values, or if a value is not
/// finite.
pub fn no_finite_reactions(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    decision: &RankDecision,
) -> Result<Vec<NoFiniteReaction>, StateError> {
    check_state(mechanism, t, q, v)?;
    let found = restrictions(mechanism, t, q, decision)?;
    if found.restricted.is_empty() {
        return Ok(Vec::new());
    }
    let Ok(Solution { acceleration, .. }) =
        solution(mechanism, (t, q, v), &RowDecision::from(decision))
    else {
        return Ok(Vec::new());
    };
    let at = Instant::of(mechanism, (t, q, v), acceleration);
    let sets = found.restricted.iter();
    sets.filter_map(|set| at.set(set).transpose()).collect()
}

/// Accelerations and loads at one instant.
struct Instant<'a> {
    mechanism: &'a Mechanism,
    t: f64,
    q: &'a [f64],
    v: &'a [f64],
    units: Vec<f64>,
    acceleration: Vec<f64>,
    inertia: InertiaAt<'a>,
    /// Generalised forces of each load, n_v values.
    loads: Vec<(String, Vec<f64>)>,
}

impl<'a> Instant<'a> {
    fn of(
        mechanism: &'a Mechanism,
        (t, q, v): (f64, &'a [f64], &'a [f64]),
        acceleration: Vec<f64>,
    ) -> Self {
        let mut s = evaluated(mechanism, t, q);
        mechanism.twist(v, &mut s);
        let mut loads = vec![("gravity".to_owned(), mechanism.weight().to_vec())];
        let forces = mechanism.applied_forces().parts(&mut s);
        loads.extend(forces.map(|(name, force)| (format!("`{name}`"), force)));
        Self {
            mechanism,
            t,
            q,
            v,
            units: velocity_units(mechanism, model::start::scene_size(mechanism, q)),
            acceleration,
            inertia: mechanism.inertia_at(q),
            loads,
        }
    }

    /// Returns the report on the reactions of a set of bodies, or `None` if the reactions are
    /// finite.
    fn set(&self, set: &RestrictedVelocities) -> Result<Option<NoFiniteReaction>, StateError> {
        let groups = self.groups(set);
        let prescribed = groups
            .iter()
            .any(|id| self.mechanism.prescribes_motion(*id));
        if prescribed || self.is_moving(set) {
            return if set.second_order == SecondOrder::Free {
                Ok(None)
            } else {
                let mut loads = self.pushing(&set.velocities);
                loads.push("inertia".to_owned());
                self.told(groups, &set.velocities, loads, false).map(Some)
            };
        }
        let acceleration: Vec<f64> = self.scaled(&self.acceleration);
        let along: Vec<f64> = set
            .velocities
            .iter()
            .map(|w| dot(&self.scaled(w), &acceleration))
            .collect();
        let across = set.velocities.iter().zip(&along);
        let excluded = across.fold(vec![0.0; self.units.len()], |mut sum, (w, x)| {
            sum.iter_mut().zip(w).for_each(|(sum, w)| *sum += x * w);
            sum
        });
        if !self.pushes(&excluded) {
            return Ok(None);
        }
        let loads = self.pushing(std::slice::from_ref(&excluded));
        let decided = match set.accelerated(&along) {
            AccelerationVerdict::Possible => return Ok(None),
            AccelerationVerdict::Excluded => true,
            AccelerationVerdict::Undecided => false,
        };
        self.told(groups, &[excluded], loads, decided).map(Some)
    }

    fn scaled(&self, v: &[f64]) -> Vec<f64> {
        v.iter().zip(&self.units).map(|(v, u)| v / u).collect()
    }

    /// Returns the joints and drives of the bodies of a set.
    fn groups(&self, set: &RestrictedVelocities) -> Vec<ConstraintId> {
        let layout = self.mechanism.layout();
        let is_own = |id: &ConstraintId| {
            let bodies = layout.groups[id.0].bodies.iter();
            let mut moving = bodies.filter_map(|b| b.moving());
            moving.any(|b| set.bodies.binary_search(&b).is_ok())
        };
        layout.constraint_ids().filter(is_own).collect()
    }

    fn is_moving(&self, set: &RestrictedVelocities) -> bool {
        let space = self.mechanism.space();
        let mut columns = set.bodies.iter().flat_map(|&b| space.columns_of(b));
        columns.any(|j| (self.v[j] / self.units[j]).abs() > AT_REST_SPEED)
    }

    /// Returns whether the component of the acceleration along the restricted velocities, w,
    /// exceeds the rounding of the loads: `wᵀ·M·w = wᵀ·(Q − M·(a − w))`.
    fn pushes(&self, w: &[f64]) -> bool {
        let own = self.inertia.between(w, w);
        own > PUSHES * (self.load_terms(w) + self.inertia_terms(w)) + self.rounding(w)
    }

    /// Returns the largest power along w that is rounding of loads of this size. If w itself is
    /// rounding, the terms of the power are rounding, too.
    fn rounding(&self, w: &[f64]) -> f64 {
        let mut inertia = vec![0.0; w.len()];
        self.inertia.add_sizes(&self.acceleration, &mut inertia);
        let of_column = |j: usize| {
            let loads = self.loads.iter().map(|(_, force)| force[j].abs());
            let all: f64 = loads.sum::<f64>() + inertia[j];
            all * self.units[j]
        };
        let load = (0..w.len()).map(of_column).fold(0.0, f64::max);
        let size = self.scaled(w).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        ROUNDING_PUSH * size * load
    }

    fn load_terms(&self, w: &[f64]) -> f64 {
        self.loads.iter().map(|(_, force)| terms(force, w)).sum()
    }

    fn inertia_terms(&self, w: &[f64]) -> f64 {
        let left = self.acceleration.iter().zip(w).map(|(a, w)| a - w);
        let mut inertia = vec![0.0; w.len()];
        self.inertia
            .add_sizes(&left.collect::<Vec<f64>>(), &mut inertia);
        terms(&inertia, w)
    }

    /// Returns the loads with a power along one of these velocities.
    fn pushing(&self, velocities: &[Vec<f64>]) -> Vec<String> {
        let pushes = |force: &Vec<f64>| {
            velocities.iter().any(|w| {
                let all = self.load_terms(w) + self.inertia_terms(w);
                dot(force, w).abs() > PUSHES * all + self.rounding(w)
            })
        };
        let loads = self.loads.iter().filter(|(_, force)| pushes(force));
        let mut names: Vec<String> = loads.map(|(name, _)| name.clone()).collect();
        if names.is_empty() {
            names.push("inertia".to_owned());
        }
        names
    }

    fn told(
        &self,
        reactions: Vec<ConstraintId>,
        velocities: &[Vec<f64>],
        mut loads: Vec<String>,
        decided: bool,
    ) -> Result<NoFiniteReaction, StateError> {
        loads.dedup();
        let motions = motions_among(self.mechanism, self.t, self.q, velocities)?;
        let motions: Vec<String> = motions.into_iter().map(|motion| motion.text).collect();
        let groups = &self.mechanism.layout().groups;
        let rows = reactions.iter().flat_map(|id| &groups[id.0].rows);
        let mut rows: Vec<usize> = rows.collect();
        rows.sort_unstable();
        Ok(NoFiniteReaction {
            reactions,
            rows,
            freedom: motions.join("; "),
            loads,
            decided,
        })
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn terms(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum()
}
