//! Common parts of URDF and SDF: poses of six numbers, tensors with named entries, the tree of
//! links and loops.

use nalgebra::{Isometry3, Matrix3, UnitQuaternion, Vector3};

use crate::findings::Findings;
use crate::limits::{GRAVITY, RIGHT_ANGLE};
use crate::mechanism::{Joint, JointKind, Load, Model};
use crate::pose::rotation;

/// Effect of the omitted friction.
pub(crate) const FRICTION: &str = "friction of joints: accelerations differ while the joints move";

/// Angles about the fixed axes x, then y, then z.
pub(crate) fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> UnitQuaternion<f64> {
    let [x, y, z] = [
        (Vector3::x(), roll),
        (Vector3::y(), pitch),
        (Vector3::z(), yaw),
    ]
    .map(|(axis, angle)| rotation(axis, angle));
    z * y * x
}

/// The inertia tensor with the entries ixx, iyy, izz, ixy, ixz, iyz.
pub(crate) fn tensor([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// Reports that the gravity does not come from the file.
pub(crate) fn assume_gravity(model: &mut Model, findings: &mut Findings) {
    model.gravity = Vector3::new(0.0, 0.0, GRAVITY);
    let remark = "The file has no gravity: 9.81 m/s² along −z is taken.";
    findings.remarks.push(remark.to_owned());
}

/// Decides which joints determine the positions of links. The first joint of each link determines
/// its position, unless this joint would close a cycle. All other joints close loops.
pub(crate) fn find_tree(model: &mut Model) {
    let mut before: Vec<Option<Option<usize>>> = vec![None; model.links.len()];
    for joint in &mut model.joints {
        joint.places = false;
        let [first, Some(second)] = joint.links else {
            continue;
        };
        if before[second].is_some() {
            continue;
        }
        let (mut at, mut steps) = (first, 0);
        while let Some(link) = at {
            if link == second || steps > before.len() {
                break;
            }
            at = before[link].flatten();
            steps += 1;
        }
        if at.is_none() {
            before[second] = Some(first);
            joint.places = true;
        }
    }
}

/// Creates a joint with a second axis. If the axes are perpendicular, the result is a universal
/// joint. Otherwise, the result is two hinges with a massless link between the hinges. `second` is
/// the second axis in the axes of the second link.
pub(crate) fn with_second_axis(
    model: &mut Model,
    mut joint: Joint,
    second: Vector3<f64>,
    load: Load,
) {
    if joint.axes[1].dot(&second).abs() <= RIGHT_ANGLE {
        joint.kind = JointKind::Universal;
        joint.cross = second;
        joint.loads[1] = load;
        model.joints.push(joint);
        return;
    }
    let pose = model.pose(joint.links[1]);
    let between = model.links.len();
    model.links.push(crate::mechanism::Link {
        name: format!("between axes of {}", joint.name),
        pose,
        mass: Default::default(),
        held: Vec::new(),
    });
    let mut outer = joint.clone();
    outer.kind = JointKind::Revolute;
    outer.links[1] = Some(between);
    let mut inner = joint;
    inner.kind = JointKind::Revolute;
    inner.links[0] = Some(between);
    inner.points[0] = inner.points[1];
    inner.axes = [second; 2];
    inner.loads = [load, Load::default()];
    inner.name = format!("{} second axis", inner.name);
    inner.names = [inner.name.clone(), inner.name.clone()];
    model.joints.extend([outer, inner]);
}

/// Computes the position of a joint on both links from the joint frame in the axes of the second
/// link, at the described pose.
pub(crate) fn joint_between(
    model: &Model,
    name: &str,
    kind: JointKind,
    links: [Option<usize>; 2],
    in_second: Isometry3<f64>,
    axis: Vector3<f64>,
) -> Joint {
    let relation = model.pose(links[0]).inverse() * model.pose(links[1]);
    let point = in_second.translation.vector;
    let other = relation.translation.vector + relation.rotation * point;
    let axes = [relation.rotation * axis, axis];
    Joint::new(name, kind, links, [other, point], axes)
}
