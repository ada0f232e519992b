//! A joint of the text; parts that could not be read are missing.

use std::ops::Range;

use joints::Argument;
use model::registry::ConstraintDefinition;
use model::{Armature, Joint};

use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::stiffness::CentreOfStiffness;
use crate::table::Table;

/// A joint of the text; parts that could not be read are missing.
pub(crate) struct JointRead<'r, S: SceneSpace> {
    pub(crate) name: String,
    /// Position of the name in the text.
    pub(crate) span: Range<usize>,
    pub(crate) kind: JointKind<'r, S>,
    pub(crate) is_active: bool,
    /// The complete joint, if all values could be read.
    pub(crate) complete: Option<CompleteJoint<S>>,
}

/// Kind of a joint.
pub(crate) enum JointKind<'r, S: SceneSpace> {
    /// The type is missing or wrong.
    Unknown,
    /// The joint couples joint coordinates of other joints.
    Coupling,
    /// The joint has a definition.
    Defined(&'r ConstraintDefinition<S>),
}

/// A joint with its position in the text and its arguments.
pub(crate) struct CompleteJoint<S: SceneSpace> {
    pub(crate) joint: Joint<S>,
    pub(crate) entry: Entry,
    /// Values of the parameters of the definition.
    pub(crate) arguments: Vec<Argument>,
    /// The centre of stiffness of the joint, if it is given.
    pub(crate) centre: Option<CentreOfStiffness>,
    pub(crate) armatures: Vec<Armature<S>>,
}

impl<'r, S: SceneSpace> JointRead<'r, S> {
    /// Creates a joint of which only the name and the kind are known.
    pub(crate) fn new(name: &str, kind: JointKind<'r, S>, table: &Table) -> Self {
        Self {
            name: name.to_owned(),
            span: table.span_of("name"),
            kind,
            is_active: true,
            complete: None,
        }
    }

    /// Definition of the joint, if its type is known and has a definition.
    pub(crate) fn definition(&self) -> Option<&'r ConstraintDefinition<S>> {
        match self.kind {
            JointKind::Defined(definition) => Some(definition),
            JointKind::Unknown | JointKind::Coupling => None,
        }
    }
}
