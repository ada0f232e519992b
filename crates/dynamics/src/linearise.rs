//! Small motions about an equilibrium or a steady motion: `ẋ = A·x + B·u`.
//!
//! The state x consists of independent positions and independent velocities. The number of
//! positions is the number of degrees of freedom with the holonomic rows alone. The number of
//! velocities is the number of degrees of freedom with all rows. Positions and velocities are small
//! changes of named coordinates of the bodies: translations and rotations of their frames. The axes
//! may rotate with one of the bodies ([`LineariseOptions::follow`]).
//!
//! The state is displaced along a curve whose direction satisfies the linearised constraints. The
//! accelerations on independent rows are differentiated along this curve. The derivative depends
//! only on the direction, so the curve needs no projection. Central differences of order eight with
//! steps of 1/128 of the size of the mechanism are accurate to rounding. The error estimate is the
//! difference between the results of order eight and order six.

mod bases;
mod chosen;
mod coordinate;
mod curve;
mod error;
mod followed;
mod inputs;
mod linearisation;
mod modes;
mod reduce;

use linalg::Matrix;

use crate::error::MotionFault;
use crate::held::{accelerated, rests};
use crate::motion::KeptRowMotion;
use crate::prepare::PreparedMechanism;
use bases::Bases;
use chosen::CoordinateChoice;
use curve::{Curves, Derivative};
use followed::FollowedCoordinates;
use reduce::reduce;

pub use coordinate::Coordinate;
pub use error::LineariseError;
pub use inputs::Input;
pub use linearisation::{Linearisation, SecondOrder};
pub use modes::{Mode, Stability};

/// Options of a linearisation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineariseOptions {
    /// Requested independent coordinates, such as `crank.angle`. The program chooses the remaining
    /// coordinates.
    pub coordinates: Vec<String>,
    /// Cyclic coordinates of a steady motion, such as `frame.x` or `frame.wz`. The cyclic
    /// coordinates are eliminated, and the axes rotate with the last cyclic coordinate.
    pub follow: Vec<String>,
}

/// Linearises the motion about the state q, v at time t. The state must satisfy the constraints.
///
/// At rest (v = 0), functions of time keep their values at t, as in [`crate::equilibrium`]. A
/// deviation of a drive from this value is an input.
///
/// # Errors
/// - [`LineariseError::NotSteady`]: the state is neither an equilibrium nor steady.
/// - [`LineariseError::Coordinate`], [`LineariseError::Dependent`]: requested coordinates do not
///   exist, or do not determine the state.
/// - [`LineariseError::NotASymmetry`]: the motion depends on a cyclic coordinate.
/// - [`LineariseError::Fault`]: the equations have no solution at the state, or a force calls an
///   external function.
pub fn linearise(
    prepared: &PreparedMechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    options: &LineariseOptions,
) -> Result<Linearisation, LineariseError> {
    if let Some(source) = prepared
        .mechanism
        .applied_forces()
        .without_derivatives()
        .next()
    {
        return Err(LineariseError::Fault(MotionFault::NoDerivatives {
            needs: "a linearisation needs",
            source,
            instead: "give the drive a law of `measure`, `rate` and `t` alone",
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
    let followed = FollowedCoordinates::of(&prepared.mechanism, (q, v), &options.follow)?;
    let mut curves = Curves::new(KeptRowMotion::new(prepared)?, prepared, (t, q, v))?;
    curves.check_steady(followed.turning)?;
    let chosen = CoordinateChoice::new(&curves, &followed, &options.coordinates)?;
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
        return reduce(&followed, whole, &chosen, &curves);
    }
    let second_order = second_order(&whole, &curves, &bases);
    Ok(Linearisation {
        second_order,
        ..whole
    })
}

/// Returns M, D and K of a state at rest. The independent velocities must be the rates of the
/// independent positions.
fn second_order(x: &Linearisation, curves: &Curves<'_>, bases: &Bases) -> Option<SecondOrder> {
    let n = x.positions.len();
    if !curves.is_at_rest() || x.velocities.len() != n {
        return None;
    }
    let (_, q, _) = curves.state();
    let inertia = curves.mechanism().inertia_at(q);
    let mass = Matrix::from_fn(n, n, |i, k| {
        inertia.between(bases.shifts.row(i), bases.shifts.row(k))
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
