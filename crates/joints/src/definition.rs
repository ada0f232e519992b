//! The common interface of constraints and forces as trait objects: the values that they store.

use crate::space::{Plane, Space};

/// A definition with values of its parameters and with stored initial values.
pub trait Definition<S: Space = Plane>: Send + Sync {
    /// Stores the values that the definition computes from the assembled initial configuration.
    fn initialise(&mut self, _x: &[S::Pose<f64>]) {}

    /// Returns whether requirement `k` of the definition is satisfied at the assembled initial
    /// configuration.
    fn requirement(&self, _k: usize, _x: &[S::Pose<f64>]) -> bool {
        true
    }

    /// Returns the cosine, the sine and the rate (rad/s) of the change of angle `k` since the
    /// start. Angle `k` is an angle whose revolutions the kernels need, or the angle in space that
    /// a drive prescribes. If there is no such angle, the function returns the result for a
    /// constant angle of zero.
    fn turned(&self, _k: usize, _x: &[S::Pose<f64>], _v: &[S::Twist<f64>]) -> [f64; 3] {
        [1.0, 0.0, 0.0]
    }

    /// Returns the points at which the definition acts, each in the frame of its body. The list
    /// contains the parameters that are points, in the order of the parameters. The list is empty
    /// if no parameter is a point.
    fn points(&self) -> Vec<S::Vector<f64>> {
        Vec::new()
    }

    /// Returns the axes u, v and w of a joint in space. The axes are fixed in the first body of the
    /// joint and given in the frame of this body. w is along the first axis or direction in this
    /// body. Returns `None` if the joint has no axis.
    fn axes(&self) -> Option<[[f64; 3]; 3]> {
        None
    }

    /// Returns axes u, v and w of each of the first two bodies, in the frame of the body. The rows
    /// `axis_u` and `axis_v` keep the axes w parallel, and the row `turn` also keeps u and v
    /// parallel. Returns `None` if the joint does not keep axes parallel.
    fn parallel_axes(&self) -> Option<[[[f64; 3]; 3]; 2]> {
        None
    }

    /// Writes the values that a constraint stores, in the order of [`crate::ConstraintSpec::data`].
    /// Forces write nothing.
    fn data(&self, _out: &mut [f64]) {}

    /// Sets the values that [`Definition::data`] returns. Directions are not normalised. Values
    /// that [`Definition::initialise`] computes only from other stored values are computed again.
    fn set_data(&mut self, _numbers: &[f64]) {}
}
