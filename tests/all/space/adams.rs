//! Compares one pendulum on five joints with tables of Adams after 5 s. The pose agrees to six
//! digits. The reactions on the ground about the reference point of the joint agree to four digits,
//! because the tables scatter beyond these digits. The table of the universal joint is late by 0.7
//! ms (0.0006 m, 0.001 N). The expected values for this joint therefore come from Lagrange's
//! equations in its two angles, integrated in steps of 2.5 ms by the classical method of order
//! four.
//!
//! Source: Project Chrono, `data/testing/joints` (files `*_ADAMS_*.txt`), BSD licence; the
//! mechanisms are those of its tests `utest_JOINT_*.cpp`.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};

use dynamics::Method;
use joints::space3::{
    Axes, Cylindrical, Direction, Pose, Revolute, Spherical, Translational, Universal,
};
use lab::mechanisms::space::diagonal;
use model::{BodyRef, SpatialBody, SpatialDescription};

use super::motion::{options, run};

/// A case of the tables.
struct Case {
    name: &'static str,
    kind: Kind,
    /// Reference point of the joint, and its orientation: a rotation about an axis across z.
    place: [f64; 3],
    axis: [f64; 2],
    angle: f64,
    /// Results after 5 s: mass centre, force and moment.
    centre: [f64; 3],
    force: [f64; 3],
    moment: [f64; 3],
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Revolute,
    Spherical,
    Universal,
    Cylindrical,
    Prismatic,
}

const CASES: [Case; 5] = [
    Case {
        name: "Revolute_Case02",
        kind: Kind::Revolute,
        place: [1.0, 2.0, 3.0],
        axis: [1.0, 0.0],
        angle: -FRAC_PI_4,
        centre: [1.209_96, 3.406_40, 1.593_60],
        force: [2.118_95, 9.409_77, -19.216_4],
        moment: [-13.792_0, 1.029_50, -1.029_50],
    },
    Case {
        name: "Spherical_Case02",
        kind: Kind::Spherical,
        place: [1.0, 2.0, 3.0],
        axis: [1.0, 0.0],
        angle: -FRAC_PI_4,
        centre: [-0.999_684, 2.0, 2.964_44],
        force: [-0.510_211, 0.0, -0.248_253],
        moment: [0.0; 3],
    },
    Case {
        name: "Universal_Case03",
        kind: Kind::Universal,
        place: [0.0; 3],
        axis: [FRAC_1_SQRT_2, -FRAC_1_SQRT_2],
        angle: FRAC_PI_2,
        centre: [-1.434_954_698, -1.392_578_011, -0.040_391_816],
        force: [-0.415_809_4, -0.403_709_0, -0.250_955_5],
        moment: [-5.104_712e-3, -5.131_402e-3, -1.887e-5],
    },
    Case {
        name: "Cylindrical_Case03",
        kind: Kind::Cylindrical,
        place: [1.0, 2.0, 3.0],
        axis: [1.0, 0.0],
        angle: -FRAC_PI_4,
        centre: [1.209_96, -57.885_2, -59.698_0],
        force: [2.118_87, 14.312_8, -14.312_8],
        moment: [1754.50, -129.869, 129.869],
    },
    Case {
        name: "Prismatic_Case02",
        kind: Kind::Prismatic,
        place: [1.0, 2.0, 3.0],
        axis: [1.0, 0.0],
        angle: -FRAC_PI_4,
        centre: [3.0, -59.291_6, -58.291_6],
        force: [0.0, 4.903_32, -4.903_32],
        moment: [601.064, 9.806_64, 9.806_64],
    },
];

/// Bounds relative to the largest component, or to one metre or newton if that is larger.
const POSE: f64 = 5e-6;
const REACTION: f64 = 1e-4;

impl Case {
    fn description(&self) -> SpatialDescription {
        let (sin, cos) = (0.5 * self.angle).sin_cos();
        let orientation = [cos, sin * self.axis[0], sin * self.axis[1], 0.0];
        let joint = Pose::new(self.place, orientation);
        // The mass centre is half of the length away: along x of the joint, and below it for a
        // universal joint.
        let (offset, moments) = match self.kind {
            Kind::Universal => ([0.0, 0.0, -2.0], [0.1, 0.1, 0.04]),
            _ => ([2.0, 0.0, 0.0], [0.04, 0.1, 0.1]),
        };
        let mut d = SpatialDescription::new(self.name);
        d.gravity = [0.0, 0.0, -9.806_65];
        let pendulum = d.body(SpatialBody {
            position: joint.to_global(offset),
            orientation,
            velocity: Some([0.0; 3]),
            angular_velocity: Some([0.0; 3]),
            ..SpatialBody::new("pendulum", 1.0, diagonal(moments))
        });
        let bodies = [BodyRef::Ground, pendulum];
        let (s_i, s_j) = (self.place, offset.map(|x: f64| -x));
        let (axis_j, axis) = (
            Axes::FRAME,
            Axes::FRAME.map(|v| joint.direction_to_global(v)),
        );
        match self.kind {
            Kind::Revolute => {
                d.joint(
                    "joint",
                    &bodies,
                    Revolute {
                        s_i,
                        s_j,
                        axis,
                        axis_j,
                    },
                );
            }
            Kind::Spherical => {
                d.joint("joint", &bodies, Spherical { s_i, s_j });
            }
            Kind::Universal => {
                // The x-axis of the joint is fixed to the ground, and its y-axis to the pendulum.
                let axis = Direction::new(axis.uvw()[0]).expect("a direction");
                let cross = Direction::Y;
                d.joint("joint", &bodies, Universal::new(s_i, s_j, axis, cross));
            }
            Kind::Cylindrical => {
                d.joint(
                    "joint",
                    &bodies,
                    Cylindrical {
                        s_i,
                        s_j,
                        axis,
                        axis_j,
                    },
                );
            }
            Kind::Prismatic => {
                d.joint(
                    "joint",
                    &bodies,
                    Translational {
                        s_i,
                        s_j,
                        axis,
                        axis_j,
                    },
                );
            }
        }
        d
    }
}

/// Returns the largest difference relative to the largest expected value, or to `least` if that is
/// larger.
fn gap(found: &[f64], expected: &[f64], least: f64) -> f64 {
    let size = expected.iter().fold(least, |a, x| a.max(x.abs()));
    let gaps = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    gaps.fold(0.0, f64::max) / size
}

#[test]
fn pendulums_on_five_joints() {
    for case in CASES {
        let (name, mut last) = (case.name, None);
        let end = options(5.0, Method::Dop853, 1e-12);
        run(&case.description(), &end, |_, row| {
            let reaction = row.reactions().expect("unique").as_chosen()[0];
            last = Some((row.q.to_vec(), reaction));
        });
        let (q, reaction) = last.expect("a row");
        let pose = gap(&q[..3], &case.centre, 1.0);
        assert!(pose < POSE, "{name}: {:?}", &q[..3]);
        let force = gap(&reaction.force, &case.force, 1.0);
        assert!(force < REACTION, "{name}: {:?}", reaction.force);
        let moment = gap(&reaction.torque, &case.moment, 1.0);
        assert!(moment < REACTION, "{name}: {:?}", reaction.torque);
    }
    // The first case has a closed form: a plane pendulum.
    let end = options(5.0, Method::Dop853, 1e-13);
    let mut force = [0.0; 3];
    run(&CASES[0].description(), &end, |_, row| {
        force = row.reactions().expect("unique").as_chosen()[0].force;
    });
    assert!(
        gap(&force, &[2.118_870, 9.409_301, -19.215_951], 1.0) < 1e-6 / 19.0,
        "{force:?}"
    );
}
