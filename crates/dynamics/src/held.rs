//! States at rest with locked functions of time. A drive that would start to move at this time
//! counts as locked.

use model::{Mechanism, System};

use crate::limits::RESTING_RATE;
use crate::prepare::PreparedMechanism;

impl PreparedMechanism {
    /// Returns the same mechanism with functions of time that keep their values at t, for a state
    /// at rest; see [`Mechanism::held_at`].
    #[must_use]
    pub fn held_at(&self, t: f64) -> Self {
        Self {
            mechanism: self.mechanism.held_at(t),
            // Generated code contains the functions of time that are not locked.
            code: None,
            ..self.clone()
        }
    }
}

/// Returns whether velocities are rounding errors for a mechanism of this size (m).
pub(crate) fn rests(mechanism: &Mechanism, size: f64, v: &[f64]) -> bool {
    let unit = |j: usize| mechanism.space().unit(j, size);
    let mut each = v.iter().enumerate();
    each.all(|(j, v)| v.abs() <= RESTING_RATE * unit(j))
}

/// Returns the names of drives and joints whose functions of time prescribe an acceleration at rest
/// at the coordinates q. Rounding errors for a mechanism of this size (m) do not count.
pub(crate) fn accelerated(mechanism: &Mechanism, size: f64, t: f64, q: &[f64]) -> Vec<String> {
    let layout = mechanism.layout();
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.twist(&vec![0.0; layout.n_v], &mut s);
    mechanism.gamma(&mut s);
    let mut names: Vec<String> = Vec::new();
    for i in 0..layout.rows() {
        let unit = if layout.is_angular(i) { 1.0 } else { size };
        let name = &layout.owner(i).name;
        if s.gamma[i].abs() > RESTING_RATE * unit && !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}
