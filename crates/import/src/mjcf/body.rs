//! `<worldbody>`, `<body>`, `<joint>`, `<site>`.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::geom::Geoms;
use super::reader::Reader;
use super::source::Item;
use crate::findings::{Fault, Findings, NumberKind, unit};
use crate::limits::{DEEPEST, PERPENDICULAR};
use crate::mass::Mass;
use crate::mechanism::{Frame, HeldWeight, Joint, JointKind, Link, Load};
use crate::solids::FRICTION;
use crate::xml::{Element, Value};

/// A joint of the file, in the axes of its body.
struct MjcfJoint {
    name: String,
    kind: JointKind,
    point: Vector3<f64>,
    axis: Vector3<f64>,
    zero: f64,
    load: Load,
}

/// Data of a joint in the file.
struct GivenJoint<'a> {
    element: Element<'a>,
    kind: Option<Value<'a>>,
    /// `ref`, `springref` and `range`.
    coordinates: [Option<Value<'a>>; 3],
    /// `stiffness`, `damping` and `armature`.
    loads: [Option<Value<'a>>; 3],
    limited: Option<Value<'a>>,
    friction: Option<Value<'a>>,
    tuned: Option<Value<'a>>,
}

impl<'a> Reader<'a, '_> {
    pub(super) fn world(&mut self, section: Element<'a>) {
        let mut items = Vec::new();
        self.source
            .items(section, Isometry3::identity(), 0, &mut items, 0);
        for item in &items {
            match item.element.name() {
                "geom" => self.source.contact_of(item),
                "site" => self.site(item, None),
                _ => {}
            }
        }
        for item in items.iter().filter(|item| item.element.name() == "body") {
            self.body_element(item, None, 1);
        }
    }

    fn body_element(&mut self, item: &Item<'a>, parent: Option<usize>, depth: usize) {
        let element = item.element;
        if depth > DEEPEST {
            return self.source.findings.of(
                Fault::Structure,
                element,
                "bodies are nested too deeply",
            );
        }
        let class = match element.attribute("childclass") {
            Some(value) => self.source.class(&value),
            None => item.class,
        };
        let get = |key: &str| element.attribute(key);
        let stated = self.source.compiler.pose(get, self.source.findings);
        let own = item.frame * stated;
        let name = element
            .attribute("name")
            .map(|name| name.text.trim().to_owned());
        let number = self.model.links.len() + 1;
        let name = name
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| format!("body {number}"));
        if element
            .attribute("mocap")
            .is_some_and(|value| value.text.trim() == "true")
        {
            let kind = "motions that a program prescribes (mocap): the body is fixed to the ground";
            self.source.findings.leave_element(kind, element, &name);
        }
        let mut items = Vec::new();
        self.source
            .items(element, Isometry3::identity(), class, &mut items, 0);
        let freedoms: Vec<MjcfJoint> = items
            .iter()
            .filter(|item| matches!(item.element.name(), "joint" | "freejoint"))
            .filter_map(|item| self.freedom(item, &name, parent.is_none()))
            .collect();
        let mass = self.source.mass(element, &stated, &items);
        let held = element.attribute("gravcomp");
        let held = held.and_then(|value| self.source.findings.number(&value, NumberKind::Other));
        let link = self.chain(&name, own, freedoms, parent);
        let kind = self.model.joints.last().map(|joint| joint.kind);
        self.aligned.note(link, (&items, kind), &mut self.source);
        self.model.links[link].mass = mass;
        self.model.links[link].held = HeldWeight::of(held.unwrap_or(0.0), &mass);
        if self.bodies.insert(name.clone(), Some(link)).is_some() {
            let message = format!("the body `{name}` is defined twice");
            self.source.findings.of(Fault::Twice, element, message);
        }
        for item in &items {
            match item.element.name() {
                "site" => self.site(item, Some(link)),
                "geom" => self.source.contact_of(item),
                _ => {}
            }
        }
        for item in items.iter().filter(|item| item.element.name() == "body") {
            self.body_element(item, Some(link), depth + 1);
        }
    }

    /// Adds the links of a body with the joints of the body. There is one link for each joint, or
    /// for each pair of hinges that forms a universal joint. All links except the last link are
    /// massless. Returns the last link.
    fn chain(
        &mut self,
        name: &str,
        own: Isometry3<f64>,
        freedoms: Vec<MjcfJoint>,
        parent: Option<usize>,
    ) -> usize {
        let pose = self.model.pose(parent) * own;
        let mut joints: Vec<(Joint, usize)> = Vec::new();
        let mut at = 0;
        while at < freedoms.len() {
            let first = &freedoms[at];
            let mut joint = Joint::new(
                first.name.clone(),
                first.kind,
                [None, None],
                [first.point; 2],
                [first.axis; 2],
            );
            joint.zero[0] = first.zero;
            joint.loads[0] = first.load;
            let mut consumed = 1;
            if let Some(second) = freedoms.get(at + 1) {
                let pair = match (first.kind, second.kind) {
                    (JointKind::Revolute, JointKind::Revolute)
                        if first.point == second.point
                            && first.axis.dot(&second.axis).abs() <= PERPENDICULAR =>
                    {
                        joint.cross = second.axis;
                        Some(JointKind::Universal)
                    }
                    (JointKind::Translational, JointKind::Revolute)
                        if first.axis == second.axis =>
                    {
                        joint.points = [second.point; 2];
                        Some(JointKind::Cylindrical)
                    }
                    _ => None,
                };
                if let Some(kind) = pair {
                    joint.kind = kind;
                    joint.name = format!("{} and {}", first.name, second.name);
                    joint.names = [first.name.clone(), second.name.clone()];
                    joint.zero[1] = second.zero;
                    joint.loads[1] = second.load;
                    consumed = 2;
                }
            }
            joints.push((joint, at));
            at += consumed;
        }
        if joints.is_empty() {
            let link = self.link(name.to_owned(), pose);
            let points = [own.translation.vector, Vector3::zeros()];
            let axes = [own.rotation * Vector3::z(), Vector3::z()];
            let weld = Joint::new(name, JointKind::Fixed, [parent, Some(link)], points, axes);
            self.model.joints.push(weld);
            return link;
        }
        let (mut before, mut from) = (parent, own);
        let count = joints.len();
        for (k, (mut joint, first)) in joints.into_iter().enumerate() {
            let name = if k + 1 == count {
                name.to_owned()
            } else {
                format!("{name} behind {}", joint.name)
            };
            let link = self.link(name, pose);
            joint.links = [before, Some(link)];
            joint.points[0] = from.translation.vector + from.rotation * joint.points[0];
            joint.axes[0] = from.rotation * joint.axes[0];
            let coordinates = joint.kind.measures().len().max(1);
            for coordinate in 0..coordinates {
                let slot = (self.model.joints.len(), coordinate);
                self.slots.push(slot);
                let name = &freedoms[first + coordinate].name;
                self.joints.insert(name.clone(), slot);
            }
            self.model.joints.push(joint);
            (before, from) = (Some(link), Isometry3::identity());
        }
        self.model.links.len() - 1
    }

    fn link(&mut self, name: String, pose: Isometry3<f64>) -> usize {
        self.model.links.push(Link {
            name,
            pose,
            mass: Mass::default(),
            held: Vec::new(),
        });
        self.model.links.len() - 1
    }

    /// A joint of a body; `None` if it cannot be read.
    fn freedom(&mut self, item: &Item<'a>, body: &str, is_outer: bool) -> Option<MjcfJoint> {
        let element = item.element;
        let name = self.name_of_joint(element, body);
        let attributes = self.source.attributes(element, item.class);
        let given = GivenJoint {
            element,
            kind: attributes.get("type"),
            coordinates: ["ref", "springref", "range"].map(|key| attributes.get(key)),
            loads: ["stiffness", "damping", "armature"].map(|key| attributes.get(key)),
            limited: attributes.get("limited"),
            friction: attributes.get("frictionloss"),
            tuned: attributes.get("springdamper"),
        };
        let [pos, axis] = ["pos", "axis"].map(|key| attributes.get(key));
        let kind = self.kind_of(&given, &name, is_outer)?;
        let point = pos.and_then(|value| self.source.findings.vector(&value, NumberKind::Length));
        let axis = match axis {
            Some(value) if matches!(kind, JointKind::Revolute | JointKind::Translational) => {
                self.source.findings.direction(&value)?
            }
            _ => Vector3::z(),
        };
        let [zero, reference] = self.coordinates_of(&given, kind);
        let load = self.load_of(&given, (kind, &name), reference)?;
        let point = item.frame.translation.vector + item.frame.rotation * point.unwrap_or_default();
        let axis = if item.frame.rotation == UnitQuaternion::identity() {
            axis
        } else {
            unit(item.frame.rotation * axis)
        };
        Some(MjcfJoint {
            name,
            kind,
            point,
            axis,
            zero,
            load,
        })
    }

    fn name_of_joint(&mut self, element: Element<'a>, body: &str) -> String {
        let given = element.attribute("name");
        let given = given.map(|name| name.text.trim()).unwrap_or_default();
        if given.is_empty() {
            return format!("joint {} of {body}", self.model.joints.len() + 1);
        }
        if !self.names.insert(given.to_owned()) {
            let message = format!("the joint `{given}` is defined twice");
            self.source.findings.of(Fault::Twice, element, message);
        }
        given.to_owned()
    }

    fn kind_of(&mut self, given: &GivenJoint<'a>, name: &str, is_outer: bool) -> Option<JointKind> {
        let word = given.kind.as_ref();
        let word = word.map_or("hinge", |value| value.text.trim());
        let (fault, message) = match (given.element.name(), word) {
            ("freejoint", _) | (_, "free") if is_outer => return Some(JointKind::Free),
            ("freejoint", _) | (_, "free") => {
                let message = format!("joint `{name}`: only bodies of the world may be free");
                (Fault::Structure, message)
            }
            (_, "hinge") => return Some(JointKind::Revolute),
            (_, "slide") => return Some(JointKind::Translational),
            (_, "ball") => return Some(JointKind::Spherical),
            (_, other) => {
                let shown: String = other.chars().take(40).collect();
                let message = format!("joint `{name}`: there is no type `{shown}`");
                (Fault::Value, message)
            }
        };
        self.source.findings.of(fault, given.element, message);
        None
    }

    /// The value of the coordinate at the pose of the file, and the value at which the spring has
    /// no load.
    fn coordinates_of(&mut self, given: &GivenJoint<'a>, kind: JointKind) -> [f64; 2] {
        let [zero, reference, _] = &given.coordinates;
        let coordinates = [zero, reference].map(|value| numbers_of(self.source.findings, value)[0]);
        let angle = self.source.compiler.angle;
        if kind != JointKind::Revolute || angle == 1.0 {
            return coordinates;
        }
        for value in given.coordinates.iter().flatten() {
            let words = value.text.split_whitespace();
            let angles: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
            self.source.findings.look_for_radians(value, &angles);
        }
        coordinates.map(|x| x * angle)
    }

    /// Loads on a joint coordinate that the import supports. Other loads on the coordinate are
    /// omitted and reported.
    fn load_of(
        &mut self,
        given: &GivenJoint<'a>,
        (kind, name): (JointKind, &str),
        reference: f64,
    ) -> Option<Load> {
        let element = given.element;
        let [stiffness, damping, armature] = given
            .loads
            .each_ref()
            .map(|value| numbers_of(self.source.findings, value));
        let (line, auto_limits) = (element.line(), self.source.compiler.auto_limits);
        let findings = &mut *self.source.findings;
        let mut leave = |kind: &'static str| {
            findings.leave(kind, name.to_owned(), element.source, line);
        };
        if stiffness[1..]
            .iter()
            .chain(&damping[1..])
            .any(|x| *x != 0.0)
        {
            leave("nonlinear terms of springs and dampers");
        }
        let is_tuned = |value: &Value| value.text.split_whitespace().any(|x| x != "0");
        let is_free_element = element.name() == "freejoint";
        if given.tuned.as_ref().is_some_and(is_tuned) && !is_free_element {
            leave("springs that are tuned by `springdamper`");
        }
        let limited = given.limited.as_ref().map(|value| value.text.trim());
        let has_limits = match limited {
            Some("true") => true,
            Some("false") => false,
            _ => auto_limits && given.coordinates[2].is_some(),
        };
        if has_limits && kind != JointKind::Free {
            leave("limits of joints");
        }
        let has_friction = |value: &Value| value.text.trim().parse() != Ok(0.0);
        if given.friction.as_ref().is_some_and(has_friction) && !is_free_element {
            leave(FRICTION);
        }
        let load = Load {
            stiffness: stiffness[0],
            damping: damping[0],
            reference,
            armature: armature[0],
        };
        let numbers = [load.stiffness, load.damping, load.armature];
        if numbers.iter().any(|x| *x < 0.0) {
            let message =
                format!("joint `{name}`: stiffness, damping and armature are not negative");
            findings.of(Fault::Range, element, message);
            return None;
        }
        match kind {
            JointKind::Free => {
                if numbers != [0.0; 3] && !is_free_element {
                    leave("springs, dampers and armatures of free bodies");
                }
                Some(Load::default())
            }
            JointKind::Spherical => {
                if load.damping != 0.0 {
                    leave(
                        "dampers of spherical joints: accelerations differ while the joints turn",
                    );
                }
                if load.armature != 0.0 {
                    leave("armatures of spherical joints: accelerations differ");
                }
                Some(Load {
                    stiffness: load.stiffness,
                    ..Load::default()
                })
            }
            _ => Some(load),
        }
    }

    /// Scales all masses if `<compiler>` specifies the total mass.
    pub(super) fn finish_masses(&mut self, root: Element<'a>) {
        let Some(total) = self.source.compiler.total_mass else {
            return;
        };
        let sum: f64 = self.model.links.iter().map(|link| link.mass.mass).sum();
        if sum > 0.0 {
            for link in &mut self.model.links {
                link.mass = link.mass.scaled(total / sum);
                { link.held.iter_mut() }.for_each(|held| held.mass *= total / sum);
            }
            let remark = format!(
                "All masses are multiplied by {:.6} (settotalmass).",
                total / sum
            );
            self.source.findings.remarks.push(remark);
        } else {
            let message = "`settotalmass` of bodies without mass";
            self.source.findings.of(Fault::Range, root, message);
        }
    }

    fn site(&mut self, item: &Item<'a>, link: Option<usize>) {
        let element = item.element;
        let attributes = self.source.attributes(element, item.class);
        let ends = attributes.get("fromto");
        let keys = ["pos", "quat", "axisangle", "euler", "xyaxes", "zaxis"];
        let values = keys.map(|key| attributes.get(key));
        let get = |key: &str| {
            keys.iter()
                .position(|k| *k == key)
                .and_then(|k| values[k].clone())
        };
        let mut pose = item.frame * self.source.compiler.pose(get, self.source.findings);
        if let Some(value) = ends {
            let Some((middle, axes, _)) = Geoms::ends(&value, self.source.findings) else {
                return;
            };
            pose = item.frame * Isometry3::from_parts(middle.into(), axes);
        }
        let Some(name) = element.attribute("name") else {
            return;
        };
        let name = name.text.trim().to_owned();
        if self.sites.insert(name.clone(), (link, pose)).is_some() {
            let message = format!("the site `{name}` is defined twice");
            self.source.findings.of(Fault::Twice, element, message);
        }
        self.model.frames.push(Frame { name, link, pose });
    }
}

/// The numbers of a value, or a single zero if the value is missing.
fn numbers_of(findings: &mut Findings, value: &Option<Value<'_>>) -> Vec<f64> {
    let numbers = value.as_ref();
    let numbers = numbers.and_then(|value| findings.numbers(value, [1, 16], NumberKind::Other));
    numbers.unwrap_or_else(|| vec![0.0])
}
