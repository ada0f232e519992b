//! From multipliers to reactions: force and torque on the first body of the joint, at the place of
//! the joint.
//!
//! The reaction is the total effect of the joint on that body, so that M·a − Q of the body is the
//! sum of its reactions. If the first body has several slots, like the ground that is also the
//! carrier of a gear, their parts are added.

use joints::Direction;
use linalg::Matrix;

use crate::description::BodyRef;
use crate::mechanism::{Mechanism, PlacedConstraint};
use crate::system::{Layout, Scratch, System};

pub use crate::group::{ColumnKind, ConstraintGroup, ConstraintId, ConstraintKind};

/// A row counts as vanishing on rigid motions below this fraction of its terms, which allows for
/// the rounding of common points far from the origin. Rows above it are assumed to act against the
/// ground, which is the cautious choice.
const ROUNDING: f64 = 1e-10;

/// Axes in which the force of a reaction is expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The global x and y.
    Global,
    /// The x and y axes of the first body of the joint; global for the ground.
    FirstBody,
    /// The only direction in which the joint can transmit a force, followed by the direction
    /// rotated by +90°: normal and along for a knife edge, across and along the axis for a slot.
    /// Joints with no row, or several rows, that have a force do not have this frame.
    Edge,
}

impl Frame {
    /// All frames.
    pub const ALL: [Self; 3] = [Self::Global, Self::FirstBody, Self::Edge];
}

/// A reaction: force (global components, N) and torque about the place (N·m), on the first body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reaction {
    /// Force Fx, Fy (N).
    pub force: [f64; 2],
    /// Torque T (N·m).
    pub torque: f64,
    /// The named component of the definition: `N` of a knife edge, `drive` of a drive.
    pub component: Option<f64>,
}

/// Computes the reactions of a mechanism at the poses of a scratch.
///
/// Methods panic if the mechanism has no such joint or drive.
#[derive(Clone, Copy)]
pub struct Reactions<'a> {
    mechanism: &'a Mechanism,
    s: &'a Scratch,
}

impl Mechanism {
    /// Its reactions at the poses of the scratch.
    #[must_use]
    pub fn reactions<'a>(&'a self, s: &'a Scratch) -> Reactions<'a> {
        Reactions { mechanism: self, s }
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
        &self.mechanism.elements.constraints[id.0]
    }

    /// The point where the reaction of a joint or drive is reported, global components.
    #[must_use]
    pub fn place(self, id: ConstraintId) -> [f64; 2] {
        let c = self.constraint(id);
        c.element.place(c.site.x(&self.s.slots))
    }

    /// The map `W` (3 × rows) with `[Fx, Fy, T] = W·λ`; allocates.
    #[must_use]
    pub fn wrench_map(self, id: ConstraintId) -> Matrix {
        let mut map = Matrix::zeros(self.layout().space.n_v(), self.group(id).rows.len());
        self.visit_wrench(id, &mut Vec::new(), |component, row, value| {
            map[(component, row)] += value;
        });
        map
    }

    /// Visits the terms of this map: component, row and value. `block` is storage.
    fn visit_wrench(
        self,
        id: ConstraintId,
        block: &mut Vec<f64>,
        mut visit: impl FnMut(usize, usize, f64),
    ) {
        let (group, c) = (self.group(id), self.constraint(id));
        let element = &c.element;
        let (x, f) = (c.site.x(&self.s.slots), c.site.f(&self.s.slots));
        block.clear();
        block.resize(group.spec.wrench.len(), 0.0);
        element.wrench(x, f, block);
        for (&[component, row], value) in group.spec.wrench.iter().zip(&*block) {
            visit(component, row, *value);
        }
        if !group.repeats_first_body() {
            return;
        }
        // −Cᵀ of the other slots that the first body takes, moved from its origin to the place.
        block.clear();
        block.resize(group.spec.c.len(), 0.0);
        element.c_constant(block);
        element.c(x, f, block);
        let [px, py] = element.place(x);
        let lever = [px - x[0].x, py - x[0].y];
        for (at, e) in group.repeated() {
            visit(e.dof, e.row, -block[at]);
            match e.dof {
                0 => visit(2, e.row, -(lever[1] * block[at])),
                1 => visit(2, e.row, lever[0] * block[at]),
                _ => {}
            }
        }
    }

    /// Like [`Self::wrench_map`], with the torque about a global point: `T + (place − about) × F`.
    #[must_use]
    pub fn wrench_map_about(self, id: ConstraintId, about: [f64; 2]) -> Matrix {
        let mut map = self.wrench_map(id);
        let [x, y] = self.place(id);
        let arm = [x - about[0], y - about[1]];
        for j in 0..map.ncols() {
            map[(2, j)] += arm[0] * map[(1, j)] - arm[1] * map[(0, j)];
        }
        map
    }

    /// The map (3 × m + h) from all multipliers to the total of the reactions on one body, `−Cᵀ·λ`:
    /// force, and torque about a global point. Returns `None` if there is no such body. Needs C at
    /// the pose of the scratch; allocates.
    #[must_use]
    pub fn body_wrench_map(self, body: usize, about: [f64; 2]) -> Option<Matrix> {
        let pose = self.s.poses.get(body)?;
        let arm = [pose.x - about[0], pose.y - about[1]];
        let layout = self.layout();
        let mut map = Matrix::zeros(self.layout().space.n_v(), layout.rows());
        for i in 0..layout.rows() {
            for (column, c) in layout
                .row(self.s, i)
                .filter(|(k, _)| layout.space.body_of(*k) == body)
            {
                map[(layout.space.dof_of(column), i)] -= c;
            }
            map[(2, i)] += arm[0] * map[(1, i)] - arm[1] * map[(0, i)];
        }
        Some(map)
    }

    /// Unit vectors (global components) of the axes in which the force of a reaction is expressed.
    /// The first axis of [`Frame::Edge`] has the sign for which the named component of the
    /// definition, or else the multiplier, is positive. Returns `None` if the reaction has no such
    /// frame.
    #[must_use]
    pub fn axes(self, id: ConstraintId, frame: Frame) -> Option<[[f64; 2]; 2]> {
        let first = match (frame, self.group(id).bodies.first()) {
            (Frame::Edge, _) => self.push(id)?,
            (Frame::FirstBody, Some(BodyRef::Body(k))) => {
                [self.s.poses[*k].cos, self.s.poses[*k].sin]
            }
            _ => [1.0, 0.0],
        };
        Some([first, [-first[1], first[0]]])
    }

    /// The direction of the only row of a joint or drive that has a force.
    fn push(self, id: ConstraintId) -> Option<[f64; 2]> {
        let group = self.group(id);
        let spec = group.spec;
        let rows: Vec<usize> = (0..spec.rows.len()).filter(|&r| group.pushes(r)).collect();
        let [row] = rows[..] else { return None };
        let map = self.wrench_map(id);
        let named = spec
            .component
            .and_then(|name| self.component_coefficients(id, name));
        let sign = named.map_or(1.0, |coefficients| coefficients[row].signum());
        let push = Direction::new([map[(0, row)], map[(1, row)]])?.xy();
        // A zero has no sign.
        Some(push.map(|x| sign * x + 0.0))
    }

    /// Coefficients of a component of a reaction, `Σ coefficient·λ` over the rows of the joint or
    /// drive: `Fx`, `Fy`, `T`, or the named component of its definition. Returns `None` if it has
    /// no such component; allocates.
    #[must_use]
    pub fn component_coefficients(self, id: ConstraintId, name: &str) -> Option<Vec<f64>> {
        if let Some(k) = self.layout().space.component(name) {
            return Some(self.wrench_map(id).row(k).to_vec());
        }
        let c = self.constraint(id);
        let element = &c.element;
        (element.spec().component == Some(name)).then(|| {
            let mut coefficients = vec![0.0; c.rows.len()];
            let slots = &self.s.slots;
            element.component(c.site.x(slots), c.site.f(slots), &mut coefficients);
            coefficients
        })
    }

    /// The reaction of a joint or drive for multipliers λ (all rows); allocates. Panics if λ is too
    /// short.
    #[must_use]
    pub fn reaction(self, id: ConstraintId, lambda: &[f64]) -> Reaction {
        self.reaction_in(&mut Vec::new(), id, lambda)
    }

    /// The same with storage that may serve again: from the second reaction of this size on,
    /// nothing is allocated.
    #[must_use]
    pub fn reaction_in(self, block: &mut Vec<f64>, id: ConstraintId, lambda: &[f64]) -> Reaction {
        let (group, c) = (self.group(id), self.constraint(id));
        let lambda = &lambda[group.rows.clone()];
        // Of multipliers that there are not, no component is known.
        let mut wrench = [lambda.iter().map(|l| l * 0.0).sum::<f64>() + 0.0; 3];
        self.visit_wrench(id, block, |component, row, value| {
            wrench[component] += value * lambda[row];
        });
        let component = group.spec.component.map(|_| {
            block.clear();
            block.resize(lambda.len(), 0.0);
            let (x, f) = (c.site.x(&self.s.slots), c.site.f(&self.s.slots));
            c.element.component(x, f, block);
            block.iter().zip(lambda).map(|(k, l)| k * l).sum()
        });
        let [fx, fy, torque] = wrench;
        Reaction {
            force: [fx, fy],
            torque,
            component,
        }
    }

    /// Whether a joint or drive acts against the ground: one of its rows does not vanish if all
    /// bodies move as one rigid body. This does not follow from the list of its bodies: an absolute
    /// velocity refers to the ground without listing it. Needs C at the pose of the scratch.
    #[must_use]
    pub fn acts_on_ground(self, id: ConstraintId) -> bool {
        let [x, y] = self.place(id);
        let space = self.layout().space;
        // Two translations and the rotation about the place of the joint.
        let motions = |column: usize| {
            let pose = &self.s.poses[space.body_of(column)];
            [
                [1.0, 0.0, y - pose.y],
                [0.0, 1.0, pose.x - x],
                [0.0, 0.0, 1.0],
            ][space.dof_of(column)]
        };
        self.group(id).rows.clone().any(|row| {
            let mut sums = [0.0; 3];
            let mut sizes = [0.0_f64; 3];
            for (column, c) in self.layout().row(self.s, row) {
                for (k, motion) in motions(column).into_iter().enumerate() {
                    sums[k] += c * motion;
                    sizes[k] += (c * motion).abs();
                }
            }
            (0..3).any(|k| sums[k].abs() > ROUNDING * sizes[k])
        })
    }
}
