//! The public API of each published crate, as text: everything that a user of the crate can name.
//! The text makes every change of the API visible in a review. A test compares text and code.

mod module;
mod public;

use std::fs;
use std::path::{Path, PathBuf};

use crate::tree::root;
use module::Module;
use public::Public;

/// Folder of the texts, one for each library.
const FOLDER: &str = "docs/api";

/// A published library: its name and the folder of its package.
struct Library {
    name: String,
    folder: PathBuf,
}

/// Writes the texts.
pub(crate) fn write() -> Result<String, String> {
    let folder = root().join(FOLDER);
    fs::create_dir_all(&folder).map_err(|e| format!("{FOLDER}: {e}"))?;
    let libraries = libraries(&root())?;
    for library in &libraries {
        let path = folder.join(format!("{}.txt", library.name));
        fs::write(&path, text(library)?).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(format!("{} texts written to {FOLDER}", libraries.len()))
}

/// Compares the texts with the code.
pub(crate) fn check() -> Result<String, String> {
    let libraries = libraries(&root())?;
    for library in &libraries {
        let path = root().join(FOLDER).join(format!("{}.txt", library.name));
        let told = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let is = text(library)?;
        if told.replace("\r\n", "\n") != is {
            let difference = is.lines().zip(told.lines()).find(|(is, told)| is != told);
            let (is, told) = difference.unwrap_or(("more lines or fewer", "the text"));
            return Err(format!(
                "the public API of `{}` differs from the list in {FOLDER}: `{}`, recorded as `{}`; if the change is intended, `cargo xtask api` updates the list",
                library.name,
                is.trim(),
                told.trim()
            ));
        }
    }
    Ok(format!(
        "{} public APIs agree with the recorded lists",
        libraries.len()
    ))
}

/// The packages under `crates/` that are published and have a library.
fn libraries(root: &Path) -> Result<Vec<Library>, String> {
    let mut libraries = Vec::new();
    let crates = root.join("crates");
    let entries = fs::read_dir(&crates).map_err(|e| format!("{}: {e}", crates.display()))?;
    for entry in entries {
        let folder = entry.map_err(|e| e.to_string())?.path();
        let Ok(manifest) = fs::read_to_string(folder.join("Cargo.toml")) else {
            continue;
        };
        let is_published = manifest.lines().any(|line| line == "publish = true");
        let is_macro = manifest.contains("proc-macro = true");
        let name = manifest
            .lines()
            .find_map(|line| line.strip_prefix("name = "));
        if let (true, false, Some(name)) = (is_published, is_macro, name) {
            libraries.push(Library {
                name: name.trim_matches('"').to_owned(),
                folder,
            });
        }
    }
    libraries.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(libraries)
}

fn text(library: &Library) -> Result<String, String> {
    let root = Module::read(&library.folder.join("src/lib.rs"))?;
    let public = Public::of(&root);
    Ok(format!(
        "// The public API of `{}`, written by `cargo xtask api`: without bodies, documentation, and items that only a macro writes.\n\n{}",
        library.name,
        public.text()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn public_apis_are_as_told() {
        assert_eq!(check().err(), None);
    }

    fn told(source: &str) -> String {
        let file = syn::parse_str(source).expect("Rust");
        Public::of(&Module::inline(file)).text()
    }

    #[test]
    fn what_cannot_be_named_is_left_out() {
        let text = told(
            "mod inner { pub struct Kept { pub x: f64, y: u8 } pub struct Hidden; \
             impl Kept { pub fn sum(&self) -> f64 { 1.0 } fn own(&self) {} } \
             impl Clone for Kept { fn clone(&self) -> Self { todo!() } } } \
             pub use inner::Kept as Renamed; pub(crate) fn none() {} \
             #[cfg(test)] pub fn test() {} /// Said.\npub const C: u8 = 3;",
        );
        for part in [
            "pub struct Kept",
            "pub x: f64",
            "pub fn sum(&self) -> f64",
            "impl Clone for Kept",
        ] {
            assert!(text.contains(part), "`{part}` is not in\n{text}");
        }
        for part in ["Hidden", "y: u8", "own", "none", "test", "Said", "todo"] {
            assert!(!text.contains(part), "`{part}` is in\n{text}");
        }
        assert!(text.contains("// as Renamed"), "{text}");
    }

    #[test]
    fn modules_and_names_of_others_are_told_by_their_paths() {
        let text = told(
            "pub mod a { pub mod b { pub fn f<T: Ord>(x: &[T]) -> usize { 0 } } } pub use other::Thing;",
        );
        assert!(text.contains("// crate::a::b"), "{text}");
        assert!(
            text.contains("pub fn f<T: Ord>(x: &[T]) -> usize"),
            "{text}"
        );
        assert!(text.contains("pub use other::Thing;"), "{text}");
    }
}
