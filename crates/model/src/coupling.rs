//! Couplings: a coordinate of one joint is a polynomial of a coordinate of another joint. Examples
//! are the wheels of a gear train, a rack, or a cam with few terms.
//!
//! The row of a drive is coordinate − initial coordinate − prescribed change. For an angle in
//! space, the row is the sine of the remaining angle ([`joints::spec::ConstraintSpec::turning`]). A
//! coupling has the kernels of two drives and the row `y − (ratio·x + c₂·x² + …) = 0`. Here x and y
//! are the changes of the joint coordinates since the start.
//!
//! The multiplier of a coupling is its load: the force or torque along y, like the load of a drive
//! of y. The reaction of a coupling is the reaction of this drive. The reaction acts on the first
//! body of the joint of y, at the reference point of this joint. This reaction is not the total
//! load on the body. On a body that belongs to both joints, the load along x acts as well, and the
//! two loads may cancel.
//!
//! A coupling uses the kernels of these two drives, so it does not need its own definition.

mod element;
mod error;
mod facts;
mod polynomial;
mod side;

use std::sync::{Arc, OnceLock};

use joints::Programs;

use crate::body::BodyRef;
use crate::element::{BodySpace, Kinematics};
pub(crate) use facts::TYPE;
use facts::facts;
use polynomial::Polynomial;
use side::Side;

pub use crate::element::{AttachedConstraint, AttachedMeasure};
pub use error::CouplingError;

/// Name of the datum with the initial value of a joint coordinate, if the drive has a separate row
/// for the coordinate.
const OF_ROW: &str = "measure_0";

/// A coupling of two joint coordinates.
#[derive(Clone)]
struct Coupling<S: BodySpace> {
    /// The coordinate x, and the coordinate y, which is given by a polynomial of x.
    sides: [Side<S>; 2],
    law: Polynomial,
    facts: &'static facts::CouplingFacts,
    /// Operation lists of the rows for evaluations in which nothing moves. The lists are recorded
    /// at the first request.
    programs: OnceLock<Arc<Programs>>,
}

/// Returns the constraint that makes the second joint coordinate a function of the first. The
/// changes x and y of the two coordinates since the start satisfy `y = Σ coefficients[k]·xᵏ⁺¹`.
///
/// # Errors
/// - [`CouplingError::Measure`]: a joint coordinate does not have its own row.
/// - [`CouplingError::Coefficients`]: a coefficient is not finite, or all are zero.
#[allow(private_bounds)]
pub(crate) fn couple<S: Kinematics>(
    measures: [AttachedMeasure<S>; 2],
    coefficients: &[f64],
) -> Result<AttachedConstraint<S>, CouplingError> {
    let law = Polynomial::new(coefficients).ok_or(CouplingError::Coefficients)?;
    // The load of the coupling acts on the first body of the joint of y, so this body comes first.
    let mut bodies: Vec<BodyRef> = measures[1].0.clone();
    bodies.dedup();
    let mut slots = Vec::new();
    for (own, drive) in &measures {
        let spec = drive.spec();
        // Without a separate row, there is no separate initial value. The rows of the drive are
        // then the rows of the joint.
        let has_own_row = spec.data.iter().any(|datum| datum.name == OF_ROW);
        let is_single = has_own_row && spec.rows.len() == 1 && own.len() == 2;
        if !is_single || spec.common.slots.len() != 2 || spec.common.functions().count() != 1 {
            return Err(CouplingError::Measure {
                definition: spec.common.name,
                rows: spec.rows.len(),
                slots: spec.common.slots.len(),
            });
        }
        let mut of = |body: &BodyRef| {
            let known = bodies.iter().position(|b| b == body);
            known.unwrap_or_else(|| {
                bodies.push(*body);
                bodies.len() - 1
            })
        };
        let own: Vec<usize> = own.iter().map(&mut of).collect();
        slots.push([own[0], own[1]]);
    }
    let [(_, x), (_, y)] = measures;
    let facts = facts(
        [x.spec(), y.spec()],
        [slots[0], slots[1]],
        [bodies.len(), S::N_DOF],
        law.degree(),
    );
    let first = [0, x.spec().n_data()];
    let turns = [0, usize::from(x.spec().turning)];
    let x = Side::new(x, slots[0], [first[0], 0], turns[0], facts);
    let y = Side::new(y, slots[1], [first[1], x.stored.end], turns[1], facts);
    let coupling = Coupling {
        sides: [x, y],
        law,
        facts,
        programs: OnceLock::new(),
    };
    Ok((bodies, Box::new(coupling)))
}

#[cfg(test)]
mod tests;
