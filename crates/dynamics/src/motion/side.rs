//! Has the mechanism passed a singular configuration within a step? There its branch is not determined by the constraints,
//! and a step that goes over it may land on another one with every residual at rounding.
//!
//! Every stage is looked at, not only the end of a step: where two branches cross, the sign of the determinant changes along each,
//! and is the same again before the crossing on one and behind it on the other.

use super::rows::KeptRows;
use crate::error::Trip;

/// A frame of the motions that were possible at the last accepted step, and the sign of the determinant of the kept rows
/// bordered by it.
#[derive(Default)]
pub(super) struct Side {
    frame: Vec<f64>,
    sign: f64,
    t: f64,
}

impl Side {
    /// Compares freshly factored rows at time t with the last accepted step.
    pub(super) fn check(&self, rows: &mut KeptRows, t: f64) -> Result<(), Trip> {
        match rows.are_singular() || self.sign * rows.orientation(&self.frame) < 0.0 {
            true => Err(Trip::SingularPassage {
                from: self.t,
                to: t,
            }),
            false => Ok(()),
        }
    }

    /// Takes the freshly factored rows of an accepted step at time t.
    pub(super) fn take(&mut self, rows: &mut KeptRows, t: f64) {
        self.t = t;
        rows.null_frame(&mut self.frame);
        self.sign = rows.orientation(&self.frame);
    }
}
