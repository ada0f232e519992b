//! Moments of reactions about points other than their reference point. If the force of a reaction
//! is not unique, the moment of the reaction may be unique about one point and not unique about
//! another point. In a spherical linkage, for example, the moment is unique about the centre.

use linalg::{Matrix, small_svd};
use model::ConstraintId;
use model::space::{cross, difference, norm};

use crate::groups::{Configuration, LinearForm, RequestError};
use crate::judged::ComponentVerdict;
use crate::limits::{FAR_CENTRE, FREE_FORCE};
use crate::verdict::Verdict;

/// Unit vectors of the ground.
const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The moment of a reaction about a point.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct MomentVerdict {
    /// The reference point of the moment (m), in ground axes.
    pub about: [f64; 3],
    /// Verdicts on the components of the moment along the axes of the ground, named as in
    /// [`model::SpaceKind::components`].
    pub components: Vec<ComponentVerdict>,
}

impl MomentVerdict {
    /// Returns whether all components are unique.
    #[must_use]
    pub fn is_unique(&self) -> bool {
        let mut components = self.components.iter();
        components.all(|c| c.judgement.verdict == Verdict::Unique)
    }
}

impl Configuration<'_> {
    /// Returns the verdict on the moment of a reaction about a point (m, ground axes).
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::NotFinite`]
    pub fn moment(&self, id: ConstraintId, about: [f64; 3]) -> Result<MomentVerdict, RequestError> {
        let space = self.reactions.mechanism.space();
        let judged = space.torques().map(|k| {
            let form = self.reactions.torque(id, UNITS[space.axis_of(k)], about)?;
            Ok(ComponentVerdict {
                name: space.components()[k],
                judgement: self.judge(&form)?,
            })
        });
        Ok(MomentVerdict {
            about,
            components: judged.collect::<Result<_, RequestError>>()?,
        })
    }

    /// Returns the nearest point about which the moment of a reaction is unique, if the moment is
    /// not unique about the reference point. Returns `None` if there is no such point nearby. Also
    /// returns `None` if the force is unique, because the point then has no influence.
    ///
    /// ```
    /// use joints::space3::{Axes, Revolute};
    /// use model::{BodyRef, ConstraintId, Mechanism, SpatialBody, SpatialDescription};
    /// use pfaff_solvability::{Configuration, certify};
    /// // A spherical linkage: the axes of four hinges meet in the origin.
    /// let mut d = SpatialDescription::new("spherical linkage");
    /// let link = |name: &str| SpatialBody::new(name, 1.0, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    /// let [a, b, c] = ["a", "b", "c"].map(|name| d.body(link(name)));
    /// let (ground, axes) = (BodyRef::Ground, [[2, 0, 1], [1, 2, 2], [-1, 1, 3], [-2, -1, 1]]);
    /// for (name, pair, at) in [("A", [ground, a]), ("B", [a, b]), ("C", [b, c]), ("D", [c, ground])]
    ///     .into_iter()
    ///     .zip(axes)
    ///     .map(|((name, pair), axis)| (name, pair, axis.map(f64::from)))
    /// {
    ///     let axis = Axes::new(at, None).unwrap();
    ///     d.joint(name, &pair, Revolute { s_i: at, s_j: at, axis, axis_j: axis });
    /// }
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let (q, _) = mechanism.described_state();
    /// let decision = certify(&mechanism, 0.0, &q).unwrap();
    /// let configuration = Configuration::new(&mechanism, 0.0, &q, &decision).unwrap();
    /// let of_a = ConstraintId(0);
    /// assert!(!configuration.moment(of_a, [2.0, 0.0, 1.0]).unwrap().is_unique());
    /// let centre = configuration.centre_of_moments(of_a).unwrap().unwrap();
    /// assert!(centre.iter().all(|x| x.abs() < 1e-12));
    /// ```
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`]
    pub fn centre_of_moments(&self, id: ConstraintId) -> Result<Option<[f64; 3]>, RequestError> {
        let place = self.reactions.place(id)?;
        if self.moment(id, place)?.is_unique() {
            return Ok(None);
        }
        let forces = UNITS.map(|along| self.reactions.force(id, along));
        let torques = UNITS.map(|along| self.reactions.torque(id, along, place));
        let free = |forms: [Result<LinearForm, RequestError>; 3]| -> Result<_, RequestError> {
            let [x, y, z] = forms;
            Ok([x?, y?, z?].map(|form| form.along_null_space(&self.solvability)))
        };
        let (forces, torques) = (free(forces)?, free(torques)?);
        let count = forces[0].len();
        // Solves x × F = T for every free wrench, with x relative to the reference point.
        let mut equations = Matrix::zeros(3 * count, 3);
        let mut right = vec![0.0; 3 * count];
        for k in 0..count {
            let [force, torque] = [&forces, &torques].map(|of| of.each_ref().map(|row| row[k]));
            for (j, unit) in UNITS.iter().enumerate() {
                let column = cross(*unit, force);
                (0..3).for_each(|i| equations[(3 * k + i, j)] = column[i]);
            }
            right[3 * k..3 * k + 3].copy_from_slice(&torque);
        }
        let Some(x) = least(&equations, &right) else {
            return Ok(None);
        };
        if norm(&x) > FAR_CENTRE * self.reactions.size {
            return Ok(None);
        }
        let there = difference(place, x.map(|x| -x));
        let found = self.moment(id, there)?.is_unique();
        Ok(found.then_some(there))
    }
}

/// Returns the smallest least-squares solution of the equations, or `None` without a free force.
fn least(equations: &Matrix, right: &[f64]) -> Option<[f64; 3]> {
    if equations.nrows() < 3 {
        return None;
    }
    let svd = small_svd(equations);
    let largest = *svd.sigma.first()?;
    if largest == 0.0 {
        return None;
    }
    let mut x = [0.0; 3];
    let clear = svd
        .sigma
        .iter()
        .take_while(|sigma| **sigma > FREE_FORCE * largest);
    for (k, sigma) in clear.enumerate() {
        let along: f64 = right
            .iter()
            .enumerate()
            .map(|(i, r)| svd.u[(i, k)] * r)
            .sum();
        (0..3).for_each(|j| x[j] += along / sigma * svd.v[(j, k)]);
    }
    Some(x)
}

#[cfg(test)]
mod tests;
