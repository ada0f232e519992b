//! One joint coordinate of a coupling. A side consists of the kernels of its drive, and of the
//! indices that relate the drive to the coupling.

use joints::Ring;

use super::facts::CouplingFacts;
use crate::element::{
    BodySpace, ConstraintKernels, DriveScalar, Kinematics, PoseOf, RowsAt, TwistOf, stored,
};

/// Number of velocity components of two bodies in space.
pub(super) const MOST: usize = 12;

/// One joint coordinate.
pub(super) struct Side<S: BodySpace> {
    pub(super) drive: Box<dyn ConstraintKernels<S>>,
    /// Indices of the two bodies in the list of bodies of the coupling.
    pub(super) slots: [usize; 2],
    /// Range of the data of the drive in the data of the coupling.
    pub(super) data: std::ops::Range<usize>,
    /// Index in `f` of the values of the unwrapped angle, if the coordinate has one.
    turn: Option<usize>,
    /// For each entry of the row of the drive, the index of the entry in the row of the coupling.
    pub(super) entries: Vec<usize>,
    /// Range of the values for the operation lists of the drive. The range refers to the values for
    /// the operation lists of the coupling.
    pub(super) stored: std::ops::Range<usize>,
}

impl<S: BodySpace> Clone for Side<S> {
    fn clone(&self) -> Self {
        Self {
            drive: self.drive.clone(),
            slots: self.slots,
            data: self.data.clone(),
            turn: self.turn,
            entries: self.entries.clone(),
            stored: self.stored.clone(),
        }
    }
}

/// The joint coordinate evaluated at a pose.
pub(super) struct At<T> {
    /// The joint coordinate since the start.
    pub(super) measure: T,
    /// The row of the drive. The value of the row is the joint coordinate, or the remaining angle
    /// without the known part.
    left: T,
    /// Gradient of the joint coordinate. The gradient has the entries of the row of the drive.
    pub(super) gradient: [T; MOST],
    /// Values passed to the drive instead of a motion.
    pub(super) f: [[T; 3]; 2],
}

impl<S: Kinematics> Side<S> {
    /// Creates a side. `turn` is the number of unwrapped angles that come before the angle of this
    /// side.
    pub(super) fn new(
        drive: Box<dyn ConstraintKernels<S>>,
        slots: [usize; 2],
        [first_datum, first_stored]: [usize; 2],
        turn: usize,
        facts: &CouplingFacts,
    ) -> Self {
        let spec = drive.spec();
        let entry = |e: &joints::spec::Entry| facts.entry(slots[e.slot], e.dof);
        let of_programs: Vec<f64> = stored(drive.as_ref());
        Self {
            slots,
            data: first_datum..first_datum + spec.n_data(),
            turn: spec.turning.then_some(3 * turn),
            entries: spec.c.iter().map(entry).collect(),
            stored: first_stored..first_stored + of_programs.len(),
            drive,
        }
    }

    /// Selects the values of the two bodies from the values of all bodies.
    pub(super) fn own<P: Copy>(&self, all: &[P]) -> [P; 2] {
        self.slots.map(|slot| all[slot])
    }

    /// Returns the joint coordinate and its gradient at poses of the two bodies.
    pub(super) fn at<T: DriveScalar>(&self, x: &[PoseOf<S, T>; 2], f: &[[T; 3]]) -> At<T> {
        let zero = T::from(0.0);
        let mut known = zero;
        let mut own = [[zero; 3]; 2];
        if let Some([angle, cos, sin, ..]) = self.turn.and_then(|first| f.get(first..)) {
            known = angle[0];
            own = [[cos[0], zero, zero], [sin[0], zero, zero]];
        }
        self.with_rows((x, &own), |rows| {
            let mut left = [zero];
            T::phi(rows, &mut left);
            let mut gradient = [zero; MOST];
            T::c(rows, &mut gradient[..self.entries.len()]);
            At {
                measure: known + left[0],
                left: left[0],
                gradient,
                f: own,
            }
        })
    }

    fn with_rows<T: DriveScalar, R>(
        &self,
        (x, f): (&[PoseOf<S, T>; 2], &[[T; 3]; 2]),
        ask: impl FnOnce(&RowsAt<'_, S, T>) -> R,
    ) -> R {
        let kernels = self.drive.as_ref();
        let first = self.stored.start;
        let stored = T::stored_by(kernels, |value, place| T::stored(value, first + place));
        ask(&RowsAt {
            kernels,
            stored: &stored,
            x,
            f,
        })
    }

    /// Returns the gradient times the velocities or accelerations of the two bodies.
    pub(super) fn times<T: Ring>(&self, gradient: &[T], v: &[TwistOf<S, T>; 2]) -> T {
        let spec = self.drive.spec();
        let entries = spec.c.iter().zip(gradient);
        entries.fold(T::from(0.0), |sum, (entry, &g)| {
            let velocity = S::velocities(&v[entry.slot]).nth(entry.dof);
            sum + g * velocity.unwrap_or(T::from(0.0))
        })
    }

    /// Computes Γ of the joint coordinate. The row of an unwrapped angle is sin ε, where ε is the
    /// difference between the angle and its known part. The Γ of this row contains the term
    /// ε·rate². The Γ of the angle does not contain this term.
    pub(super) fn gamma<T: DriveScalar>(
        &self,
        at: &At<T>,
        x: &[PoseOf<S, T>; 2],
        v: &[TwistOf<S, T>; 2],
    ) -> T {
        let mut gamma = [T::from(0.0)];
        self.with_rows((x, &at.f), |rows| T::gamma(rows, v, &mut gamma));
        match self.turn {
            Some(_) => {
                let rate = self.times(&at.gradient, v);
                gamma[0] - at.left * rate * rate
            }
            None => gamma[0],
        }
    }
}
