//! What all formats are read into: links with mass and place, joints between them, couplings.
//!
//! Everything is at the *described* pose, at which the coordinates of all joints have the values
//! `zero`. A link that is `None` is the ground.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::mass::Mass;

/// A rigid part of a file.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    /// From its axes to those of the ground, at the described pose.
    pub(crate) pose: Isometry3<f64>,
    /// In its axes.
    pub(crate) mass: Mass,
    /// Share of its weight that is held from outside: MuJoCo's `gravcomp`.
    pub(crate) held_weight: f64,
}

/// What a joint lets its second link do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum JointKind {
    Revolute,
    Translational,
    Spherical,
    /// About the axis of the first link, then about `cross` of the second.
    Universal,
    Cylindrical,
    /// Metres of advance per turn.
    Screw(f64),
    Planar,
    Fixed,
    /// Six freedoms: no joint, but coordinates of a file.
    Free,
}

impl JointKind {
    /// The type in a scene; `None` if it has no joint there.
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

    /// Names of its measures in a scene, in the order of its coordinates.
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
    /// Value of the coordinate without a load of the spring.
    pub(crate) reference: f64,
    /// Inertia of a rotor that turns with the coordinate.
    pub(crate) armature: f64,
}

/// A joint between two links.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    /// Names of its coordinates: those of the joints of the file that it stands for.
    pub(crate) names: [String; 2],
    pub(crate) kind: JointKind,
    /// First and second link.
    pub(crate) links: [Option<usize>; 2],
    /// Whether it places the second link: it is an edge of the tree of links. Other joints close
    /// loops.
    pub(crate) places: bool,
    /// Its point in the axes of each link.
    pub(crate) points: [Vector3<f64>; 2],
    /// Its axis in the axes of each link.
    pub(crate) axes: [Vector3<f64>; 2],
    /// Second axis of a universal joint, in the axes of the second link.
    pub(crate) cross: Vector3<f64>,
    /// For joints that keep an orientation and close a loop: the axes of both links that have to
    /// coincide. `None` keeps the relation at the described pose.
    pub(crate) frames: Option<[UnitQuaternion<f64>; 2]>,
    /// Values of its coordinates at the described pose.
    pub(crate) zero: [f64; 2],
    /// Changes of its coordinates from the described pose to the start.
    pub(crate) moved: [f64; 2],
    pub(crate) loads: [Load; 2],
    pub(crate) is_active: bool,
}

impl Joint {
    /// A joint without loads that places its second link.
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
            moved: [0.0; 2],
            loads: [Load::default(); 2],
            is_active: true,
        }
    }
}

/// y = a₀ + a₁·x + a₂·x² + …, with x, y the coordinates of joints, measured from where
/// `coefficients` are told.
#[derive(Clone, Debug)]
pub(crate) struct Coupling {
    pub(crate) name: String,
    /// Joint and coordinate of x; `None` holds y at a₀.
    pub(crate) x: Option<(usize, usize)>,
    pub(crate) y: (usize, usize),
    pub(crate) coefficients: Vec<f64>,
    pub(crate) is_active: bool,
}

/// A place of a link with a name: sites and frames.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub(crate) name: String,
    pub(crate) link: Option<usize>,
    pub(crate) pose: Isometry3<f64>,
}

/// A state of all joints by coordinates, as a keyframe tells it.
#[derive(Clone, Debug)]
pub(crate) struct Keyframe {
    pub(crate) name: String,
    /// The line of the file.
    pub(crate) line: usize,
    /// For each joint its coordinates: for a spherical joint a quaternion (w, x, y, z), for a free
    /// link position and quaternion.
    pub(crate) q: Vec<Vec<f64>>,
    /// For each joint its velocities; a spherical joint and the rotation of a free link have their
    /// angular velocity in the axes of the link. `None` if all are zero.
    pub(crate) v: Option<Vec<Vec<f64>>>,
}

/// Everything that is read of a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    pub(crate) name: String,
    pub(crate) gravity: Vector3<f64>,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) couplings: Vec<Coupling>,
    pub(crate) frames: Vec<Frame>,
    pub(crate) states: Vec<Keyframe>,
}

impl Model {
    /// Number of coordinates with an armature, each of which becomes a rotor.
    pub(crate) fn rotors(&self) -> usize {
        let active = self.joints.iter().filter(|joint| joint.is_active);
        let loads = active.flat_map(|joint| joint.loads);
        loads.filter(|load| load.armature != 0.0).count()
    }

    /// Where a link is at the described pose.
    pub(crate) fn pose(&self, link: Option<usize>) -> Isometry3<f64> {
        link.and_then(|link| self.links.get(link))
            .map_or_else(Isometry3::identity, |link| link.pose)
    }
}
