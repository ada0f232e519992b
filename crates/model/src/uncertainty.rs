//! What the entries of C are known to. Data stand in `f64`, rounded: an entry that is made of terms
//! of size one and is 1e-17 may as well be zero, one that is made of terms of size 1e-8 and is 1e-9
//! means something.

use std::ops::Range;

use joints::{Magnitude, Pose};
use linalg::Matrix;

use crate::mechanism::{Mechanism, N_BODY, pose_of};
use crate::scale::Scales;
use crate::system::System;

/// Relative error of the numbers of a scene, and of what is made of them: half a unit in the last
/// place for each of eight roundings, which are reading of the number, the place of its body (two),
/// its turn into the frame of the body (two), sine and cosine, and the evaluation of C (two).
pub const ROUNDING: f64 = 8.0 * f64::EPSILON / 2.0;

/// An assembled start is closed to so many roundings.
const CLOSED: f64 = 10.0;

/// How well a configuration is known along the motions that the constraints leave free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// As stored: it is the one that is meant.
    AsStored,
    /// To this share of a radian and of the lengths of the mechanism: what an integrator reached
    /// with about this tolerance.
    To(f64),
}

impl Known {
    /// By how many radians bodies may be turned, beyond rounding.
    fn turned(self) -> f64 {
        match self {
            Self::AsStored => 0.0,
            Self::To(share) => share.abs(),
        }
    }
}

/// Whether anything is stated of any number of a mechanism.
pub(crate) fn has_tolerances(mechanism: &Mechanism) -> bool {
    mechanism.tolerance().is_stated()
        || mechanism
            .bodies()
            .iter()
            .any(|body| body.tolerance.is_some())
        || mechanism
            .elements
            .constraints
            .iter()
            .any(|c| c.tolerance.is_some())
}

impl Scales<'_> {
    /// How far each entry of C may be from that of the mechanism meant, (m+h) × n_v, in the units
    /// of C; allocates.
    ///
    /// A number is known to the relative error of the data times the size of the terms it adds up,
    /// which its kernel on magnitudes gives, but never entry by entry: of a force and of the place
    /// of a point all components are known equally well, whichever way the axes point, and no zero
    /// is exact. A lever is known to the rounding of the longest arm of its body and of where its
    /// bodies stand, and to what the constraints leave open, |Φ_i|: where a tolerance is stated no
    /// more than rounding, for what contradicting rows miss within it is no fault of the entries.
    /// `size` is that of the mechanism. Needs Φ and C at the pose of the scratch.
    #[must_use]
    pub fn uncertainty(self, size: f64, known: Known) -> Matrix {
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

    /// The same for each entry of the pattern of C, in its order.
    #[must_use]
    pub fn uncertainty_of_entries(self, size: f64, known: Known) -> Vec<f64> {
        let layout = self.mechanism.layout();
        let pattern = &layout.pattern;
        let magnitudes = self.magnitudes();
        // How far bodies may be turned; a mechanism that stands far away is turned about itself.
        let has_tolerances = has_tolerances(self.mechanism);
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
            // Forces on the bodies of the row, and how far they stand from the origin.
            let forces: Vec<(usize, f64, f64)> = self.forces_of_row(&magnitudes, row.clone());
            let places = |&(body, force, _): &(usize, f64, f64)| {
                force * self.s.poses[body].x.hypot(self.s.poses[body].y)
            };
            let shift = ROUNDING * forces.iter().map(places).sum::<f64>() + opening(i);
            for k in row {
                let (body, dof) = (pattern.column[k] / N_BODY, pattern.column[k] % N_BODY);
                let of_body = forces.iter().find(|(other, ..)| *other == body);
                let (_, force, magnitude) = of_body.copied().unwrap_or_default();
                u.push(match dof {
                    2 => {
                        let lever = force * self.mechanism.reach(body);
                        // A rotation that comes without a force, as that of a rolling wheel, has no
                        // lever.
                        let moved = if force > 0.0 || forces.is_empty() {
                            shift
                        } else {
                            0.0
                        };
                        let entry = self.s.entries[pattern.entry[k]].abs();
                        let terms = magnitudes[pattern.entry[k]].value();
                        ROUNDING * (terms + lever) + turned * (entry + lever) + moved
                    }
                    _ => ROUNDING * magnitude + turned * force,
                });
            }
        }
        u
    }

    /// Of each body that this row of the pattern pushes: the body, the size of the force, and the
    /// size of the terms that it is made of.
    fn forces_of_row(self, magnitudes: &[Magnitude], row: Range<usize>) -> Vec<(usize, f64, f64)> {
        let pattern = &self.mechanism.layout().pattern;
        let mut forces: Vec<(usize, [f64; 2], [f64; 2])> = Vec::new();
        for k in row.filter(|&k| pattern.column[k] % N_BODY != 2) {
            let (body, dof) = (pattern.column[k] / N_BODY, pattern.column[k] % N_BODY);
            let at = match forces.iter().position(|(other, ..)| *other == body) {
                Some(at) => at,
                None => {
                    forces.push((body, [0.0; 2], [0.0; 2]));
                    forces.len() - 1
                }
            };
            let entry = pattern.entry[k];
            forces[at].1[dof] += self.s.entries[entry];
            forces[at].2[dof] += magnitudes[entry].value();
        }
        let sizes = forces
            .into_iter()
            .map(|(body, force, terms)| (body, force[0].hypot(force[1]), terms[0].hypot(terms[1])));
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
            let poses = c
                .site
                .bodies
                .iter()
                .map(|&body| magnitude(&pose_of(&self.s.poses, body)));
            let x: Vec<Pose<Magnitude>> = poses.collect();
            let jets = c.site.f(&self.s.slots).iter();
            let f: Vec<[Magnitude; 3]> = jets.map(|jet| jet.map(Magnitude::from)).collect();
            c.element
                .magnitude()
                .c(&x, &f, &mut entries[c.entries.clone()]);
        }
        entries
    }
}

/// Sizes of what a pose contributes to a polynomial; cosine and sine are known to the rounding of
/// their angle.
fn magnitude(pose: &Pose) -> Pose<Magnitude> {
    let turned = Magnitude::from(pose.angle.abs().max(1.0));
    Pose {
        x: pose.x.into(),
        y: pose.y.into(),
        angle: pose.angle.into(),
        cos: turned,
        sin: turned,
    }
}
