//! A mechanism at a configuration whose rank has been decided: where the numbers of its reactions
//! are made and judged.

use crate::pose::{dimensionless, evaluated, uncertainty};
use std::borrow::Cow;

use linalg::Matrix;
use model::start::scene_size;
use model::{ConstraintId, Mechanism, Scratch, System};
use rank::RankDecision;

use super::error::{RequestError, check};
use super::form::LinearForm;
use crate::matrices::Solvability;
use crate::verdict::Judgement;

/// A mechanism at time t and coordinates q, with the rank of C there.
pub struct Configuration<'a> {
    pub(crate) mechanism: Cow<'a, Mechanism>,
    pub(crate) s: Scratch,
    /// Length by which torques are compared with forces (m).
    pub(crate) size: f64,
    /// What the entries of the dimensionless C are known to.
    pub(crate) uncertainty: Matrix,
    pub(crate) solvability: Solvability,
}

impl<'a> Configuration<'a> {
    /// The mechanism where `decision` was made.
    ///
    /// # Errors
    /// - [`RequestError::Length`]: q, or the decision, belongs to another mechanism.
    /// - [`RequestError::NotFinite`]: t or q is not finite.
    pub fn new(
        mechanism: &'a Mechanism,
        t: f64,
        q: &[f64],
        decision: &RankDecision,
    ) -> Result<Self, RequestError> {
        Self::of(Cow::Borrowed(mechanism), t, q, decision)
    }

    /// The same of a mechanism that nobody else needs.
    pub(crate) fn of(
        mechanism: Cow<'a, Mechanism>,
        t: f64,
        q: &[f64],
        decision: &RankDecision,
    ) -> Result<Self, RequestError> {
        let layout = mechanism.layout();
        check("t", &[t], 1)?;
        check("q", q, layout.n_q)?;
        let scaling = &decision.scaling;
        let shape = [
            (
                "the rank decision, by rows,",
                scaling.rows.len(),
                layout.rows(),
            ),
            (
                "the rank decision, by columns,",
                scaling.cols.len(),
                layout.n_v,
            ),
        ];
        for (argument, found, expected) in shape {
            if found != expected {
                return Err(RequestError::Length {
                    argument,
                    found,
                    expected,
                });
            }
        }
        let s = evaluated(&mechanism, t, q);
        let size = scene_size(&mechanism, q);
        let c = dimensionless(&mechanism, &s, size);
        Ok(Self {
            uncertainty: uncertainty(&mechanism, &s, size),
            mechanism,
            s,
            size,
            solvability: Solvability::from_decision(&c, decision.clone()),
        })
    }

    /// What can be said of the multipliers.
    #[must_use]
    pub fn solvability(&self) -> &Solvability {
        &self.solvability
    }

    /// The verdict of a number.
    ///
    /// # Errors
    /// [`RequestError::Length`]: the form belongs to another mechanism.
    pub fn judge(&self, form: &LinearForm) -> Result<Judgement, RequestError> {
        form.judge(&self.solvability)
    }

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
    /// point. Each body counts once.
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

    /// Adds `along · (map·λ)` for a map of some rows; forces count by their size in the plane,
    /// torques by the arm that forces may have.
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
        match id.0 < reactions {
            true => Ok(()),
            false => Err(RequestError::UnknownReaction {
                id: id.0,
                reactions,
            }),
        }
    }

    fn first_row(&self, id: ConstraintId) -> usize {
        self.mechanism.layout().groups[id.0].rows.start
    }
}

/// Unit vectors of the wrench.
const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
