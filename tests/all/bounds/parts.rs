//! Random parts with two undetermined load components, as scenes and as unit loads of the joints.

use model::ConstraintId;
use pfaff::solvability::ElasticLoad;
use tests::numbers::Numbers;

use super::equilibrium::{INERTIA, Loads, MASS, Unit, Vector};

/// Number of joints and drives after which another part is drawn.
const MOST: usize = 8;

/// The motion of all drives.
const REST: &str = "{ type = \"constant-rate\", rate = 0.0 }";

const AXES: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// What a part consists of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// One body on joints anywhere.
    Any,
    /// Joints at the same place.
    EqualFeet,
    /// Joints on a straight line.
    InALine,
    /// Two bodies with several joints between them, which may load each other.
    Circuit,
    /// Joints with drives.
    Drives,
    /// Joints that carry moments.
    Moments,
}

impl Kind {
    pub(super) const ALL: [Self; 6] = [
        Self::Any,
        Self::EqualFeet,
        Self::InALine,
        Self::Circuit,
        Self::Drives,
        Self::Moments,
    ];

    fn joints(self, in_space: bool) -> &'static [&'static str] {
        match (self, in_space) {
            (Self::Moments, false) => &["angle", "fixed", "translational", "point-on-line"],
            (Self::Moments, true) => &["orientation", "fixed", "translational", "cylindrical"],
            (Self::Drives, false) => &["revolute", "translational", "point-on-line"],
            (Self::Drives, true) => &["revolute", "translational", "spherical", "point-on-plane"],
            (Self::InALine, false) => &["point-on-line", "point-on-line", "revolute", "distance"],
            (Self::InALine, true) => &["point-on-plane", "spherical", "point-on-line", "revolute"],
            (_, false) => &[
                "revolute",
                "revolute",
                "fixed",
                "point-on-line",
                "pin-in-slot",
                "distance",
                "translational",
                "angle",
            ],
            (_, true) => &[
                "spherical",
                "spherical",
                "revolute",
                "fixed",
                "point-on-plane",
                "cylindrical",
                "translational",
                "distance",
                "point-on-line",
            ],
        }
    }
}

/// A part with its unit loads.
pub(super) struct Part {
    pub(super) kind: Kind,
    in_space: bool,
    bodies: Vec<Vector>,
    gravity: Vector,
    joints: Vec<String>,
    drives: Vec<String>,
    /// The joint or drive of each load, and whether the load is its moment.
    pub(super) loads: Vec<(Owner, bool)>,
    units: Vec<Unit>,
}

/// A joint or drive with its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Owner {
    Joint(usize),
    Drive(usize),
}

impl Part {
    /// Draws parts of a kind until one has two undetermined load components.
    pub(super) fn draw(kind: Kind, in_space: bool, numbers: &mut Numbers) -> (Self, Loads) {
        loop {
            let mut part = Self::empty(kind, in_space, numbers);
            let direction = direction(in_space, numbers);
            let origin = point(in_space, numbers);
            let mut places: Vec<Vector> = Vec::new();
            for k in 0..MOST {
                let at = match kind {
                    Kind::EqualFeet if k > 0 && numbers.once_in(2) => {
                        places[numbers.below(places.len())]
                    }
                    Kind::InALine => {
                        let t = 0.5 * numbers.between(-4, 4) as f64;
                        [0, 1, 2].map(|i| origin[i] + t * direction[i])
                    }
                    _ => point(in_space, numbers),
                };
                places.push(at);
                let bodies = match part.bodies.len() {
                    1 => [Some(0), None],
                    _ if k < 2 || numbers.once_in(4) => [Some(0), Some(1)],
                    _ => [Some(numbers.below(2)), None],
                };
                let bodies = if numbers.once_in(3) {
                    [bodies[1], bodies[0]]
                } else {
                    bodies
                };
                part.add(bodies, at, numbers);
                let Some(loads) = part.equilibrium() else {
                    break;
                };
                match loads.free() {
                    0 | 1 => {}
                    2 => return (part, loads),
                    _ => break,
                }
            }
        }
    }

    fn empty(kind: Kind, in_space: bool, numbers: &mut Numbers) -> Self {
        let count = match kind {
            Kind::Circuit => 2,
            _ => 1,
        };
        let [x, y, z] = point(in_space, numbers);
        let gravity = if in_space {
            [x, y, z - 9.81]
        } else {
            [x, y - 9.81, 0.0]
        };
        Self {
            kind,
            in_space,
            bodies: (0..count).map(|_| point(in_space, numbers)).collect(),
            gravity,
            joints: Vec::new(),
            drives: Vec::new(),
            loads: Vec::new(),
            units: Vec::new(),
        }
    }

    /// Adds a random joint, perhaps with a drive.
    fn add(&mut self, bodies: [Option<usize>; 2], at: Vector, numbers: &mut Numbers) {
        let types = self.kind.joints(self.in_space);
        let (kind, bodies) = match (types[numbers.below(types.len())], bodies) {
            // In the plane, a point on a line is a point of one body.
            ("point-on-line", [Some(_), Some(_)]) if !self.in_space => ("pin-in-slot", bodies),
            ("point-on-line", [None, body]) if !self.in_space => ("point-on-line", [body, None]),
            (kind, bodies) => (kind, bodies),
        };
        let axis = direction(self.in_space, numbers);
        let [first, second] = bodies.map(|k| k.map_or("ground".to_owned(), |k| format!("b{k}")));
        let other = [0, 1, 2].map(|k| at[k] + axis[k]);
        let [place, along, end] = [at, axis, other].map(|v| self.list(v));
        let keys = match kind {
            "angle" | "orientation" => String::new(),
            "distance" => format!(", at = [{place}, {end}]"),
            "point-on-plane" => format!(", at = {place}, normal = {along}"),
            "point-on-line" if !self.in_space => format!(", at = {place}, line = [{place}, {end}]"),
            "fixed" | "spherical" => format!(", at = {place}"),
            "revolute" if !self.in_space => format!(", at = {place}"),
            _ => format!(", at = {place}, axis = {along}"),
        };
        let of = match kind {
            "point-on-line" if !self.in_space => format!("body = \"{first}\""),
            _ => format!("bodies = [\"{first}\", \"{second}\"]"),
        };
        let number = self.joints.len();
        let joint = format!("{{ name = \"j{number}\", type = \"{kind}\", {of}{keys} }},");
        self.joints.push(joint);
        let axes = Axes::new(axis, self.in_space);
        let [forces, moments] = axes.of_joint(kind, self.in_space);
        self.load((Owner::Joint(number), false), bodies, at, &forces);
        self.load((Owner::Joint(number), true), bodies, at, &moments);
        let (measure, is_moment, axis) = match kind {
            "revolute" => ("angle", true, axes.turn),
            "translational" => ("displacement", false, axes.along),
            _ => return,
        };
        if matches!(self.kind, Kind::Drives) {
            let own = (Owner::Drive(self.drives.len()), is_moment);
            self.drives.push(format!(
                "{{ name = \"d{number}\", joint = \"j{number}\", type = \"{measure}\", motion = {REST} }},"
            ));
            self.load(own, bodies, at, &[axis]);
        }
    }

    /// Adds a load with its unit loads along these axes, if there are any.
    fn load(
        &mut self,
        own: (Owner, bool),
        bodies: [Option<usize>; 2],
        at: Vector,
        axes: &[Vector],
    ) {
        if axes.is_empty() {
            return;
        }
        let load = self.loads.len();
        self.loads.push(own);
        self.units.extend(axes.iter().map(|&axis| Unit {
            bodies,
            at,
            axis,
            is_moment: own.1,
            load,
        }));
    }

    /// Returns the scene.
    pub(super) fn scene(&self) -> String {
        let space = if self.in_space { "spatial" } else { "plane" };
        let inertia = if self.in_space {
            format!("{INERTIA:?}")
        } else {
            format!("{:?}", INERTIA[2])
        };
        let bodies = self.bodies.iter().enumerate().map(|(k, at)| {
            format!(
                "    {{ name = \"b{k}\", mass = {MASS:?}, inertia = {inertia}, position = {} }},\n",
                self.list(*at)
            )
        });
        format!(
            "scene = {{ name = \"part\", space = \"{space}\", gravity = {} }}\nbody = [\n{}]\n\
             joint = [\n    {}\n]\ndrive = [\n    {}\n]\n",
            self.list(self.gravity),
            bodies.collect::<String>(),
            self.joints.join("\n    "),
            self.drives.join("\n    ")
        )
    }

    fn list(&self, v: Vector) -> String {
        format!("{:?}", if self.in_space { &v[..] } else { &v[..2] })
    }

    fn equilibrium(&self) -> Option<Loads> {
        Loads::of(&self.units, &self.bodies, self.gravity)
    }

    /// Returns the joint or drive with this number: drives follow all joints.
    fn owner(&self, reaction: ConstraintId) -> Owner {
        match reaction.0.checked_sub(self.joints.len()) {
            None => Owner::Joint(reaction.0),
            Some(drive) => Owner::Drive(drive),
        }
    }

    /// Returns the number of a load.
    pub(super) fn load_of(&self, load: ElasticLoad) -> usize {
        let own = (self.owner(load.reaction), load.is_moment);
        let found = self.loads.iter().position(|known| *known == own);
        found.unwrap_or_else(|| panic!("{load:?} is not a load of\n{}", self.scene()))
    }

    /// Returns the coefficients of the unit loads in a component of a reaction on the first body:
    /// a force or moment along an axis, or the load of a drive.
    pub(super) fn component(&self, reaction: ConstraintId, name: &str) -> Vec<f64> {
        let own = self.owner(reaction);
        let coefficient = |unit: &Unit| {
            let (owner, is_moment) = self.loads[unit.load];
            let along = match &name[..1] {
                "F" | "T" if name.starts_with('T') != is_moment => 0.0,
                "F" | "T" => match name.as_bytes().last() {
                    Some(b'x') => unit.axis[0],
                    Some(b'y') => unit.axis[1],
                    _ => unit.axis[2],
                },
                _ => 1.0,
            };
            if owner == own { along } else { 0.0 }
        };
        self.units.iter().map(coefficient).collect()
    }
}

fn point(in_space: bool, numbers: &mut Numbers) -> Vector {
    let mut next = || (numbers.unit() * 1024.0).round() / 1024.0;
    let [x, y, z] = [next(), next(), next()];
    [x, y, if in_space { z } else { 0.0 }]
}

/// Returns a direction along an axis or any other one. Its length is not 1.
fn direction(in_space: bool, numbers: &mut Numbers) -> Vector {
    let mut axis = [0.0; 3];
    if numbers.once_in(2) {
        axis[numbers.below(if in_space { 3 } else { 2 })] = 1.0;
        return axis;
    }
    loop {
        let axis = point(in_space, numbers);
        if linalg::kernels::norm(&axis) > 0.3 {
            return axis;
        }
    }
}

/// Unit vectors of a joint.
struct Axes {
    along: Vector,
    /// Across the direction of the joint: two vectors in space, one in the plane.
    across: Vec<Vector>,
    /// The axis of rotation of a revolute joint.
    turn: Vector,
}

impl Axes {
    fn new(axis: Vector, in_space: bool) -> Self {
        let unit = |v: Vector| v.map(|x| x / linalg::kernels::norm(&v));
        let cross = |a: Vector, b: Vector| {
            [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
        };
        let along = unit(axis);
        if !in_space {
            let turn = AXES[2];
            let across = vec![cross(turn, along)];
            return Self {
                along,
                across,
                turn,
            };
        }
        let other = AXES
            .into_iter()
            .find(|a| linalg::kernels::dot(a, &along).abs() < 0.6);
        let first = unit(cross(other.expect("not along all axes"), along));
        let across = vec![first, cross(along, first)];
        Self {
            along,
            across,
            turn: along,
        }
    }

    /// Returns the axes of the force and of the moment of a joint of a type.
    fn of_joint(&self, kind: &str, in_space: bool) -> [Vec<Vector>; 2] {
        let none = Vec::new;
        let across = || self.across.clone();
        let (all, turns) = if in_space {
            (AXES.to_vec(), AXES.to_vec())
        } else {
            (AXES[..2].to_vec(), AXES[2..].to_vec())
        };
        match kind {
            "revolute" if in_space => [all, across()],
            "revolute" | "spherical" => [all, none()],
            "fixed" => [all, turns],
            "angle" | "orientation" => [none(), turns],
            "translational" => [across(), turns],
            "pin-in-slot" | "point-on-line" => [across(), none()],
            "cylindrical" => [across(), across()],
            "point-on-plane" | "distance" => [vec![self.along], none()],
            other => unreachable!("{other} is not drawn"),
        }
    }
}
