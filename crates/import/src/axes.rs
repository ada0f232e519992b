//! Finds axes of a loop that are nearly parallel or nearly intersect. The cause may be rounded
//! digits or an intended tilt. The import reports these axes. On request, the import makes these
//! axes parallel or intersecting.

use model::words::estimate;
use std::cmp::Reverse;

use nalgebra::{Isometry3, Point3, Vector3};

use crate::findings::Findings;
use crate::limits::{EXACT, MEETING, NEARLY, SNAPPED};
use crate::mechanism::{JointKind, Model};
use crate::pose::placing;

/// Treatment of axes that are nearly parallel or nearly intersect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The import reports these axes and does not change them.
    Told,
    /// The import makes these axes parallel or intersecting, and reports the changes.
    Snapped,
}

/// The axis of a joint at the initial pose, in ground axes.
#[derive(Clone, Copy)]
struct JointAxis {
    joint: usize,
    point: Vector3<f64>,
    direction: Vector3<f64>,
}

/// An axis that is tilted relative to other axes of the same loop.
struct Tilt {
    joint: usize,
    /// Angle (rad).
    off: f64,
    /// The direction of the other axes, with the sign chosen so that it is close to this axis.
    direction: Vector3<f64>,
    /// Names of the other axes.
    others: String,
}

impl Tilt {
    fn words(&self, model: &Model) -> String {
        format!(
            "the axis of `{}` is tilted by {} against {} of its loop",
            model.joints[self.joint].name,
            estimate(self.off, "rad"),
            self.others
        )
    }
}

/// Returns the largest angle (rad) between two axes that the import makes parallel on request. The
/// angle is three times the accuracy of angles in the file, but at least `SNAPPED`.
fn near(angle: Option<f64>) -> f64 {
    SNAPPED.max(3.0 * angle.unwrap_or(0.0))
}

/// The axes of one loop that are nearly parallel to most other axes of the loop.
fn tilted(
    model: &Model,
    poses: &[Isometry3<f64>],
    loop_: &[usize],
    angle: Option<f64>,
) -> (Vec<JointAxis>, Option<JointAxis>, Vec<Tilt>) {
    let known = EXACT.max(angle.unwrap_or(0.0));
    let of: Vec<JointAxis> = loop_
        .iter()
        .filter_map(|&joint| axis(model, poses, joint))
        .collect();
    // The reference axis is the axis with the largest number of parallel axes in the loop.
    let agree = |a: &JointAxis| of.iter().filter(|b| tilt(a, b) <= known).count();
    let votes: Vec<usize> = of.iter().map(agree).collect();
    let best = (0..of.len()).max_by_key(|&k| (votes[k], Reverse(of[k].joint)));
    let Some(reference) = best.map(|best| of[best]) else {
        return (of, None, Vec::new());
    };
    let mut members: Vec<&JointAxis> = of.iter().collect();
    members.sort_unstable_by_key(|axis| axis.joint);
    let tilts = of.iter().filter_map(|axis| {
        let off = tilt(&reference, axis);
        if off <= EXACT || off > NEARLY {
            return None;
        }
        let others: Vec<String> = members
            .iter()
            .filter(|other| other.joint != axis.joint && tilt(&reference, other) <= known)
            .map(|other| format!("`{}`", model.joints[other.joint].name))
            .collect();
        Some(Tilt {
            joint: axis.joint,
            off,
            direction: reference.direction * reference.direction.dot(&axis.direction).signum(),
            others: others.join(", "),
        })
    });
    let tilts = tilts.collect();
    (of, Some(reference), tilts)
}

/// Returns descriptions of the axes that `--snap` would make parallel. Returns `None` if there are
/// no such axes.
pub(crate) fn tilts(model: &Model, poses: &[Isometry3<f64>], angle: Option<f64>) -> Option<String> {
    let loops = loops(model);
    let all = loops
        .iter()
        .flat_map(|loop_| tilted(model, poses, loop_, angle).2);
    let near = all.filter(|tilt| tilt.off <= near(angle));
    let mut words: Vec<String> = near.map(|tilt| tilt.words(model)).collect();
    words.dedup();
    (!words.is_empty()).then(|| words.join("; "))
}

/// Makes nearly parallel axes parallel, before loops are closed. `poses` are the poses of the
/// initial guess.
pub(crate) fn align(
    model: &mut Model,
    poses: &[Isometry3<f64>],
    angle: Option<f64>,
    findings: &mut Findings,
) {
    for loop_ in loops(model) {
        for tilt in tilted(model, poses, &loop_, angle).2 {
            if tilt.off <= near(angle) {
                snap(model, poses, &tilt, findings);
            }
        }
    }
}

fn snap(model: &mut Model, poses: &[Isometry3<f64>], tilt: &Tilt, findings: &mut Findings) {
    let what = sentence(&tilt.words(model));
    findings
        .remarks
        .push(format!("{what}; it is made parallel."));
    turn(model, poses, tilt.joint, tilt.direction);
}

/// The text with a capital letter at its start.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// Reports axes of each loop that are nearly parallel or nearly intersect. `poses` contains the
/// initial poses of the links, and `tolerance` the accuracy of lengths and angles.
pub(crate) fn look(
    model: &mut Model,
    poses: &[Isometry3<f64>],
    tolerance: [Option<f64>; 2],
    axes: Axes,
    findings: &mut Findings,
) {
    let [length, angle] = tolerance;
    let mut told = std::collections::BTreeSet::new();
    for loop_ in loops(model) {
        let (mut of, reference, tilts) = tilted(model, poses, &loop_, angle);
        let Some(reference) = reference else { continue };
        for tilt in tilts {
            if !told.insert((reference.joint, tilt.joint)) {
                continue;
            }
            let is_near = tilt.off <= near(angle);
            if axes == Axes::Snapped && is_near {
                snap(model, poses, &tilt, findings);
                for axis in of.iter_mut().filter(|axis| axis.joint == tilt.joint) {
                    axis.direction = tilt.direction;
                }
                continue;
            }
            let within = if angle.is_some_and(|angle| tilt.off <= angle) {
                ", within the digits of the file"
            } else {
                ""
            };
            let advice = if is_near {
                " (--snap makes it parallel)"
            } else {
                ""
            };
            let what = sentence(&tilt.words(model));
            findings.remarks.push(format!("{what}{within}{advice}."));
        }
        let Some(length) = length else { continue };
        for pair in of.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let normal = a.direction.cross(&b.direction);
            if normal.norm() <= NEARLY {
                continue;
            }
            let normal = normal.normalize();
            let off = normal.dot(&(b.point - a.point));
            if off.abs() <= length * MEETING
                || off.abs() > 2.0 * length
                || !told.insert((a.joint, b.joint))
            {
                continue;
            }
            let [one, two] = [a, b].map(|axis| &model.joints[axis.joint].name);
            let what = format!(
                "The axes of `{one}` and `{two}` meet to {}, within the digits of the file",
                estimate(off.abs(), "m")
            );
            if axes == Axes::Snapped {
                findings.remarks.push(format!(
                    "{what}; the import moves the axes so that they meet."
                ));
                shift(model, poses, b.joint, -normal * off);
            } else {
                findings
                    .remarks
                    .push(format!("{what} (--snap makes them meet)."));
            }
        }
    }
}

/// Returns the angle between two lines, independent of the sense of the lines.
fn tilt(a: &JointAxis, b: &JointAxis) -> f64 {
    let sine = a.direction.cross(&b.direction).norm();
    sine.atan2(a.direction.dot(&b.direction).abs())
}

fn axis(model: &Model, poses: &[Isometry3<f64>], joint: usize) -> Option<JointAxis> {
    let of = &model.joints[joint];
    let has_axis = matches!(
        of.kind,
        JointKind::Revolute
            | JointKind::Translational
            | JointKind::Cylindrical
            | JointKind::Screw(_)
    );
    let pose = of.links[1].map_or_else(Isometry3::identity, |link| poses[link]);
    has_axis.then(|| JointAxis {
        joint,
        point: (pose * Point3::from(of.points[1])).coords,
        direction: pose.rotation * of.axes[1],
    })
}

/// Sets the direction of the axis of a joint.
fn turn(model: &mut Model, poses: &[Isometry3<f64>], joint: usize, direction: Vector3<f64>) {
    let of = &mut model.joints[joint];
    for side in 0..2 {
        let pose = of.links[side].map_or_else(Isometry3::identity, |link| poses[link]);
        of.axes[side] = pose.rotation.inverse() * direction;
    }
}

/// Moves the point of a joint.
fn shift(model: &mut Model, poses: &[Isometry3<f64>], joint: usize, by: Vector3<f64>) {
    let of = &mut model.joints[joint];
    for side in 0..2 {
        let pose = of.links[side].map_or_else(Isometry3::identity, |link| poses[link]);
        of.points[side] += pose.rotation.inverse() * by;
    }
}

/// Returns the joints of each loop. These are the joint that closes the loop, and the joints of the
/// tree between the links of this joint.
fn loops(model: &Model) -> Vec<Vec<usize>> {
    let before = placing(model);
    let chain = |link: Option<usize>| {
        let (mut out, mut at) = (Vec::new(), link);
        while let Some(joint) = at.and_then(|link| before[link]) {
            out.push(joint);
            if out.len() > model.joints.len() {
                break;
            }
            at = model.joints[joint].links[0];
        }
        out
    };
    let closing = model.joints.iter().enumerate();
    let closing = closing
        .filter(|(_, joint)| !joint.places && joint.is_active && joint.kind != JointKind::Free);
    closing
        .map(|(k, joint)| {
            let [mut a, mut b] = joint.links.map(chain);
            // Joints that both chains contain do not belong to the loop.
            while a.last().is_some() && a.last() == b.last() {
                a.pop();
                b.pop();
            }
            a.reverse();
            a.push(k);
            a.extend(b);
            a
        })
        .collect()
}
