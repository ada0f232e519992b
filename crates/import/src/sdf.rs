//! SDF, the format of Gazebo: <http://sdformat.org/spec>.

mod frames;
mod inertial;
mod names;
mod parts;
mod scope;

use std::collections::{HashMap, HashSet};

use model::words::quantity;
use nalgebra::{Isometry3, Vector3};

use crate::changing::refuse_second;
use crate::extensions;
use crate::files::Files;
use crate::findings::{Fault, Findings, NumberKind};
use crate::limits::APART;
use crate::mechanism::{Coupling, Frame, HeldWeight, JointKind, Link, Load, Model};
use crate::solids::{FRICTION, assume_gravity, find_tree, joint_between, with_second_axis};
use crate::xml::{Element, Value};
pub(crate) use frames::Frames;
use frames::{base_of, pose_of};
use inertial::{ModelLink, mass_of};
pub(crate) use names::NAMES;
use parts::{ModelItem, Part};
use scope::SceneNames;
pub(crate) use scope::Scope;

/// Reads the models of a file. `chosen` is the name of the only model that is read.
pub(crate) fn read<'a>(
    files: &'a Files<'a>,
    chosen: Option<&str>,
    findings: &mut Findings,
) -> Model {
    let mut model = Model::default();
    let world = parts::world(files, chosen, findings);
    // If models cannot be read, names are missing. They are not reported as separate faults.
    let Some(world) = world.filter(|_| !findings.has_problems()) else {
        return model;
    };
    model.name = name_of(&world);
    let gravity = world.element.text_of("gravity");
    match gravity.map(|value| findings.vector(&value, NumberKind::Other)) {
        Some(Some(gravity)) => model.gravity = gravity,
        Some(None) => return model,
        None => assume_gravity(&mut model, findings),
    }
    let frames = Frames::of_world(&world, findings);
    // If a name is used twice, the frames of one model are missing.
    if findings.has_problems() {
        return model;
    }
    let names = SceneNames::of(&world);
    let mut reader = ModelReader {
        world: &frames,
        names: &names,
        numbers: HashMap::new(),
    };
    reader.links(&world, &frames, false, &mut model, findings);
    reader.joints(&world, &frames, &mut model, findings);
    let joints = model.joints.iter().enumerate();
    reader.numbers = joints.map(|(k, joint)| (joint.name.clone(), k)).collect();
    reader.mimics(&world, &frames, &mut model, findings);
    reader.plugins(&world, &frames, &mut model, findings);
    find_tree(&mut model);
    model
}

/// The name of the only model, or of the world.
fn name_of(world: &Part) -> String {
    let name = match world.parts.as_slice() {
        [only] => only.name.as_str(),
        _ => world
            .element
            .attribute("name")
            .map_or("", |name| name.text.trim()),
    };
    if name.is_empty() {
        "SDF model".to_owned()
    } else {
        name.to_owned()
    }
}

/// Reads the elements of all models.
struct ModelReader<'r> {
    world: &'r Frames,
    names: &'r SceneNames,
    /// The joints by name, after they were read.
    numbers: HashMap<String, usize>,
}

impl<'r> ModelReader<'r> {
    /// Reads the links of a model and of the models within it, in the order of their numbers.
    fn links(
        &self,
        part: &Part,
        frames: &Frames,
        around_is_static: bool,
        model: &mut Model,
        findings: &mut Findings,
    ) {
        let is_static = part.is_static || around_is_static;
        for item in part.items_of("link") {
            refuse_world(item.element, item.name, findings);
            refuse_second(
                item.element,
                &["inertial", "pose", "gravity"],
                READER,
                findings,
            );
            let name = self.names.place(&part.path, item.name);
            let pose = frames.pose(item.name).unwrap_or_default();
            let share = held_share(item.element, &name, findings);
            let link = ModelLink {
                element: item.element,
                name: &name,
                pose,
                frames,
            };
            // A static link has no inertia.
            let mass = (!is_static).then(|| mass_of(&link, findings));
            let mass = mass.flatten().unwrap_or_default();
            let number = model.links.len();
            model.links.push(Link {
                name: name.clone(),
                pose,
                mass,
                held: HeldWeight::of(share, &mass),
            });
            if is_static {
                let (links, here) = ([None, Some(number)], Isometry3::identity());
                let name = format!("static {name}");
                let fixed =
                    joint_between(model, &name, JointKind::Fixed, links, here, Vector3::z());
                model.joints.push(fixed);
            }
        }
        for (inner, frames) in inner(part, frames) {
            self.links(inner, frames, is_static, model, findings);
        }
    }

    /// Reads the joints and frames of a model and of the models within it.
    fn joints(&self, part: &Part, frames: &Frames, model: &mut Model, findings: &mut Findings) {
        for (name, link, pose) in frames.places(&model.links) {
            let name = self.names.place(&part.path, &name);
            model.frames.push(Frame { name, link, pose });
        }
        let mut seen = HashSet::new();
        for item in part.items_of("joint") {
            if !seen.insert(item.name) {
                let message = format!("the joint `{}` is defined twice", item.name);
                findings.of(Fault::Twice, item.element, message);
            }
            joint(
                item.element,
                &self.scope(part, item, frames),
                model,
                findings,
            );
        }
        for (inner, frames) in inner(part, frames) {
            self.joints(inner, frames, model, findings);
        }
    }

    fn mimics(&self, part: &Part, frames: &Frames, model: &mut Model, findings: &mut Findings) {
        for item in part.items_of("joint") {
            mimic(
                item.element,
                &self.scope(part, item, frames),
                model,
                findings,
            );
        }
        for (inner, frames) in inner(part, frames) {
            self.mimics(inner, frames, model, findings);
        }
    }

    fn plugins(&self, part: &Part, frames: &Frames, model: &mut Model, findings: &mut Findings) {
        for item in part.items_of("plugin") {
            let scope = self.scope(part, item, frames);
            extensions::plugin(item.element, &scope, model, "plugins", findings);
        }
        for (inner, frames) in inner(part, frames) {
            self.plugins(inner, frames, model, findings);
        }
    }

    fn scope<'s>(&'s self, part: &'s Part, item: &ModelItem, frames: &'s Frames) -> Scope<'s> {
        let frames = [self.world, frames];
        Scope::of_item(item, part, frames, self.names, &self.numbers)
    }
}

/// The models within a model, with their names.
fn inner<'p, 'a>(
    part: &'p Part<'a>,
    frames: &'p Frames,
) -> impl Iterator<Item = (&'p Part<'a>, &'p Frames)> {
    let parts = part.parts.iter();
    parts.filter_map(|inner| Some((inner, frames.inner(&inner.name)?)))
}

fn unsupported(element: Element, message: &str, findings: &mut Findings) {
    findings.of(Fault::Unsupported, element, message);
}

/// Rejects a link with the reserved name of the ground, which joints cannot distinguish from it.
fn refuse_world(link: Element, name: &str, findings: &mut Findings) {
    if name == "world" {
        let message = "a link has the name `world`, which is reserved for the ground";
        let help = "rename the link, also in the joints that refer to it".to_owned();
        let (source, span) = (link.source, link.span());
        findings.fault_with_help(Fault::Unsupported, source, span, message, "", help);
    }
}

/// Returns the compensated share of the weight of a link, and reports its contacts.
fn held_share(link: Element, name: &str, findings: &mut Findings) -> f64 {
    for collision in link.children().filter(|child| child.name() == "collision") {
        findings.leave_element("contacts of links", collision, name);
    }
    let falls = link.text_of("gravity");
    let falls = falls
        .and_then(|value| findings.boolean(&value))
        .unwrap_or(true);
    if falls { 0.0 } else { 1.0 }
}

/// Elements that change the mechanism, and that a joint contains once.
const IN_JOINT: [&str; 5] = ["parent", "child", "pose", "axis", "axis2"];

/// The program that reads only the first of two elements.
const READER: &str = "Gazebo uses";

/// An axis with its loads.
struct Axis {
    /// Direction in the axes of the second link.
    direction: Vector3<f64>,
    load: Load,
}

/// Reads a joint and adds it to the model.
pub(crate) fn joint(element: Element, scope: &Scope, model: &mut Model, findings: &mut Findings) {
    // Missing or wrong content has already been reported.
    let _ = read_joint(element, scope, model, findings);
}

fn read_joint(
    element: Element,
    scope: &Scope,
    model: &mut Model,
    findings: &mut Findings,
) -> Option<()> {
    let Some(name) = element.attribute("name") else {
        findings.missing(element, "a `name`");
        return None;
    };
    let name = name.text.trim();
    let Some(kind) = element.attribute("type") else {
        findings.missing(element, "a `type`");
        return None;
    };
    refuse_second(element, &IN_JOINT, READER, findings);
    let links = links_of(element, name, scope, findings)?;
    // A pose relative to the ground is read from its own numbers.
    let is_of_ground = links[1].is_none() && element.child("pose").and_then(base_of).is_none();
    let in_second = match scope.frames.pose_of_joint(name).filter(|_| !is_of_ground) {
        Some(pose) => model.pose(links[1]).inverse() * pose,
        None => match element.child("pose") {
            Some(pose) => pose_of(pose, NumberKind::Length, findings)?,
            None => Isometry3::identity(),
        },
    };
    look_at_parent(
        element,
        name,
        model.pose(links[1]) * in_second,
        scope,
        findings,
    );
    let axis = |key: &str, findings: &mut Findings| {
        let child = element.child(key);
        child.map(|child| read_axis(child, name, &in_second, links, scope, model, findings))
    };
    let first = axis("axis", findings);
    let second = axis("axis2", findings);
    let z = Axis {
        direction: in_second.rotation * Vector3::z(),
        load: Load::default(),
    };
    let first = match first {
        Some(axis) => axis?,
        None => z,
    };
    let found = kind_of(element, name, &kind, findings)?;
    if is_passive(element) {
        model.passive.insert(model.joints.len());
    }
    let mut joint = joint_between(
        model,
        &scope.joint(name),
        found,
        links,
        in_second,
        first.direction,
    );
    if found.measures().is_empty() {
        if first.load != Load::default() {
            findings.leave_element(
                "springs and dampers of joints without one axis",
                element,
                name,
            );
        }
    } else {
        joint.loads[0] = first.load;
    }
    if found == JointKind::Universal {
        let Some(second) = second else {
            findings.missing(element, "an `<axis2>`");
            return None;
        };
        let second = second?;
        with_second_axis(model, joint, second.direction, second.load);
    } else {
        model.joints.push(joint);
    }
    Some(())
}

/// Whether a joint has an effort limit of zero, so that no actuator can act on it.
fn is_passive(joint: Element) -> bool {
    let limit = joint.child("axis").and_then(|axis| axis.child("limit"));
    let effort = limit.and_then(|limit| limit.text_of("effort"));
    effort.is_some_and(|effort| effort.text.parse() == Ok(0.0))
}

/// Reports a joint that is not at its parent frame. SDF places a joint at its child.
fn look_at_parent(
    element: Element,
    name: &str,
    joint: Isometry3<f64>,
    scope: &Scope,
    findings: &mut Findings,
) {
    let Some(parent) = element.child("parent") else {
        return;
    };
    let parent = parent.text();
    let frame = parent.text.trim();
    let pose = scope.pose(frame);
    let Some(pose) = pose.filter(|_| scope.frames.is_frame(frame)) else {
        return;
    };
    let apart = (pose.translation.vector - joint.translation.vector).norm();
    if apart > APART {
        findings.remarks.push(format!(
            "The joint `{name}` is {} away from its parent frame `{frame}`: SDF places a joint at its child.",
            quantity(apart, "m")
        ));
    }
}

/// The links of `<parent>` and `<child>`.
fn links_of(
    element: Element,
    name: &str,
    scope: &Scope,
    findings: &mut Findings,
) -> Option<[Option<usize>; 2]> {
    let mut end = |key: &str| {
        let Some(child) = element.child(key) else {
            findings.missing(element, &format!("a `<{key}>`"));
            return None;
        };
        // In `<gazebo>` of a URDF the name may be an attribute.
        let value = child.attribute("link").unwrap_or_else(|| child.text());
        scope.link(&value, findings)
    };
    let (first, second) = (end("parent"), end("child"));
    let links = [first?, second?];
    if links[0] == links[1] {
        let message = format!("joint `{name}` connects a link with itself");
        findings.of(Fault::Structure, element, message);
        return None;
    }
    Some(links)
}

fn kind_of(
    element: Element,
    name: &str,
    kind: &Value,
    findings: &mut Findings,
) -> Option<JointKind> {
    Some(match kind.text.trim() {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Translational,
        "ball" => JointKind::Spherical,
        "fixed" => JointKind::Fixed,
        "universal" | "revolute2" => JointKind::Universal,
        "screw" => JointKind::Screw(pitch_of(element, findings)?),
        "gearbox" => {
            unsupported(
                element,
                "a `gearbox` is not supported: write it as a `mimic`, or add a `coupling` to the scene",
                findings,
            );
            return None;
        }
        other => {
            let shown: String = other.chars().take(40).collect();
            let message = format!("joint `{name}`: there is no type `{shown}`");
            findings.at(Fault::Value, kind, message);
            return None;
        }
    })
}

/// The advance of a screw per revolution.
fn pitch_of(element: Element, findings: &mut Findings) -> Option<f64> {
    if let Some(metres) = element.text_of("screw_thread_pitch") {
        return findings.number(&metres, NumberKind::Length);
    }
    let Some(value) = element.text_of("thread_pitch") else {
        findings.missing(element, "a `<screw_thread_pitch>`");
        return None;
    };
    let turns = findings.number(&value, NumberKind::Other)?;
    if turns == 0.0 {
        findings.at(Fault::Range, &value, "a thread without a pitch");
        return None;
    }
    Some(-std::f64::consts::TAU / turns)
}

fn read_axis(
    element: Element,
    joint: &str,
    in_second: &Isometry3<f64>,
    links: [Option<usize>; 2],
    scope: &Scope,
    model: &Model,
    findings: &mut Findings,
) -> Option<Axis> {
    let xyz = element.child("xyz");
    let given = match xyz {
        Some(xyz) => findings.direction(&xyz.text())?,
        None => Vector3::z(),
    };
    let of_model = element.text_of("use_parent_model_frame");
    let of_model = match of_model {
        Some(value) => findings.boolean(&value)?,
        None => scope.in_model,
    };
    let expressed = xyz.and_then(|xyz| xyz.attribute("expressed_in"));
    let second = model.pose(links[1]).rotation;
    let direction = match expressed.filter(|value| !value.text.is_empty()) {
        Some(value) => {
            let Some(pose) = scope.pose(value.text.trim()) else {
                let message = format!("{}: there is no frame `{}`", value.subject, value.text);
                findings.at(Fault::Unknown, &value, message);
                return None;
            };
            second.inverse() * (pose.rotation * given)
        }
        None if of_model => second.inverse() * (scope.model().rotation * given),
        None => in_second.rotation * given,
    };
    let mut load = Load::default();
    for child in element.children() {
        match child.name() {
            "limit" => {
                // Limits as large as 1e16 mean no limit.
                let bounds = ["lower", "upper"].map(|key| {
                    let text = child.text_of(key)?;
                    text.text.parse::<f64>().ok().filter(|x| x.abs() < 1e15)
                });
                if bounds.iter().any(Option::is_some) {
                    findings.leave_element("limits of joints", child, joint);
                }
            }
            "dynamics" => {
                let mut number = |key: &str| match child.text_of(key) {
                    Some(value) => findings.not_negative(&value, NumberKind::Other),
                    None => Some(0.0),
                };
                load.damping = number("damping")?;
                load.stiffness = number("spring_stiffness")?;
                if number("friction")? != 0.0 {
                    findings.leave_element(FRICTION, child, joint);
                }
                if let Some(value) = child.text_of("spring_reference") {
                    load.reference = findings.number(&value, NumberKind::Other)?;
                }
            }
            _ => {}
        }
    }
    Some(Axis { direction, load })
}

/// `<mimic>` of an axis: y = multiplier·(x − reference) + offset.
fn mimic(element: Element, scope: &Scope, model: &mut Model, findings: &mut Findings) {
    let Some(name) = element.attribute("name") else {
        return;
    };
    for (coordinate, key) in ["axis", "axis2"].into_iter().enumerate() {
        let Some(mimic) = element.child(key).and_then(|axis| axis.child("mimic")) else {
            continue;
        };
        let Some(other) = mimic.attribute("joint") else {
            findings.missing(mimic, "a `joint`");
            continue;
        };
        let led = usize::from(
            mimic
                .attribute("axis")
                .is_some_and(|axis| axis.text == "axis2"),
        );
        let (Some(y), Some(x)) = (scope.number_of(name.text), scope.number_of(other.text)) else {
            let message = format!("there is no joint `{}`", other.text);
            findings.at(Fault::Unknown, &other, message);
            continue;
        };
        let has = |joint: usize, k: usize| model.joints[joint].kind.measures().len() > k;
        if !has(x, led) || !has(y, coordinate) || (x, led) == (y, coordinate) {
            let message = format!("joint `{}` cannot follow `{}`", name.text, other.text);
            findings.at(Fault::Structure, &other, message);
            continue;
        }
        let mut number = |key: &str, default: f64| match mimic.text_of(key) {
            Some(value) => findings
                .number(&value, NumberKind::Other)
                .unwrap_or(default),
            None => default,
        };
        let (multiplier, offset) = (number("multiplier", 1.0), number("offset", 0.0));
        let reference = number("reference", 0.0);
        model.couplings.push(Coupling {
            name: format!("{} follows {}", model.joints[y].name, model.joints[x].name),
            x: Some((x, led)),
            y: (y, coordinate),
            coefficients: vec![offset - multiplier * reference, multiplier],
            is_active: true,
        });
    }
}
