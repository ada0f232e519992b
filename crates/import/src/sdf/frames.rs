//! Named poses of links, joints and frames, each given relative to another pose.

use std::collections::HashMap;

use nalgebra::Isometry3;

use super::parts::{self, MergedModel, ModelItem, Part};
use crate::findings::{Fault, Findings, NumberKind};
use crate::mechanism::Link;
use crate::pose::quaternion;
use crate::solids::roll_pitch_yaw;
use crate::xml::{Element, Value};

/// A named pose in a model.
struct Place {
    /// The name of the reference frame; `None` for the model.
    base: Option<String>,
    own: Isometry3<f64>,
    what: What,
}

enum What {
    Link(usize),
    /// A joint, with the name of its child.
    Joint(Option<String>),
    /// A frame, with the name of the item to which the frame is attached; `None` for the model.
    Frame(Option<String>),
    /// A model within the model.
    Model,
    /// A merged model, with the name of the link of its frame.
    Merged(Option<String>),
}

/// The key for the frame of a joint, because a joint may have the name of a link.
fn of_joint(name: &str) -> String {
    format!("{name}{JOINT}")
}

const JOINT: &str = "\0joint";

/// All named poses of a model, at the described pose.
#[derive(Default)]
pub(crate) struct Frames {
    places: HashMap<String, Place>,
    /// Poses relative to the model.
    poses: HashMap<String, Isometry3<f64>>,
    /// The models within the model.
    inner: HashMap<String, Frames>,
    /// The pose of the model in ground axes.
    model: Isometry3<f64>,
    /// The link to which the frame of the model belongs.
    canonical: Option<String>,
    is_world: bool,
}

impl Frames {
    /// The links of a URDF, without poses.
    pub(crate) fn of_links(names: &HashMap<String, usize>) -> Self {
        let place = |link: &usize| Place {
            base: None,
            own: Isometry3::identity(),
            what: What::Link(*link),
        };
        let places = names.iter().map(|(name, link)| (name.clone(), place(link)));
        Self {
            places: places.collect(),
            ..Self::default()
        }
    }

    /// The poses of the world in ground axes.
    pub(super) fn of_world(world: &Part, findings: &mut Findings) -> Self {
        let mut frames = Self::read(world, findings);
        frames.settle(Isometry3::identity());
        frames
    }

    /// Reads the poses of a model, and of the models within it, relative to the model.
    fn read(part: &Part, findings: &mut Findings) -> Self {
        let mut frames = Self {
            canonical: part.canonical().map(str::to_owned),
            is_world: part.is_world,
            ..Self::default()
        };
        for inner in &part.parts {
            let of_inner = Self::read(inner, findings);
            frames.inner.insert(inner.name.clone(), of_inner);
        }
        for merged in &part.merged {
            let what = What::Merged(merged.canonical.map(str::to_owned));
            frames.model_at(&merged.name, &merged.place, what, part, findings);
        }
        for inner in &part.parts {
            frames.model_at(&inner.name, &inner.place, What::Model, part, findings);
            frames.shift(inner, findings);
        }
        for item in &part.items {
            frames.item(item, part, findings);
        }
        for merged in part.merged.iter().rev() {
            frames.shift_merged(merged, findings);
        }
        frames.resolve(part.element, findings);
        frames
    }

    fn item(&mut self, item: &ModelItem, part: &Part, findings: &mut Findings) {
        let (element, name) = (item.element, item.name);
        let word = |value: Option<Value>| value.map(|value| value.text.trim().to_owned());
        let (what, default) = match element.name() {
            "link" => (What::Link(item.link), None),
            "joint" => {
                let child = word(element.text_of("child"));
                (What::Joint(child.clone()), child)
            }
            "frame" => {
                let attached = word(element.attribute("attached_to"));
                let attached = attached.filter(|name| !name.is_empty());
                (What::Frame(attached.clone()), attached)
            }
            _ => return,
        };
        let key = match what {
            What::Joint(_) => of_joint(name),
            _ => name.to_owned(),
        };
        let pose = element.child("pose");
        let base = base_in(pose, default, item.within, part);
        let own = pose.and_then(|pose| pose_of(pose, NumberKind::Length, findings));
        let own = own.unwrap_or_default();
        self.add(key, Place { base, own, what }, element, findings);
    }

    /// Adds the frame of a model at its stated pose.
    fn model_at(
        &mut self,
        name: &str,
        place: &parts::Placement,
        what: What,
        part: &Part,
        findings: &mut Findings,
    ) {
        let base = base_in(place.pose, None, place.within, part);
        let own = place
            .pose
            .and_then(|pose| pose_of(pose, NumberKind::Length, findings));
        let own = own.unwrap_or_default();
        let element = place.pose.unwrap_or(part.element);
        self.add(
            name.to_owned(),
            Place { base, own, what },
            element,
            findings,
        );
    }

    fn add(&mut self, key: String, place: Place, element: Element, findings: &mut Findings) {
        if !matches!(place.what, What::Joint(_)) && self.places.contains_key(&key) {
            let message = format!("the name `{key}` is used twice");
            return findings.of(Fault::Twice, element, message);
        }
        self.places.insert(key, place);
    }

    /// Moves a model so that its placement frame, in place of its own frame, is at the stated pose.
    fn shift(&mut self, inner: &Part, findings: &mut Findings) {
        let Some(frame) = &inner.place.frame else {
            return;
        };
        let of_inner = self.inner.get(&inner.name);
        let pose = of_inner.and_then(|frames| frames.pose(frame.text.trim()));
        match (pose, self.places.get_mut(&inner.name)) {
            (Some(pose), Some(place)) => place.own *= pose.inverse(),
            _ => no_frame(frame, findings),
        }
    }

    /// Moves a merged model so that its placement frame is at the stated pose.
    fn shift_merged(&mut self, merged: &MergedModel, findings: &mut Findings) {
        let Some(frame) = &merged.place.frame else {
            return;
        };
        let (mut pose, mut at) = (Isometry3::identity(), Some(frame.text.trim().to_owned()));
        let mut steps = 0;
        while let Some(name) = at.take_if(|name| *name != merged.name) {
            let Some((own, base)) = self.step(&name) else {
                break;
            };
            pose = own * pose;
            steps += 1;
            at = base.filter(|_| steps <= self.places.len());
            if at.is_none() {
                return no_frame(frame, findings);
            }
        }
        match (at, self.places.get_mut(&merged.name)) {
            (Some(_), Some(place)) => place.own *= pose.inverse(),
            _ => no_frame(frame, findings),
        }
    }

    /// The pose of a name relative to another name of the model, and this name.
    fn step(&self, name: &str) -> Option<(Isometry3<f64>, Option<String>)> {
        if let Some((_, place)) = self.place(name) {
            return Some((place.own, place.base.clone()));
        }
        let (part, pose) = self.within(name)?;
        Some((pose, Some(part.to_owned())))
    }

    fn place(&self, name: &str) -> Option<(&String, &Place)> {
        let found = self.places.get_key_value(name);
        found.or_else(|| self.places.get_key_value(&of_joint(name)))
    }

    /// The model within the model of a name such as `model::link`, and the pose of the name in
    /// axes of `pose`.
    fn within<'n>(&self, name: &'n str) -> Option<(&'n str, Isometry3<f64>)> {
        let (part, rest) = name.split_once("::")?;
        Some((part, self.inner.get(part)?.pose(rest)?))
    }

    /// Combines the poses along the chains.
    fn resolve(&mut self, model: Element, findings: &mut Findings) {
        let mut names: Vec<&String> = self.places.keys().collect();
        names.sort();
        for name in names {
            let mut chain: Vec<(String, Isometry3<f64>)> = Vec::new();
            let mut at = Some(name.clone());
            let mut known = Isometry3::identity();
            while let Some(name) = at {
                if let Some(found) = self.poses.get(&name) {
                    known = *found;
                    break;
                }
                let key = self
                    .place(&name)
                    .map_or_else(|| name.clone(), |(key, _)| key.clone());
                let Some((own, base)) = self.step(&name) else {
                    // The reader of joints rejects a joint of a missing link.
                    let of = chain.last().and_then(|(key, _)| self.places.get(key));
                    if !matches!(
                        of,
                        Some(Place {
                            what: What::Joint(_),
                            ..
                        })
                    ) {
                        let message =
                            format!("a pose is relative to `{name}`, which does not exist");
                        findings.of(Fault::Unknown, model, message);
                    }
                    chain.clear();
                    break;
                };
                chain.push((key, own));
                if chain.len() > 2 * self.places.len() {
                    let message = format!("the pose of `{name}` is relative to itself");
                    findings.of(Fault::Structure, model, message);
                    // The names of a cycle get arbitrary poses, so that the cycle is not reported
                    // again for other names.
                    break;
                }
                at = base;
            }
            for (name, own) in chain.into_iter().rev() {
                known *= own;
                self.poses.insert(name, known);
            }
        }
    }

    /// Sets the pose of the model, and of the models within it, in ground axes.
    fn settle(&mut self, model: Isometry3<f64>) {
        self.model = model;
        for (name, inner) in &mut self.inner {
            let own = self.poses.get(name).copied().unwrap_or_default();
            inner.settle(model * own);
        }
    }

    /// The models within the model.
    pub(super) fn inner(&self, name: &str) -> Option<&Self> {
        self.inner.get(name)
    }

    /// The names of links, frames and models.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        let names = self.places.keys().map(String::as_str);
        names.filter(|name| !name.contains('\0'))
    }

    /// The names of joints.
    pub(super) fn joints(&self) -> impl Iterator<Item = &str> {
        self.places.keys().filter_map(|key| key.strip_suffix(JOINT))
    }

    /// The pose of a link, joint, frame or model.
    pub(super) fn pose(&self, name: &str) -> Option<Isometry3<f64>> {
        if name == "__model__" {
            return Some(self.model);
        }
        if let Some((key, _)) = self.place(name) {
            return self.poses.get(key).map(|own| self.model * own);
        }
        Some(self.within(name)?.1)
    }

    /// A pose in the axes of a link with the given pose, from an element within the link.
    pub(super) fn pose_in_link(
        &self,
        element: Element,
        link: &Isometry3<f64>,
        findings: &mut Findings,
    ) -> Option<Isometry3<f64>> {
        let own = pose_of(element, NumberKind::Other, findings)?;
        let Some(base) = base_of(element) else {
            return Some(own);
        };
        let Some(pose) = self.pose(base.text.trim()) else {
            no_frame(&base, findings);
            return None;
        };
        Some(link.inverse() * pose * own)
    }

    /// The pose of the frame of a joint.
    pub(super) fn pose_of_joint(&self, name: &str) -> Option<Isometry3<f64>> {
        self.poses.get(&of_joint(name)).map(|own| self.model * own)
    }

    /// The link of a name; the inner `None` is the ground.
    pub(super) fn link_of(&self, name: &str) -> Option<Option<usize>> {
        let (mut at, mut steps) = (name, 0);
        while steps <= self.places.len() {
            steps += 1;
            let Some((key, place)) = self.place(at) else {
                return match (at, at.split_once("::")) {
                    ("world", _) => Some(None),
                    ("__model__", _) => self.canonical_link(),
                    (_, Some((part, rest))) => self.inner.get(part)?.link_of(rest),
                    _ => None,
                };
            };
            at = match &place.what {
                What::Link(link) => return Some(Some(*link)),
                What::Model => return self.inner.get(key)?.canonical_link(),
                What::Frame(None) => return self.canonical_link(),
                What::Joint(next) | What::Merged(next) => next.as_deref()?,
                What::Frame(Some(next)) => next,
            };
        }
        None
    }

    /// The link of the frame of the model.
    fn canonical_link(&self) -> Option<Option<usize>> {
        if self.is_world {
            return Some(None);
        }
        match &self.canonical {
            Some(name) => match (self.places.get(name), name.split_once("::")) {
                (Some(place), _) => match place.what {
                    What::Link(link) => Some(Some(link)),
                    _ => None,
                },
                (None, Some((part, rest))) => self.inner.get(part)?.link_of(rest),
                (None, None) => None,
            },
            None => {
                let mut names: Vec<&String> = self.inner.keys().collect();
                names.sort();
                self.inner.get(*names.first()?)?.canonical_link()
            }
        }
    }

    /// Whether a name is the name of a frame.
    pub(super) fn is_frame(&self, name: &str) -> bool {
        match self.places.get(name) {
            Some(place) => matches!(place.what, What::Frame(_)),
            None => name
                .split_once("::")
                .and_then(|(part, rest)| Some(self.inner.get(part)?.is_frame(rest)))
                .unwrap_or(false),
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
                let of_link = match link {
                    Some(link) => links.get(link)?.pose,
                    None => Isometry3::identity(),
                };
                Some((name.clone(), link, of_link.inverse() * self.pose(name)?))
            })
            .collect();
        out.sort_by(|a, b| a.0.cmp(&b.0));
        out
    }
}

/// The name to which a pose in a model is relative; `None` for the model.
fn base_in(
    pose: Option<Element>,
    default: Option<String>,
    within: Option<usize>,
    part: &Part,
) -> Option<String> {
    let given = pose
        .and_then(base_of)
        .map(|value| value.text.trim().to_owned());
    let name = given
        .or(default)
        .filter(|name| !matches!(name.as_str(), "__model__" | "world"));
    name.or_else(|| Some(part.merged.get(within?)?.name.clone()))
}

fn no_frame(value: &Value, findings: &mut Findings) {
    let message = format!("{}: there is no frame `{}`", value.subject, value.text);
    findings.at(Fault::Unknown, value, message);
}

/// The name of the frame to which a pose is relative.
pub(super) fn base_of(pose: Element) -> Option<Value> {
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
