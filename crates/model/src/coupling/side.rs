//! One measure of a coupling: the kernels of its drive, and where they are in those of the
//! coupling.

use joints::{Element, Magnitude, Positions, Recorded, Ring};
use linalg::Dd;

use super::facts::Facts;
use crate::element::{BodySpace, ConstraintKernels, Kinematics, PoseOf, TwistOf};

/// Velocities of two bodies.
pub(super) const MOST: usize = 12;

/// A number type in which constraints have rows at poses.
pub(super) trait Numbers: Ring {
    /// The rows of a constraint in it.
    fn of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Positions<Self, S>;
}

/// A number type in which constraints have all kernels of their equations.
pub(super) trait KernelNumbers: Numbers {
    /// The kernels of a constraint in it.
    fn all_of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Element<Self, S>;
}

impl Numbers for f64 {
    fn of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Positions<Self, S> {
        kernels
    }
}

impl KernelNumbers for f64 {
    fn all_of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Element<Self, S> {
        kernels
    }
}

impl Numbers for Dd {
    fn of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Positions<Self, S> {
        kernels.extended()
    }
}

impl Numbers for Magnitude {
    fn of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Positions<Self, S> {
        kernels.magnitude()
    }
}

impl Numbers for Recorded {
    fn of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Positions<Self, S> {
        kernels.recorded()
    }
}

impl KernelNumbers for Recorded {
    fn all_of<S: BodySpace>(kernels: &dyn ConstraintKernels<S>) -> &dyn Element<Self, S> {
        kernels.recorded()
    }
}

/// One measure.
pub(super) struct Side<S: BodySpace> {
    pub(super) drive: Box<dyn ConstraintKernels<S>>,
    /// Slots of the coupling of its two bodies.
    pub(super) slots: [usize; 2],
    /// Its data among those of the coupling.
    pub(super) data: std::ops::Range<usize>,
    /// Index in `f` of what is given of its angle, if it counts turns.
    turn: Option<usize>,
    /// For each entry of its row, the entry of the coupling's.
    pub(super) entries: Vec<usize>,
    /// Entries of its row that depend on parameters only, zero elsewhere.
    constant: [f64; MOST],
}

impl<S: BodySpace> Clone for Side<S> {
    fn clone(&self) -> Self {
        Self {
            drive: self.drive.clone(),
            slots: self.slots,
            data: self.data.clone(),
            turn: self.turn,
            entries: self.entries.clone(),
            constant: self.constant,
        }
    }
}

/// What a side is at a pose.
pub(super) struct At<T> {
    /// The measure since the start.
    pub(super) measure: T,
    /// Its gradient: the entries of the row of its drive.
    pub(super) gradient: [T; MOST],
    /// What its drive is given in place of a motion.
    pub(super) f: [[T; 3]; 2],
}

impl<S: Kinematics> Side<S> {
    /// `turn` angles come before in what is given of angles that count turns.
    pub(super) fn new(
        drive: Box<dyn ConstraintKernels<S>>,
        slots: [usize; 2],
        first_datum: usize,
        turn: usize,
        facts: &Facts,
    ) -> Self {
        let spec = drive.spec();
        let entry = |e: &joints::spec::Entry| facts.entry(slots[e.slot], e.dof);
        let mut side = Self {
            slots,
            data: first_datum..first_datum + spec.n_data(),
            turn: spec.turning.then_some(3 * turn),
            entries: spec.c.iter().map(entry).collect(),
            constant: [0.0; MOST],
            drive,
        };
        side.take_constants();
        side
    }

    /// Whether its measure is an angle that is given with its turns.
    pub(super) fn counts_turns(&self) -> bool {
        self.turn.is_some()
    }

    /// Takes the constant entries from the parameters.
    pub(super) fn take_constants(&mut self) {
        self.constant = [0.0; MOST];
        let n = self.drive.spec().c.len();
        self.drive.c_constant(&mut self.constant[..n]);
    }

    /// Its two among the values of all slots.
    pub(super) fn own<P: Copy>(&self, all: &[P]) -> [P; 2] {
        self.slots.map(|slot| all[slot])
    }

    /// The measure and its gradient at poses of its bodies.
    pub(super) fn at<T: Numbers>(&self, x: &[PoseOf<S, T>; 2], f: &[[T; 3]]) -> At<T> {
        let zero = T::from(0.0);
        let mut known = zero;
        let mut own = [[zero; 3]; 2];
        if let Some([angle, cos, sin, ..]) = self.turn.and_then(|first| f.get(first..)) {
            known = angle[0];
            own = [[cos[0], zero, zero], [sin[0], zero, zero]];
        }
        let kernels = T::of(self.drive.as_ref());
        let mut left = [zero];
        kernels.phi(x, &own, &mut left);
        let mut gradient = self.constant.map(T::from);
        kernels.c(x, &own, &mut gradient[..self.entries.len()]);
        At {
            measure: known + left[0],
            gradient,
            f: own,
        }
    }

    /// The gradient times velocities or accelerations of its bodies.
    pub(super) fn times<T: Ring>(&self, gradient: &[T], v: &[TwistOf<S, T>; 2]) -> T {
        let spec = self.drive.spec();
        let entries = spec.c.iter().zip(gradient);
        entries.fold(T::from(0.0), |sum, (entry, &g)| {
            let velocity = S::velocities(&v[entry.slot]).nth(entry.dof);
            sum + g * velocity.unwrap_or(T::from(0.0))
        })
    }

    /// Γ of the row of its drive.
    pub(super) fn gamma<T: KernelNumbers>(
        &self,
        x: &[PoseOf<S, T>; 2],
        v: &[TwistOf<S, T>; 2],
        f: &[[T; 3]; 2],
    ) -> T {
        let mut gamma = [T::from(0.0)];
        T::all_of(self.drive.as_ref()).gamma(x, v, f, &mut gamma);
        gamma[0]
    }
}
