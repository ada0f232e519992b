//! Definitions by their scene type, so that a reader of scenes can build joints and forces without
//! knowing them.

use joints::spec::{ConstraintSpec, ForceSpec, Spec};
use joints::{Argument, ArgumentError, Constraint, Force, Visitor};

use crate::element::{ConstraintKernels, ForceKernels};
use crate::law::{Law, LawError, build_law};

/// Builds a constraint from the values of its parameters.
pub type BuildConstraint = fn(&[Argument]) -> Result<Box<dyn ConstraintKernels>, ArgumentError>;

/// Builds a force from the values of its parameters.
pub type BuildForce = fn(&[Argument]) -> Result<Box<dyn ForceKernels>, ArgumentError>;

/// Builds a force along a measure from the values of the parameters of its joint.
pub type BuildLaw = fn(&[Argument], Law) -> Result<Box<dyn ForceKernels>, LawError>;

/// A constraint definition.
#[derive(Clone, Debug)]
pub struct ConstraintDefinition {
    /// Its description.
    pub spec: &'static ConstraintSpec,
    /// Its constructor.
    pub build: BuildConstraint,
    /// The drives of its measures, in the same order.
    pub drives: Vec<DriveDefinition>,
}

/// The drive of a measure. It has the arguments of its joint and one function of time.
#[derive(Clone, Debug)]
pub struct DriveDefinition {
    /// Its description.
    pub spec: &'static ConstraintSpec,
    /// Its constructor.
    pub build: BuildConstraint,
    /// Constructor of a law in place of the motion: a force with one function, the time.
    pub law: BuildLaw,
}

/// A force definition.
#[derive(Clone, Debug)]
pub struct ForceDefinition {
    /// Its description.
    pub spec: &'static ForceSpec,
    /// Its constructor.
    pub build: BuildForce,
}

/// All definitions to which a scene may refer.
///
/// ```
/// use model::Registry;
/// let registry = Registry::planar();
/// let revolute = registry.constraints("revolute").next().unwrap();
/// assert_eq!(revolute.spec.rows.len(), 2);
/// assert_eq!(revolute.drives.len(), 1); // its angle
/// ```
#[derive(Clone, Debug, Default)]
pub struct Registry {
    constraints: Vec<ConstraintDefinition>,
    forces: Vec<ForceDefinition>,
}

impl Registry {
    /// A registry without definitions.
    #[must_use]
    pub fn empty() -> Self {
        Self::default()
    }

    /// All planar definitions of the library.
    #[must_use]
    pub fn planar() -> Self {
        let mut registry = Self::empty();
        joints::plane_constraints(&mut registry);
        joints::plane_forces(&mut registry);
        registry
    }

    /// Adds a constraint definition with the drives of its measures.
    pub fn add_constraint<K: Constraint>(&mut self) {
        self.constraint::<K>();
    }

    /// Adds a force definition.
    pub fn add_force<K: Force>(&mut self) {
        self.force::<K>();
    }

    /// Constraints of a scene type. Several may share a type and differ in a key or in the number
    /// of bodies.
    pub fn constraints<'a>(
        &'a self,
        scene_type: &'a str,
    ) -> impl Iterator<Item = &'a ConstraintDefinition> {
        self.constraints
            .iter()
            .filter(move |d| d.spec.common.scene_type == scene_type)
    }

    /// Forces of a scene type.
    pub fn forces<'a>(&'a self, scene_type: &'a str) -> impl Iterator<Item = &'a ForceDefinition> {
        self.forces
            .iter()
            .filter(move |d| d.spec.common.scene_type == scene_type)
    }

    /// Descriptions of all constraints.
    pub fn constraint_specs(&self) -> impl Iterator<Item = &'static Spec> + '_ {
        self.constraints.iter().map(|d| &d.spec.common)
    }

    /// Descriptions of all forces.
    pub fn force_specs(&self) -> impl Iterator<Item = &'static Spec> + '_ {
        self.forces.iter().map(|d| &d.spec.common)
    }
}

/// The drives of one definition.
struct Drives(Vec<DriveDefinition>);

impl Visitor for Drives {
    fn constraint<K: Constraint>(&mut self) {}
    fn force<K: Force>(&mut self) {}
    fn drive<K: Constraint>(&mut self) {
        self.0.push(DriveDefinition {
            spec: &K::SPEC,
            build: build_constraint::<K>,
            law: build_law::<K>,
        });
    }
}

impl Visitor for Registry {
    fn constraint<K: Constraint>(&mut self) {
        let mut drives = Drives(Vec::new());
        K::visit_drives(&mut drives);
        self.constraints.push(ConstraintDefinition {
            spec: &K::SPEC,
            build: build_constraint::<K>,
            drives: drives.0,
        });
    }

    /// Drives are added with their constraint.
    fn drive<K: Constraint>(&mut self) {}

    fn force<K: Force>(&mut self) {
        self.forces.push(ForceDefinition {
            spec: &K::SPEC,
            build: build_force::<K>,
        });
    }
}

fn build_constraint<K: Constraint>(
    arguments: &[Argument],
) -> Result<Box<dyn ConstraintKernels>, ArgumentError> {
    Ok(Box::new(K::from_arguments(arguments)?))
}

fn build_force<K: Force>(arguments: &[Argument]) -> Result<Box<dyn ForceKernels>, ArgumentError> {
    Ok(Box::new(K::from_arguments(arguments)?))
}
