//! A consistent start: the configuration nearest to the described one, in the mass metric, that the
//! constraints allow. Rows that keep an initial value do not restrict it: they hold at any start.
//!
//! No rank is decided here: away from the constraints a redundant row is not yet redundant. The
//! correction is the regularised least-squares step of `linalg`, repeated to rounding.

mod conflict;
mod error;
mod tier;
mod velocity;
pub(crate) mod within;

use linalg::{Matrix, least_squares_step};

use crate::mechanism::{Mechanism, N_BODY};
use crate::system::{Layout, Scratch, System};
use crate::uncertainty::ROUNDING;

pub use conflict::{HeldVelocity, VelocityConflict};
pub use error::{Misfit, StartError};
pub use velocity::{StartVelocity, consistent_velocity};

/// What a start may and may not do.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartOptions {
    /// Coordinates and velocities that keep their described values exactly; a velocity that is not
    /// given keeps zero.
    pub keep: Vec<Coordinate>,
    /// Whether a correction of more than a thousandth of the scene's size is accepted, or one of
    /// given velocities by more than a thousandth of the fastest that hang together with them.
    pub correction: CorrectionLimit,
}

/// How far a start may be corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CorrectionLimit {
    /// By a thousandth of the scene's size, and a thousandth of a radian; given velocities by a
    /// thousandth of the fastest.
    #[default]
    Small,
    /// By any amount.
    Any,
}

/// One coordinate or velocity of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// Place of the body in the list.
    pub body: usize,
    /// 0 x, 1 y, 2 angle.
    pub dof: usize,
    /// Position or velocity.
    pub level: KeepLevel,
}

/// Position or velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepLevel {
    /// `x`, `y` or `angle`
    Position,
    /// `vx`, `vy` or `omega`
    Velocity,
}

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

/// Rows that restrict a start, and the inverse weights of its coordinates.
type Restricting<'a> = (&'a [usize], &'a [f64]);

/// Iterations of the assembly; each gains digits linearly with the size of the correction.
const ITERATIONS: usize = 60;

/// Damping of the least-squares step, relative to rows of size one: small against any row that
/// matters, large against rounding.
const DAMPING: f64 = 1e-10;

/// Share of the scene's size (and of a radian, and of the fastest velocity) that a start may be
/// corrected without being asked.
const SMALL_CORRECTION: f64 = 1e-3;

/// A row counts as satisfied below this many roundings of its terms.
const ROUNDINGS: f64 = 10.0;

/// Entries of the largest matrix of a correction: 1 GB.
const MOST_ENTRIES: usize = 1 << 27;

/// These rows of C; allocates.
fn dense_rows(layout: &Layout, s: &Scratch, rows: &[usize]) -> Result<Matrix, StartError> {
    let entries = rows.len().checked_mul(layout.n_v);
    if entries.is_none_or(|entries| entries > MOST_ENTRIES) {
        return Err(StartError::TooLarge {
            rows: rows.len(),
            columns: layout.n_v,
            most: MOST_ENTRIES as f64,
        });
    }
    let mut c = Matrix::zeros(rows.len(), layout.n_v);
    for (k, &i) in rows.iter().enumerate() {
        layout.scatter_row(s, i, c.row_mut(k));
    }
    Ok(c)
}

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
    mechanism.initialise(&described);
    let size = scene_size(mechanism, &described);
    let rows = restricting_rows(mechanism);
    let weights = position_weights(mechanism, options, size)?;
    let mut s = mechanism.scratch();
    let within = mechanism.has_tolerances();
    let q = nearest(
        mechanism,
        &mut s,
        (0.0, within),
        &rows,
        &weights,
        &described,
    );
    let q = match within {
        true => within::meant(mechanism, &mut s, (&rows, &weights), &described, size, q),
        false => q,
    };
    // What a definition asks of its numbers explains more than rows that miss because of them.
    let q = q.map_err(|error| match mechanism.unmet_requirement(&described) {
        Some((name, requirement)) => StartError::Requirement { name, requirement },
        None => error,
    })?;
    mechanism.initialise(&q);
    if let Some((name, requirement)) = mechanism.unmet_requirement(&q) {
        return Err(StartError::Requirement { name, requirement });
    }
    let correction = mechanism.difference_of(&q, &described);
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

/// The row with the largest value, NaN above all.
fn largest(rows: impl Iterator<Item = (usize, f64)>) -> (usize, f64) {
    rows.fold(
        (0, 0.0),
        |a, b| if b.1 > a.1 || b.1.is_nan() { b } else { a },
    )
}

/// Places that are no farther apart than so many roundings of where they stand are one place.
const COINCIDE: f64 = 1e3;

/// Diagonal of the box around all bodies and joints; where these are one place, around all points
/// of the joints; 1 m where these are, too.
#[must_use]
pub fn scene_size(mechanism: &Mechanism, q: &[f64]) -> f64 {
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    size_of(mechanism, &s)
}

/// The same at the poses of the scratch.
pub(crate) fn size_of(mechanism: &Mechanism, s: &Scratch) -> f64 {
    let bodies = s.poses.iter().map(|p| [p.x, p.y]);
    let places = mechanism.constraint_ids().map(|id| mechanism.place(id, s));
    let mut points: Vec<[f64; 2]> = bodies.chain(places).collect();
    if let Some(size) = diagonal(&points) {
        return size;
    }
    let of_joints = mechanism
        .constraint_ids()
        .flat_map(|id| mechanism.points(id));
    points.extend(of_joints.map(|(body, p)| match body.moving() {
        None => p,
        Some(k) => {
            let pose = &s.poses[k];
            [
                pose.x + pose.cos * p[0] - pose.sin * p[1],
                pose.y + pose.sin * p[0] + pose.cos * p[1],
            ]
        }
    }));
    diagonal(&points).unwrap_or(1.0)
}

/// Diagonal of the box around points. `None` if they are one place.
fn diagonal(points: &[[f64; 2]]) -> Option<f64> {
    let span = |k: usize| {
        let low = points.iter().fold(f64::INFINITY, |a, p| a.min(p[k]));
        let high = points.iter().fold(f64::NEG_INFINITY, |a, p| a.max(p[k]));
        high - low
    };
    let size = span(0).hypot(span(1));
    let farthest = points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    (size > COINCIDE * ROUNDING * farthest).then_some(size)
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

/// Masses, and inertias divided by the square of the size, below this share of the largest weigh as
/// this share: what is lighter makes no difference to what is heavy, but its square would overflow.
const LIGHTEST: f64 = 1e-30;

/// Inverse weights of the coordinates in the mass metric; what has no mass or inertia weighs as the
/// smallest one that has it.
fn weights(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let unit = |k: usize| if k % N_BODY == 2 { size * size } else { 1.0 };
    let comparable = mechanism
        .mass()
        .iter()
        .enumerate()
        .map(|(k, m)| m / unit(k));
    let heaviest = comparable.filter(|m| m.is_finite()).fold(0.0, f64::max);
    let least = |(k, &m): (usize, &f64)| match m > 0.0 {
        true => m.max(LIGHTEST * heaviest * unit(k)),
        false => m,
    };
    let mass: Vec<f64> = mechanism.mass().iter().enumerate().map(least).collect();
    let smallest = |angles: bool| {
        let of_kind = mass
            .iter()
            .enumerate()
            .filter(|(k, _)| (k % N_BODY == 2) == angles);
        let positive = of_kind.map(|(_, &m)| m).filter(|&m| m > 0.0);
        positive.fold(f64::INFINITY, f64::min)
    };
    let fallback = [smallest(false), smallest(true)].map(|m| if m.is_finite() { m } else { 1.0 });
    let weight = |(k, &m): (usize, &f64)| match m > 0.0 {
        true => 1.0 / m,
        false => 1.0 / fallback[usize::from(k % N_BODY == 2)],
    };
    mass.iter().enumerate().map(weight).collect()
}

/// Columns that are kept at a level.
fn kept_columns(
    mechanism: &Mechanism,
    options: &StartOptions,
    level: KeepLevel,
) -> Result<Vec<usize>, StartError> {
    let bodies = mechanism.bodies().len();
    let kept = options.keep.iter().filter(|c| c.level == level);
    kept.map(
        |&Coordinate { body, dof, .. }| match body < bodies && dof < N_BODY {
            true => Ok(N_BODY * body + dof),
            false => Err(StartError::NoCoordinate { body, dof, bodies }),
        },
    )
    .collect()
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
        let ratio = |r: usize| s.phi[r].abs() / mechanism.position_scale(s, r);
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
        let shift = mechanism.difference_of(described, &q);
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
        q = mechanism.displaced(described, 1.0, &step);
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
