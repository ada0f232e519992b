//! Poses that a mechanism reaches on its kept rows: what is redundant is so at all of them, what is singular is so at one.

use linalg::Matrix;
use model::System;
use model::start::nearest_configuration;

use super::pose::Candidate;
use super::share::Question;
use crate::mechanism::{dimensionless, velocity_units};

/// Poses to each side.
const POSES: usize = 3;

/// From one pose to the next: a share of the size, or radians. Short, so that the walk does not pass a singular pose onto another branch.
const REACH: f64 = 0.05;

/// Steps from one pose to the next.
const STEPS: usize = 5;

/// Coordinates of up to six poses on both sides of the pose of the question, on the kept rows of Φ, along velocities that all kept rows allow:
/// mainly the one that the kept rows alone set free.
pub(super) fn walk(question: &Question<'_>, kept: &[usize]) -> Vec<Vec<f64>> {
    let mut poses = Vec::new();
    for side in [1.0, -1.0] {
        let mut q = question.q.to_vec();
        let mut heading: Option<Vec<f64>> = None;
        for _ in 0..POSES {
            let reached =
                (0..STEPS).all(|_| step(question, kept, side, &mut q, &mut heading).is_some());
            if !reached {
                break;
            }
            poses.push(q.clone());
        }
    }
    poses
}

/// One step; `None` where it leads nowhere.
fn step(
    question: &Question<'_>,
    kept: &[usize],
    side: f64,
    q: &mut Vec<f64>,
    heading: &mut Option<Vec<f64>>,
) -> Option<()> {
    let mechanism = question.mechanism;
    let t = question.s.t;
    let s = crate::mechanism::evaluated(mechanism, t, q);
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
    let stride = REACH / STEPS as f64 * question.size / largest;
    let units = velocity_units(mechanism, question.size);
    let velocity: Vec<f64> = direction
        .iter()
        .zip(&units)
        .map(|(d, unit)| d * unit)
        .collect();
    let moved = mechanism.displaced(q, stride, &velocity);
    let m = mechanism.layout().m;
    let holonomic: Vec<usize> = kept.iter().copied().filter(|&i| i < m).collect();
    *q = nearest_configuration(mechanism, t, &holonomic, &moved).ok()?;
    *heading = Some(direction);
    Some(())
}

/// Velocities without dimensions that the kept rows allow, one in each row, the one that the other rows resist most first.
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
