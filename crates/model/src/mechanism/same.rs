//! Compares the constraints of two mechanisms.

use super::Mechanism;
use crate::record::RecordedEquations;
use crate::space::SpaceKind;

impl Mechanism {
    /// Returns whether the joints, drives and forces of another mechanism have the same stored
    /// values, tolerances and initial values, and whether its bodies have the same sizes. In this
    /// case, all results about the constraints at a configuration are equal for both mechanisms.
    /// Masses, moments of inertia and weights may differ. The result is also `false` for mechanisms
    /// with unwrapped angles or controllers, which cannot be compared.
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Mechanism};
    /// let built = |mass: f64, gravity: f64| {
    ///     let mut d = Description { gravity: [0.0, -gravity], ..Description::new("stone") };
    ///     d.body(Body::new("stone", mass, 1.0));
    ///     Mechanism::build(&d).unwrap()
    /// };
    /// assert!(built(1.0, 9.81).has_constraints_of(&built(2.0, 1.62)));
    /// ```
    #[must_use]
    pub fn has_constraints_of(&self, other: &Self) -> bool {
        let is_recorded = |m: &Self| {
            let known = matches!(m.space(), SpaceKind::Plane | SpaceKind::Space3);
            known
                && m.layout.turns == 0
                && m.layout.states == 0
                && m.elements.controllers.is_empty()
        };
        let bits = |x: &[f64]| -> Vec<u64> { x.iter().map(|x| x.to_bits()).collect() };
        let stated = |m: &Self| {
            let bodies = m.bodies.iter().map(|body| body.tolerance);
            let joints = m.elements.constraints.iter().map(|c| c.tolerance);
            bodies.chain(joints).collect::<Vec<_>>()
        };
        is_recorded(self)
            && is_recorded(other)
            && self.space() == other.space()
            && self.tolerance == other.tolerance
            && self.held == other.held
            && bits(&self.reach) == bits(&other.reach)
            && bits(&self.elements.entries) == bits(&other.elements.entries)
            && stated(self) == stated(other)
            && same_numbers(&RecordedEquations::of(self), &RecordedEquations::of(other))
    }
}

/// Returns whether two recordings have the same shape and the same values in joints, drives, forces
/// and functions of time.
fn same_numbers(a: &RecordedEquations, b: &RecordedEquations) -> bool {
    if a.shape() != b.shape() {
        return false;
    }
    let first = a.owners.first().map_or(a.beside.first, |(first, _)| *first);
    let of_time = a.beside.functions.iter().flatten().map(|r| r.place());
    let axes = a
        .beside
        .principal
        .iter()
        .flatten()
        .flatten()
        .map(|r| r.place());
    let number = |r: &RecordedEquations, place: usize| r.number(place).map(f64::to_bits);
    let mut places = (first..a.beside.first).chain(of_time).chain(axes);
    places.all(|place| number(a, place) == number(b, place))
}
