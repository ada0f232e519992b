//! Definitions of joints and forces, found by their type in scenes. With the registry, a reader of
//! scenes can build joints and forces without a dependency on their Rust types.

use joints::spec::{ConstraintSpec, ForceSpec, Spec};
use joints::{Argument, ArgumentError, Constraint, Force, Plane, Space3, Visitor, space3};

use crate::element::{BodySpace, ConstraintKernels, ForceKernels};
use crate::law::{Law, LawError};
use crate::space::SpaceKind;

/// Builds a constraint from the values of its parameters.
pub type BuildConstraint<S = Plane> =
    fn(&[Argument]) -> Result<Box<dyn ConstraintKernels<S>>, ArgumentError>;

/// Builds a force from the values of its parameters.
pub type BuildForce<S = Plane> = fn(&[Argument]) -> Result<Box<dyn ForceKernels<S>>, ArgumentError>;

/// Builds a force along a joint coordinate from the values of the parameters of its joint.
pub type BuildLaw<S = Plane> = fn(&[Argument], Law) -> Result<Box<dyn ForceKernels<S>>, LawError>;

/// A constraint definition.
#[derive(Clone, Debug)]
pub struct ConstraintDefinition<S: BodySpace = Plane> {
    /// Description of the definition.
    pub spec: &'static ConstraintSpec,
    /// Constructor of the constraint.
    pub build: BuildConstraint<S>,
    /// The drives of the joint coordinates, in the order of the coordinates.
    pub drives: Vec<DriveDefinition<S>>,
}

/// The drive of a joint coordinate. The drive has the arguments of its joint and one function of
/// time.
#[derive(Clone, Debug)]
pub struct DriveDefinition<S: BodySpace = Plane> {
    /// Description of the definition.
    pub spec: &'static ConstraintSpec,
    /// Constructor of the drive.
    pub build: BuildConstraint<S>,
    /// Constructor of a force law that replaces the motion. A force law is a force with one
    /// function, the time.
    pub law: BuildLaw<S>,
}

/// A force definition.
#[derive(Clone, Debug)]
pub struct ForceDefinition<S: BodySpace = Plane> {
    /// Description of the definition.
    pub spec: &'static ForceSpec,
    /// Constructor of the force.
    pub build: BuildForce<S>,
}

/// The definitions of one space.
#[derive(Clone, Debug)]
pub struct Definitions<S: BodySpace> {
    constraints: Vec<ConstraintDefinition<S>>,
    forces: Vec<ForceDefinition<S>>,
}

impl<S: BodySpace> Default for Definitions<S> {
    fn default() -> Self {
        Self {
            constraints: Vec::new(),
            forces: Vec::new(),
        }
    }
}

impl<S: BodySpace> Definitions<S> {
    /// Returns the constraints of a type in scenes. Several definitions may have the same type.
    /// Such definitions differ in a key or in the number of bodies.
    pub fn constraints<'a>(
        &'a self,
        scene_type: &'a str,
    ) -> impl Iterator<Item = &'a ConstraintDefinition<S>> {
        self.constraints
            .iter()
            .filter(move |d| d.spec.common.scene_type == scene_type)
    }

    /// Returns the forces of a type in scenes.
    pub fn forces<'a>(
        &'a self,
        scene_type: &'a str,
    ) -> impl Iterator<Item = &'a ForceDefinition<S>> {
        self.forces
            .iter()
            .filter(move |d| d.spec.common.scene_type == scene_type)
    }

    /// Returns the descriptions of all constraints.
    pub fn constraint_specs(&self) -> impl Iterator<Item = &'static Spec> + '_ {
        self.constraints.iter().map(|d| &d.spec.common)
    }

    /// Returns the descriptions of all forces.
    pub fn force_specs(&self) -> impl Iterator<Item = &'static Spec> + '_ {
        self.forces.iter().map(|d| &d.spec.common)
    }
}

/// All definitions that a scene may use, in the plane and in space.
///
/// ```
/// use pfaff_model::Registry;
/// let registry = Registry::standard();
/// let revolute = registry.plane().constraints("revolute").next().unwrap();
/// assert_eq!(revolute.spec.rows.len(), 2);
/// assert_eq!(revolute.drives.len(), 1); // its angle
/// let revolute = registry.space().constraints("revolute").next().unwrap();
/// assert_eq!(revolute.spec.rows.len(), 5);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Registry {
    plane: Definitions<Plane>,
    space: Definitions<Space3>,
}

impl Registry {
    /// Returns a registry without definitions.
    #[must_use]
    pub fn empty() -> Self {
        Self::default()
    }

    /// Returns all definitions of the library.
    #[must_use]
    pub fn standard() -> Self {
        let mut registry = Self::empty();
        joints::plane_constraints(&mut registry.plane);
        joints::plane_forces(&mut registry.plane);
        space3::constraints(&mut registry.space);
        space3::forces(&mut registry.space);
        registry
    }

    /// Returns the definitions of the plane.
    #[must_use]
    pub fn plane(&self) -> &Definitions<Plane> {
        &self.plane
    }

    /// Returns the definitions of space.
    #[must_use]
    pub fn space(&self) -> &Definitions<Space3> {
        &self.space
    }

    /// Returns the descriptions of all constraints of a space.
    #[must_use]
    pub fn constraints_in(&self, space: SpaceKind) -> Vec<&'static ConstraintSpec> {
        match space {
            SpaceKind::Space3 => self.space.constraints.iter().map(|d| d.spec).collect(),
            _ => self.plane.constraints.iter().map(|d| d.spec).collect(),
        }
    }

    /// Adds a constraint definition of the plane, with the drives of the joint coordinates.
    pub fn add_constraint<K: Constraint>(&mut self) {
        self.plane.constraint::<K>();
    }

    /// Adds a force definition of the plane.
    pub fn add_force<K: Force>(&mut self) {
        self.plane.force::<K>();
    }

    /// Adds a constraint definition of space, with the drives of the joint coordinates.
    pub fn add_spatial_constraint<K: Constraint<Space3>>(&mut self) {
        self.space.constraint::<K>();
    }

    /// Adds a force definition of space.
    pub fn add_spatial_force<K: Force<Space3>>(&mut self) {
        self.space.force::<K>();
    }
}

/// The drives of one definition.
struct Drives<S: BodySpace>(Vec<DriveDefinition<S>>);

impl<S: BodySpace> Visitor<S> for Drives<S> {
    fn constraint<K: Constraint<S>>(&mut self) {}
    fn force<K: Force<S>>(&mut self) {}
    fn drive<K: Constraint<S>>(&mut self) {
        self.0.push(DriveDefinition {
            spec: &K::SPEC,
            build: build_constraint::<K, S>,
            law: build_law::<K, S>,
        });
    }
}

impl<S: BodySpace> Visitor<S> for Definitions<S> {
    fn constraint<K: Constraint<S>>(&mut self) {
        let mut drives = Drives(Vec::new());
        K::visit_drives(&mut drives);
        self.constraints.push(ConstraintDefinition {
            spec: &K::SPEC,
            build: build_constraint::<K, S>,
            drives: drives.0,
        });
    }

    /// The drives are added together with the constraint, so nothing is done here.
    fn drive<K: Constraint<S>>(&mut self) {}

    fn force<K: Force<S>>(&mut self) {
        self.forces.push(ForceDefinition {
            spec: &K::SPEC,
            build: build_force::<K, S>,
        });
    }
}

fn build_constraint<K: Constraint<S>, S: BodySpace>(
    arguments: &[Argument],
) -> Result<Box<dyn ConstraintKernels<S>>, ArgumentError> {
    Ok(K::from_arguments(arguments)?.boxed())
}

fn build_law<K: Constraint<S>, S: BodySpace>(
    arguments: &[Argument],
    law: Law,
) -> Result<Box<dyn ForceKernels<S>>, LawError> {
    S::law(K::from_arguments(arguments)?, law)
}

fn build_force<K: Force<S>, S: BodySpace>(
    arguments: &[Argument],
) -> Result<Box<dyn ForceKernels<S>>, ArgumentError> {
    Ok(Box::new(K::from_arguments(arguments)?))
}
