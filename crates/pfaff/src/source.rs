//! Texts of files, whether or not they are scenes.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use model::Registry;
use model::codes::Code;
use scene::{LoadCase, Scene, Setting, nearest};

use crate::refusal::Refusal;

/// Size of the largest scene that is read (bytes). It is ten times the size of a scene with a
/// hundred thousand bodies. Because of this limit, an endless device cannot fill the memory.
pub const LARGEST: u64 = 1 << 28;

const UNREADABLE: Code = Code::new(2);

/// Number of entries of a directory that are searched for a similar name.
const LOOKED_AT: usize = 10_000;

/// Returns the name in messages and the text of a file.
///
/// # Errors
/// Returns an error if the file cannot be read, is too large for a scene, or is not UTF-8. For an
/// unreadable file, the error suggests a file in the same directory with a similar name.
pub fn of_file(path: &Path) -> Result<(String, String), Refusal> {
    let name = path.display().to_string();
    let bytes = File::open(path).and_then(bounded);
    let bytes = bytes.map_err(|e| unreadable(path, &e))?;
    Ok((name.clone(), text(&name, bytes)?))
}

/// Returns the text of a stream with this name in messages.
///
/// # Errors
/// Returns the errors of [`of_file`].
pub fn of_stream(name: &str, stream: impl Read) -> Result<String, Refusal> {
    let bytes = bounded(stream).map_err(|e| unread(name, &e, ""))?;
    text(name, bytes)
}

fn text(name: &str, bytes: Vec<u8>) -> Result<String, Refusal> {
    if bytes.len() as u64 > LARGEST {
        let largest = LARGEST >> 20;
        let message = format!("`{name}` is too large for a scene: more than {largest} MiB");
        return Err(Refusal::input(message).coded(UNREADABLE));
    }
    String::from_utf8(bytes).map_err(|e| {
        let (line, column) = end_of(&e.as_bytes()[..e.utf8_error().valid_up_to()]);
        let message = format!("{name}:{line}:{column}: not UTF-8: save the file as UTF-8");
        Refusal::input(message).coded(UNREADABLE)
    })
}

/// Builds the error for a file that cannot be read. The error suggests a scene in the same
/// directory with a similar name.
#[must_use]
pub fn unreadable(path: &Path, e: &io::Error) -> Refusal {
    let near = match e.kind() {
        io::ErrorKind::NotFound => scene_beside(path),
        _ => None,
    };
    let advice = near.map_or_else(String::new, |near| {
        format!("; did you mean `{}`?", near.display())
    });
    unread(&path.display().to_string(), e, &advice)
}

fn unread(name: &str, e: &io::Error, advice: &str) -> Refusal {
    Refusal::input(format!("cannot read `{name}`: {e}{advice}")).coded(UNREADABLE)
}

/// Finds a scene in the directory of a path. The name of this scene is the name most similar to the
/// file name of the path.
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

/// Reads all bytes, but at most one byte more than the limit for a scene.
fn bounded(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(LARGEST + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Returns the line and the column after the last valid character of a text (both 1-based).
fn end_of(text: &[u8]) -> (usize, usize) {
    let text = String::from_utf8_lossy(text);
    let last = text.rsplit('\n').next().unwrap_or_default();
    (text.matches('\n').count() + 1, last.chars().count() + 1)
}

/// Returns the text of a scene with the values of one of its load cases. A text that is not a valid
/// scene remains unchanged, because the reader of scenes reports the errors of the text.
///
/// # Errors
/// [`Refusal::Input`]: the scene has no such case.
pub fn with_case(text: String, case: &str, registry: &Registry) -> Result<String, Refusal> {
    match scene::read("", &text, registry) {
        Ok(scene) => with_values_of(&text, case_of(&scene, case)?),
        Err(_) => Ok(text),
    }
}

/// Returns the load cases of a scene with these names, in the order of the scene. If there are no
/// names, returns all cases.
///
/// # Errors
/// [`Refusal::Input`]: the scene has no load cases, or a name does not exist.
pub fn cases<'s>(scene: &'s Scene, names: &[String]) -> Result<Vec<&'s LoadCase>, Refusal> {
    for name in names {
        case_of(scene, name)?;
    }
    if scene.cases.is_empty() {
        return Err(no_cases());
    }
    let is_wanted = |case: &&LoadCase| names.is_empty() || names.contains(&case.name);
    Ok(scene.cases.iter().filter(is_wanted).collect())
}

/// Returns the text of a scene with the values of a load case.
///
/// # Errors
/// [`Refusal::Input`]: the values cannot be written to the text.
pub fn with_values_of(text: &str, case: &LoadCase) -> Result<String, Refusal> {
    let replaced = Setting::replaced(text, &case.settings);
    replaced.map_err(|e| Refusal::input(format!("case `{}`: {e}", case.name)).coded(e.code()))
}

fn case_of<'s>(scene: &'s Scene, case: &str) -> Result<&'s LoadCase, Refusal> {
    if let Some(found) = scene.cases.iter().find(|own| own.name == case) {
        return Ok(found);
    }
    if scene.cases.is_empty() {
        return Err(no_cases());
    }
    let names: Vec<&str> = scene.cases.iter().map(|case| case.name.as_str()).collect();
    Err(unknown("load case", case, &names))
}

fn no_cases() -> Refusal {
    Refusal::input("the scene has no load cases; add `[[case]]` to it".to_owned())
}

/// Builds the error for an unknown name, with the most similar known name and a list of the known
/// names.
#[must_use]
pub fn unknown(what: &str, name: &str, known: &[&str]) -> Refusal {
    let near = nearest(name, known.iter().copied());
    let advice = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    Refusal::input(format!(
        "there is no {what} `{name}`; there are: {}{advice}",
        known.join(", ")
    ))
}
