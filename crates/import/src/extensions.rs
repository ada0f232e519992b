//! Elements of other programs that change the mechanism: constraints of Drake, joints that close
//! loops in a URDF, and plugins of Gazebo. They are read, or they are refused by name.

use nalgebra::{Isometry3, Vector3};

use crate::changing::{advice, refuse};
use crate::findings::{Fault, Findings, NumberKind};
use crate::mechanism::{Joint, JointKind, Model};
use crate::sdf::Scope;
use crate::solids::joint_between;
use crate::xml::Element;

/// Reads `<loop_joint>`, whose joint has a frame on each of two links.
pub(crate) fn loop_joint(
    element: Element,
    scope: &Scope,
    model: &mut Model,
    origin: impl Fn(Element, &mut Findings) -> Option<Isometry3<f64>>,
    findings: &mut Findings,
) -> Option<()> {
    let name = findings.needed(element, "name")?;
    let word = findings.needed(element, "type")?;
    let kind = match word.text.trim() {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Translational,
        "spherical" | "ball" => JointKind::Spherical,
        "cylindrical" => JointKind::Cylindrical,
        "planar" => JointKind::Planar,
        "fixed" => JointKind::Fixed,
        other => {
            let shown: String = other.chars().take(40).collect();
            let message = format!("a loop joint has no type `{shown}`");
            findings.at(Fault::Value, &word, message);
            return None;
        }
    };
    let mut ends = [None; 2];
    let mut frames = [Isometry3::identity(); 2];
    for (k, key) in ["link1", "link2"].into_iter().enumerate() {
        let Some(end) = element.child(key) else {
            findings.missing(element, &format!("a `<{key}>`"));
            return None;
        };
        ends[k] = scope.link(&findings.needed(end, "link")?, findings)?;
        frames[k] = origin(end, findings)?;
    }
    let axis = match element.child("axis") {
        Some(axis) => {
            let direction = findings.needed(axis, "xyz")?;
            findings.direction(&direction)?
        }
        None => Vector3::x(),
    };
    let points = frames.map(|frame| frame.translation.vector);
    let axes = frames.map(|frame| frame.rotation * axis);
    let mut joint = Joint::new(name.text.trim(), kind, ends, points, axes);
    joint.frames = Some(frames.map(|frame| frame.rotation));
    closing(joint, element, model, findings)
}

/// Reads `<drake:ball_constraint>`: two points that coincide.
pub(crate) fn ball_constraint(
    element: Element,
    scope: &Scope,
    model: &mut Model,
    findings: &mut Findings,
) -> Option<()> {
    let part = |key: &str, attribute: &str, findings: &mut Findings| {
        let name = format!("ball_constraint_{key}");
        let mut parts = element.foreign_children();
        let found = parts.find(|part| part.name() == name);
        if found.is_none() {
            findings.missing(element, &format!("a `<drake:{name}>`"));
        }
        findings.needed(found?, attribute)
    };
    let mut ends = [None; 2];
    let mut points = [Vector3::zeros(); 2];
    for (k, (body, point)) in [("body_A", "p_AP"), ("body_B", "p_BQ")]
        .into_iter()
        .enumerate()
    {
        ends[k] = scope.link(&part(body, "name", findings)?, findings)?;
        let point = part(point, "value", findings)?;
        points[k] = findings.vector(&point, NumberKind::Length)?;
    }
    let count = model.joints.iter().filter(|joint| !joint.places).count();
    let name = format!("ball_constraint_{}", count + 1);
    let joint = Joint::new(name, JointKind::Spherical, ends, points, [Vector3::z(); 2]);
    closing(joint, element, model, findings)
}

/// Reads a plugin of Gazebo that changes the mechanism. Other plugins are left out as `kind`.
pub(crate) fn plugin(
    element: Element,
    scope: &Scope,
    model: &mut Model,
    kind: &'static str,
    findings: &mut Findings,
) {
    let names = ["name", "filename"].map(|key| element.attribute(key));
    let names = names.map(|name| name.map_or("", |name| name.text.trim()));
    let is_detachable = names
        .iter()
        .any(|name| name.contains("DetachableJoint") || name.contains("detachable-joint"));
    let shown: String = names[0].chars().take(60).collect();
    let subject = format!("<plugin> `{shown}`");
    if is_detachable {
        // Missing or wrong content has already been reported.
        let _ = detachable(element, scope, model, findings);
    } else if let Some((name, advice)) = names.iter().find_map(|name| Some((name, advice(name)?))) {
        let shown: String = name.chars().take(60).collect();
        refuse(element, &format!("the plugin `{shown}`"), advice, findings);
    } else {
        findings.leave_element(kind, element, &subject);
        let letters = names.concat().to_lowercase();
        let letters: String = letters
            .chars()
            .filter(char::is_ascii_alphanumeric)
            .collect();
        if CONTROLLERS.iter().any(|known| letters.contains(known)) {
            controller(element, &letters, scope, model, findings);
        }
    }
}

/// Plugins of Gazebo that act on joints, as letters of their names.
const CONTROLLERS: [&str; 7] = [
    "jointcontroller",
    "jointpositioncontroller",
    TRAJECTORY,
    "applyjointforce",
    "diffdrive",
    "ackermannsteering",
    "mecanumdrive",
];

/// A controller that acts on all joints of its model if it names no joints.
const TRAJECTORY: &str = "jointtrajectorycontroller";

/// Records the joints of a controller as actuated.
fn controller(
    element: Element,
    letters: &str,
    scope: &Scope,
    model: &mut Model,
    findings: &Findings,
) {
    let is_joint =
        |child: &Element| child.name().ends_with("joint") || child.name() == "joint_name";
    let named = element.children().filter(is_joint);
    let mut joints: Vec<usize> = named
        .filter_map(|child| scope.number_of(child.text().text))
        .collect();
    if joints.is_empty() && letters.contains(TRAJECTORY) {
        joints = scope.joints();
        joints.retain(|&joint| model.joints[joint].kind.measures().len() == 1);
    }
    let is_plain = false;
    for joint in joints {
        model.actuate("", (joint, 0), is_plain, findings);
    }
}

/// The plugin `DetachableJoint` of Gazebo: two links are fixed to each other in their described
/// pose, until a message at run time detaches them.
fn detachable(
    element: Element,
    scope: &Scope,
    model: &mut Model,
    findings: &mut Findings,
) -> Option<()> {
    let part = |key: &str, findings: &mut Findings| {
        let found = element.text_of(key);
        if found.is_none() {
            findings.missing(element, &format!("a `<{key}>`"));
        }
        found
    };
    let other = part("child_model", findings)?;
    let ends = ["parent_link", "child_link"].map(|key| part(key, findings));
    let [Some(parent), Some(child)] = ends else {
        return None;
    };
    let links = [
        scope.link(&parent, findings)?,
        scope.link_of_model(&other, &child, findings)?,
    ];
    let name = format!("{} holds {}", parent.text.trim(), child.text.trim());
    let here = Isometry3::identity();
    let joint = joint_between(model, &name, JointKind::Fixed, links, here, Vector3::z());
    findings.remarks.push(format!(
        "The detachable joint between `{}` and `{}` is attached.",
        parent.text.trim(),
        child.text.trim()
    ));
    closing(joint, element, model, findings)
}

/// Adds a joint that closes a loop.
fn closing(
    mut joint: Joint,
    element: Element,
    model: &mut Model,
    findings: &mut Findings,
) -> Option<()> {
    if joint.links[0] == joint.links[1] {
        let message = format!("joint `{}` connects a link with itself", joint.name);
        findings.of(Fault::Structure, element, message);
        return None;
    }
    joint.places = false;
    model.joints.push(joint);
    Some(())
}
