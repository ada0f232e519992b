//! Poses that a mechanism reaches on its kept rows: a redundancy exists at all of them, a
//! singularity at one only.
//!
//! Within a stated tolerance the intended mechanism has other data, and is at a pose nearby. A pose
//! counts only if it certainly exists there, by the condition of Newton and Kantorovich:
//! `‖C_K⁺‖·γ·η ≤ ½`, with the distance η by which data within the tolerance move the pose to first
//! order, and the constant γ = 1 by which C changes with a pose, in units of the size. Elsewhere the
//! first order says nothing: near a singular pose of the kept rows the walk may have gone on along a
//! branch that the intended mechanism does not have.
//!
//! Source: L. V. Kantorovich, G. P. Akilov, Functional Analysis (1982), ch. XVIII.

use crate::limits::{
    KNOWN_POSE, OTHER_DIRECTIONS, WALK_CORRECTED, WALK_POSES, WALK_REACH, WALK_SMALL_STEPS,
    WALK_STEPS,
};
use crate::pose::{dimensionless, velocity_units};
use linalg::{Matrix, singular_values};
use model::start::{Metric, nearest_configuration};
use model::{DataBlock, Scratch, System};

use super::follow::{Followed, Ground, Step};
use super::pose::Candidate;
use super::share::Question;

/// Poses of a mechanism.
pub(super) struct Walk {
    /// Steps to each side of the first pose, if nonholonomic rows are kept.
    sides: [Vec<Step>; 2],
    /// Coordinates of each pose, its side, and the number of steps that lead there.
    stops: Vec<(Vec<f64>, usize, usize)>,
    /// Whether all poses of one side were reached, or nothing can move.
    pub(super) is_complete: bool,
}

impl Walk {
    /// Coordinates of each pose, and the steps that lead to it, the last one first; no steps if
    /// only holonomic rows are kept, because these determine every pose directly.
    pub(super) fn poses(&self) -> impl Iterator<Item = (&[f64], impl Iterator<Item = &Step>)> {
        let stops = self.stops.iter();
        stops.map(|(q, side, steps)| (&**q, self.sides[*side][..*steps].iter().rev()))
    }

    /// The last pose.
    pub(super) fn farthest(&self) -> Option<&[f64]> {
        self.stops.last().map(|(q, ..)| &**q)
    }
}

/// Up to six poses on both sides of the pose of the question, on the kept rows of Φ, along
/// velocities that all kept rows allow: mainly the velocity that only the dropped rows prevent.
pub(super) fn walk(question: &Question<'_>, kept: &[usize]) -> Walk {
    let (mechanism, size) = (question.mechanism, question.size);
    let ground = Ground {
        mechanism,
        kept,
        units: &velocity_units(mechanism, size),
        size,
        t: question.s.t,
    };
    let (mut sides, mut stops) = ([Vec::new(), Vec::new()], Vec::new());
    let is_still = free_directions(&dimensionless(mechanism, question.s, size), kept).nrows() == 0;
    let is_known = |s: &Scratch| {
        let blurred = question.tolerance().map(|_| blurred(question, &ground, s));
        blurred.is_none_or(|blurred| blurred <= KNOWN_POSE)
    };
    let signs = if is_still || !is_known(question.s) {
        &[][..]
    } else {
        &[1.0, -1.0]
    };
    let mut is_complete = is_still;
    for (side, sign) in signs.iter().enumerate() {
        let way: &mut Vec<Step> = &mut sides[side];
        let mut q = question.q.to_vec();
        let mut heading: Option<Vec<f64>> = None;
        for _ in 0..WALK_POSES {
            let next = [WALK_STEPS, WALK_SMALL_STEPS]
                .into_iter()
                .find_map(|steps| {
                    let (mut q, mut heading, mut taken) = (q.clone(), heading.clone(), Vec::new());
                    let stride = WALK_REACH / steps as f64 * size;
                    for _ in 0..steps {
                        taken.extend(step(&ground, (*sign, stride), &mut q, &mut heading)?);
                    }
                    Some((q, heading, taken))
                });
            let Some((there, on, taken)) = next else {
                break;
            };
            if !is_known(&crate::pose::evaluated(mechanism, ground.t, &there)) {
                break;
            }
            (q, heading) = (there, on);
            way.extend(taken);
            stops.push((q.clone(), side, way.len()));
        }
        is_complete |= stops.iter().filter(|(_, own, _)| *own == side).count() == WALK_POSES;
    }
    Walk {
        sides,
        stops,
        is_complete,
    }
}

/// `‖C_K⁺‖·η` of the kept rows of Φ at the pose of the scratch. Lengths are measured by the size of
/// the mechanism, and the largest entry of each row is one.
fn blurred(question: &Question<'_>, ground: &Ground<'_>, s: &Scratch) -> f64 {
    let (mechanism, size) = (question.mechanism, question.size);
    let rows = ground.holonomic();
    let mut scaled = dimensionless(mechanism, s, size).select_rows(&rows);
    let mut own = Vec::with_capacity(rows.len());
    for (i, &row) in rows.iter().enumerate() {
        let largest = scaled.row(i).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        scaled.row_mut(i).iter_mut().for_each(|x| *x /= largest);
        own.push((row, largest.recip()));
    }
    let Some(&weakest) = singular_values(&scaled).last() else {
        return 0.0;
    };
    let followed = Followed::new(&scaled, own, ground.units.to_vec());
    let data = mechanism.data();
    let blocks = data.blocks(s);
    let moved = ground.units.iter().enumerate().map(|(column, unit)| {
        let mut gradient = vec![0.0; ground.units.len()];
        gradient[column] = 1.0;
        let (lambda, _) = followed.split(&gradient, mechanism.layout().rows());
        data.phi_change(s, &lambda, &blocks, DataBlock::known_to) / (unit * size)
    });
    moved.fold(0.0, f64::max) / weakest
}

/// One step, which is recorded if nonholonomic rows are kept. Returns `None` if the step cannot be
/// made.
fn step(
    ground: &Ground<'_>,
    (side, stride): (f64, f64),
    q: &mut Vec<f64>,
    heading: &mut Option<Vec<f64>>,
) -> Option<Option<Step>> {
    let (mechanism, units) = (ground.mechanism, ground.units);
    let s = crate::pose::evaluated(mechanism, ground.t, q);
    let free = free_directions(&dimensionless(mechanism, &s, ground.size), ground.kept);
    let direction = match heading.take() {
        // The projection of the last step onto the free directions.
        Some(last) => free.transpose_times(&free.times(&last)),
        None => mixed(&free, side),
    };
    let largest = direction.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    if largest.is_nan() || largest == 0.0 {
        return None;
    }
    let along = direction.iter().zip(units);
    let moved: Vec<f64> = along.map(|(d, unit)| stride / largest * d * unit).collect();
    let (ahead, taken) = if ground.is_led() {
        let (ahead, taken) = ground.flow(q, moved)?;
        (ahead, Some(taken))
    } else {
        (mechanism.space().displaced(q, 1.0, &moved), None)
    };
    let rows = ground.holonomic();
    let there = nearest_configuration(mechanism, ground.t, &rows, &ahead, Metric::Length).ok()?;
    let correction = mechanism.space().difference_of(&there, &ahead);
    let mut lengths = correction
        .iter()
        .zip(units)
        .map(|(x, unit)| (x / unit).abs());
    if lengths.any(|x| x.is_nan() || x > WALK_CORRECTED * stride) {
        return None;
    }
    *q = there;
    *heading = Some(direction);
    Some(taken)
}

/// Velocities without dimensions that the kept rows allow, one in each row, the one that the other
/// rows resist most first.
fn free_directions(c: &Matrix, kept: &[usize]) -> Matrix {
    Candidate::of_rows(c, kept.to_vec()).into_free()
}

/// The first direction with a small part of the others, so that every freedom moves.
fn mixed(free: &Matrix, side: f64) -> Vec<f64> {
    let share = |k: usize| match k {
        0 => side,
        _ => side * OTHER_DIRECTIONS / k as f64,
    };
    let shares: Vec<f64> = (0..free.nrows()).map(share).collect();
    free.transpose_times(&shares)
}

#[cfg(test)]
mod tests;
