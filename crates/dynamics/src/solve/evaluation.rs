//! A mechanism and the results of its kernels at one state. The kernels compute poses, constraints
//! and forces.

use model::{Mechanism, RowLabel, Scratch, System};

use crate::error::MotionFault;

/// A mechanism, and the results of its kernels at the last evaluated state.
#[derive(Clone)]
pub(crate) struct Evaluation<'m> {
    pub(crate) mechanism: &'m Mechanism,
    pub(crate) s: Scratch,
    /// Size of the mechanism, the unit of positions (m).
    pub(crate) size: f64,
}

impl<'m> Evaluation<'m> {
    pub(crate) fn new(mechanism: &'m Mechanism, size: f64) -> Self {
        let s = mechanism.scratch();
        Self { mechanism, s, size }
    }

    /// Evaluates a configuration and C.
    pub(crate) fn pose(&mut self, t: f64, q: &[f64]) {
        self.mechanism.pose(t, q, &mut self.s);
        self.mechanism.c(&mut self.s);
    }

    /// Evaluates a configuration, C and Φ.
    pub(crate) fn pose_and_phi(&mut self, t: f64, q: &[f64]) {
        self.mechanism.pose(t, q, &mut self.s);
        self.mechanism.phi(&mut self.s);
        self.mechanism.c(&mut self.s);
    }

    /// Evaluates b at the current configuration.
    pub(crate) fn b(&mut self) {
        if self.mechanism.layout().rheonomic {
            self.mechanism.b(&mut self.s);
        }
    }

    /// Evaluates Γ and Q at the current configuration.
    pub(crate) fn gamma_and_force(&mut self, v: &[f64]) {
        self.mechanism.twist(v, &mut self.s);
        self.mechanism.gamma(&mut self.s);
        self.mechanism.force(&mut self.s);
    }

    /// Returns the residual C·v − b of row i.
    pub(crate) fn velocity_residual(&self, i: usize, v: &[f64]) -> f64 {
        self.mechanism.layout().velocity_residual(&self.s, i, v)
    }

    /// Returns the residual C·v − b of row i, and the size of its terms.
    pub(crate) fn velocity_residual_and_scale(&self, i: usize, v: &[f64]) -> (f64, f64) {
        let (mut sum, mut size) = (0.0, 0.0);
        for (column, c) in self.mechanism.layout().row(&self.s, i) {
            let term = c * v[column];
            sum += term;
            size += term.abs();
        }
        let b = self.s.b[i];
        (sum - b, size + b.abs())
    }

    /// Returns the size of the terms of row i of Φ.
    pub(crate) fn position_scale(&self, i: usize) -> f64 {
        self.mechanism.scales(&self.s).position(i)
    }

    /// Returns the size of the terms of row i of C·v − b.
    pub(crate) fn velocity_scale(&self, i: usize, v: &[f64]) -> f64 {
        self.mechanism.scales(&self.s).velocity(i, v)
    }

    /// Returns the value of row i of C for a motion of the size of the mechanism.
    pub(crate) fn row_size(&self, i: usize) -> f64 {
        let row = self.mechanism.layout().row(&self.s, i);
        let space = self.mechanism.space();
        row.map(|(j, c)| c.abs() * space.unit(j, self.size)).sum()
    }

    pub(crate) fn label(&self, i: usize) -> RowLabel {
        self.mechanism.layout().labels[i].clone()
    }

    /// Replaces the fault by a fault with the name of a force that has no value, if there is such a
    /// force.
    pub(super) fn named(&mut self, fault: MotionFault) -> MotionFault {
        match fault {
            MotionFault::NotFinite { time, what } => {
                match self.mechanism.applied_forces().undefined(&mut self.s) {
                    Some(source) if source.is_of_function() => {
                        MotionFault::Function { time, source }
                    }
                    Some(force) => MotionFault::NotFinite {
                        time,
                        what: force.to_string(),
                    },
                    None => MotionFault::NotFinite { time, what },
                }
            }
            other => other,
        }
    }

    /// Returns the fault of completed coordinates that are too far from the expected coordinates.
    /// `column` of C has the largest distance.
    pub(crate) fn far_completion(&self, time: f64, (column, by): (usize, f64)) -> MotionFault {
        let (body, coordinate) = self.mechanism.coordinate(column);
        let body = body.to_owned();
        MotionFault::FarCompletion {
            time,
            body,
            coordinate,
            by,
        }
    }
}
