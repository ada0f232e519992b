//! The numbers of reactions at one pose, as linear forms of the multipliers: components, sums of
//! them, sums of wrenches, resultants. This module does not determine which of them are unique.

use std::borrow::Cow;

use linalg::Matrix;
use model::{ConstraintId, Mechanism, Scratch, System};

use super::error::{RequestError, check, check_finite};
use super::form::LinearForm;
use super::group::{Group, NO_REACTION, Term};

/// A mechanism at a pose, from which the linear forms of its reactions are computed.
pub struct ReactionForms<'a> {
    pub(crate) mechanism: Cow<'a, Mechanism>,
    pub(crate) s: Scratch,
    /// Length by which torques are divided for comparison with forces (m).
    pub(crate) size: f64,
}

impl ReactionForms<'_> {
    /// The origin of a body's frame, global components (m).
    ///
    /// # Errors
    /// [`RequestError::UnknownBody`]
    pub fn origin(&self, body: usize) -> Result<[f64; 2], RequestError> {
        let bodies = self.s.poses.len();
        let pose = self.s.poses.get(body);
        pose.map(|p| [p.x, p.y])
            .ok_or(RequestError::UnknownBody { body, bodies })
    }

    /// The point where the reaction of a joint or drive is reported, global components (m).
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`]
    pub fn place(&self, id: ConstraintId) -> Result<[f64; 2], RequestError> {
        self.check_id(id)?;
        Ok(self.mechanism.reactions(&self.s).place(id))
    }

    /// The force of a reaction along a direction (global components; a unit vector gives N).
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::NotFinite`]
    pub fn force(&self, id: ConstraintId, along: [f64; 2]) -> Result<LinearForm, RequestError> {
        self.check_id(id)?;
        check("direction", &along, 2)?;
        let map = self.mechanism.reactions(&self.s).wrench_map(id);
        let mut form = self.zero();
        self.add_wrench(
            &mut form,
            &map,
            self.first_row(id),
            [along[0], along[1], 0.0],
        );
        Ok(form)
    }

    /// The torque of a reaction about a global point.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::NotFinite`]
    pub fn torque(&self, id: ConstraintId, about: [f64; 2]) -> Result<LinearForm, RequestError> {
        self.check_id(id)?;
        check("point", &about, 2)?;
        let map = self
            .mechanism
            .reactions(&self.s)
            .wrench_map_about(id, about);
        let mut form = self.zero();
        self.add_wrench(&mut form, &map, self.first_row(id), [0.0, 0.0, 1.0]);
        Ok(form)
    }

    /// A component of a reaction by its name: `Fx`, `Fy`, `T`, or the named component of the
    /// definition.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::UnknownComponent`]
    pub fn component(&self, id: ConstraintId, name: &str) -> Result<LinearForm, RequestError> {
        match name {
            "Fx" => self.force(id, [1.0, 0.0]),
            "Fy" => self.force(id, [0.0, 1.0]),
            "T" => self.torque(id, self.place(id)?),
            _ => self.named_component(id, name),
        }
    }

    fn named_component(&self, id: ConstraintId, name: &str) -> Result<LinearForm, RequestError> {
        self.check_id(id)?;
        let coefficients = self
            .mechanism
            .reactions(&self.s)
            .component_coefficients(id, name);
        let Some(coefficients) = coefficients else {
            let group = &self.mechanism.layout().groups[id.0];
            let named = group.spec.component.map(|name| format!(", `{name}`"));
            return Err(RequestError::UnknownComponent {
                reaction: group.name.clone(),
                component: name.to_owned(),
                available: format!("`Fx`, `Fy`, `T`{}", named.unwrap_or_default()),
            });
        };
        let rows = self.first_row(id)..;
        let mut form = self.zero();
        form.add(&rows.zip(coefficients).collect::<Vec<_>>())?;
        Ok(form)
    }

    /// The total of all reactions on a set of bodies, `[Fx, Fy, T]` with the torque about a global
    /// point. A body that is listed twice counts once.
    ///
    /// # Errors
    /// [`RequestError::UnknownBody`], [`RequestError::Empty`], [`RequestError::NotFinite`]
    pub fn resultant(
        &self,
        bodies: &[usize],
        about: [f64; 2],
    ) -> Result<[LinearForm; 3], RequestError> {
        check("point", &about, 2)?;
        if bodies.is_empty() {
            return Err(RequestError::Empty { of: "body" });
        }
        let mut forms = [(); 3].map(|()| self.zero());
        for (k, &body) in bodies.iter().enumerate() {
            let map = self
                .mechanism
                .reactions(&self.s)
                .body_wrench_map(body, about);
            let map = map.ok_or(RequestError::UnknownBody {
                body,
                bodies: self.mechanism.bodies().len(),
            })?;
            if bodies[..k].contains(&body) {
                continue;
            }
            for (form, along) in forms.iter_mut().zip(UNITS) {
                self.add_wrench(form, &map, 0, along);
            }
        }
        Ok(forms)
    }

    /// `coefficient · [Fx, Fy, T]` of a reaction about a global point, added to three forms.
    pub(super) fn add_reaction(
        &self,
        forms: &mut [LinearForm; 3],
        id: ConstraintId,
        coefficient: f64,
        about: [f64; 2],
    ) {
        let map = self
            .mechanism
            .reactions(&self.s)
            .wrench_map_about(id, about);
        for (form, along) in forms.iter_mut().zip(UNITS) {
            let along = along.map(|x| coefficient * x);
            self.add_wrench(form, &map, self.first_row(id), along);
        }
    }

    /// Adds `along · (map·λ)` for a map of some rows. The size of a term is the magnitude of its
    /// force, and for torques also that force times the size of the mechanism.
    fn add_wrench(&self, form: &mut LinearForm, map: &Matrix, first_row: usize, along: [f64; 3]) {
        for j in 0..map.ncols() {
            let [x, y, t] = [0, 1, 2].map(|k| map[(k, j)]);
            let force = x.hypot(y);
            let coefficient = along[0] * x + along[1] * y + along[2] * t;
            let size =
                force * along[0].hypot(along[1]) + (t.abs() + force * self.size) * along[2].abs();
            form.add_term(first_row + j, coefficient, size);
        }
    }

    pub(super) fn zero(&self) -> LinearForm {
        LinearForm::zero(self.mechanism.layout().rows())
    }

    pub(crate) fn check_id(&self, id: ConstraintId) -> Result<(), RequestError> {
        let reactions = self.mechanism.layout().groups.len();
        if id.0 < reactions {
            Ok(())
        } else {
            Err(RequestError::UnknownReaction {
                id: id.0,
                reactions,
            })
        }
    }

    fn first_row(&self, id: ConstraintId) -> usize {
        self.mechanism.layout().groups[id.0].rows.start
    }

    /// The numbers of a group, with their names: the `sum` of a combination; `Fx`, `Fy` and `T` of
    /// wrenches. A group of several separate reactions has none.
    ///
    /// # Errors
    /// As [`crate::judge_groups`].
    pub fn numbers(&self, group: &Group) -> Result<Vec<(&'static str, LinearForm)>, RequestError> {
        self.numbers_about(group, self.about(group)?)
    }

    /// Like [`Self::numbers`], with T of wrenches about this point.
    pub(crate) fn numbers_about(
        &self,
        group: &Group,
        about: Option<[f64; 2]>,
    ) -> Result<Vec<(&'static str, LinearForm)>, RequestError> {
        Ok(match group {
            Group::Members(_) | Group::OneJoint(_) => Vec::new(),
            Group::Combination(terms) => vec![("sum", self.combination(terms)?)],
            Group::WrenchSum(terms) => {
                self.named(self.wrench_sum_about(terms, about.ok_or(NO_REACTION)?)?)
            }
            Group::Resultant(bodies) => {
                self.named(self.resultant(bodies, about.unwrap_or_default())?)
            }
        })
    }

    /// The point about which T of a sum of wrenches or a resultant is taken.
    pub(crate) fn about(&self, group: &Group) -> Result<Option<[f64; 2]>, RequestError> {
        match group {
            Group::WrenchSum(terms) => terms.first().map(|&(_, id)| self.place(id)).transpose(),
            Group::Resultant(bodies) => bodies.first().map(|&body| self.origin(body)).transpose(),
            _ => Ok(None),
        }
    }

    /// `Σ coefficient · component`
    ///
    /// # Errors
    /// As [`crate::judge_groups`].
    pub fn combination(&self, terms: &[Term]) -> Result<LinearForm, RequestError> {
        if terms.is_empty() {
            return Err(RequestError::Empty { of: "term" });
        }
        let factors: Vec<f64> = terms.iter().map(|t| t.coefficient).collect();
        check_finite("coefficients", &factors)?;
        let mut sum = self.zero();
        for term in terms {
            sum.add_scaled(
                &self.component(term.reaction, &term.component)?,
                term.coefficient,
            );
        }
        Ok(sum)
    }

    /// `[Fx, Fy, T]` of `Σ coefficient · wrench`, T about the place of the first reaction.
    ///
    /// # Errors
    /// As [`crate::judge_groups`].
    pub fn wrench_sum(
        &self,
        terms: &[(f64, ConstraintId)],
    ) -> Result<[LinearForm; 3], RequestError> {
        let Some(&(_, first)) = terms.first() else {
            return Err(NO_REACTION);
        };
        self.wrench_sum_about(terms, self.place(first)?)
    }

    fn wrench_sum_about(
        &self,
        terms: &[(f64, ConstraintId)],
        about: [f64; 2],
    ) -> Result<[LinearForm; 3], RequestError> {
        let factors: Vec<f64> = terms.iter().map(|(factor, _)| *factor).collect();
        check_finite("coefficients", &factors)?;
        let mut sum = [(); 3].map(|()| self.zero());
        for &(coefficient, id) in terms {
            self.check_id(id)?;
            self.add_reaction(&mut sum, id, coefficient, about);
        }
        Ok(sum)
    }

    fn named(&self, forms: [LinearForm; 3]) -> Vec<(&'static str, LinearForm)> {
        let names = self.mechanism.space().components();
        names.iter().copied().zip(forms).collect()
    }

    pub(super) fn rows_of(
        &self,
        members: &[ConstraintId],
    ) -> Result<Vec<std::ops::Range<usize>>, RequestError> {
        let groups = &self.mechanism.layout().groups;
        if members.is_empty() {
            return Err(NO_REACTION);
        }
        members
            .iter()
            .map(|&id| self.check_id(id).map(|()| groups[id.0].rows.clone()))
            .collect()
    }
}

/// Unit vectors of the wrench.
const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
