//! The robot with its trolley, written in code. It is the same mechanism as in
//! `crates/robot-trolley/robot-trolley.toml`, with the same dimensions, but built independently of
//! the scene reader.

use joints::plane::Direction;
use joints::{KnifeEdge, Pose, Revolute, Translational, TranslationalDisplacementDrive};
use model::{Body, BodyRef, Description, Drive, Function, Joint};

/// Names, masses, inertias and positions of the seven bodies.
const BODIES: [(&str, f64, f64, [f64; 2]); 7] = [
    ("platform", 20.0, 1.2, [0.0, 0.0]),
    ("front-knuckle", 0.5, 0.002, [0.255, 0.025]),
    ("rear-knuckle", 0.5, 0.002, [-0.255, 0.025]),
    ("front-link", 0.3, 0.0016, [0.205, -0.075]),
    ("rear-link", 0.3, 0.0016, [-0.205, -0.075]),
    ("slider", 1.0, 0.02, [0.0, -0.2]),
    ("trolley", 8.0, 0.5, [-0.75, 0.0]),
];

/// Name, bodies and reference point of the revolute joints.
const REVOLUTES: [(&str, usize, usize, [f64; 2]); 7] = [
    ("A", 0, 6, [-0.4, 0.0]),
    ("B", 0, 1, [0.3, 0.0]),
    ("C", 0, 2, [-0.3, 0.0]),
    ("D", 1, 3, [0.21, 0.05]),
    ("E", 2, 4, [-0.21, 0.05]),
    ("F", 3, 5, [0.2, -0.2]),
    ("G", 4, 5, [-0.2, -0.2]),
];

/// Name, body and contact point of the knife edges. The normal of each edge is the y-axis of its
/// body.
const EDGES: [(&str, usize, [f64; 2]); 5] = [
    ("W1", 1, [0.3, 0.0]),
    ("W2", 2, [-0.3, 0.0]),
    ("W3", 0, [0.0, -0.2]),
    ("W4", 0, [0.0, 0.2]),
    ("W5", 6, [-0.8, 0.0]),
];

/// The published motion of the drive: right turn, straight, left turn, straight.
pub fn steering() -> Function {
    steering_of_size(1.0)
}

/// Returns the same motion for a robot whose lengths are multiplied by `size`.
pub fn steering_of_size(size: f64) -> Function {
    let steps = [
        [1.0, 2.0, 0.02 * size],
        [3.0, 4.0, -0.02 * size],
        [6.0, 7.0, -0.021876 * size],
        [8.0, 9.0, 0.021876 * size],
    ];
    Function::steps(0.0, &steps).expect("the steps are ordered")
}

/// Returns the robot with its trolley, steered by `motion`.
pub fn robot(motion: Function) -> Description {
    robot_of_size(1.0, motion)
}

/// Returns the robot with all lengths multiplied by `size`, speeds included.
pub fn robot_of_size(size: f64, motion: Function) -> Description {
    let by = |p: [f64; 2]| p.map(|x| x * size);
    let bodies: Vec<Body> = BODIES
        .iter()
        .map(|&(name, mass, inertia, position)| Body {
            name: name.into(),
            mass,
            inertia: inertia * size * size,
            position: by(position),
            velocity: Some(by([1.0, 0.0])),
            ..Body::default()
        })
        .collect();
    let local = |body: usize, p: [f64; 2]| {
        let [x, y] = BODIES[body].3;
        by(Pose::new(x, y, 0.0).to_local(p))
    };
    let body = BodyRef::Body;
    let mut joints: Vec<Joint> = REVOLUTES
        .iter()
        .map(|&(name, i, j, at)| {
            let element = Revolute {
                s_i: local(i, at),
                s_j: local(j, at),
            };
            Joint::new(name, &[body(i), body(j)], element)
        })
        .collect();
    let (platform, slider) = (0, 5);
    let (s_i, s_j) = (local(platform, [0.0, -0.2]), local(slider, [0.0, -0.2]));
    let pair = [body(platform), body(slider)];
    let element = Translational::new(s_i, s_j, Direction::Y);
    joints.push(Joint::new("H", &pair, element));
    for (name, i, at) in EDGES {
        joints.push(Joint::new(
            name,
            &[body(i)],
            KnifeEdge {
                s: local(i, at),
                normal: Direction::Y,
            },
        ));
    }
    let element = TranslationalDisplacementDrive::new(s_i, s_j, Direction::Y);
    let drive = Drive {
        name: "steering".into(),
        bodies: pair.to_vec(),
        element: Box::new(element),
        motion,
        tolerance: None,
    };
    Description {
        name: "robot-trolley".into(),
        bodies,
        joints,
        drives: vec![drive],
        ..Description::default()
    }
}
