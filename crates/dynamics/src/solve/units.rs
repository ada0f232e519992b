//! Units of a mechanism. Lengths are divided by the size of the mechanism, rounded to a power of
//! two so that scaling causes no rounding error. The module also computes the sizes and masses that
//! decide whether solutions are refined.

use linalg::{AddedMass, MassMatrix};
use model::{Mechanism, System};

use crate::limits::FAR_FROM_A_METRE;

/// Masses, a force and a motion in units of the mechanism, n_v each.
#[derive(Clone)]
pub(super) struct ScaledVectors {
    /// Units of the coordinates.
    pub(super) units: Vec<f64>,
    pub(super) mass: Vec<f64>,
    /// The rows of M.
    pub(super) added: AddedMass,
    pub(super) force: Vec<f64>,
    pub(super) motion: Vec<f64>,
}

impl ScaledVectors {
    /// Creates a zero force and a zero motion, with these units and masses, and rows of M.
    pub(super) fn new(units: Vec<f64>, mass: Vec<f64>, added: AddedMass) -> Self {
        Self {
            added,
            force: vec![0.0; units.len()],
            motion: vec![0.0; units.len()],
            units,
            mass,
        }
    }

    /// Copies the values of the rows of M.
    pub(super) fn take_added(&mut self, added: &AddedMass) {
        self.added.take(added, &self.units);
    }

    /// Returns M.
    pub(super) fn inertia(&self) -> MassMatrix<'_> {
        MassMatrix::new(&self.mass, &self.added)
    }

    /// Copies a force in SI units.
    pub(super) fn take_force(&mut self, force: &[f64]) {
        for ((scaled, f), unit) in self.force.iter_mut().zip(force).zip(&self.units) {
            *scaled = f * unit;
        }
    }

    /// Copies a motion in SI units.
    pub(super) fn take_motion(&mut self, x: &[f64]) {
        for ((scaled, x), unit) in self.motion.iter_mut().zip(x).zip(&self.units) {
            *scaled = x / unit;
        }
    }

    /// Writes the motion in SI units.
    pub(super) fn write_motion(&self, x: &mut [f64]) {
        for ((x, scaled), unit) in x.iter_mut().zip(&self.motion).zip(&self.units) {
            *x = scaled * unit;
        }
    }
}

/// Returns the unit of the velocity of each column of C, for a mechanism of this size (m). All
/// columns of the same physical dimension have the same unit.
pub(super) fn units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let exponents = mechanism.layout().dimension_scaling(size).cols;
    exponents.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Returns the unit of each column of C, chosen for each body. The unit of a translation is 1 m. A
/// rotation is measured by the distance (m) by which it moves the joints of the body. For example,
/// the links of a chain of a thousand metres then have masses of one order of magnitude. With the
/// size of the chain as the unit, their moments of inertia would be negligible.
fn units_of_bodies(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let (layout, space) = (mechanism.layout(), mechanism.space());
    let mut units = vec![1.0; layout.n_v];
    let bodies = units.chunks_exact_mut(space.n_v());
    for (body, length) in bodies.zip(lengths(mechanism, size)) {
        body[space.torques()].fill(length.recip());
    }
    units
}

/// Returns the length (m) of each body. The length is the longest arm from the centre of mass to a
/// point of a joint, or the largest radius of gyration if this radius is longer. If both lengths
/// are zero or rounding errors, it is the size of the mechanism (m).
fn lengths(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let space = mechanism.space();
    let gyration = |mass: &[f64]| {
        let heaviest = |part: &[f64]| part.iter().fold(0.0, |a: f64, &m| a.max(m));
        let square = heaviest(&mass[space.torques()]) / heaviest(&mass[space.forces()]);
        if square.is_finite() {
            square.sqrt()
        } else {
            0.0
        }
    };
    let bodies = mechanism.mass().chunks_exact(space.n_v());
    let mut lengths: Vec<f64> = bodies.map(gyration).collect();
    for id in mechanism.layout().constraint_ids() {
        for (body, point) in mechanism.points(id) {
            if let Some(k) = body.moving() {
                lengths[k] = lengths[k].max(linalg::kernels::norm(&point));
            }
        }
    }
    for (body, length) in lengths.iter_mut().enumerate() {
        if !(mechanism.is_length(body, *length) && length.log2().is_finite()) {
            *length = size;
        }
    }
    lengths
}

/// Returns masses and moments of inertia in these units.
pub(super) fn mass_in_units(mechanism: &Mechanism, units: &[f64]) -> Vec<f64> {
    let mass = units.iter().zip(mechanism.mass());
    mass.map(|(unit, m)| unit * m * unit).collect()
}

/// Returns masses and moments of inertia if only holonomic rows are solved. In this case, motions
/// that only nonholonomic rows restrict are free. If such a motion has no mass or inertia, the mass
/// metric defines no smallest correction for it. Therefore a coordinate without mass gets the
/// smallest positive value of the other coordinates, or 1.
pub(super) fn mass_of_positions(mechanism: &Mechanism, units: &[f64]) -> Vec<f64> {
    let mut mass = mass_in_units(mechanism, units);
    let some = mass.iter().copied().filter(|&m| m > 0.0);
    let smallest = some.reduce(f64::min).unwrap_or(1.0);
    for m in mass.iter_mut().filter(|m| **m == 0.0) {
        *m = smallest;
    }
    mass
}

/// Returns whether the size of a mechanism (m) is far from the size of ordinary machines. In this
/// case the terms that are added, such as weights and centrifugal terms, also differ by many powers
/// of ten.
pub(crate) fn is_far(size: f64) -> bool {
    !(1.0 / FAR_FROM_A_METRE..=FAR_FROM_A_METRE).contains(&size)
}

/// Returns the largest mass divided by the smallest nonzero mass, scaled by the lengths of the
/// bodies. This ratio decides whether solutions are refined.
pub(crate) fn mass_spread(mechanism: &Mechanism, size: f64) -> f64 {
    let units = units_of_bodies(mechanism, size);
    let mut mass = mass_in_units(mechanism, &units);
    // An armature is compared with the inertias, or with the masses, of the bodies of its joint.
    for armature in mechanism.armatures() {
        for body in armature.bodies.iter().filter_map(|body| body.moving()) {
            let columns = mechanism.layout().columns(body);
            let own = columns.filter(|j| mechanism.space().is_rotation(*j) == armature.is_angle);
            mass.extend(own.map(|j| units[j] * armature.inertia * units[j]));
        }
    }
    linalg::mass_spread(&mass)
}
