//! The benchmark bicycle as a scene, in any state: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A.
//! L. Schwab, Linearized dynamics equations for the balance and steer of a bicycle, Proc. R. Soc. A
//! 463 (2007) 1955–1982, table 1. In this source z points down, in the scene z points up; x points
//! forwards in both.

use std::f64::consts::PI;
use std::fmt::Write;

/// Wheelbase, trail, and tilt of the steering axis.
pub(crate) const WHEELBASE: f64 = 1.02;
const TRAIL: f64 = 0.08;
const TILT: f64 = PI / 10.0;

/// Radii of the rear and of the front wheel.
pub(crate) const RADII: [f64; 2] = [0.3, 0.35];

/// The parts, in the order of the scene.
pub(crate) const PARTS: [Part; 4] = [
    Part {
        name: "rear",
        mass: 2.0,
        centre: [0.0, 0.0, RADII[0]],
        inertia: [0.0603, 0.12, 0.0603, 0.0],
    },
    Part {
        name: "frame",
        mass: 85.0,
        centre: [0.3, 0.0, 0.9],
        // The product of inertia changes its sign with the direction of z.
        inertia: [9.2, 11.0, 2.8, -2.4],
    },
    Part {
        name: "fork",
        mass: 4.0,
        centre: [0.9, 0.0, 0.7],
        inertia: [0.058_92, 0.06, 0.007_08, 0.007_56],
    },
    Part {
        name: "front",
        mass: 3.0,
        centre: [WHEELBASE, 0.0, RADII[1]],
        inertia: [0.1405, 0.28, 0.1405, 0.0],
    },
];

/// A body of the bicycle.
pub(crate) struct Part {
    name: &'static str,
    mass: f64,
    /// Mass centre of the body for the upright bicycle, with the rear contact at the origin.
    pub(crate) centre: [f64; 3],
    /// Moments Jxx, Jyy, Jzz and Jxz.
    inertia: [f64; 4],
}

/// Pose and velocities of a part, in ground axes.
pub(crate) struct State {
    pub(crate) centre: [f64; 3],
    /// Rotation from the body to the ground.
    pub(crate) orientation: [[f64; 3]; 3],
    pub(crate) velocity: [f64; 3],
    pub(crate) angular_velocity: [f64; 3],
}

/// A unit vector along the steering axis, upwards.
pub(crate) fn steering_axis() -> [f64; 3] {
    [-TILT.sin(), 0.0, TILT.cos()]
}

/// Returns the intersection of the steering axis with the ground.
pub(crate) fn steering_point() -> [f64; 3] {
    [WHEELBASE + TRAIL, 0.0, 0.0]
}

/// The bicycle with its [`PARTS`] in these states.
pub(crate) fn scene(states: &[State; 4]) -> String {
    let mut text = String::from(
        "[scene]\nname = \"bicycle\"\nspace = \"spatial\"\ngravity = [0.0, 0.0, -9.81]\n",
    );
    for (part, state) in PARTS.iter().zip(states) {
        let [xx, yy, zz, xz] = part.inertia;
        let inertia = [[xx, 0.0, xz], [0.0, yy, 0.0], [xz, 0.0, zz]];
        writeln!(
            text,
            "[[body]]\nname = \"{}\"\nmass = {:?}\ninertia = {inertia:?}\nposition = {:?}\n\
             orientation = {{ matrix = {:?} }}\nvelocity = {:?}\nangular_velocity = {:?}",
            part.name,
            part.mass,
            state.centre,
            state.orientation,
            state.velocity,
            state.angular_velocity
        )
        .expect("a string");
    }
    let [rear, frame, fork, front] = &PARTS;
    let hubs = [rear.centre, steering_point(), front.centre];
    let hinges = [
        ("rear hub", [frame, rear], hubs[0], [0.0, 1.0, 0.0]),
        ("head", [frame, fork], hubs[1], steering_axis()),
        ("front hub", [fork, front], hubs[2], [0.0, 1.0, 0.0]),
    ];
    for (name, [first, second], at, axis) in hinges {
        let from = |part: &Part| -> [f64; 3] { std::array::from_fn(|k| at[k] - part.centre[k]) };
        writeln!(
            text,
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = [\"{0}\", \"{1}\"]\naxis = {axis:?}\n\
             points = {{ {0} = {2:?}, {1} = {3:?} }}",
            first.name,
            second.name,
            from(first),
            from(second)
        )
        .expect("a string");
    }
    for (wheel, radius) in [rear, front].into_iter().zip(RADII) {
        writeln!(
            text,
            "[[joint]]\nname = \"{0} contact\"\ntype = \"wheel\"\nbody = \"{0}\"\n\
             point = [0.0, 0.0, 0.0]\naxis = [0.0, 1.0, 0.0]\nradius = {radius:?}",
            wheel.name
        )
        .expect("a string");
    }
    text
}

/// Returns the bicycle in straight motion at this speed.
pub(crate) fn upright(speed: f64) -> String {
    let [rear, front] = RADII.map(|radius| speed / radius);
    let spins = [rear, 0.0, 0.0, front];
    let states = std::array::from_fn(|k| State {
        centre: PARTS[k].centre,
        orientation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        velocity: [speed, 0.0, 0.0],
        angular_velocity: [0.0, spins[k], 0.0],
    });
    scene(&states)
}
