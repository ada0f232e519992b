//! Spatial mechanisms for tests. Bodies and joints are described in ground coordinates of a home
//! pose. The whole mechanism is then moved to another pose. Body frames are rotated and have an
//! offset from the centre of mass.

use joints::space3::{Axes, Cylindrical, Direction, Planar, Pose, Revolute, Spherical};
use joints::space3::{Distance, GroundPlane, PointOnPlane, Translational, Wheel};
use model::{BodyRef, Mechanism, SpatialBody, SpatialDescription};

use crate::{Analysis, analyse};

pub(crate) const GROUND: BodyRef = BodyRef::Ground;
pub(crate) const X: [f64; 3] = [1.0, 0.0, 0.0];
pub(crate) const Y: [f64; 3] = [0.0, 1.0, 0.0];
pub(crate) const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Centre of mass of every body in its frame.
const CENTRE: [f64; 3] = [0.1, -0.2, 0.3];

/// Kinds of joints with at most one axis.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Revolute,
    Cylindrical,
    Translational,
    Spherical,
    Planar,
    /// The second point stays in the plane.
    OnPlane,
}

/// A mechanism under construction.
pub(crate) struct Sketch {
    pub(crate) d: SpatialDescription,
    moved: Pose,
}

impl Sketch {
    /// Creates a mechanism in the home pose.
    pub(crate) fn new() -> Self {
        Self::at(Pose::GROUND)
    }

    /// Creates a mechanism that is moved as a whole.
    pub(crate) fn at(moved: Pose) -> Self {
        let d = SpatialDescription::new("sketch");
        Self { d, moved }
    }

    /// Adds a body with its centre of mass at a point.
    pub(crate) fn body(&mut self, name: &str, centre: [f64; 3]) -> BodyRef {
        let turn = 0.2 * self.d.bodies.len() as f64;
        let orientation = [0.9, 0.3 + turn, -0.2, 0.5];
        let arm = Pose::new([0.0; 3], orientation).direction_to_global(CENTRE);
        let centre = self.moved.to_global(centre);
        let tensor = [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]];
        self.d.body(SpatialBody {
            centre: CENTRE,
            position: std::array::from_fn(|k| centre[k] - arm[k]),
            orientation,
            ..SpatialBody::new(name, 1.0, tensor)
        })
    }

    /// Returns a direction of the home pose in the frame of a body.
    fn direction(&self, body: BodyRef, v: [f64; 3]) -> [f64; 3] {
        let v = self.moved.direction_to_global(v);
        let [origin, tip] = [[0.0; 3], v].map(|p| self.d.local(body, p));
        std::array::from_fn(|k| tip[k] - origin[k])
    }

    /// Adds a joint at a point, with its axis or normal along w.
    pub(crate) fn joint(
        &mut self,
        name: &str,
        kind: Kind,
        bodies: [BodyRef; 2],
        at: [f64; 3],
        w: [f64; 3],
    ) {
        let [s_i, s_j] = bodies.map(|body| self.d.local(body, self.moved.to_global(at)));
        let axes = Axes::new(w, None).expect("a direction").uvw();
        let [axis, axis_j] = bodies.map(|body| {
            let [u, _, w] = axes.map(|v| self.direction(body, v));
            Axes::new(w, Some(u)).expect("a direction")
        });
        let (d, bodies) = (&mut self.d, &bodies);
        match kind {
            Kind::Revolute => d.joint(
                name,
                bodies,
                Revolute {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                },
            ),
            Kind::Cylindrical => d.joint(
                name,
                bodies,
                Cylindrical {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                },
            ),
            Kind::Translational => d.joint(
                name,
                bodies,
                Translational {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                },
            ),
            Kind::OnPlane => {
                let normal = Direction::new(axis.uvw()[2]).expect("a direction");
                d.joint(name, bodies, PointOnPlane { s_i, s_j, normal })
            }
            Kind::Spherical => d.joint(name, bodies, Spherical { s_i, s_j }),
            Kind::Planar => {
                let (normal, normal_j) = (axis, axis_j);
                d.joint(
                    name,
                    bodies,
                    Planar {
                        s_i,
                        s_j,
                        normal,
                        normal_j,
                    },
                )
            }
        };
    }

    /// Adds a bar of fixed length between a point of each body.
    pub(crate) fn bar(&mut self, name: &str, bodies: [BodyRef; 2], ends: [[f64; 3]; 2]) {
        let end = |k: usize| self.d.local(bodies[k], self.moved.to_global(ends[k]));
        let [s_i, s_j] = [end(0), end(1)];
        let bar = Distance::new(s_i, s_j);
        self.d.joint(name, &bodies, bar);
    }

    /// Adds a wheel of this radius on the plane z = 0; the mechanism must be in the home pose.
    pub(crate) fn wheel(&mut self, name: &str, wheel: BodyRef, axis: [f64; 3], radius: f64) {
        let axis = Direction::new(self.direction(wheel, axis)).expect("a direction");
        let rolls = Wheel::new([0.0; 3], axis, radius, GroundPlane::Z);
        self.d.joint(name, &[wheel], rolls);
    }

    /// Returns the mechanism, its configuration and its verdicts.
    pub(crate) fn judged(&self) -> (Mechanism, Vec<f64>, Analysis) {
        let mechanism = Mechanism::build(&self.d).expect("builds");
        let (q, _) = mechanism.described_state();
        let analysis = analyse(&mechanism, 0.0, &q).expect("a configuration");
        (mechanism, q, analysis)
    }
}

/// Returns a door with hinges of these kinds along z.
pub(crate) fn door(kinds: &[Kind], moved: Pose) -> Sketch {
    let mut s = Sketch::at(moved);
    let door = s.body("door", [0.5, 0.1, 1.0]);
    for (k, kind) in kinds.iter().enumerate() {
        let at = [0.0, 0.0, 0.4 + 0.7 * k as f64];
        s.joint(&format!("H{k}"), *kind, [GROUND, door], at, Z);
    }
    s
}

/// Returns a closed chain of three links. The joints are named in order.
pub(crate) fn loop_of_four(
    names: [&str; 7],
    kinds: [Kind; 4],
    points: [[f64; 3]; 4],
    axes: [[f64; 3]; 4],
    moved: Pose,
) -> Sketch {
    let mut s = Sketch::at(moved);
    let [a, b, c, links @ ..] = names;
    let [first, middle, last] = [(a, 0), (b, 1), (c, 2)].map(|(name, k)| {
        let (p, q): ([f64; 3], [f64; 3]) = (points[k], points[k + 1]);
        s.body(name, std::array::from_fn(|i| 0.5 * (p[i] + q[i])))
    });
    let pairs = [
        [GROUND, first],
        [first, middle],
        [middle, last],
        [last, GROUND],
    ];
    for k in 0..4 {
        s.joint(links[k], kinds[k], pairs[k], points[k], axes[k]);
    }
    s
}

const FOUR_BAR: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [0.3, 0.8, 0.0],
    [1.5, 1.1, 0.0],
    [1.4, 0.0, 0.0],
];

/// Returns the planar four-bar A(0, 0), B(.3, .8), C(1.5, 1.1), D(1.4, 0), with all axes along z.
pub(crate) fn four_bar(kinds: [Kind; 4], moved: Pose) -> Sketch {
    let names = ["crank", "coupler", "rocker", "A", "B", "C", "D"];
    loop_of_four(names, kinds, FOUR_BAR, [Z; 4], moved)
}

/// Returns the four-bar with revolute joints, with all lengths times `size`.
pub(crate) fn scaled_four_bar(size: f64, moved: Pose) -> Sketch {
    let names = ["crank", "coupler", "rocker", "A", "B", "C", "D"];
    let points = FOUR_BAR.map(|p| p.map(|x| size * x));
    loop_of_four(names, [Kind::Revolute; 4], points, [Z; 4], moved)
}

/// Returns Bennett's linkage with rational dimensions.
pub(crate) fn bennett(moved: Pose) -> Sketch {
    let names = ["first", "middle", "last", "J0", "J1", "J2", "J3"];
    let points = [
        [0.0; 3],
        [0.0, 3.0, 0.0],
        [-16.0 / 13.0, -9.0 / 13.0, 12.0 / 13.0],
        [-4.0, 0.0, 0.0],
    ];
    let axes = [Z, [3.0, 0.0, 4.0], [-3.0, 4.0, 12.0], [0.0, 4.0, 3.0]];
    loop_of_four(names, [Kind::Revolute; 4], points, axes, moved)
}

/// Returns poses to which a mechanism is moved.
pub(crate) fn places() -> [Pose; 3] {
    [
        Pose::GROUND,
        Pose::new([0.3, -0.7, 1.1], [1.0, 0.0, 0.0, 1.0]),
        Pose::new([-1.3, 2.1, 0.4], [0.9, 0.3, -0.2, 0.5]),
    ]
}
