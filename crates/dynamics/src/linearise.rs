//! Small motions about a state that is at rest or steady: `ẋ = A·x + B·u`.
//!
//! x are independent positions, as many as the holonomic rows leave free, and independent
//! velocities, as many as all rows leave free. Both are small changes of named coordinates of the
//! bodies: places and turns of their frames, in axes that may turn with one of them
//! ([`LineariseOptions::follow`]).
//!
//! A state is displaced along a curve whose direction satisfies the linearised constraints, and
//! accelerations of the motion on kept rows are differentiated along it: the derivative depends on
//! the direction only, so the curve needs no projection. Central differences of order eight from
//! steps of 1/128 of the mechanism are accurate to rounding, and those of order six tell by how
//! much.

mod coordinates;
mod curve;
mod error;
mod inputs;
mod modes;
mod reduce;

use linalg::{DampedRows, Matrix};
use model::System;

use crate::error::MotionFault;
use crate::held::{accelerated, rests};
use crate::motion::KeptRowMotion;
use crate::prepare::Prepared;
use coordinates::Chosen;
use curve::{BODY, Curves, Derivative};
use reduce::Followed;

pub use coordinates::Coordinate;
pub use error::LineariseError;
pub use inputs::Input;
pub use modes::{Mode, Stability};

/// What is asked of a linearisation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineariseOptions {
    /// Independent coordinates that are wanted, such as `crank.angle`; the others are chosen.
    pub coordinates: Vec<String>,
    /// Coordinates in which the state moves on without change, such as `frame.x` or `frame.wz`:
    /// they are left out, and axes turn with the latter.
    pub follow: Vec<String>,
}

/// The linearised motion about a state.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Linearisation {
    /// Time (s).
    pub time: f64,
    /// Coordinates of the state, n_q.
    pub q: Vec<f64>,
    /// The positions of x, in front.
    pub positions: Vec<Coordinate>,
    /// The velocities of x.
    pub velocities: Vec<Coordinate>,
    /// The inputs u.
    pub inputs: Vec<Input>,
    /// Drives and joints that functions of time would accelerate, and that are held because the
    /// state is at rest.
    pub held: Vec<String>,
    /// A, square.
    pub a: Matrix,
    /// B, a column for each input.
    pub b: Matrix,
    /// Mass, damping and stiffness of `M·ÿ + D·ẏ + K·y = …` for the positions y; only at rest,
    /// without nonholonomic rows and if nothing is followed.
    pub second_order: Option<SecondOrder>,
    /// Displacements of all bodies for a change by one of each position, in rows: n_v each.
    pub shapes: Matrix,
    /// Difference of two orders of approximation, as a share of the largest entries of A.
    pub accuracy: f64,
}

/// Matrices of `M·ÿ + D·ẏ + K·y`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SecondOrder {
    /// Masses and moments of inertia.
    pub mass: Matrix,
    /// Damping.
    pub damping: Matrix,
    /// Stiffness: of springs, of the weight and of the forces that the joints carry.
    pub stiffness: Matrix,
}

/// Linearises the motion about the state q, v at time t, which satisfies the constraints.
///
/// At rest, v = 0, functions of time keep the values that they have at t, as in
/// [`crate::equilibrium`]: what a drive does next is an input.
///
/// # Errors
/// - [`LineariseError::NotSteady`]: the state is neither at rest nor steady.
/// - [`LineariseError::Coordinate`], [`LineariseError::Dependent`]: asked coordinates do not exist,
///   or do not determine the state.
/// - [`LineariseError::NotASymmetry`]: the motion depends on a coordinate that is followed.
/// - [`LineariseError::Fault`]: the equations have no solution there, or a force calls a function.
pub fn linearise(
    prepared: &Prepared,
    (t, q, v): (f64, &[f64], &[f64]),
    options: &LineariseOptions,
) -> Result<Linearisation, LineariseError> {
    if let Some(source) = prepared.mechanism.applied_forces().called().next() {
        return Err(LineariseError::Fault(MotionFault::NoDerivatives {
            needs: "a linearisation needs",
            source,
            instead: "give the drive a law of `measure`, `rate` and `t`",
        }));
    }
    let size = prepared.assembly.size;
    let at_rest = rests(&prepared.mechanism, size, v).then(|| prepared.held_at(t));
    let still = vec![0.0; v.len()];
    let v = if at_rest.is_some() { &still } else { v };
    let held = match &at_rest {
        Some(_) => accelerated(&prepared.mechanism, size, t, q),
        None => Vec::new(),
    };
    let prepared = at_rest.as_ref().unwrap_or(prepared);
    let followed = Followed::of(&prepared.mechanism, (q, v), &options.follow)?;
    let mut curves = Curves::new(KeptRowMotion::new(prepared)?, prepared, (t, q, v))?;
    curves.check_steady(followed.turning)?;
    let chosen = Chosen::new(&curves, &followed, &options.coordinates)?;
    let bases = Bases::new(&curves, &chosen)?;

    let mut columns = Vec::new();
    for k in 0..chosen.positions.len() {
        let shift = bases.shift(k);
        let dv = bases.velocity_kept_by(&curves, &shift)?;
        columns.push(curves.along(&shift, &dv)?);
    }
    for k in 0..chosen.velocities.len() {
        let dv = bases.velocity(k)?;
        columns.push(curves.along(&vec![0.0; dv.len()], &dv)?);
    }
    let (inputs, of_inputs) = inputs::all(&mut curves, &bases)?;
    let accuracy = curves.accuracy();
    let rates = |columns: &[Derivative]| {
        let mut all = Matrix::zeros(chosen.len(), columns.len());
        for (k, column) in columns.iter().enumerate() {
            for (i, rate) in chosen.rates(column, &curves, followed.turning).enumerate() {
                all[(i, k)] = rate;
            }
        }
        all
    };
    let whole = Linearisation {
        time: t,
        q: q.to_vec(),
        a: rates(&columns),
        b: rates(&of_inputs),
        positions: chosen.positions.clone(),
        velocities: chosen.velocities.clone(),
        inputs,
        held,
        second_order: None,
        shapes: bases.shifts.clone(),
        accuracy,
    };
    if !options.follow.is_empty() {
        return followed.reduce(whole, &chosen, &curves);
    }
    let second_order = second_order(&whole, &curves, &bases);
    Ok(Linearisation {
        second_order,
        ..whole
    })
}

/// M, D and K of a state at rest whose velocities are the rates of its positions.
fn second_order(x: &Linearisation, curves: &Curves<'_>, bases: &Bases) -> Option<SecondOrder> {
    let n = x.positions.len();
    if !curves.is_at_rest() || x.velocities.len() != n {
        return None;
    }
    let masses = curves.mechanism().mass();
    let mass = Matrix::from_fn(n, n, |i, k| {
        let terms = masses.iter().zip(bases.shifts.row(i));
        terms
            .zip(bases.shifts.row(k))
            .map(|((m, a), b)| m * a * b)
            .sum()
    });
    let of = |first: usize| {
        let block = Matrix::from_fn(n, n, |i, k| -x.a[(n + i, first + k)]);
        mass.product(&block)
    };
    Some(SecondOrder {
        damping: of(n),
        stiffness: of(0),
        mass,
    })
}

/// Displacements and velocities that change one independent coordinate each.
pub(crate) struct Bases {
    /// Displacements in rows, one for each position, n_v each.
    pub(crate) shifts: Matrix,
    positions: DampedRows,
    velocities: DampedRows,
    /// Numbers of kept rows of Φ and of C.
    kept: [usize; 2],
    free: [usize; 2],
    free_velocities: Vec<Coordinate>,
}

impl Bases {
    fn new(curves: &Curves<'_>, chosen: &Chosen) -> Result<Self, LineariseError> {
        let weights = curves.squared_units();
        let square = |kept: &[usize], free: &[Coordinate]| {
            let c = curves.rows(kept);
            let all = Matrix::from_fn(kept.len() + free.len(), weights.len(), |i, j| {
                if i < kept.len() {
                    c[(i, j)]
                } else {
                    curves.frames[(free[i - kept.len()].row(), j)]
                }
            });
            DampedRows::new(&all, &weights, 0.0).map_err(|_| LineariseError::Singular)
        };
        let [of_phi, of_c] = curves.kept();
        let positions = square(of_phi, &chosen.positions)?;
        let (m, d) = (of_phi.len(), chosen.positions.len());
        let mut shifts = Matrix::zeros(d, weights.len());
        for k in 0..d {
            let shift = unit_step(&positions, m + d, m + k)?;
            shifts.row_mut(k).copy_from_slice(&shift);
        }
        Ok(Self {
            shifts,
            velocities: square(of_c, &chosen.velocities)?,
            positions,
            kept: [m, of_c.len()],
            free: [d, chosen.velocities.len()],
            free_velocities: chosen.velocities.clone(),
        })
    }

    /// The displacement that changes position k by one.
    fn shift(&self, k: usize) -> Vec<f64> {
        self.shifts.row(k).to_vec()
    }

    /// The velocity that changes velocity k by one.
    fn velocity(&self, k: usize) -> Result<Vec<f64>, LineariseError> {
        let [_, r] = self.kept;
        unit_step(&self.velocities, r + self.free[1], r + k)
    }

    /// The displacement that changes the kept row `k` of Φ by one, and no independent position.
    pub(crate) fn shift_of_row(&self, k: usize) -> Result<Vec<f64>, LineariseError> {
        unit_step(&self.positions, self.kept[0] + self.free[0], k)
    }

    /// The velocity that changes the kept row `k` of C·v by one, and no independent velocity.
    pub(crate) fn velocity_of_row(&self, k: usize) -> Result<Vec<f64>, LineariseError> {
        unit_step(&self.velocities, self.kept[1] + self.free[1], k)
    }

    /// The change of velocities along a displacement with constant independent velocities.
    pub(crate) fn velocity_kept_by(
        &self,
        curves: &Curves<'_>,
        shift: &[f64],
    ) -> Result<Vec<f64>, LineariseError> {
        let missed = curves.missed_velocities(shift, &self.free_velocities);
        let step = self.velocities.step(&missed);
        step.map_err(|_| LineariseError::Singular)
    }
}

/// The step that changes row k of `of` by one and the others not.
fn unit_step(of: &DampedRows, rows: usize, k: usize) -> Result<Vec<f64>, LineariseError> {
    let mut residual = vec![0.0; rows];
    residual[k] = -1.0;
    of.step(&residual).map_err(|_| LineariseError::Singular)
}

/// Row of the frame of a body and its direction: three translations, then three rotations.
pub(crate) fn frame_row(body: usize, direction: usize) -> usize {
    BODY * body + direction
}
