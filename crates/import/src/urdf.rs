//! URDF, the format of ROS: <https://wiki.ros.org/urdf/XML>, with loop joints in `<gazebo>`.

mod names;

use std::collections::HashMap;

use nalgebra::{Isometry3, Vector3};

use crate::changing::refuse_second;
use crate::extensions;
use crate::findings::{Fault, Findings, NumberKind};
use crate::loops;
use crate::mass::Mass;
use crate::mechanism::{Coupling, Joint, JointKind, Link, Load, Model};
use crate::options::Base;
use crate::pose::quaternion;
use crate::sdf;
use crate::solids::{FRICTION, assume_gravity, roll_pitch_yaw, tensor};
use crate::xml::Element;
pub(crate) use names::NAMES;

/// Elements of a joint that change the mechanism, and that a joint contains once.
const IN_JOINT: [&str; 6] = ["origin", "parent", "child", "axis", "mimic", "dynamics"];

/// The program that reads only the first of two elements.
const READER: &str = "ROS uses";

/// A joint of the file.
struct Edge<'a> {
    element: Element<'a>,
    name: String,
    parent: usize,
    child: usize,
    origin: Isometry3<f64>,
}

/// Reads a model.
pub(crate) fn read(root: Element, base: Base, findings: &mut Findings) -> Model {
    let mut model = Model::default();
    let name = root
        .attribute("name")
        .map(|name| name.text.trim().to_owned());
    model.name = name
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| "URDF robot".into());
    let names = links(root, &mut model, findings);
    let edges = edges(root, &names, findings);
    // If joints cannot be read, links have no position. The missing position is not reported as a
    // separate fault.
    if findings.has_problems() || !place(root, &edges, base, &mut model, findings) {
        return model;
    }
    let mut numbers = HashMap::new();
    for edge in &edges {
        if let Some(joint) = joint(edge, findings) {
            numbers.insert(edge.name.clone(), model.joints.len());
            model.joints.push(joint);
        }
    }
    for edge in &edges {
        if let Some(mimic) = edge.element.child("mimic") {
            let coupling = coupling(edge, mimic, &numbers, &model, findings);
            model.couplings.extend(coupling);
        }
    }
    let frames = sdf::Frames::of_links(&names);
    let own = model.name.clone();
    let scope = sdf::Scope::of_links(&frames, &own, &numbers);
    for child in root.children() {
        match child.name() {
            "gazebo" => gazebo(child, &scope, &mut model, findings),
            "loop_joint" => {
                let kinds = [NumberKind::Length, NumberKind::Direction];
                let frame = |end: Element, findings: &mut Findings| frame(end, kinds, findings);
                // Missing or wrong content has already been reported.
                let _ = extensions::loop_joint(child, &scope, &mut model, frame, findings);
            }
            "transmission" => transmission(child, &scope, &mut model, findings),
            "ros2_control" => control(child, &scope, &mut model, findings),
            _ => {}
        }
    }
    for child in root.foreign_children() {
        if (child.prefix(), child.name()) == (Some("drake"), "ball_constraint") {
            let _ = extensions::ball_constraint(child, &scope, &mut model, findings);
        }
    }
    assume_gravity(&mut model, findings);
    model
}

/// `<origin xyz rpy>` of an element.
fn origin(
    element: Element,
    counted: [NumberKind; 2],
    findings: &mut Findings,
) -> Option<Isometry3<f64>> {
    match element.child("origin") {
        Some(origin) => frame(origin, counted, findings),
        None => Some(Isometry3::identity()),
    }
}

/// The attributes `xyz` and `rpy` of an element.
fn frame(
    origin: Element,
    counted: [NumberKind; 2],
    findings: &mut Findings,
) -> Option<Isometry3<f64>> {
    let [length, angle] = counted;
    let at = match origin.attribute("xyz") {
        Some(value) => findings.vector(&value, length)?,
        None => Vector3::zeros(),
    };
    if let Some(value) = origin.attribute("quat_xyzw") {
        let n = findings.numbers(&value, [4, 4], angle)?;
        if n.iter().all(|x| *x == 0.0) {
            let message = "a quaternion of zeros does not define an orientation";
            findings.at(Fault::Range, &value, message);
            return None;
        }
        let turned = quaternion([n[3], n[0], n[1], n[2]]);
        return Some(Isometry3::from_parts(at.into(), turned));
    }
    let turned = match origin.attribute("rpy") {
        Some(value) => {
            let turned = findings.vector(&value, angle)?;
            findings.look_for_degrees(&value, turned.as_slice());
            turned
        }
        None => Vector3::zeros(),
    };
    Some(Isometry3::from_parts(
        at.into(),
        roll_pitch_yaw(turned.into()),
    ))
}

fn links(root: Element, model: &mut Model, findings: &mut Findings) -> HashMap<String, usize> {
    let mut names = HashMap::new();
    for element in root.children().filter(|child| child.name() == "link") {
        let Some(name) = findings.needed(element, "name") else {
            continue;
        };
        let name = name.text.trim().to_owned();
        if names.insert(name.clone(), model.links.len()).is_some() {
            let message = format!("the link `{name}` is defined twice");
            findings.of(Fault::Twice, element, message);
        }
        for child in element.children().filter(|c| c.name() == "collision") {
            findings.leave_element("contacts of links", child, &name);
        }
        refuse_second(element, &["inertial"], READER, findings);
        let mass = match element.child("inertial") {
            Some(inertial) => mass_of(inertial, findings).unwrap_or_default(),
            None => Mass::default(),
        };
        model.links.push(Link {
            name,
            pose: Isometry3::identity(),
            mass,
            held: Vec::new(),
        });
    }
    names
}

fn mass_of(inertial: Element, findings: &mut Findings) -> Option<Mass> {
    refuse_second(inertial, &["origin", "mass", "inertia"], READER, findings);
    let pose = origin(inertial, [NumberKind::Other; 2], findings)?;
    let Some(mass) = inertial.child("mass") else {
        findings.missing(inertial, "a `<mass>`");
        return None;
    };
    let mass = findings.needed(mass, "value")?;
    let mass = findings.not_negative(&mass, NumberKind::Other)?;
    let Some(inertia) = inertial.child("inertia") else {
        findings.missing(inertial, "an `<inertia>`");
        return None;
    };
    let mut numbers = [0.0; 6];
    for (number, key) in numbers
        .iter_mut()
        .zip(["ixx", "iyy", "izz", "ixy", "ixz", "iyz"])
    {
        let value = findings.needed(inertia, key)?;
        *number = findings.number(&value, NumberKind::Other)?;
    }
    Some(Mass::turned(
        mass,
        pose.translation.vector,
        pose.rotation,
        tensor(numbers),
    ))
}

fn edges<'a>(
    root: Element<'a>,
    names: &HashMap<String, usize>,
    findings: &mut Findings,
) -> Vec<Edge<'a>> {
    let mut edges: Vec<Edge> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for element in root.children().filter(|child| child.name() == "joint") {
        let Some(name) = findings.needed(element, "name") else {
            continue;
        };
        let name = name.text.trim().to_owned();
        if !seen.insert(name.clone()) {
            let message = format!("the joint `{name}` is defined twice");
            findings.of(Fault::Twice, element, message);
        }
        refuse_second(element, &IN_JOINT, READER, findings);
        let mut end = |key: &str| {
            let Some(child) = element.child(key) else {
                findings.missing(element, &format!("a `<{key}>`"));
                return None;
            };
            let link = findings.needed(child, "link")?;
            let found = names.get(link.text.trim()).copied();
            if found.is_none() {
                let message = format!("joint `{name}`: there is no link `{}`", link.text);
                findings.at(Fault::Unknown, &link, message);
            }
            found
        };
        let (parent, child) = (end("parent"), end("child"));
        let origin = origin(
            element,
            [NumberKind::Length, NumberKind::Direction],
            findings,
        );
        if let (Some(parent), Some(child), Some(origin)) = (parent, child, origin) {
            edges.push(Edge {
                element,
                name,
                parent,
                child,
                origin,
            });
        }
    }
    edges
}

/// Computes the poses of all links, starting at the root. Returns whether the links form a tree.
fn place(
    root: Element,
    edges: &[Edge],
    base: Base,
    model: &mut Model,
    findings: &mut Findings,
) -> bool {
    let mut before = vec![None; model.links.len()];
    let mut behind: Vec<Vec<usize>> = vec![Vec::new(); model.links.len()];
    for (k, edge) in edges.iter().enumerate() {
        if before[edge.child].replace(k).is_some() {
            let link = &model.links[edge.child].name;
            let message = format!("the link `{link}` is the child of two joints");
            let help = "URDF is a tree: give loops as joints in <gazebo>, or with --loops";
            let (source, span) = (edge.element.source, edge.element.span());
            let help = help.to_owned();
            findings.fault_with_help(Fault::Structure, source, span, message, "", help);
            return false;
        }
        behind[edge.parent].push(k);
    }
    if let Some(cycle) = cycle(edges, &before) {
        let names: Vec<String> = cycle
            .iter()
            .map(|&k| format!("`{}`", edges[k].name))
            .collect();
        let message = match names.as_slice() {
            [one] => format!("joint {one} connects a link with itself"),
            _ => format!(
                "{} form a cycle: none of their links is the root",
                names.join(", ")
            ),
        };
        let help = "URDF is a tree: give loops as joints in <gazebo>, or with --loops".to_owned();
        let element = edges[cycle[0]].element;
        let (source, span) = (element.source, element.span());
        findings.fault_with_help(Fault::Structure, source, span, message, "", help);
        return false;
    }
    let roots: Vec<usize> = (0..before.len()).filter(|&k| before[k].is_none()).collect();
    let &[first] = roots.as_slice() else {
        if !model.links.is_empty() {
            let names: Vec<String> = roots
                .iter()
                .take(10)
                .map(|&k| format!("`{}`", model.links[k].name))
                .collect();
            let message = format!(
                "exactly one link must be the root, found {}: {}",
                roots.len(),
                names.join(", ")
            );
            findings.of(Fault::Structure, root, message);
        }
        return false;
    };
    let mut queue = vec![first];
    while let Some(link) = queue.pop() {
        for &k in &behind[link] {
            let edge = &edges[k];
            model.links[edge.child].pose = model.links[link].pose * edge.origin;
            queue.push(edge.child);
        }
    }
    let own = model.links[first].name.clone();
    if base == Base::Fixed || own == "world" {
        let zero = [Vector3::zeros(); 2];
        let joint = Joint::new(
            own.clone(),
            JointKind::Fixed,
            [None, Some(first)],
            zero,
            [Vector3::z(); 2],
        );
        model.joints.push(joint);
        if own != "world" {
            findings.remarks.push(format!(
                "The root link `{own}` is fixed to the ground; --base free leaves it free."
            ));
        }
    } else {
        findings
            .remarks
            .push(format!("The root link `{own}` is free."));
    }
    true
}

/// Returns a cycle of joints, in which the child of each joint is the parent of the next joint.
/// `before` contains, for each link, the joint whose child is this link.
fn cycle(edges: &[Edge], before: &[Option<usize>]) -> Option<Vec<usize>> {
    let mut seen = vec![usize::MAX; before.len()];
    for first in 0..before.len() {
        let mut at = first;
        while seen[at] == usize::MAX {
            seen[at] = first;
            let Some(joint) = before[at] else { break };
            at = edges[joint].parent;
        }
        let Some(joint) = before[at].filter(|_| seen[at] == first) else {
            continue;
        };
        let mut cycle = vec![joint];
        let mut link = edges[joint].parent;
        while link != at {
            let joint = before[link]?;
            cycle.push(joint);
            link = edges[joint].parent;
        }
        cycle.sort_unstable();
        return Some(cycle);
    }
    None
}

fn joint(edge: &Edge, findings: &mut Findings) -> Option<Joint> {
    let Edge { element, name, .. } = edge;
    let element = *element;
    let word = findings.needed(element, "type")?;
    let kind = match word.text.trim() {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Translational,
        "fixed" => JointKind::Fixed,
        "floating" => JointKind::Free,
        "planar" => JointKind::Planar,
        other => {
            let shown: String = other.chars().take(40).collect();
            let message = format!("joint `{name}`: there is no type `{shown}`");
            findings.at(Fault::Value, &word, message);
            return None;
        }
    };
    let has_axis = matches!(
        kind,
        JointKind::Revolute | JointKind::Translational | JointKind::Planar
    );
    let axis = match element.child("axis").filter(|_| has_axis) {
        Some(axis) => {
            let value = findings.needed(axis, "xyz")?;
            findings.direction(&value)?
        }
        None => Vector3::x(),
    };
    let mut load = Load::default();
    for child in element.children() {
        let mut leave = |kind| findings.leave_element(kind, child, name);
        match child.name() {
            "limit" if word.text.trim() == "continuous" || !has_axis => {}
            "limit" => leave("limits of joints"),
            "dynamics" => {
                if let Some(value) = child.attribute("damping") {
                    load.damping = findings.not_negative(&value, NumberKind::Other)?;
                }
                let friction = child.attribute("friction");
                if friction.is_some_and(|value| value.text.trim().parse() != Ok(0.0)) {
                    findings.leave_element(FRICTION, child, name);
                }
            }
            _ => {}
        }
    }
    if load.damping != 0.0 && !matches!(kind, JointKind::Revolute | JointKind::Translational) {
        findings.leave_element("dampers of joints without one axis", element, name);
        load = Load::default();
    }
    let points = [edge.origin.translation.vector, Vector3::zeros()];
    let axes = [edge.origin.rotation * axis, axis];
    let links = [Some(edge.parent), Some(edge.child)];
    let mut joint = Joint::new(name.clone(), kind, links, points, axes);
    joint.loads[0] = load;
    Some(joint)
}

fn coupling(
    edge: &Edge,
    mimic: Element,
    numbers: &HashMap<String, usize>,
    model: &Model,
    findings: &mut Findings,
) -> Option<Coupling> {
    let name = findings.needed(mimic, "joint")?;
    let mut number = |key: &str, default: f64| match mimic.attribute(key) {
        Some(value) => findings.number(&value, NumberKind::Other),
        None => Some(default),
    };
    let coefficients = vec![number("offset", 0.0)?, number("multiplier", 1.0)?];
    let ends = [edge.name.as_str(), name.text.trim()].map(|name| numbers.get(name).copied());
    let [Some(y), Some(x)] = ends else {
        let message = format!(
            "joint `{}` follows `{}`, which does not exist",
            edge.name, name.text
        );
        findings.at(Fault::Unknown, &name, message);
        return None;
    };
    if model.joints[y].kind == JointKind::Fixed {
        findings.remarks.push(format!(
            "Joint `{}` is fixed, so it does not follow `{}`.",
            edge.name, name.text
        ));
        return None;
    }
    let has = |joint: usize| !model.joints[joint].kind.measures().is_empty();
    if x == y || !has(x) || !has(y) {
        let message = format!("joint `{}` cannot follow `{}`", edge.name, name.text);
        findings.at(Fault::Structure, &name, message);
        return None;
    }
    Some(Coupling {
        name: format!("{} follows {}", edge.name, name.text.trim()),
        x: Some((x, 0)),
        y: (y, 0),
        coefficients,
        is_active: true,
    })
}

/// Kind of omission for actuators.
const ACTUATORS: &str = "actuators";

/// Leaves out a `<transmission>`, and records its actuators.
fn transmission(element: Element, scope: &sdf::Scope, model: &mut Model, findings: &mut Findings) {
    let name = element.attribute("name").map_or("", |name| name.text);
    findings.leave_element(ACTUATORS, element, name);
    let joints: Vec<_> = element
        .children()
        .filter(|child| child.name() == "joint")
        .collect();
    let actuator = element.child("actuator").filter(|_| joints.len() == 1);
    let name = actuator.and_then(|actuator| actuator.attribute("name"));
    let name = name.map_or("", |name| name.text);
    let reductions = [Some(element), actuator].into_iter().flatten();
    let mut reductions = reductions.filter_map(|of| of.text_of("mechanicalReduction"));
    let is_plain = reductions.all(|value| value.text.parse() == Ok(1.0));
    for joint in joints {
        actuate(joint, (name, is_plain), scope, model, findings);
    }
}

/// Leaves out a `<ros2_control>`, and records the joints that it commands.
fn control(element: Element, scope: &sdf::Scope, model: &mut Model, findings: &mut Findings) {
    let name = element.attribute("name").map_or("", |name| name.text);
    findings.leave_element(ACTUATORS, element, &format!("<ros2_control> `{name}`"));
    let joints = element.children().filter(|child| child.name() == "joint");
    for joint in joints.filter(|joint| joint.child("command_interface").is_some()) {
        actuate(joint, ("", false), scope, model, findings);
    }
}

/// Records an actuator with its name, and whether it is only a force.
fn actuate(
    joint: Element,
    (name, is_plain): (&str, bool),
    scope: &sdf::Scope,
    model: &mut Model,
    findings: &Findings,
) {
    let of = joint.attribute("name").map_or("", |name| name.text);
    if let Some(number) = scope.number_of(of) {
        model.actuate(name, (number, 0), is_plain, findings);
    }
}

/// Kind of omission for content of `<gazebo>`.
const GAZEBO: &str = "settings and plugins of Gazebo";

/// Joints that close loops, written as in SDF; settings of a simulator are omitted.
fn gazebo(element: Element, scope: &sdf::Scope, model: &mut Model, findings: &mut Findings) {
    for child in element.children() {
        if child.name() == "joint" {
            crate::vocabulary::check(child, sdf::NAMES, None, findings);
            let first = model.joints.len();
            sdf::joint(child, scope, model, findings);
            for joint in &mut model.joints[first..] {
                joint.places = false;
            }
        } else if child.name() == "plugin" {
            extensions::plugin(child, scope, model, GAZEBO, findings);
        } else {
            let subject = match element.attribute("reference") {
                Some(link) => format!("<{}> of `{}`", child.name(), link.text),
                None => format!("<{}>", child.name()),
            };
            findings.leave_element(GAZEBO, child, &subject);
        }
    }
}

/// Adds the closures of a file of loops.
pub(crate) fn close_loops(model: &mut Model, text: &scene::SourceText, findings: &mut Findings) {
    // In the file of loops, the name of a joint refers to the link whose position the joint
    // determines.
    let joints = model
        .joints
        .iter()
        .filter_map(|j| Some((j.name.clone(), j.links[1]?)));
    let mut names: HashMap<String, usize> = joints.collect();
    let links = model.links.iter().enumerate();
    names.extend(links.map(|(k, link)| (link.name.clone(), k)));
    loops::read(model, &names, text, findings);
}
