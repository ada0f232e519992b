//! The elements of a file, and the settings that determine the meaning of their attributes.

use nalgebra::Isometry3;

use super::compiler::{Compiler, WAYS};
use super::defaults::Defaults;
use crate::files::Files;
use crate::findings::{Fault, Findings};
use crate::limits::DEEPEST;
use crate::xml::{Element, Value};

/// The elements of a file, and the settings that determine the meaning of their attributes.
pub(super) struct Source<'a, 'f> {
    pub(super) files: &'a Files<'a>,
    pub(super) findings: &'f mut Findings,
    pub(super) compiler: Compiler,
    pub(super) defaults: Defaults<'a>,
}

/// An element of a body, with the pose of the surrounding frames and with the class of the element.
#[derive(Clone)]
pub(super) struct Item<'a> {
    pub(super) element: Element<'a>,
    pub(super) frame: Isometry3<f64>,
    pub(super) class: usize,
}

/// An element with the attributes of its class.
pub(super) struct Attributes<'a, 'r> {
    element: Element<'a>,
    pub(super) class: usize,
    defaults: &'r Defaults<'a>,
}

impl<'a> Attributes<'a, '_> {
    pub(super) fn get(&self, key: &str) -> Option<Value<'a>> {
        let own = self.element.attribute(key);
        let is_turned = || WAYS.iter().any(|way| self.element.attribute(way).is_some());
        // An orientation of the element replaces an orientation of the class in any form.
        if own.is_none() && WAYS.contains(&key) && is_turned() {
            return None;
        }
        own.or_else(|| self.defaults.get(self.class, self.element.name(), key))
    }
}

impl<'a> Source<'a, '_> {
    /// The child elements of an element; includes are replaced by the elements of the included
    /// files.
    pub(super) fn children(&mut self, element: Element<'a>) -> Vec<Element<'a>> {
        self.files.children(element, self.findings)
    }

    /// Returns an element with the attributes of its class. An element without a class has the
    /// class of the surrounding body.
    pub(super) fn attributes(&mut self, element: Element<'a>, around: usize) -> Attributes<'a, '_> {
        let class = match element.attribute("class") {
            Some(value) => self.class(&value),
            None => around,
        };
        Attributes {
            element,
            class,
            defaults: &self.defaults,
        }
    }

    /// The index of a class.
    pub(super) fn class(&mut self, value: &Value) -> usize {
        self.defaults.find(value.text.trim()).unwrap_or_else(|| {
            let message = format!("{}: there is no class `{}`", value.subject, value.text);
            self.findings.at(Fault::Unknown, value, message);
            0
        })
    }

    /// The elements of a body, including those within frames.
    pub(super) fn items(
        &mut self,
        around: Element<'a>,
        frame: Isometry3<f64>,
        class: usize,
        out: &mut Vec<Item<'a>>,
        depth: usize,
    ) {
        if depth > DEEPEST {
            return self
                .findings
                .of(Fault::Structure, around, "frames are nested too deeply");
        }
        for element in self.children(around) {
            match element.name() {
                "frame" => {
                    let get = |key: &str| element.attribute(key);
                    let own = self.compiler.pose(get, self.findings);
                    let class = match element.attribute("childclass") {
                        Some(value) => self.class(&value),
                        None => class,
                    };
                    self.items(element, frame * own, class, out, depth + 1);
                }
                "body" | "joint" | "freejoint" | "geom" | "site" | "inertial" => {
                    out.push(Item {
                        element,
                        frame,
                        class,
                    });
                }
                "composite" | "flexcomp" | "replicate" | "attach" => {
                    let message = format!("`<{}>` makes bodies that are not read", element.name());
                    let help = "load the file in MuJoCo, save it with mj_saveLastXML, and import the saved file";
                    let (source, span) = (element.source, element.span());
                    let fault = Fault::Unsupported;
                    self.findings.fault_with_help(
                        fault,
                        source,
                        span,
                        message,
                        "",
                        help.to_owned(),
                    );
                }
                _ => {}
            }
        }
    }
}
