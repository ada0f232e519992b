//! Couplings: a measure of one joint follows a measure of another by a polynomial, as the wheels of
//! a gear train, a rack, or a cam of few terms.
//!
//! A drive states its measure by the row measure − initial measure − motion, or for an angle in
//! space by the sine of what is left of the angle ([`joints::spec::ConstraintSpec::turning`]). A
//! coupling has the kernels of two drives, x and y their measures since the start, and the row `y −
//! (ratio·x + c₂·x² + …) = 0`.
//!
//! Its multiplier is its load: the force or torque along y, as that of a drive of y. Its reaction
//! is that of this drive: on the first body of the joint of y, at the place of that joint. It is
//! not the total on a body: a body that both joints share has the load along x, too, and the two
//! may cancel.

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

/// Name of the datum with the initial value of a measure that has a row of its own.
const OF_ROW: &str = "measure_0";

/// A coupling of two measures.
#[derive(Clone)]
struct Coupling<S: BodySpace> {
    /// The measure x, and y that follows it.
    sides: [Side<S>; 2],
    law: Polynomial,
    facts: &'static facts::CouplingFacts,
    /// Its rows for all that does not move, recorded when first asked for.
    programs: OnceLock<Arc<Programs>>,
}

/// The constraint by which the second measure follows the first: their changes since the start
/// satisfy `y = Σ coefficients[k]·xᵏ⁺¹`.
///
/// # Errors
/// - [`CouplingError::Measure`]: a measure has no row of its own.
/// - [`CouplingError::Coefficients`]: a coefficient is not finite, or all are zero.
#[allow(private_bounds)]
pub(crate) fn couple<S: Kinematics>(
    measures: [AttachedMeasure<S>; 2],
    coefficients: &[f64],
) -> Result<AttachedConstraint<S>, CouplingError> {
    let law = Polynomial::new(coefficients).ok_or(CouplingError::Coefficients)?;
    // The first body is that of the joint of y, where the load of the coupling acts.
    let mut bodies: Vec<BodyRef> = measures[1].0.clone();
    bodies.dedup();
    let mut slots = Vec::new();
    for (own, drive) in &measures {
        let spec = drive.spec();
        // A kept measure has no initial value of its own: its drive has the rows of the joint.
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
