//! Common parts of constraints and forces as trait objects: their stored numbers.

use crate::space::{Plane, Space};

/// A definition with values for its parameters and the values stored at the start.
pub trait Definition<S: Space = Plane>: Send + Sync {
    /// Stores the values that the definition computes from the assembled start.
    fn initialise(&mut self, _x: &[S::Pose<f64>]) {}

    /// Whether requirement `k` of the definition is satisfied at the assembled start.
    fn requirement(&self, _k: usize, _x: &[S::Pose<f64>]) -> bool {
        true
    }

    /// Cosine, sine and rate (rad/s) of unwrapped angle `k` since the start. These are the angles
    /// whose revolutions the kernels receive, or the angle in space that a drive prescribes. If
    /// there is no such angle, the result is that of a constant angle.
    fn turned(&self, _k: usize, _x: &[S::Pose<f64>], _v: &[S::Twist<f64>]) -> [f64; 3] {
        [1.0, 0.0, 0.0]
    }

    /// Points at which the definition acts, each in the frame of its body: the parameters that are
    /// points, in their order. Empty if the definition has no such parameter.
    fn points(&self) -> Vec<S::Vector<f64>> {
        Vec::new()
    }

    /// Axes u, v and w of a joint in space, fixed in its first body and in the frame of this body:
    /// w is along its first axis or direction there. `None` if the joint has no axis.
    fn axes(&self) -> Option<[[f64; 3]; 3]> {
        None
    }

    /// Axes u, v and w of the bodies in the first two slots, each in the frame of its body. The
    /// rows `axis_u` and `axis_v` keep both axes w parallel, and the row `turn` also keeps u and v
    /// parallel. `None` if the joint keeps no axes parallel.
    fn parallel_axes(&self) -> Option<[[[f64; 3]; 3]; 2]> {
        None
    }

    /// Writes the numbers stored by a constraint, in the order of [`crate::ConstraintSpec::data`];
    /// forces write nothing.
    fn data(&self, _out: &mut [f64]) {}

    /// Sets the numbers that [`Definition::data`] returns, without a change: directions are not
    /// normalised. Values that [`Definition::initialise`] computes only from other stored numbers
    /// are computed again.
    fn set_data(&mut self, _numbers: &[f64]) {}
}
