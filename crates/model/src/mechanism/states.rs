//! States of force laws, for example the integral of a control error. The configuration has one
//! coordinate for each state, after the unwrapped angles. The rate of this coordinate is not a
//! linear function of the velocities: it follows from the law. Constraints do not contain states.

use super::Mechanism;
use super::elements::Elements;
use crate::system::{Scratch, System};

impl Elements {
    /// Returns the name of the drive to which state `k` belongs.
    pub(super) fn state_name(&self, mut k: usize) -> Option<&str> {
        for own in &self.states {
            if k < own.n {
                return Some(&self.forces[own.force].name);
            }
            k -= own.n;
        }
        None
    }

    /// Returns the indices of the states of some forces, which are in ascending order.
    pub(super) fn states_of(&self, forces: &[usize]) -> Vec<usize> {
        let owners = self.states.iter();
        let owners = owners.flat_map(|own| std::iter::repeat_n(own.force, own.n));
        let there = owners.enumerate();
        let there = there.filter(|(_, force)| forces.binary_search(force).is_ok());
        there.map(|(k, _)| k).collect()
    }
}

impl Mechanism {
    /// Passes states to the kernels.
    #[inline]
    pub(super) fn take_states(&self, mut states: &[f64], s: &mut Scratch) {
        for own in &self.elements.states {
            let (these, others) = states.split_at(own.n);
            for (jet, &x) in s.slots.jets[own.first..].iter_mut().zip(these) {
                *jet = [x, 0.0, 0.0];
            }
            states = others;
        }
    }

    /// Computes the rates of the states of force laws at the configuration and the velocities in
    /// the work space. The rates are the last [`Layout::states`] entries of q̇.
    ///
    /// # Panics
    /// Panics if q̇ has the wrong length.
    ///
    /// [`Layout::states`]: crate::Layout::states
    pub fn state_rates(&self, s: &Scratch, qd: &mut [f64]) {
        let mut rates = &mut qd[self.layout.n_q - self.layout.states..];
        for own in &self.elements.states {
            let (these, others) = rates.split_at_mut(own.n);
            self.elements.forces[own.force].state_rates(&s.slots, these);
            rates = others;
        }
    }

    /// Sets the states of force laws at the start: integrals are zero, and a lag has the value of
    /// its input.
    ///
    /// # Panics
    /// Panics if q or v has the wrong length.
    pub fn start_states(&self, q: &mut [f64], v: &[f64]) {
        let layout = &self.layout;
        if layout.states == 0 {
            return;
        }
        let mut s = self.scratch();
        self.pose(layout.start_time, q, &mut s);
        self.twist(v, &mut s);
        let mut states = &mut q[layout.n_q - layout.states..];
        for own in &self.elements.states {
            let (these, others) = states.split_at_mut(own.n);
            self.elements.forces[own.force].first_states(&s.slots, these);
            states = others;
        }
    }
}
