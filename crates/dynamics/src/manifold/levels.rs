//! Positions and velocities of independent rows as levels of Newton's method. Positions need
//! several corrections. Velocities need one linear solution and corrections of its rounding error.

use model::System;

use super::held::IndependentRotations;
use super::newton::{Level, Limits, correct};
use crate::error::MotionFault;
use crate::limits::{
    CORRECTIONS, FEW_ROUNDINGS, READ_ROTATION, ROUNDINGS, SHARPENED, STALLED_ROUNDINGS,
    VELOCITY_CORRECTIONS, WEAK,
};
use crate::solve::{KeptEquations, KeptRows};

/// The coordinates that a correction changes.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Moves {
    /// All coordinates are corrected, by the smallest change in the mass metric.
    AllCoordinates,
    /// The dependent coordinates of the partition.
    DependentCoordinates,
}

struct Positions<'a, 'm> {
    equations: &'a mut KeptEquations<'m>,
    t: f64,
    q: &'a mut [f64],
    storage: &'a mut ProjectionStorage,
    moves: Moves,
}

/// Vectors of a projection.
pub(super) struct ProjectionStorage {
    /// A correction, n_v.
    pub(super) delta: Vec<f64>,
    /// Sizes of the terms of the independent rows of Φ at the first configuration. Corrections
    /// change these sizes only slightly.
    scales: Vec<f64>,
    /// Rotations that a completion does not change, for bodies that also have dependent rotations.
    pub(super) held: IndependentRotations,
}

impl ProjectionStorage {
    pub(super) fn new(n_v: usize) -> Self {
        Self {
            delta: vec![0.0; n_v],
            scales: Vec::with_capacity(n_v),
            held: IndependentRotations::default(),
        }
    }
}

impl Level for Positions<'_, '_> {
    type Fault = MotionFault;

    fn misses(&mut self, corrections: usize) -> (usize, f64) {
        let KeptEquations { at, position, .. } = &mut *self.equations;
        at.pose_and_phi(self.t, self.q);
        let phi = &at.s.phi;
        position.take_rhs(|i| -phi[i]);
        let scales = &mut self.storage.scales;
        if corrections == 0 {
            scales.clear();
            scales.extend(position.kept.iter().map(|&i| at.position_scale(i)));
        }
        let mut worst = (0, 0.0_f64);
        for (k, &i) in position.kept.iter().enumerate() {
            // The solution cannot correct a row that is omitted from it.
            if phi[i] == 0.0 || corrections > 0 && !position.uses(k) {
                continue;
            }
            let roundings = phi[i].abs() / (f64::EPSILON * scales[k]);
            if roundings > worst.1 || roundings.is_nan() {
                worst = (i, roundings);
            }
        }
        if self.moves == Moves::DependentCoordinates {
            let off = self.storage.held.off(self.q) / (f64::EPSILON * READ_ROTATION);
            if off > worst.1 || off.is_nan() {
                worst.1 = off;
            }
        }
        worst
    }

    fn correct(&mut self, converges: bool) -> Result<(), MotionFault> {
        let KeptEquations { at, position, .. } = &mut *self.equations;
        let ProjectionStorage { delta, held, .. } = &mut *self.storage;
        match self.moves {
            Moves::AllCoordinates => {
                position.factor(at)?;
                position.solve(at, None, delta)?;
            }
            Moves::DependentCoordinates => {
                if !converges {
                    position.factor(at)?;
                }
                delta.fill(0.0);
                position.complete(at, delta)?;
                if !converges {
                    held.find_tangents(at, position, self.q)?;
                }
                held.hold(at.mechanism, self.q, delta);
            }
        }
        at.mechanism.displace(self.q, delta);
        Ok(())
    }
}

/// Moves q onto the independent rows of Φ. Returns the number of corrections.
pub(super) fn correct_position(
    equations: &mut KeptEquations<'_>,
    (t, q): (f64, &mut [f64]),
    storage: &mut ProjectionStorage,
    moves: Moves,
) -> Result<usize, MotionFault> {
    let enough = match moves {
        Moves::AllCoordinates => enough(&equations.position),
        Moves::DependentCoordinates => FEW_ROUNDINGS,
    };
    let least = usize::from(equations.position.relative_pivot() < SHARPENED);
    let limits = Limits {
        corrections: [least, CORRECTIONS],
        enough,
        stalled: STALLED_ROUNDINGS,
    };
    let mut level = Positions {
        equations,
        t,
        q,
        storage,
        moves,
    };
    let end = correct(&mut level, &limits)?;
    let (at, row) = (&equations.at, end.worst);
    // The accuracy of rows is also limited by the rounding error of terms that are not present at
    // this orientation.
    let (scales, level) = (at.mechanism.scales(&at.s), model::Level::positions());
    let rounding = |i: usize| STALLED_ROUNDINGS * f64::EPSILON * scales.terms(i, &level);
    let are_rounding = || {
        let mut kept = equations.position.kept.iter();
        kept.all(|&i| at.s.phi[i].abs() <= rounding(i))
    };
    if end.is_reached || are_rounding() {
        Ok(end.corrections)
    } else {
        Err(MotionFault::OffConstraints {
            time: t,
            row: at.label(row),
            residual: at.s.phi[row].abs(),
            tolerance: ROUNDINGS * f64::EPSILON * at.position_scale(row),
            iterations: end.corrections,
        })
    }
}

struct Velocities<'a, 'm> {
    equations: &'a mut KeptEquations<'m>,
    v: &'a mut [f64],
    delta: &'a mut [f64],
    /// Largest residual of the rows after the corrections.
    left: f64,
}

impl Level for Velocities<'_, '_> {
    type Fault = MotionFault;

    fn misses(&mut self, _: usize) -> (usize, f64) {
        let KeptEquations { at, velocity, .. } = &mut *self.equations;
        let mut fastest = 0.0_f64;
        velocity.take_rhs(|i| {
            let (residual, scale) = at.velocity_residual_and_scale(i, self.v);
            fastest = fastest.max(scale);
            -residual
        });
        self.left = largest(&velocity.rhs);
        if self.left == 0.0 {
            (0, 0.0)
        } else {
            (0, self.left / (f64::EPSILON * fastest))
        }
    }

    fn correct(&mut self, _: bool) -> Result<(), MotionFault> {
        let KeptEquations { at, velocity, .. } = &mut *self.equations;
        velocity.solve(at, None, self.delta)?;
        for (v, d) in self.v.iter_mut().zip(&*self.delta) {
            *v += d;
        }
        Ok(())
    }
}

/// Moves v onto the independent rows of C, which must be factored at a settled position. Returns
/// their largest residual after the correction.
pub(super) fn correct_velocity(
    equations: &mut KeptEquations<'_>,
    v: &mut [f64],
    storage: &mut ProjectionStorage,
) -> Result<f64, MotionFault> {
    equations.at.b();
    let limits = Limits {
        corrections: [0, VELOCITY_CORRECTIONS],
        enough: enough(&equations.velocity),
        stalled: 0.0,
    };
    let mut level = Velocities {
        equations,
        v,
        delta: &mut storage.delta,
        left: 0.0,
    };
    correct(&mut level, &limits)?;
    Ok(level.left)
}

/// Returns the largest |x_i|.
pub(super) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}

/// Returns the number of rounding errors below which rows count as satisfied.
fn enough(rows: &KeptRows) -> f64 {
    if rows.relative_pivot() < WEAK {
        FEW_ROUNDINGS
    } else {
        ROUNDINGS
    }
}
