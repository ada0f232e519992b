//! Detects whether a step moves through a singular configuration. At a singular configuration the
//! independent rows are dependent for an instant, and branches of the motion may meet. A step may
//! then end on another branch although every residual is a rounding error.
//!
//! The accelerations at a singular configuration are quotients whose numerator and denominator both
//! vanish. Let the distance σ from the configuration be a relative pivot. A constraint violation δ
//! of a stage then causes an error δ/σ, and rounding causes an error eps/σ². Therefore stages near
//! a singular configuration are moved onto the constraint manifold before their evaluation. Steps
//! are chosen such that the configuration is between two stages ([`Passage::expected`]), and rows
//! with relative pivots below 1e-6 are left out of the solution. A step must not end so close that
//! a projection could not distinguish the branches. A step over a singular configuration is
//! accepted only if its correction is small relative to the distance of the branches. Thus the run
//! continues on the smooth branch.

use crate::guards::GUARDED;
use crate::limits::{KINK, SUSPECT};
use crate::solve::KeptRows;

/// An evaluated state.
#[derive(Clone, Copy)]
pub(crate) struct Now<'a> {
    pub(crate) t: f64,
    pub(crate) q: &'a [f64],
    pub(crate) v: &'a [f64],
    pub(crate) a: &'a [f64],
}

/// Data of the last accepted step: a basis of the possible motions, and the sign of the determinant
/// of the independent rows bordered by this basis. The data also contain the smallest pivot of the
/// stages since this step.
#[derive(Default)]
pub(crate) struct Passage {
    frame: Vec<f64>,
    sign: f64,
    t: f64,
    /// Relative pivot at this step, and its rate since the previous step.
    pivot: f64,
    rate: f64,
    lowest: Option<f64>,
    /// The last accepted state whose pivots were not small.
    entry: Option<Entry>,
}

/// Time, velocities and accelerations of a state.
struct Entry {
    t: f64,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Passage {
    /// Returns the time of the last accepted step.
    pub(crate) fn since(&self) -> f64 {
        self.t
    }

    /// Returns the relative pivot at the last accepted step.
    pub(super) fn pivot(&self) -> f64 {
        self.pivot
    }

    /// Returns the time at which the pivots vanish if the pivots of the last two accepted steps are
    /// extrapolated linearly.
    pub(super) fn expected(&self) -> Option<f64> {
        (self.rate < 0.0).then(|| self.t - self.pivot / self.rate)
    }

    /// Records the pivots of a stage.
    pub(crate) fn see(&mut self, rows: &KeptRows) {
        if !GUARDED {
            return;
        }
        let pivot = rows.relative_pivot();
        self.lowest = Some(self.lowest.map_or(pivot, |lowest| lowest.min(pivot)));
    }

    /// Returns whether the determinant of freshly factored rows has changed its sign since the last
    /// accepted step.
    pub(super) fn is_beyond(&self, rows: &mut KeptRows) -> bool {
        self.sign * rows.orientation(&self.frame) < 0.0
    }

    /// Returns whether velocities v at time t, with accelerations a and the weights `mass`,
    /// continue the velocities before the singular configuration. On another branch the velocities
    /// have another direction. The function is called when the rows have good pivots again.
    pub(super) fn is_continued_by(&self, Now { t, v, a, .. }: Now<'_>, mass: &[f64]) -> bool {
        let Some(entry) = &self.entry else {
            return true;
        };
        let dt = t - entry.t;
        let norm = |x: &mut dyn Iterator<Item = f64>| -> f64 {
            x.zip(mass).map(|(x, m)| m * x * x).sum::<f64>().sqrt()
        };
        let kink =
            norm(&mut (0..v.len()).map(|i| v[i] - entry.v[i] - 0.5 * dt * (a[i] + entry.a[i])));
        let change = norm(&mut (0..v.len()).map(|i| 0.5 * dt * (a[i].abs() + entry.a[i].abs())));
        let speed = norm(&mut v.iter().copied()).max(norm(&mut entry.v.iter().copied()));
        kink <= KINK * (speed + change)
    }

    /// Stores an accepted state as the last state before pivots become small.
    pub(super) fn enter(&mut self, Now { t, v, a, .. }: Now<'_>) {
        let entry = self.entry.get_or_insert_with(|| Entry {
            t,
            v: v.to_vec(),
            a: a.to_vec(),
        });
        entry.t = t;
        entry.v.copy_from_slice(v);
        entry.a.copy_from_slice(a);
    }

    /// Deletes the stored state, because velocities jump for another reason.
    pub(crate) fn forget_entry(&mut self) {
        self.entry = None;
    }

    /// Returns whether a step that ends at freshly factored rows may have moved through a singular
    /// configuration.
    pub(super) fn is_suspect(&self, rows: &mut KeptRows) -> bool {
        self.lowest.is_some_and(|lowest| lowest < SUSPECT) || self.is_beyond(rows)
    }

    /// Stores the freshly factored rows of an accepted step at time t.
    pub(crate) fn take(&mut self, rows: &mut KeptRows, t: f64) {
        if !GUARDED {
            self.t = t;
            return;
        }
        let pivot = rows.relative_pivot();
        self.rate = (pivot - self.pivot) / (t - self.t);
        self.pivot = pivot;
        self.t = t;
        self.lowest = None;
        rows.null_frame(&mut self.frame);
        self.sign = rows.orientation(&self.frame);
    }
}
