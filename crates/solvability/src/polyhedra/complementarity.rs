//! Accelerations of supports that can lift.
//!
//! Without supporting forces, the gaps of n supports have the accelerations r. The forces f ≥ 0 add
//! W·f, so that `a = r + W·f ≥ 0`. A support that lifts carries no load: `f·a = 0`. By Gauss'
//! principle f minimises `½·fᵀ·W·f + rᵀ·f`. The accelerations a are unique. The forces are not
//! unique if supports are redundant, that is, if W is singular.
//!
//! The method is described by C. L. Lawson and R. J. Hanson, *Solving Least Squares Problems*,
//! 1974, chapter 23. A support is added to the supports that carry a load only if its acceleration
//! is negative. The column of W of this support is then independent of the columns of these
//! supports. Therefore the forces of these supports are unique.

use linalg::{Dd, Lu, Matrix, kernels};

use super::{Unclear, exact_dot, refined};
use crate::limits::{CLEAR_SUPPORT, PIVOTS, SUPPORT_ROUNDING};

/// Forces and accelerations of supports.
#[derive(Debug)]
pub(crate) struct SupportMotion {
    /// Forces f ≥ 0 of the supports. The forces are one of several possible solutions if supports
    /// are redundant.
    pub(crate) forces: Vec<f64>,
    /// Accelerations a ≥ 0 of the gaps. A support lifts if and only if its acceleration is
    /// positive.
    pub(crate) accelerations: Vec<f64>,
}

/// Solves `a = r + W·f ≥ 0`, `f ≥ 0`, `f·a = 0` for a symmetric matrix W without negative
/// eigenvalues.
///
/// # Panics
/// Panics if W and r differ in size.
pub(crate) fn support_motion(w: &Matrix, r: &[f64]) -> Result<SupportMotion, Unclear> {
    let n = r.len();
    assert_eq!((w.nrows(), w.ncols()), (n, n), "W of {n} supports");
    let size = kernels::max_abs(r);
    let zero = SUPPORT_ROUNDING * size;
    let mut forces = vec![0.0; n];
    let mut carrying: Vec<usize> = Vec::new();
    for _ in 0..PIVOTS {
        let mut accelerations: Vec<f64> = (0..n)
            .map(|k| (exact_dot(w.row(k), &forces) + Dd::from(r[k])).to_f64())
            .collect();
        let others = (0..n).filter(|k| !carrying.contains(k));
        let sinking = others.filter(|&k| accelerations[k] < -zero);
        let slope = |&k: &usize| accelerations[k] / w[(k, k)].sqrt();
        let Some(next) = sinking.min_by(|j, k| slope(j).total_cmp(&slope(k))) else {
            for (k, a) in accelerations.iter_mut().enumerate() {
                if a.abs() <= zero {
                    *a = 0.0;
                } else if carrying.contains(&k) || a.is_nan() {
                    return Err(Unclear::Unproved);
                } else if *a < CLEAR_SUPPORT * size {
                    return Err(Unclear::Acceleration(*a));
                }
            }
            return Ok(SupportMotion {
                forces,
                accelerations,
            });
        };
        let independent = independent_part(w, &carrying, next)?;
        if independent.is_nan() || independent <= SUPPORT_ROUNDING {
            return Err(Unclear::Component(independent));
        }
        carrying.push(next);
        carry(w, r, &mut carrying, &mut forces)?;
    }
    Err(Unclear::Steps)
}

/// Returns the acceleration of a support due to its own force, if the other supports stay closed.
fn independent_part(w: &Matrix, carrying: &[usize], next: usize) -> Result<f64, Unclear> {
    let column: Vec<f64> = carrying.iter().map(|&k| w[(k, next)]).collect();
    let share = solve(w, carrying, &column)?;
    let own = Dd::from(w[(next, next)]);
    Ok((own - exact_dot(&column, &share)).to_f64() / own.to_f64())
}

/// Computes the forces with which the supports that carry a load have no acceleration. Supports
/// whose force would be negative are removed.
fn carry(
    w: &Matrix,
    r: &[f64],
    carrying: &mut Vec<usize>,
    forces: &mut [f64],
) -> Result<(), Unclear> {
    loop {
        let right: Vec<f64> = carrying.iter().map(|&k| -r[k]).collect();
        let target = solve(w, carrying, &right)?;
        let pulling = carrying.iter().zip(&target).filter(|(_, to)| **to <= 0.0);
        let first = pulling
            .map(|(&k, to)| (forces[k] / (forces[k] - to), k))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let step = first.map_or(1.0, |(step, _)| step);
        for (&k, to) in carrying.iter().zip(&target) {
            forces[k] = if step < 1.0 {
                forces[k] + step * (to - forces[k])
            } else {
                *to
            };
        }
        let Some((_, first)) = first else {
            return Ok(());
        };
        forces[first] = 0.0;
        carrying.retain(|&k| {
            let stays = forces[k] > 0.0;
            if !stays {
                forces[k] = 0.0;
            }
            stays
        });
    }
}

/// Solves the equations with the rows and columns of these supports.
fn solve(w: &Matrix, supports: &[usize], right: &[f64]) -> Result<Vec<f64>, Unclear> {
    let entry = |i: usize, j: usize| w[(supports[i], supports[j])];
    let mut factors = Lu::new(supports.len());
    let singular = |_| Unclear::Component(0.0);
    factors.factor(entry).map_err(singular)?;
    Ok(refined(&mut factors, entry, right))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the accelerations for the first set of supports that carry a load and satisfy all
    /// conditions. W must be regular.
    fn enumerated(w: &Matrix, r: &[f64]) -> Vec<f64> {
        let n = r.len();
        let mut solutions = (0..1_usize << n).filter_map(|set| {
            let carrying: Vec<usize> = (0..n).filter(|k| set >> k & 1 == 1).collect();
            let right: Vec<f64> = carrying.iter().map(|&k| -r[k]).collect();
            let carried = solve(w, &carrying, &right).ok()?;
            let mut forces = vec![0.0; n];
            for (&k, f) in carrying.iter().zip(&carried) {
                forces[k] = *f;
            }
            let mut a = w.times(&forces);
            kernels::axpy(1.0, r, &mut a);
            let fits = forces.iter().chain(&a).all(|x| *x >= -1e-9);
            fits.then_some(a)
        });
        solutions.next().expect("a solution")
    }

    /// W = J·Jᵀ for random directions of supports, and r = J·g for random loads. Redundant supports
    /// are therefore consistent.
    #[test]
    fn accelerations_are_those_of_the_set_that_carries() {
        let mut x = 0.41_f64;
        let mut next = || {
            x = (x * 97.31 + 0.519).fract();
            2.0 * x - 1.0
        };
        let (mut lifted, mut closed) = (0, 0);
        for case in 0..400_usize {
            let n = 1 + case % 6;
            let freedoms = if case % 2 == 0 { n } else { n.div_ceil(2) };
            let j = Matrix::from_fn(n, freedoms, |_, _| next());
            let load: Vec<f64> = (0..freedoms).map(|_| next()).collect();
            let (w, r) = (j.product(&j.transpose()), j.times(&load));
            let found = support_motion(&w, &r).unwrap();
            for k in 0..n {
                let (f, a) = (found.forces[k], found.accelerations[k]);
                assert!(f >= 0.0 && a >= 0.0 && f * a == 0.0, "{f} {a}");
                lifted += usize::from(a > 0.0);
                closed += usize::from(a == 0.0);
            }
            if freedoms == n {
                for (a, expected) in found.accelerations.iter().zip(enumerated(&w, &r)) {
                    assert!((a - expected).abs() < 1e-9, "{a} is not {expected}");
                }
            }
            let moved: Vec<f64> = found
                .accelerations
                .iter()
                .zip(&r)
                .map(|(a, r)| a - r)
                .collect();
            for (moved, supporting) in moved.iter().zip(w.times(&found.forces)) {
                assert!((moved - supporting).abs() < 1e-11);
            }
        }
        assert!(
            lifted > 200 && closed > 200,
            "{lifted} lift, {closed} do not"
        );
    }

    /// A table of 12 kg on four feet, with the load 0.1 m beyond the edge AB. The table rotates
    /// about the edge with α = m·g·d/(I + m·d²), I = 1 kg·m².
    #[test]
    fn a_table_tips_about_its_edge() {
        let (m, i, g, d) = (12.0, 1.0, 9.81, 0.1);
        // Feet relative to the mass centre: A and B at the edge, C and D one metre behind.
        let feet = [[-0.5, -d], [0.5, -d], [0.5, -d - 1.0], [-0.5, -d - 1.0]];
        // Velocities: up, and rotations about the two axes of the plane.
        let inertia = [m, i, i];
        let rows = feet.map(|[x, y]| [1.0, y, -x]);
        let w = Matrix::from_fn(4, 4, |k, l| {
            (0..3).map(|c| rows[k][c] * rows[l][c] / inertia[c]).sum()
        });
        let found = support_motion(&w, &[-g; 4]).unwrap();
        let alpha = m * g * d / (i + m * d * d);
        let expected = [0.0, 0.0, alpha, alpha];
        for (a, expected) in found.accelerations.iter().zip(expected) {
            assert!((a - expected).abs() < 1e-12, "{a} is not {expected}");
        }
        // The acceleration of the mass centre is downwards.
        let up: f64 = found.forces.iter().sum::<f64>() / m - g;
        assert!((up + alpha * d).abs() < 1e-12, "{up}");
    }

    #[test]
    fn contradicting_supports_are_undecided() {
        // Two supports at one place, with different accelerations of the ground.
        let one = Matrix::from_rows(&[[1.0, 1.0], [1.0, 1.0]]);
        let found = support_motion(&one, &[-1.0, -0.5]).unwrap();
        assert_eq!(found.accelerations, [0.0, 0.5]);
        let opposite = Matrix::from_rows(&[[1.0, -1.0], [-1.0, 1.0]]);
        let found = support_motion(&opposite, &[-1.0, -0.5]).map(|found| found.forces);
        assert!(matches!(found, Err(Unclear::Component(_))), "{found:?}");
        let doubt = support_motion(&Matrix::identity(2), &[-1.0, 1e-10]).err();
        assert_eq!(doubt, Some(Unclear::Acceleration(1e-10)));
        let immovable = support_motion(&Matrix::zeros(1, 1), &[-1.0]).err();
        assert!(immovable.is_some());
        assert!(
            support_motion(&Matrix::zeros(0, 0), &[])
                .unwrap()
                .forces
                .is_empty()
        );
    }
}
