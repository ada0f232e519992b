//! Independent coordinates z and velocities u. The constraint rows determine all other coordinates
//! and velocities, so the motion is an ordinary differential equation in z and u. The integrator
//! nevertheless integrates the vector y of all coordinates and velocities: `f(y) = F(P·y)`. Here P
//! completes a state from its independent entries. Therefore results, projections and output do not
//! depend on the partition into independent and dependent coordinates. Steps of explicit methods
//! need no projection. Implicit methods have a Jacobian without constraints ([`crate::run`]).
//!
//! The partition is constant during a step and its dense output, because f must not change during a
//! step. If the pivots of the partition have become small, a new partition is chosen at the
//! accepted state when the next step starts. Near a singular configuration no partition exists. A
//! step that needs a partition is then rejected.

use model::{Mechanism, System};

use super::dropped::check_positions;
use super::held::IndependentRotations;
use super::levels::{Moves, ProjectionStorage, correct_position};
use crate::error::MotionFault;
use crate::limits::{FAR_AT_REST, FAR_COMPLETION, FAR_EXTRAPOLATED, FAR_IN_A_STEP};
use crate::solve::{Evaluation, KeptEquations};

/// A partition into independent and dependent coordinates, and the last completed state.
pub(crate) struct IndependentCoordinates {
    pub(crate) partition: Partition,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    /// The last accepted state.
    accepted: Origin,
    /// Whether no step has started from the accepted state.
    is_fresh: bool,
    /// The configuration relative to which independent rotations are computed, and the number of
    /// earlier reference configurations.
    pub(crate) base: Vec<f64>,
    pub(crate) bases: u64,
    /// The state at which a new partition must be chosen, if a new partition is necessary.
    renewal: Option<Origin>,
    /// Work memory: a configuration before its completion (n_q values), and a correction (n_v
    /// values).
    guess: Vec<f64>,
    storage: ProjectionStorage,
}

/// The coordinates and velocities that are independent.
pub(crate) struct Partition {
    /// Columns of Φq whose coordinates are independent.
    pub(crate) z: Vec<usize>,
    /// Independent velocities.
    pub(crate) u: Vec<usize>,
    /// The state at which the partition was chosen.
    pub(crate) origin: Origin,
    /// Number of earlier partitions.
    pub(crate) generation: u64,
}

/// An accepted state.
#[derive(Clone)]
pub(crate) struct Origin {
    pub(crate) t: f64,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
}

impl IndependentCoordinates {
    /// Partitions the coordinates at the last evaluated pose. This pose must be the pose of
    /// `origin`.
    pub(super) fn new(
        equations: &mut KeptEquations<'_>,
        origin: Origin,
        before: Option<&Self>,
    ) -> Result<Self, MotionFault> {
        let at = &equations.at;
        let mechanism = at.mechanism;
        // Far from the origin of the frame, positions have fewer accurate digits than angles.
        let place = |j: usize| at.mechanism.space().position(&origin.q, j).abs();
        let far = |j: usize| (place(j) / at.mechanism.space().unit(j, at.size)).max(1.0);
        let z = equations.position.partition(at, far)?;
        let u = equations.velocity.partition(at, |_| 1.0)?;
        // Rows requested by the user are used only at single instants, without a partition.
        if let Some(requested) = &mut equations.requested_rows {
            requested.forget_partition();
        }
        let mut storage = ProjectionStorage::new(origin.v.len());
        storage.held = IndependentRotations::among(mechanism, &z, &origin.q);
        Ok(Self {
            is_fresh: false,
            base: origin.q.clone(),
            bases: before.map_or(0, |c| c.bases + 1),
            q: origin.q.clone(),
            v: origin.v.clone(),
            accepted: origin.clone(),
            guess: origin.q.clone(),
            storage,
            partition: Partition {
                z,
                u,
                origin,
                generation: before.map_or(0, |c| c.partition.generation + 1),
            },
            renewal: None,
        })
    }

    /// Uses the configuration in `y` as the initial value of the next completion.
    pub(crate) fn begin_from(&mut self, y: &[f64]) {
        let n_q = self.q.len();
        self.q.copy_from_slice(&y[..n_q]);
    }

    /// Completes a state by iteration. The initial value is the last completed state. If the
    /// iteration fails or ends too far away, it is repeated from the last accepted state, and then
    /// from the values of the integrator. In a mechanism without degrees of freedom the values of
    /// the integrator are used first, because only these values show how far the motion has
    /// advanced.
    pub(crate) fn complete(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<(), MotionFault> {
        let mechanism = equations.at.mechanism;
        let far = FAR_COMPLETION + FAR_EXTRAPOLATED * self.way_to(t, &equations.at);
        if self.partition.z.is_empty() {
            self.q.copy_from_slice(q);
        }
        self.take_independent(mechanism, q, v);
        let near = self.complete_from_here(equations, t, far);
        if near.is_ok() {
            return near;
        }
        self.q.copy_from_slice(&self.accepted.q);
        self.take_independent(mechanism, q, v);
        if self.complete_from_here(equations, t, far).is_ok() {
            return Ok(());
        }
        self.q.copy_from_slice(q);
        self.storage.held.keep(&mut self.q);
        if self
            .complete_from_here(equations, t, FAR_COMPLETION)
            .is_ok()
        {
            return Ok(());
        }
        // A failed completion is not a valid starting point.
        self.q.copy_from_slice(&self.accepted.q);
        near
    }

    /// Overwrites dependent coordinates and velocities. The rows are then factored at the result.
    fn complete_from_here(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        far: f64,
    ) -> Result<(), MotionFault> {
        self.guess.copy_from_slice(&self.q);
        let moves = Moves::DependentCoordinates;
        correct_position(equations, (t, &mut self.q), &mut self.storage, moves)?;
        let at = &equations.at;
        let moved = at
            .mechanism
            .largest_difference(&self.q, &self.guess, at.size);
        if moved.1 > far {
            return Err(at.far_completion(t, moved));
        }
        check_positions(equations)?;
        let KeptEquations { at, velocity, .. } = equations;
        velocity.factor(at)?;
        at.b();
        velocity.take_rhs(|i| at.s.b[i]);
        velocity.complete(at, &mut self.v)
    }

    /// Returns the longest displacement along a column of C from the last accepted state to time t,
    /// at the velocities of this state. The displacement is in units of the mechanism.
    fn way_to(&self, t: f64, at: &Evaluation<'_>) -> f64 {
        let velocities = self.accepted.v.iter().enumerate();
        let rates = velocities.map(|(j, v)| v.abs() / at.mechanism.space().unit(j, at.size));
        rates.fold(0.0, f64::max) * (t - self.accepted.t).abs()
    }

    /// Copies the independent entries of a state. The other entries keep the values of the last
    /// completed state. The integrator's values of these entries may have an error as large as a
    /// step. With such initial values, Newton's method may converge to another branch or another
    /// revolution. For unwrapped angles, only the number of revolutions is read from the
    /// integrator's values.
    fn take_independent(&mut self, mechanism: &Mechanism, q: &[f64], v: &[f64]) {
        mechanism.take(&mut self.q, q, &self.partition.z);
        self.storage.held.keep(&mut self.q);
        for &i in &self.partition.u {
            self.v[i] = v[i];
        }
    }

    /// Checks that an evaluated state (q, v) at the end of a step lies on the path that the
    /// velocities at both ends imply. A state on another branch or in another revolution fails the
    /// check.
    ///
    /// # Errors
    /// Returns [`MotionFault::FarCompletion`] in this case.
    pub(crate) fn check_travel(
        &mut self,
        at: &Evaluation<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
    ) -> Result<(), MotionFault> {
        let dt = t - self.accepted.t;
        let mut farthest = 0.0_f64;
        for (j, way) in self.storage.delta.iter_mut().enumerate() {
            let (from, to) = (self.accepted.v[j], v[j]);
            *way = 0.5 * dt * (from + to);
            farthest =
                farthest.max(dt * from.abs().max(to.abs()) / at.mechanism.space().unit(j, at.size));
        }
        self.guess.copy_from_slice(&self.accepted.q);
        at.mechanism.displace(&mut self.guess, &self.storage.delta);
        let off = at.mechanism.largest_difference(q, &self.guess, at.size);
        if off.1 <= FAR_IN_A_STEP * farthest + FAR_AT_REST {
            Ok(())
        } else {
            Err(at.far_completion(t, off))
        }
    }

    /// Accepts the state just evaluated, at time t. If the partition is ill-conditioned, a new
    /// partition is chosen from this state when the next step starts.
    pub(crate) fn accept(&mut self, t: f64, is_worn: bool) {
        self.accepted.t = t;
        self.accepted.q.copy_from_slice(&self.q);
        self.accepted.v.copy_from_slice(&self.v);
        self.is_fresh = true;
        if is_worn {
            self.renewal = Some(self.accepted.clone());
        }
    }

    /// Computes rotations relative to the accepted state from now on, if a step has started from
    /// this state. Rotations are not valid coordinates at half a turn away from their reference
    /// configuration.
    pub(crate) fn begin_step(&mut self, mechanism: &Mechanism, has_begun: impl Fn(f64) -> bool) {
        let held = &mut self.storage.held;
        if self.is_fresh && !held.is_empty() && has_begun(self.accepted.t) {
            self.is_fresh = false;
            self.base.copy_from_slice(&self.accepted.q);
            self.bases += 1;
            held.read_from(mechanism, &self.base);
        }
    }

    /// Returns the state at which a new partition must be chosen, if a step has started.
    /// `has_begun` decides whether a step has started, from the time of the accepted state.
    pub(crate) fn due(&self, has_begun: impl Fn(f64) -> bool) -> Option<Origin> {
        let due = self.renewal.as_ref();
        due.filter(|origin| has_begun(origin.t)).cloned()
    }
}
