//! The files of a model: the given file and its included files, which must be in the same folder.

mod uris;

use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};

use roxmltree::Document;
use scene::SourceText;

use crate::findings::{Fault, Findings};
use crate::limits::{DEEPEST, LARGEST, MOST_FILES};
use crate::xml::{Element, Value, parse};
pub(crate) use uris::{IncludeProblem, version_of};

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

    /// The path of a file or folder in the folder, or the reason why it cannot be used.
    fn path_of(&self, name: &str) -> Result<PathBuf, String> {
        let Self::At(folder) = self else {
            return Err("files are included only into a file, not into standard input".to_owned());
        };
        let path = Path::new(name);
        let stays = path
            .components()
            .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !stays || name.is_empty() {
            return Err(OUTSIDE.to_owned());
        }
        let told = |e: std::io::Error| format!("it cannot be read: {e}");
        let root = folder.canonicalize().map_err(told)?;
        let path = folder.join(path).canonicalize().map_err(told)?;
        if !path.starts_with(&root) {
            return Err(OUTSIDE.to_owned());
        }
        Ok(path)
    }

    /// Returns the text of a file in the folder, or the reason why the file cannot be read.
    fn read(&self, name: &str) -> Result<String, String> {
        let told = |e: std::io::Error| format!("it cannot be read: {e}");
        let path = self.path_of(name)?;
        let size = std::fs::metadata(&path).map_err(told)?;
        if !size.is_file() || size.len() > LARGEST as u64 {
            return Err(format!("it is not a file of at most {LARGEST} bytes"));
        }
        std::fs::read_to_string(&path).map_err(told)
    }

    fn is_folder(&self, name: &str) -> bool {
        self.path_of(name).is_ok_and(|path| path.is_dir())
    }
}

const OUTSIDE: &str = "it is outside of the folder of the file";

/// The texts of all files, starting with the given file.
pub(crate) struct Texts {
    pub(crate) all: Vec<SourceText>,
    uris: Uris,
}

/// The number of the text for each URI in each text of SDF, or the reason why the URI does not lead
/// to a text.
type Uris = HashMap<(usize, String), Result<usize, IncludeProblem>>;

/// Reads the given file and all included files.
pub(crate) fn load(source: SourceText, folder: &Folder, findings: &mut Findings) -> Texts {
    let mut texts = Texts {
        all: vec![source],
        uris: HashMap::new(),
    };
    let mut at = 0;
    while at < texts.all.len() {
        let (number, text) = (at, texts.all[at].clone());
        at += 1;
        let Ok(document) = parse(&text) else { continue };
        let mut stack = vec![Element::root(&document, &text)];
        let is_sdf = stack.iter().any(|root| root.name() == "sdf");
        while let Some(element) = stack.pop() {
            stack.extend(element.children());
            if element.name() != "include" {
                continue;
            }
            let goes_on = if is_sdf {
                texts.find(number, element, folder);
                true
            } else {
                texts.add(element, folder, findings).is_some()
            };
            if !goes_on {
                return texts;
            }
        }
    }
    texts
}

impl Texts {
    /// Adds the file of an `<include>` of MJCF. The result is `None` if there are too many files.
    fn add(&mut self, element: Element, folder: &Folder, findings: &mut Findings) -> Option<()> {
        let Some(file) = element.attribute("file") else {
            return Some(());
        };
        if self.number_of(file.text).is_some() {
            let message = format!("`{}` is included twice", file.text);
            findings.at(Fault::Include, &file, message);
            return Some(());
        }
        if self.all.len() > MOST_FILES {
            findings.at(Fault::Include, &file, too_many());
            return None;
        }
        match folder.read(file.text) {
            Ok(read) => self.all.push(SourceText::new(file.text, &read)),
            Err(reason) => {
                let message = format!("`{}` is not included: {reason}", file.text);
                findings.at(Fault::Include, &file, message);
            }
        }
        Some(())
    }

    /// Finds the file of an `<include>` of SDF. A file may be included several times, so the reader
    /// of the format reports a URI without a file only if it uses the element.
    fn find(&mut self, number: usize, element: Element, folder: &Folder) {
        let Some(uri) = element.text_of("uri") else {
            return;
        };
        let key = (number, uri.text.to_owned());
        if self.uris.contains_key(&key) {
            return;
        }
        // The given file is in the folder itself.
        let from = if number == 0 {
            ""
        } else {
            element.source.name()
        };
        let found = self.text_at(from, uri.text, folder);
        self.uris.insert(key, found);
    }

    fn text_at(&mut self, from: &str, uri: &str, folder: &Folder) -> Result<usize, IncludeProblem> {
        let name = uris::file_of(from, uri, folder)?;
        if let Some(number) = self.number_of(&name) {
            return Ok(number);
        }
        if self.all.len() > MOST_FILES {
            return Err(IncludeProblem::new(too_many()));
        }
        let read = folder.read(&name).map_err(IncludeProblem::new)?;
        self.all.push(SourceText::new(&name, &read));
        Ok(self.all.len() - 1)
    }

    /// The number of an included file.
    fn number_of(&self, name: &str) -> Option<usize> {
        let mut all = self.all.iter().enumerate().skip(1);
        all.find(|(_, text)| text.name() == name)
            .map(|(number, _)| number)
    }
}

fn too_many() -> String {
    format!("more than {MOST_FILES} files are included")
}

/// The parsed files.
pub(crate) struct Files<'a> {
    roots: Vec<Element<'a>>,
    uris: &'a Uris,
}

impl<'a> Files<'a> {
    pub(crate) fn new(documents: &'a [Document<'a>], texts: &'a Texts) -> Self {
        let pairs = documents.iter().zip(&texts.all);
        let roots = pairs
            .map(|(document, text)| Element::root(document, text))
            .collect();
        let uris = &texts.uris;
        Self { roots, uris }
    }

    pub(crate) fn root(&self) -> Element<'a> {
        self.roots[0]
    }

    /// The root of the file to which the URI of an `<include>` of SDF leads.
    pub(crate) fn of_uri(&self, uri: &Value) -> Result<Element<'a>, IncludeProblem> {
        let mut roots = self.roots.iter();
        let number = roots.position(|root| std::ptr::eq(root.source, uri.source));
        let found = number.and_then(|number| self.uris.get(&(number, uri.text.to_owned())));
        match found {
            Some(Ok(number)) => Ok(self.roots[*number]),
            Some(Err(reason)) => Err(reason.clone()),
            None => Err(IncludeProblem::new(too_many())),
        }
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
