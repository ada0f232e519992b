//! Computes reactions from multipliers. A reaction consists of the force and the torque on the
//! first body of the joint, at the reference point of the joint.
//!
//! The reaction is the total effect of the joint on this body. For each body, M·a − Q is the sum of
//! its reactions. If the first body occurs more than once in the list of bodies (for example, the
//! ground is also the carrier of a gear), the loads of all its positions are added.

use joints::Direction;
use linalg::Matrix;

use crate::body::BodyRef;
use crate::element::PlacedConstraint;
use crate::mechanism::Mechanism;
pub use crate::space::Frame;
use crate::space::{SpaceKind, cross, difference, unit_cross};
use crate::system::{Layout, Scratch, System};

pub use crate::group::{ColumnKind, ConstraintGroup, ConstraintId, ConstraintKind};

/// The value of a row on rigid motions counts as zero below this fraction of the terms of the row.
/// The fraction allows for the rounding of common points far from the origin. Rows with larger
/// values are assumed to act against the ground, which is the safe assumption.
const ROUNDING: f64 = 1e-10;

/// The axes of the ground, computed like the axes of a body. The second axis has the values of a
/// body with rotation angle zero, including the sign of the zero.
const GROUND_AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [-0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A reaction on the first body: force, and torque about the reference point, in ground axes. In
/// the plane, the force has no z component, and the torque has only a z component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reaction {
    /// Force (N).
    pub force: [f64; 3],
    /// Torque (N·m).
    pub torque: [f64; 3],
    /// The component named by the definition, for example `N` of a knife edge or `drive` of a
    /// drive.
    pub component: Option<f64>,
}

impl Reaction {
    /// Returns a reaction with these components, in the order of [`SpaceKind::components`].
    #[must_use]
    pub fn new(space: SpaceKind, components: &[f64], component: Option<f64>) -> Self {
        let mut reaction = Self {
            component,
            ..Self::default()
        };
        for (k, value) in components.iter().enumerate() {
            *reaction.of_mut(space, k) = *value;
        }
        reaction
    }

    fn of_mut(&mut self, space: SpaceKind, component: usize) -> &mut f64 {
        let axis = space.axis_of(component);
        if space.forces().contains(&component) {
            &mut self.force[axis]
        } else {
            &mut self.torque[axis]
        }
    }

    /// Returns the force and the torque minus the force and the torque of another wrench about the
    /// same point.
    pub(crate) fn minus(mut self, other: Self) -> Self {
        for (own, x) in self.force.iter_mut().zip(other.force) {
            *own -= x;
        }
        for (own, x) in self.torque.iter_mut().zip(other.torque) {
            *own -= x;
        }
        self
    }

    /// Returns the components of force and torque along these axes.
    #[must_use]
    pub fn along(self, axes: [[f64; 3]; 3]) -> Self {
        let along = |v: [f64; 3]| axes.map(|a| a[0] * v[0] + a[1] * v[1] + a[2] * v[2]);
        Self {
            force: along(self.force),
            torque: along(self.torque),
            ..self
        }
    }

    /// Returns the components of force and torque, in the order of [`SpaceKind::components`].
    ///
    /// ```
    /// use pfaff_model::{Reaction, SpaceKind};
    /// let reaction = Reaction::new(SpaceKind::Plane, &[1.0, 2.0, 3.0], None);
    /// assert_eq!((reaction.force, reaction.torque), ([1.0, 2.0, 0.0], [0.0, 0.0, 3.0]));
    /// assert!(reaction.components(SpaceKind::Plane).eq([1.0, 2.0, 3.0]));
    /// ```
    pub fn components(self, space: SpaceKind) -> impl Iterator<Item = f64> {
        let mut reaction = self;
        (0..space.n_v()).map(move |k| *reaction.of_mut(space, k))
    }
}

/// Unit vectors of axes in ground components. The number of axes is the number of dimensions of the
/// space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Axes {
    axes: [[f64; 3]; 3],
    count: usize,
}

impl std::ops::Deref for Axes {
    type Target = [[f64; 3]];

    fn deref(&self) -> &Self::Target {
        &self.axes[..self.count]
    }
}

/// Computes the reactions of a mechanism at the configuration in a work space.
///
/// Methods panic if the joint or drive does not exist.
#[derive(Clone, Copy)]
pub struct Reactions<'a> {
    mechanism: &'a Mechanism,
    s: &'a Scratch,
    /// A constraint that replaces the corresponding constraint of the mechanism.
    other: Option<&'a ConstraintCopy>,
}

/// A copy of a joint or drive of a mechanism. The stored values of the copy may differ.
#[derive(Clone)]
pub struct ConstraintCopy {
    id: ConstraintId,
    placed: PlacedConstraint,
}

impl ConstraintCopy {
    /// Replaces the stored values, in the order of [`crate::data::Data::numbers`]. These include
    /// the stored initial values. Axes are rotated from their current orientation by the given
    /// rotation vector.
    ///
    /// # Panics
    /// Panics if there are fewer values than the constraint stores.
    pub fn set_numbers(&mut self, own: &[f64]) {
        self.placed.set_data(own);
    }
}

impl Mechanism {
    /// Returns the reactions at the configuration in the work space.
    #[must_use]
    pub fn reactions<'a>(&'a self, s: &'a Scratch) -> Reactions<'a> {
        Reactions {
            mechanism: self,
            s,
            other: None,
        }
    }

    /// Returns a copy of a joint or drive, and panics if it does not exist. The function allocates
    /// memory.
    #[must_use]
    pub fn copy_of(&self, id: ConstraintId) -> ConstraintCopy {
        ConstraintCopy {
            id,
            placed: self.elements.constraints[id.0].clone(),
        }
    }
}

impl<'a> Reactions<'a> {
    fn layout(self) -> &'a Layout {
        self.mechanism.layout()
    }

    fn group(self, id: ConstraintId) -> &'a ConstraintGroup {
        &self.layout().groups[id.0]
    }

    fn constraint(self, id: ConstraintId) -> &'a PlacedConstraint {
        match self.other {
            Some(other) if other.id == id => &other.placed,
            _ => &self.mechanism.elements.constraints[id.0],
        }
    }

    /// Returns the reactions of the mechanism with this copy in place of the original joint or
    /// drive.
    #[must_use]
    pub fn with(self, other: &'a ConstraintCopy) -> Self {
        Self {
            other: Some(other),
            ..self
        }
    }

    /// Returns the space of the mechanism.
    #[must_use]
    pub fn space(self) -> SpaceKind {
        self.layout().space
    }

    /// Returns the reference point of the reaction of a joint or drive (m), in ground axes.
    #[must_use]
    pub fn place(self, id: ConstraintId) -> [f64; 3] {
        self.constraint(id).place(&self.s.slots)
    }

    /// Returns the map `W` (components × rows) with `[F, T] = W·λ`, in the order of
    /// [`SpaceKind::components`]. The function allocates memory.
    #[must_use]
    pub fn wrench_map(self, id: ConstraintId) -> Matrix {
        let rows = self.group(id).rows.len();
        let mut map = Matrix::zeros(self.layout().space.n_v(), rows);
        self.visit_wrench(id, &mut Vec::new(), |component, row, value| {
            map[(component, row)] += value;
        });
        map
    }

    /// Calls a function for each term of this map. The arguments are the component, the row and the
    /// value. `block` is a buffer.
    fn visit_wrench(
        self,
        id: ConstraintId,
        block: &mut Vec<f64>,
        mut visit: impl FnMut(usize, usize, f64),
    ) {
        let (group, c, slots) = (self.group(id), self.constraint(id), &self.s.slots);
        block.clear();
        block.resize(group.spec.wrench.len(), 0.0);
        c.wrench(slots, block);
        for (&[component, row], value) in group.spec.wrench.iter().zip(&*block) {
            visit(component, row, *value);
        }
        if !group.repeats_first_body() {
            return;
        }
        // Adds −Cᵀ for the other positions of the first body in the list of bodies. The torque is
        // transferred from the origin of the body to the reference point.
        block.clear();
        block.resize(group.spec.c.len(), 0.0);
        c.kernels().c_constant(block);
        c.c(slots, block);
        let (space, arm) = (
            group.space,
            difference(c.first_origin(slots), c.place(slots)),
        );
        for (at, e) in group.repeated() {
            visit(e.dof, e.row, -block[at]);
            if space.forces().contains(&e.dof) {
                let mut force = [0.0; 3];
                force[e.dof] = -block[at];
                let turned = space.torques();
                for k in turned.filter(|k| space.axis_of(*k) != e.dof) {
                    visit(k, e.row, cross(arm, force)[space.axis_of(k)]);
                }
            }
        }
    }

    /// Works like [`Self::wrench_map`], with the torque about a point (m, ground axes):
    /// `T + (place − about) × F`.
    #[must_use]
    pub fn wrench_map_about(self, id: ConstraintId, about: [f64; 3]) -> Matrix {
        let mut map = self.wrench_map(id);
        let arm = difference(self.place(id), about);
        for j in 0..map.ncols() {
            add_moment(self.layout().space, &mut map, j, arm);
        }
        map
    }

    /// Returns the map (components × m + h) from all multipliers to the sum of the reactions on one
    /// body, `−Cᵀ·λ`. The rows are the force and the torque about a point (m, ground axes). Returns
    /// `None` if the body does not exist. The work space must contain C at its configuration. The
    /// function allocates memory.
    #[must_use]
    pub fn body_wrench_map(self, body: usize, about: [f64; 3]) -> Option<Matrix> {
        if body >= self.s.bodies.len() {
            return None;
        }
        let arm = difference(self.s.bodies.origin(body), about);
        let (layout, space) = (self.layout(), self.layout().space);
        let mut map = Matrix::zeros(space.n_v(), layout.rows());
        for i in 0..layout.rows() {
            for (column, c) in layout.row(self.s, i) {
                if space.body_of(column) == body {
                    self.visit_ground(column, |component, share| map[(component, i)] -= share * c);
                }
            }
            add_moment(space, &mut map, i, arm);
        }
        Some(map)
    }

    /// For a column of C, calls `visit` with each component of force and torque in ground axes and
    /// the share of the column in this component. The rotations of a spatial body are about the
    /// axes of the body.
    fn visit_ground(self, column: usize, mut visit: impl FnMut(usize, f64)) {
        let space = self.layout().space;
        let dof = space.dof_of(column);
        if space.n_rotations() == 1 || space.forces().contains(&dof) {
            return visit(dof, 1.0);
        }
        let axis = self.s.bodies.axes(space.body_of(column))[space.axis_of(dof)];
        for component in space.torques() {
            visit(component, axis[space.axis_of(component)]);
        }
    }

    /// Returns the axes in which a reaction is expressed. The sign of the first axis of
    /// [`Frame::Edge`] is chosen so that the component named by the definition is positive, or that
    /// the multiplier is positive if there is no named component. Returns `None` if the reaction
    /// has no frame of this kind.
    #[must_use]
    pub fn axes(self, id: ConstraintId, frame: Frame) -> Option<Axes> {
        let axes = match (frame, self.group(id).bodies.first()) {
            (Frame::Edge, _) => {
                let [x, y] = self.push(id)?;
                [[x, y, 0.0], [-y, x, 0.0], GROUND_AXES[2]]
            }
            (Frame::Joint, first) => {
                let own = self.constraint(id).axes()?;
                let frame = first.map_or(GROUND_AXES, |body| self.frame_axes(*body));
                let turned = |[u, v, w]: [f64; 3]| {
                    std::array::from_fn(|k| u * frame[0][k] + v * frame[1][k] + w * frame[2][k])
                };
                own.map(turned)
            }
            (Frame::FirstBody, Some(body)) => self.frame_axes(*body),
            _ => GROUND_AXES,
        };
        let count = self.layout().space.n_translations();
        Some(Axes { axes, count })
    }

    /// Returns the axes of a body frame, in ground axes.
    #[must_use]
    pub fn frame_axes(self, body: BodyRef) -> [[f64; 3]; 3] {
        let Some(k) = body.moving() else {
            return GROUND_AXES;
        };
        let own = self.s.bodies.axes(k);
        let principal = self.mechanism.bodies()[k].principal.as_ref();
        principal.map_or(own, |of| of.framed(own))
    }

    /// Returns the direction, in the plane, of the force of a joint or drive. The result exists
    /// only if exactly one row has a force. In space, the result is `None`, because one direction
    /// does not define a unique perpendicular direction.
    fn push(self, id: ConstraintId) -> Option<[f64; 2]> {
        let group = self.group(id);
        if group.space.n_translations() > 2 {
            return None;
        }
        let spec = group.spec;
        let rows: Vec<usize> = (0..spec.rows.len()).filter(|&r| group.pushes(r)).collect();
        let [row] = rows[..] else { return None };
        let map = self.wrench_map(id);
        let named = spec
            .component
            .and_then(|name| self.component_coefficients(id, name));
        let sign = named.map_or(1.0, |coefficients| coefficients[row].signum());
        let push = Direction::new([map[(0, row)], map[(1, row)]])?.xy();
        // Adding zero removes the sign of a negative zero.
        Some(push.map(|x| sign * x + 0.0))
    }

    /// Returns the coefficients of a component of a reaction, `Σ coefficient·λ` over the rows of
    /// the joint or drive. `name` is one of [`SpaceKind::components`], or the component named by
    /// the definition. Returns `None` if the component does not exist. The function allocates
    /// memory.
    #[must_use]
    pub fn component_coefficients(self, id: ConstraintId, name: &str) -> Option<Vec<f64>> {
        if let Some(k) = self.layout().space.component(name) {
            return Some(self.wrench_map(id).row(k).to_vec());
        }
        let c = self.constraint(id);
        (c.spec().component == Some(name)).then(|| {
            let mut coefficients = vec![0.0; c.rows.len()];
            c.component(&self.s.slots, &mut coefficients);
            coefficients
        })
    }

    /// Returns the reaction of a joint or drive for multipliers λ (all rows). The function panics
    /// if λ is too short. The function allocates memory.
    #[must_use]
    pub fn reaction(self, id: ConstraintId, lambda: &[f64]) -> Reaction {
        self.reaction_in(&mut Vec::new(), id, lambda)
    }

    /// Works like [`Self::reaction`], with a reusable buffer. After the first reaction of this
    /// size, the function does not allocate memory.
    #[must_use]
    pub fn reaction_in(self, block: &mut Vec<f64>, id: ConstraintId, lambda: &[f64]) -> Reaction {
        let (group, c) = (self.group(id), self.constraint(id));
        let early = &lambda[group.rows.holonomic.clone()];
        let late = &lambda[group.rows.nonholonomic.clone()];
        let of_row = |own: usize| match early.get(own) {
            Some(lambda) => *lambda,
            None => late[own - early.len()],
        };
        // If a multiplier is not known (NaN), the components are not known, either.
        let nothing = |lambda: &[f64]| lambda.iter().map(|l| l * 0.0).sum::<f64>();
        let none = nothing(early) + nothing(late) + 0.0;
        let space = group.space;
        let mut wrench = Reaction::default();
        (0..space.n_v()).for_each(|k| *wrench.of_mut(space, k) = none);
        self.visit_wrench(id, block, |component, row, value| {
            *wrench.of_mut(space, component) += value * of_row(row);
        });
        wrench.component = group.spec.component.map(|_| {
            block.clear();
            block.resize(group.rows.len(), 0.0);
            c.component(&self.s.slots, block);
            let product = |k: &[f64], l: &[f64]| k.iter().zip(l).map(|(k, l)| k * l).sum::<f64>();
            product(block, early) + product(&block[early.len()..], late)
        });
        wrench
    }

    /// Returns whether a joint or drive acts against the ground. A joint or drive acts against the
    /// ground if one of its rows is not zero when all bodies move together as one rigid body. The
    /// list of bodies is not sufficient for this decision, because an absolute velocity refers to
    /// the ground without listing it. The work space must contain C at its configuration.
    #[must_use]
    pub fn acts_on_ground(self, id: ConstraintId) -> bool {
        let (space, place) = (self.layout().space, self.place(id));
        // The velocity component of a column of C in each of the rigid motions. The rigid motions
        // are translations along the axes, and rotations about the axes through the reference point
        // of the joint.
        let velocities = |column: usize| {
            let mut found = [0.0; 6];
            self.visit_ground(column, |motion, share| found[motion] += share);
            let dof = space.dof_of(column);
            if space.forces().contains(&dof) {
                let arm = difference(self.s.bodies.origin(space.body_of(column)), place);
                for motion in space.torques() {
                    found[motion] = unit_cross(space.axis_of(motion), arm)[dof];
                }
            }
            found
        };
        self.group(id).rows.iter().any(|row| {
            let mut sums = [[0.0_f64; 2]; 6];
            for (column, c) in self.layout().row(self.s, row) {
                for ([sum, size], v) in sums.iter_mut().zip(velocities(column)) {
                    *sum += c * v;
                    *size += f64::abs(c * v);
                }
            }
            let is_moved = |[sum, size]: [f64; 2]| sum.abs() > ROUNDING * size;
            sums.into_iter().any(is_moved)
        })
    }
}

/// Adds the moment of the force to the torque in a column of a map: `T + arm × F`.
fn add_moment(space: SpaceKind, map: &mut Matrix, column: usize, arm: [f64; 3]) {
    let mut force = [0.0; 3];
    for k in space.forces() {
        force[space.axis_of(k)] = map[(k, column)];
    }
    let moment = cross(arm, force);
    for k in space.torques() {
        map[(k, column)] += moment[space.axis_of(k)];
    }
}

#[cfg(test)]
mod tests;
