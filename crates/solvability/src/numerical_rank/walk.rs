//! Continuation of a mechanism on its kept rows to other configurations. A redundancy exists at all
//! of these configurations, but a singularity exists at only one configuration.
//!
//! Within a stated tolerance, the intended mechanism has other data and a nearby configuration. To
//! first order, data within the tolerance move a configuration by up to δq, and C_K changes along
//! this displacement by δC_K. By the theorem of Newton and Kantorovich, the configuration certainly
//! exists if `‖C_K⁺·δC_K‖ ≤ ½`. Beyond this limit, the first order is not sufficient. Near a
//! singular configuration of the kept rows, a continuation may follow a branch that the intended
//! mechanism does not have.
//!
//! Source: P. Deuflhard, Newton Methods for Nonlinear Problems (2004), section 2.1, for the form
//! that does not depend on the scales of the rows.

use crate::limits::{
    KNOWN_POSE, OTHER_DIRECTIONS, WALK_CORRECTED, WALK_POSES, WALK_REACH, WALK_SMALL_STEPS,
    WALK_STEPS,
};
use crate::pose::{dimensionless, velocity_units};
use linalg::{Matrix, singular_values};
use model::System;
use model::start::{Metric, nearest_configuration};

use super::follow::{Ground, Step};
use super::pose::Candidate;
use super::share::Question;

/// Configurations that a continuation has reached.
pub(super) struct Walk {
    sides: [Side; 2],
    /// Whether no motion is possible.
    is_still: bool,
}

/// Configurations on one side of the first configuration.
#[derive(Default)]
struct Side {
    /// Steps to the configurations, if nonholonomic rows are kept.
    way: Vec<Step>,
    stops: Vec<Stop>,
}

/// A configuration of the continuation.
struct Stop {
    /// Coordinates of the configuration.
    q: Vec<f64>,
    /// Number of steps to this configuration.
    steps: usize,
    /// `‖C_K⁺·δC_K‖` for data within the stated tolerance; zero without a tolerance.
    blur: f64,
}

impl Walk {
    /// Returns the coordinates of each configuration of one side, and the steps that lead to it,
    /// the last step first. There are no steps if only holonomic rows are kept, because these rows
    /// determine every configuration directly.
    pub(super) fn poses(
        &self,
        side: usize,
    ) -> impl Iterator<Item = (&[f64], impl Iterator<Item = &Step>)> {
        let Side { way, stops } = &self.sides[side];
        let steps = |stop: &Stop| way[..stop.steps].iter().rev();
        stops.iter().map(move |stop| (&*stop.q, steps(stop)))
    }

    /// Returns the last configuration.
    pub(super) fn farthest(&self) -> Option<&[f64]> {
        let last = self.sides.iter().rev().find_map(|side| side.stops.last());
        last.map(|stop| &*stop.q)
    }

    /// Returns the number of configurations on each side.
    pub(super) fn reach(&self) -> [usize; 2] {
        self.sides.each_ref().map(|side| side.stops.len())
    }

    /// Returns the number of configurations on each side before the limit of the first order. At
    /// this limit, data within the tolerance move a configuration too far for the first order.
    pub(super) fn known_reach(&self) -> [usize; 2] {
        self.sides.each_ref().map(|side| {
            let known = side.stops.iter().take_while(|stop| stop.blur <= KNOWN_POSE);
            known.count()
        })
    }

    /// Removes the configuration that data within the tolerance move farthest, and all
    /// configurations beyond this configuration, from the reach. The configurations are removed
    /// only if changes of the data by this share of the tolerance move the configuration too far
    /// for the first order.
    pub(super) fn shorter(&self, reach: [usize; 2], share: f64) -> Option<[usize; 2]> {
        let of_side = |k: usize| {
            let stops = self.sides[k].stops[..reach[k]].iter().enumerate();
            stops.map(move |(at, stop)| (stop.blur, k, at))
        };
        let blurred = [0, 1].into_iter().flat_map(of_side);
        let (blur, side, at) = blurred.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut reach = reach;
        reach[side] = at;
        (blur * share > KNOWN_POSE).then_some(reach)
    }

    /// Returns whether all configurations of one side are within reach, or whether no motion is
    /// possible.
    pub(super) fn is_complete(&self, reach: [usize; 2]) -> bool {
        self.is_still || reach.contains(&WALK_POSES)
    }
}

/// Returns up to six configurations on both sides of the given configuration, on the kept rows of
/// Φ. The continuation uses velocities that all kept rows allow. The continuation mainly uses the
/// velocity that only the dropped rows prevent.
pub(super) fn walk(question: &Question<'_>, kept: &[usize]) -> Walk {
    let (mechanism, size) = (question.mechanism, question.size);
    let ground = Ground {
        mechanism,
        kept,
        units: &velocity_units(mechanism, size),
        size,
        t: question.s.t,
    };
    let is_still = free_directions(&dimensionless(mechanism, question.s, size), kept).nrows() == 0;
    let mut sides = [Side::default(), Side::default()];
    let signs = if is_still { &[][..] } else { &[1.0, -1.0] };
    for (Side { way, stops }, sign) in sides.iter_mut().zip(signs) {
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
            (q, heading) = (there, on);
            way.extend(taken);
            stops.push(Stop {
                blur: question.tolerance().map_or(0.0, |_| blur(&ground, &q)),
                q: q.clone(),
                steps: way.len(),
            });
        }
    }
    Walk { sides, is_still }
}

/// Returns `‖C_K⁺·δC_K‖` of the kept rows of Φ. The data change within their uncertainty so that
/// one coordinate of the configuration moves as far as possible.
fn blur(ground: &Ground<'_>, q: &[f64]) -> f64 {
    let (mechanism, data) = (ground.mechanism, ground.mechanism.data());
    let rows = ground.holonomic();
    let (s, c) = ground.at(q);
    let kept = c.select_rows(&rows);
    let followed = ground.followed(&c, &rows);
    let (blocks, slopes) = (data.blocks(&s), data.slopes(&s));
    let gradient_of = |lambda: &[f64]| {
        let mut gradient = vec![0.0; data.count()];
        slopes.add_phi(lambda, 1.0, &mut gradient);
        gradient
    };
    let of_column = |column: usize| {
        let mut own = vec![0.0; ground.units.len()];
        own[column] = 1.0;
        let gradient = gradient_of(&followed.split(&own, mechanism.layout().rows()).0);
        let changes = blocks.iter().map(|b| b.change(&gradient, b.known_to()));
        (changes.sum::<f64>() / ground.units[column], gradient)
    };
    let moved = (0..ground.units.len()).map(of_column);
    let Some((_, gradient)) = moved.max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return 0.0;
    };
    // The change of each row by these changes of the data.
    let missed = rows.iter().map(|&row| {
        let mut own = vec![0.0; mechanism.layout().rows()];
        own[row] = 1.0;
        let by = gradient_of(&own);
        let changes = blocks.iter().map(|b| {
            let (along, by) = (b.part(&gradient), b.part(&by));
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            match dot(along, along).sqrt() {
                0.0 => 0.0,
                size => b.known_to() * dot(along, by) / size,
            }
        });
        changes.sum::<f64>()
    });
    let moved = followed.answer(&missed.collect::<Vec<_>>());
    let (_, there) = ground.at(&mechanism.space().displaced(q, -1.0, &moved));
    let mut change = there.select_rows(&rows);
    for (x, here) in change.as_mut_slice().iter_mut().zip(kept.as_slice()) {
        *x -= here;
    }
    let blur = singular_values(&followed.through(&change)).first().copied();
    // A change that is not a number counts as infinite.
    blur.map_or(0.0, |blur| if blur.is_nan() { f64::INFINITY } else { blur })
}

/// Performs one step. The step is recorded if nonholonomic rows are kept. Returns `None` if the
/// step fails.
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
        // Projects the last step onto the free directions.
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
    let correction = mechanism.difference_of(&there, &ahead);
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

/// Returns dimensionless velocities that the kept rows allow, one in each row. The velocity that
/// the other rows constrain most comes first.
fn free_directions(c: &Matrix, kept: &[usize]) -> Matrix {
    Candidate::of_rows(c, kept.to_vec()).into_free()
}

/// Returns the first direction with a small part of the other directions, so that every freedom
/// moves.
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
