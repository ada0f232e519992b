//! Wrong scenes with the messages of `pfaff check`: `tests/wrong/*.toml`, each with one fault and a
//! remark on it, and the expected message in `*.txt`. Every message names the place and the
//! correction. `PFAFF_BLESS=1` rewrites the messages; read them before they are committed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{stderr, stdout};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/wrong");

/// The scenes, sorted by name.
fn scenes() -> Vec<PathBuf> {
    let entries = fs::read_dir(FOLDER).expect("readable").flatten();
    let files = entries.map(|entry| entry.path());
    let mut scenes: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    scenes.sort();
    scenes
}

#[test]
fn every_wrong_scene_has_its_text() {
    let scenes = scenes();
    assert!(scenes.len() >= 80, "{}", scenes.len());
    let bless = std::env::var_os("PFAFF_BLESS").is_some();
    let mut differing = Vec::new();
    for path in &scenes {
        let name = path.file_name().expect("a name");
        let output = Command::new(env!("CARGO_BIN_EXE_pfaff"))
            .arg("check")
            .arg(name)
            .current_dir(FOLDER)
            .output()
            .expect("the command starts");
        assert_eq!(
            (output.status.code(), &*stdout(&output)),
            (Some(2), ""),
            "{name:?}"
        );
        // Lines of the excerpt are padded with blanks.
        let said: String = stderr(&output)
            .lines()
            .map(|line| format!("{}\n", line.trim_end()))
            .collect();
        let golden = path.with_extension("txt");
        if bless {
            fs::write(&golden, &said).expect("writable");
        }
        let expected = fs::read_to_string(&golden)
            .unwrap_or_default()
            .replace("\r\n", "\n");
        if said != expected {
            differing.push(format!("{name:?} says\n{said}instead of\n{expected}"));
        }
    }
    assert!(
        differing.is_empty(),
        "PFAFF_BLESS=1 writes the texts anew\n{}",
        differing.join("\n")
    );
}

#[test]
fn no_text_is_without_its_scene() {
    for entry in fs::read_dir(FOLDER).expect("readable").flatten() {
        let path = entry.path();
        let is_text = path.extension().is_some_and(|end| end == "txt");
        assert!(
            !is_text || Path::new(&path.with_extension("toml")).exists(),
            "{}",
            path.display()
        );
    }
}
