//! The files of a model: the given file and its included files, which must be in the same folder.

use std::path::{Component, Path, PathBuf};

use roxmltree::Document;
use scene::SourceText;

use crate::findings::{Fault, Findings};
use crate::limits::{DEEPEST, LARGEST, MOST_FILES};
use crate::xml::{Element, Value, parse};

/// The folder in which included files may be.
#[derive(Clone, Debug)]
pub enum Folder {
    /// Includes are rejected, as for a text from standard input.
    None,
    /// The folder of the file, and its subfolders.
    At(PathBuf),
}

impl Folder {
    /// The folder of a file.
    #[must_use]
    pub fn of(file: &Path) -> Self {
        let parent = file.parent().unwrap_or(Path::new(""));
        let here = parent.as_os_str().is_empty();
        Self::At(if here {
            PathBuf::from(".")
        } else {
            parent.to_path_buf()
        })
    }

    /// Returns the text of a file in the folder, or the reason why the file cannot be read.
    fn read(&self, name: &str) -> Result<String, String> {
        let Self::At(folder) = self else {
            return Err("files are included only into a file, not into standard input".to_owned());
        };
        let path = Path::new(name);
        let stays = path
            .components()
            .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !stays || name.is_empty() {
            return Err("it is outside of the folder of the file".to_owned());
        }
        let told = |e: std::io::Error| format!("it cannot be read: {e}");
        let root = folder.canonicalize().map_err(told)?;
        let path = folder.join(path).canonicalize().map_err(told)?;
        if !path.starts_with(&root) {
            return Err("it is outside of the folder of the file".to_owned());
        }
        let size = std::fs::metadata(&path).map_err(told)?;
        if !size.is_file() || size.len() > LARGEST as u64 {
            return Err(format!("it is not a file of at most {LARGEST} bytes"));
        }
        std::fs::read_to_string(&path).map_err(told)
    }
}

/// The texts of all files, starting with the given file.
pub(crate) fn load(
    source: SourceText,
    folder: &Folder,
    findings: &mut Findings,
) -> Vec<SourceText> {
    let mut texts = vec![source];
    let mut at = 0;
    while at < texts.len() {
        let text = texts[at].clone();
        at += 1;
        let Ok(document) = parse(&text) else { continue };
        let mut stack = vec![Element::root(&document, &text)];
        while let Some(element) = stack.pop() {
            stack.extend(element.children());
            let Some(file) = included(element) else {
                continue;
            };
            if texts.iter().skip(1).any(|text| text.name() == file.text) {
                let message = format!("`{}` is included twice", file.text);
                findings.at(Fault::Include, &file, message);
                continue;
            }
            if texts.len() > MOST_FILES {
                let message = format!("more than {MOST_FILES} files are included");
                findings.at(Fault::Include, &file, message);
                return texts;
            }
            match folder.read(file.text) {
                Ok(read) => texts.push(SourceText::new(file.text, &read)),
                Err(reason) => {
                    let message = format!("`{}` is not included: {reason}", file.text);
                    findings.at(Fault::Include, &file, message);
                }
            }
        }
    }
    texts
}

fn included<'a>(element: Element<'a>) -> Option<Value<'a>> {
    (element.name() == "include").then(|| element.attribute("file"))?
}

/// The parsed files.
pub(crate) struct Files<'a> {
    roots: Vec<Element<'a>>,
}

impl<'a> Files<'a> {
    pub(crate) fn new(documents: &'a [Document<'a>], texts: &'a [SourceText]) -> Self {
        let pairs = documents.iter().zip(texts);
        let roots = pairs
            .map(|(document, text)| Element::root(document, text))
            .collect();
        Self { roots }
    }

    pub(crate) fn root(&self) -> Element<'a> {
        self.roots[0]
    }

    /// The child elements of an element; includes are replaced by the elements of the included
    /// files.
    pub(crate) fn children(
        &self,
        element: Element<'a>,
        findings: &mut Findings,
    ) -> Vec<Element<'a>> {
        let mut out = Vec::new();
        self.flatten(element, 0, &mut out, findings);
        out
    }

    fn flatten(
        &self,
        element: Element<'a>,
        depth: usize,
        out: &mut Vec<Element<'a>>,
        findings: &mut Findings,
    ) {
        for child in element.children() {
            if child.name() != "include" {
                out.push(child);
                continue;
            }
            let Some(file) = child.attribute("file") else {
                findings.missing(child, "a `file`");
                continue;
            };
            let root = self
                .roots
                .iter()
                .skip(1)
                .find(|root| root.source.name() == file.text);
            if let (Some(root), true) = (root, depth < DEEPEST) {
                self.flatten(*root, depth + 1, out, findings);
            }
        }
    }
}
