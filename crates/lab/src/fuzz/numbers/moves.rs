//! Decides whether a mechanism moves. The test makes a step along a motion that all rows allow to
//! first order, followed by Newton's method for all rows. The mechanism moves if the result
//! satisfies the constraints and differs from the initial configuration.

use model::start::scene_size;
use model::{Mechanism, System};
use nalgebra::{DMatrix, DVector};

use super::decomposition::Decomposition;
use super::oracle::units;
use suite::numbers::Numbers;

/// Length of a step along the motion that drives require, as a fraction of the size of the
/// mechanism.
const STEP: f64 = 1e-3;

/// Length of a step along a free motion. The step is long enough to detect a motion that is blocked
/// only at third order. The residual of this motion is the cube of the remaining part of the step.
const FREE_STEP: f64 = 1e-2;

/// Largest residual of rows after the step, as a fraction of the size of the mechanism.
const ON_ROWS: f64 = 1e-12;

/// Singular values below this fraction of the largest singular value count as zero in a correction.
const ZERO: f64 = 1e-6;

/// Largest number of iterations. If rows are dependent only to second order, each iteration halves
/// the distance.
const ITERATIONS: usize = 40;

/// A mechanism moves if at least this fraction of the step remains after the correction.
const AWAY: f64 = 0.2;

/// Number of short steps of a continued motion.
const MARCH: usize = 8;

/// Number of directions that are tried.
const TRIES: usize = 6;

/// The decomposition of a scaled C, or of its holonomic rows.
struct Linear {
    range: Decomposition,
    scale: Vec<f64>,
}

impl Linear {
    fn of(mechanism: &Mechanism, (t, q): (f64, &[f64]), rows: &[usize], size: f64) -> Option<Self> {
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        let scale = units(mechanism, size);
        let dense = mechanism.layout().dense(&s);
        let c = DMatrix::from_fn(rows.len(), scale.len(), |i, j| {
            dense[(rows[i], j)] * scale[j]
        });
        if rows.is_empty() || c.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let range = Decomposition::of(&c).above(ZERO);
        Some(Self { range, scale })
    }

    fn rank(&self) -> usize {
        self.range.rank()
    }

    /// Returns the vector x of smallest norm with `C·x ≈ g`, in units of velocities.
    fn solve(&self, g: &DVector<f64>) -> Vec<f64> {
        let x = self.range.solve(g);
        x.iter().zip(&self.scale).map(|(x, d)| x * d).collect()
    }

    /// Returns a random motion that all rows allow, of unit length; `None` if no such motion
    /// exists.
    fn free(&self, numbers: &mut Numbers) -> Option<Vec<f64>> {
        let n = self.scale.len();
        if self.rank() >= n {
            return None;
        }
        let mut x = DVector::from_fn(n, |_, _| numbers.unit());
        x -= &self.range.right * (self.range.right.transpose() * &x);
        x.normalize_mut();
        Some(x.iter().zip(&self.scale).map(|(x, d)| x * d).collect())
    }
}

/// Returns the rank of C without drives at a configuration, and the largest rank at neighbouring
/// configurations. At a singular configuration the first rank is lower.
#[must_use]
pub fn ranks(mechanism: &Mechanism, (t, q): (f64, &[f64]), numbers: &mut Numbers) -> [usize; 2] {
    let size = scene_size(mechanism, q);
    let layout = mechanism.layout();
    let drives = layout.drive_rows();
    let rows: Vec<usize> = (0..layout.rows()).filter(|i| !drives.contains(i)).collect();
    let positions: Vec<usize> = rows.iter().copied().filter(|i| *i < layout.m).collect();
    let rank = |q: &[f64]| Linear::of(mechanism, (t, q), &rows, size).map_or(0, |c| c.rank());
    let units = units(mechanism, size);
    let mut near = |length: f64| {
        let mut moved = q.to_vec();
        let unit = units.iter().map(|unit| length * size * unit);
        let d: Vec<f64> = unit.map(|unit| unit * numbers.unit()).collect();
        mechanism.displace(&mut moved, &d);
        corrected(mechanism, (t, &positions), &mut moved, size).then(|| rank(&moved))
    };
    let here = rank(q);
    let near = [0.1, 0.1, 0.03, 0.03].map(&mut near);
    [here, near.into_iter().flatten().fold(here, usize::max)]
}

/// Whether a mechanism can move from a configuration, according to an independent step. The step is
/// along velocities that the drives require, or along any free motion.
#[must_use]
pub fn moves(mechanism: &Mechanism, (t, q): (f64, &[f64]), numbers: &mut Numbers) -> bool {
    let size = scene_size(mechanism, q);
    let layout = mechanism.layout();
    let Some(c) = Linear::of(mechanism, (t, q), &all(layout.rows()), size) else {
        return layout.rows() == 0;
    };
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    let b = DVector::from_column_slice(&s.b);
    let driven = c.solve(&b);
    let rate = driven.iter().zip(&c.scale).map(|(v, d)| (v / d).abs());
    let rate = rate.fold(0.0, f64::max);
    if rate > 1e-9 * size {
        return marches(mechanism, (t, q, &driven), STEP * size / rate);
    }
    (0..TRIES).any(|_| {
        c.free(numbers).is_some_and(|v| {
            let step: Vec<f64> = v.iter().map(|x| FREE_STEP * x * size).collect();
            steps(mechanism, t, (q, &step), size)
        })
    })
}

/// Whether the motion continues for a time `dt` after a state.
#[must_use]
pub fn marches(mechanism: &Mechanism, state: (f64, &[f64], &[f64]), dt: f64) -> bool {
    march(mechanism, state, dt).is_some()
}

/// Computes the configuration at the time `dt` after a state in several short steps; `None` if a
/// step does not end at a configuration that satisfies the constraints.
#[must_use]
pub fn march(mechanism: &Mechanism, (t, q, v): (f64, &[f64], &[f64]), dt: f64) -> Option<Vec<f64>> {
    let size = scene_size(mechanism, q);
    let short = dt / MARCH as f64;
    let positions = all(mechanism.layout().m);
    let mut step: Vec<f64> = v.iter().map(|v| v * short).collect();
    let mut at = q.to_vec();
    for k in 1..=MARCH {
        let mut next = at.clone();
        mechanism.displace(&mut next, &step);
        if !corrected(
            mechanism,
            (t + k as f64 * short, &positions),
            &mut next,
            size,
        ) {
            return None;
        }
        mechanism.difference(&next, &at, &mut step);
        at = next;
    }
    Some(at)
}

/// Whether Newton's method at time t, started at `q + step`, ends at a configuration that satisfies
/// the constraints and differs from q.
fn steps(mechanism: &Mechanism, t: f64, (q, step): (&[f64], &[f64]), size: f64) -> bool {
    let positions = all(mechanism.layout().m);
    let mut moved = q.to_vec();
    mechanism.displace(&mut moved, step);
    let [begun, ended] = [false, true].map(|ends| {
        let is_on = !ends || corrected(mechanism, (t, &positions), &mut moved, size);
        is_on.then(|| mechanism.largest_difference(&moved, q, size).1)
    });
    matches!((begun, ended), (Some(begun), Some(ended)) if ended >= AWAY * begun)
}

fn all(to: usize) -> Vec<usize> {
    (0..to).collect()
}

/// Corrects a configuration so that it satisfies these holonomic rows; returns whether this
/// succeeded.
fn corrected(mechanism: &Mechanism, (t, rows): (f64, &[usize]), q: &mut [f64], size: f64) -> bool {
    let mut s = mechanism.scratch();
    for _ in 0..ITERATIONS {
        mechanism.pose(t, q, &mut s);
        mechanism.phi(&mut s);
        let missing = DVector::from_iterator(rows.len(), rows.iter().map(|&i| -s.phi[i]));
        if missing.amax() <= ON_ROWS * size {
            return true;
        }
        let Some(c) = Linear::of(mechanism, (t, q), rows, size) else {
            return false;
        };
        let step = c.solve(&missing);
        if step.iter().any(|x| !x.is_finite()) {
            return false;
        }
        mechanism.displace(q, &step);
    }
    false
}
