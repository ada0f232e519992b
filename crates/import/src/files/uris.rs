//! URIs of SDF: a path relative to the file, or `model://NAME` for a folder with a `model.config`.

use super::{Folder, OUTSIDE};
use crate::xml::{Element, parse};
use scene::SourceText;

/// Reason why a URI does not lead to a file, and advice.
#[derive(Clone, Debug)]
pub(crate) struct IncludeProblem {
    pub(crate) reason: String,
    pub(crate) advice: Option<String>,
}

impl IncludeProblem {
    pub(super) fn new(reason: impl Into<String>) -> Self {
        let reason = reason.into();
        Self {
            reason,
            advice: None,
        }
    }

    fn with(reason: impl Into<String>, advice: String) -> Self {
        let reason = reason.into();
        Self {
            reason,
            advice: Some(advice),
        }
    }
}

/// The file to which a URI in the file `from` leads, relative to the folder.
pub(super) fn file_of(from: &str, uri: &str, folder: &Folder) -> Result<String, IncludeProblem> {
    let here = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    if let Some(model) = uri.strip_prefix("model://") {
        return of_model(here, model, folder);
    }
    if uri.contains("://") {
        let name = model_name(uri);
        let advice = format!(
            "copy the model into a folder `{name}` next to the file, and write `model://{name}`"
        );
        return Err(IncludeProblem::with(
            "only `model://` and paths are read",
            advice,
        ));
    }
    let path = joined(here, uri).ok_or_else(|| IncludeProblem::new(OUTSIDE))?;
    if folder.is_folder(&path) {
        return in_folder(&path, folder);
    }
    Ok(path)
}

/// The name of a model on the network: `…/models/NAME` on Gazebo Fuel, otherwise the last part.
fn model_name(uri: &str) -> &str {
    let last = || uri.trim_end_matches('/').rsplit('/').next();
    let (_, fuel) = uri.split_once("/models/").unzip();
    let fuel = fuel.and_then(|fuel| fuel.split('/').next());
    fuel.or_else(last).unwrap_or_default()
}

/// Searches `model://NAME` in the folder of the file and in the folders around it.
fn of_model(here: &str, model: &str, folder: &Folder) -> Result<String, IncludeProblem> {
    let name = model.split('/').next().unwrap_or_default();
    let mut around = Some(here);
    while let Some(at) = around {
        let path = joined(at, model).ok_or_else(|| IncludeProblem::new(OUTSIDE))?;
        if folder.is_folder(&path) {
            return in_folder(&path, folder);
        }
        if folder.path_of(&path).is_ok() {
            return Ok(path);
        }
        let outer = at.rsplit_once('/').map_or("", |(outer, _)| outer);
        around = (!at.is_empty()).then_some(outer);
    }
    if let Folder::None = folder {
        return Err(folder
            .path_of(name)
            .err()
            .map_or_else(|| IncludeProblem::new(OUTSIDE), IncludeProblem::new));
    }
    let advice = format!(
        "copy the folder `{name}` into the folder of the file, or remove the element if it does not \
         belong to the mechanism"
    );
    let reason = "the folder of the file does not contain it";
    Err(IncludeProblem::with(reason, advice))
}

/// The file of a model in its folder: the newest version in `model.config`, or `model.sdf`.
fn in_folder(path: &str, folder: &Folder) -> Result<String, IncludeProblem> {
    let config = format!("{path}/model.config");
    let name = match folder.path_of(&config) {
        Ok(_) => newest(&config, folder)?,
        Err(_) => "model.sdf".to_owned(),
    };
    joined(path, &name).ok_or_else(|| IncludeProblem::new(OUTSIDE))
}

/// The name in the element `<sdf version="…">` of a `model.config` with the largest version.
fn newest(config: &str, folder: &Folder) -> Result<String, IncludeProblem> {
    let text = folder.read(config).map_err(IncludeProblem::new)?;
    let text = SourceText::new(config, &text);
    let Ok(document) = parse(&text) else {
        return Err(IncludeProblem::new(format!("`{config}` is not XML")));
    };
    let root = Element::root(&document, &text);
    let files = root.children().filter(|child| child.name() == "sdf");
    let newest = files.max_by_key(|file| {
        let version = file.attribute("version");
        version.map(|value| version_of(value.text))
    });
    match newest.map(|file| file.text().text) {
        Some(name) if !name.is_empty() => Ok(name.to_owned()),
        _ => Err(IncludeProblem::new(format!(
            "`{config}` has no `<sdf>` with a file"
        ))),
    }
}

/// The two numbers of a version.
pub(crate) fn version_of(version: &str) -> (u32, u32) {
    let mut parts = version
        .trim()
        .split('.')
        .map(|part| part.parse().unwrap_or(0));
    (parts.next().unwrap_or(1), parts.next().unwrap_or(6))
}

/// A path relative to a folder, without `.` and `..`. The result is `None` if the path leaves the
/// outermost folder.
fn joined(folder: &str, path: &str) -> Option<String> {
    if path.is_empty() || path.starts_with('/') {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(path.split('/')) {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_in_the_folder() {
        let paths = [
            ("", "a.sdf", Some("a.sdf")),
            ("b", "./a.sdf", Some("b/a.sdf")),
            ("b/c", "../a.sdf", Some("b/a.sdf")),
            ("b", "../../a.sdf", None),
            ("", "/a.sdf", None),
            ("b", "", None),
            ("b", "..", None),
        ];
        for (folder, path, expected) in paths {
            assert_eq!(joined(folder, path).as_deref(), expected, "{folder} {path}");
        }
        assert!(version_of("1.10") > version_of("1.9"));
    }
}
