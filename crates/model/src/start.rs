//! Finds a consistent initial configuration. The configuration satisfies the constraints and is
//! closest to the described configuration in the mass metric. Its axes point in the described
//! directions. Rows that store an initial value do not restrict the initial configuration, because
//! every initial configuration satisfies these rows.
//!
//! If the iteration does not converge, or converges to axes with the opposite direction, an
//! approximate solution is first computed in the metric of lengths. The iteration then restarts
//! from this solution.
//!
//! This module does not determine ranks. At a configuration that violates the constraints, a
//! redundant row is still independent. The correction is the regularised least-squares step of
//! `linalg`, repeated until only rounding errors remain.
//!
//! The initial poses may differ from the description ([`StartOptions::poses`]). In this case,
//! initial values are still taken from the described configuration. The bodies are then moved so
//! that the constraints with these values remain satisfied.
//!
//! A search for an equilibrium returns such poses. Therefore the points, phases and free lengths in
//! the text of the scene do not change.

mod approach;
mod blame;
mod components;
mod conflict;
mod dependent;
mod error;
mod metric;
mod options;
mod parallel;
mod velocity;
pub(crate) mod within;

use linalg::DampedRows;

use crate::agreement::Level;
use crate::mechanism::{Mechanism, initialise, unmet_requirement, unmet_rows};
use crate::system::{Scratch, System};
use metric::{DAMPING, ROUNDINGS, Restricting, SMALL_CORRECTION, dense_rows, largest, weights};
use options::kept_columns;

pub use crate::size::scene_size;
pub use conflict::{HeldVelocity, LockedBodies, VelocityConflict};
pub use error::{Misfit, StartError};
pub use options::{Coordinate, CorrectionLimit, KeepLevel, StartOptions, StartPose, State};
pub use velocity::{StartVelocity, consistent_velocity};

/// An assembled configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// Coordinates that satisfy the constraints.
    pub q: Vec<f64>,
    /// Displacement from the coordinates given in the scene, or from the initial poses (n_v
    /// values).
    pub correction: Vec<f64>,
    /// Largest |Φ|.
    pub residual: f64,
    /// Size of the mechanism, used as the unit of positions (m).
    pub size: f64,
}

impl Assembly {
    fn of(
        mechanism: &Mechanism,
        mut s: Scratch,
        (q, correction): (Vec<f64>, Vec<f64>),
        size: f64,
    ) -> Self {
        mechanism.pose(mechanism.layout().start_time, &q, &mut s);
        mechanism.phi(&mut s);
        let residual = s.phi.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        Self {
            q,
            correction,
            residual,
            size,
        }
    }

    /// Returns whether another assembly has the same coordinates and the same size, bit by bit.
    #[must_use]
    pub fn has_configuration_of(&self, other: &Self) -> bool {
        let bits =
            |x: &Self| -> Vec<u64> { x.q.iter().chain([&x.size]).map(|x| x.to_bits()).collect() };
        bits(self) == bits(other)
    }
}

/// Largest number of iterations of the assembly. The convergence is linear, and its rate depends on
/// the size of the correction.
const ITERATIONS: usize = 60;

/// The iteration ends if the residual has not decreased by a factor of ten in this number of steps.
/// In this case, it would not converge to rounding within [`ITERATIONS`].
const PATIENCE: usize = 12;

/// Finds a consistent configuration and sets the initial values of joints, drives and forces to
/// their values at this configuration.
///
/// The correction minimises `(q − q₀)ᵀ·M·(q − q₀)` under Φ(q, 0) = 0. Coordinates without mass or
/// inertia have the weight of the smallest mass or inertia. Coordinates that `options` keep do not
/// change.
///
/// With [`StartOptions::poses`], the initial values are taken from the described configuration. The
/// bodies then start at the configuration that satisfies the same constraints and is closest to the
/// poses.
///
/// # Errors
/// - [`StartError::NoAssembly`]: the constraints contradict each other or the given configuration
///   is too far away.
/// - [`StartError::LargeCorrection`]: the correction exceeds what `options` allow.
/// - [`StartError::WrongSide`]: the gap of a one-sided joint is described on the side to which it
///   cannot open, and exceeds a small correction. An open gap is closed, like the gap of any other
///   joint.
/// - [`StartError::TooLarge`]: the correction needs a matrix that is too large for the memory.
/// - [`StartError::Requirement`]: a requirement of a definition is not satisfied.
/// - [`StartError::NoCoordinate`], [`StartError::NoPose`]: `options` refer to a coordinate or a
///   body that does not exist.
pub fn assemble(mechanism: &mut Mechanism, options: &StartOptions) -> Result<Assembly, StartError> {
    let (described, _) = mechanism.described_state();
    initialise(mechanism, &described);
    let size = scene_size(mechanism, &described);
    check_sides(mechanism, &described, size)?;
    let rows = restricting_rows(mechanism);
    let weights = position_weights(mechanism, options, size)?;
    let mut s = mechanism.scratch();
    let q = closest(mechanism, &mut s, (&rows, &weights), &described, size)?;
    initialise(mechanism, &q);
    requirement(mechanism, &q)?;
    let correction = mechanism.difference_of(&q, &described);
    if options.correction == CorrectionLimit::Small {
        check_correction(mechanism, &correction, size, || {
            missing(mechanism, &described, &rows)
        })?;
    }
    let layout = mechanism.layout();
    let is_later = layout.rheonomic && layout.start_time != 0.0;
    if is_later || options.state.is_some() || !options.poses.is_empty() {
        let posed = match &options.state {
            Some(state) => state.q.clone(),
            None => posed(mechanism, &options.poses, &q)?,
        };
        return settled(mechanism, options, size, &posed);
    }
    Ok(Assembly::of(mechanism, s, (q, correction), size))
}

/// Works like [`assemble`], for another state ([`StartOptions::state`]) of a mechanism that has its
/// initial values. The initial values do not change. Without a state, the function assembles the
/// described configuration.
///
/// # Errors
/// Returns the same errors as [`assemble`].
pub fn assemble_state(
    mechanism: &Mechanism,
    options: &StartOptions,
) -> Result<Assembly, StartError> {
    let (described, _) = mechanism.described_state();
    let q = options.state.as_ref().map_or(&described, |state| &state.q);
    settled(mechanism, options, scene_size(mechanism, &described), q)
}

/// Returns the configuration that is closest to other poses and satisfies all rows, including the
/// rows of initial values.
fn settled(
    mechanism: &Mechanism,
    options: &StartOptions,
    size: f64,
    posed: &[f64],
) -> Result<Assembly, StartError> {
    check_sides(mechanism, posed, size)?;
    let weights = position_weights(mechanism, options, size)?;
    let rows: Vec<usize> = (0..mechanism.layout().m).collect();
    let mut s = mechanism.scratch();
    let mut q = closest(mechanism, &mut s, (&rows, &weights), posed, size)?;
    let first = mechanism.layout().angles().start;
    mechanism.elements.settle_angles(first, &mut q);
    requirement(mechanism, &q)?;
    let mut correction = mechanism.difference_of(&q, posed);
    // Only bodies with a given pose have a weight; the other bodies follow.
    let columns = |pose: &StartPose| mechanism.space().columns_of(pose.body);
    let given: Vec<usize> = options.poses.iter().flat_map(columns).collect();
    for (j, moved) in correction.iter_mut().enumerate() {
        if options.state.is_none() && !given.contains(&j) {
            *moved = 0.0;
        }
    }
    if options.correction == CorrectionLimit::Small {
        check_correction(mechanism, &correction, size, || {
            missing(mechanism, posed, &rows)
        })?;
    }
    Ok(Assembly::of(mechanism, s, (q, correction), size))
}

/// Checks that no gap of a one-sided joint is on the side to which it cannot open and exceeds a
/// small correction. The gap of a joint that stores an initial value is zero at every start.
fn check_sides(mechanism: &Mechanism, q: &[f64], size: f64) -> Result<(), StartError> {
    let groups = mechanism.layout().groups.iter();
    let sided = groups.filter_map(|group| {
        let side = group.limits.open_side?;
        let restricts = group.spec.rows[0].restricts_start;
        restricts.then(|| (&group.name, group.rows.row(0), side.sign()))
    });
    let sided: Vec<_> = sided.collect();
    if sided.is_empty() {
        return Ok(());
    }
    let mut s = mechanism.scratch();
    mechanism.pose(mechanism.layout().start_time, q, &mut s);
    mechanism.phi(&mut s);
    let depth = |(name, row, sign): &(&String, usize, f64)| ((*name).clone(), -sign * s.phi[*row]);
    let depths = sided.iter().map(depth);
    let mut joints: Vec<(String, f64)> = depths
        .filter(|(_, depth)| *depth > SMALL_CORRECTION * size)
        .collect();
    joints.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    match joints.as_slice() {
        [] => Ok(()),
        _ => Err(StartError::WrongSide { joints }),
    }
}

/// Returns the coordinates q after the frames of some bodies are set to other poses.
fn posed(mechanism: &Mechanism, poses: &[StartPose], q: &[f64]) -> Result<Vec<f64>, StartError> {
    let space = mechanism.space();
    let mut posed = q.to_vec();
    for StartPose { body, frame } in poses {
        let bodies = mechanism.bodies().len();
        let record = mechanism.bodies().get(*body);
        let Some(moved) = record.and_then(|record| record.at(frame)) else {
            let body = *body;
            return Err(StartError::NoPose { body, bodies });
        };
        moved.coordinates(space, &mut posed[space.coordinates(*body)]);
    }
    Ok(posed)
}

/// Checks the requirements of all definitions and measures at a configuration.
///
/// # Errors
/// [`StartError::Requirement`]: the first requirement that is not satisfied.
pub fn requirement(mechanism: &Mechanism, q: &[f64]) -> Result<(), StartError> {
    let unmet = unmet_requirement(mechanism, q);
    match unmet.or_else(|| mechanism.frames().unmet_requirement(q)) {
        Some((name, requirement)) => Err(StartError::Requirement { name, requirement }),
        None => Ok(()),
    }
}

/// Returns the configuration closest to the described configuration that satisfies the rows and
/// whose axes point in the described directions.
fn closest(
    mechanism: &Mechanism,
    s: &mut Scratch,
    restricting: Restricting<'_>,
    described: &[f64],
    size: f64,
) -> Result<Vec<f64>, StartError> {
    let (rows, _) = restricting;
    let within = mechanism.has_tolerances();
    let start = (mechanism.layout().start_time, within);
    let q = nearest(mechanism, s, start, restricting, described, described);
    let q = if within {
        within::within_data(mechanism, s, restricting, described, size, q)
    } else {
        q
    };
    let q = match q {
        Ok(q) if approach::is_meant(mechanism, s, &q) => Ok(q),
        Err(e @ StartError::NoAssembly { .. })
            if approach::is_near(mechanism, s, rows, described, size) =>
        {
            Err(e)
        }
        Ok(_) | Err(StartError::NoAssembly { .. }) => {
            let meant = approached(mechanism, s, start, restricting, described, size);
            // A violated requirement is reported in a later check.
            match (q, meant) {
                (Ok(q), Err(_)) if !unmet_rows(mechanism, &q).is_empty() => Ok(q),
                (_, meant) => meant,
            }
        }
        Err(other) => Err(other),
    };
    // A violated requirement of a definition is reported instead of the rows that are violated
    // because of it.
    q.map_err(|error| match unmet_requirement(mechanism, described) {
        Some((name, requirement)) => StartError::Requirement { name, requirement },
        None => error,
    })
}

/// Returns the configuration closest to the described configuration. The iteration starts from a
/// configuration that satisfies the constraints and is closest in the metric of lengths. If this
/// iteration fails, the function returns the configuration closest to that starting configuration.
fn approached(
    mechanism: &Mechanism,
    s: &mut Scratch,
    start: (f64, bool),
    restricting: Restricting<'_>,
    described: &[f64],
    size: f64,
) -> Result<Vec<f64>, StartError> {
    let mut there = approach::approach(mechanism, s, restricting, described, size)?;
    // If a wheel is described below its plane, the iteration would satisfy the row of the wheel
    // from below. Therefore the other rows are satisfied first.
    let (rows, weights) = restricting;
    let unmet = unmet_rows(mechanism, &there);
    if !unmet.is_empty() {
        let mut others = rows.to_vec();
        others.retain(|row| !unmet.contains(row));
        let aside = approach::approach(mechanism, s, (&others, weights), described, size)?;
        there = approach::approach(mechanism, s, restricting, &aside, size)?;
    }
    let closest = nearest(mechanism, s, start, restricting, described, &there);
    match closest {
        Ok(q) if approach::is_meant(mechanism, s, &q) => Ok(q),
        _ => nearest(mechanism, s, start, restricting, &there, &there),
    }
}

/// Metric that defines which configuration is closest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Metric<'a> {
    /// Masses and inertias, the metric for the initial configuration.
    Mass,
    /// Masses and inertias; coordinates that these options keep do not change.
    Start(&'a StartOptions),
    /// Lengths, with angles times the size of the mechanism. The configurations that a mechanism
    /// can reach do not depend on its masses. In the mass metric, a large rotation of a large light
    /// body would be preferred to a small motion of its heavy neighbour.
    Length,
}

/// Returns the configuration closest to q on the given rows of Φ at time t. The function allocates
/// memory.
///
/// # Errors
/// - [`StartError::NoAssembly`]: no configuration near q satisfies the rows.
pub fn nearest_configuration(
    mechanism: &Mechanism,
    t: f64,
    rows: &[usize],
    q: &[f64],
    metric: Metric<'_>,
) -> Result<Vec<f64>, StartError> {
    let size = scene_size(mechanism, q);
    let weights = match metric {
        Metric::Mass => position_weights(mechanism, &StartOptions::default(), size)?,
        Metric::Start(options) => position_weights(mechanism, options, size)?,
        Metric::Length => metric::lengths(mechanism, size),
    };
    let mut s = mechanism.scratch();
    nearest(mechanism, &mut s, (t, false), (rows, &weights), q, q)
}

/// Returns the rows of Φ that restrict the initial configuration.
fn restricting_rows(mechanism: &Mechanism) -> Vec<usize> {
    let layout = mechanism.layout();
    layout
        .groups
        .iter()
        .flat_map(|g| g.rows.holonomic.clone().zip(g.spec.rows))
        .filter(|(_, spec)| spec.restricts_start)
        .map(|(row, _)| row)
        .collect()
}

/// Returns the inverse weights of the coordinates in the mass metric. The inverse weights are zero
/// for coordinates that are kept.
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
/// rounding. The caller passes the first q. If rows contradict each other, the sum of squares of Φ
/// is minimised. The result is then accepted if `within` finds the residuals within the stated
/// tolerances.
fn nearest(
    mechanism: &Mechanism,
    s: &mut Scratch,
    (t, within): (f64, bool),
    (rows, weights): Restricting<'_>,
    described: &[f64],
    from: &[f64],
) -> Result<Vec<f64>, StartError> {
    let mut q = from.to_vec();
    let mut best = f64::INFINITY;
    let mut stalled = 0;
    // The residual at its last decrease by a factor of ten, and the iteration at which it
    // decreased.
    let mut digit = (f64::INFINITY, 0);
    for iteration in 0..=ITERATIONS {
        mechanism.pose(t, &q, s);
        mechanism.phi(s);
        mechanism.c(s);
        let ratio = |r: usize| s.phi[r].abs() / mechanism.scales(s).position(r);
        // A row without terms is either satisfied or NaN.
        let misses = |r: usize| if s.phi[r] == 0.0 { 0.0 } else { ratio(r) };
        let (_, residual) = largest(rows.iter().map(|&r| (r, misses(r))));
        let tolerance = ROUNDINGS * f64::EPSILON;
        stalled = if residual < best { 0 } else { stalled + 1 };
        best = best.min(residual);
        if best <= 0.1 * digit.0 {
            digit = (best, iteration);
        }
        let is_last = iteration == ITERATIONS || iteration >= digit.1 + PATIENCE;
        // Rounding errors may be slightly larger than the tolerance: an iteration that stalls near
        // the tolerance has converged.
        if residual <= tolerance || (stalled > 1 && residual <= ROUNDINGS * tolerance) {
            return Ok(q);
        }
        let is_at_rest = stalled > 1 || is_last;
        if within && is_at_rest && residual.is_finite() && within::is_within(mechanism, s, rows) {
            return Ok(q);
        }
        // Rows are accurate to the rounding error of all possible terms. These include terms that
        // are zero at this orientation.
        if is_last && rows.iter().all(|&r| is_rounding(mechanism, s, r)) {
            return Ok(q);
        }
        if is_last || !residual.is_finite() {
            return Err(StartError::NoAssembly {
                misfits: approach::misfits(mechanism, s, rows),
                iterations: iteration,
            });
        }
        let c = dense_rows(mechanism.layout(), s, rows)?;
        let shift = mechanism.difference_of(described, &q);
        // Solves C·(q₀ + δ − q) + Φ = 0.
        let moved = c.times(&shift);
        let misfit: Vec<f64> = rows
            .iter()
            .zip(&moved)
            .map(|(&r, m)| s.phi[r] + m)
            .collect();
        let damped = DampedRows::new(&c, weights, DAMPING)?;
        let mut step = damped.step(&misfit)?;
        // Damping leaves a small residual. Another step removes the residual if the rows are
        // consistent.
        let left = c.times(&step);
        let misfit: Vec<f64> = misfit.iter().zip(&left).map(|(a, b)| a + b).collect();
        for (a, b) in step.iter_mut().zip(damped.step(&misfit)?) {
            *a += b;
        }
        q = mechanism.space().displaced(described, 1.0, &step);
    }
    unreachable!("the last iteration returns")
}

/// Returns whether the residual of a row of Φ is at most the rounding error of its terms at any
/// orientation.
fn is_rounding(mechanism: &Mechanism, s: &Scratch, row: usize) -> bool {
    let terms = mechanism.scales(s).terms(row, &Level::positions());
    s.phi[row].abs() <= ROUNDINGS * ROUNDINGS * f64::EPSILON * terms
}

/// Returns the joints and drives that are violated at coordinates q, the largest violation first.
fn missing(mechanism: &Mechanism, q: &[f64], rows: &[usize]) -> Vec<Misfit> {
    let mut s = mechanism.scratch();
    mechanism.pose(mechanism.layout().start_time, q, &mut s);
    mechanism.phi(&mut s);
    approach::misfits(mechanism, &s, rows)
}

fn check_correction(
    mechanism: &Mechanism,
    correction: &[f64],
    size: f64,
    misfits: impl FnOnce() -> Vec<Misfit>,
) -> Result<(), StartError> {
    let limit = |j: usize| SMALL_CORRECTION * mechanism.space().unit(j, size);
    let excess = |j: usize| correction[j].abs() / limit(j);
    let worst = (0..correction.len()).fold(0, |a, b| if excess(b) > excess(a) { b } else { a });
    if correction.is_empty() || excess(worst) <= 1.0 {
        return Ok(());
    }
    let (body, coordinate) = mechanism.coordinate(worst);
    Err(StartError::LargeCorrection {
        body: body.to_owned(),
        coordinate,
        correction: correction[worst].abs(),
        limit: limit(worst),
        unit: if mechanism.space().is_rotation(worst) {
            "rad"
        } else {
            "m"
        },
        misfits: misfits(),
    })
}
