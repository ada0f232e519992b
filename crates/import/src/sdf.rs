//! SDF, the format of Gazebo: <http://sdformat.org/spec>.

mod frames;
mod inertial;
mod names;

use std::collections::HashMap;

use model::words::quantity;
use nalgebra::{Isometry3, Vector3};

use crate::extensions;
use crate::findings::{Fault, Findings, NumberKind};
use crate::limits::APART;
use crate::mass::Mass;
use crate::mechanism::{Coupling, Frame, JointKind, Link, Load, Model};
use crate::solids::{FRICTION, assume_gravity, find_tree, joint_between, with_second_axis};
use crate::xml::{Element, Value};
use frames::{Frames, pose_of};
pub(crate) use names::NAMES;

/// Names of links for joints, and the convention of the file for axes.
pub(crate) struct Scope<'n> {
    links: HashMap<&'n str, Option<usize>>,
    frames: Frames,
    /// Whether joint axes are given in the axes of the model, as in versions before 1.5.
    in_model: bool,
}

impl<'n> Scope<'n> {
    /// The scope for joints in the element `<gazebo>` of a URDF.
    pub(crate) fn of_links(names: &'n HashMap<String, usize>) -> Self {
        let links = names
            .iter()
            .map(|(name, link)| (name.as_str(), Some(*link)));
        Self {
            links: links.collect(),
            frames: Frames::default(),
            in_model: false,
        }
    }

    pub(crate) fn link(&self, value: &Value, findings: &mut Findings) -> Option<Option<usize>> {
        let name = value.text.trim();
        if name == "world" {
            return Some(None);
        }
        if let Some(link) = self.links.get(name) {
            return Some(*link);
        }
        if let Some(link) = self.frames.link_of(name) {
            return Some(Some(link));
        }
        let near = scene::nearest(name, self.links.keys().copied());
        let help = near.map(|near| format!("did you mean `{near}`?"));
        let message = format!("{}: there is no link `{name}`", value.subject);
        let (source, span) = (value.source, value.span.clone());
        findings.fault_with_help(Fault::Unknown, source, span, message, "no such link", help);
        None
    }
}

/// Reads the model of a file.
pub(crate) fn read(root: Element, findings: &mut Findings) -> Model {
    let mut model = Model::default();
    let world = root.child("world");
    let around = world.unwrap_or(root);
    let models: Vec<Element> = around
        .children()
        .filter(|child| child.name() == "model")
        .collect();
    let &[element] = models.as_slice() else {
        let message = format!("one `<model>` is read, found {}", models.len());
        findings.of(Fault::Structure, root, message);
        return model;
    };
    let gravity = world.and_then(|world| world.text_of("gravity"));
    match gravity.map(|value| findings.vector(&value, NumberKind::Other)) {
        Some(Some(gravity)) => model.gravity = gravity,
        Some(None) => return model,
        None => assume_gravity(&mut model, findings),
    }
    for child in around.children() {
        match child.name() {
            "include" => unsupported(
                child,
                "`<include>` is not supported: put the model into the file",
                findings,
            ),
            "joint" => unsupported(
                child,
                "joints outside of a model are not supported",
                findings,
            ),
            _ => {}
        }
    }
    let version = root.attribute("version");
    let version = version.map_or((1, 6), |value| numbers_of(value.text));
    read_model(element, version, &mut model, findings);
    model
}

fn numbers_of(version: &str) -> (u32, u32) {
    let mut parts = version
        .trim()
        .split('.')
        .map(|part| part.parse().unwrap_or(0));
    (parts.next().unwrap_or(1), parts.next().unwrap_or(6))
}

fn unsupported(element: Element, message: &str, findings: &mut Findings) {
    findings.of(Fault::Unsupported, element, message);
}

fn read_model(element: Element, version: (u32, u32), model: &mut Model, findings: &mut Findings) {
    let name = element
        .attribute("name")
        .map(|name| name.text.trim().to_owned());
    model.name = name
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| "SDF model".into());
    let mut names: Vec<String> = Vec::new();
    let mut is_static = false;
    for child in element.children() {
        match child.name() {
            "link" => {
                let name = child
                    .attribute("name")
                    .map(|name| name.text.trim().to_owned());
                let Some(name) = name else {
                    findings.missing(child, "a `name`");
                    continue;
                };
                if names.contains(&name) && names.len() < 5000 {
                    let message = format!("the link `{name}` is defined twice");
                    findings.of(Fault::Twice, child, message);
                }
                names.push(name);
            }
            "static" => is_static = findings.boolean(&child.text()).unwrap_or(false),
            "model" => unsupported(child, "models within models are not supported", findings),
            "include" => unsupported(
                child,
                "`<include>` is not supported: put the model into the file",
                findings,
            ),
            _ => {}
        }
    }
    if is_static {
        return findings.of(
            Fault::Structure,
            element,
            "the model is static, so no body moves",
        );
    }
    let frames = Frames::read(element, &names, findings);
    for (child, name) in element
        .children()
        .filter(|child| child.name() == "link")
        .zip(&names)
    {
        let pose = frames.pose(name).unwrap_or_default();
        let (mass, held_weight) = link(child, name, &frames, findings).unwrap_or_default();
        model.links.push(Link {
            name: name.clone(),
            pose,
            mass,
            held_weight,
        });
    }
    let mut scope = Scope {
        links: names
            .iter()
            .enumerate()
            .map(|(k, name)| (name.as_str(), Some(k)))
            .collect(),
        frames,
        in_model: version < (1, 5),
    };
    for (name, link, pose) in scope.frames.places(&model.links) {
        model.frames.push(Frame { name, link, pose });
    }
    let mut seen = std::collections::HashSet::new();
    for child in element.children().filter(|child| child.name() == "joint") {
        if let Some(name) = child.attribute("name")
            && !seen.insert(name.text)
        {
            let message = format!("the joint `{}` is defined twice", name.text);
            findings.of(Fault::Twice, child, message);
        }
        joint(child, &scope, model, findings);
    }
    for child in element.children().filter(|child| child.name() == "plugin") {
        extensions::plugin(child, &scope, model, "plugins", findings);
    }
    scope.links.clear();
    for child in element.children().filter(|child| child.name() == "joint") {
        mimic(child, model, findings);
    }
    find_tree(model);
}

/// Returns the mass of a link, and the compensated share of the weight.
fn link(
    element: Element,
    name: &str,
    frames: &Frames,
    findings: &mut Findings,
) -> Option<(Mass, f64)> {
    let mut held = 0.0;
    for child in element.children() {
        match child.name() {
            "collision" => findings.leave_element("contacts of links", child, name),
            "gravity" => {
                let falls = findings.boolean(&child.text()).unwrap_or(true);
                held = if falls { 0.0 } else { 1.0 };
            }
            _ => {}
        }
    }
    Some((inertial::mass_of(element, name, frames, findings)?, held))
}

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
    let links = links_of(element, name, scope, findings)?;
    let in_second = match scope.frames.pose_of_joint(name) {
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
    let mut joint = joint_between(model, name, found, links, in_second, first.direction);
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
    let Some(pose) = scope
        .frames
        .pose(frame)
        .filter(|_| !scope.links.contains_key(frame))
    else {
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
            let Some(pose) = scope.frames.pose(value.text.trim()) else {
                let message = format!("{}: there is no frame `{}`", value.subject, value.text);
                findings.at(Fault::Unknown, &value, message);
                return None;
            };
            second.inverse() * (pose.rotation * given)
        }
        None if of_model => second.inverse() * (scope.frames.model().rotation * given),
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
fn mimic(element: Element, model: &mut Model, findings: &mut Findings) {
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
        let find = |name: &str| {
            model
                .joints
                .iter()
                .position(|joint| joint.name == name.trim())
        };
        let led = usize::from(
            mimic
                .attribute("axis")
                .is_some_and(|axis| axis.text == "axis2"),
        );
        let (Some(y), Some(x)) = (find(name.text), find(other.text)) else {
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
            name: format!("{} follows {}", name.text.trim(), other.text.trim()),
            x: Some((x, led)),
            y: (y, coordinate),
            coefficients: vec![offset - multiplier * reference, multiplier],
            is_active: true,
        });
    }
}
