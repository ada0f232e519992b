//! Named poses of links, joints and frames, each given relative to another pose.

use std::collections::HashMap;

use nalgebra::Isometry3;

use crate::findings::{Fault, Findings, NumberKind};
use crate::mechanism::Link;
use crate::pose::quaternion;
use crate::solids::roll_pitch_yaw;
use crate::xml::{Element, Value};

/// A named pose in a file.
struct Place {
    /// The name of the reference frame; `None` for the model.
    base: Option<String>,
    own: Isometry3<f64>,
    what: What,
}

#[derive(Clone, PartialEq)]
enum What {
    Link(usize),
    Joint,
    /// A frame, with the name of the item to which the frame is attached.
    Frame(Option<String>),
}

/// The key for the frame of a joint, because a joint may have the name of a link.
fn of_joint(name: &str) -> String {
    format!("{name}\0joint")
}

/// All named poses of a model, in ground axes at the described pose.
#[derive(Default)]
pub(super) struct Frames {
    places: HashMap<String, Place>,
    poses: HashMap<String, Isometry3<f64>>,
    model: Isometry3<f64>,
}

impl Frames {
    pub(super) fn read(model: Element, links: &[String], findings: &mut Findings) -> Self {
        let mut frames = Self::default();
        if let Some(pose) = model.child("pose") {
            frames.model = pose_of(pose, NumberKind::Length, findings).unwrap_or_default();
        }
        let mut numbers = links.iter().enumerate();
        for child in model.children() {
            let what = match child.name() {
                "link" => match child.attribute("name").and_then(|_| numbers.next()) {
                    Some((number, _)) => What::Link(number),
                    None => continue,
                },
                "joint" => What::Joint,
                "frame" => What::Frame(
                    child
                        .attribute("attached_to")
                        .map(|v| v.text.trim().to_owned()),
                ),
                _ => continue,
            };
            let Some(name) = child.attribute("name") else {
                continue;
            };
            let pose = child.child("pose");
            let relative = pose
                .and_then(base_of)
                .map(|value| value.text.trim().to_owned());
            let base = relative.or_else(|| match &what {
                What::Link(_) => None,
                What::Joint => child.text_of("child").map(|value| value.text.to_owned()),
                What::Frame(attached) => attached.clone().filter(|name| !name.is_empty()),
            });
            let base = base.filter(|name| !matches!(name.as_str(), "__model__" | "world"));
            let own = pose.and_then(|pose| pose_of(pose, NumberKind::Length, findings));
            let own = own.unwrap_or_default();
            let name = name.text.trim().to_owned();
            let name = match what {
                What::Joint => of_joint(&name),
                _ => name,
            };
            if what != What::Joint && frames.places.contains_key(&name) {
                let message = format!("the name `{name}` is used twice");
                findings.of(Fault::Twice, child, message);
                continue;
            }
            frames.places.insert(name, Place { base, own, what });
        }
        frames.resolve(model, findings);
        frames
    }

    /// Combines the poses along the chains.
    fn resolve(&mut self, model: Element, findings: &mut Findings) {
        let mut names: Vec<&String> = self.places.keys().collect();
        names.sort();
        for name in names {
            let (mut chain, mut at): (Vec<(&String, &Place)>, _) = (Vec::new(), Some(name));
            let mut known = self.model;
            while let Some(name) = at {
                if let Some(found) = self.poses.get(name) {
                    known = *found;
                    break;
                }
                let joint = of_joint(name);
                let Some((name, place)) = self
                    .places
                    .get_key_value(name)
                    .or_else(|| self.places.get_key_value(&joint))
                else {
                    // The reader of joints rejects a joint of a missing link.
                    if !matches!(
                        chain.last(),
                        Some((
                            _,
                            Place {
                                what: What::Joint,
                                ..
                            }
                        ))
                    ) {
                        let message =
                            format!("a pose is relative to `{name}`, which does not exist");
                        findings.of(Fault::Unknown, model, message);
                    }
                    chain.clear();
                    break;
                };
                chain.push((name, place));
                if chain.len() > self.places.len() {
                    let message = format!("the pose of `{name}` is relative to itself");
                    findings.of(Fault::Structure, model, message);
                    // The names of a cycle get arbitrary poses, so that the cycle is not reported
                    // again for other names.
                    break;
                }
                at = place.base.as_ref();
            }
            for (name, place) in chain.into_iter().rev() {
                known *= place.own;
                self.poses.insert(name.clone(), known);
            }
        }
    }

    /// The pose of a link, joint or frame.
    pub(super) fn pose(&self, name: &str) -> Option<Isometry3<f64>> {
        if name == "__model__" {
            return Some(self.model);
        }
        let found = self.poses.get(name);
        found.or_else(|| self.poses.get(&of_joint(name))).copied()
    }

    /// A pose in the axes of a link, from an element within the link.
    pub(super) fn pose_in_link(
        &self,
        element: Element,
        link: &str,
        findings: &mut Findings,
    ) -> Option<Isometry3<f64>> {
        let own = pose_of(element, NumberKind::Other, findings)?;
        let Some(base) = base_of(element) else {
            return Some(own);
        };
        let Some(pose) = self.pose(base.text.trim()) else {
            let message = format!("{}: there is no frame `{}`", base.subject, base.text);
            findings.at(Fault::Unknown, &base, message);
            return None;
        };
        Some(self.pose(link)?.inverse() * pose * own)
    }

    /// The pose of the frame of a joint.
    pub(super) fn pose_of_joint(&self, name: &str) -> Option<Isometry3<f64>> {
        self.poses.get(&of_joint(name)).copied()
    }

    pub(super) fn model(&self) -> Isometry3<f64> {
        self.model
    }

    /// The link of a frame.
    pub(super) fn link_of(&self, name: &str) -> Option<usize> {
        let (mut at, mut steps) = (name, 0);
        loop {
            match &self.places.get(at)?.what {
                What::Link(link) => return Some(*link),
                What::Frame(Some(next)) if steps < self.places.len() => at = next,
                _ => return None,
            }
            steps += 1;
        }
    }

    /// Frames with the links to which they are attached, in the axes of these links.
    pub(super) fn places(&self, links: &[Link]) -> Vec<(String, Option<usize>, Isometry3<f64>)> {
        let frames = self
            .places
            .iter()
            .filter(|(_, place)| matches!(place.what, What::Frame(_)));
        let mut out: Vec<_> = frames
            .filter_map(|(name, _)| {
                let link = self.link_of(name)?;
                let pose = links.get(link)?.pose.inverse() * self.poses.get(name)?;
                Some((name.clone(), Some(link), pose))
            })
            .collect();
        out.sort_by(|a, b| a.0.cmp(&b.0));
        out
    }
}

/// The name of the frame to which a pose is relative.
fn base_of(pose: Element) -> Option<Value> {
    let name = pose.attribute("relative_to");
    let name = name.or_else(|| pose.attribute("frame"));
    name.filter(|value| !value.text.trim().is_empty())
}

/// Reads a pose of six numbers (position, and angles about fixed axes), or of seven numbers
/// (position, and quaternion x, y, z, w).
pub(super) fn pose_of(
    element: Element,
    counted: NumberKind,
    findings: &mut Findings,
) -> Option<Isometry3<f64>> {
    let value = element.text();
    let in_degrees = match element.attribute("degrees") {
        Some(value) => findings.boolean(&value)?,
        None => false,
    };
    let format = element.attribute("rotation_format");
    let is_quaternion = format.is_some_and(|value| value.text.trim() == "quat_xyzw");
    let n = if is_quaternion { 7 } else { 6 };
    if value.text.is_empty() {
        return Some(Isometry3::identity());
    }
    // Digits of lengths and of angles are counted separately.
    let numbers = findings.numbers(&value, [n, n], NumberKind::Other)?;
    if counted != NumberKind::Other {
        for (k, word) in value.text.split_whitespace().enumerate() {
            if k < 3 {
                findings.lengths.see(word);
            } else {
                findings.directions.see(word);
            }
        }
    }
    let place = nalgebra::Translation3::new(numbers[0], numbers[1], numbers[2]);
    let turned = if is_quaternion {
        if numbers[3..].iter().all(|x| *x == 0.0) {
            let message = "a quaternion of zeros does not define an orientation";
            findings.at(Fault::Range, &value, message);
            return None;
        }
        quaternion([numbers[6], numbers[3], numbers[4], numbers[5]])
    } else {
        let unit = if in_degrees {
            std::f64::consts::PI / 180.0
        } else {
            1.0
        };
        if !in_degrees {
            findings.look_for_degrees(&value, &numbers[3..]);
        }
        roll_pitch_yaw([numbers[3] * unit, numbers[4] * unit, numbers[5] * unit])
    };
    Some(Isometry3::from_parts(place, turned))
}
