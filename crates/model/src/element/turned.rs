//! Forces on bodies with products of inertia. The coordinates of these bodies refer to principal
//! axes ([`crate::principal`]). However, the components of a force may be given in the axes of the
//! body frames. Therefore the force is evaluated with the body frames, and its torques and
//! derivatives are then rotated to the principal axes.

use joints::space3::{N_DOF, Pose, Twist};
use joints::{RecordedNumber, Ring, Space3};

use super::ForceKernels;
use crate::principal::Principal;

/// Largest number of bodies of a force for which no memory is allocated. No force of the library
/// has more than two bodies.
const FEW: usize = 2;

/// The principal axes of the bodies of a force, if they differ from the axes of the body frames.
#[derive(Clone)]
pub(crate) struct TurnedSlots {
    principal: Vec<Option<Principal>>,
    /// All pairs of columns, row by row. These pairs are the pattern of the derivatives.
    pairs: Vec<[usize; 2]>,
}

impl TurnedSlots {
    /// Creates the rotations, or returns `None` if the axes of all body frames are principal axes.
    pub(crate) fn new(principal: Vec<Option<Principal>>) -> Option<Self> {
        principal.iter().flatten().next()?;
        let n = N_DOF * principal.len();
        let pairs = (0..n).flat_map(|row| (0..n).map(move |column| [row, column]));
        let pairs = pairs.collect();
        Some(Self { principal, pairs })
    }

    /// Returns the columns of Q, which are all columns of the block.
    pub(super) fn columns(&self) -> std::ops::Range<usize> {
        0..self.n()
    }

    /// Returns the pattern of the derivatives of Q.
    pub(super) fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }

    fn n(&self) -> usize {
        N_DOF * self.principal.len()
    }

    /// Returns the bodies whose frames are rotated. For each body, it also returns the index of the
    /// first rotation of the body in the block.
    fn turned(&self) -> impl Iterator<Item = (usize, &Principal)> {
        let slots = self.principal.iter().enumerate();
        slots.filter_map(|(slot, of)| Some((N_DOF * slot + 3, of.as_ref()?)))
    }

    /// Transforms a point from the body frame to the axes of the coordinates of the body.
    pub(super) fn own_point(&self, slot: usize, point: [f64; 3]) -> [f64; 3] {
        let principal = self.principal.get(slot).and_then(Option::as_ref);
        principal.map_or(point, |of| of.own(point))
    }

    /// Transforms poses of the principal axes to poses of the body frames.
    pub(super) fn poses<T: Ring>(&self, x: &mut [Pose<T>]) {
        for (pose, of) in x.iter_mut().zip(&self.principal) {
            if let Some(of) = of {
                pose.rot = pose.rot.map(|row| of.to_frame(row));
            }
        }
    }

    /// Transforms twists from the principal axes to the body frames.
    fn twists<T: Ring>(&self, v: &mut [Twist<T>]) {
        for (twist, of) in v.iter_mut().zip(&self.principal) {
            if let Some(of) = of {
                twist.omega = of.to_frame(twist.omega);
            }
        }
    }

    /// Writes the values of a force for the columns of a pattern to a list for all columns.
    fn write<T: Ring>(&self, pattern: &[usize], values: &[T], out: &mut [T]) {
        out.fill(T::from(0.0));
        for (&column, value) in pattern.iter().zip(values) {
            out[column] = *value;
        }
        for (first, of) in self.turned() {
            let torque = &mut out[first..first + 3];
            let own = of.own([torque[0], torque[1], torque[2]]);
            torque.copy_from_slice(&own);
        }
    }

    /// Calls `kernel` with the poses and twists of the body frames.
    pub(super) fn with_frames<R>(
        &self,
        (x, v): (&[Pose], &[Twist]),
        kernel: impl FnOnce(&[Pose], &[Twist]) -> R,
    ) -> R {
        let (mut few, mut many) = ([Pose::GROUND; FEW], Vec::new());
        let poses = lent(&mut few, &mut many, x.len());
        poses.copy_from_slice(x);
        self.poses(poses);
        let (mut few, mut many) = ([Twist::zero(); FEW], Vec::new());
        let twists = lent(&mut few, &mut many, v.len());
        twists.copy_from_slice(v);
        self.twists(twists);
        kernel(poses, twists)
    }

    /// Computes Q of a force for all columns.
    pub(super) fn q(
        &self,
        kernels: &dyn ForceKernels<Space3>,
        at: (&[Pose], &[Twist]),
        f: &[[f64; 3]],
        out: &mut [f64],
    ) {
        let pattern = kernels.spec().q;
        let (mut few, mut many) = ([0.0; FEW * N_DOF], Vec::new());
        let values = lent(&mut few, &mut many, pattern.len());
        self.with_frames(at, |x, v| kernels.q(x, v, f, values));
        self.write(pattern, values, out);
    }

    /// Computes Q of a force for all columns with recording numbers.
    pub(super) fn recorded_q(
        &self,
        kernels: &dyn ForceKernels<Space3>,
        (mut x, mut v): (Vec<Pose<RecordedNumber>>, Vec<Twist<RecordedNumber>>),
        f: &[[RecordedNumber; 3]],
        out: &mut [RecordedNumber],
    ) {
        let pattern = kernels.spec().q;
        let mut values = vec![RecordedNumber::from(0.0); pattern.len()];
        self.poses(&mut x);
        self.twists(&mut v);
        kernels.recorded_q(&x, &v, f, &mut values);
        self.write(pattern, &values, out);
    }

    /// Computes a derivative of Q for all pairs of columns. `pattern` is the pattern of the
    /// derivative from the kernels.
    pub(super) fn derivative(
        &self,
        pattern: &[[usize; 2]],
        at: (&[Pose], &[Twist]),
        kernel: impl FnOnce(&[Pose], &[Twist], &mut [f64]),
        out: &mut [f64],
    ) {
        let (mut few, mut many) = ([0.0; FEW * FEW * N_DOF * N_DOF], Vec::new());
        let values = lent(&mut few, &mut many, pattern.len());
        self.with_frames(at, |x, v| kernel(x, v, values));
        out.fill(0.0);
        let n = self.n();
        for (&[row, column], value) in pattern.iter().zip(&*values) {
            out[n * row + column] = *value;
        }
        for (first, of) in self.turned() {
            let mut turn = |at: [usize; 3]| {
                let own = of.own(at.map(|k| out[k]));
                at.into_iter().zip(own).for_each(|(k, own)| out[k] = own);
            };
            for k in 0..n {
                turn([0, 1, 2].map(|axis| n * (first + axis) + k));
            }
            for k in 0..n {
                turn([0, 1, 2].map(|axis| n * k + first + axis));
            }
        }
    }
}

/// Returns `n` values of the array `few` if the array is large enough, and otherwise `n` values of
/// a vector.
pub(super) fn lent<'a, T: Copy, const N: usize>(
    few: &'a mut [T; N],
    many: &'a mut Vec<T>,
    n: usize,
) -> &'a mut [T] {
    if n > N {
        many.resize(n, few[0]);
        return many;
    }
    &mut few[..n]
}
