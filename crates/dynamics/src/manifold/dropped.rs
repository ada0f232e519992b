//! Redundant rows. The module checks whether the independent rows imply the redundant rows, and
//! computes the residuals of all rows. The residual of a redundant row after projection certifies
//! the redundancy at no extra cost.

use model::{ConstraintLevel, Level, System};

use super::levels::largest;
use crate::counts::{WorkKind, note};
use crate::error::MotionFault;
use crate::guards::GUARDED;
use crate::limits::{AT_REST, DROPPED_MISFIT, NEAREST_PIVOT, POSITION_MISFIT, STALLED_ROUNDINGS};
use crate::solve::{Evaluation, KeptEquations, KeptRows, Misfits};

/// Result of a projection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Correction {
    /// Number of corrections of the position.
    pub iterations: usize,
    /// Largest |Φ| of all rows after the projection.
    pub position_residual: f64,
    /// Largest |C·v − b| of all rows after the projection.
    pub velocity_residual: f64,
}

/// Computes the residuals of all rows at a projected state. `iterations` is the number of
/// corrections, and `left` is the largest velocity residual of the independent rows. Returns an
/// error if a redundant row is above its limit. `horizon` is the duration of the run (s).
pub(super) fn monitor(
    equations: &mut KeptEquations<'_>,
    v: &[f64],
    (iterations, left): (usize, f64),
    horizon: f64,
) -> Result<Correction, MotionFault> {
    if !GUARDED {
        return Ok(Correction {
            iterations,
            ..Correction::default()
        });
    }
    let (at, rows) = (&equations.at, &equations.velocity);
    let residual = |i: usize| at.velocity_residual(i, v).abs();
    let found = Correction {
        iterations,
        position_residual: largest(&at.s.phi),
        velocity_residual: rows.dropped.iter().fold(left, |a, &i| a.max(residual(i))),
    };
    if let Some(misfits) = &mut equations.misfits {
        misfits.look_at(equations.at.s.t);
    }
    check_positions(equations)?;
    let (at, rows) = (&equations.at, &mut equations.velocity);
    let residual = |i: usize| at.velocity_residual(i, v).abs();
    let scale = |i: usize| at.velocity_scale(i, v);
    let share = dropped_misfit(rows);
    // Most rows agree within the rounding error of their own terms.
    if equations.misfits.is_none()
        && rows
            .dropped
            .iter()
            .all(|&i| residual(i) <= share * scale(i))
    {
        return Ok(found);
    }
    // The rows cannot agree better than the rounding error of the coordinates allows. Independent
    // rows are solved to the rounding error of the row with the largest terms. Therefore redundant
    // rows are not more accurate. A violation of redundant rows within a tolerance is not an error
    // of the coordinates.
    let position = &equations.position;
    let exact = position.kept.iter();
    let exact = exact.chain(
        position
            .dropped
            .iter()
            .filter(|_| equations.misfits.is_none()),
    );
    let scales = at.mechanism.scales(&at.s);
    let rounding = scales.relative_residual(at.size, exact.copied());
    let check = Check {
        level: Level::velocities(at.mechanism, at.size, v),
        share: share.max(STALLED_ROUNDINGS * rounding),
        residual: |i: usize| at.velocity_residual(i, v),
        most: f64::INFINITY,
        floor: |i: usize| AT_REST * at.row_size(i) / horizon,
    };
    check.of(rows, at, &mut equations.misfits)?;
    Ok(found)
}

/// Checks the redundant rows of Φ at the last evaluated pose. Redundant rows are violated if the
/// pose is on another branch of the independent rows.
pub(super) fn check_positions(equations: &mut KeptEquations<'_>) -> Result<(), MotionFault> {
    let (at, rows) = (&equations.at, &mut equations.position);
    let check = Check {
        level: Level::positions(),
        share: dropped_misfit(rows),
        residual: |i: usize| at.s.phi[i],
        most: POSITION_MISFIT,
        floor: |_| 0.0,
    };
    check.of(rows, at, &mut equations.misfits)
}

/// Returns the drives and joints with functions of time in the dependency of the redundant row i.
fn drives_among(
    rows: &mut KeptRows,
    at: &Evaluation<'_>,
    i: usize,
) -> Result<Vec<String>, MotionFault> {
    let layout = at.mechanism.layout();
    let mut z = vec![0.0; layout.rows()];
    rows.dependency(at, i, &mut z)?;
    let share = dropped_misfit(rows);
    let mut names: Vec<String> = Vec::new();
    for (k, _) in z.iter().enumerate().filter(|(_, z)| z.abs() > share) {
        let group = &layout.groups[layout.owners[k].0];
        if group.spec.rheonomic && !names.contains(&group.name) {
            names.push(group.name.clone());
        }
    }
    Ok(names)
}

/// Returns the allowed residual of rows that depend on these rows, as a share of their terms. The
/// rounding error of the independent rows is multiplied by the inverse of the pivots. Therefore it
/// is larger near a singular configuration.
fn dropped_misfit(rows: &KeptRows) -> f64 {
    DROPPED_MISFIT / rows.relative_pivot().clamp(NEAREST_PIVOT, 1.0)
}

/// Residuals of redundant rows at the level of positions or of velocities.
struct Check<'v, R, F> {
    level: Level<'v>,
    /// Allowed residual of redundant rows, as a share of the terms.
    share: f64,
    residual: R,
    /// Largest allowed share, for any rounding error of the independent rows. Above this share, it
    /// cannot be decided whether the row is satisfied.
    most: f64,
    /// Allowed residual for rows with any terms. A difference between velocities or positions is
    /// allowed if it causes only a small displacement during the run. The limit of this
    /// displacement is a share of the size of the mechanism, even if the motion is slow.
    floor: F,
}

impl<R, F> Check<'_, R, F>
where
    R: Fn(usize) -> f64,
    F: Fn(usize) -> f64,
{
    fn name(&self) -> &'static str {
        if self.is_of_velocities() {
            "velocity"
        } else {
            "position"
        }
    }

    fn is_of_velocities(&self) -> bool {
        self.level.of == ConstraintLevel::Velocity
    }

    /// Returns an error for the first redundant row that the independent rows do not imply. The row
    /// must also not be implied for data within a stated tolerance.
    fn of(
        &self,
        rows: &mut KeptRows,
        at: &Evaluation<'_>,
        misfits: &mut Option<Box<Misfits>>,
    ) -> Result<(), MotionFault> {
        let scales = at.mechanism.scales(&at.s);
        let scale = |i: usize| scales.terms(i, &self.level);
        // The terms that are nonzero in this state are a part of all terms and take less time to
        // compute.
        let present = |i: usize| match self.level.of {
            ConstraintLevel::Position => at.position_scale(i),
            _ => 0.0,
        };
        for k in 0..rows.dropped.len() {
            note(WorkKind::Monitors);
            let i = rows.dropped[k];
            let value = (self.residual)(i);
            let residual = value.abs();
            // Most rows agree within the rounding error of their own terms.
            if residual <= self.share * present(i) || residual <= self.share * scale(i) {
                if let Some(misfits) = misfits {
                    misfits.see(self.is_of_velocities(), i, value, None, at);
                }
                continue;
            }
            rows.factor(at)?;
            let implied = self.share * rows.implied_scale(at, i, scale)?;
            let mut tolerance = implied.min(self.most * scale(i));
            if residual > tolerance {
                tolerance = tolerance.max((self.floor)(i) + scales.rest(i, &self.level));
            }
            let is_rounding = residual <= tolerance;
            if let Some(misfits) = misfits {
                let bound = if is_rounding {
                    None
                } else {
                    Some(misfits.bound((at, rows), i, &self.level)?)
                };
                misfits.see(self.is_of_velocities(), i, value, bound, at);
                if let Some(bound) = bound {
                    if residual <= bound {
                        continue;
                    }
                    return Err(MotionFault::BeyondTolerance {
                        time: at.s.t,
                        row: at.label(i),
                        level: self.name(),
                        residual,
                        bound,
                        way: misfits.way(at),
                    });
                }
            }
            if !is_rounding {
                return Err(MotionFault::DroppedRow {
                    time: at.s.t,
                    row: at.label(i),
                    level: self.name(),
                    residual,
                    tolerance,
                    drives: drives_among(rows, at, i)?.into(),
                });
            }
        }
        Ok(())
    }
}
