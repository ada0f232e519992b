//! Reaction components at one configuration, sums of components, sums of wrenches, and resultants.
//! Each reaction or sum is a linear form of the multipliers. Other modules determine which of these
//! forms are unique.

use std::borrow::Cow;

use linalg::Matrix;
use model::space::norm;
use model::{ConstraintId, Mechanism, RowRanges, Scratch, SpaceKind, System};

use super::error::{RequestError, check, check_finite, unknown_component};
use super::form::LinearForm;
use super::group::{Group, NO_REACTION, Term};

/// A mechanism at a configuration, from which the linear forms of its reactions are computed.
pub struct ReactionForms<'a> {
    pub(crate) mechanism: Cow<'a, Mechanism>,
    pub(crate) s: Cow<'a, Scratch>,
    /// Length (m) by which torques are divided so that they can be compared with forces.
    pub(crate) size: f64,
}

impl<'a> ReactionForms<'a> {
    /// Returns the forms at the configuration of a scratch, for a mechanism of this size.
    pub(crate) fn at(mechanism: &'a Mechanism, s: &'a Scratch, size: f64) -> Self {
        Self {
            mechanism: Cow::Borrowed(mechanism),
            s: Cow::Borrowed(s),
            size,
        }
    }

    /// Returns the origin of the frame of a body, in global components (m).
    ///
    /// # Errors
    /// [`RequestError::UnknownBody`]
    pub fn origin(&self, body: usize) -> Result<[f64; 3], RequestError> {
        let bodies = self.s.bodies.len();
        if body >= bodies {
            return Err(RequestError::UnknownBody { body, bodies });
        }
        Ok(self.s.bodies.origin(body))
    }

    /// Returns the reference point of the reaction of a joint or drive, in global components (m).
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`]
    pub fn place(&self, id: ConstraintId) -> Result<[f64; 3], RequestError> {
        self.check_id(id)?;
        Ok(self.mechanism.reactions(&self.s).place(id))
    }

    /// Returns the force of a reaction along a direction in global components. For a unit vector,
    /// the unit of the force is N.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::NotFinite`]
    pub fn force(&self, id: ConstraintId, along: [f64; 3]) -> Result<LinearForm, RequestError> {
        self.check_id(id)?;
        check("direction", &along, 3)?;
        let map = self.mechanism.reactions(&self.s).wrench_map(id);
        let mut form = self.zero();
        let along = WrenchDirection {
            force: along,
            torque: [0.0; 3],
        };
        self.add_wrench(&mut form, &map, self.rows(id), along);
        Ok(form)
    }

    /// Returns the torque of a reaction along a direction about a point, both in ground axes. For a
    /// unit vector, the unit of the torque is N·m. In the plane, only the z component of the
    /// direction counts.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::NotFinite`]
    pub fn torque(
        &self,
        id: ConstraintId,
        along: [f64; 3],
        about: [f64; 3],
    ) -> Result<LinearForm, RequestError> {
        self.check_id(id)?;
        check("direction", &along, 3)?;
        check("point", &about, 3)?;
        let map = self
            .mechanism
            .reactions(&self.s)
            .wrench_map_about(id, about);
        let mut form = self.zero();
        let along = WrenchDirection {
            force: [0.0; 3],
            torque: along,
        };
        self.add_wrench(&mut form, &map, self.rows(id), along);
        Ok(form)
    }

    /// Returns the components of the moment of a reaction about a point, along the global axes.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::NotFinite`]
    pub fn moments(
        &self,
        id: ConstraintId,
        about: [f64; 3],
    ) -> Result<Vec<LinearForm>, RequestError> {
        let space = self.mechanism.space();
        let axes = space.torques().map(|k| {
            let mut axis = [0.0; 3];
            axis[space.axis_of(k)] = 1.0;
            self.torque(id, axis, about)
        });
        axes.collect()
    }

    /// Returns a component of a reaction by its name. The component is a component of the space, or
    /// the named component of the definition.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::UnknownComponent`]
    pub fn component(&self, id: ConstraintId, name: &str) -> Result<LinearForm, RequestError> {
        let space = self.mechanism.space();
        let Some(component) = space.component(name) else {
            return self.named_component(id, name);
        };
        let WrenchDirection { force, torque } = WrenchDirection::component(space, component);
        if space.forces().contains(&component) {
            self.force(id, force)
        } else {
            self.torque(id, torque, self.place(id)?)
        }
    }

    fn named_component(&self, id: ConstraintId, name: &str) -> Result<LinearForm, RequestError> {
        self.check_id(id)?;
        let coefficients = self
            .mechanism
            .reactions(&self.s)
            .component_coefficients(id, name);
        let coefficients =
            coefficients.ok_or_else(|| unknown_component(&self.mechanism, id, name))?;
        let rows = self.rows(id).iter();
        let mut form = self.zero();
        form.add(&rows.zip(coefficients).collect::<Vec<_>>())?;
        Ok(form)
    }

    /// Returns the sum of all reactions on a set of bodies. The result contains all components,
    /// with torques about a point in ground axes. A body that is listed twice counts once.
    ///
    /// # Errors
    /// [`RequestError::UnknownBody`], [`RequestError::Empty`], [`RequestError::NotFinite`]
    pub fn resultant(
        &self,
        bodies: &[usize],
        about: [f64; 3],
    ) -> Result<Vec<LinearForm>, RequestError> {
        check("point", &about, 3)?;
        if bodies.is_empty() {
            return Err(RequestError::Empty { of: "body" });
        }
        let space = self.mechanism.space();
        let mut forms = self.zeros();
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
            for (k, form) in forms.iter_mut().enumerate() {
                self.add_wrench(
                    form,
                    &map,
                    0..map.ncols(),
                    WrenchDirection::component(space, k),
                );
            }
        }
        Ok(forms)
    }

    /// For each component of the reaction `id`, adds `coefficient` times this component to the form
    /// with the same index. Torques are about the point `about`.
    pub(super) fn add_reaction(
        &self,
        forms: &mut [LinearForm],
        id: ConstraintId,
        coefficient: f64,
        about: [f64; 3],
    ) {
        let map = self
            .mechanism
            .reactions(&self.s)
            .wrench_map_about(id, about);
        for (k, form) in forms.iter_mut().enumerate() {
            let WrenchDirection { force, torque } =
                WrenchDirection::component(self.mechanism.space(), k);
            let along = WrenchDirection {
                force: force.map(|x| coefficient * x),
                torque: torque.map(|x| coefficient * x),
            };
            self.add_wrench(form, &map, self.rows(id), along);
        }
    }

    /// Adds `along · (map·λ)` for a map of these rows. For forces, the size of a term is the
    /// magnitude of its force. For torques, the magnitude of the force times the size of the
    /// mechanism is added.
    fn add_wrench(
        &self,
        form: &mut LinearForm,
        map: &Matrix,
        rows: impl IntoIterator<Item = usize>,
        along: WrenchDirection,
    ) {
        let space = self.mechanism.space();
        for (j, row) in rows.into_iter().enumerate() {
            let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
            space
                .forces()
                .for_each(|k| force[space.axis_of(k)] = map[(k, j)]);
            space
                .torques()
                .for_each(|k| torque[space.axis_of(k)] = map[(k, j)]);
            let pairs = along.force.iter().zip(&force);
            let pairs = pairs.chain(along.torque.iter().zip(&torque));
            let coefficient = pairs.fold(0.0, |sum, (along, x)| sum + along * x);
            let (force, torque) = (norm(&force), norm(&torque));
            let size =
                force * norm(&along.force) + (torque + force * self.size) * norm(&along.torque);
            form.add_term(row, coefficient, size);
        }
    }

    /// Returns a zero form for each component.
    fn zeros(&self) -> Vec<LinearForm> {
        vec![self.zero(); self.mechanism.space().n_v()]
    }

    pub(crate) fn zero(&self) -> LinearForm {
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

    fn rows(&self, id: ConstraintId) -> &RowRanges {
        &self.mechanism.layout().groups[id.0].rows
    }

    /// Returns the numbers of a group with their names. The numbers are the `sum` of a combination,
    /// or all components of wrenches. A group of several separate reactions has no numbers.
    ///
    /// # Errors
    /// Returns the same errors as [`crate::judge_groups`].
    pub fn numbers(&self, group: &Group) -> Result<Vec<(&'static str, LinearForm)>, RequestError> {
        self.numbers_about(group, self.about(group)?)
    }

    /// Works like [`Self::numbers`], but the torques T of wrenches are about this point.
    pub(crate) fn numbers_about(
        &self,
        group: &Group,
        about: Option<[f64; 3]>,
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

    /// Returns the reference point for the torques T of a sum of wrenches or a resultant.
    pub(crate) fn about(&self, group: &Group) -> Result<Option<[f64; 3]>, RequestError> {
        match group {
            Group::WrenchSum(terms) => terms.first().map(|&(_, id)| self.place(id)).transpose(),
            Group::Resultant(bodies) => bodies.first().map(|&body| self.origin(body)).transpose(),
            _ => Ok(None),
        }
    }

    /// Returns the sum `Σ coefficient · component`.
    ///
    /// # Errors
    /// Returns the same errors as [`crate::judge_groups`].
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

    /// Returns all components of `Σ coefficient · wrench`, with torques about the reference point
    /// of the first reaction.
    ///
    /// # Errors
    /// Returns the same errors as [`crate::judge_groups`].
    pub fn wrench_sum(
        &self,
        terms: &[(f64, ConstraintId)],
    ) -> Result<Vec<LinearForm>, RequestError> {
        let Some(&(_, first)) = terms.first() else {
            return Err(NO_REACTION);
        };
        self.wrench_sum_about(terms, self.place(first)?)
    }

    fn wrench_sum_about(
        &self,
        terms: &[(f64, ConstraintId)],
        about: [f64; 3],
    ) -> Result<Vec<LinearForm>, RequestError> {
        let factors: Vec<f64> = terms.iter().map(|(factor, _)| *factor).collect();
        check_finite("coefficients", &factors)?;
        let mut sum = self.zeros();
        for &(coefficient, id) in terms {
            self.check_id(id)?;
            self.add_reaction(&mut sum, id, coefficient, about);
        }
        Ok(sum)
    }

    fn named(&self, forms: Vec<LinearForm>) -> Vec<(&'static str, LinearForm)> {
        let names = self.mechanism.space().components();
        names.iter().copied().zip(forms).collect()
    }

    pub(super) fn rows_of(&self, members: &[ConstraintId]) -> Result<Vec<RowRanges>, RequestError> {
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

/// A direction of wrenches, in ground axes.
#[derive(Clone, Copy)]
struct WrenchDirection {
    force: [f64; 3],
    torque: [f64; 3],
}

impl WrenchDirection {
    /// Returns the unit vector of a component.
    fn component(space: SpaceKind, component: usize) -> Self {
        let mut along = Self {
            force: [0.0; 3],
            torque: [0.0; 3],
        };
        let axis = space.axis_of(component);
        if space.forces().contains(&component) {
            along.force[axis] = 1.0;
        } else {
            along.torque[axis] = 1.0;
        }
        along
    }
}
