//! MJCF, the format of MuJoCo: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.

mod aligned;
mod body;
mod compiler;
mod defaults;
mod equality;
mod geom;
mod keyframe;
mod mass;
mod names;
mod reader;
mod source;

use std::collections::{HashMap, HashSet};

use nalgebra::Vector3;

use crate::files::Files;
use crate::findings::{Fault, Findings, NumberKind};
use crate::limits::GRAVITY;
use crate::mechanism::Model;
use crate::xml::Element;
use aligned::Alignments;
use compiler::Compiler;
use defaults::Defaults;
pub(crate) use names::NAMES;
use reader::Reader;
use source::Source;

/// Kinds of omission for actuators that have no effect without a signal, and for all other
/// actuators.
const IDLE_ACTUATORS: &str = "actuators";
const ACTING: &str = "actuators that also act without a signal: accelerations differ";

/// Elements of `<actuator>` with a gear, which can act on joints.
const ACTUATORS: [&str; 6] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
];

/// Reads a model. Problems are added to `findings`.
pub(crate) fn read<'a>(
    files: &'a Files<'a>,
    keyframe: Option<&str>,
    findings: &mut Findings,
) -> Model {
    let root = files.root();
    let sections = files.children(root, findings);
    let compiler = Compiler::read(&sections, findings);
    let defaults = Defaults::read(files, &sections, findings);
    let mut reader = Reader {
        source: Source {
            files,
            findings,
            compiler,
            defaults,
        },
        model: Model::default(),
        keyframe: keyframe.map(str::to_owned),
        bodies: HashMap::from([("world".to_owned(), None)]),
        joints: HashMap::new(),
        names: HashSet::new(),
        tendons: HashMap::new(),
        sites: HashMap::new(),
        aligned: Alignments::default(),
        slots: Vec::new(),
    };
    let name = root
        .attribute("model")
        .map(|value| value.text.trim().to_owned());
    reader.model.name = name
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| "MuJoCo model".into());
    reader.model.gravity = Vector3::new(0.0, 0.0, GRAVITY);
    for section in &sections {
        reader.option(*section);
    }
    for section in sections
        .iter()
        .filter(|section| section.name() == "worldbody")
    {
        reader.world(*section);
    }
    reader.finish_masses(root);
    for section in &sections {
        reader.tendons(*section);
    }
    // Keyframes refer to all joints, also to the joints that sections after them add.
    let is_keyframes = |section: &&Element| section.name() == "keyframe";
    for section in sections.iter().filter(|section| !is_keyframes(section)) {
        reader.section(*section);
    }
    for section in sections.iter().filter(is_keyframes) {
        reader.keyframes(*section);
    }
    reader.model
}

impl<'a> Reader<'a, '_> {
    fn option(&mut self, section: Element<'a>) {
        if section.name() != "option" {
            return;
        }
        for (key, value) in section.attributes() {
            match key {
                "gravity" => {
                    if let Some(gravity) = self.source.findings.vector(&value, NumberKind::Other) {
                        self.model.gravity = gravity;
                    }
                }
                "wind" | "density" | "viscosity" | "magnetic" => {
                    let numbers = self
                        .source
                        .findings
                        .numbers(&value, [1, 3], NumberKind::Other);
                    if numbers.is_some_and(|numbers| numbers.iter().any(|x| *x != 0.0)) {
                        let kind = "forces of a medium or field";
                        self.source
                            .findings
                            .leave(kind, key, value.source, value.line());
                    }
                }
                _ => {}
            }
        }
        for flags in section.children().filter(|child| child.name() == "flag") {
            for (key, value) in flags.attributes() {
                match (key, value.text.trim()) {
                    ("gravity", "disable") => self.model.gravity = Vector3::zeros(),
                    ("spring" | "damper" | "passive" | "equality", "disable") => {
                        let message = format!(
                            "{} disables parts of the model that a scene always contains",
                            value.subject
                        );
                        let help = "remove the flag, or the elements that it disables".to_owned();
                        let (source, span) = (value.source, value.span.clone());
                        self.source.findings.fault_with_help(
                            Fault::Unsupported,
                            source,
                            span,
                            message,
                            "",
                            help,
                        );
                    }
                    _ => {}
                }
            }
        }
    }

    fn section(&mut self, section: Element<'a>) {
        let left: &'static str = match section.name() {
            "actuator" | "tendon" => "",
            "equality" => return self.equalities(section),
            "sensor" => "sensors",
            "contact" => "pairs and exclusions of contacts",
            "deformable" => "deformable bodies",
            "extension" => "plugins",
            _ => return,
        };
        let mut is_empty = true;
        for child in self.source.children(section) {
            is_empty = false;
            let name = child.attribute("name").map(|name| name.text.to_owned());
            let subject = name.unwrap_or_else(|| format!("<{}>", child.name()));
            let left = match section.name() {
                "actuator" => self.actuator(child),
                "tendon" => self.tendon(child),
                _ => left,
            };
            self.source.findings.leave_element(left, child, &subject);
            if section.name() == "actuator" {
                actuate(self, child);
            }
        }
        if is_empty && section.attributes().next().is_some() {
            self.source.findings.leave_element(left, section, "");
        }
    }

    /// Kind of omission for an actuator. Motors have no effect without a signal; other actuators
    /// have an effect.
    fn actuator(&mut self, element: Element<'a>) -> &'static str {
        let has = |element: &Element, key: &str| {
            let value = element.attribute(key);
            value.is_some_and(|value| value.text.split_whitespace().any(|x| x.parse() != Ok(0.0)))
        };
        // Damping and armature of an actuator act on the joint of the actuator.
        if has(&element, "damping") || has(&element, "armature") {
            return ACTING;
        }
        match element.name() {
            "motor" | "damper" | "adhesion" => IDLE_ACTUATORS,
            "general" => {
                let bias = self.source.attributes(element, 0).get("biastype");
                match bias.as_ref().map_or("none", |value| value.text.trim()) {
                    "none" => IDLE_ACTUATORS,
                    _ => ACTING,
                }
            }
            "cylinder" if !has(&element, "bias") => IDLE_ACTUATORS,
            _ => ACTING,
        }
    }

    /// Records the tendons of a section by their names.
    fn tendons(&mut self, section: Element<'a>) {
        if section.name() != "tendon" {
            return;
        }
        for child in self.source.children(section) {
            let Some(name) = child.attribute("name") else {
                continue;
            };
            let name = name.text.trim().to_owned();
            if self.tendons.insert(name.clone(), child).is_some() {
                let message = format!("the tendon `{name}` is defined twice");
                self.source.findings.of(Fault::Twice, child, message);
            }
        }
    }

    /// Returns the kind of omission for a tendon. The kind depends on whether springs, dampers or
    /// friction are omitted.
    fn tendon(&mut self, element: Element<'a>) -> &'static str {
        let class = self.source.attributes(element, 0).class;
        let acts = ["stiffness", "damping", "frictionloss", "armature"]
            .iter()
            .any(|key| {
                let own = element.attribute(key);
                let value = own.or_else(|| self.source.defaults.get(class, "tendon", key));
                value.is_some_and(|value| {
                    value.text.split_whitespace().any(|x| x.parse() != Ok(0.0))
                })
            });
        if acts {
            "tendons with springs, dampers, friction or armatures: accelerations differ"
        } else {
            "tendons"
        }
    }
}

/// Records an actuator that acts on a joint coordinate.
fn actuate<'a>(reader: &mut Reader<'a, '_>, element: Element<'a>) {
    let joint = element.attribute("joint");
    let joint = joint.or_else(|| element.attribute("jointinparent"));
    let Some(at) = joint.and_then(|joint| reader.joints.get(joint.text.trim()).copied()) else {
        return;
    };
    let name = element.attribute("name").map_or("", |name| name.text);
    let class = reader.source.attributes(element, 0).class;
    // Defaults of each kind of actuator apply to all kinds.
    let get = |key: &str| {
        let kinds = ACTUATORS.iter();
        let default = |kind: &&str| reader.source.defaults.get(class, kind, key);
        element
            .attribute(key)
            .or_else(|| { kinds }.find_map(default))
    };
    let gear = get("gear");
    let first = gear.and_then(|gear| gear.text.split_whitespace().next()?.parse().ok());
    let has = |key| get(key).is_some();
    let is_plain = element.name() == "motor"
        && first.unwrap_or(1.0) == 1.0
        && !["ctrlrange", "forcerange", "damping", "armature"]
            .into_iter()
            .any(has);
    reader
        .model
        .actuate(name, at, is_plain, reader.source.findings);
}
