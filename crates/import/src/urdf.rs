//! URDF, the format of ROS: <https://wiki.ros.org/urdf/XML>, with loop joints in `<gazebo>`.

use std::collections::HashMap;

use nalgebra::{Isometry3, Vector3};

use crate::findings::{Counted, Fault, Findings};
use crate::mass::Mass;
use crate::mechanism::{Coupling, Joint, Kind, Link, Load, Model};
use crate::sdf;
use crate::solids::{assume_gravity, roll_pitch_yaw, tensor};
use crate::xml::{Element, Value};
use crate::{Base, loops};

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
    if !place(root, &edges, base, &mut model, findings) {
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
    for child in root.children() {
        match child.name() {
            "link" | "joint" | "material" => {}
            "gazebo" => gazebo(child, &names, &mut model, findings),
            "transmission" => {
                let name = child.attribute("name").map_or("", |name| name.text);
                findings.leave_element("actuators", child, name);
            }
            other => {
                let subject = format!("<{other}>");
                findings.leave_element("elements that are not understood", child, &subject);
            }
        }
    }
    assume_gravity(&mut model, findings);
    model
}

fn attribute<'a>(element: Element<'a>, key: &str, findings: &mut Findings) -> Option<Value<'a>> {
    let value = element.attribute(key);
    if value.is_none() {
        findings.missing(element, &format!("`{key}`"));
    }
    value
}

/// `<origin xyz rpy>` of an element.
fn origin(
    element: Element,
    counted: [Counted; 2],
    findings: &mut Findings,
) -> Option<Isometry3<f64>> {
    let Some(origin) = element.child("origin") else {
        return Some(Isometry3::identity());
    };
    let [length, angle] = counted;
    let at = match origin.attribute("xyz") {
        Some(value) => findings.vector(&value, length)?,
        None => Vector3::zeros(),
    };
    let turned = match origin.attribute("rpy") {
        Some(value) => findings.vector(&value, angle)?,
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
        let Some(name) = attribute(element, "name", findings) else {
            continue;
        };
        let name = name.text.trim().to_owned();
        if names.insert(name.clone(), model.links.len()).is_some() {
            let message = format!("the link `{name}` is there already");
            findings.of(Fault::Twice, element, message);
        }
        for child in element.children() {
            match child.name() {
                "inertial" | "visual" => {}
                "collision" => findings.leave_element("contacts of links", child, &name),
                other => {
                    let subject = format!("<{other}> of `{name}`");
                    findings.leave_element("elements that are not understood", child, &subject);
                }
            }
        }
        let mass = match element.child("inertial") {
            Some(inertial) => mass_of(inertial, findings).unwrap_or_default(),
            None => Mass::default(),
        };
        model.links.push(Link {
            name,
            pose: Isometry3::identity(),
            mass,
            held_weight: 0.0,
        });
    }
    names
}

fn mass_of(inertial: Element, findings: &mut Findings) -> Option<Mass> {
    let pose = origin(inertial, [Counted::Not; 2], findings)?;
    let Some(mass) = inertial.child("mass") else {
        findings.missing(inertial, "a `<mass>`");
        return None;
    };
    let mass = attribute(mass, "value", findings)?;
    let mass = findings.not_negative(&mass, Counted::Not)?;
    let Some(inertia) = inertial.child("inertia") else {
        findings.missing(inertial, "an `<inertia>`");
        return None;
    };
    let mut numbers = [0.0; 6];
    for (number, key) in numbers
        .iter_mut()
        .zip(["ixx", "iyy", "izz", "ixy", "ixz", "iyz"])
    {
        let value = attribute(inertia, key, findings)?;
        *number = findings.number(&value, Counted::Not)?;
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
        let Some(name) = attribute(element, "name", findings) else {
            continue;
        };
        let name = name.text.trim().to_owned();
        if !seen.insert(name.clone()) {
            let message = format!("the joint `{name}` is there already");
            findings.of(Fault::Twice, element, message);
        }
        let mut end = |key: &str| {
            let Some(child) = element.child(key) else {
                findings.missing(element, &format!("a `<{key}>`"));
                return None;
            };
            let link = attribute(child, "link", findings)?;
            let found = names.get(link.text.trim()).copied();
            if found.is_none() {
                let message = format!("joint `{name}`: there is no link `{}`", link.text);
                findings.at(Fault::Unknown, &link, message);
            }
            found
        };
        let (parent, child) = (end("parent"), end("child"));
        let origin = origin(element, [Counted::Length, Counted::Direction], findings);
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

/// Places all links from the root on. Returns whether they form a tree.
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
    let roots: Vec<usize> = (0..before.len()).filter(|&k| before[k].is_none()).collect();
    let &[first] = roots.as_slice() else {
        if !model.links.is_empty() {
            let names: Vec<String> = roots
                .iter()
                .take(10)
                .map(|&k| format!("`{}`", model.links[k].name))
                .collect();
            let message = format!(
                "one link has to be the root, found {}: {}",
                roots.len(),
                names.join(", ")
            );
            findings.of(Fault::Structure, root, message);
        }
        return false;
    };
    let (mut queue, mut count) = (vec![first], 0);
    while let Some(link) = queue.pop() {
        count += 1;
        for &k in &behind[link] {
            let edge = &edges[k];
            model.links[edge.child].pose = model.links[link].pose * edge.origin;
            queue.push(edge.child);
        }
    }
    if count < model.links.len() {
        findings.of(
            Fault::Structure,
            root,
            "some links are parents of themselves",
        );
        return false;
    }
    let own = model.links[first].name.clone();
    if base == Base::Fixed || own == "world" {
        let zero = [Vector3::zeros(); 2];
        let joint = Joint::new(
            own.clone(),
            Kind::Fixed,
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

fn joint(edge: &Edge, findings: &mut Findings) -> Option<Joint> {
    let Edge { element, name, .. } = edge;
    let element = *element;
    let word = attribute(element, "type", findings)?;
    let kind = match word.text.trim() {
        "revolute" | "continuous" => Kind::Revolute,
        "prismatic" => Kind::Translational,
        "fixed" => Kind::Fixed,
        "floating" => Kind::Free,
        "planar" => Kind::Planar,
        other => {
            let shown: String = other.chars().take(40).collect();
            let message = format!("joint `{name}`: there is no type `{shown}`");
            findings.at(Fault::Value, &word, message);
            return None;
        }
    };
    let has_axis = matches!(kind, Kind::Revolute | Kind::Translational | Kind::Planar);
    let axis = match element.child("axis").filter(|_| has_axis) {
        Some(axis) => {
            let value = attribute(axis, "xyz", findings)?;
            findings.direction(&value)?
        }
        None => Vector3::x(),
    };
    let mut load = Load::default();
    for child in element.children() {
        let mut leave = |kind| findings.leave_element(kind, child, name);
        match child.name() {
            "origin" | "parent" | "child" | "axis" | "mimic" => {}
            "limit" if word.text.trim() == "continuous" || !has_axis => {}
            "limit" => leave("limits of joints"),
            "safety_controller" | "calibration" => leave("controllers and calibrations"),
            "dynamics" => {
                if let Some(value) = child.attribute("damping") {
                    load.damping = findings.not_negative(&value, Counted::Not)?;
                }
                let friction = child.attribute("friction");
                if friction.is_some_and(|value| value.text.trim().parse() != Ok(0.0)) {
                    findings.leave_element("friction of joints", child, name);
                }
            }
            other => {
                let subject = format!("<{other}> of `{name}`");
                findings.leave_element("elements that are not understood", child, &subject);
            }
        }
    }
    if load.damping != 0.0 && !matches!(kind, Kind::Revolute | Kind::Translational) {
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
    let name = attribute(mimic, "joint", findings)?;
    let mut number = |key: &str, default: f64| match mimic.attribute(key) {
        Some(value) => findings.number(&value, Counted::Not),
        None => Some(default),
    };
    let coefficients = vec![number("offset", 0.0)?, number("multiplier", 1.0)?];
    let ends = [edge.name.as_str(), name.text.trim()].map(|name| numbers.get(name).copied());
    let [Some(y), Some(x)] = ends else {
        let message = format!(
            "joint `{}` follows `{}`, which is not there",
            edge.name, name.text
        );
        findings.at(Fault::Unknown, &name, message);
        return None;
    };
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

/// Joints that close loops, in the words of SDF; settings of a simulator are left out.
fn gazebo(
    element: Element,
    names: &HashMap<String, usize>,
    model: &mut Model,
    findings: &mut Findings,
) {
    for child in element.children() {
        if child.name() == "joint" {
            let first = model.joints.len();
            let scope = sdf::Scope::of_links(names);
            sdf::joint(child, &scope, model, findings);
            for joint in &mut model.joints[first..] {
                joint.places = false;
            }
        } else {
            let subject = match element.attribute("reference") {
                Some(link) => format!("{} of `{}`", child.name(), link.text),
                None => child.name().to_owned(),
            };
            findings.leave_element("settings and plugins of Gazebo", child, &subject);
        }
    }
}

/// Adds the closures of a file of loops.
pub(crate) fn close_loops(model: &mut Model, text: &scene::SourceText, findings: &mut Findings) {
    // A joint stands for the link that it places.
    let joints = model
        .joints
        .iter()
        .filter_map(|j| Some((j.name.clone(), j.links[1]?)));
    let mut names: HashMap<String, usize> = joints.collect();
    let links = model.links.iter().enumerate();
    names.extend(links.map(|(k, link)| (link.name.clone(), k)));
    loops::read(model, &names, text, findings);
}
