//! A mechanism as plain data. A reader of scenes or a program creates the data. This module checks
//! nothing; [`crate::Mechanism::build`] checks everything once.

use joints::spec::{ConstraintSpec, Unit};
use joints::{Constraint, Plane, Space3};

pub use crate::body::{Body, BodyRecord, BodyRef, DescribedBody, FramePose, SpatialBody};
use crate::called::{
    BodyState, CallError, CalledWrench, ControlState, Controller, Efforts, Wrench,
};
use crate::contact::ContactLimits;
use crate::element::{BodySpace, ConstraintKernels, ForceKernels};
use crate::function::Function;
use crate::law::{Law, LawError};
use crate::observed::Observables;
use crate::space::SpaceKind;
use crate::tolerance::Tolerance;

/// A mechanism before it is assembled.
///
/// The lists may be read and changed directly. [`Description::body`] and similar methods add one
/// named item.
///
/// ```
/// use joints::Revolute;
/// use pfaff_model::{Body, BodyRef, Description, Mechanism, System};
///
/// // A rod at (1, 2), with its centre of mass half a metre below.
/// let mut pendulum = Description { gravity: [0.0, -9.81], ..Description::new("pendulum") };
/// let rod = pendulum.body(Body { position: [1.0, 1.5], ..Body::new("rod", 2.0, 0.2) });
/// let s_j = pendulum.local(rod, [1.0, 2.0]);
/// assert_eq!(s_j, [0.0, 0.5]);
/// pendulum.joint("pivot", &[BodyRef::Ground, rod], Revolute { s_i: [1.0, 2.0], s_j });
/// assert_eq!(Mechanism::build(&pendulum).unwrap().layout().rows(), 2);
///
/// // A second item with the same name is reported when it is built.
/// pendulum.joint("pivot", &[rod, BodyRef::Ground], Revolute { s_i: s_j, s_j: [1.0, 2.0] });
/// let faults = Mechanism::build(&pendulum).err().unwrap();
/// assert_eq!(faults[0].to_string(), "the name `pivot` is used twice");
/// ```
#[derive(Clone)]
pub struct MechanismDescription<S: BodySpace> {
    /// Name of the mechanism.
    pub name: String,
    /// Acceleration due to gravity (m/s²).
    pub gravity: S::Vector<f64>,
    /// Bodies; their order defines the order of the coordinates.
    pub bodies: Vec<S::Body>,
    /// Joints; their order defines the order of the rows.
    pub joints: Vec<Joint<S>>,
    /// Drives; their rows come after the holonomic rows of the joints.
    pub drives: Vec<Drive<S>>,
    /// Forces.
    pub forces: Vec<Force<S>>,
    /// Tolerance of the data for which neither the joint nor the body states a tolerance.
    pub tolerance: Tolerance,
    /// Markers and measures.
    pub observed: Observables,
    /// Time of the start (s). The described configuration belongs to t = 0.
    pub start_time: f64,
    /// Controllers, added by [`MechanismDescription::control`].
    pub controllers: Vec<Controller>,
    /// Inertias of joint coordinates, added by [`MechanismDescription::armature`].
    pub armatures: Vec<Armature<S>>,
}

/// A mechanism in the plane before it is assembled; see [`MechanismDescription`].
pub type Description = MechanismDescription<Plane>;

/// A mechanism in space before it is assembled.
///
/// ```
/// use joints::space3::{Axes, Revolute};
/// use pfaff_model::{BodyRef, Mechanism, SpatialBody, SpatialDescription, System};
/// // A door on two hinges: five of their ten rows are redundant.
/// let mut d = SpatialDescription::new("door");
/// let door = d.body(SpatialBody {
///     position: [0.5, 0.0, 1.0],
///     ..SpatialBody::new("door", 20.0, [[6.0, 0.0, 0.0], [0.0, 8.0, 0.0], [0.0, 0.0, 2.0]])
/// });
/// for (name, z) in [("bottom", 0.2), ("top", 1.8)] {
///     let [s_i, s_j] = [BodyRef::Ground, door].map(|body| d.local(body, [0.0, 0.0, z]));
///     let hinge = Revolute { s_i, s_j, axis: Axes::FRAME, axis_j: Axes::FRAME };
///     d.joint(name, &[BodyRef::Ground, door], hinge);
/// }
/// let mechanism = Mechanism::build(&d).unwrap();
/// assert_eq!((mechanism.layout().rows(), mechanism.layout().n_v), (10, 6));
/// ```
pub type SpatialDescription = MechanismDescription<Space3>;

impl<S: BodySpace> Default for MechanismDescription<S> {
    fn default() -> Self {
        Self {
            name: String::new(),
            gravity: S::vector([0.0; 3]),
            bodies: Vec::new(),
            joints: Vec::new(),
            drives: Vec::new(),
            forces: Vec::new(),
            tolerance: Tolerance::default(),
            observed: Observables::default(),
            start_time: 0.0,
            controllers: Vec::new(),
            armatures: Vec::new(),
        }
    }
}

impl<S: BodySpace> MechanismDescription<S> {
    /// Returns a description without bodies.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    /// Adds a body and returns the reference by which joints refer to it.
    pub fn body(&mut self, body: S::Body) -> BodyRef {
        self.bodies.push(body);
        BodyRef::Body(self.bodies.len() - 1)
    }

    /// Adds a joint, with points in the frames of its bodies. If the joint depends on time, the
    /// caller must add the functions of time to the result.
    pub fn joint(
        &mut self,
        name: &str,
        bodies: &[BodyRef],
        element: impl ConstraintKernels<S> + 'static,
    ) -> &mut Joint<S> {
        self.joints.push_mut(Joint::new(name, bodies, element))
    }

    /// Adds a drive, which changes its joint coordinate by f(t) − f(0).
    pub fn drive(
        &mut self,
        name: &str,
        bodies: &[BodyRef],
        element: impl ConstraintKernels<S> + 'static,
        motion: Function,
    ) {
        self.drives.push(Drive {
            name: name.to_owned(),
            bodies: bodies.to_vec(),
            element: Box::new(element),
            motion,
            tolerance: None,
        });
    }

    /// Adds an armature to a joint: the inertia of a rotor that rotates with a joint coordinate s.
    /// The kinetic energy of the mechanism contains ½·a·ṡ². Gyroscopic terms of the rotor are
    /// neglected. `element` is the drive of the joint coordinate, and the inertia has the unit
    /// kg·m² (kg for a length).
    ///
    /// ```
    /// use joints::{Revolute, RevoluteAngleDrive};
    /// use pfaff_model::{Body, BodyRef, Description, Mechanism};
    /// // A geared motor: 2e-5 kg·m² at the motor and a ratio of 100 are 0.2 kg·m² at the joint.
    /// let mut d = Description::new("arm");
    /// let arm = d.body(Body::new("arm", 1.0, 0.5));
    /// let (bodies, o) = ([BodyRef::Ground, arm], [0.0, 0.0]);
    /// d.joint("shoulder", &bodies, Revolute { s_i: o, s_j: o });
    /// d.armature("shoulder", &bodies, RevoluteAngleDrive::new(o, o), 0.2);
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// assert_eq!(mechanism.kinetic_energy(&[0.0; 3], &[0.0, 0.0, 2.0]), 1.4);
    /// ```
    pub fn armature(
        &mut self,
        joint: &str,
        bodies: &[BodyRef],
        element: impl ConstraintKernels<S> + 'static,
        inertia: f64,
    ) {
        self.armatures.push(Armature {
            joint: joint.to_owned(),
            bodies: bodies.to_vec(),
            element: Box::new(element),
            inertia,
        });
    }

    /// Adds a force, with points in the frames of its bodies. If the force depends on time, the
    /// caller must add the functions of time to the result.
    pub fn force(
        &mut self,
        name: &str,
        bodies: &[BodyRef],
        element: impl ForceKernels<S> + 'static,
    ) -> &mut Force<S> {
        self.forces.push_mut(Force {
            name: name.to_owned(),
            bodies: bodies.to_vec(),
            element: Box::new(element),
            functions: Vec::new(),
        })
    }

    /// Adds a drive that applies a force (N) or torque (N·m) along its joint coordinate. The force
    /// law replaces the prescribed motion. The force law is a function of the coordinate, the rate
    /// of the coordinate and time.
    ///
    /// ```
    /// use joints::{Revolute, RevoluteAngleDrive};
    /// use pfaff_model::{Body, BodyRef, Description, Law, Mechanism, System};
    /// // A wheel that a controller turns to 2 rad.
    /// let mut d = Description::new("wheel");
    /// let wheel = d.body(Body::new("wheel", 1.0, 0.5));
    /// let (bodies, o) = ([BodyRef::Ground, wheel], [0.0, 0.0]);
    /// d.joint("shaft", &bodies, Revolute { s_i: o, s_j: o });
    /// let controller = Law::called(|at| Ok(3.0 * (2.0 - at.measure) - 0.5 * at.rate));
    /// d.drive_by_law("motor", &bodies, RevoluteAngleDrive::new(o, o), controller)?;
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let mut s = mechanism.scratch();
    /// mechanism.pose(0.0, &[0.0, 0.0, 1.0], &mut s);
    /// mechanism.twist(&[0.0, 0.0, 4.0], &mut s);
    /// mechanism.force(&mut s);
    /// assert_eq!(s.force, [0.0, 0.0, 1.0]);
    /// # Ok::<(), pfaff_model::law::LawError>(())
    /// ```
    ///
    /// # Errors
    /// [`LawError::Rows`]: the drive has several rows, or more than four bodies.
    pub fn drive_by_law(
        &mut self,
        name: &str,
        bodies: &[BodyRef],
        element: impl Constraint<S>,
        law: Law,
    ) -> Result<(), LawError> {
        self.forces.push(Force {
            name: name.to_owned(),
            bodies: bodies.to_vec(),
            element: S::law(element, law)?,
            functions: vec![Function::time()],
        });
        Ok(())
    }

    /// Adds a force and a torque on a body. A callback computes both from the state of the body.
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Mechanism, System, Wrench};
    /// // A stone in the wind, which blows with 3 m/s along x.
    /// let mut d = Description::new("stone");
    /// let stone = d.body(Body::new("stone", 1.0, 0.1));
    /// d.called_force("wind", stone, |at| {
    ///     let push = [0.5 * (3.0 - at.velocity[0]), -0.5 * at.velocity[1], 0.0];
    ///     Ok(Wrench { force: push, ..Wrench::default() })
    /// });
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let mut s = mechanism.scratch();
    /// mechanism.pose(0.0, &[0.0; 3], &mut s);
    /// mechanism.twist(&[1.0, 2.0, 0.0], &mut s);
    /// mechanism.force(&mut s);
    /// assert_eq!(s.force, [1.0, -1.0, 0.0]);
    /// ```
    pub fn called_force(
        &mut self,
        name: &str,
        body: BodyRef,
        function: impl Fn(&BodyState) -> Result<Wrench, CallError> + Send + Sync + 'static,
    ) {
        self.forces.push(Force {
            name: name.to_owned(),
            bodies: vec![body],
            element: S::wrench(CalledWrench::new(function)),
            functions: vec![Function::time()],
        });
    }

    /// Adds a controller: a callback that commands drives with force laws and loads bodies. The
    /// callback receives the state of the whole mechanism and is called once for each evaluation of
    /// the applied forces. The conditions of [`Law::called`] apply. Its values replace the force
    /// laws of the drives, and act as forces and torques at the centres of mass of the bodies.
    ///
    /// ```
    /// use joints::{Revolute, RevoluteAngleDrive};
    /// use pfaff_model::{Body, BodyRef, Description, Law, Mechanism, System, Wrench};
    /// // A motor that turns a wheel toward the angle of another wheel.
    /// let mut d = Description::new("wheels");
    /// let [a, b] = ["a", "b"].map(|name| d.body(Body::new(name, 1.0, 0.5)));
    /// for (body, name) in [(a, "pin a"), (b, "pin b")] {
    ///     d.joint(name, &[BodyRef::Ground, body], Revolute::new([0.0; 2], [0.0; 2]));
    /// }
    /// let angle = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    /// d.drive_by_law("motor", &[BodyRef::Ground, b], angle, Law::called(|_| Ok(0.0)))?;
    /// d.control(&["motor"], &[a], |state, efforts| {
    ///     efforts.drives[0] = 3.0 * (state.bodies[0].angle - state.bodies[1].angle);
    ///     efforts.bodies[0] = Wrench { torque: [0.0, 0.0, 0.5], ..Wrench::default() };
    ///     Ok(())
    /// })?;
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let mut s = mechanism.scratch();
    /// mechanism.pose(0.0, &[0.0, 0.0, 2.0, 0.0, 0.0, 1.0], &mut s);
    /// mechanism.twist(&[0.0; 6], &mut s);
    /// mechanism.force(&mut s);
    /// assert_eq!(s.force, [0.0, 0.0, 0.5, 0.0, 0.0, 3.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if one of the drives has no force law.
    pub fn control(
        &mut self,
        drives: &[&str],
        bodies: &[BodyRef],
        function: impl Fn(&ControlState<'_>, &mut Efforts) -> Result<(), CallError>
        + Send
        + Sync
        + 'static,
    ) -> Result<(), SetLawError> {
        let mut values = Vec::new();
        for drive in drives {
            self.set_law(drive, &Law::commanded())?;
            let mut forces = self.forces.iter_mut();
            if let Some(force) = forces.find(|force| force.name == *drive) {
                force.functions.clear();
            }
            values.push((*drive).to_owned());
        }
        let records = self.records();
        for &body in bodies {
            let name = body.moving().and_then(|at| records.get(at));
            let name = name.map_or("ground", |record| record.name.as_str());
            let kinds = ["force on", "torque on"].into_iter().zip(S::loads());
            for (kind, element) in kinds {
                let name = format!("{kind} {name}");
                let count = element.spec().common.functions().count();
                values.extend(std::iter::repeat_n(name.clone(), count));
                self.forces.push(Force {
                    name,
                    bodies: vec![body],
                    element,
                    functions: Vec::new(),
                });
            }
        }
        let sizes = [drives.len(), bodies.len()];
        self.controllers
            .push(Controller::new(values, sizes, function));
        Ok(())
    }

    /// Replaces the force law of a drive and keeps the joint coordinate.
    ///
    /// # Errors
    /// Returns an error if no drive of this name has a force law.
    pub fn set_law(&mut self, drive: &str, law: &Law) -> Result<(), SetLawError> {
        let name = || drive.to_owned();
        let found = self.forces.iter_mut().find(|force| force.name == drive);
        if let Some(force) = found {
            force.element = force
                .element
                .with_law(law)
                .ok_or_else(|| SetLawError::Force { name: name() })?;
            return Ok(());
        }
        let prescribed = self.drives.iter().find(|known| known.name == drive);
        Err(match prescribed {
            Some(found) => {
                let mut units = found.element.spec().common.functions();
                let turns = units.any(|(_, unit)| unit == Unit::Angle);
                SetLawError::Motion {
                    name: name(),
                    load: if turns { "torque" } else { "force" },
                }
            }
            None => SetLawError::Unknown { name: name() },
        })
    }

    /// Returns the bodies in the form stored by a mechanism.
    #[must_use]
    pub fn records(&self) -> Vec<BodyRecord> {
        let described = self.bodies.iter().cloned().map(Into::<DescribedBody>::into);
        described.map(BodyRecord::from).collect()
    }

    /// Converts a point in ground axes (m) to a point relative to the centre of mass of a body in
    /// its described pose. Joints and forces require such points. For the ground, and for a body
    /// that does not exist, the result is the point itself.
    #[must_use]
    pub fn local(&self, body: BodyRef, point: S::Vector<f64>) -> S::Vector<f64> {
        let described = body.moving().and_then(|at| self.bodies.get(at));
        described.map_or(point, |body| S::to_local(body, point))
    }
}

/// Reason why a force law cannot be assigned.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SetLawError {
    /// The drive does not exist.
    #[error("there is no drive `{name}`")]
    Unknown {
        /// The unknown name.
        name: String,
    },
    /// The drive prescribes a motion.
    #[error(
        "drive `{name}` prescribes a motion, and its {load} follows from the motion; to give it a law, write `{load} = 0` in place of its `motion`"
    )]
    Motion {
        /// The drive.
        name: String,
        /// "force" or "torque".
        load: &'static str,
    },
    /// The name belongs to a force that is not a drive.
    #[error("`{name}` is a force, not a drive by a law")]
    Force {
        /// Name of the force.
        name: String,
    },
}

/// A mechanism before it is assembled, in the plane or in space.
///
/// ```
/// use pfaff_model::{AnyDescription, Body, Description, Mechanism};
/// let mut d = Description::new("stone");
/// d.body(Body::new("stone", 1.0, 1.0));
/// let d = AnyDescription::from(d);
/// assert_eq!((d.name(), d.joints().count()), ("stone", 0));
/// assert_eq!(Mechanism::build(&d).unwrap().bodies().len(), 1);
/// ```
#[derive(Clone)]
pub enum AnyDescription {
    /// A description in the plane.
    Plane(Description),
    /// A description in space.
    Space3(SpatialDescription),
}

impl Default for AnyDescription {
    fn default() -> Self {
        Self::Plane(Description::default())
    }
}

impl From<Description> for AnyDescription {
    fn from(d: Description) -> Self {
        Self::Plane(d)
    }
}

impl From<SpatialDescription> for AnyDescription {
    fn from(d: SpatialDescription) -> Self {
        Self::Space3(d)
    }
}

/// Evaluates the same expression for a description of either space.
macro_rules! either {
    ($any:expr, $d:ident => $body:expr) => {
        match $any {
            AnyDescription::Plane($d) => $body,
            AnyDescription::Space3($d) => $body,
        }
    };
}

impl AnyDescription {
    /// Returns the space of the description.
    #[must_use]
    pub fn space(&self) -> SpaceKind {
        match self {
            Self::Plane(_) => SpaceKind::Plane,
            Self::Space3(_) => SpaceKind::Space3,
        }
    }

    /// Returns the name.
    #[must_use]
    pub fn name(&self) -> &str {
        either!(self, d => &d.name)
    }

    /// Returns the tolerance of the data for which neither the joint nor the body states a
    /// tolerance.
    #[must_use]
    pub fn tolerance(&self) -> Tolerance {
        either!(self, d => d.tolerance)
    }

    /// Replaces the tolerance returned by [`Self::tolerance`].
    pub fn set_tolerance(&mut self, tolerance: Tolerance) {
        either!(self, d => d.tolerance = tolerance);
    }

    /// Returns the bodies.
    #[must_use]
    pub fn bodies(&self) -> Vec<BodyRecord> {
        either!(self, d => d.records())
    }

    /// Returns the names and descriptions of the joints.
    pub fn joints(&self) -> impl Iterator<Item = (&str, &'static ConstraintSpec)> {
        let named: Vec<_> = either!(self, d => d
            .joints
            .iter()
            .map(|joint| (joint.name.as_str(), joint.element.spec()))
            .collect());
        named.into_iter()
    }

    /// Returns the names and descriptions of the drives.
    pub fn drives(&self) -> impl Iterator<Item = (&str, &'static ConstraintSpec)> {
        let named: Vec<_> = either!(self, d => d
            .drives
            .iter()
            .map(|drive| (drive.name.as_str(), drive.element.spec()))
            .collect());
        named.into_iter()
    }

    /// Returns the prescribed motions of the drives.
    pub fn motions(&self) -> impl Iterator<Item = Motion<'_>> {
        let all: Vec<Motion> = either!(self, d => d
            .drives
            .iter()
            .map(|drive| Motion {
                name: &drive.name,
                bodies: &drive.bodies,
                spec: drive.element.spec(),
                of_time: &drive.motion,
            })
            .collect());
        all.into_iter()
    }

    /// Returns the names of the drives with force laws, including springs on joint coordinates.
    pub fn laws(&self) -> impl Iterator<Item = &str> {
        let named: Vec<_> = either!(self, d => d
            .forces
            .iter()
            .filter(|force| force.element.is_law())
            .map(|force| force.name.as_str())
            .collect());
        named.into_iter()
    }

    /// Replaces the force law of a drive and keeps the joint coordinate.
    ///
    /// # Errors
    /// Returns an error if no drive of this name has a force law.
    pub fn set_law(&mut self, drive: &str, law: &Law) -> Result<(), SetLawError> {
        either!(self, d => d.set_law(drive, law))
    }

    /// Adds a controller; see [`MechanismDescription::control`].
    ///
    /// # Errors
    /// Returns an error if one of the drives has no force law.
    pub fn control(
        &mut self,
        drives: &[&str],
        bodies: &[BodyRef],
        function: impl Fn(&ControlState<'_>, &mut Efforts) -> Result<(), CallError>
        + Send
        + Sync
        + 'static,
    ) -> Result<(), SetLawError> {
        either!(self, d => d.control(drives, bodies, function))
    }

    /// Adds a force and a torque on a body. A callback computes both from the state of the body.
    pub fn called_force(
        &mut self,
        name: &str,
        body: BodyRef,
        function: impl Fn(&BodyState) -> Result<Wrench, CallError> + Send + Sync + 'static,
    ) {
        either!(self, d => d.called_force(name, body, function));
    }

    /// Returns the names and bodies of the joints, drives and forces.
    pub fn connections(&self) -> impl Iterator<Item = (&str, &[BodyRef])> {
        let all: Vec<(&str, &[BodyRef])> = either!(self, d => {
            let joints = d.joints.iter().map(|x| (x.name.as_str(), x.bodies.as_slice()));
            let drives = d.drives.iter().map(|x| (x.name.as_str(), x.bodies.as_slice()));
            let forces = d.forces.iter().map(|x| (x.name.as_str(), x.bodies.as_slice()));
            joints.chain(drives).chain(forces).collect()
        });
        all.into_iter()
    }

    /// Returns the number of forces.
    #[must_use]
    pub fn n_forces(&self) -> usize {
        either!(self, d => d.forces.len())
    }

    /// Returns the description if it is planar.
    #[must_use]
    pub fn plane(&self) -> Option<&Description> {
        match self {
            Self::Plane(d) => Some(d),
            Self::Space3(_) => None,
        }
    }

    /// Returns the description as a mutable reference if it is planar.
    pub fn plane_mut(&mut self) -> Option<&mut Description> {
        match self {
            Self::Plane(d) => Some(d),
            Self::Space3(_) => None,
        }
    }
}

/// A prescribed motion, in the plane or in space.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'d> {
    /// The name of the drive.
    pub name: &'d str,
    /// The bodies of the driven joint.
    pub bodies: &'d [BodyRef],
    /// The definition of the drive.
    pub spec: &'static ConstraintSpec,
    /// The prescribed joint coordinate as a function of time.
    pub of_time: &'d Function,
}

/// A joint between bodies.
#[derive(Clone)]
pub struct Joint<S: BodySpace = Plane> {
    /// Name of the joint.
    pub name: String,
    /// The bodies, in the order of the definition.
    pub bodies: Vec<BodyRef>,
    /// Definition of the joint with parameters.
    pub element: Box<dyn ConstraintKernels<S>>,
    /// Functions of time, in the order of the definition.
    pub functions: Vec<Function>,
    /// Tolerance of the points, directions and scalars of the joint (m). For angles, the tolerance
    /// is divided by the size of the mechanism. This tolerance takes precedence over the tolerances
    /// of the bodies and of the scene.
    pub tolerance: Option<f64>,
    /// Limits of the loads of the joint.
    pub limits: ContactLimits,
}

impl<S: BodySpace> Joint<S> {
    /// Returns a joint that does not depend on time.
    pub fn new(
        name: &str,
        bodies: &[BodyRef],
        element: impl ConstraintKernels<S> + 'static,
    ) -> Self {
        Self {
            name: name.to_owned(),
            bodies: bodies.to_vec(),
            element: Box::new(element),
            functions: Vec::new(),
            tolerance: None,
            limits: ContactLimits::default(),
        }
    }
}

/// A prescribed relative motion, with the row coordinate − initial coordinate − (f(t) − f(0)) = 0.
#[derive(Clone)]
pub struct Drive<S: BodySpace = Plane> {
    /// Name of the drive.
    pub name: String,
    /// The bodies, in the order of the definition of the joint.
    pub bodies: Vec<BodyRef>,
    /// The element that drives one coordinate of the joint. The element has the parameters of the
    /// joint.
    pub element: Box<dyn ConstraintKernels<S>>,
    /// The function f.
    pub motion: Function,
    /// Tolerance of the points, directions and scalars (m). The tolerance is equal to the tolerance
    /// of the driven joint.
    pub tolerance: Option<f64>,
}

/// The inertia of a joint coordinate, for example of a geared motor.
#[derive(Clone)]
pub struct Armature<S: BodySpace = Plane> {
    /// Name of the joint.
    pub joint: String,
    /// The bodies, in the order of the definition of the joint.
    pub bodies: Vec<BodyRef>,
    /// The element that drives the coordinate. The element has the parameters of the joint.
    pub element: Box<dyn ConstraintKernels<S>>,
    /// Inertia (kg·m² for an angle, kg for a length).
    pub inertia: f64,
}

/// An applied force.
#[derive(Clone)]
pub struct Force<S: BodySpace = Plane> {
    /// Name of the force.
    pub name: String,
    /// The bodies, in the order of the definition.
    pub bodies: Vec<BodyRef>,
    /// Definition of the force with parameters.
    pub element: Box<dyn ForceKernels<S>>,
    /// Functions of time, in the order of the definition.
    pub functions: Vec<Function>,
}

#[cfg(test)]
mod tests;
