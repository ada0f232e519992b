//! The uncertainty of the entries of C. Data are rounded to `f64`. An entry of 1e-17 that is a sum
//! of terms of about one may be zero. However, an entry of 1e-9 that is a sum of terms of size 1e-8
//! is significant.

use std::ops::Range;

use joints::Magnitude;
use linalg::Matrix;

use crate::mechanism::Mechanism;
use crate::rounding::ROUNDING;
use crate::scale::Scales;
use crate::space::norm;
use crate::system::{Layout, System};

/// An assembled initial configuration satisfies the constraints to this multiple of the rounding
/// error.
const CLOSED: f64 = 10.0;

/// Accuracy of a configuration along the motions that the constraints permit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConfigurationAccuracy {
    /// The configuration is exact as stored.
    AsStored,
    /// The accuracy is this fraction of a radian and of the lengths of the mechanism. The result of
    /// an integrator with about this tolerance has such an accuracy.
    To(f64),
}

impl ConfigurationAccuracy {
    /// Returns the uncertainty of the angles of bodies in addition to rounding errors (rad).
    fn turned(self) -> f64 {
        match self {
            Self::AsStored => 0.0,
            Self::To(share) => share.abs(),
        }
    }
}

impl Mechanism {
    /// Returns whether a tolerance is stated for any value.
    #[must_use]
    pub fn has_tolerances(&self) -> bool {
        self.tolerance().is_stated()
            || self.bodies().iter().any(|body| body.tolerance.is_some())
            || self
                .elements
                .constraints
                .iter()
                .any(|c| c.tolerance.is_some())
            || self.observed.has_tolerances()
    }
}

impl Scales<'_> {
    /// Returns a bound on the difference of each entry of C from the entry of the intended
    /// mechanism, (m+h) × n_v, in the units of C. The function allocates memory.
    ///
    /// The uncertainty of an entry is the relative error of the data times the size of the terms of
    /// this entry. The kernels compute this size from absolute values. The uncertainty is not
    /// determined for single entries: all components of a force, or of the position of a point,
    /// have the same uncertainty. This rule applies to every direction of the axes, so a zero entry
    /// is not exact, either. The uncertainty of a lever is the sum of three terms: the rounding
    /// error of the longest arm of the body, the rounding error of the positions of the bodies, and
    /// the residual |Φ_i| of the constraints. If a tolerance is stated, a rounding error is added
    /// instead of the residual, because residuals within the tolerance are not an error of the
    /// entries. `size` is the size of the mechanism. The work space must contain Φ and C at its
    /// configuration.
    #[must_use]
    pub fn uncertainty(self, size: f64, known: ConfigurationAccuracy) -> Matrix {
        let layout = self.mechanism.layout();
        let of_entries = self.uncertainty_of_entries(size, known);
        let mut u = Matrix::zeros(layout.rows(), layout.n_v);
        for i in 0..layout.rows() {
            for k in layout.pattern.row(i) {
                u[(i, layout.pattern.column[k])] += of_entries[k];
            }
        }
        u
    }

    /// Works like [`Self::uncertainty`], but returns one value for each entry in the pattern of C,
    /// in the order of the pattern.
    #[must_use]
    pub fn uncertainty_of_entries(self, size: f64, known: ConfigurationAccuracy) -> Vec<f64> {
        let layout = self.mechanism.layout();
        let pattern = &layout.pattern;
        let magnitudes = self.magnitudes();
        // The uncertainty of the angles of bodies. For a mechanism far from the origin, the
        // rotation is about the mechanism itself.
        let has_tolerances = self.mechanism.has_tolerances();
        let opening = |i: usize| {
            let missed = self.s.phi.get(i).map_or(0.0, |phi| phi.abs());
            if has_tolerances {
                missed.min(CLOSED * ROUNDING * self.position(i))
            } else {
                missed
            }
        };
        let of_row = |i: usize| self.relative_to_reach(i, size, opening(i));
        let turned = known.turned() + (0..layout.m).map(of_row).fold(0.0, f64::max);
        let mut u = Vec::with_capacity(pattern.column.len());
        for i in 0..layout.rows() {
            let row = pattern.row(i);
            // Forces on the bodies of the row, and the distances of the bodies from the origin.
            let forces: Vec<(usize, f64, f64)> = self.forces_of_row(&magnitudes, row.clone());
            let places =
                |&(body, force, _): &(usize, f64, f64)| force * norm(&self.s.bodies.origin(body));
            let shift = ROUNDING * forces.iter().map(places).sum::<f64>() + opening(i);
            for k in row {
                let column = pattern.column[k];
                let body = layout.space.body_of(column);
                let of_body = forces.iter().find(|(other, ..)| *other == body);
                let (_, force, magnitude) = of_body.copied().unwrap_or_default();
                // A force that is not larger than the rounding error of its terms counts as zero,
                // for any direction of the axes.
                let has_force = force > ROUNDING * magnitude;
                u.push(if layout.space.is_rotation(column) {
                    let lever = force * self.mechanism.reach(body);
                    // A rotation without a force, for example that of a rolling wheel, has no
                    // lever.
                    let moved = if has_force || forces.is_empty() {
                        shift
                    } else {
                        0.0
                    };
                    let entry = self.s.entries[pattern.entry[k]].abs();
                    let terms = magnitudes[pattern.entry[k]].value();
                    ROUNDING * (terms + lever) + turned * (entry + lever) + moved
                } else {
                    ROUNDING * magnitude + turned * force
                });
            }
        }
        u
    }

    /// For each body on which this row of the pattern exerts a force, returns the body, the size of
    /// the force, and the size of the terms of the force.
    fn forces_of_row(self, magnitudes: &[Magnitude], row: Range<usize>) -> Vec<(usize, f64, f64)> {
        let Layout { space, pattern, .. } = self.mechanism.layout();
        let mut forces: Vec<(usize, [f64; 3], [f64; 3])> = Vec::new();
        for k in row.filter(|&k| !space.is_rotation(pattern.column[k])) {
            let column = pattern.column[k];
            let (body, axis) = (space.body_of(column), space.axis_of(space.dof_of(column)));
            let at = match forces.iter().position(|(other, ..)| *other == body) {
                Some(at) => at,
                None => {
                    forces.push((body, [0.0; 3], [0.0; 3]));
                    forces.len() - 1
                }
            };
            let entry = pattern.entry[k];
            forces[at].1[axis] += self.s.entries[entry];
            forces[at].2[axis] += magnitudes[entry].value();
        }
        let sizes = forces
            .into_iter()
            .map(|(body, force, terms)| (body, norm(&force), norm(&terms)));
        sizes.collect()
    }

    /// Sizes of the terms of all entries of C.
    fn magnitudes(self) -> Vec<Magnitude> {
        let constant = self.mechanism.elements.entries.iter();
        let mut entries: Vec<Magnitude> = constant.map(|&e| Magnitude::from(e)).collect();
        for c in self
            .mechanism
            .elements
            .constraints
            .iter()
            .filter(|c| c.has_varying_entries())
        {
            c.magnitude_c(&self.s.slots, &mut entries[c.entries.clone()]);
        }
        entries
    }
}
