//! Computes a configuration near the constraints from a distant initial configuration, by damped
//! least squares of the violations of the joints. Violations are lengths; angles are multiplied by
//! the size of the mechanism. Masses have no influence. With weights by mass, a light body could
//! rotate far and end on the opposite side of its joint.
//!
//! Source: Levenberg–Marquardt method, as in J. Nocedal, S. Wright, Numerical Optimization, 2nd
//! ed., section 10.3, with corrections of minimum norm, so that rows may be redundant.

use linalg::{Matrix, least_squares_step};

use super::error::{Misfit, StartError};
use super::metric::{Restricting, SMALL_CORRECTION, dense_rows, lengths};
use super::parallel::Parallel;
use crate::mechanism::{Mechanism, unmet_rows};
use crate::system::{Scratch, System};

/// Joints are not listed in messages if their violation is below this fraction of the largest
/// violation.
const NAMED_MISFIT: f64 = 1e-2;

/// Largest number of steps. An initial configuration with errors of 20 % and 20° needs about ten
/// steps.
const ITERATIONS: usize = 200;

/// Largest rotation in one step (rad), and largest displacement in one step as a fraction of the
/// size. For larger steps, the linearised rows are not accurate.
const LARGEST_STEP: f64 = 0.5;

/// The constraints count as approximately satisfied if every row is violated by less than this
/// fraction of the size (or of a radian). From such a configuration, the iteration of
/// [`super::nearest`] converges.
const REACHED: f64 = 1e-9;

/// Initial damping, smallest damping, and the damping at which the iteration stops. All values are
/// relative to rows of norm one.
const DAMPING: f64 = 1e-3;
const LEAST_DAMPING: f64 = 1e-12;
const MOST_DAMPING: f64 = 1e8;

/// Factor by which the damping is multiplied or divided.
const FACTOR: f64 = 10.0;

/// The iteration ends if a step reduces the residual by less than this fraction.
const STILL: f64 = 1e-10;

/// Residuals of rows at a configuration, and their derivatives with respect to displacements along
/// the velocity components.
struct Linearisation {
    /// Residuals in metres; residuals of angles are multiplied by the size of the mechanism.
    residual: Vec<f64>,
    /// Derivatives, with one row for each residual.
    c: Matrix,
}

impl Linearisation {
    fn square(&self) -> f64 {
        self.residual.iter().map(|r| r * r).sum()
    }
}

/// Returns the residuals of these rows at q. Rotation vectors replace products of directions.
/// Therefore an axis with the opposite direction does not satisfy the rows.
fn linearised(
    mechanism: &Mechanism,
    s: &mut Scratch,
    rows: &[usize],
    q: &[f64],
    size: f64,
) -> Result<Linearisation, StartError> {
    let layout = mechanism.layout();
    mechanism.pose(mechanism.layout().start_time, q, s);
    mechanism.phi(s);
    mechanism.c(s);
    let mut c = dense_rows(layout, s, rows)?;
    let mut residual: Vec<f64> = rows.iter().map(|&r| s.phi[r]).collect();
    let space = mechanism.space();
    for joint in &mechanism.elements.constraints {
        let Some(parallel) = Parallel::of(joint, s) else {
            continue;
        };
        for (row, (angle, gradient)) in parallel.rows.zip(parallel.each) {
            let Ok(k) = rows.binary_search(&row) else {
                continue;
            };
            residual[k] = angle;
            c.row_mut(k).fill(0.0);
            for (slot, sign) in [(0, -1.0), (1, 1.0)] {
                let Some(body) = joint.site.bodies[slot].moving() else {
                    continue;
                };
                let columns = space.rotations_of(body).zip(s.bodies.axes(body));
                for (column, axis) in columns {
                    c[(k, column)] += sign * joints::space3::dot(gradient, axis);
                }
            }
        }
    }
    for (k, &row) in rows.iter().enumerate() {
        if layout.is_angular(row) {
            residual[k] *= size;
            c.row_mut(k).iter_mut().for_each(|x| *x *= size);
        }
    }
    Ok(Linearisation { residual, c })
}

/// Returns whether the axes that the joints keep parallel have the described direction at q instead
/// of the opposite direction. All requirements of definitions must also be satisfied (for example,
/// a wheel is above the ground).
pub(super) fn is_meant(mechanism: &Mechanism, s: &mut Scratch, q: &[f64]) -> bool {
    if !unmet_rows(mechanism, q).is_empty() {
        return false;
    }
    mechanism.pose(mechanism.layout().start_time, q, s);
    let joints = mechanism.elements.constraints.iter();
    let mut axes = joints.filter_map(|joint| Parallel::of(joint, s));
    axes.all(|axes| axes.is_as_described())
}

/// Returns whether the violation of the rows at q is within the default limit for corrections of
/// the initial configuration.
pub(super) fn is_near(
    mechanism: &Mechanism,
    s: &mut Scratch,
    rows: &[usize],
    q: &[f64],
    size: f64,
) -> bool {
    let found = linearised(mechanism, s, rows, q, size);
    found.is_ok_and(|at| {
        let mut each = at.residual.iter();
        each.all(|r| r.abs() <= SMALL_CORRECTION * size)
    })
}

/// Returns a configuration near another configuration. The configuration satisfies the rows to
/// [`REACHED`]. Coordinates with weight zero do not change.
///
/// # Errors
/// [`StartError::NoAssembly`]: the violations of the joints have a minimum that is not zero.
pub(super) fn approach(
    mechanism: &Mechanism,
    s: &mut Scratch,
    (rows, weights): Restricting<'_>,
    from: &[f64],
    size: f64,
) -> Result<Vec<f64>, StartError> {
    let is_held = |(&of_length, &weight): (&f64, &f64)| if weight == 0.0 { 0.0 } else { of_length };
    let lengths = lengths(mechanism, size);
    let weights: Vec<f64> = lengths.iter().zip(weights).map(is_held).collect();
    let space = mechanism.space();
    let mut q = from.to_vec();
    let mut at = linearised(mechanism, s, rows, &q, size)?;
    let (mut damping, mut iterations) = (DAMPING, 0);
    loop {
        let worst = at.residual.iter().fold(0.0_f64, |a, r| a.max(r.abs()));
        if worst <= REACHED * size {
            return Ok(q);
        }
        if iterations == ITERATIONS || damping > MOST_DAMPING || !at.square().is_finite() {
            break;
        }
        iterations += 1;
        let step = least_squares_step(&at.c, &at.residual, &weights, damping)?;
        let units = step
            .iter()
            .enumerate()
            .map(|(j, d)| d / space.unit(j, size));
        let longest = units.fold(0.0_f64, |a, d| a.max(d.abs()));
        let share = (LARGEST_STEP / longest).min(1.0);
        let next = space.displaced(&q, share, &step);
        let there = linearised(mechanism, s, rows, &next, size)?;
        if there.square() < at.square() {
            let gain = 1.0 - there.square() / at.square();
            damping = (damping / FACTOR).max(LEAST_DAMPING);
            (q, at) = (next, there);
            if gain < STILL {
                break;
            }
        } else {
            damping *= FACTOR;
        }
    }
    mechanism.pose(mechanism.layout().start_time, &q, s);
    mechanism.phi(s);
    Err(StartError::NoAssembly {
        misfits: misfits(mechanism, s, rows),
        iterations,
    })
}

/// Returns the joints and drives that are violated at the configuration in the work space, the
/// largest violation first.
pub(super) fn misfits(mechanism: &Mechanism, s: &Scratch, rows: &[usize]) -> Vec<Misfit> {
    let size = crate::size::size_of(mechanism, s);
    let groups = mechanism.layout().groups.iter();
    let joints = groups.zip(&mechanism.elements.constraints);
    let of_joint = joints.filter_map(|(group, joint)| {
        let parallel = Parallel::of(joint, s);
        let (mut distance, mut angle) = (0.0_f64, 0.0_f64);
        let own = group.rows.iter();
        for row in own.filter(|row| rows.binary_search(row).is_ok()) {
            let residual = s.phi[row];
            if !mechanism.layout().is_angular(row) {
                distance = distance.hypot(residual);
            } else if parallel.as_ref().is_none_or(|p| !p.rows.contains(&row)) {
                angle = angle.hypot(mechanism.space().angle_of_row(residual));
            }
        }
        if let Some(parallel) = parallel
            && rows.binary_search(&parallel.rows.start).is_ok()
        {
            angle = angle.hypot(parallel.angle);
        }
        let misses = distance != 0.0 || angle != 0.0;
        misses.then(|| Misfit {
            joint: group.name.clone(),
            distance,
            angle,
        })
    });
    let excess = |m: &Misfit| {
        let excess = (m.distance / size).max(m.angle);
        // NaN counts as the largest value.
        if (m.distance + m.angle).is_nan() {
            f64::INFINITY
        } else {
            excess
        }
    };
    let mut found: Vec<Misfit> = of_joint.collect();
    let worst = found.iter().map(excess).fold(0.0, f64::max);
    found.retain(|m| excess(m) >= NAMED_MISFIT * worst);
    found.sort_by(|a, b| excess(b).total_cmp(&excess(a)));
    found
}
