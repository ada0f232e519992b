//! Does it move? A step along a motion that all rows allow to first order, and Newton's method on
//! all rows: if that ends on the constraints and away from where it began, the mechanism moves.

use model::start::scene_size;
use model::{Mechanism, System};
use nalgebra::{DMatrix, DVector};

use super::oracle::units;
use crate::numbers::Numbers;

/// Length of a step, in sizes of the mechanism.
const STEP: f64 = 1e-3;

/// Residuals of rows after the step, in sizes of the mechanism. A freedom that second order blocks
/// leaves the square of the step, 1e-6.
const ON_ROWS: f64 = 1e-12;

/// Singular values below this fraction of the largest one count as zero in a correction.
const ZERO: f64 = 1e-6;

const ITERATIONS: usize = 12;

/// Directions that are tried.
const TRIES: usize = 6;

/// A scaled C, or its holonomic rows, decomposed.
struct Linear {
    left: DMatrix<f64>,
    values: Vec<f64>,
    right: DMatrix<f64>,
    scale: Vec<f64>,
}

impl Linear {
    fn of(mechanism: &Mechanism, (t, q): (f64, &[f64]), rows: usize, size: f64) -> Option<Self> {
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        let scale = units(mechanism, size);
        let dense = mechanism.layout().dense(&s);
        let c = DMatrix::from_fn(rows, scale.len(), |i, j| dense[(i, j)] * scale[j]);
        if rows == 0 || c.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let svd = c.svd(true, true);
        let largest = svd.singular_values.max();
        let values: Vec<f64> = svd.singular_values.iter().copied().collect();
        let rank = values.iter().filter(|x| **x > ZERO * largest).count();
        Some(Self {
            left: svd.u?.columns(0, rank).into_owned(),
            values: values[..rank].to_vec(),
            right: svd.v_t?.rows(0, rank).transpose(),
            scale,
        })
    }

    fn rank(&self) -> usize {
        self.values.len()
    }

    /// The smallest x with `C·x ≈ g`, in units of velocities.
    fn solve(&self, g: &DVector<f64>) -> Vec<f64> {
        let along = self.left.transpose() * g;
        let divided = DVector::from_fn(self.rank(), |k, _| along[k] / self.values[k]);
        let x = &self.right * divided;
        x.iter().zip(&self.scale).map(|(x, d)| x * d).collect()
    }

    /// A random motion that all rows allow, of unit length; `None` if there is none.
    fn free(&self, numbers: &mut Numbers) -> Option<Vec<f64>> {
        let n = self.scale.len();
        if self.rank() >= n {
            return None;
        }
        let mut x = DVector::from_fn(n, |_, _| numbers.unit());
        x -= &self.right * (self.right.transpose() * &x);
        x.normalize_mut();
        Some(x.iter().zip(&self.scale).map(|(x, d)| x * d).collect())
    }
}

/// The ranks of C at a configuration, and the largest at configurations near it: the former is
/// lower where the configuration is singular.
#[must_use]
pub fn ranks(mechanism: &Mechanism, (t, q): (f64, &[f64]), numbers: &mut Numbers) -> [usize; 2] {
    let size = scene_size(mechanism, q);
    let rows = mechanism.layout().rows();
    let rank = |q: &[f64]| Linear::of(mechanism, (t, q), rows, size).map_or(0, |c| c.rank());
    let here = rank(q);
    let near = (0..3).map(|_| {
        let d: Vec<f64> = (0..mechanism.layout().n_v)
            .map(|_| 0.1 * size * numbers.unit())
            .collect();
        let units = units(mechanism, size);
        let d: Vec<f64> = d.iter().zip(&units).map(|(d, u)| d * u).collect();
        let mut moved = q.to_vec();
        mechanism.displace(&mut moved, &d);
        corrected(mechanism, t, &mut moved, size).then(|| rank(&moved))
    });
    [here, near.flatten().fold(here, usize::max)]
}

/// Whether an own step moves the mechanism at a configuration: along velocities that its drives
/// require, or along any free motion.
#[must_use]
pub fn moves(mechanism: &Mechanism, (t, q): (f64, &[f64]), numbers: &mut Numbers) -> bool {
    let size = scene_size(mechanism, q);
    let layout = mechanism.layout();
    let Some(c) = Linear::of(mechanism, (t, q), layout.rows(), size) else {
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
        return continues(mechanism, (t, q, &driven), STEP * size / rate);
    }
    (0..TRIES).any(|_| {
        c.free(numbers).is_some_and(|v| {
            let v: Vec<f64> = v.iter().map(|x| x * size).collect();
            steps(mechanism, t, (q, &v), STEP, size)
        })
    })
}

/// Whether the motion goes on for a time `dt` after a state.
#[must_use]
pub fn continues(mechanism: &Mechanism, (t, q, v): (f64, &[f64], &[f64]), dt: f64) -> bool {
    steps(mechanism, t + dt, (q, v), dt, scene_size(mechanism, q))
}

/// Whether Newton's method at time t, begun at `q + v·dt`, ends on the constraints, within half of
/// that step of where it began.
fn steps(mechanism: &Mechanism, t: f64, (q, v): (&[f64], &[f64]), dt: f64, size: f64) -> bool {
    let step: Vec<f64> = v.iter().map(|v| v * dt).collect();
    let mut moved = q.to_vec();
    mechanism.displace(&mut moved, &step);
    let begun = moved.clone();
    if !corrected(mechanism, t, &mut moved, size) {
        return false;
    }
    let [far, corrected] =
        [q, &begun].map(|from| mechanism.largest_difference(&moved, from, size).1);
    corrected <= 0.5 * far
}

/// Moves a configuration onto all holonomic rows; whether that succeeded.
fn corrected(mechanism: &Mechanism, t: f64, q: &mut [f64], size: f64) -> bool {
    let m = mechanism.layout().m;
    if m == 0 {
        return true;
    }
    let mut s = mechanism.scratch();
    for _ in 0..ITERATIONS {
        mechanism.pose(t, q, &mut s);
        mechanism.phi(&mut s);
        if linalg::kernels::max_abs(&s.phi) <= ON_ROWS * size {
            return true;
        }
        let Some(c) = Linear::of(mechanism, (t, q), m, size) else {
            return false;
        };
        let step: Vec<f64> = c
            .solve(&DVector::from_column_slice(&s.phi))
            .iter()
            .map(|x| -x)
            .collect();
        if step.iter().any(|x| !x.is_finite()) {
            return false;
        }
        mechanism.displace(q, &step);
    }
    false
}
