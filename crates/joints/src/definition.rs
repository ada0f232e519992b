//! Common parts of constraints and forces as trait objects: the numbers that they store.

use crate::space::{Plane, Space};

/// A definition with values for its parameters and the values stored at the start.
pub trait Definition<S: Space = Plane>: Send + Sync {
    /// Stores the values that the definition takes from the assembled start.
    fn initialise(&mut self, _x: &[S::Pose<f64>]) {}

    /// Whether requirement `k` of the definition holds at the assembled start.
    fn requirement(&self, _k: usize, _x: &[S::Pose<f64>]) -> bool {
        true
    }

    /// Cosine, sine and rate (rad/s) of counted angle `k` since the start: of the angles that
    /// kernels are given with their turns, or of the angle in space that a drive prescribes. Those
    /// of an angle that stays if there is none of this number.
    fn turned(&self, _k: usize, _x: &[S::Pose<f64>], _v: &[S::Twist<f64>]) -> [f64; 3] {
        [1.0, 0.0, 0.0]
    }

    /// Points at which the definition acts, each in the frame of its body: the parameters that are
    /// points, in their order. Empty if a definition has none.
    fn points(&self) -> Vec<S::Vector<f64>> {
        Vec::new()
    }

    /// Axes u, v and w of a joint in space, fixed in its first body and in the frame of it: w along
    /// its first axis or direction there. `None` if it has none.
    fn axes(&self) -> Option<[[f64; 3]; 3]> {
        None
    }

    /// Axes u, v and w of the bodies in its first two slots, each in the frame of its body, whose w
    /// its rows `axis_u` and `axis_v` keep parallel, and with `turn` u and v as well. `None` if it
    /// keeps none.
    fn parallel_axes(&self) -> Option<[[[f64; 3]; 3]; 2]> {
        None
    }

    /// Writes the numbers stored by a constraint, in the order of [`crate::ConstraintSpec::data`];
    /// nothing for forces.
    fn data(&self, _out: &mut [f64]) {}

    /// Sets the numbers that [`Definition::data`] returns, unchanged: directions are not
    /// normalised. Values that [`Definition::initialise`] computed from other numbers alone are
    /// computed again.
    fn set_data(&mut self, _numbers: &[f64]) {}
}
