//! Dropped rows: what the kept ones imply of them, and what all rows miss by. Their residual after
//! projection is a free certificate of redundancy.

use model::System;

use super::levels::largest;
use crate::counts::{Counted, note};
use crate::error::MotionFault;
use crate::guards::GUARDED;
use crate::limits::{AT_REST, DROPPED_MISFIT, NEAREST_PIVOT, POSITION_MISFIT, STALLED_ROUNDINGS};
use crate::solve::{Evaluation, KeptEquations, KeptRows};

/// What a projection found and did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Corrections of the position made.
    pub iterations: usize,
    /// Largest |Φ| afterwards, all rows.
    pub position_residual: f64,
    /// Largest |C·v − b| afterwards, all rows.
    pub velocity_residual: f64,
}

/// Residuals of all rows at a projected state, the kept ones being off by `left`; dropped rows
/// refused above the limit. `horizon`: how long the run lasts (s).
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
    check_positions(equations)?;
    let (at, rows) = (&equations.at, &mut equations.velocity);
    let residual = |i: usize| at.velocity_residual(i, v).abs();
    let scale = |i: usize| at.velocity_scale(i, v);
    let share = dropped_misfit(rows);
    // Most rows agree to rounding of their own terms.
    if rows
        .dropped
        .iter()
        .all(|&i| residual(i) <= share * scale(i))
    {
        return Ok(found);
    }
    // Off the constraints by rounding of its coordinates, the rows agree to the same share. Kept
    // rows are solved to rounding of the fastest of them, so that the others are no better.
    let rounding = at.mechanism.scales(&at.s).relative_residual(at.size);
    let all = 0..at.mechanism.layout().rows();
    let fastest = all.map(scale).fold(0.0, f64::max);
    let level = Level {
        name: "velocity",
        share: share.max(STALLED_ROUNDINGS * rounding),
        residual,
        scale: |_| fastest,
        most: f64::INFINITY,
        floor: || AT_REST * size_of_rows(at) / horizon,
    };
    level.check(rows, at)?;
    Ok(found)
}

/// Dropped rows of Φ at the pose of the scratch, on the kept ones: on another configuration of
/// these they do not hold.
pub(super) fn check_positions(equations: &mut KeptEquations<'_>) -> Result<(), MotionFault> {
    let (at, rows) = (&equations.at, &mut equations.position);
    let level = Level {
        name: "position",
        share: dropped_misfit(rows),
        residual: |i: usize| at.s.phi[i].abs(),
        scale: |i| at.position_scale(i),
        most: POSITION_MISFIT,
        floor: || 0.0,
    };
    level.check(rows, at)
}

/// What rows dropped from these may miss by, as share of their terms: rounding of the kept rows
/// reaches them through the inverse of the pivots, near a singular configuration more than
/// elsewhere.
fn dropped_misfit(rows: &KeptRows) -> f64 {
    DROPPED_MISFIT / rows.relative_pivot().clamp(NEAREST_PIVOT, 1.0)
}

/// The largest row of C for motions of the size of the mechanism.
fn size_of_rows(at: &Evaluation<'_>) -> f64 {
    let layout = at.mechanism.layout();
    let of_row = |i: usize| {
        let row = layout.row(&at.s, i);
        row.map(|(j, c)| c.abs() * model::space::unit(j, at.size))
            .sum()
    };
    (0..layout.rows()).map(of_row).fold(0.0, f64::max)
}

/// Positions or velocities of rows: what row i misses by, and the size of its terms.
struct Level<R, S, F> {
    name: &'static str,
    /// What dropped rows may miss by, as share of the terms.
    share: f64,
    residual: R,
    scale: S,
    /// The same share whatever rounding of the kept rows explains: beyond it the row is not known
    /// to hold.
    most: f64,
    /// What they may miss by however small the terms are: as positions may, velocities may part by
    /// what moves the mechanism by no more than a small share of its size while the run lasts,
    /// however slow the motion is.
    floor: F,
}

impl<R, S, F> Level<R, S, F>
where
    R: Fn(usize) -> f64,
    S: Fn(usize) -> f64,
    F: Fn() -> f64,
{
    /// Refuses the first dropped row that the kept ones do not imply.
    fn check(&self, rows: &mut KeptRows, at: &Evaluation<'_>) -> Result<(), MotionFault> {
        for k in 0..rows.dropped.len() {
            note(Counted::Monitors);
            let i = rows.dropped[k];
            let residual = (self.residual)(i);
            // Most rows agree to rounding of their own terms.
            if residual <= self.share * (self.scale)(i) {
                continue;
            }
            rows.factor(at)?;
            let implied = self.share * rows.implied_scale(at, i, &self.scale)?;
            let mut tolerance = implied.min(self.most * (self.scale)(i));
            if residual > tolerance {
                tolerance = tolerance.max((self.floor)());
            }
            if residual > tolerance || residual.is_nan() || tolerance.is_nan() {
                return Err(MotionFault::DroppedRow {
                    time: at.s.t,
                    row: at.label(i),
                    level: self.name,
                    residual,
                    tolerance,
                });
            }
        }
        Ok(())
    }
}
