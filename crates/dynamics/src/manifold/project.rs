//! Projection onto the constraints. Positions are corrected first, then velocities, each by the
//! smallest correction in the mass metric. In a run without projection, the module computes the
//! residuals of a state.

use model::System;

use super::coordinates::{IndependentCoordinates, Origin};
use super::dropped::{Correction, monitor};
use super::levels::{Moves, ProjectionStorage, correct_position, correct_velocity, largest};
use crate::error::MotionFault;
use crate::options::Stabilisation;
use crate::solve::{Evaluation, KeptEquations};

/// Treatment of states that violate the constraints.
pub(crate) struct Manifold {
    /// Independent coordinates, if the motion uses them.
    pub(crate) coordinates: Option<IndependentCoordinates>,
    stabilisation: Stabilisation,
    /// Duration of the run (s). The duration is infinite if the duration is not given or zero. In
    /// this case, no difference between velocities is allowed.
    horizon: f64,
    storage: ProjectionStorage,
}

impl Manifold {
    pub(crate) fn new(at: &Evaluation<'_>, stabilisation: Stabilisation, horizon: f64) -> Self {
        Self {
            coordinates: None,
            stabilisation,
            horizon,
            storage: ProjectionStorage::new(at.mechanism.mass().len()),
        }
    }

    /// Returns whether states are moved onto the constraint manifold. The result is always true
    /// with independent coordinates.
    pub(crate) fn projects(&self) -> bool {
        self.coordinates.is_some() || self.stabilisation == Stabilisation::Projection
    }

    /// Switches the motion to independent coordinates. The independent coordinates are chosen at
    /// the last evaluated pose, which must be the pose of `origin`.
    pub(crate) fn choose_coordinates(
        &mut self,
        equations: &mut KeptEquations<'_>,
        origin: Origin,
    ) -> Result<(), MotionFault> {
        let chosen = IndependentCoordinates::new(equations, origin, self.coordinates.as_ref())?;
        self.coordinates = Some(chosen);
        Ok(())
    }

    /// Moves q onto the constraint manifold and factors the rows at the result. Returns the number
    /// of corrections.
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

    /// Completes a state on independent coordinates and settles its position. After a completion,
    /// the corrections remove only rounding errors.
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

    /// Moves v onto the constraints at a settled position and checks all residuals.
    pub(crate) fn finish(
        &mut self,
        equations: &mut KeptEquations<'_>,
        v: &mut [f64],
        iterations: usize,
    ) -> Result<Correction, MotionFault> {
        let left = correct_velocity(equations, v, &mut self.storage)?;
        monitor(equations, v, (iterations, left), self.horizon)
    }

    /// Moves a state onto the constraint manifold and checks the redundant rows.
    pub(crate) fn project(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<Correction, MotionFault> {
        let iterations = self.settle_completed(equations, t, (q, v))?;
        self.finish(equations, v, iterations)
    }

    /// Moves a stage onto the constraint manifold without a check of redundant rows.
    pub(crate) fn approach(
        &mut self,
        equations: &mut KeptEquations<'_>,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<(), MotionFault> {
        self.settle(equations, t, q)?;
        correct_velocity(equations, v, &mut self.storage).map(drop)
    }

    /// Returns the change of [q; v] that a projection would make, for states that are not
    /// projected. The function allocates memory. Redundant rows are nevertheless checked.
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

/// Factors the rows at a state without changing it, and computes the residuals of all rows.
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
