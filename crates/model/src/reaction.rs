//! From multipliers to what an engineer calls a reaction: force and torque on the first body of the
//! joint, at the joint's place.
//!
//! It is all that the joint does to that body, so that M·a − Q of the body is the sum of the
//! reactions on it. Where the first body takes several slots, as the ground may that is also the
//! carrier of a gear, their parts add up.

use std::ops::Range;

use joints::Direction;
use joints::spec::{ConstraintSpec, Entry};
use linalg::Matrix;

use crate::description::BodyRef;
use crate::mechanism::{Mechanism, N_BODY};
use crate::system::{Scratch, System};

/// Place of a joint or drive in [`crate::Layout::groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ConstraintId(pub usize);

/// A joint or a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintKind {
    /// Connects bodies.
    Joint,
    /// Prescribes a relative motion.
    Drive,
}

/// A joint or drive with its rows.
#[derive(Clone, Debug)]
pub struct ConstraintGroup {
    /// Its name.
    pub name: String,
    /// Joint or drive.
    pub kind: ConstraintKind,
    /// Facts of its definition.
    pub spec: &'static ConstraintSpec,
    /// Its bodies.
    pub bodies: Vec<BodyRef>,
    /// Its rows of C.
    pub rows: Range<usize>,
}

/// Names of the three components of a planar wrench.
pub const COMPONENTS: [&str; 3] = ["Fx", "Fy", "T"];

/// Place of the torque in [`COMPONENTS`], and of the rotation among the degrees of freedom of a
/// body.
const TORQUE: usize = 2;

impl ConstraintGroup {
    /// Whether it only prescribes a motion: a drive, listed apart from the joints.
    #[must_use]
    pub fn is_drive(&self) -> bool {
        self.kind == ConstraintKind::Drive
    }

    /// Components of the reaction that are not identically zero, as places in [`COMPONENTS`].
    #[must_use]
    pub fn components(&self) -> Vec<usize> {
        let entries = self.wrench_entries();
        (0..COMPONENTS.len())
            .filter(|c| entries.iter().any(|[component, _]| component == c))
            .collect()
    }

    /// Entries (component, row) of the map from multipliers to the reaction that are not
    /// identically zero, sorted.
    #[must_use]
    pub fn wrench_entries(&self) -> Vec<[usize; 2]> {
        let mut entries = self.spec.wrench.to_vec();
        for (_, e) in self.repeated() {
            entries.push([TORQUE, e.row]);
            if e.dof < TORQUE {
                entries.push([e.dof, e.row]);
            }
        }
        entries.sort_unstable();
        entries.dedup();
        entries
    }

    /// Whether a row of this joint or drive has a force in its reaction.
    #[must_use]
    pub fn pushes(&self, row: usize) -> bool {
        let entries = self.wrench_entries();
        entries
            .iter()
            .any(|[component, at]| *at == row && *component < TORQUE)
    }

    /// Entries of the block of C, with their places in it, of other slots that the first body
    /// takes, too.
    fn repeated(&self) -> impl Iterator<Item = (usize, &'static Entry)> + '_ {
        let is_repeated = |e: &Entry| e.slot > 0 && self.bodies.get(e.slot) == self.bodies.first();
        self.spec
            .c
            .iter()
            .enumerate()
            .filter(move |(_, e)| is_repeated(e))
    }
}

/// Axes along which the force of a reaction is taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The global x and y.
    Global,
    /// The x and y of the first body of the joint; those of the ground are global.
    FirstBody,
    /// Along the one direction in which the joint can push, then across it (that turned by +90°):
    /// normal and along for a knife edge, across and along the axis for a slot. Joints with no row
    /// or several rows that push have no such frame.
    Edge,
}

impl Frame {
    /// All frames.
    pub const ALL: [Self; 3] = [Self::Global, Self::FirstBody, Self::Edge];

    /// Names of the components in this frame.
    #[must_use]
    pub fn components(self) -> [&'static str; 3] {
        match self {
            Self::Global => COMPONENTS,
            Self::FirstBody => ["Fx'", "Fy'", "T"],
            Self::Edge => ["Fn", "Ft", "T"],
        }
    }
}

/// What a column of C belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A velocity in m/s; the generalised force is a force.
    Translation,
    /// An angular velocity in rad/s; the generalised force is a torque.
    Rotation,
}

/// A reaction: force (global components, N) and torque about the place (N·m), on the first body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reaction {
    /// Fx, Fy
    pub force: [f64; 2],
    /// T
    pub torque: f64,
    /// The named component of the definition: `N` of a knife edge, `drive` of a drive.
    pub component: Option<f64>,
}

impl Mechanism {
    /// The map `W` (3 × rows) with `[Fx, Fy, T] = W·λ` at the poses of the scratch; allocates.
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn wrench_map(&self, id: ConstraintId, s: &Scratch) -> Matrix {
        let c = &self.constraints()[id.0];
        let spec = c.element.element().spec();
        let mut values = vec![0.0; spec.wrench.len()];
        let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
        c.element.element().wrench(x, f, &mut values);
        let mut map = Matrix::zeros(COMPONENTS.len(), c.rows.len());
        for (&[component, row], value) in spec.wrench.iter().zip(values) {
            map[(component, row)] = value;
        }
        self.add_repeated(id, s, &mut map);
        map
    }

    /// Adds −Cᵀ of the other slots that the first body takes, moved from its origin to the place.
    fn add_repeated(&self, id: ConstraintId, s: &Scratch, map: &mut Matrix) {
        let group = &self.layout().groups[id.0];
        if group.repeated().next().is_none() {
            return;
        }
        let c = &self.constraints()[id.0];
        let element = c.element.element();
        let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
        let mut block = vec![0.0; group.spec.c.len()];
        element.c_constant(&mut block);
        element.c(x, f, &mut block);
        let [px, py] = element.place(x);
        let lever = [px - x[0].x, py - x[0].y];
        for (at, e) in group.repeated() {
            let value = block[at];
            map[(e.dof, e.row)] -= value;
            match e.dof {
                0 => map[(TORQUE, e.row)] -= lever[1] * value,
                1 => map[(TORQUE, e.row)] += lever[0] * value,
                _ => {}
            }
        }
    }

    /// The same map with the torque about a global point: `T + (place − about) × F`.
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn wrench_map_about(&self, id: ConstraintId, about: [f64; 2], s: &Scratch) -> Matrix {
        let mut map = self.wrench_map(id, s);
        let [x, y] = self.place(id, s);
        let arm = [x - about[0], y - about[1]];
        for j in 0..map.ncols() {
            map[(2, j)] += arm[0] * map[(1, j)] - arm[1] * map[(0, j)];
        }
        map
    }

    /// The map (3 × m + h) from all multipliers to the total of the reactions on one body, `−Cᵀ·λ`:
    /// force, and torque about a global point. `None` if there is no such body. Needs C at the pose
    /// of the scratch; allocates.
    #[must_use]
    pub fn body_wrench_map(&self, body: usize, about: [f64; 2], s: &Scratch) -> Option<Matrix> {
        let pose = s.poses.get(body)?;
        let arm = [pose.x - about[0], pose.y - about[1]];
        let layout = self.layout();
        let mut map = Matrix::zeros(COMPONENTS.len(), layout.rows());
        for i in 0..layout.rows() {
            for (column, c) in layout.row(s, i).filter(|(k, _)| k / N_BODY == body) {
                map[(column % N_BODY, i)] -= c;
            }
            map[(2, i)] += arm[0] * map[(1, i)] - arm[1] * map[(0, i)];
        }
        Some(map)
    }

    /// Unit vectors (global components) of the axes in which the force of a reaction is taken
    /// apart. The first axis of [`Frame::Edge`] has the sign for which the named component of the
    /// definition, or else the multiplier, is positive. `None` if the reaction has no such frame.
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn axes(&self, id: ConstraintId, frame: Frame, s: &Scratch) -> Option<[[f64; 2]; 2]> {
        let group = &self.layout().groups[id.0];
        let first = match frame {
            Frame::Global => [1.0, 0.0],
            Frame::FirstBody => match group.bodies.first() {
                Some(BodyRef::Body(k)) => [s.poses[*k].cos, s.poses[*k].sin],
                Some(BodyRef::Ground) | None => [1.0, 0.0],
            },
            Frame::Edge => self.push(id, s)?,
        };
        Some([first, [-first[1], first[0]]])
    }

    /// The direction of the only row of a joint or drive that has a force.
    fn push(&self, id: ConstraintId, s: &Scratch) -> Option<[f64; 2]> {
        let group = &self.layout().groups[id.0];
        let spec = group.spec;
        let rows: Vec<usize> = (0..spec.rows.len()).filter(|&r| group.pushes(r)).collect();
        let [row] = rows[..] else { return None };
        let map = self.wrench_map(id, s);
        let named = spec
            .component
            .and_then(|name| self.component_coefficients(id, name, s));
        let sign = named.map_or(1.0, |coefficients| coefficients[row].signum());
        let push = Direction::new([map[(0, row)], map[(1, row)]])?.xy();
        Some(push.map(|x| sign * x))
    }

    /// What each column of C belongs to, n_v entries.
    #[must_use]
    pub fn column_kinds(&self) -> Vec<ColumnKind> {
        let kind = |k| match k % N_BODY {
            2 => ColumnKind::Rotation,
            _ => ColumnKind::Translation,
        };
        (0..self.layout().n_v).map(kind).collect()
    }

    /// Coefficients of a component of a reaction, `Σ coefficient·λ` over the rows of the joint or
    /// drive: `Fx`, `Fy`, `T`, or the named component of its definition. `None` if it has no such
    /// component; allocates.
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn component_coefficients(
        &self,
        id: ConstraintId,
        name: &str,
        s: &Scratch,
    ) -> Option<Vec<f64>> {
        if let Some(k) = COMPONENTS.iter().position(|c| *c == name) {
            return Some(self.wrench_map(id, s).row(k).to_vec());
        }
        let c = &self.constraints()[id.0];
        let element = c.element.element();
        (element.spec().component == Some(name)).then(|| {
            let mut coefficients = vec![0.0; c.rows.len()];
            let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
            element.component(x, f, &mut coefficients);
            coefficients
        })
    }

    /// The reaction of a joint or drive for multipliers λ (all rows) at the poses of the scratch;
    /// allocates.
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive, or λ is too short.
    #[must_use]
    pub fn reaction(&self, id: ConstraintId, s: &Scratch, lambda: &[f64]) -> Reaction {
        let c = &self.constraints()[id.0];
        let lambda = &lambda[c.rows.clone()];
        let wrench = self.wrench_map(id, s).times(lambda);
        let named = c.element.element().spec().component;
        let component = named
            .and_then(|name| self.component_coefficients(id, name, s))
            .map(|coefficients| coefficients.iter().zip(lambda).map(|(k, l)| k * l).sum());
        Reaction {
            force: [wrench[0], wrench[1]],
            torque: wrench[2],
            component,
        }
    }

    /// The point where the reaction of a joint or drive is reported, global components.
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn place(&self, id: ConstraintId, s: &Scratch) -> [f64; 2] {
        let c = &self.constraints()[id.0];
        c.element.element().place(&s.slot_poses[c.slots.clone()])
    }

    /// Ids of all joints and drives, in the order of their rows.
    pub fn constraint_ids(&self) -> impl Iterator<Item = ConstraintId> + use<> {
        (0..self.layout().groups.len()).map(ConstraintId)
    }
}
