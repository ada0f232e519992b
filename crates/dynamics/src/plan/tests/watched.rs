//! A constraint that counts the calls of each of its kernels and records the sines passed to them.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use joints::spec::ConstraintSpec;
use joints::{ConstraintKernels, Definition, Element, Pose, Programs, Reaction, Twist};
use model::Joint;

/// Calls of kernels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Calls {
    pub(super) phi: usize,
    pub(super) c: usize,
    pub(super) b: usize,
    pub(super) gamma: usize,
    pub(super) wrench: usize,
    pub(super) derivatives: usize,
    /// Bit patterns of all sines that were passed for the last body of the constraint.
    pub(super) sines: BTreeSet<u64>,
}

/// Shared record of the calls.
pub(super) type Notes = Arc<Mutex<Calls>>;

/// A constraint with its record.
#[derive(Clone)]
struct Watched {
    inner: Box<dyn ConstraintKernels>,
    notes: Notes,
}

/// Replaces a joint by a constraint that records its calls.
pub(super) fn watch(joint: &mut Joint) -> Notes {
    let notes = Notes::default();
    joint.element = Box::new(Watched {
        inner: joint.element.clone(),
        notes: Arc::clone(&notes),
    });
    notes
}

/// Returns the record and resets it.
pub(super) fn take(notes: &Notes) -> Calls {
    std::mem::take(&mut notes.lock().expect("nobody panicked"))
}

impl Watched {
    fn note(&self, x: &[Pose], kernel: impl FnOnce(&mut Calls) -> &mut usize) {
        let mut calls = self.notes.lock().expect("nobody panicked");
        *kernel(&mut calls) += 1;
        calls.sines.extend(x.last().map(|pose| pose.sin.to_bits()));
    }
}

impl Definition for Watched {
    fn initialise(&mut self, x: &[Pose]) {
        self.inner.initialise(x);
    }
    fn requirement(&self, k: usize, x: &[Pose]) -> bool {
        self.inner.requirement(k, x)
    }
    fn points(&self) -> Vec<[f64; 2]> {
        self.inner.points()
    }
    fn data(&self, out: &mut [f64]) {
        self.inner.data(out);
    }
    fn set_data(&mut self, numbers: &[f64]) {
        self.inner.set_data(numbers);
    }
}

impl Element for Watched {
    fn spec(&self) -> &'static ConstraintSpec {
        self.inner.spec()
    }
    fn phi(&self, x: &[Pose], f: &[[f64; 3]], out: &mut [f64]) {
        self.note(x, |calls| &mut calls.phi);
        self.inner.phi(x, f, out);
    }
    fn c_constant(&self, out: &mut [f64]) {
        self.inner.c_constant(out);
    }
    fn c(&self, x: &[Pose], f: &[[f64; 3]], out: &mut [f64]) {
        self.note(x, |calls| &mut calls.c);
        self.inner.c(x, f, out);
    }
    fn b(&self, x: &[Pose], f: &[[f64; 3]], out: &mut [f64]) {
        self.note(x, |calls| &mut calls.b);
        self.inner.b(x, f, out);
    }
    fn gamma(&self, x: &[Pose], v: &[Twist], f: &[[f64; 3]], out: &mut [f64]) {
        self.note(x, |calls| &mut calls.gamma);
        self.inner.gamma(x, v, f, out);
    }
    fn component(&self, x: &[Pose], f: &[[f64; 3]], out: &mut [f64]) {
        self.inner.component(x, f, out);
    }
}

impl Reaction for Watched {
    fn wrench(&self, x: &[Pose], f: &[[f64; 3]], out: &mut [f64]) {
        self.note(x, |calls| &mut calls.wrench);
        self.inner.wrench(x, f, out);
    }
    fn place(&self, x: &[Pose]) -> [f64; 2] {
        self.inner.place(x)
    }
}

impl ConstraintKernels for Watched {
    fn programs(&self) -> &Programs {
        self.inner.programs()
    }
    fn stored(&self, out: &mut Vec<f64>) {
        self.inner.stored(out);
    }
    fn d_stored_dp(&self, entry: &mut dyn FnMut(usize, usize, f64)) {
        self.inner.d_stored_dp(entry);
    }
    fn d_force_dx(&self, x: &[Pose], f: &[[f64; 3]], lambda: &[f64], out: &mut [f64]) {
        self.note(x, |calls| &mut calls.derivatives);
        self.inner.d_force_dx(x, f, lambda, out);
    }
    fn d_residual_dx(&self, x: &[Pose], v: &[Twist], a: &[Twist], f: &[[f64; 3]], out: &mut [f64]) {
        self.inner.d_residual_dx(x, v, a, f, out);
    }
    fn d_gamma_dv(&self, x: &[Pose], v: &[Twist], f: &[[f64; 3]], out: &mut [f64]) {
        self.inner.d_gamma_dv(x, v, f, out);
    }
    fn d_velocity_dx(&self, x: &[Pose], v: &[Twist], f: &[[f64; 3]], out: &mut [f64]) {
        self.inner.d_velocity_dx(x, v, f, out);
    }
    fn boxed(&self) -> Box<dyn ConstraintKernels> {
        Box::new(self.clone())
    }
}
