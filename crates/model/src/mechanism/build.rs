//! Builds a mechanism from a description and reports all errors of the description together.

use std::ops::Range;

use joints::spec::ConstraintSpec;

use super::check;
use super::elements::{CountedAngle, LawStates, Owner};
use super::spins::free_spins;
use super::turn;
use super::work::held_bodies;
use super::{BuildError, Elements, FunctionForm, KernelInput, Mechanism, TimeFunction, initialise};
use crate::body::{BodyRecord, BodyRef, DescribedBody};
use crate::contact::ContactLimits;
use crate::description::{AnyDescription, MechanismDescription};
use crate::element::{
    AnyForce, BodySpace, FramedConstraint, PlacedArmature, PlacedConstraint, PlacedForce, Site,
    TurnedSlots,
};
use crate::function::Function;
use crate::group::{ConstraintGroup, ConstraintId, ConstraintKind};
use crate::observed::Observables;
use crate::rows::RowRanges;
use crate::space::SpaceKind;
use crate::system::{Layout, RowLabel};
use crate::tolerance::Tolerance;

/// Descriptions that [`Mechanism::build`] accepts. The descriptions are in the plane, in space, or
/// of a type for both.
pub trait Buildable {
    /// Returns the mechanism, or all errors of the description.
    #[doc(hidden)]
    fn built(&self) -> Result<Mechanism, Vec<BuildError>>;
}

impl<S: BodySpace> Buildable for MechanismDescription<S> {
    fn built(&self) -> Result<Mechanism, Vec<BuildError>> {
        let bodies = self.records();
        let errors = check::faults(self, &bodies);
        if !errors.is_empty() {
            return Err(errors);
        }
        let mut b = Builder::new(S::KIND, self.start_time);
        let is_early = |spec: &ConstraintSpec| spec.holonomic > 0;
        b.joints(self, &bodies, is_early);
        let first_drive = b.elements.constraints.len();
        for drive in &self.drives {
            let element = S::any_constraint(drive.element.clone());
            let element = turn::constraint(element, &bodies, &drive.bodies);
            b.constraint(
                &drive.name,
                ConstraintKind::Drive,
                &drive.bodies,
                element,
                std::slice::from_ref(&drive.motion),
                drive.tolerance,
            );
        }
        b.joints(self, &bodies, |spec| !is_early(spec));
        let drives = first_drive..first_drive + self.drives.len();
        let mut next = [0, drives.end];
        let joints = self.joints.iter().map(|j| {
            let next = &mut next[usize::from(!is_early(j.element.spec()))];
            *next += 1;
            *next - 1
        });
        b.number_rows(&joints.chain(drives).collect::<Vec<_>>());
        b.elements.controllers.clone_from(&self.controllers);
        for f in &self.forces {
            let turned = TurnedSlots::new(turn::principal(&bodies, &f.bodies));
            let kernels = S::any_force(f.element.clone());
            b.force(&f.name, &f.bodies, (kernels, turned), &f.functions);
        }
        for armature in &self.armatures {
            let element = S::any_constraint(armature.element.clone());
            let element = turn::constraint(element, &bodies, &armature.bodies);
            let inertia = armature.inertia;
            b.armature(&armature.joint, &armature.bodies, element, inertia);
        }
        let (space, gravity) = (S::KIND, S::point(self.gravity));
        let weight = bodies.iter().flat_map(|b| {
            let of_axis = move |k: usize| {
                if k < space.n_translations() {
                    b.mass * gravity[k]
                } else {
                    0.0
                }
            };
            (0..space.n_v()).map(of_axis)
        });
        let weight = weight.collect();
        let mut mechanism = b.finish(&self.name, bodies, weight);
        mechanism.tolerance = self.tolerance;
        mechanism.observed = self.observed.clone();
        let (q, _) = mechanism.described_state();
        initialise(&mut mechanism, &q);
        let spins = free_spins(&mechanism, &q);
        mechanism.set_free_spins(spins);
        Ok(mechanism)
    }
}

impl Buildable for AnyDescription {
    fn built(&self) -> Result<Mechanism, Vec<BuildError>> {
        match self {
            Self::Plane(d) => d.built(),
            Self::Space3(d) => d.built(),
        }
    }
}

impl Mechanism {
    /// Assembles a mechanism. Initial values are taken from the described configuration. Later,
    /// [`crate::start::assemble`] replaces them by the values at a consistent configuration.
    ///
    /// # Errors
    /// Returns an error with all errors of the description.
    pub fn build(d: &impl Buildable) -> Result<Self, Vec<BuildError>> {
        d.built()
    }

    /// Sets the tolerance of the data for which neither the joint nor the body states a tolerance.
    ///
    /// # Errors
    /// [`BuildError::Tolerance`]: the tolerance is not a finite number > 0. In this case the
    /// mechanism does not change.
    pub fn set_tolerance(&mut self, tolerance: Tolerance) -> Result<(), BuildError> {
        check::tolerance(tolerance)?;
        self.tolerance = tolerance;
        Ok(())
    }

    /// Returns the mechanism without tolerances. The uncertainty of its values is their rounding
    /// error.
    #[must_use]
    pub fn without_tolerances(mut self) -> Self {
        self.tolerance = Tolerance::default();
        for body in &mut self.bodies {
            body.tolerance = None;
        }
        for c in &mut self.elements.constraints {
            c.tolerance = None;
        }
        for marker in &mut self.observed.markers {
            marker.tolerance = None;
        }
        self
    }
}

/// Builds the lists of a mechanism, element by element.
pub(super) struct Builder {
    pub(super) elements: Elements,
    pub(super) layout: Layout,
}

impl Builder {
    pub(super) fn new(space: SpaceKind, start_time: f64) -> Self {
        Self {
            elements: Elements::default(),
            layout: Layout {
                space,
                start_time,
                ..Layout::default()
            },
        }
    }

    /// Adds the joints whose definitions are of this kind.
    fn joints<S: BodySpace>(
        &mut self,
        d: &MechanismDescription<S>,
        bodies: &[BodyRecord],
        is_of_kind: impl Fn(&ConstraintSpec) -> bool,
    ) {
        for j in d.joints.iter().filter(|j| is_of_kind(j.element.spec())) {
            let (kind, element) = (ConstraintKind::Joint, S::any_constraint(j.element.clone()));
            let element = turn::constraint(element, bodies, &j.bodies);
            self.constraint(&j.name, kind, &j.bodies, element, &j.functions, j.tolerance);
            self.limit(&j.limits);
        }
    }

    pub(super) fn constraint(
        &mut self,
        name: &str,
        kind: ConstraintKind,
        bodies: &[BodyRef],
        framed: FramedConstraint,
        functions: &[Function],
        tolerance: Option<f64>,
    ) {
        let element = framed.kernels();
        let spec = element.spec();
        let first_entry = self.elements.entries.len();
        let entries = first_entry..first_entry + spec.c.len();
        self.elements.entries.resize(entries.end, 0.0);
        element.c_constant(&mut self.elements.entries[entries.clone()]);
        let offset = |f: &Function| match kind {
            ConstraintKind::Drive => f.jet(0.0)[0],
            ConstraintKind::Joint => 0.0,
        };
        let owner = Owner::Constraint(self.elements.constraints.len());
        let mut site = self.site(bodies, functions, offset, spec.turning);
        self.count(owner, spec.turns, &mut site);
        let placed = PlacedConstraint::new(framed, site, entries, tolerance);
        self.layout.rheonomic |= spec.rheonomic;
        self.layout.groups.push(ConstraintGroup {
            space: self.layout.space,
            name: name.to_owned(),
            kind,
            spec,
            bodies: bodies.to_vec(),
            rows: RowRanges::default(),
            limits: ContactLimits::default(),
        });
        self.elements.constraints.push(placed);
    }

    /// Sets the limits of the loads of the last constraint.
    pub(super) fn limit(&mut self, limits: &ContactLimits) {
        if let Some(group) = self.layout.groups.last_mut() {
            group.limits.clone_from(limits);
        }
    }

    pub(super) fn force(
        &mut self,
        name: &str,
        bodies: &[BodyRef],
        (element, turned): (AnyForce, Option<TurnedSlots>),
        functions: &[Function],
    ) {
        let owner = Owner::Force(self.elements.forces.len());
        let mut site = self.site(bodies, functions, |_| 0.0, false);
        let values = self.elements.controllers.iter();
        let values = values.flat_map(|controller| &controller.values);
        let all = values.clone().count();
        self.elements.signals.resize(all, 0);
        let mut signals = 0;
        for (value, place) in values.zip(&mut self.elements.signals) {
            if value == name {
                *place = self.elements.given.len();
                self.elements.given.push(KernelInput::Signal);
                signals += 1;
            }
        }
        self.count(owner, element.spec().turns, &mut site);
        let n = element.n_states();
        if n > 0 {
            let first = self.elements.given.len();
            let states = std::iter::repeat_n(KernelInput::State, n);
            self.elements.given.extend(states);
            site.functions.end = first + n;
            let force = self.elements.forces.len();
            self.elements.states.push(LawStates { force, first, n });
        }
        let mut placed = PlacedForce::new(name, element, site, turned);
        placed.signals = signals;
        self.elements.block = self.elements.block.max(placed.columns.len());
        self.elements.forces.push(placed);
    }

    /// Adds the inertia of a joint coordinate, unless the inertia is zero.
    pub(super) fn armature(
        &mut self,
        joint: &str,
        bodies: &[BodyRef],
        framed: FramedConstraint,
        inertia: f64,
    ) {
        if inertia == 0.0 {
            return;
        }
        let site = self.site(bodies, &[], |_| 0.0, false);
        let measure = framed.kernels().spec().common.scene_type;
        let placed = PlacedArmature::new((joint, measure), inertia, framed, site);
        self.elements.armatures.push(placed);
    }

    /// Numbers the rows of all constraints and adds their labels, owners and patterns. The
    /// holonomic rows come first, in the order of the constraints; the nonholonomic rows follow in
    /// the order of the argument, which lists all constraints.
    pub(super) fn number_rows(&mut self, nonholonomic: &[usize]) {
        let constraints = &mut self.elements.constraints;
        let mut next = 0;
        let mut following = |n: usize| {
            next += n;
            next - n..next
        };
        for c in constraints.iter_mut() {
            c.rows.holonomic = following(c.spec().holonomic);
        }
        self.layout.m = following(0).end;
        for &id in nonholonomic {
            constraints[id].rows.nonholonomic = following(constraints[id].spec().nonholonomic());
        }
        self.layout.h = following(0).end - self.layout.m;
        self.layout.pattern.start.push(0);
        for (group, c) in self.layout.groups.iter_mut().zip(constraints) {
            group.rows.clone_from(&c.rows);
        }
        for id in 0..self.layout.groups.len() {
            self.pattern_of(id, |rows| rows.holonomic.clone());
        }
        for &id in nonholonomic {
            self.pattern_of(id, |rows| rows.nonholonomic.clone());
        }
    }

    /// Appends the labels, owners and patterns of rows of one constraint.
    fn pattern_of(&mut self, id: usize, of: fn(&RowRanges) -> Range<usize>) {
        let (layout, first_entry) = (
            &mut self.layout,
            self.elements.constraints[id].entries.start,
        );
        let (group, columns) = (&layout.groups[id], layout.space.n_v());
        for i in of(&group.rows) {
            let Some(own) = group.rows.own(i) else {
                continue;
            };
            layout.owners.push(ConstraintId(id));
            layout.labels.push(RowLabel {
                number: i + 1,
                joint: group.name.clone(),
                row: group.spec.rows[own].name,
            });
            let entries = group.spec.c.iter().enumerate();
            for (at, e) in entries.filter(|(_, e)| e.row == own) {
                if let BodyRef::Body(body) = group.bodies[e.slot] {
                    layout.pattern.column.push(columns * body + e.dof);
                    layout.pattern.entry.push(first_entry + at);
                }
            }
            layout.pattern.start.push(layout.pattern.column.len());
        }
    }

    /// Returns the indices of the next element. The element has these bodies and functions of time.
    /// `offset` is subtracted from the functions. If `turning` is true, the kernels receive the
    /// cosine and the sine of the functions.
    fn site(
        &mut self,
        bodies: &[BodyRef],
        functions: &[Function],
        offset: impl Fn(&Function) -> f64,
        turning: bool,
    ) -> Site {
        let (first_slot, first) = (self.elements.n_slots, self.elements.given.len());
        self.elements.n_slots += bodies.len();
        for function in functions {
            self.layout.break_times.extend(function.break_times());
            let forms: &[FunctionForm] = if turning {
                &[FunctionForm::Cosine, FunctionForm::Sine]
            } else {
                &[FunctionForm::Value]
            };
            let given = forms.iter().map(|&form| {
                KernelInput::Function(TimeFunction {
                    function: function.clone(),
                    offset: offset(function),
                    form,
                })
            });
            self.elements.given.extend(given);
        }
        Site {
            space: self.layout.space,
            bodies: bodies.to_vec(),
            slots: first_slot..self.elements.n_slots,
            functions: first..self.elements.given.len(),
        }
    }

    /// Adds the unwrapped angles of an element. The unwrapped angles come after the functions of
    /// time of the element.
    fn count(&mut self, owner: Owner, turns: usize, site: &mut Site) {
        for number in 0..turns {
            let first = self.elements.given.len();
            self.elements.given.extend([
                KernelInput::Counted,
                KernelInput::Counted,
                KernelInput::Counted,
            ]);
            self.elements.counted.push(CountedAngle {
                owner,
                number,
                first,
            });
        }
        site.functions.end = self.elements.given.len();
    }

    /// Returns the mechanism with these bodies and with constraints whose rows are numbered.
    /// Initial values and arms are set later.
    pub(super) fn finish(
        mut self,
        name: &str,
        bodies: Vec<BodyRecord>,
        weight: Vec<f64>,
    ) -> Mechanism {
        let space = self.layout.space;
        self.layout.turns = self.elements.counted.len();
        self.layout.states = self.elements.states.iter().map(|own| own.n).sum();
        let counted = self.layout.turns + self.layout.states;
        self.layout.n_q = space.n_q() * bodies.len() + counted;
        self.layout.n_v = space.n_v() * bodies.len();
        self.layout.break_times.sort_by(f64::total_cmp);
        self.layout.break_times.dedup();
        let mass = bodies.iter();
        Mechanism {
            name: name.to_owned(),
            mass: mass.flat_map(inertia).collect(),
            free_spins: Vec::new(),
            weight,
            tolerance: Tolerance::default(),
            observed: Observables::default(),
            reach: vec![0.0; bodies.len()],
            held: held_bodies(&self.elements, &self.layout, bodies.len()),
            elements: self.elements,
            layout: self.layout,
            bodies,
        }
    }
}

/// Returns the entries of a body on the diagonal of M.
fn inertia(body: &BodyRecord) -> Vec<f64> {
    let m = body.mass;
    match &body.described {
        DescribedBody::Plane(b) => vec![m, m, b.inertia],
        DescribedBody::Space3(b) => {
            let diagonal = [0, 1, 2].map(|k| b.inertia[k][k]);
            let own = body.principal.as_ref();
            let [x, y, z] = own.map_or(diagonal, |own| own.moments.map(|j| j.max(0.0)));
            vec![m, m, m, x, y, z]
        }
    }
}

#[cfg(test)]
mod tests;
