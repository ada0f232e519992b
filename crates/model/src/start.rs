//! A consistent start: the configuration nearest to the described one, in the mass metric, that the
//! constraints allow. Rows that keep an initial value do not restrict it: they hold at any start.
//!
//! No rank is decided here: away from the constraints a redundant row is not yet redundant. The
//! correction is the regularised least-squares step of `linalg`, repeated to rounding.

mod blame;
mod conflict;
mod error;
mod metric;
mod options;
mod tier;
mod velocity;
pub(crate) mod within;

use linalg::least_squares_step;

use crate::mechanism::{Mechanism, N_BODY, initialise, unmet_requirement};
use crate::system::{Scratch, System};
use crate::uncertainty::has_tolerances;
use metric::{DAMPING, ROUNDINGS, SMALL_CORRECTION, dense_rows, largest, weights};
use options::kept_columns;

pub use crate::size::scene_size;
pub use conflict::{HeldVelocity, VelocityConflict};
pub use error::{Misfit, StartError};
pub use options::{Coordinate, CorrectionLimit, KeepLevel, StartOptions};
pub use velocity::{StartVelocity, consistent_velocity};

/// An assembled configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// Coordinates on the constraints.
    pub q: Vec<f64>,
    /// How far it is from the described coordinates, n_v.
    pub correction: Vec<f64>,
    /// Largest |Φ|.
    pub residual: f64,
    /// Length by which positions are measured (m).
    pub size: f64,
}

/// Rows that miss by less than this share of the worst one are not named.
const NAMED_MISFIT: f64 = 1e-2;

/// Iterations of the assembly; each gains digits linearly with the size of the correction.
const ITERATIONS: usize = 60;

/// Finds a consistent configuration and takes the initial values of joints, drives and forces from
/// it.
///
/// The correction minimises `(q − q₀)ᵀ·M·(q − q₀)` under Φ(q, 0) = 0; coordinates without mass or
/// inertia weigh as the smallest one that has it, kept ones do not move.
///
/// # Errors
/// - [`StartError::NoAssembly`]: the constraints contradict each other or the start is too far off.
/// - [`StartError::LargeCorrection`]: the correction exceeds what `options` allow.
/// - [`StartError::TooLarge`]: the correction takes a matrix beyond memory.
/// - [`StartError::Requirement`]: a definition's requirement does not hold.
/// - [`StartError::NoCoordinate`]: a coordinate that `options` keep does not exist.
pub fn assemble(mechanism: &mut Mechanism, options: &StartOptions) -> Result<Assembly, StartError> {
    let (described, _) = mechanism.described_state();
    initialise(mechanism, &described);
    let size = scene_size(mechanism, &described);
    let rows = restricting_rows(mechanism);
    let weights = position_weights(mechanism, options, size)?;
    let mut s = mechanism.scratch();
    let within = has_tolerances(mechanism);
    let q = nearest(
        mechanism,
        &mut s,
        (0.0, within),
        &rows,
        &weights,
        &described,
    );
    let q = if within {
        within::meant(mechanism, &mut s, (&rows, &weights), &described, size, q)
    } else {
        q
    };
    // What a definition asks of its numbers explains more than rows that miss because of them.
    let q = q.map_err(|error| match unmet_requirement(mechanism, &described) {
        Some((name, requirement)) => StartError::Requirement { name, requirement },
        None => error,
    })?;
    initialise(mechanism, &q);
    if let Some((name, requirement)) = unmet_requirement(mechanism, &q) {
        return Err(StartError::Requirement { name, requirement });
    }
    let correction = mechanism.space().difference_of(&q, &described);
    if options.correction == CorrectionLimit::Small {
        check_correction(mechanism, &correction, size)?;
    }
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    let residual = s.phi.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    Ok(Assembly {
        q,
        correction,
        residual,
        size,
    })
}

/// How it is measured which configuration is nearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// By masses and inertias, as a start is assembled.
    Mass,
    /// By lengths, angles times the size of the mechanism: masses say nothing of where a mechanism
    /// can be, and on the long arm of a light body the mass metric would rather turn it far than
    /// move its heavy neighbour a little.
    Length,
}

/// The configuration nearest to q on the given rows of Φ at time t; allocates.
///
/// # Errors
/// - [`StartError::NoAssembly`]: there is none near q.
pub fn nearest_configuration(
    mechanism: &Mechanism,
    t: f64,
    rows: &[usize],
    q: &[f64],
    metric: Metric,
) -> Result<Vec<f64>, StartError> {
    let size = scene_size(mechanism, q);
    let weights = match metric {
        Metric::Mass => position_weights(mechanism, &StartOptions::default(), size)?,
        Metric::Length => (0..mechanism.layout().n_v)
            .map(|k| {
                if k % N_BODY == 2 {
                    1.0 / (size * size)
                } else {
                    1.0
                }
            })
            .collect(),
    };
    let mut s = mechanism.scratch();
    nearest(mechanism, &mut s, (t, false), rows, &weights, q)
}

/// Rows of Φ that restrict the start.
fn restricting_rows(mechanism: &Mechanism) -> Vec<usize> {
    let layout = mechanism.layout();
    layout
        .groups
        .iter()
        .flat_map(|g| g.rows.clone().zip(g.spec.rows))
        .filter(|(row, spec)| *row < layout.m && spec.restricts_start)
        .map(|(row, _)| row)
        .collect()
}

/// Inverse weights of the coordinates in the mass metric, zero for those that are kept.
fn position_weights(
    mechanism: &Mechanism,
    options: &StartOptions,
    size: f64,
) -> Result<Vec<f64>, StartError> {
    let mut weights = weights(mechanism, size);
    for column in kept_columns(mechanism, options, KeepLevel::Position)? {
        weights[column] = 0.0;
    }
    Ok(weights)
}

/// Repeats `q ← q₀ + argmin ‖δ‖_M` under the constraints linearised at q, until Φ is zero to
/// rounding; if rows disagree, until the sum of squares of Φ is least, where that is `within` the
/// tolerances that the scene states.
fn nearest(
    mechanism: &Mechanism,
    s: &mut Scratch,
    (t, within): (f64, bool),
    rows: &[usize],
    weights: &[f64],
    described: &[f64],
) -> Result<Vec<f64>, StartError> {
    let mut q = described.to_vec();
    let mut best = f64::INFINITY;
    let mut stalled = 0;
    for iteration in 0..=ITERATIONS {
        mechanism.pose(t, &q, s);
        mechanism.phi(s);
        mechanism.c(s);
        let ratio = |r: usize| s.phi[r].abs() / mechanism.scales(s).position(r);
        // A row without any term is satisfied or not a number.
        let misses = |r: usize| if s.phi[r] == 0.0 { 0.0 } else { ratio(r) };
        let (_, residual) = largest(rows.iter().map(|&r| (r, misses(r))));
        let tolerance = ROUNDINGS * f64::EPSILON;
        stalled = if residual < best { 0 } else { stalled + 1 };
        best = best.min(residual);
        // Rounding may leave a little more than the tolerance: a stalled iteration near it is done.
        if residual <= tolerance || (stalled > 1 && residual <= ROUNDINGS * tolerance) {
            return Ok(q);
        }
        let is_at_rest = stalled > 1 || iteration == ITERATIONS;
        if within && is_at_rest && residual.is_finite() && within::is_within(mechanism, s, rows) {
            return Ok(q);
        }
        if iteration == ITERATIONS || !residual.is_finite() {
            let rows = misfits(mechanism, s, rows);
            return Err(StartError::NoAssembly {
                rows,
                iterations: iteration,
            });
        }
        let c = dense_rows(mechanism.layout(), s, rows)?;
        let shift = mechanism.space().difference_of(described, &q);
        // C·(q₀ + δ − q) + Φ = 0
        let moved = c.times(&shift);
        let misfit: Vec<f64> = rows
            .iter()
            .zip(&moved)
            .map(|(&r, m)| s.phi[r] + m)
            .collect();
        let mut step = least_squares_step(&c, &misfit, weights, DAMPING)?;
        // The damping leaves a small misfit; one more step removes it where the rows agree.
        let left = c.times(&step);
        let misfit: Vec<f64> = misfit.iter().zip(&left).map(|(a, b)| a + b).collect();
        for (a, b) in step
            .iter_mut()
            .zip(least_squares_step(&c, &misfit, weights, DAMPING)?)
        {
            *a += b;
        }
        q = mechanism.space().displaced(described, 1.0, &step);
    }
    unreachable!("the last iteration returns")
}

/// Rows that miss, the worst first. What a least-squares solution leaves is orthogonal to all
/// motions, so these rows are the ones that cannot hold together.
fn misfits(mechanism: &Mechanism, s: &Scratch, rows: &[usize]) -> Vec<Misfit> {
    let worst = rows.iter().fold(0.0_f64, |a, &r| a.max(s.phi[r].abs()));
    let missing = |r: &&usize| {
        let residual = s.phi[**r].abs();
        residual.is_nan() || residual >= NAMED_MISFIT * worst
    };
    let mut found: Vec<Misfit> = rows
        .iter()
        .filter(missing)
        .map(|&r| Misfit {
            row: mechanism.layout().labels[r].clone(),
            residual: s.phi[r],
        })
        .collect();
    found.sort_by(|a, b| b.residual.abs().total_cmp(&a.residual.abs()));
    found
}

fn check_correction(
    mechanism: &Mechanism,
    correction: &[f64],
    size: f64,
) -> Result<(), StartError> {
    let limits = [size, size, 1.0].map(|unit| SMALL_CORRECTION * unit);
    let excess = |k: usize| correction[k].abs() / limits[k % N_BODY];
    let worst = (0..correction.len()).fold(0, |a, b| if excess(b) > excess(a) { b } else { a });
    if correction.is_empty() || excess(worst) <= 1.0 {
        return Ok(());
    }
    let (body, coordinate) = mechanism.coordinate(worst);
    Err(StartError::LargeCorrection {
        body: body.to_owned(),
        coordinate,
        correction: correction[worst].abs(),
        limit: limits[worst % N_BODY],
    })
}
