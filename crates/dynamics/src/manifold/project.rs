//! Projection onto the constraints, positions first, both levels by the smallest correction in the
//! mass metric; or no projection, and what a state then misses.

use model::System;

use super::coordinates::{IndependentCoordinates, Origin};
use super::dropped::{Correction, monitor};
use super::levels::{Moves, Storage, correct_position, correct_velocity, largest};
use crate::error::MotionFault;
use crate::options::Stabilisation;
use crate::solve::{Evaluation, KeptEquations};

/// The way of a motion along its constraints.
pub(crate) struct Manifold {
    /// Independent coordinates, where the motion is one of these alone.
    pub(crate) coordinates: Option<IndependentCoordinates>,
    stabilisation: Stabilisation,
    /// How long the run lasts (s); infinite where nobody has said, and where it takes no time:
    /// nothing may part then.
    horizon: f64,
    storage: Storage,
}

impl Manifold {
    pub(crate) fn new(at: &Evaluation<'_>, stabilisation: Stabilisation, horizon: f64) -> Self {
        Self {
            coordinates: None,
            stabilisation,
            horizon,
            storage: Storage::new(at.mechanism.mass().len()),
        }
    }

    /// Whether states are moved onto the constraints. On independent coordinates they always are.
    pub(crate) fn projects(&self) -> bool {
        self.coordinates.is_some() || self.stabilisation == Stabilisation::Projection
    }

    /// From now on the motion is one of independent coordinates, chosen at the pose of the scratch,
    /// which is that of the origin.
    pub(crate) fn choose_coordinates(
        &mut self,
        equations: &mut KeptEquations<'_>,
        origin: Origin,
    ) -> Result<(), MotionFault> {
        let chosen = IndependentCoordinates::new(equations, origin, self.coordinates.as_ref())?;
        self.coordinates = Some(chosen);
        Ok(())
    }

    /// Moves q onto the constraints and factors there; how many corrections that took.
    pub(crate) fn settle(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        q: &mut [f64],
    ) -> Result<usize, MotionFault> {
        let moves = Moves::AllCoordinates;
        let corrections = correct_position(equations, (t, q), &mut self.storage, moves)?;
        equations.velocity.factor(&equations.at)?;
        Ok(corrections)
    }

    /// Completes a state on independent coordinates and settles its position. What the corrections
    /// leave to do after a completion is rounding.
    pub(crate) fn settle_completed(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<usize, MotionFault> {
        if let Some(coordinates) = &mut self.coordinates {
            coordinates.complete(equations, t, q, v)?;
            q.copy_from_slice(&coordinates.q);
            v.copy_from_slice(&coordinates.v);
        }
        self.settle(equations, t, q)
    }

    /// Moves v onto the constraints at a settled position and looks at all residuals.
    pub(crate) fn finish(
        &mut self,
        equations: &mut KeptEquations<'_>,
        v: &mut [f64],
        iterations: usize,
    ) -> Result<Correction, MotionFault> {
        let left = correct_velocity(equations, v, &mut self.storage)?;
        monitor(equations, v, (iterations, left), self.horizon)
    }

    /// Moves a state onto the constraints and checks the dropped rows.
    pub(crate) fn project(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<Correction, MotionFault> {
        let iterations = self.settle_completed(equations, t, (q, v))?;
        self.finish(equations, v, iterations)
    }

    /// Moves a stage onto the constraints; dropped rows are not looked at.
    pub(crate) fn approach(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<(), MotionFault> {
        self.settle(equations, t, q)?;
        correct_velocity(equations, v, &mut self.storage).map(drop)
    }

    /// What a projection changes in [q; v] of a state that is left as it is; allocates. Dropped
    /// rows are checked all the same.
    pub(crate) fn missed_correction(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        (q, v): (&[f64], &[f64]),
    ) -> Result<Vec<f64>, MotionFault> {
        let (mut polished_q, mut polished_v) = (q.to_vec(), v.to_vec());
        self.project(equations, t, (&mut polished_q, &mut polished_v))?;
        inspect(equations, t, q, v)?;
        let moved = polished_q.iter().zip(q).chain(polished_v.iter().zip(v));
        Ok(moved.map(|(to, from)| to - from).collect())
    }
}

/// Factors at a state as it is, and finds the residuals of all rows there.
pub(crate) fn inspect(
    equations: &mut KeptEquations<'_>,
    t: f64,
    q: &[f64],
    v: &[f64],
) -> Result<Correction, MotionFault> {
    let KeptEquations { at, velocity, .. } = equations;
    at.pose_and_phi(t, q);
    velocity.factor(at)?;
    at.b();
    let residuals = (0..at.mechanism.layout().rows()).map(|i| at.velocity_residual(i, v).abs());
    Ok(Correction {
        iterations: 0,
        position_residual: largest(&at.s.phi),
        velocity_residual: residuals.fold(0.0, f64::max),
    })
}
