//! Definitions by their scene type, so that a reader of scenes can build joints and forces without
//! knowing them.

use joints::spec::{ConstraintSpec, ForceSpec, Spec};
use joints::{
    Argument, ArgumentError, Constraint, Element, Force, ForceElement, Magnitude, Pose, Recorded,
    Twist, Visitor,
};
use linalg::Dd;

use crate::law::{DriveForce, Law, LawError, build_law};

/// A planar constraint as a trait object: kernels in `f64` for motion, and in other number types.
pub trait PlaneConstraint: Element {
    /// Kernels for certificates.
    fn extended(&self) -> &dyn Element<Dd>;
    /// Kernels for bounds on the rounding of data.
    fn magnitude(&self) -> &dyn Element<Magnitude>;
    /// Kernels that record their operations.
    fn recorded(&self) -> &dyn Element<Recorded>;
    /// A copy.
    fn boxed(&self) -> Box<dyn PlaneConstraint>;
}

impl<K: Constraint> PlaneConstraint for K {
    fn extended(&self) -> &dyn Element<Dd> {
        self.element()
    }
    fn magnitude(&self) -> &dyn Element<Magnitude> {
        self.element()
    }
    fn recorded(&self) -> &dyn Element<Recorded> {
        self.element()
    }
    fn boxed(&self) -> Box<dyn PlaneConstraint> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn PlaneConstraint> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// A planar force as a trait object.
pub trait PlaneForce: ForceElement {
    /// Kernels that record their operations.
    fn recorded(&self) -> &dyn ForceElement<Recorded>;
    /// A copy.
    fn boxed(&self) -> Box<dyn PlaneForce>;
    /// Whether this is a drive by a law.
    fn is_law(&self) -> bool {
        false
    }
    /// The force along the measure of a drive by a law.
    fn drive(&self, _x: &[Pose], _v: &[Twist], _f: &[[f64; 3]]) -> Option<DriveForce> {
        None
    }
}

impl<K: Force> PlaneForce for K {
    fn recorded(&self) -> &dyn ForceElement<Recorded> {
        self.element()
    }
    fn boxed(&self) -> Box<dyn PlaneForce> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn PlaneForce> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// Builds a constraint from the values of its parameters.
pub type BuildConstraint = fn(&[Argument]) -> Result<Box<dyn PlaneConstraint>, ArgumentError>;

/// Builds a force from the values of its parameters.
pub type BuildForce = fn(&[Argument]) -> Result<Box<dyn PlaneForce>, ArgumentError>;

/// Builds a force along a measure from the values of the parameters of its joint.
pub type BuildLaw = fn(&[Argument], Law) -> Result<Box<dyn PlaneForce>, LawError>;

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
) -> Result<Box<dyn PlaneConstraint>, ArgumentError> {
    Ok(Box::new(K::from_arguments(arguments)?))
}

fn build_force<K: Force>(arguments: &[Argument]) -> Result<Box<dyn PlaneForce>, ArgumentError> {
    Ok(Box::new(K::from_arguments(arguments)?))
}
