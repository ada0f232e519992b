//! Initial configurations of mechanisms with stated tolerances. Rows may have residuals that can
//! result from the tolerances of the data. No body is moved far to remove these residuals.
//!
//! Suppose that the lines of two sliders should be equal but differ by a rounding error. The
//! sliders coincide if one slider is rotated by the square root of this error, or if it is far
//! away. Such a configuration satisfies all rows, but it is not the intended configuration.

use linalg::{Matrix, small_svd};

use super::error::StartError;
use super::metric::{Restricting, dense_rows};
use crate::data::{DataBlock, DataUnit, SHARED};
use crate::mechanism::Mechanism;
use crate::rounding::ROUNDING;
use crate::size::size_of;
use crate::system::{Scratch, System};

/// If a change of the data within the tolerance moves a body by more than this multiple of the
/// tolerance, the data do not determine the position of the body. Residuals along this motion are
/// not removed. A lever arm is determined by two points, so this limit must not be much larger than
/// two. With a limit of ten and a tolerance of 0.1 mm, arms of 0.7 mm were reported as nonzero
/// although only the refinement of the configuration had caused them.
const AMPLIFIED: f64 = 3.0;

/// Largest number of rows for which these directions are computed. The computing time is
/// proportional to the cube of the number of rows.
const ROWS: usize = 200;

/// Largest number of iterations. Except along the omitted directions, each iteration doubles the
/// number of correct digits.
const ITERATIONS: usize = 20;

/// A step is negligible below this fraction of the tolerance.
const STILL: f64 = 1e-6;

/// Returns the largest tolerance of lengths and of angles. It is not known which data are wrong, so
/// the largest tolerance is used.
fn largest(blocks: &[DataBlock]) -> [f64; 2] {
    [DataUnit::Length, DataUnit::Angle].map(|unit| {
        let of_unit = blocks.iter().filter(|b| b.unit == unit);
        of_unit.filter_map(|b| b.tolerance).fold(0.0, f64::max)
    })
}

/// Returns for each of these rows the largest change that data within the tolerance can cause.
fn reach(mechanism: &Mechanism, s: &Scratch, rows: &[usize]) -> Vec<f64> {
    let blocks = mechanism.data().blocks(s);
    let [length, angle] = largest(&blocks);
    let mut lambda = vec![0.0; mechanism.layout().rows()];
    let moved = |block: &DataBlock| {
        let stated = match block.unit {
            DataUnit::Length => length,
            DataUnit::Angle => angle,
        };
        stated.max(ROUNDING * block.scale)
    };
    let of_row = |&row: &usize| {
        lambda[row] = 1.0;
        let change = mechanism.data().phi_change(s, &lambda, &blocks, moved);
        lambda[row] = 0.0;
        change
    };
    rows.iter().map(of_row).collect()
}

/// Returns whether the residual of each of these rows can result from data within the tolerance.
pub(super) fn is_within(mechanism: &Mechanism, s: &Scratch, rows: &[usize]) -> bool {
    let reach = reach(mechanism, s, rows);
    let mut each = rows.iter().zip(reach);
    each.all(|(&row, reach)| s.phi[row].abs() <= SHARED * reach)
}

/// Returns the displacement of a body along each column of C that corresponds to one tolerance. For
/// translations, the displacement is the tolerance. For rotations, it is the angle that moves a
/// point at the distance of the size by this tolerance.
fn units(mechanism: &Mechanism, s: &Scratch, size: f64) -> Vec<f64> {
    let [length, angle] = largest(&mechanism.data().blocks(s));
    let length = match length {
        0.0 => angle * size,
        length => length,
    };
    let unit = |k: usize| {
        if mechanism.space().is_rotation(k) {
            length / size
        } else {
            length
        }
    };
    (0..mechanism.layout().n_v).map(unit).collect()
}

/// Returns the distance of two configurations in these units.
fn farthest(mechanism: &Mechanism, a: &[f64], b: &[f64], units: &[f64]) -> f64 {
    let apart = mechanism.difference_of(a, b);
    let shares = apart.iter().zip(units).map(|(d, unit)| d.abs() / unit);
    shares.fold(0.0, f64::max)
}

/// Returns whether a tolerance is stated and the distance of these coordinates exceeds the
/// uncertainty of the positions.
pub(crate) fn is_beyond(mechanism: &Mechanism, s: &Scratch, from: &[f64], to: &[f64]) -> bool {
    mechanism.has_tolerances()
        && farthest(
            mechanism,
            from,
            to,
            &units(mechanism, s, size_of(mechanism, s)),
        ) > AMPLIFIED
}

/// Returns the intended configuration. `found` is the configuration that satisfies the rows as well
/// as possible. The function returns another configuration only if two conditions are satisfied:
/// the residuals of this configuration can result from data within the tolerance, and its distance
/// from `found` exceeds the uncertainty of positions. Otherwise it returns `found`.
pub(super) fn within_data(
    mechanism: &Mechanism,
    s: &mut Scratch,
    (rows, weights): Restricting<'_>,
    described: &[f64],
    size: f64,
    found: Result<Vec<f64>, StartError>,
) -> Result<Vec<f64>, StartError> {
    if rows.len() > ROWS
        || matches!(found, Err(ref e) if !matches!(e, StartError::NoAssembly { .. }))
    {
        return found;
    }
    let units = units(mechanism, s, size);
    let far = |from: &[f64], to: &[f64]| farthest(mechanism, from, to, &units) > AMPLIFIED;
    if let Ok(found) = &found
        && !far(found, described)
    {
        return Ok(found.clone());
    }
    match truncated(mechanism, s, (rows, weights), described, &units)? {
        Some(q) if found.as_ref().map_or(true, |found| far(found, &q)) => Ok(q),
        _ => found,
    }
}

/// Returns the configuration that satisfies the rows and is closest in the mass metric. The
/// configuration changes only along the directions in which the data determine the positions. A
/// singular direction is omitted if one tolerance moves a body along it by many tolerances. Returns
/// `None` if a row has a larger residual than data within the tolerance can cause.
fn truncated(
    mechanism: &Mechanism,
    s: &mut Scratch,
    (rows, weights): Restricting<'_>,
    described: &[f64],
    units: &[f64],
) -> Result<Option<Vec<f64>>, StartError> {
    let root: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
    let mut q = described.to_vec();
    let mut is_still = false;
    for _ in 0..ITERATIONS {
        mechanism.pose(mechanism.layout().start_time, &q, s);
        mechanism.phi(s);
        mechanism.c(s);
        if is_still {
            break;
        }
        let reach = reach(mechanism, s, rows);
        let scale = |i: usize| if reach[i] > 0.0 { reach[i] } else { 1.0 };
        let c = dense_rows(mechanism.layout(), s, rows)?;
        let scaled = Matrix::from_fn(rows.len(), root.len(), |i, j| {
            c[(i, j)] * root[j] / scale(i)
        });
        if scaled.first_non_finite().is_some() {
            return Ok(None);
        }
        // Solves C·(q₀ + δ − q) + Φ = 0.
        let shift = mechanism.difference_of(described, &q);
        let moved = c.times(&shift);
        let misfit: Vec<f64> = (0..rows.len())
            .map(|i| (s.phi[rows[i]] + moved[i]) / scale(i))
            .collect();
        let svd = small_svd(&scaled);
        let mut step = vec![0.0; root.len()];
        for (k, &sigma) in svd.sigma.iter().enumerate() {
            let along = |j: usize| root[j] * svd.v[(j, k)] / sigma;
            let amplified = (0..root.len())
                .map(|j| along(j).abs() / units[j])
                .fold(0.0, f64::max);
            if sigma == 0.0 || amplified > AMPLIFIED {
                continue;
            }
            let share: f64 = misfit
                .iter()
                .enumerate()
                .map(|(i, m)| svd.u[(i, k)] * m)
                .sum();
            for (j, step) in step.iter_mut().enumerate() {
                *step -= along(j) * share;
            }
        }
        let next = mechanism.space().displaced(described, 1.0, &step);
        is_still = farthest(mechanism, &q, &next, units) <= STILL;
        q = next;
    }
    Ok((is_still && is_within(mechanism, s, rows)).then_some(q))
}

#[cfg(test)]
mod tests {
    use joints::{Direction, PinInSlot};

    use super::AMPLIFIED;
    use crate::start::{CorrectionLimit, assemble};
    use crate::{Body, BodyRef, Description, Joint, Mechanism, StartOptions, Tolerance};

    /// Assembles a body with a point that slides on the x-axis. The origin of the ground slides in
    /// a slot of the body; the slot is displaced from this point by 0.1 µm. The equations are
    /// `y = 0` and `x·sin θ + 1e-7·cos θ = 0`. Both equations are satisfied only if the body is
    /// rotated or displaced by the square root of 0.1 µm.
    fn assembled(tolerance: f64) -> Vec<f64> {
        let slot = |name: &str, bodies: [BodyRef; 2], x: f64, y: f64| {
            let slot = PinInSlot {
                s_i: [x, 0.0],
                s_j: [0.0, y],
                axis: Direction::X,
            };
            Joint::new(name, &bodies, slot)
        };
        let (ground, body) = (BodyRef::Ground, BodyRef::Body(0));
        let description = Description {
            bodies: vec![Body {
                mass: 1.0,
                inertia: 1.0,
                ..Body::default()
            }],
            joints: vec![
                slot("A", [ground, body], 1.0, 0.0),
                slot("B", [body, ground], 0.0, 1e-7),
            ],
            tolerance: Tolerance {
                length: Some(tolerance),
                angle: None,
            },
            ..Description::default()
        };
        let mut mechanism = Mechanism::build(&description).expect("it builds");
        let options = StartOptions {
            correction: CorrectionLimit::Any,
            ..StartOptions::default()
        };
        let start = assemble(&mut mechanism, &options);
        start.expect("it assembles").q
    }

    #[test]
    fn no_body_is_moved_far_to_mend_what_the_data_explain() {
        let largest = |q: &[f64]| q.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        let within = assembled(1e-6);
        assert!(largest(&within) <= AMPLIFIED * 1e-6, "{within:?}");
    }
}
