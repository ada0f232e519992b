//! Computes poses of links for given joint coordinates, as products of displacements. Displacements
//! are relative to the pose of the links in the imported file (the described pose).
//!
//! The displacement of a link is g_child = g_parent·D(q). Here g_parent is the displacement of the
//! previous link, and D(q) is the displacement of the joint at its described position.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use crate::mechanism::{Joint, JointKind, Model};

/// A joint that determines the position of a link. Point and axis are in ground axes, for the links
/// at the described pose.
pub(crate) struct JointPlacement {
    pub(crate) point: Vector3<f64>,
    pub(crate) axis: Vector3<f64>,
    pub(crate) cross: Vector3<f64>,
    /// Pose of the second link.
    pub(crate) second: Isometry3<f64>,
}

impl JointPlacement {
    pub(crate) fn of(model: &Model, joint: &Joint) -> Self {
        let second = model.pose(joint.links[1]);
        // The first axis of a universal joint is fixed in the first link only.
        let axis = match joint.kind {
            JointKind::Universal => model.pose(joint.links[0]).rotation * joint.axes[0],
            _ => second.rotation * joint.axes[1],
        };
        Self {
            point: second * nalgebra::Point3::from(joint.points[1]) - nalgebra::Point3::origin(),
            axis,
            cross: second.rotation * joint.cross,
            second,
        }
    }

    /// A rotation about an axis through the point of the joint.
    pub(crate) fn turn(&self, rotation: UnitQuaternion<f64>) -> Isometry3<f64> {
        let shift = self.point - rotation * self.point;
        Isometry3::from_parts(Translation3::from(shift), rotation)
    }

    /// The displacement for coordinate changes relative to the described pose. For spherical joints
    /// and free links, `q` contains the coordinates of a keyframe.
    pub(crate) fn displacement(&self, kind: JointKind, q: &[f64]) -> Isometry3<f64> {
        let about = |axis: Vector3<f64>, angle: f64| self.turn(rotation(axis, angle));
        let along =
            |by: f64| Isometry3::from_parts((self.axis * by).into(), UnitQuaternion::identity());
        match (kind, q) {
            (JointKind::Revolute, &[q]) => about(self.axis, q),
            (JointKind::Translational, &[q]) => along(q),
            (JointKind::Universal, &[first, second]) => {
                about(self.axis, first) * about(self.cross, second)
            }
            (JointKind::Cylindrical, &[shift, turn]) => along(shift) * about(self.axis, turn),
            (JointKind::Screw(pitch), &[q]) => {
                along(pitch * q / std::f64::consts::TAU) * about(self.axis, q)
            }
            (JointKind::Spherical, &[w, x, y, z]) => {
                let own = self.second.rotation;
                self.turn(own * quaternion([w, x, y, z]) * own.inverse())
            }
            (JointKind::Free, &[px, py, pz, w, x, y, z]) => {
                let shift = Translation3::new(px, py, pz);
                let pose = Isometry3::from_parts(shift, quaternion([w, x, y, z]));
                pose * self.second.inverse()
            }
            _ => Isometry3::identity(),
        }
    }
}

/// Returns the rotation by an angle about an axis. For an angle of zero, the result is exactly the
/// identity.
pub(crate) fn rotation(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    if angle == 0.0 {
        return UnitQuaternion::identity();
    }
    let (sin, cos) = (0.5 * angle).sin_cos();
    UnitQuaternion::new_normalize(Quaternion::from_parts(cos, axis * sin))
}

/// The smallest rotation that maps z to a unit vector.
pub(crate) fn along_z(z: Vector3<f64>) -> UnitQuaternion<f64> {
    if z == Vector3::z() {
        return UnitQuaternion::identity();
    }
    let axis = Vector3::z().cross(&z);
    let angle = axis.norm().atan2(z.z);
    // For a vector along z, the cross product is a rounding error without a meaningful direction.
    let axis = if axis.amax() > model::ROUNDING {
        crate::findings::unit(axis)
    } else {
        Vector3::x()
    };
    rotation(axis, angle)
}

/// The rotation of a quaternion of any length except zero.
pub(crate) fn quaternion([w, x, y, z]: [f64; 4]) -> UnitQuaternion<f64> {
    let q = Quaternion::new(w, x, y, z);
    if q == Quaternion::identity() {
        return UnitQuaternion::identity();
    }
    UnitQuaternion::new_normalize(q)
}

/// Computes the displacements of all links from the displacements of the joints. The joints may
/// have any order. If no joint determines the position of a link, the link has its described pose.
pub(crate) fn displaced(model: &Model, joints: &[Isometry3<f64>]) -> Vec<Isometry3<f64>> {
    let mut links = vec![None; model.links.len()];
    let before = placing(model);
    for link in 0..model.links.len() {
        // The loop follows the tree up to a link with a known displacement. Then the displacements
        // are computed down to the link.
        let (mut chain, mut at) = (Vec::new(), Some(link));
        let mut known = Isometry3::identity();
        while let Some(link) = at {
            if let Some(found) = links[link] {
                known = found;
                break;
            }
            let joint = before[link];
            chain.push((link, joint));
            at = joint.and_then(|joint| model.joints[joint].links[0]);
            if chain.len() > model.links.len() {
                break;
            }
        }
        for (link, joint) in chain.into_iter().rev() {
            if let Some(joint) = joint {
                known *= joints[joint];
            }
            links[link] = Some(known);
        }
    }
    links.into_iter().map(Option::unwrap_or_default).collect()
}

/// For each link, the joint that determines its position.
pub(crate) fn placing(model: &Model) -> Vec<Option<usize>> {
    let mut before = vec![None; model.links.len()];
    for (k, joint) in model.joints.iter().enumerate() {
        if let (true, Some(link)) = (joint.places, joint.links[1]) {
            before[link] = Some(k);
        }
    }
    before
}

/// Pose of a link, and its motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) pose: Isometry3<f64>,
    /// Velocity of the origin of the axes of the link, and angular velocity of the link, in ground
    /// axes.
    pub(crate) velocity: Vector3<f64>,
    pub(crate) spin: Vector3<f64>,
}

fn placements(model: &Model) -> Vec<JointPlacement> {
    let joints = model.joints.iter();
    joints
        .map(|joint| JointPlacement::of(model, joint))
        .collect()
}

/// The coordinates of a joint in [`JointPlacement::displacement`], from the coordinates of all
/// joints in a keyframe.
fn change(model: &Model, k: usize, q: &[Vec<f64>]) -> Vec<f64> {
    let joint = &model.joints[k];
    match joint.kind {
        JointKind::Spherical | JointKind::Free => q[k].clone(),
        _ => { q[k].iter().zip(&joint.zero) }
            .map(|(q, zero)| q - zero)
            .collect(),
    }
}

/// Displacements of all joints at the coordinates of a keyframe.
pub(crate) fn displacements(model: &Model, q: &[Vec<f64>]) -> Vec<Isometry3<f64>> {
    let places = placements(model);
    (0..model.joints.len())
        .map(|k| places[k].displacement(model.joints[k].kind, &change(model, k, q)))
        .collect()
}

/// The links at a state of the joints.
pub(crate) fn at_state(model: &Model, q: &[Vec<f64>], v: Option<&[Vec<f64>]>) -> Vec<Motion> {
    let places = placements(model);
    let moved = displacements(model, q);
    let links = displaced(model, &moved);
    let before = placing(model);
    let mut motions: Vec<Motion> = links
        .iter()
        .zip(&model.links)
        .map(|(g, link)| Motion {
            pose: g * link.pose,
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        })
        .collect();
    let Some(v) = v else { return motions };
    // The twists of the joints (ω, velocity of the body point at the origin of the ground) are
    // added along the chain.
    let no_twist = (Vector3::zeros(), Vector3::zeros());
    for link in 0..model.links.len() {
        let mut twist: (Vector3<f64>, Vector3<f64>) = no_twist;
        let (mut at, mut steps) = (Some(link), 0);
        while let Some(joint) = at.and_then(|link| before[link]) {
            let [first, _] = model.joints[joint].links;
            let g = first.map_or_else(Isometry3::identity, |first| links[first]);
            let own = joint_twist(
                &places[joint],
                model.joints[joint].kind,
                &change(model, joint, q),
                &v[joint],
                &g,
            );
            twist = (twist.0 + own.0, twist.1 + own.1);
            at = first;
            steps += 1;
            if steps > model.links.len() {
                break;
            }
        }
        let motion = &mut motions[link];
        motion.spin = twist.0;
        motion.velocity = twist.1 + twist.0.cross(&motion.pose.translation.vector);
    }
    motions
}

/// The twist of a joint: angular velocity, and velocity of the body point at the origin of the
/// ground.
fn joint_twist(
    place: &JointPlacement,
    kind: JointKind,
    q: &[f64],
    v: &[f64],
    before: &Isometry3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    let point = before * nalgebra::Point3::from(place.point) - nalgebra::Point3::origin();
    let turning = |spin: Vector3<f64>| (spin, -spin.cross(&point));
    let axis = before.rotation * place.axis;
    match (kind, v) {
        (JointKind::Revolute, &[v]) => turning(axis * v),
        (JointKind::Translational, &[v]) => (Vector3::zeros(), axis * v),
        (JointKind::Universal, &[first, second]) => {
            let turned = rotation(place.axis, q[0]);
            turning(axis * first + before.rotation * (turned * place.cross) * second)
        }
        (JointKind::Cylindrical, &[shift, turn]) => {
            let (spin, velocity) = turning(axis * turn);
            (spin, velocity + axis * shift)
        }
        (JointKind::Screw(pitch), &[v]) => {
            let (spin, velocity) = turning(axis * v);
            (spin, velocity + axis * (pitch * v / std::f64::consts::TAU))
        }
        (JointKind::Spherical, &[x, y, z]) => {
            let g = before * place.displacement(kind, q);
            turning(g.rotation * place.second.rotation * Vector3::new(x, y, z))
        }
        (JointKind::Free, &[vx, vy, vz, x, y, z]) => {
            let pose = before * place.displacement(kind, q) * place.second;
            let spin = pose.rotation * Vector3::new(x, y, z);
            let velocity = before.rotation * Vector3::new(vx, vy, vz);
            (spin, velocity - spin.cross(&pose.translation.vector))
        }
        _ => (Vector3::zeros(), Vector3::zeros()),
    }
}
