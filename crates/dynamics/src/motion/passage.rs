//! Does a step pass a singular configuration? There the kept rows are dependent for an instant: branches of the motion may meet,
//! and a step may land on another one with every residual at rounding.
//!
//! What determines the accelerations there is a quotient of two numbers that both vanish: at the distance σ, a share of the reference
//! pivots, a stage off the constraints by δ is wrong by δ/σ and rounding by eps/σ². So, near a singular configuration, stages are
//! moved onto the constraints before they are evaluated, steps are chosen such that it falls between two stages
//! ([`Passage::expected`]), and rows below 1e-6 are left out of a solve. A step must not end where a projection could not tell the
//! branches apart, and one that goes over a singular configuration stands only if its correction is small beside the
//! distance of the branches: the motion goes on as smoothly as it came.

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
    /// Relative pivot there, and its rate since the step before.
    pivot: f64,
    rate: f64,
    lowest: Option<f64>,
}

impl Passage {
    /// Time of the last accepted step.
    pub(super) fn since(&self) -> f64 {
        self.t
    }

    /// When the pivots of the last two accepted steps, continued as a straight line, vanish.
    pub(super) fn expected(&self) -> Option<f64> {
        (self.rate < 0.0).then(|| self.t - self.pivot / self.rate)
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
        let pivot = rows.relative_pivot();
        self.rate = (pivot - self.pivot) / (t - self.t);
        self.pivot = pivot;
        self.t = t;
        self.lowest = None;
        rows.null_frame(&mut self.frame);
        self.sign = rows.orientation(&self.frame);
    }
}
