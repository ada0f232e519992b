//! A consistent start: the configuration nearest to the described one, in the mass metric, that the
//! constraints allow. Rows that keep an initial value do not restrict it: they hold at any start.
//!
//! No rank is decided here: away from the constraints a redundant row is not yet redundant. The correction is the
//! regularised least-squares step of `linalg`, repeated to rounding.

use linalg::{Matrix, StepError, least_squares_step};

use crate::mechanism::{Mechanism, N_BODY};
use crate::system::{Layout, RowLabel, Scratch, System};
use crate::uncertainty::ROUNDING;

/// What a start may and may not do.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartOptions {
    /// Coordinates and velocities that keep their described values exactly.
    pub keep: Vec<Coordinate>,
    /// Whether a correction of more than a thousandth of the scene's size is accepted, or one of given velocities by more than a
    /// thousandth of the fastest.
    pub correction: CorrectionLimit,
}

/// How far a start may be corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CorrectionLimit {
    /// By a thousandth of the scene's size, and a thousandth of a radian; given velocities by a thousandth of the fastest.
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
    /// Velocities as described, not yet on the constraints.
    pub v: Vec<f64>,
    /// `q` minus the described coordinates.
    pub correction: Vec<f64>,
    /// Largest |Φ|.
    pub residual: f64,
    /// Length by which positions are measured (m).
    pub size: f64,
}

/// Why no consistent start was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StartError {
    /// The constraints cannot be satisfied from the described configuration.
    #[error(
        "the constraints cannot be assembled: after {iterations} iterations these rows still miss: {}; \
         they contradict each other, or the start is too far from an assembled one",
        list(rows)
    )]
    NoAssembly {
        /// The rows that cannot be reconciled, the worst first.
        rows: Vec<Misfit>,
        /// Iterations made.
        iterations: usize,
    },
    /// The nearest assembled configuration is far from the described one.
    #[error(
        "the start must be corrected by {correction:.3e} ({coordinate} of body `{body}`), more than the allowed {limit:.3e}; \
         correct the scene, or set `allow_correction = true` in `[start]`"
    )]
    LargeCorrection {
        /// The body that moves most.
        body: String,
        /// Which coordinate.
        coordinate: &'static str,
        /// By how much.
        correction: f64,
        /// What is allowed.
        limit: f64,
    },
    /// The nearest velocities that the constraints allow are far from given ones.
    #[error(
        "the start must be corrected by {:.3e} ({coordinate} of body `{body}`: given {given}, corrected {corrected:.4e}), more than the allowed {limit:.3e}; \
         correct the velocities of the scene; or leave out those that follow from others, and hold these by `keep`, as \
         `keep = [\"{body}.{coordinate}\"]` in `[start]`; or set `allow_correction = true` there",
        (corrected - given).abs()
    )]
    LargeVelocityCorrection {
        /// The body whose velocity changes most.
        body: String,
        /// `vx`, `vy` or `omega`.
        coordinate: &'static str,
        /// The velocity that is given.
        given: f64,
        /// The one that satisfies the constraints.
        corrected: f64,
        /// What the difference may be.
        limit: f64,
    },
    /// A definition requires something that the start does not have.
    #[error("`{name}` requires at the start: {requirement}")]
    Requirement {
        /// The joint, drive or force.
        name: String,
        /// What is required.
        requirement: &'static str,
    },
    /// A coordinate that does not exist is to be kept.
    #[error(
        "`keep` names coordinate {dof} of body {body}; bodies are 0..{bodies}, coordinates 0 x, 1 y, 2 angle"
    )]
    NoCoordinate {
        /// The body asked for.
        body: usize,
        /// The coordinate asked for.
        dof: usize,
        /// Number of bodies.
        bodies: usize,
    },
    /// The velocity constraints cannot be satisfied with the velocities that are kept.
    #[error(
        "no velocities satisfy the constraints: row {worst} still misses by {residual:.3e}; \
         the velocities held by `keep` leave no freedom for it, or redundant drives contradict each other"
    )]
    NoVelocity {
        /// The row that misses most.
        worst: RowLabel,
        /// By how much.
        residual: f64,
    },
    /// The start has to be corrected, and the matrix for it would fill the memory.
    #[error(
        "the start has to be corrected, which takes a dense matrix of {rows} × {columns} numbers, more than {most:e}; \
         describe positions and velocities that satisfy the constraints"
    )]
    TooLarge {
        /// Rows that have to be satisfied.
        rows: usize,
        /// Coordinates.
        columns: usize,
        /// Most entries of a matrix.
        most: f64,
    },
    /// The correction step failed.
    #[error("the start cannot be corrected: {0}")]
    Step(#[from] StepError),
}

/// A row that is not satisfied.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The row.
    pub row: RowLabel,
    /// Its residual.
    pub residual: f64,
}

fn list(rows: &[Misfit]) -> String {
    let parts = rows.iter().take(NAMED_ROWS);
    let parts: Vec<String> = parts
        .map(|m| format!("{} by {:.3e}", m.row, m.residual))
        .collect();
    let named = parts.join(", ");
    match rows.len().saturating_sub(NAMED_ROWS) {
        0 => named,
        more => format!("{named}, and {more} more"),
    }
}

/// Rows that a message names.
const NAMED_ROWS: usize = 20;

/// Rows that miss by less than this share of the worst one are not named.
const NAMED_MISFIT: f64 = 1e-2;

/// Iterations of the assembly; each gains digits linearly with the size of the correction.
const ITERATIONS: usize = 60;

/// A correction of the velocities has to leave less than this share of the residuals: one step is exact but for rounding, and for damping
/// where velocities are held.
const PROGRESS: f64 = 0.5;

/// Damping of the least-squares step, relative to rows of size one: small against any row that matters,
/// large against rounding.
const DAMPING: f64 = 1e-10;

/// Share of the scene's size (and of a radian, and of the fastest velocity) that a start may be corrected without being asked.
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

/// Finds a consistent configuration and takes the initial values of joints, drives and forces from it.
///
/// The correction minimises `(q − q₀)ᵀ·M·(q − q₀)` under Φ(q, 0) = 0; coordinates without mass or inertia weigh as the
/// smallest one that has it, kept ones do not move.
///
/// # Errors
/// - [`StartError::NoAssembly`]: the constraints contradict each other or the start is too far off.
/// - [`StartError::LargeCorrection`]: the correction exceeds what `options` allow.
/// - [`StartError::TooLarge`]: the correction takes a matrix beyond memory.
/// - [`StartError::Requirement`]: a definition's requirement does not hold.
/// - [`StartError::NoCoordinate`]: a coordinate that `options` keep does not exist.
pub fn assemble(mechanism: &mut Mechanism, options: &StartOptions) -> Result<Assembly, StartError> {
    let (described, v) = mechanism.described_state();
    mechanism.initialise(&described);
    let size = scene_size(mechanism, &described);
    let rows = restricting_rows(mechanism);
    let weights = weights(mechanism, options, KeepLevel::Position)?;
    let mut s = mechanism.scratch();
    let q = nearest(mechanism, &mut s, 0.0, &rows, &weights, &described)?;
    mechanism.initialise(&q);
    if let Some((name, requirement)) = mechanism.unmet_requirement(&q) {
        return Err(StartError::Requirement { name, requirement });
    }
    let correction: Vec<f64> = q.iter().zip(&described).map(|(a, b)| a - b).collect();
    if options.correction == CorrectionLimit::Small {
        check_correction(mechanism, &correction, size)?;
    }
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    let residual = s.phi.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    Ok(Assembly {
        q,
        v,
        correction,
        residual,
        size,
    })
}

/// The velocities nearest to `v` in the mass metric that satisfy `C·v = b` in the kept rows at an assembled
/// configuration. Velocities that `options` keep do not change.
///
/// # Errors
/// - [`StartError::NoVelocity`]: the kept velocities leave no freedom for the constraints.
/// - [`StartError::TooLarge`]: they have to be corrected, by a matrix beyond memory.
/// - [`StartError::NoCoordinate`]: a velocity that `options` keep does not exist.
pub fn consistent_velocity(
    mechanism: &Mechanism,
    options: &StartOptions,
    q: &[f64],
    v: &[f64],
    kept: &[usize],
) -> Result<Vec<f64>, StartError> {
    let layout = mechanism.layout();
    let weights = weights(mechanism, options, KeepLevel::Velocity)?;
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    // A consistent start needs no matrix.
    let mut c = None;
    let mut v = v.to_vec();
    let mut best = f64::INFINITY;
    loop {
        let residual: Vec<f64> = kept
            .iter()
            .map(|&i| layout.velocity_residual(&s, i, &v))
            .collect();
        let scale = kept
            .iter()
            .map(|&i| mechanism.bounded_velocity_scale(&s, i, &v))
            .fold(0.0, f64::max);
        let (worst, size) = largest(kept.iter().copied().zip(residual.iter().map(|r| r.abs())));
        let tolerance = ROUNDINGS * f64::EPSILON * scale;
        let is_stuck = size.is_nan() || size > PROGRESS * best;
        // Rounding may leave a little more than the tolerance.
        if size <= tolerance || (is_stuck && size <= ROUNDINGS * tolerance) {
            return Ok(v);
        }
        let missing = || StartError::NoVelocity {
            worst: layout.labels[worst].clone(),
            residual: size,
        };
        if is_stuck || !size.is_finite() {
            return Err(missing());
        }
        best = size;
        let c = match &mut c {
            Some(c) => c,
            none => none.insert(dense_rows(layout, &s, kept)?),
        };
        // The kept rows are independent; they need no damping unless velocities are held.
        let step = match least_squares_step(c, &residual, &weights, 0.0) {
            Ok(step) => step,
            Err(StepError::Dependent { .. }) => {
                least_squares_step(c, &residual, &weights, DAMPING)?
            }
            Err(e) => return Err(e.into()),
        };
        for (v, dv) in v.iter_mut().zip(step) {
            *v += dv;
        }
    }
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

/// Diagonal of the box around all bodies and joints; where these are one place, around all points of the joints; 1 m where these are, too.
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

/// The configuration nearest to q, in the mass metric, on the given rows of Φ at time t; allocates.
///
/// # Errors
/// - [`StartError::NoAssembly`]: there is none near q.
pub fn nearest_configuration(
    mechanism: &Mechanism,
    t: f64,
    rows: &[usize],
    q: &[f64],
) -> Result<Vec<f64>, StartError> {
    let weights = weights(mechanism, &StartOptions::default(), KeepLevel::Position)?;
    nearest(mechanism, &mut mechanism.scratch(), t, rows, &weights, q)
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
fn weights(
    mechanism: &Mechanism,
    options: &StartOptions,
    level: KeepLevel,
) -> Result<Vec<f64>, StartError> {
    let mass = mechanism.mass();
    let smallest = |angles: bool| {
        let of_kind = mass
            .iter()
            .enumerate()
            .filter(|(k, _)| (k % N_BODY == 2) == angles);
        let positive = of_kind.map(|(_, &m)| m).filter(|&m| m > 0.0);
        positive.fold(f64::INFINITY, f64::min)
    };
    let fallback = [smallest(false), smallest(true)].map(|m| if m.is_finite() { m } else { 1.0 });
    let mut weights: Vec<f64> = mass
        .iter()
        .enumerate()
        .map(|(k, &m)| {
            1.0 / if m > 0.0 {
                m
            } else {
                fallback[usize::from(k % N_BODY == 2)]
            }
        })
        .collect();
    let bodies = mechanism.bodies().len();
    for &Coordinate { body, dof, .. } in options.keep.iter().filter(|c| c.level == level) {
        if body >= bodies || dof >= N_BODY {
            return Err(StartError::NoCoordinate { body, dof, bodies });
        }
        weights[N_BODY * body + dof] = 0.0;
    }
    Ok(weights)
}

/// Repeats `q ← q₀ + argmin ‖δ‖_M` under the constraints linearised at q, until Φ is zero to rounding.
fn nearest(
    mechanism: &Mechanism,
    s: &mut Scratch,
    t: f64,
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
        let ratio = |r: usize| s.phi[r].abs() / mechanism.position_scale(s, r, &q);
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
        if iteration == ITERATIONS || !residual.is_finite() {
            let rows = misfits(mechanism, s, rows);
            return Err(StartError::NoAssembly {
                rows,
                iterations: iteration,
            });
        }
        let c = dense_rows(mechanism.layout(), s, rows)?;
        let shift: Vec<f64> = described.iter().zip(&q).map(|(a, b)| a - b).collect();
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
        for k in 0..q.len() {
            q[k] = described[k] + step[k];
        }
    }
    unreachable!("the last iteration returns")
}

/// Rows that miss, the worst first. What a least-squares solution leaves is orthogonal to all motions, so
/// these rows are the ones that cannot hold together.
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

/// Consistent velocities minus the described ones. Those of bodies that are described as moving are given; the others follow from these and from the
/// constraints. Given ones are measured by the fastest, rotations by what they move at the size of the mechanism assembled at q.
///
/// # Errors
/// [`StartError::LargeVelocityCorrection`]: a given one changes by more than `options` allow.
pub fn velocity_correction(
    mechanism: &Mechanism,
    options: &StartOptions,
    q: &[f64],
    described: &[f64],
    found: &[f64],
) -> Result<Vec<f64>, StartError> {
    let correction: Vec<f64> = found.iter().zip(described).map(|(a, b)| a - b).collect();
    if options.correction == CorrectionLimit::Any {
        return Ok(correction);
    }
    let size = scene_size(mechanism, q);
    let arm = |k: usize| if k % N_BODY == 2 { size } else { 1.0 };
    let states = described.iter().enumerate().chain(found.iter().enumerate());
    let fastest = states.fold(0.0_f64, |a, (k, v)| a.max(arm(k) * v.abs()));
    let limit = |k: usize| SMALL_CORRECTION * fastest / arm(k);
    let by = |k: usize| correction[k].abs();
    // A zero that is spelled out is the default; one beside a component that is not is meant.
    let is_given = |k: usize| match k % N_BODY {
        2 => described[k] != 0.0,
        dof => described[k - dof..k - dof + 2] != [0.0; 2],
    };
    let worst = (0..correction.len())
        .filter(|&k| is_given(k) && by(k) > limit(k))
        .max_by(|&a, &b| (arm(a) * by(a)).total_cmp(&(arm(b) * by(b))));
    let Some(k) = worst else {
        return Ok(correction);
    };
    Err(StartError::LargeVelocityCorrection {
        body: mechanism.bodies()[k / N_BODY].name.clone(),
        coordinate: ["vx", "vy", "omega"][k % N_BODY],
        given: described[k],
        corrected: found[k],
        limit: limit(k),
    })
}
