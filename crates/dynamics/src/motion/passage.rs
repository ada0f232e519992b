//! Does a step pass a singular configuration? There the kept rows are dependent for an instant: branches of the motion may meet,
//! and a step may land on another one with every residual at rounding.
//!
//! Stages that come as near as [`SINGULAR`](super::rows) leave the dependent rows out of their solve. A step must not end
//! near a singular configuration, where a projection cannot tell the branches apart; one that goes over it stands only if it
//! needed no correction worth its tolerance, which a kink into another branch would: the motion goes on as smoothly as it came.

use super::rows::KeptRows;

/// Stages below this share of the reference pivots make a step suspect.
const SUSPECT: f64 = 0.1;

/// A frame of the motions that were possible at the last accepted step, and the sign of the determinant of the kept rows
/// bordered by it; and how near to a singular configuration the stages since then came.
#[derive(Default)]
pub(super) struct Passage {
    frame: Vec<f64>,
    sign: f64,
    t: f64,
    lowest: Option<f64>,
}

impl Passage {
    /// Time of the last accepted step.
    pub(super) fn since(&self) -> f64 {
        self.t
    }

    /// Notes the pivots of a stage.
    pub(super) fn see(&mut self, rows: &KeptRows) {
        let pivot = rows.relative_pivot();
        self.lowest = Some(self.lowest.map_or(pivot, |lowest| lowest.min(pivot)));
    }

    /// Whether the determinant of freshly factored rows has another sign than at the last accepted step.
    pub(super) fn is_beyond(&self, rows: &mut KeptRows) -> bool {
        self.sign * rows.orientation(&self.frame) < 0.0
    }

    /// Whether a step that ends at freshly factored rows may have passed a singular configuration.
    pub(super) fn is_suspect(&self, rows: &mut KeptRows) -> bool {
        self.lowest.is_some_and(|lowest| lowest < SUSPECT) || self.is_beyond(rows)
    }

    /// Takes the freshly factored rows of an accepted step at time t.
    pub(super) fn take(&mut self, rows: &mut KeptRows, t: f64) {
        self.t = t;
        self.lowest = None;
        rows.null_frame(&mut self.frame);
        self.sign = rows.orientation(&self.frame);
    }
}
