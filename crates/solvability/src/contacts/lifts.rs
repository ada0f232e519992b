//! The one-sided joints that open if not all one-sided joints can stay closed. The accelerations
//! are computed by Gauss' principle of least constraint.
//!
//! The accelerations minimise `½·(v̇ − M⁻¹·Q)ᵀ·M·(v̇ − M⁻¹·Q)` under the two-sided rows and `g̈ ≥
//! 0` for the gaps g of one-sided joints. The accelerations are unique if M is positive definite on
//! the motions that the rows permit. The forces need not be unique. In terms of the pressing forces
//! N ≥ 0: `g̈ = r + W·N ≥ 0`, `Nᵀ·g̈ = 0`. Rolling rows of a joint that opens are kept, because the
//! accelerations are those at the instant of opening. See C. Glocker, Set-Valued Force Laws,
//! Springer 2001, chapter 9.

use linalg::{KeptRowSaddle, Matrix};
use model::start::scene_size;
use model::{ConstraintId, Mechanism, System};
use rank::RankStatus;

use super::carried::pressing_force;
use super::error::PermittedError;
use crate::choices::Equations;
use crate::limits::OPENING;
use crate::polyhedra::complementarity::support_motion;
use crate::pose::{dimensionless, evaluated, uncertainty};

/// Returns the joints that open at time t, coordinates q and velocities v. The joints that open are
/// the joints whose gaps accelerate. If the accelerations are not clear, they are the joints that
/// take part in opening.
#[must_use]
pub fn opened(
    mechanism: &Mechanism,
    state: (f64, &[f64], &[f64]),
    opening: &[ConstraintId],
) -> Vec<ConstraintId> {
    match lifted(mechanism, state) {
        Ok(found) if !found.joints.is_empty() => {
            found.joints.into_iter().map(|(id, _)| id).collect()
        }
        _ => opening.to_vec(),
    }
}

/// One-sided joints that open.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Liftoff {
    /// The joints, each with the acceleration of its gap (m/s²).
    pub joints: Vec<(ConstraintId, f64)>,
    /// The accelerations v̇, n_v values.
    pub accelerations: Vec<f64>,
}

/// Returns the one-sided joints that open at time t, coordinates q and velocities v.
///
/// # Errors
/// [`PermittedError`]
pub fn lifted(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
) -> Result<Liftoff, PermittedError> {
    let layout = mechanism.layout();
    let (s, size) = (evaluated(mechanism, t, q), scene_size(mechanism, q));
    // The row of a gap, multiplied by this number, is the rate of the gap.
    let sided = layout.constraint_ids().filter_map(|id| {
        let group = &layout.groups[id.0];
        let side = group.limits.open_side?;
        let force = pressing_force(mechanism, &s, id);
        Some((id, group.rows.row(0), side.sign() / force))
    });
    let sided: Vec<(ConstraintId, usize, f64)> = sided.collect();
    let is_sided = |row: &usize| sided.iter().any(|(_, own, _)| own == row);
    let held: Vec<usize> = (0..layout.rows()).filter(|row| !is_sided(row)).collect();
    let equations = Equations::of(mechanism, t, q, v)?;
    let decision = rank::decide(
        &dimensionless(mechanism, &s, size).select_rows(&held),
        &uncertainty(mechanism, &s, size).select_rows(&held),
    );
    let decision = decision.map_err(|e| PermittedError::Accelerations(e.to_string()))?;
    if decision.status != RankStatus::Decided {
        return Err(PermittedError::Rank);
    }
    let kept: Vec<usize> = decision.kept.iter().map(|k| held[*k]).collect();
    let failed = |e: linalg::SaddleError| PermittedError::Accelerations(e.to_string());
    let mut saddle = KeptRowSaddle::new(layout.n_v, kept.len()).map_err(failed)?;
    saddle
        .factor(|k| equations.c.row(kept[k]), equations.inertia())
        .map_err(failed)?;
    let mut accelerations = |force: &[f64], gamma: &[f64]| {
        let (mut a, mut lambda) = (vec![0.0; layout.n_v], vec![0.0; kept.len()]);
        let solved = saddle.solve(force, gamma, &mut a, &mut lambda);
        solved.map(|()| a).map_err(failed)
    };
    let of_kept: Vec<f64> = kept.iter().map(|&i| equations.gamma[i]).collect();
    let free = accelerations(&equations.force, &of_kept)?;
    let along = |k: usize, a: &[f64]| -> f64 {
        let (_, row, rate) = sided[k];
        rate * linalg::kernels::dot(equations.c.row(row), a)
    };
    let n = sided.len();
    let zeros = vec![0.0; kept.len()];
    let mut pushed = Vec::with_capacity(n);
    for &(_, row, rate) in &sided {
        let force: Vec<f64> = equations.c.row(row).iter().map(|c| rate * c).collect();
        pushed.push(accelerations(&force, &zeros)?);
    }
    // Gaps that two-sided joints keep closed have only a mobility due to rounding.
    let masses = equations.inertia().full_diagonal();
    let mobility = |&(_, row, rate): &(ConstraintId, usize, f64)| -> f64 {
        let each = equations.c.row(row).iter().zip(&masses);
        let each = each.map(|(c, m)| if *m > 0.0 { c * c / m } else { 0.0 });
        rate * rate * each.sum::<f64>()
    };
    let moves = |k: usize| along(k, &pushed[k]) > OPENING * mobility(&sided[k]);
    let moves: Vec<bool> = (0..n).map(moves).collect();
    let w = |i: usize, j: usize| {
        if moves[i] && moves[j] {
            along(i, &pushed[j])
        } else {
            0.0
        }
    };
    let w = Matrix::from_fn(n, n, w);
    let r = |k: usize| {
        if moves[k] {
            along(k, &free) - sided[k].2 * equations.gamma[sided[k].1]
        } else {
            0.0
        }
    };
    let r: Vec<f64> = (0..n).map(r).collect();
    let found = support_motion(&w, &r)?;
    // The acceleration without any other joint. Accelerations that other joints prevent are
    // rounding errors of it.
    let unheld = |&(_, row, rate): &(ConstraintId, usize, f64)| -> f64 {
        let loads = equations.force.iter().zip(&masses);
        let each = equations.c.row(row).iter().zip(loads);
        let each = each.map(|(c, (q, m))| if *m > 0.0 { (c * q / m).abs() } else { 0.0 });
        rate.abs() * (each.sum::<f64>() + equations.gamma[row].abs())
    };
    let sizes = r.iter().map(|r| r.abs());
    let largest = sizes.chain(sided.iter().map(unheld)).fold(0.0, f64::max);
    let lifted = sided.iter().zip(&found.accelerations);
    let lifted = lifted.filter(|(_, a)| **a > OPENING * largest);
    let joints = lifted.map(|((id, ..), a)| (*id, *a)).collect();
    let mut a = free;
    for (force, own) in found.forces.iter().zip(&pushed) {
        (a.iter_mut().zip(own)).for_each(|(a, x)| *a += force * x);
    }
    Ok(Liftoff {
        joints,
        accelerations: a,
    })
}
