//! All solutions `λ₀ + Z·y` at one configuration, and the solutions that a rule selects.

use linalg::Matrix;
use model::{ConstraintId, RowRanges, System};

use super::minimise::{Term, independent_columns, minimise_in, strain};
use super::multipliers::FreeMultipliers;
use super::{Centres, ChoiceError, ElasticSupports, Misfit, NormWeights};
use crate::groups::{ReactionForms, RequestError};

/// Returns `C_Xᵀ·Z_X` of equilibrated rows X.
type Cancelling<'a> = Box<dyn Fn(&RowRanges) -> Result<Matrix, RequestError> + 'a>;

/// The reactions at a configuration, and the directions in which their multipliers are free.
pub(crate) struct Choosing<'a> {
    pub(crate) reactions: &'a ReactionForms<'a>,
    pub(crate) free: FreeMultipliers<'a>,
    pub(crate) b_x: Cancelling<'a>,
}

impl Choosing<'_> {
    /// Returns the λ of least norm with these weights.
    pub(crate) fn least_norm(
        &self,
        lambda_0: &[f64],
        w: NormWeights,
    ) -> Result<Vec<f64>, ChoiceError> {
        for value in [w.force, w.torque] {
            if !(value.is_finite() && value > 0.0) {
                return Err(ChoiceError::NormWeight { value });
            }
        }
        let forces = self.reactions.mechanism.space().forces();
        self.least(lambda_0, |_, component| {
            let w = if forces.contains(&component) {
                w.force
            } else {
                w.torque
            };
            w * w
        })
    }

    /// Returns the λ of elastic supports.
    pub(crate) fn elastic(
        &self,
        lambda_0: &[f64],
        supports: &ElasticSupports,
    ) -> Result<Vec<f64>, ChoiceError> {
        let mechanism = &self.reactions.mechanism;
        let space = mechanism.space();
        let rigid = ([0.0; 3], 0.0);
        let mut of_joint = vec![rigid; mechanism.layout().groups.len()];
        for joint in &supports.compliances {
            self.reactions.check_id(joint.reaction)?;
            let (along, rotation) = &mut of_joint[joint.reaction.0];
            let totals = along.iter_mut().chain([rotation]);
            for (total, compliance) in totals.zip(joint.along.into_iter().chain([joint.rotation])) {
                if !(compliance.is_finite() && compliance >= 0.0) {
                    return Err(ChoiceError::Weight { value: compliance });
                }
                // Compliances of springs in series add up.
                *total += compliance;
            }
        }
        let mut misfits = vec![[[0.0; 3]; 2]; mechanism.layout().groups.len()];
        for misfit in &supports.misfits {
            self.reactions.check_id(misfit.reaction)?;
            let own = &mut misfits[misfit.reaction.0];
            for (own, given) in own.iter_mut().zip([misfit.along, misfit.rotation]) {
                for (own, given) in own.iter_mut().zip(given) {
                    if !given.is_finite() {
                        return Err(ChoiceError::Misfit { value: given });
                    }
                    *own += given;
                }
            }
        }
        let terms = self.terms(&supports.centres, |id, component| {
            let (along, rotation) = of_joint[id.0];
            let (axis, [d, phi]) = (space.axis_of(component), misfits[id.0]);
            if space.forces().contains(&component) {
                (along[axis], d[axis])
            } else {
                (rotation, phi[axis])
            }
        })?;
        self.check_fits(&terms, &supports.misfits)?;
        minimise_in(&self.free, lambda_0, &terms)
    }

    /// Checks that a misfit causes no load through nonholonomic rows. These rows slip, so a load
    /// through them does not last.
    fn check_fits(&self, terms: &[Term], misfits: &[Misfit]) -> Result<(), ChoiceError> {
        let layout = self.reactions.mechanism.layout();
        let (strain, most) = strain(&self.free, terms);
        let pushes = strain.iter().any(|x| x.abs() > most * self.free.tolerance);
        let z = &self.free.z;
        let is_shared = |row: usize| z.row(row).iter().any(|z| z.abs() > self.free.tolerance);
        let mut slipping = layout.groups.iter().filter(|group| {
            let rows = group.rows.nonholonomic.clone();
            rows.into_iter().any(is_shared)
        });
        match (pushes, misfits.first(), slipping.next()) {
            (true, Some(misfit), Some(group)) => Err(ChoiceError::Slips {
                misfit: layout.groups[misfit.reaction.0].name.clone(),
                slipping: group.name.clone(),
            }),
            _ => Ok(()),
        }
    }

    /// Minimises the weighted sum of squares of all wrenches.
    fn least(
        &self,
        lambda_0: &[f64],
        weights: impl Fn(ConstraintId, usize) -> f64,
    ) -> Result<Vec<f64>, ChoiceError> {
        let centres = Centres::default();
        let terms = self.terms(&centres, |id, component| (weights(id, component), 0.0))?;
        minimise_in(&self.free, lambda_0, &terms)
    }

    /// Returns the components of all wrenches with their weights and misfits.
    fn terms(
        &self,
        centres: &Centres,
        of: impl Fn(ConstraintId, usize) -> (f64, f64),
    ) -> Result<Vec<Term>, ChoiceError> {
        let groups = &self.reactions.mechanism.layout().groups;
        let mut terms = Vec::new();
        for (k, group) in groups.iter().enumerate() {
            let id = ConstraintId(k);
            let space = group.space;
            let mut own = Vec::new();
            let components = group.components();
            let is_torque = |c: &usize| space.torques().contains(c);
            let centre = centres.of(id).filter(|_| components.iter().any(is_torque));
            for c in components
                .iter()
                .filter(|c| centre.is_none() || !is_torque(c))
            {
                own.push((*c, self.reactions.component(id, space.components()[*c])?));
            }
            if let Some(about) = centre {
                // About another point, the force has moments about all axes.
                own.extend(space.torques().zip(self.reactions.moments(id, about)?));
            }
            for (c, form) in own {
                let (weight, misfit) = of(id, c);
                terms.push(Term {
                    form,
                    weight,
                    misfit,
                });
            }
        }
        self.check_visible(&terms)?;
        Ok(terms)
    }

    /// Checks that every free direction changes at least one of the wrenches.
    fn check_visible(&self, terms: &[Term]) -> Result<(), ChoiceError> {
        let (p, tolerance) = (self.free.z.ncols(), self.free.tolerance);
        let images: Vec<Vec<f64>> = terms
            .iter()
            .map(|term| term.form.image(&self.free).0)
            .collect();
        let rows: Vec<&[f64]> = images.iter().map(Vec::as_slice).collect();
        let visible = independent_columns(&rows, p, tolerance).len();
        if visible == p {
            return Ok(());
        }
        for group in &self.reactions.mechanism.layout().groups {
            let b_x = (self.b_x)(&group.rows)?;
            let of_bodies = (0..b_x.nrows()).map(|i| b_x.row(i));
            let all: Vec<&[f64]> = rows.iter().copied().chain(of_bodies).collect();
            if independent_columns(&all, p, tolerance).len() > visible {
                return Err(ChoiceError::Hidden {
                    reaction: group.name.clone(),
                });
            }
        }
        Ok(())
    }
}
