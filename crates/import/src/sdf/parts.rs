//! The models of a file: each with its elements, with the elements of merged models, and with the
//! models within it. Includes are replaced by the models of their files.

use std::collections::HashSet;

use super::names::NAMES;
use crate::files::Files;
use crate::findings::{Fault, Findings};
use crate::limits::{DEEPEST_MODEL, LARGEST, MOST_LISTED};
use crate::vocabulary;
use crate::xml::{Element, Value};

/// A model, or the world.
pub(super) struct Part<'a> {
    pub(super) element: Element<'a>,
    /// The name in the surrounding model.
    pub(super) name: String,
    /// The names of the surrounding models and of this model; empty for the world.
    pub(super) path: String,
    /// The number of surrounding models.
    depth: usize,
    pub(super) place: Placement<'a>,
    pub(super) is_static: bool,
    pub(super) is_world: bool,
    /// Links, joints, frames and plugins.
    pub(super) items: Vec<ModelItem<'a>>,
    pub(super) merged: Vec<MergedModel<'a>>,
    pub(super) parts: Vec<Part<'a>>,
}

/// An element of a model.
pub(super) struct ModelItem<'a> {
    pub(super) element: Element<'a>,
    /// The name; empty for plugins.
    pub(super) name: &'a str,
    /// The merged model that contains the element.
    pub(super) within: Option<usize>,
    /// The number of a link.
    pub(super) link: usize,
}

/// A model whose elements belong to the including model.
pub(super) struct MergedModel<'a> {
    /// The name of its frame.
    pub(super) name: String,
    pub(super) place: Placement<'a>,
    pub(super) canonical: Option<&'a str>,
}

/// The position of a model.
#[derive(Clone)]
pub(super) struct Placement<'a> {
    pub(super) pose: Option<Element<'a>>,
    /// The frame of the model that is at the pose.
    pub(super) frame: Option<Value<'a>>,
    /// The merged model that contains the model.
    pub(super) within: Option<usize>,
}

impl<'a> Placement<'a> {
    /// The position of a model. The elements of its `<include>` precede the elements of the model.
    fn of(model: Element<'a>, include: Option<Element<'a>>, within: Option<usize>) -> Self {
        let pose = include.and_then(|include| include.child("pose"));
        let frame = include.and_then(|include| include.text_of("placement_frame"));
        let frame = frame.or_else(|| model.attribute("placement_frame"));
        Self {
            pose: pose.or_else(|| model.child("pose")),
            frame: frame.filter(|frame| !frame.text.trim().is_empty()),
            within,
        }
    }
}

impl<'a> Part<'a> {
    /// The link to which the frame of the model belongs.
    pub(super) fn canonical(&self) -> Option<&'a str> {
        let given = self.element.attribute("canonical_link");
        let given = given.map(|value| value.text.trim());
        given.filter(|name| !name.is_empty()).or_else(|| {
            let first = self.items_of("link").next();
            first.map(|item| item.name)
        })
    }

    pub(super) fn items_of(&self, kind: &str) -> impl Iterator<Item = &ModelItem<'a>> {
        self.items
            .iter()
            .filter(move |item| item.element.name() == kind)
    }

    /// Numbers the links: first the links of the model, then the links of the models within it.
    fn number(&mut self, next: &mut usize) {
        for item in &mut self.items {
            if item.element.name() == "link" {
                item.link = *next;
                *next += 1;
            }
        }
        for part in &mut self.parts {
            part.number(next);
        }
    }
}

/// Reads the models of a file as parts of the world. `chosen` is the name of the only model that is
/// read.
pub(super) fn world<'a>(
    files: &'a Files<'a>,
    chosen: Option<&str>,
    findings: &mut Findings,
) -> Option<Part<'a>> {
    let root = files.root();
    let worlds: Vec<Element> = root.children().filter(|c| c.name() == "world").collect();
    if let [_, second, ..] = worlds.as_slice() {
        let message = format!("one `<world>` is read, found {}", worlds.len());
        findings.of(Fault::Structure, *second, message);
        return None;
    }
    let mut builder = PartBuilder {
        files,
        findings,
        around: Vec::new(),
        checked: HashSet::new(),
        size: 0,
    };
    let mut world = Part {
        element: worlds.first().copied().unwrap_or(root),
        name: String::new(),
        path: String::new(),
        depth: 0,
        place: Placement {
            pose: None,
            frame: None,
            within: None,
        },
        is_static: false,
        is_world: true,
        items: Vec::new(),
        merged: Vec::new(),
        parts: Vec::new(),
    };
    let is_model = |element: &Element| matches!(element.name(), "model" | "include");
    let mut elements: Vec<Element> = root.children().filter(is_model).collect();
    for world in worlds {
        elements.extend(world.children().filter(|child| child.name() != "link"));
    }
    match chosen {
        Some(chosen) => builder.choose(&elements, chosen, &mut world),
        None => builder.fill(&elements, None, &mut world),
    }
    world.number(&mut 0);
    Some(world)
}

struct PartBuilder<'a, 'f> {
    files: &'a Files<'a>,
    findings: &'f mut Findings,
    /// The included files around the current element.
    around: Vec<&'a str>,
    /// Files whose names were checked.
    checked: HashSet<&'a str>,
    /// The number of bytes of all included files, counted at each inclusion.
    size: usize,
}

impl<'a> PartBuilder<'a, '_> {
    /// Adds one model of the world. Other models are reported.
    fn choose(&mut self, elements: &[Element<'a>], chosen: &str, world: &mut Part<'a>) {
        let is_model = |element: &&Element| matches!(element.name(), "model" | "include");
        let models: Vec<_> = elements.iter().filter(is_model).copied().collect();
        let names: Vec<_> = models.iter().map(|model| self.name_of(*model)).collect();
        if !names.contains(&chosen) {
            let known: Vec<String> = names
                .iter()
                .take(MOST_LISTED)
                .map(|n| format!("`{n}`"))
                .collect();
            let message = format!("the file has no model `{chosen}`");
            let help = (!known.is_empty()).then(|| format!("known are {}", known.join(", ")));
            let (source, span) = (world.element.source, world.element.span());
            let fault = Fault::Unknown;
            return self
                .findings
                .fault_with_help(fault, source, span, message, "", help);
        }
        for (model, name) in models.into_iter().zip(names) {
            if name == chosen {
                self.fill(&[model], None, world);
            } else {
                self.findings
                    .leave_element("models that are not chosen", model, name);
            }
        }
        let joints = elements.iter().filter(|element| element.name() == "joint");
        for joint in joints {
            let name = joint.attribute("name").map_or("", |name| name.text);
            let is_of = |key| {
                let text = joint.text_of(key).map_or("", |value| value.text);
                text == "world" || text.split("::").next() == Some(chosen)
            };
            if is_of("parent") && is_of("child") {
                self.fill(&[*joint], None, world);
            } else {
                self.findings
                    .leave_element("joints of models that are not chosen", *joint, name);
            }
        }
    }

    /// The name of a model in the world.
    fn name_of(&self, element: Element<'a>) -> &'a str {
        let own = |element: Element<'a>| element.attribute("name").map(|name| name.text.trim());
        if element.name() == "model" {
            return own(element).unwrap_or_default();
        }
        let given = element.text_of("name").map(|name| name.text);
        given.unwrap_or_else(|| {
            let root = element
                .text_of("uri")
                .and_then(|uri| self.files.of_uri(&uri).ok());
            root.and_then(|root| own(root.child("model")?))
                .unwrap_or_default()
        })
    }

    fn fill(&mut self, elements: &[Element<'a>], within: Option<usize>, part: &mut Part<'a>) {
        for element in elements {
            match element.name() {
                "link" | "joint" | "frame" => self.item(*element, within, part),
                "plugin" if !part.is_world => part.items.push(ModelItem {
                    element: *element,
                    name: "",
                    within,
                    link: 0,
                }),
                "model" => self.model(*element, None, within, part),
                "include" => self.include(*element, within, part),
                "static" => {
                    part.is_static = self.findings.boolean(&element.text()).unwrap_or(false);
                }
                _ => {}
            }
        }
    }

    fn item(&mut self, element: Element<'a>, within: Option<usize>, part: &mut Part<'a>) {
        let Some(name) = self.findings.needed(element, "name") else {
            return;
        };
        part.items.push(ModelItem {
            element,
            name: name.text.trim(),
            within,
            link: 0,
        });
    }

    fn model(
        &mut self,
        element: Element<'a>,
        include: Option<Element<'a>>,
        within: Option<usize>,
        around: &mut Part<'a>,
    ) {
        let given = include.and_then(|include| include.text_of("name"));
        let name = given.or_else(|| element.attribute("name"));
        let name = name.map_or("", |name| name.text.trim()).to_owned();
        if name.is_empty() && !around.is_world {
            return self.findings.missing(element, "a `name`");
        }
        let path = if around.is_world {
            name.clone()
        } else {
            format!("{}/{name}", around.path)
        };
        if around.depth >= DEEPEST_MODEL {
            let message = format!("models are nested more than {DEEPEST_MODEL} deep");
            return self.findings.of(Fault::Structure, element, message);
        }
        let mut part = Part {
            element,
            name,
            path,
            depth: around.depth + 1,
            place: Placement::of(element, include, within),
            is_static: false,
            is_world: false,
            items: Vec::new(),
            merged: Vec::new(),
            parts: Vec::new(),
        };
        let own: Vec<_> = element.children().collect();
        self.fill(&own, None, &mut part);
        let more = include.into_iter().flat_map(|include| include.children());
        let more: Vec<_> = more
            .filter(|child| matches!(child.name(), "static" | "plugin"))
            .collect();
        self.fill(&more, None, &mut part);
        around.parts.push(part);
    }

    fn include(&mut self, include: Element<'a>, within: Option<usize>, part: &mut Part<'a>) {
        let Some(model) = self.model_of(include) else {
            return;
        };
        let merges = include.attribute("merge");
        let merges = merges
            .and_then(|value| self.findings.boolean(&value))
            .unwrap_or(false);
        self.around.push(model.source.name());
        if merges && part.is_world {
            let message = "a model is merged into a model, not into the world";
            self.findings.of(Fault::Unsupported, include, message);
        } else if merges {
            self.merge(model, include, within, part);
        } else {
            self.model(model, Some(include), within, part);
        }
        self.around.pop();
    }

    fn merge(
        &mut self,
        model: Element<'a>,
        include: Element<'a>,
        within: Option<usize>,
        part: &mut Part<'a>,
    ) {
        let name = include.text_of("name").or_else(|| model.attribute("name"));
        let name = name.map_or("", |name| name.text.trim());
        let number = part.merged.len();
        let canonical = model
            .attribute("canonical_link")
            .map(|value| value.text.trim());
        part.merged.push(MergedModel {
            name: format!("_merged__{name}__model__"),
            place: Placement::of(model, Some(include), within),
            canonical: canonical.filter(|name| !name.is_empty()),
        });
        let first = part.items.len();
        let own: Vec<_> = model
            .children()
            .filter(|child| child.name() != "static")
            .collect();
        self.fill(&own, Some(number), part);
        let link = part.items[first..]
            .iter()
            .find(|item| item.element.name() == "link");
        let merged = &mut part.merged[number];
        merged.canonical = merged.canonical.or(link.map(|item| item.name));
        let plugins: Vec<_> = include
            .children()
            .filter(|c| c.name() == "plugin")
            .collect();
        self.fill(&plugins, Some(number), part);
    }

    /// The model of an `<include>`. Files with only lights or actors have no model.
    fn model_of(&mut self, include: Element<'a>) -> Option<Element<'a>> {
        let Some(uri) = include.text_of("uri") else {
            self.findings.missing(include, "a `<uri>`");
            return None;
        };
        let root = match self.files.of_uri(&uri) {
            Ok(root) => root,
            Err(found) => {
                let message = format!("`{}` is not included: {}", uri.text, found.reason);
                let (span, help) = (uri.span.clone(), found.advice);
                let fault = Fault::Include;
                self.findings
                    .fault_with_help(fault, uri.source, span, message, "", help);
                return None;
            }
        };
        self.allow(root, &uri)?;
        if self.checked.insert(root.source.name()) && root.name() == "sdf" {
            vocabulary::check(root, NAMES, None, self.findings);
        }
        self.only_model(root, &uri)
    }

    /// Rejects files that include each other, and inclusions without end.
    fn allow(&mut self, root: Element<'a>, uri: &Value<'a>) -> Option<()> {
        let file = root.source.name();
        let message = if let Some(first) = self.around.iter().position(|name| *name == file) {
            let through = self.around[first..].join("`, `");
            format!("`{through}` include each other without end")
        } else if self.size > LARGEST {
            // The first inclusion above the limit was reported.
            return None;
        } else {
            self.size += root.source.text().len();
            if self.size <= LARGEST {
                return Some(());
            }
            format!("all included files together have more than {LARGEST} bytes")
        };
        self.findings.at(Fault::Include, uri, message);
        None
    }

    fn only_model(&mut self, root: Element<'a>, uri: &Value<'a>) -> Option<Element<'a>> {
        let mut models = root.children().filter(|child| child.name() == "model");
        let idle = |child: Element| matches!(child.name(), "light" | "actor");
        let problem = match (root.name(), models.next(), models.next()) {
            ("sdf", Some(model), None) => return Some(model),
            ("sdf", None, _) if root.children().any(idle) => return None,
            ("sdf", ..) => "an included file needs one `<model>`".to_owned(),
            (other, ..) => {
                let shown: String = other.chars().take(40).collect();
                format!("its root is `<{shown}>`, expected `<sdf>`")
            }
        };
        let message = format!("`{}` is not included: {problem}", uri.text);
        self.findings.at(Fault::Include, uri, message);
        None
    }
}
