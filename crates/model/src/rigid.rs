//! Rigid motions of the whole mechanism: which constraints act among bodies only, and which against
//! the ground.

use std::ops::Range;

use crate::mechanism::{Mechanism, N_BODY};
use crate::reaction::ConstraintId;
use crate::system::{Layout, Scratch, System};

/// A row counts as vanishing on rigid motions below this share of its terms: rounding of points
/// that a joint makes one, far from the origin. Rows above it are taken to act against the ground,
/// which is the careful reading.
const ROUNDING: f64 = 1e-10;

impl Layout {
    /// Columns of C of a body.
    #[must_use]
    pub fn columns(&self, body: usize) -> Range<usize> {
        N_BODY * body..N_BODY * (body + 1)
    }
}

impl Mechanism {
    /// Whether a joint or drive acts against the ground: one of its rows does not vanish when all
    /// bodies move as one rigid body. The list of its bodies does not tell: an absolute velocity
    /// refers to the ground without naming it. `s.entries` must hold C.
    #[must_use]
    pub fn acts_on_ground(&self, id: ConstraintId, s: &Scratch) -> bool {
        let [x, y] = self.place(id, s);
        // Two translations and the rotation about the place of the joint.
        let motions = |column: usize| {
            let pose = &s.poses[column / N_BODY];
            [
                [1.0, 0.0, y - pose.y],
                [0.0, 1.0, pose.x - x],
                [0.0, 0.0, 1.0],
            ][column % N_BODY]
        };
        self.layout().groups[id.0].rows.clone().any(|row| {
            let mut sums = [0.0; N_BODY];
            let mut sizes = [0.0_f64; N_BODY];
            for (column, c) in self.layout().row(s, row) {
                for (k, motion) in motions(column).into_iter().enumerate() {
                    sums[k] += c * motion;
                    sizes[k] += (c * motion).abs();
                }
            }
            (0..N_BODY).any(|k| sums[k].abs() > ROUNDING * sizes[k])
        })
    }
}
