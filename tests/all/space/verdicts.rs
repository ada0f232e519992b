//! Compares verdicts in space with known results: rows, rank, redundancy, mobility, and which
//! reactions are unique. The results follow from screws of single loops, from planar linkages in
//! space, and from exact arithmetic (crate `lab`, `fuzz::space`).

use joints::space3::{Axes, Cylindrical, Direction, Planar, Revolute, Spherical, Translational};
use joints::space3::{Pose, Universal};
use model::{BodyRef, Mechanism, SpatialBody, SpatialDescription, System};
use solvability::{ReactionVerdict, Verdict, analyse};

/// A mechanism under construction: all joints are placed in ground coordinates.
struct Sketch {
    d: SpatialDescription,
}

pub(super) const TENSOR: [[f64; 3]; 3] = [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]];

/// The kinds of joints with an axis.
#[derive(Clone, Copy)]
enum Kind {
    R,
    C,
    P,
    S,
    Flat,
}

impl Sketch {
    fn new(name: &str) -> Self {
        Self {
            d: SpatialDescription::new(name),
        }
    }

    /// Adds a body with its mass centre at a point and rotated axes.
    fn body(&mut self, name: &str, position: [f64; 3], orientation: [f64; 4]) -> BodyRef {
        self.d.body(SpatialBody {
            position,
            orientation,
            ..SpatialBody::new(name, 1.0, TENSOR)
        })
    }

    /// Returns axes along a direction of the ground, in a body.
    fn axes(&self, body: BodyRef, axis: [f64; 3]) -> Axes {
        let axes = Axes::new(axis, None).expect("a direction");
        axes.map(|v| self.direction(body, v))
    }

    fn direction(&self, body: BodyRef, v: [f64; 3]) -> [f64; 3] {
        let origin = self.d.local(body, [0.0; 3]);
        let tip = self.d.local(body, v);
        std::array::from_fn(|k| tip[k] - origin[k])
    }

    fn joint(&mut self, name: &str, kind: Kind, bodies: [BodyRef; 2], at: [f64; 3], w: [f64; 3]) {
        let [s_i, s_j] = bodies.map(|body| self.d.local(body, at));
        let [axis, axis_j] = bodies.map(|body| self.axes(body, w));
        match kind {
            Kind::R => drop(self.d.joint(
                name,
                &bodies,
                Revolute {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                },
            )),
            Kind::C => drop(self.d.joint(
                name,
                &bodies,
                Cylindrical {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                },
            )),
            Kind::P => drop(self.d.joint(
                name,
                &bodies,
                Translational {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                },
            )),
            Kind::S => drop(self.d.joint(name, &bodies, Spherical { s_i, s_j })),
            Kind::Flat => drop(self.d.joint(
                name,
                &bodies,
                Planar {
                    s_i,
                    s_j,
                    normal: axis,
                    normal_j: axis_j,
                },
            )),
        }
    }

    /// Adds a cross with its axis `a` fixed in the first body and `b` in the second.
    fn cross(&mut self, name: &str, bodies: [BodyRef; 2], at: [f64; 3], a: [f64; 3], b: [f64; 3]) {
        let [s_i, s_j] = bodies.map(|body| self.d.local(body, at));
        let [axis, cross] = [(0, a), (1, b)]
            .map(|(k, v)| Direction::new(self.direction(bodies[k], v)).expect("a direction"));
        self.d
            .joint(name, &bodies, Universal::new(s_i, s_j, axis, cross));
    }

    fn build(&self) -> Mechanism {
        Mechanism::build(&self.d).unwrap_or_else(|e| panic!("{}: {e:?}", self.d.name))
    }
}

/// A motion of the whole mechanism: every body and every joint of a sketch is placed through it.
#[derive(Clone, Copy)]
pub(super) struct Motion(pub(super) Pose);

impl Motion {
    pub(super) fn all() -> [Self; 3] {
        [
            Pose::GROUND,
            Pose::new([0.3, -0.7, 1.1], [1.0, 0.0, 0.0, 1.0]),
            Pose::new([-1.3, 2.1, 0.4], [0.9, 0.3, -0.2, 0.5]),
        ]
        .map(Self)
    }

    pub(super) fn point(&self, p: [f64; 3]) -> [f64; 3] {
        self.0.to_global(p)
    }

    pub(super) fn vector(&self, v: [f64; 3]) -> [f64; 3] {
        self.0.direction_to_global(v)
    }
}

/// Rows, rank, redundancy and mobility.
type Ranks = [usize; 4];

fn judge(sketch: &Sketch, expected: Ranks) -> Vec<ReactionVerdict> {
    let mechanism = sketch.build();
    let (q, _) = mechanism.described_state();
    let name = mechanism.name().to_owned();
    let analysis = analyse(&mechanism, 0.0, &q).unwrap_or_else(|e| panic!("{name}: {e}"));
    let rows = mechanism.layout().rows();
    let decision = &analysis.decision;
    assert!(decision.is_decided(), "{name}: {decision:?}");
    let r = decision.rank;
    let found = [rows, r, rows - r, mechanism.layout().n_v - r];
    assert_eq!(found, expected, "{name}: {decision:?}");
    analysis.reactions
}

/// Returns the components of a reaction that are unique, in ground axes.
fn unique(reactions: &[ReactionVerdict], name: &str) -> Vec<&'static str> {
    let reaction = reactions.iter().find(|r| r.name == name).expect(name);
    let unique = |c: &&solvability::ComponentVerdict| c.judgement.verdict == Verdict::Unique;
    reaction
        .components
        .iter()
        .filter(unique)
        .map(|c| c.name)
        .collect()
}

fn is_unique(reactions: &[ReactionVerdict], name: &str) -> bool {
    let reaction = reactions.iter().find(|r| r.name == name).expect(name);
    reaction.wrench.verdict == Verdict::Unique
}

/// Case V1 is a door on n coaxial hinges.
#[test]
fn doors() {
    for motion in Motion::all() {
        let door = |kinds: &[Kind]| {
            let mut s = Sketch::new("door");
            let body = s.body("door", motion.point([0.5, 0.1, 1.0]), [0.8, 0.1, -0.4, 0.3]);
            for (k, kind) in kinds.iter().enumerate() {
                let at = motion.point([0.0, 0.0, 0.4 + 0.7 * k as f64]);
                let name = format!("H{k}");
                s.joint(
                    &name,
                    *kind,
                    [BodyRef::Ground, body],
                    at,
                    motion.vector([0.0, 0.0, 1.0]),
                );
            }
            s
        };
        let three = judge(&door(&[Kind::R; 3]), [15, 5, 10, 1]);
        assert!(["H0", "H1", "H2"].iter().all(|h| !is_unique(&three, h)));
        judge(&door(&[Kind::R; 2]), [10, 5, 5, 1]);
        judge(&door(&[Kind::R]), [5, 5, 0, 1]);
        judge(&door(&[Kind::R, Kind::C, Kind::C]), [13, 5, 8, 1]);
        let good = judge(&door(&[Kind::R, Kind::S]), [8, 5, 3, 1]);
        assert!(!is_unique(&good, "H1"));
    }
}

const A: [f64; 3] = [0.0, 0.0, 0.0];
const B: [f64; 3] = [0.3, 0.8, 0.0];
const C: [f64; 3] = [1.5, 1.1, 0.0];
const D: [f64; 3] = [1.4, 0.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn four_bar(name: &str, kinds: [Kind; 4], motion: &Motion) -> Sketch {
    let mut s = Sketch::new(name);
    let mid = |p: [f64; 3], q: [f64; 3]| -> [f64; 3] {
        motion.point(std::array::from_fn(|k| 0.5 * (p[k] + q[k])))
    };
    let crank = s.body("crank", mid(A, B), [1.0, 0.2, 0.3, -0.4]);
    let coupler = s.body("coupler", mid(B, C), [0.5, -0.2, 0.7, 0.1]);
    let rocker = s.body("rocker", mid(C, D), [1.0, 0.0, 0.0, 0.0]);
    let places = [
        ("A", [BodyRef::Ground, crank], A),
        ("B", [crank, coupler], B),
        ("C", [coupler, rocker], C),
        ("D", [rocker, BodyRef::Ground], D),
    ];
    for ((name, bodies, at), kind) in places.into_iter().zip(kinds) {
        s.joint(name, kind, bodies, motion.point(at), motion.vector(Z));
    }
    s
}

/// Case V3 is the planar four-bar with joints of space.
#[test]
fn four_bars() {
    use Kind::{C, R, S};
    let at_home = Motion(Pose::GROUND);
    let planar = judge(&four_bar("RRRR", [R; 4], &at_home), [20, 17, 3, 1]);
    for joint in ["A", "B", "C", "D"] {
        // Tz of a revolute is zero, and so it is unique.
        assert_eq!(unique(&planar, joint), ["Fx", "Fy", "Tz"], "{joint}");
    }
    let ball = judge(&four_bar("RRRS", [R, R, R, S], &at_home), [18, 17, 1, 1]);
    for joint in ["A", "B", "C", "D"] {
        let found = unique(&ball, joint);
        assert!(
            found.contains(&"Fx") && found.contains(&"Fy") && !found.contains(&"Fz"),
            "{joint}"
        );
    }
    // A–D is along x: the self-stress is a force along z through D, without moment about x at A.
    assert!(unique(&ball, "A").contains(&"Tx"));
    for motion in Motion::all() {
        judge(&four_bar("RRRR", [R; 4], &motion), [20, 17, 3, 1]);
        judge(&four_bar("RRRS", [R, R, R, S], &motion), [18, 17, 1, 1]);
        for kinds in [[R, R, S, C], [R, S, C, R]] {
            let reactions = judge(&four_bar("p = 0", kinds, &motion), [17, 17, 0, 1]);
            assert!(
                ["A", "B", "C", "D"]
                    .iter()
                    .all(|j| is_unique(&reactions, j))
            );
        }
        judge(&four_bar("RRCR", [R, R, C, R], &motion), [19, 17, 2, 1]);
        judge(&four_bar("RSSR", [R, S, S, R], &motion), [16, 16, 0, 2]);
    }
}

/// Case V4 contains slider-cranks.
#[test]
fn slider_cranks() {
    use Kind::{C, P, R, S};
    for motion in Motion::all() {
        let slider = |kinds: [Kind; 4]| {
            let mut s = Sketch::new("slider-crank");
            let [o, a, b] = [[0.0; 3], [0.3, 0.4, 0.0], [1.5, 0.0, 0.0]];
            let crank = s.body(
                "crank",
                motion.point([0.15, 0.2, 0.0]),
                [1.0, 0.2, 0.3, -0.4],
            );
            let rod = s.body("rod", motion.point([0.9, 0.2, 0.0]), [0.3, 0.2, -0.7, 0.4]);
            let block = s.body("block", motion.point(b), [1.0, 0.5, 0.0, 0.0]);
            let x = motion.vector([1.0, 0.0, 0.0]);
            let z = motion.vector(Z);
            s.joint("O", kinds[0], [BodyRef::Ground, crank], motion.point(o), z);
            s.joint("A", kinds[1], [crank, rod], motion.point(a), z);
            s.joint("B", kinds[2], [rod, block], motion.point(b), z);
            s.joint(
                "slide",
                kinds[3],
                [BodyRef::Ground, block],
                motion.point(b),
                x,
            );
            s
        };
        judge(&slider([R, R, R, P]), [20, 17, 3, 1]);
        judge(&slider([R, R, C, P]), [19, 17, 2, 1]);
        judge(&slider([R, R, S, P]), [18, 17, 1, 1]);
        judge(&slider([R, S, R, P]), [18, 17, 1, 1]);
    }
}

/// Case V10 is a Hooke joint between two bearings, with its cross as a body or as one joint.
#[test]
fn hooke_joints() {
    for motion in Motion::all() {
        let (sin, cos) = 0.5_f64.sin_cos();
        let first = motion.vector([1.0, 0.0, 0.0]);
        let second = motion.vector([cos, sin, 0.0]);
        // The axes of the cross are z on the first shaft, and the direction across both on the
        // second.
        let [a, b] = [Z, [-sin, cos, 0.0]].map(|v| motion.vector(v));
        let [centre, left, right] =
            [[0.0; 3], [-0.6, 0.0, 0.0], [0.7 * cos, 0.7 * sin, 0.0]].map(|p| motion.point(p));
        let mut s = Sketch::new("Hooke joint");
        let input = s.body(
            "input",
            motion.point([-0.3, 0.0, 0.0]),
            [1.0, 0.0, 0.2, 0.0],
        );
        let output = s.body(
            "output",
            motion.point([0.3, 0.2, 0.0]),
            [1.0, 0.1, 0.0, 0.5],
        );
        s.joint("left", Kind::R, [BodyRef::Ground, input], left, first);
        s.joint("right", Kind::R, [BodyRef::Ground, output], right, second);
        let mut with_joint = Sketch { d: s.d.clone() };
        let cross = s.body("cross", centre, [1.0, 0.0, 0.0, 0.3]);
        s.joint("arm", Kind::R, [input, cross], centre, a);
        s.joint("other arm", Kind::R, [cross, output], centre, b);
        judge(&s, [20, 17, 3, 1]);
        with_joint.cross("cross", [input, output], centre, a, b);
        judge(&with_joint, [14, 11, 3, 1]);
    }
}

/// Case V11 is Bennett's linkage in rational numbers: one redundant row, and no reaction is unique.
#[test]
fn bennett() {
    for motion in Motion::all() {
        let points = [
            [0.0; 3],
            [0.0, 3.0, 0.0],
            [-16.0 / 13.0, -9.0 / 13.0, 12.0 / 13.0],
            [-4.0, 0.0, 0.0],
        ];
        let axes = [
            [0.0, 0.0, 1.0],
            [3.0, 0.0, 4.0],
            [-3.0, 4.0, 12.0],
            [0.0, 4.0, 3.0],
        ];
        let mut s = Sketch::new("Bennett");
        let bodies = [0, 1, 2].map(|k| {
            let (p, q): ([f64; 3], [f64; 3]) = (points[k], points[k + 1]);
            let mid: [f64; 3] = std::array::from_fn(|j| 0.5 * (p[j] + q[j]));
            s.body(
                &format!("link {k}"),
                motion.point(mid),
                [1.0, 0.1 * k as f64, 0.3, 0.2],
            )
        });
        let [a, b, c] = bodies;
        let pairs = [[BodyRef::Ground, a], [a, b], [b, c], [c, BodyRef::Ground]];
        for (k, pair) in pairs.into_iter().enumerate() {
            let (at, w) = (motion.point(points[k]), motion.vector(axes[k]));
            s.joint(&format!("J{k}"), Kind::R, pair, at, w);
        }
        let reactions = judge(&s, [20, 17, 3, 1]);
        assert!(
            reactions
                .iter()
                .all(|r| r.wrench.verdict == Verdict::NotUnique)
        );
    }
}

/// Case V16 is a table on n points of a plane.
#[test]
fn tables() {
    for motion in Motion::all() {
        let mut s = Sketch::new("slab");
        let slab = s.body("slab", motion.point([0.2, 0.1, 0.5]), [1.0, 0.1, 0.2, 0.3]);
        let z = motion.vector(Z);
        s.joint(
            "flat",
            Kind::Flat,
            [BodyRef::Ground, slab],
            motion.point([0.0; 3]),
            z,
        );
        let reactions = judge(&s, [3, 3, 0, 3]);
        assert!(is_unique(&reactions, "flat"));
        s.joint(
            "again",
            Kind::Flat,
            [slab, BodyRef::Ground],
            motion.point([1.0, 2.0, 0.0]),
            z,
        );
        judge(&s, [6, 3, 3, 3]);
    }
}

/// Case V22 is a chassis on four wheels, each with a hub and a contact that does not slip;
/// straight, and with its front axle steered in parallel.
#[test]
fn cars() {
    use joints::space3::{GroundPlane, Wheel};
    let car = |turn: f64| {
        let mut s = Sketch::new("car");
        let chassis = s.body("chassis", [0.1, 0.0, 0.5], [1.0, 0.0, 0.0, 0.0]);
        let wheels = [[1.2, 0.7], [1.2, -0.7], [-1.1, 0.7], [-1.1, -0.7]];
        for (k, [x, y]) in wheels.into_iter().enumerate() {
            let angle = if k < 2 { turn } else { 0.0 };
            let (sin, cos) = (0.5 * angle).sin_cos();
            // Each wheel has turned about its own axis by a different angle.
            let spin = 0.3 * (k as f64 + 1.0);
            let own = [spin.cos(), 0.0, spin.sin(), 0.0];
            let orientation = [cos * own[0], -sin * own[2], cos * own[2], sin * own[0]];
            let centre = [x, y, 0.3];
            let wheel = s.body(&format!("wheel {k}"), centre, orientation);
            let axis = [-angle.sin(), angle.cos(), 0.0];
            s.joint(&format!("hub {k}"), Kind::R, [chassis, wheel], centre, axis);
            let axis = Direction::new(s.direction(wheel, axis)).expect("a direction");
            let rolls = Wheel::new([0.0; 3], axis, 0.3, GroundPlane::Z);
            s.d.joint(&format!("tread {k}"), &[wheel], rolls);
        }
        s
    };
    judge(&car(0.0), [32, 29, 3, 1]);
    judge(&car(0.2), [32, 30, 2, 0]);
}
