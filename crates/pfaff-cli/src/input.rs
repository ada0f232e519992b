//! A scene file from the command line, or standard input.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use pfaff::model::codes::Code;
use pfaff::model::{Registry, Tolerance};
use pfaff::scene::{KeyError, Template, nearest};
use pfaff::{AssembledScene, Overrides, Study, StudyError};

use crate::args::{Known, Settings};
use crate::console::Console;
use crate::output::Failure;
use crate::resources::{Resources, Stage};

/// Largest scene that is read (bytes): ten times the size of a scene with a hundred thousand
/// bodies. An endless device must not fill the memory.
pub const LARGEST: u64 = 1 << 28;

const UNREADABLE: Code = Code::new(2);

/// Number of entries of a directory that are searched for a similar name.
const LOOKED_AT: usize = 10_000;

/// The text of a scene, its name in messages, and the tolerances of the command line.
pub(crate) struct Source<'r> {
    pub(crate) name: String,
    pub(crate) text: String,
    /// Takes precedence over the tolerance that the scene states.
    pub(crate) tolerance: Tolerance,
    /// The joints and forces that the scene may use.
    pub(crate) registry: &'r Registry,
}

impl<'r> Source<'r> {
    /// Reads a file, or standard input for `-`, with other numbers in it.
    pub(crate) fn read(
        path: &Path,
        settings: &Settings,
        console: &Console<'r>,
    ) -> Result<Self, Failure> {
        let (name, text) = text_of(path)?;
        Ok(Self {
            name,
            text: with_settings(text, settings)?,
            tolerance: Tolerance::default(),
            registry: console.registry,
        })
    }

    /// The same scene with numbers known to this.
    pub(crate) fn known(self, known: &Known) -> Self {
        Self {
            tolerance: known.into(),
            ..self
        }
    }

    /// Reads and assembles the scene, if the limits of the machine allow it.
    pub(crate) fn study(
        &self,
        overrides: &Overrides,
        resources: Resources,
    ) -> Result<Study, Failure> {
        resources.apply();
        let assembled = resources.assembled(self)?;
        let study = self.prepare(assembled, overrides);
        study.map_err(|e| self.failure(e))
    }

    /// Assembles a scene that was read from this text.
    pub(crate) fn prepare(
        &self,
        assembled: AssembledScene,
        overrides: &Overrides,
    ) -> Result<Study, StudyError> {
        let _said = Stage::begin(self, "assembling and choosing rows");
        assembled.prepare(overrides)
    }

    /// An error with its places in this text.
    pub(crate) fn failure(&self, error: StudyError) -> Failure {
        let code = error.code();
        let failure = match error {
            StudyError::SingularStart {
                place: Some(diagnostic),
                ..
            } => self.failure(StudyError::Scene(vec![*diagnostic])),
            StudyError::Scene(diagnostics) => Failure::Scene {
                name: self.name.clone(),
                text: self.text.clone(),
                diagnostics,
            },
            StudyError::NoEnd => Failure::input(format!(
                "{}: write one after `--t-end`, or after `--along`",
                StudyError::NoEnd
            )),
            other if other.is_input() => Failure::input(other.to_string()),
            other => Failure::stopped(other.to_string()),
        };
        failure.coded(code)
    }
}

/// The name in messages and the text of a file, or of standard input for `-`.
pub(crate) fn text_of(path: &Path) -> Result<(String, String), Failure> {
    let standard_input = path.as_os_str() == "-";
    let name = if standard_input {
        "<stdin>".to_owned()
    } else {
        path.display().to_string()
    };
    let bytes = if standard_input {
        bounded(std::io::stdin())
    } else {
        File::open(path).and_then(bounded)
    };
    let bytes = bytes.map_err(|e| unreadable(path, &e))?;
    if bytes.len() as u64 > LARGEST {
        let largest = LARGEST >> 20;
        let message = format!("`{name}` is too large for a scene: more than {largest} MiB");
        return Err(Failure::input(message).coded(UNREADABLE));
    }
    let text = String::from_utf8(bytes).map_err(|e| {
        let (line, column) = end_of(&e.as_bytes()[..e.utf8_error().valid_up_to()]);
        let message = format!("{name}:{line}:{column}: not UTF-8: save the file as UTF-8");
        Failure::input(message).coded(UNREADABLE)
    })?;
    Ok((name, text))
}

/// The text of a scene with other numbers in it. One that is not TOML stays as it is: its reader
/// says what is wrong.
fn with_settings(text: String, Settings { list }: &Settings) -> Result<String, Failure> {
    if list.is_empty() {
        return Ok(text);
    }
    let keys: Vec<&str> = list.iter().map(|set| set.key.as_str()).collect();
    let template = match Template::new(&text, &keys) {
        Ok(template) => template,
        Err(KeyError::NotToml) => return Ok(text),
        Err(e) => return Err(Failure::input(format!("--set: {e}")).coded(e.code())),
    };
    let expressions: Vec<&str> = list.iter().map(|set| set.expression.as_str()).collect();
    Ok(template.with_expressions(&expressions))
}

/// A file that cannot be read, with the scene in its directory that was probably meant.
pub fn unreadable(path: &Path, e: &io::Error) -> Failure {
    let name = if path.as_os_str() == "-" {
        "<stdin>".into()
    } else {
        path.display().to_string()
    };
    let near = match e.kind() {
        io::ErrorKind::NotFound => scene_beside(path),
        _ => None,
    };
    let advice = near.map_or_else(String::new, |near| {
        format!("; did you mean `{}`?", near.display())
    });
    Failure::input(format!("cannot read `{name}`: {e}{advice}")).coded(UNREADABLE)
}

/// The scene in the directory of a path whose name is nearest to that of the path.
fn scene_beside(path: &Path) -> Option<PathBuf> {
    let directory = match path.parent() {
        Some(parent) if parent.as_os_str() != "" => parent,
        _ => Path::new("."),
    };
    let entries = fs::read_dir(directory).ok()?.take(LOOKED_AT).flatten();
    let scenes = entries.map(|entry| PathBuf::from(entry.file_name()));
    let scenes = scenes.filter(|file| file.extension().is_some_and(|end| end == "toml"));
    let stem = |file: &Path| Some(file.file_stem()?.to_str()?.to_owned());
    let mut stems: Vec<String> = scenes.filter_map(|file| stem(&file)).collect();
    // The system lists a directory in no defined order.
    stems.sort_unstable();
    let near = nearest(&stem(path)?, stems.iter().map(String::as_str))?;
    Some(path.with_file_name(format!("{near}.toml")))
}

/// The error for an unknown name, with the name that was probably meant and the known names.
pub fn unknown(what: &str, name: &str, known: &[&str]) -> Failure {
    let near = nearest(name, known.iter().copied());
    let advice = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    Failure::input(format!(
        "there is no {what} `{name}`; there are: {}{advice}",
        known.join(", ")
    ))
}

/// Reads all bytes, but at most one more than a scene may have.
fn bounded(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(LARGEST + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Line and column just after the last valid character of a text, both from 1.
fn end_of(text: &[u8]) -> (usize, usize) {
    let text = String::from_utf8_lossy(text);
    let last = text.rsplit('\n').next().unwrap_or_default();
    (text.matches('\n').count() + 1, last.chars().count() + 1)
}

/// Rows counted from 0, from the user's rows counted from 1.
pub(crate) fn rows_from_zero(rows: Option<&[usize]>) -> Result<Option<Vec<usize>>, Failure> {
    let Some(rows) = rows else { return Ok(None) };
    let from_zero: Option<Vec<usize>> = rows.iter().map(|r| r.checked_sub(1)).collect();
    match from_zero {
        Some(rows) => Ok(Some(rows)),
        None => Err(Failure::input(
            "rows are counted from 1; there is no row 0".to_owned(),
        )),
    }
}
