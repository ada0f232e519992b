//! The names that an element of a model can use, and the names of the scene.

use std::collections::{HashMap, HashSet};

use nalgebra::Isometry3;

use super::frames::Frames;
use super::parts::{ModelItem, Part};
use crate::files::version_of;
use crate::findings::{Fault, Findings};
use crate::xml::Value;

/// The names for an element of a model.
pub(crate) struct Scope<'s> {
    pub(super) frames: &'s Frames,
    /// The world, for plugins that name another model.
    world: Option<&'s Frames>,
    /// The name of the model.
    model: &'s str,
    path: &'s str,
    /// The frame that `__model__` means.
    own: &'s str,
    names: Option<&'s SceneNames>,
    /// The joints by their names in the scene.
    numbers: &'s HashMap<String, usize>,
    /// Whether joint axes are given in the axes of the model, as in versions before 1.5.
    pub(super) in_model: bool,
}

impl<'s> Scope<'s> {
    /// The scope for elements in `<gazebo>` of a URDF.
    pub(crate) fn of_links(
        frames: &'s Frames,
        model: &'s str,
        numbers: &'s HashMap<String, usize>,
    ) -> Self {
        Self {
            frames,
            world: None,
            model,
            path: "",
            own: "__model__",
            names: None,
            numbers,
            in_model: false,
        }
    }

    /// The scope for an element of a model.
    pub(super) fn of_item(
        item: &ModelItem,
        part: &'s Part,
        [world, frames]: [&'s Frames; 2],
        names: &'s SceneNames,
        numbers: &'s HashMap<String, usize>,
    ) -> Self {
        let version = item.element.file_root().attribute("version");
        let merged = item.within.and_then(|number| part.merged.get(number));
        Self {
            frames,
            world: Some(world),
            model: &part.name,
            path: &part.path,
            own: merged.map_or("__model__", |merged| &merged.name),
            names: Some(names),
            numbers,
            in_model: version.is_some_and(|value| version_of(value.text) < (1, 5)),
        }
    }

    /// The link of a name; the inner `None` is the ground.
    pub(crate) fn link(&self, value: &Value, findings: &mut Findings) -> Option<Option<usize>> {
        let name = self.meant(value.text.trim());
        let found = match name {
            "world" => Some(None),
            name => self.frames.link_of(name),
        };
        if found.is_some() {
            return found;
        }
        let near = scene::nearest(name, self.frames.names());
        let help = near.map(|near| format!("did you mean `{near}`?"));
        let message = format!("{}: there is no link `{name}`", value.subject);
        let (source, span) = (value.source, value.span.clone());
        findings.fault_with_help(Fault::Unknown, source, span, message, "no such link", help);
        None
    }

    /// The link of a model that a plugin names, which is this model or a model of the world.
    pub(crate) fn link_of_model(
        &self,
        model: &Value,
        link: &Value,
        findings: &mut Findings,
    ) -> Option<Option<usize>> {
        let name = model.text.trim();
        if name == self.model || name == "__model__" {
            return self.link(link, findings);
        }
        let Some(frames) = self.world.and_then(|world| world.inner(name)) else {
            let message =
                format!("a detachable joint holds the model `{name}`, which is not in this file");
            findings.at(Fault::Unsupported, model, message);
            return None;
        };
        Scope::of_links(frames, name, self.numbers).link(link, findings)
    }

    /// The pose of a name in ground axes.
    pub(super) fn pose(&self, name: &str) -> Option<Isometry3<f64>> {
        self.frames.pose(self.meant(name))
    }

    /// The pose of the model in ground axes.
    pub(super) fn model(&self) -> Isometry3<f64> {
        self.pose("__model__").unwrap_or_default()
    }

    fn meant<'n>(&self, name: &'n str) -> &'n str
    where
        's: 'n,
    {
        if name == "__model__" { self.own } else { name }
    }

    /// The number of a joint of this model, or of a model within it.
    pub(crate) fn number_of(&self, name: &str) -> Option<usize> {
        self.numbers.get(&self.joint(name.trim())).copied()
    }

    /// The numbers of the joints of this model.
    pub(crate) fn joints(&self) -> Vec<usize> {
        let names = self.frames.joints();
        let mut joints: Vec<usize> = names.filter_map(|name| self.number_of(name)).collect();
        joints.sort_unstable();
        joints
    }

    /// The name in the scene of a joint of this model, or of a model within it.
    pub(crate) fn joint(&self, name: &str) -> String {
        let Some(names) = self.names else {
            return name.to_owned();
        };
        match name.rsplit_once("::") {
            Some((inner, own)) => {
                let inner = inner.replace("::", "/");
                let path = [self.path, &inner].join("/");
                names.joint(path.trim_start_matches('/'), own)
            }
            None => names.joint(self.path, name),
        }
    }
}

/// The names of several models in the scene. A name that several models use is preceded by the
/// names of its models.
pub(super) struct SceneNames {
    repeated: [HashSet<String>; 2],
}

impl SceneNames {
    pub(super) fn of(world: &Part) -> Self {
        let mut names = Self {
            repeated: Default::default(),
        };
        let mut seen = Default::default();
        names.see(world, &mut seen);
        names
    }

    fn see<'p>(&mut self, part: &'p Part, seen: &mut [HashSet<&'p str>; 2]) {
        for item in part.items.iter().filter(|item| !item.name.is_empty()) {
            let kind = usize::from(item.element.name() == "joint");
            if !seen[kind].insert(item.name) {
                self.repeated[kind].insert(item.name.to_owned());
            }
        }
        for inner in &part.parts {
            self.see(inner, seen);
        }
    }

    /// The name of a link or frame.
    pub(super) fn place(&self, path: &str, name: &str) -> String {
        full(&self.repeated[0], path, name)
    }

    fn joint(&self, path: &str, name: &str) -> String {
        full(&self.repeated[1], path, name)
    }
}

fn full(repeated: &HashSet<String>, path: &str, name: &str) -> String {
    if path.is_empty() || !repeated.contains(name) {
        name.to_owned()
    } else {
        format!("{path}/{name}")
    }
}
