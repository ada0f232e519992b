//! Initial velocities. Velocities that are not given are computed from the given velocities and
//! from prescribed motions, with the smallest kinetic energy.
//!
//! Given velocities may be rounded to a few digits. Impossible given velocities are replaced by the
//! closest possible velocities in the mass metric. If the difference exceeds the permitted
//! correction, the error contains the wrong velocities. Velocities in `keep` do not change.
//!
//! Residuals are compared with the rounding errors of their own terms, and velocities at rest with
//! the rounding errors of positions. Residuals and velocities are not compared with a solution,
//! because the solution may be zero.
//!
//! We rejected a single least-squares problem for all velocities: a crank with a given rate of 10
//! rad/s slowed down because of the bodies connected to it.

use linalg::Matrix;

use super::conflict::VelocityConflict;
use super::dependent::{DENSE_ROWS, DependentVelocities, Equations, RowBlock, exceeds, shortest};
use super::error::StartError;
use super::metric::{ROUNDINGS, SMALL_CORRECTION, largest};
use super::options::{CorrectionLimit, KeepLevel, StartOptions, kept_columns};
use crate::mechanism::Mechanism;

/// Velocities that satisfy the constraints.
#[derive(Clone, Debug, PartialEq)]
pub struct StartVelocity {
    /// The velocities.
    pub v: Vec<f64>,
    /// The velocities minus the given velocities. The value is zero for velocities that are not
    /// given.
    pub correction: Vec<f64>,
}

/// Whether a velocity is computed, given or kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hold {
    /// The velocity is computed from the other velocities.
    No,
    /// The velocity is given. The accuracy of the velocity is the accuracy of the given digits.
    Given,
    /// The velocity is given as an exact value.
    Kept,
}

/// Number of corrections of given velocities. Each correction after the first removes the rounding
/// error of the previous correction.
const PASSES: usize = 5;

/// In large sets, the weight of dependent velocities relative to the weight of given velocities.
/// This weight is so small that it has no effect on the result.
const CHEAP: f64 = 1e-6;

/// Entries of a sum of rows count as rounding if they are below this fraction of the terms of the
/// sum.
const CANCELLED: f64 = 1e-12;

/// Returns velocities that satisfy `C·v = b` in the rows `kept` at an assembled configuration.
/// Given velocities are used, and the other velocities have the smallest kinetic energy, `M·v =
/// Cᵀ·μ`. Velocities without mass or inertia have the weight of the smallest mass or inertia.
///
/// Given velocities that are compatible up to rounding do not change. Incompatible velocities are
/// corrected by the smallest change in the mass metric. Velocities that `options` keep do not
/// change. Kept velocities need not be given.
///
/// ```
/// use joints::Revolute;
/// use pfaff_model::start::{StartOptions, assemble, consistent_velocity};
/// use pfaff_model::{Body, BodyRef, Description, Mechanism, System};
///
/// // A bob 2 m below its pivot, rotating with 3 rad/s: its centre moves with 6 m/s.
/// let mut d = Description::new("pendulum");
/// let bob = d.body(Body { position: [0.0, -2.0], angular_velocity: Some(3.0), ..Body::new("bob", 1.0, 0.1) });
/// d.joint("pivot", &[BodyRef::Ground, bob], Revolute { s_i: [0.0, 0.0], s_j: [0.0, 2.0] });
/// let mut mechanism = Mechanism::build(&d).unwrap();
/// let options = StartOptions::default();
/// let q = assemble(&mut mechanism, &options)?.q;
/// let given = mechanism.frames().given_velocities(&q);
/// let found = consistent_velocity(&mechanism, &options, &q, &given, &[0, 1])?;
/// assert_eq!((found.v, found.correction), (vec![6.0, 0.0, 3.0], vec![0.0; 3]));
/// # Ok::<(), pfaff_model::StartError>(())
/// ```
///
/// # Errors
/// - [`StartError::Velocities`]: the given velocities are impossible, or need a larger correction
///   than `options` allow.
/// - [`StartError::NoVelocity`]: the rows do not permit any velocities.
/// - [`StartError::NoCoordinate`]: `options` refer to a velocity that does not exist.
pub fn consistent_velocity(
    mechanism: &Mechanism,
    options: &StartOptions,
    q: &[f64],
    given: &[Option<f64>],
    kept: &[usize],
) -> Result<StartVelocity, StartError> {
    let mut start = Start::new(mechanism, options, q, given)?;
    let mut v = start.written.clone();
    let mut conflicts: Vec<VelocityConflict> = Vec::new();
    // If the velocities are already consistent, no matrix is necessary.
    if start.misses(kept, &v) {
        start.equations.learn();
        for rows in start.equations.sets(kept, |_| true) {
            if !start.misses(&rows, &v) {
                continue;
            }
            match start.solve(&rows, &start.hold, start.limit, &mut v)? {
                None => {}
                Some(miss) => conflicts.push(start.conflict(&rows, miss)?),
            }
        }
    }
    if let Some(conflict) = VelocityConflict::merged(conflicts) {
        return Err(Box::new(conflict).into());
    }
    let found = v.iter().zip(&start.written).zip(&start.hold);
    let correction = found.map(|((v, written), hold)| match hold {
        Hold::No => 0.0,
        _ => v - written,
    });
    Ok(StartVelocity {
        correction: start.equations.velocities(&correction.collect::<Vec<_>>()),
        v: start.equations.velocities(&v),
    })
}

/// Requirements for the initial velocities.
pub(super) struct Start<'m> {
    pub(super) equations: Equations<'m>,
    /// Given velocities in the variables of the equations; zero for velocities that are not given.
    pub(super) written: Vec<f64>,
    /// For each velocity, whether the scene gives it.
    pub(super) is_written: Vec<bool>,
    pub(super) hold: Vec<Hold>,
    pub(super) limit: CorrectionLimit,
    /// The largest rate of the given velocities (1/s).
    fastest: f64,
}

/// Reason why some rows have no acceptable velocities.
#[derive(Clone, Copy, Debug)]
pub(super) enum Miss {
    /// The closest velocities are too far from the given velocities.
    Far,
    /// The rows do not permit any velocities; this row has the largest residual.
    Open(usize),
}

impl<'m> Start<'m> {
    fn new(
        mechanism: &'m Mechanism,
        options: &StartOptions,
        q: &[f64],
        given: &[Option<f64>],
    ) -> Result<Self, StartError> {
        let hold = |x: &Option<f64>| x.map_or(Hold::No, |_| Hold::Given);
        let mut hold: Vec<Hold> = given.iter().map(hold).collect();
        for column in kept_columns(mechanism, options, KeepLevel::Velocity)? {
            hold[column] = Hold::Kept;
        }
        let equations = Equations::new(mechanism, options, q);
        let mut written: Vec<f64> = given.iter().map(|x| x.unwrap_or_default()).collect();
        equations.take(&mut written);
        Ok(Self {
            fastest: equations.fastest(0..written.len(), &written),
            equations,
            written,
            is_written: given.iter().map(Option::is_some).collect(),
            hold,
            limit: options.correction,
        })
    }

    /// Returns whether one of these rows has a residual that is larger than rounding.
    fn misses(&self, rows: &[usize], v: &[f64]) -> bool {
        let of = &self.equations;
        rows.iter()
            .any(|&i| exceeds(of.residual(i, v).abs(), of.rounding(i, v)))
    }

    /// Computes the velocities for some rows. The rows must include all rows that have a velocity
    /// in common with them. Returns the reason if there are no acceptable velocities.
    ///
    /// # Errors
    /// Returns an error if a value is not finite.
    pub(super) fn solve(
        &self,
        rows: &[usize],
        hold: &[Hold],
        limit: CorrectionLimit,
        v: &mut [f64],
    ) -> Result<Option<Miss>, StartError> {
        let of = &self.equations;
        let columns = of.columns(rows);
        for &j in &columns {
            v[j] = match hold[j] {
                Hold::No => 0.0,
                _ => self.written[j],
            };
        }
        let mut dependent = DependentVelocities::new(of, rows, |j| hold[j] == Hold::No)?;
        dependent.follow(of, v)?;
        let given: Vec<usize> = columns
            .iter()
            .copied()
            .filter(|&j| hold[j] == Hold::Given)
            .collect();
        for _ in 0..PASSES {
            let is_open = dependent.open(of, v).next().is_some()
                || rows.len() > DENSE_ROWS && self.misses(rows, v);
            if given.is_empty() || !is_open {
                break;
            }
            if rows.len() > DENSE_ROWS {
                self.correct_many(rows, hold, v)?;
            } else {
                self.correct(&dependent, &given, v)?;
            }
            dependent.follow(of, v)?;
        }
        // A velocity that is given as zero up to rounding is set to zero. Otherwise, the iteration
        // for a locked part would reduce this velocity in every step and would not end.
        let is_still = |&j: &usize| v[j].abs().max(self.written[j].abs()) <= of.rest_of(j);
        if columns.iter().all(is_still) && rows.iter().all(|&i| of.s.b[i] == 0.0) {
            for &j in columns.iter().filter(|&&j| hold[j] != Hold::Kept) {
                v[j] = 0.0;
            }
        }
        Ok(self
            .open(rows, &columns, v)
            .or_else(|| self.far(&columns, hold, limit, v)))
    }

    /// Adds the smallest correction of the given velocities that makes the sums over circuits zero.
    fn correct(
        &self,
        dependent: &DependentVelocities,
        given: &[usize],
        v: &mut [f64],
    ) -> Result<(), StartError> {
        let of = &self.equations;
        let mut sums: Vec<Vec<f64>> = Vec::new();
        let mut residual = Vec::new();
        for circuit in &dependent.circuits {
            let c = of.matrix(&circuit.rows, given);
            let sum = c.transpose_times(&circuit.coefficients);
            let terms = |l: usize| {
                (0..c.nrows())
                    .map(|k| (circuit.coefficients[k] * c[(k, l)]).abs())
                    .sum::<f64>()
            };
            let largest = (0..given.len()).map(terms).fold(0.0, f64::max);
            // These rows contain only kept velocities, so given velocities cannot correct them.
            if sum.iter().all(|x| x.abs() <= CANCELLED * largest) {
                continue;
            }
            let terms = circuit.rows.iter().zip(&circuit.coefficients);
            residual.push(terms.map(|(&i, z)| z * of.residual(i, v)).sum());
            sums.push(sum);
        }
        if sums.is_empty() {
            return Ok(());
        }
        let sums = Matrix::from_fn(sums.len(), given.len(), |k, l| sums[k][l]);
        let weights: Vec<f64> = given.iter().map(|&j| of.weights[j]).collect();
        for (&j, dv) in given.iter().zip(shortest(&sums, &residual, &weights)?) {
            v[j] += dv;
        }
        Ok(())
    }

    /// Works like [`Self::correct`], for many rows. Here, the dependent velocities are variables
    /// with almost zero weight.
    fn correct_many(&self, rows: &[usize], hold: &[Hold], v: &mut [f64]) -> Result<(), StartError> {
        let of = &self.equations;
        let mut columns = of.columns(rows);
        columns.retain(|&j| hold[j] != Hold::Kept);
        let cost =
            |&j: &usize| of.weights[j].recip() * if hold[j] == Hold::No { CHEAP } else { 1.0 };
        let masses: Vec<f64> = columns.iter().map(cost).collect();
        let mut moved = v.to_vec();
        if let Some(mut part) = RowBlock::schur(of, rows, columns.clone(), &masses)? {
            part.follow(of, &mut moved)?;
        }
        for &j in columns.iter().filter(|&&j| hold[j] == Hold::Given) {
            v[j] = moved[j];
        }
        Ok(())
    }

    /// Returns the row with the largest residual if the residual exceeds the limits for rounding
    /// and rest.
    fn open(&self, rows: &[usize], columns: &[usize], v: &[f64]) -> Option<Miss> {
        let of = &self.equations;
        // Velocities that are computed together are accurate to the rounding error of the largest
        // of these velocities.
        let rate = of.fastest(columns.iter().copied(), v);
        // The rounding error may be slightly larger than the rounding error of the terms of one
        // row.
        let excess = |i: usize| {
            of.residual(i, v).abs() / (ROUNDINGS * of.rounding(i, v) + of.slack(i, rate))
        };
        let excesses = rows
            .iter()
            .map(|&i| (i, excess(i)))
            .filter(|(i, _)| of.residual(*i, v) != 0.0);
        let (row, worst) = largest(excesses);
        exceeds(worst, 1.0).then_some(Miss::Open(row))
    }

    /// Returns whether a given velocity was corrected by more than the permitted amount.
    fn far(
        &self,
        columns: &[usize],
        hold: &[Hold],
        limit: CorrectionLimit,
        v: &[f64],
    ) -> Option<Miss> {
        if limit == CorrectionLimit::Any {
            return None;
        }
        let mut given = columns.iter().filter(|&&j| hold[j] == Hold::Given);
        given
            .any(|&j| (v[j] - self.written[j]).abs() > self.allowed(j, columns, hold, v))
            .then_some(Miss::Far)
    }

    /// Returns the largest permitted correction of a given velocity. The permitted correction is a
    /// thousandth of the largest velocity that has rows in common with this velocity, plus the
    /// limit of rest for the largest of all velocities. Rotations are multiplied by the size of the
    /// mechanism.
    pub(super) fn allowed(&self, j: usize, columns: &[usize], hold: &[Hold], v: &[f64]) -> f64 {
        let of = &self.equations;
        if hold[j] == Hold::Kept {
            return of.rest_of(j);
        }
        let speed = |k: &usize| of.arm(*k) * v[*k].abs().max(self.written[*k].abs());
        let fastest = columns.iter().map(speed).fold(0.0, f64::max);
        (SMALL_CORRECTION * fastest / of.arm(j)).max(of.rest_at(j, self.fastest))
    }
}
