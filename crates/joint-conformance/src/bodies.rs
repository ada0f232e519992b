//! Operations on the bodies of a space. The operations generate random poses, apply rigid motions,
//! and compute the forces on bodies. In this module, a velocity is the list of its components.

use std::f64::consts::{FRAC_PI_2, PI};

use joints::space3::Axes;
use joints::{Argument, Plane, Space, Space3, plane, space3};

use crate::case::{Kind, Random};
use crate::number::Number;

/// A space whose definitions can be tested.
pub trait Bodies: Space {
    /// Names of the velocity components of a body.
    const DOFS: &'static [&'static str];
    /// Names of the components of a wrench.
    const COMPONENTS: &'static [&'static str];

    /// Returns a random pose whose coordinates differ from `base` by at most `reach`.
    #[doc(hidden)]
    fn draw(kind: Kind, base: f64, reach: f64, random: &mut Random) -> Self::Pose<f64>;

    /// Returns a description of a pose as text.
    #[doc(hidden)]
    fn words(x: &Self::Pose<f64>) -> String;

    /// Returns a pose with its orientation replaced by that of another pose.
    #[doc(hidden)]
    fn with_orientation(x: &Self::Pose<f64>, of: &Self::Pose<f64>) -> Self::Pose<f64>;

    /// Returns a point, or a vector that defines a direction, as an argument.
    #[doc(hidden)]
    fn argument(numbers: [f64; 3]) -> Argument;

    /// Returns the pose after the time τ, for constant velocities.
    #[doc(hidden)]
    fn moved<D: Number>(x: &Self::Pose<f64>, v: &[f64], tau: D) -> Self::Pose<D>;

    /// Returns the pose after a rigid motion of the whole mechanism; the motion is the same for all
    /// bodies.
    #[doc(hidden)]
    fn carried(x: &Self::Pose<f64>) -> Self::Pose<f64>;
    #[doc(hidden)]
    fn carried_velocities(v: &[f64]) -> Vec<f64>;

    /// Returns the coordinates of the origin, and the largest magnitude of the values for the
    /// orientation.
    #[doc(hidden)]
    fn origin(x: &Self::Pose<f64>) -> ([f64; 3], f64);

    /// Returns force and torque about a point, in ground components, for a generalised force on a
    /// body.
    #[doc(hidden)]
    fn wrench(x: &Self::Pose<f64>, q: &[f64], about: [f64; 3]) -> Vec<f64>;

    /// Returns the velocity of a point of the body for a unit value of each velocity component.
    #[doc(hidden)]
    fn point_velocities(x: &Self::Pose<f64>, point: [f64; 3]) -> Vec<[f64; 3]>;
}

impl Bodies for Plane {
    const DOFS: &'static [&'static str] = &["x", "y", "rotation"];
    const COMPONENTS: &'static [&'static str] = &["Fx", "Fy", "T"];

    fn draw(kind: Kind, base: f64, reach: f64, random: &mut Random) -> plane::Pose {
        let [x, y] = random.pair(reach);
        let sign = [-1.0, 1.0][random.below(2)];
        let angle = match kind {
            Kind::RightAngles => [0.0, FRAC_PI_2, -FRAC_PI_2, PI, -PI][random.below(5)],
            Kind::NearPi => sign * (PI + [1e-9, -1e-9][random.below(2)]),
            Kind::LargeAngles => sign * (1e3 + random.within(PI)),
            _ => random.within(PI),
        };
        plane::Pose::new(base + x, y - base, angle)
    }

    fn words(x: &plane::Pose) -> String {
        format!("(x {:?}, y {:?}, angle {:?})", x.x, x.y, x.angle)
    }

    fn with_orientation(x: &plane::Pose, of: &plane::Pose) -> plane::Pose {
        plane::Pose {
            angle: of.angle,
            cos: of.cos,
            sin: of.sin,
            ..*x
        }
    }

    fn argument([x, y, _]: [f64; 3]) -> Argument {
        Argument::Pair([x, y])
    }

    fn moved<D: Number>(x: &plane::Pose, v: &[f64], tau: D) -> plane::Pose<D> {
        let line = |start: f64, rate: f64| D::from(start) + D::from(rate) * tau;
        let angle = line(x.angle, v[2]);
        let (sin, cos) = angle.sin_cos();
        plane::Pose {
            x: line(x.x, v[0]),
            y: line(x.y, v[1]),
            angle,
            cos,
            sin,
        }
    }

    fn carried(x: &plane::Pose) -> plane::Pose {
        let turn = plane::Pose::new(0.7, -1.3, 0.9);
        let [px, py] = turn.to_global([x.x, x.y]);
        plane::Pose::new(px, py, turn.angle + x.angle)
    }

    fn carried_velocities(v: &[f64]) -> Vec<f64> {
        let (sin, cos) = 0.9_f64.sin_cos();
        vec![cos * v[0] - sin * v[1], cos * v[1] + sin * v[0], v[2]]
    }

    fn origin(x: &plane::Pose) -> ([f64; 3], f64) {
        ([x.x, x.y, 0.0], x.angle.abs())
    }

    fn wrench(x: &plane::Pose, q: &[f64], about: [f64; 3]) -> Vec<f64> {
        let (arm_x, arm_y) = (x.x - about[0], x.y - about[1]);
        vec![q[0], q[1], q[2] + arm_x * q[1] - arm_y * q[0]]
    }

    fn point_velocities(x: &plane::Pose, point: [f64; 3]) -> Vec<[f64; 3]> {
        let turned = [-(point[1] - x.y), point[0] - x.x, 0.0];
        vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], turned]
    }
}

/// Returns a rigid motion: a translation, and a rotation by about 0.9 rad about an axis that is not
/// a coordinate axis.
fn carrier() -> space3::Pose {
    space3::Pose::new([0.7, -1.3, 0.4], [0.9, 0.2, -0.3, 0.25])
}

impl Bodies for Space3 {
    const DOFS: &'static [&'static str] = &[
        "x",
        "y",
        "z",
        "rotation about x",
        "rotation about y",
        "rotation about z",
    ];
    const COMPONENTS: &'static [&'static str] = &["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];

    fn draw(kind: Kind, base: f64, reach: f64, random: &mut Random) -> space3::Pose {
        let r = [base, -base, base].map(|base| base + random.within(reach));
        let quaternion = match kind {
            // Rotations by 90° or 180° about the coordinate axes, and by 120° about a diagonal.
            Kind::RightAngles => [
                [1.0, 0.0, 0.0, 0.0],
                [1.0, 1.0, 0.0, 0.0],
                [1.0, 0.0, 0.0, -1.0],
                [0.0, 0.0, 1.0, 0.0],
                [1.0, 1.0, 1.0, 1.0],
            ][random.below(5)],
            // A rotation by nearly 180° about some axis.
            Kind::NearPi => {
                let axis: [f64; 3] = std::array::from_fn(|_| random.within(1.0));
                [[1e-9, -1e-9][random.below(2)], axis[0], axis[1], axis[2]]
            }
            // Quaternions whose length is far from one.
            Kind::LargeAngles => std::array::from_fn(|_| 1e3 * random.within(1.0)),
            _ => std::array::from_fn(|_| random.within(1.0)),
        };
        space3::Pose::new(r, quaternion)
    }

    fn words(x: &space3::Pose) -> String {
        format!("(r {:?}, R {:?})", x.r, x.rot)
    }

    fn with_orientation(x: &space3::Pose, of: &space3::Pose) -> space3::Pose {
        space3::Pose {
            r: x.r,
            rot: of.rot,
        }
    }

    fn argument(numbers: [f64; 3]) -> Argument {
        Argument::Triple(numbers)
    }

    /// Computes R·exp([ωτ]×) by Rodrigues' formula. The angular velocity ω is constant in the body
    /// frame, so the angular acceleration is zero.
    fn moved<D: Number>(x: &space3::Pose, v: &[f64], tau: D) -> space3::Pose<D> {
        let omega = [v[3], v[4], v[5]];
        let speed = omega.iter().map(|w| w * w).sum::<f64>().sqrt();
        let r = std::array::from_fn(|k| D::from(x.r[k]) + D::from(v[k]) * tau);
        if speed == 0.0 {
            let rot = x.rot.map(|row| row.map(D::from));
            return space3::Pose { r, rot };
        }
        let axis = omega.map(|w| w / speed);
        let (sin, cos) = (D::from(speed) * tau).sin_cos();
        let versine = D::from(1.0) - cos;
        let turned = |d: [f64; 3]| -> [D; 3] {
            let once = cross(axis, d);
            let twice = cross(axis, once);
            std::array::from_fn(|k| {
                D::from(d[k]) + sin * D::from(once[k]) + versine * D::from(twice[k])
            })
        };
        // Column k of the result is R times the k-th axis after the rotation.
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(turned);
        let rot = std::array::from_fn(|row| {
            std::array::from_fn(|k| {
                let [a, b, c] = x.rot[row];
                let [p, q, s] = columns[k];
                D::from(a) * p + D::from(b) * q + D::from(c) * s
            })
        });
        space3::Pose { r, rot }
    }

    fn carried(x: &space3::Pose) -> space3::Pose {
        let turn = carrier();
        let columns: [[f64; 3]; 3] =
            std::array::from_fn(|k| turn.direction_to_global(x.rot.map(|row| row[k])));
        space3::Pose {
            r: turn.to_global(x.r),
            rot: std::array::from_fn(|row| std::array::from_fn(|k| columns[k][row])),
        }
    }

    fn carried_velocities(v: &[f64]) -> Vec<f64> {
        let turned = carrier().direction_to_global([v[0], v[1], v[2]]);
        [turned, [v[3], v[4], v[5]]].concat()
    }

    fn origin(x: &space3::Pose) -> ([f64; 3], f64) {
        (x.r, 1.0)
    }

    fn wrench(x: &space3::Pose, q: &[f64], about: [f64; 3]) -> Vec<f64> {
        let force = [q[0], q[1], q[2]];
        let own = x.direction_to_global([q[3], q[4], q[5]]);
        let carried = cross(std::array::from_fn(|k| x.r[k] - about[k]), force);
        let moment: [f64; 3] = std::array::from_fn(|k| own[k] + carried[k]);
        [force, moment].concat()
    }

    fn point_velocities(x: &space3::Pose, point: [f64; 3]) -> Vec<[f64; 3]> {
        let arm = std::array::from_fn(|k| point[k] - x.r[k]);
        let axes = [0, 1, 2].map(|k| x.rot.map(|row| row[k]));
        let moved = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        moved
            .into_iter()
            .chain(axes.map(|axis| cross(axis, arm)))
            .collect()
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Returns axes for a parameter. The directions are random directions for the axis and
/// perpendicular to the axis, or directions along the axes of the frame.
pub(crate) fn axes(kind: Kind, random: &mut Random) -> Argument {
    if kind == Kind::RightAngles {
        let along = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]][random.below(3)];
        return Argument::Triple(along);
    }
    loop {
        let mut vector = || std::array::from_fn(|_| random.within(1.0));
        if let Some(axes) = Axes::new(vector(), Some(vector())) {
            return Argument::Axes(axes);
        }
    }
}
