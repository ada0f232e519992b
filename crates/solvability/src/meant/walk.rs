//! Poses that a mechanism reaches on its kept rows: what is redundant is so at all of them, what is
//! singular is so at one.

use linalg::{Matrix, PivotedQr};
use model::System;

use super::pose::Candidate;
use super::share::Question;
use crate::mechanism::{dimensionless, velocity_units};

/// Poses to each side.
const POSES: usize = 3;

/// From one pose to the next: a share of the size, or radians. Short, so that the walk does not
/// pass a singular pose onto another branch.
const REACH: f64 = 0.05;

/// Steps from one pose to the next.
const STEPS: usize = 5;

/// The same where such steps do not arrive.
const SMALL_STEPS: usize = 40;

/// Corrections of a step onto the kept rows at most, and the largest as a share of the step: what
/// is corrected by more may be on another branch.
const CORRECTIONS: usize = 12;
const CORRECTED: f64 = 0.5;

/// A correction below this share of the size is none; one that no longer falls is rounding if it is
/// below the other.
const MET: f64 = 1e-14;
const NEARLY_MET: f64 = 1e-10;

/// Rows whose pivot is below this share of the largest follow from the others.
const INDEPENDENT: f64 = 1e-8;

/// Poses of a mechanism.
pub(super) struct Walk {
    /// Coordinates of each.
    pub(super) poses: Vec<Vec<f64>>,
    /// Whether these are all that were wanted, or there is nothing that moves.
    pub(super) is_complete: bool,
}

/// Up to six poses on both sides of the pose of the question, on the kept rows of Φ, along
/// velocities that all kept rows allow: mainly the one that the kept rows alone set free.
pub(super) fn walk(question: &Question<'_>, kept: &[usize]) -> Walk {
    let mut poses = Vec::new();
    let here = dimensionless(question.mechanism, question.s, question.size);
    if free_directions(&here, kept).nrows() == 0 {
        let is_complete = true;
        return Walk { poses, is_complete };
    }
    for side in [1.0, -1.0] {
        let mut q = question.q.to_vec();
        let mut heading: Option<Vec<f64>> = None;
        for _ in 0..POSES {
            let next = [STEPS, SMALL_STEPS].into_iter().find_map(|steps| {
                let (mut q, mut heading) = (q.clone(), heading.clone());
                let stride = REACH / steps as f64 * question.size;
                (0..steps)
                    .try_for_each(|_| step(question, kept, (side, stride), &mut q, &mut heading))?;
                Some((q, heading))
            });
            let Some(next) = next else {
                break;
            };
            (q, heading) = next;
            poses.push(q.clone());
        }
    }
    let is_complete = poses.len() == 2 * POSES;
    Walk { poses, is_complete }
}

/// One step; `None` where it leads nowhere.
fn step(
    question: &Question<'_>,
    kept: &[usize],
    (side, stride): (f64, f64),
    q: &mut Vec<f64>,
    heading: &mut Option<Vec<f64>>,
) -> Option<()> {
    let mechanism = question.mechanism;
    let s = crate::mechanism::evaluated(mechanism, question.s.t, q);
    let free = free_directions(&dimensionless(mechanism, &s, question.size), kept);
    let direction = match heading.take() {
        // What is free of the last step.
        Some(last) => free.transpose_times(&free.times(&last)),
        None => mixed(&free, side),
    };
    let largest = direction.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    if largest.is_nan() || largest == 0.0 {
        return None;
    }
    let units = velocity_units(mechanism, question.size);
    let velocity: Vec<f64> = direction
        .iter()
        .zip(&units)
        .map(|(d, unit)| d * unit)
        .collect();
    let moved = mechanism.displaced(q, stride / largest, &velocity);
    *q = onto_kept(question, kept, stride, moved)?;
    *heading = Some(direction);
    Some(())
}

/// The configuration on the kept rows of Φ, by corrections that are shortest without dimensions:
/// masses say nothing of where a mechanism can be.
fn onto_kept(
    question: &Question<'_>,
    kept: &[usize],
    stride: f64,
    mut q: Vec<f64>,
) -> Option<Vec<f64>> {
    let (mechanism, size) = (question.mechanism, question.size);
    let m = mechanism.layout().m;
    let holonomic: Vec<usize> = kept.iter().copied().filter(|&i| i < m).collect();
    if holonomic.is_empty() {
        return Some(q);
    }
    let units = velocity_units(mechanism, size);
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let s = crate::mechanism::evaluated(mechanism, question.s.t, &q);
        let c = dimensionless(mechanism, &s, size).select_rows(&holonomic);
        let missing: Vec<f64> = holonomic.iter().map(|&i| -s.phi[i]).collect();
        let correction = shortest(&c, &missing);
        let largest = correction.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        if correction.iter().any(|x| x.is_nan()) || largest > CORRECTED * stride {
            return None;
        }
        let is_rounding = largest >= 0.5 * last && largest <= NEARLY_MET * size;
        if largest <= MET * size || is_rounding {
            return Some(q);
        }
        last = largest;
        let velocity: Vec<f64> = correction.iter().zip(&units).map(|(x, u)| x * u).collect();
        q = mechanism.displaced(&q, 1.0, &velocity);
    }
    None
}

/// The shortest δ with `C·δ = x`, by rows that are independent.
fn shortest(c: &Matrix, x: &[f64]) -> Vec<f64> {
    let size_of = |i: usize| c.row(i).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let sizes: Vec<f64> = (0..c.nrows())
        .map(|i| match size_of(i) {
            0.0 => 1.0,
            size => size,
        })
        .collect();
    let equal = Matrix::from_fn(c.nrows(), c.ncols(), |i, j| c[(i, j)] / sizes[i]);
    let order = PivotedQr::of_rows(equal.clone());
    let pivots: Vec<f64> = order.r_diagonal().map(f64::abs).collect();
    let least = INDEPENDENT * pivots.first().copied().unwrap_or(0.0);
    let rank = pivots.iter().take_while(|&&r| r > least).count();
    let rows = &order.permutation()[..rank];
    let inverse = PivotedQr::of_rows(equal.select_rows(rows)).pseudo_inverse();
    let x: Vec<f64> = rows.iter().map(|&i| x[i] / sizes[i]).collect();
    inverse.times(&x)
}

/// Velocities without dimensions that the kept rows allow, one in each row, the one that the other
/// rows resist most first.
fn free_directions(c: &Matrix, kept: &[usize]) -> Matrix {
    Candidate::of_rows(c, kept.to_vec()).into_free()
}

/// The first direction with a little of the others, so that no freedom stands still.
fn mixed(free: &Matrix, side: f64) -> Vec<f64> {
    /// Share of the other directions.
    const OTHERS: f64 = 0.3;
    let share = |k: usize| match k {
        0 => side,
        _ => side * OTHERS / k as f64,
    };
    let shares: Vec<f64> = (0..free.nrows()).map(share).collect();
    free.transpose_times(&shares)
}
