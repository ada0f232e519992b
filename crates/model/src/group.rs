//! Joints and drives with their rows. A group contains names, sizes, and the components of the
//! reaction.

use joints::spec::{ConstraintSpec, Datum, DatumShape, Entry};

use crate::body::BodyRef;
use crate::contact::ContactLimits;
use crate::coupling;
use crate::rows::RowRanges;
use crate::space::SpaceKind;

/// Index of a joint or drive in [`crate::Layout::groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ConstraintId(pub usize);

/// A joint or a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintKind {
    /// A joint, which connects bodies.
    Joint,
    /// A drive, which prescribes a relative motion.
    Drive,
}

/// A joint or drive with its rows.
#[derive(Clone, Debug)]
pub struct ConstraintGroup {
    /// The space of the mechanism.
    pub space: SpaceKind,
    /// Name of the joint or drive.
    pub name: String,
    /// Whether the group is a joint or a drive.
    pub kind: ConstraintKind,
    /// Description of the constraint type.
    pub spec: &'static ConstraintSpec,
    /// Bodies of the joint or drive.
    pub bodies: Vec<BodyRef>,
    /// Rows of C of the joint or drive.
    pub rows: RowRanges,
    /// Limits of the loads of the joint.
    pub limits: ContactLimits,
}

impl ConstraintGroup {
    /// Returns whether the constraint is a drive, which only prescribes a motion and is listed
    /// separately from the joints.
    #[must_use]
    pub fn is_drive(&self) -> bool {
        self.kind == ConstraintKind::Drive
    }

    /// Returns the index (in the list of bodies) of the body that contains the point `name`, if
    /// this body contains no other point of the constraint.
    #[must_use]
    pub fn slot_of_point(&self, name: &str) -> Option<usize> {
        let slot_of = |datum: &Datum| match datum.shape {
            DatumShape::Point { slot } => Some(slot),
            _ => None,
        };
        let data = self.spec.data.iter();
        let slot = data.clone().find(|d| d.name == name).and_then(slot_of)?;
        let points = data.filter(|d| slot_of(d) == Some(slot)).count();
        (points == 1).then_some(slot)
    }

    /// Components of the reaction that are not identically zero, as indices of
    /// [`SpaceKind::components`].
    #[must_use]
    pub fn components(&self) -> Vec<usize> {
        let entries = self.wrench_entries();
        (0..self.space.n_v())
            .filter(|c| entries.iter().any(|[component, _]| component == c))
            .collect()
    }

    /// Returns the named component that is reported in addition to force and torque, namely the
    /// load of a coupling. This load acts on up to four bodies. The reported force and torque act
    /// on one of these bodies.
    #[must_use]
    pub fn own_load(&self) -> Option<&'static str> {
        let named = self.spec.component;
        named.filter(|_| self.spec.common.scene_type == coupling::TYPE)
    }

    /// Returns the names of the reported components. The reported components are the components
    /// that are not identically zero, and the named component.
    pub fn component_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        let names = self.space.components();
        let own = self.components().into_iter().map(|c| names[c]);
        own.chain(self.own_load())
    }

    /// Returns the entries (component, row) of the map from multipliers to the reaction, without
    /// entries that are identically zero. The list is sorted.
    #[must_use]
    pub fn wrench_entries(&self) -> Vec<[usize; 2]> {
        let mut entries = self.spec.wrench.to_vec();
        for (_, e) in self.repeated() {
            entries.push([e.dof, e.row]);
            if self.space.forces().contains(&e.dof) {
                let turned = self.space.torques();
                let turned = turned.filter(|k| self.space.axis_of(*k) != e.dof);
                entries.extend(turned.map(|k| [k, e.row]));
            }
        }
        entries.sort_unstable();
        entries.dedup();
        entries
    }

    /// Returns whether a row of this joint or drive has a force in its reaction, not only a torque.
    #[must_use]
    pub fn pushes(&self, row: usize) -> bool {
        let entries = self.wrench_entries();
        entries
            .iter()
            .any(|[component, at]| *at == row && self.space.forces().contains(component))
    }

    /// Returns whether the first body occurs again in the list of bodies.
    pub(crate) fn repeats_first_body(&self) -> bool {
        let [first, others @ ..] = &self.bodies[..] else {
            return false;
        };
        others.contains(first)
    }

    /// Returns the entries of the block of C for the second and later positions of the first body
    /// in the list of bodies. Each entry has its index in the block.
    pub(crate) fn repeated(&self) -> impl Iterator<Item = (usize, &'static Entry)> + '_ {
        let is_repeated = |e: &Entry| e.slot > 0 && self.bodies.get(e.slot) == self.bodies.first();
        self.spec
            .c
            .iter()
            .enumerate()
            .filter(move |(_, e)| is_repeated(e))
    }
}

/// Kind of the velocity of a column of C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A velocity in m/s; the generalised force is a force.
    Translation,
    /// An angular velocity in rad/s; the generalised force is a torque.
    Rotation,
}
