//! The common data of all formats: links with mass and position, joints between links, couplings.
//!
//! All positions refer to the *described* pose, at which the coordinates of all joints have the
//! values `zero`. A link that is `None` is the ground.

use std::collections::HashSet;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::findings::Findings;
use crate::mass::Mass;

/// A rigid part of a file.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    /// Transformation from the axes of the link to the axes of the ground, at the described pose.
    pub(crate) pose: Isometry3<f64>,
    /// Mass in the axes of the link.
    pub(crate) mass: Mass,
    /// Compensated weights of the link and of the links merged into it.
    pub(crate) held: Vec<HeldWeight>,
}

/// A weight that is compensated: `gravcomp` of MuJoCo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldWeight {
    /// Share of the weight, multiplied by the mass (kg).
    pub(crate) mass: f64,
    /// Centre of mass in the axes of the link (m).
    pub(crate) centre: Vector3<f64>,
}

impl HeldWeight {
    /// The compensated weight of a link: a share of the weight of its mass.
    pub(crate) fn of(share: f64, mass: &Mass) -> Vec<Self> {
        let held = Self {
            mass: share * mass.mass,
            centre: mass.centre,
        };
        { [held].into_iter() }
            .filter(|held| held.mass != 0.0)
            .collect()
    }

    /// Combines weights of the same sign to one weight at their common centre. Weights of different
    /// signs can form a pure torque, which has no centre.
    pub(crate) fn combined(parts: &[Self]) -> Vec<Self> {
        let (up, down): (Vec<Self>, Vec<Self>) = parts.iter().partition(|part| part.mass > 0.0);
        let sum = |parts: &[Self]| -> Option<Self> {
            let (first, rest) = parts.split_first()?;
            Some(rest.iter().fold(*first, Self::plus))
        };
        [sum(&up), sum(&down)].into_iter().flatten().collect()
    }

    fn plus(self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let centre = (self.centre * self.mass + other.centre * other.mass) / mass;
        Self { mass, centre }
    }
}

/// Degrees of freedom of the second link relative to the first link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum JointKind {
    Revolute,
    Translational,
    Spherical,
    /// Rotations about the axis of the first link, then about the axis `cross` of the second link.
    Universal,
    Cylindrical,
    /// Advance in metres per revolution.
    Screw(f64),
    Planar,
    Fixed,
    /// Six degrees of freedom. The scene has no joint in this case, but the file has coordinates.
    Free,
}

impl JointKind {
    /// The type in a scene; `None` if the scene has no such joint.
    pub(crate) fn name(self) -> Option<&'static str> {
        match self {
            Self::Revolute => Some("revolute"),
            Self::Translational => Some("translational"),
            Self::Spherical => Some("spherical"),
            Self::Universal => Some("universal"),
            Self::Cylindrical => Some("cylindrical"),
            Self::Screw(_) => Some("screw"),
            Self::Planar => Some("planar"),
            Self::Fixed => Some("fixed"),
            Self::Free => None,
        }
    }

    /// Names of the joint coordinates in a scene, in the order of the coordinates.
    pub(crate) fn measures(self) -> &'static [&'static str] {
        match self {
            Self::Revolute => &["angle"],
            Self::Translational => &["displacement"],
            Self::Universal => &["first", "second"],
            Self::Cylindrical => &["displacement", "angle"],
            Self::Screw(_) => &["angle"],
            Self::Spherical | Self::Planar | Self::Fixed | Self::Free => &[],
        }
    }
}

/// Loads on a coordinate of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Load {
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// Value of the coordinate at which the spring has no load.
    pub(crate) reference: f64,
    /// Inertia of a rotor that rotates with the coordinate (kg·m², or kg along a slide).
    pub(crate) armature: f64,
}

/// A joint between two links.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    /// Names of the coordinates. These are the names of the joints in the file that this joint
    /// replaces.
    pub(crate) names: [String; 2],
    pub(crate) kind: JointKind,
    /// First and second link.
    pub(crate) links: [Option<usize>; 2],
    /// Whether the joint is an edge of the tree of links and determines the position of its second
    /// link. Other joints close loops.
    pub(crate) places: bool,
    /// Point of the joint in the axes of each link.
    pub(crate) points: [Vector3<f64>; 2],
    /// Axis of the joint in the axes of each link.
    pub(crate) axes: [Vector3<f64>; 2],
    /// Second axis of a universal joint, in the axes of the second link.
    pub(crate) cross: Vector3<f64>,
    /// The axes in both links that must coincide, for joints that close a loop and fix the relative
    /// orientation. `None` means that the relative orientation at the described pose is fixed.
    pub(crate) frames: Option<[UnitQuaternion<f64>; 2]>,
    /// Values of the coordinates at the described pose.
    pub(crate) zero: [f64; 2],
    /// Changes of the coordinates from the pose at which the points of the joint coincide to the
    /// described pose. The import moves links to close loops and to satisfy couplings.
    pub(crate) described: [f64; 2],
    /// Changes of the coordinates from the described pose to the initial pose.
    pub(crate) moved: [f64; 2],
    pub(crate) loads: [Load; 2],
    pub(crate) is_active: bool,
}

impl Joint {
    /// Creates a joint without loads that determines the position of its second link.
    pub(crate) fn new(
        name: impl Into<String>,
        kind: JointKind,
        links: [Option<usize>; 2],
        points: [Vector3<f64>; 2],
        axes: [Vector3<f64>; 2],
    ) -> Self {
        let name = name.into();
        Self {
            names: [name.clone(), name.clone()],
            name,
            kind,
            links,
            places: true,
            points,
            axes,
            cross: Vector3::z(),
            frames: None,
            zero: [0.0; 2],
            described: [0.0; 2],
            moved: [0.0; 2],
            loads: [Load::default(); 2],
            is_active: true,
        }
    }
}

/// Records that the described pose of a joint has changed by these changes of its coordinates.
pub(crate) fn redescribe(joint: &mut Joint, change: [f64; 2]) {
    for (k, change) in change.into_iter().enumerate() {
        joint.zero[k] += change;
        joint.described[k] += change;
    }
}

/// The equation y = a₀ + a₁·x + a₂·x² + …. The variables x and y are changes of joint coordinates
/// from the values to which `coefficients` refer.
#[derive(Clone, Debug)]
pub(crate) struct Coupling {
    pub(crate) name: String,
    /// Joint and coordinate of x; `None` locks y at a₀.
    pub(crate) x: Option<(usize, usize)>,
    pub(crate) y: (usize, usize),
    pub(crate) coefficients: Vec<f64>,
    pub(crate) is_active: bool,
}

/// An actuator of the file that acts on a joint coordinate.
#[derive(Clone, Debug)]
pub(crate) struct Actuator {
    /// The name in the file; empty if the element has no name of its own.
    pub(crate) name: String,
    /// Joint and coordinate.
    pub(crate) at: (usize, usize),
    /// The index of its element in the omissions.
    pub(crate) omission: usize,
    /// Whether the actuator is a force on the coordinate itself, without a gear, a law or limits.
    pub(crate) is_plain: bool,
}

/// A drive of the scene.
#[derive(Clone, Debug)]
pub(crate) struct Drive {
    pub(crate) name: String,
    /// Joint and coordinate.
    pub(crate) at: (usize, usize),
    /// Whether the drive prescribes the coordinate. Otherwise it has a force law.
    pub(crate) is_motion: bool,
}

/// A named frame of a link, from a site or frame of the file.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub(crate) name: String,
    pub(crate) link: Option<usize>,
    pub(crate) pose: Isometry3<f64>,
}

/// The coordinates and velocities of all joints, as given by a keyframe.
#[derive(Clone, Debug)]
pub(crate) struct Keyframe {
    pub(crate) name: String,
    /// Line in the file.
    pub(crate) line: usize,
    /// The coordinates of each joint. A spherical joint has a quaternion (w, x, y, z), and a free
    /// link has position and quaternion.
    pub(crate) q: Vec<Vec<f64>>,
    /// The velocities of each joint. For a spherical joint and for the rotation of a free link,
    /// these are the components of the angular velocity in the axes of the link. `None` if all
    /// velocities are zero.
    pub(crate) v: Option<Vec<Vec<f64>>>,
}

/// All data that are read from a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    pub(crate) name: String,
    pub(crate) gravity: Vector3<f64>,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) couplings: Vec<Coupling>,
    pub(crate) actuators: Vec<Actuator>,
    /// Joints on which no actuator can act.
    pub(crate) passive: HashSet<usize>,
    pub(crate) drives: Vec<Drive>,
    pub(crate) frames: Vec<Frame>,
    pub(crate) states: Vec<Keyframe>,
}

impl Model {
    /// Number of coordinates with an armature.
    pub(crate) fn armatures(&self) -> usize {
        let active = self.joints.iter().filter(|joint| joint.is_active);
        let loads = active.flat_map(|joint| joint.loads);
        loads.filter(|load| load.armature != 0.0).count()
    }

    /// Adds an actuator whose element is the last omission. If the joint does not have the
    /// coordinate, the element remains an omission.
    pub(crate) fn actuate(
        &mut self,
        name: &str,
        at: (usize, usize),
        is_plain: bool,
        findings: &Findings,
    ) {
        let joint = self.joints.get(at.0);
        let has = joint.is_some_and(|joint| joint.kind.measures().len() > at.1);
        if let (true, Some(omission)) = (has, findings.omissions.len().checked_sub(1)) {
            self.actuators.push(Actuator {
                name: name.trim().to_owned(),
                at,
                omission,
                is_plain,
            });
        }
    }

    /// Pose of a link at the described pose of the model.
    pub(crate) fn pose(&self, link: Option<usize>) -> Isometry3<f64> {
        link.and_then(|link| self.links.get(link))
            .map_or_else(Isometry3::identity, |link| link.pose)
    }
}
