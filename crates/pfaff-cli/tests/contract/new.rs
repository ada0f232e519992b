//! Tests `pfaff new`: the templates are the examples, and no existing file is overwritten.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{Folder, pfaff, stderr, stdout, with_scene};

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");

fn place(name: &str) -> Folder {
    let folder = Folder::new(name);
    fs::create_dir_all(&folder.0).expect("writable");
    folder
}

/// Returns the names of templates, as the command lists them.
fn templates() -> Vec<String> {
    let output = pfaff(&["new", "--json"]);
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let list = document["templates"].as_array().expect("templates");
    for template in list {
        assert!(
            template["summary"]
                .as_str()
                .is_some_and(|text| text.len() > 10),
            "{template}"
        );
    }
    let names = list.iter().filter_map(|t| t["name"].as_str());
    names.map(str::to_owned).collect()
}

#[test]
fn every_example_is_a_template_and_every_template_is_judged() {
    let mut expected = vec!["robot-trolley".to_owned()];
    for entry in fs::read_dir(EXAMPLES).expect("readable").flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|end| end == "toml") {
            let stem = path.file_stem().and_then(|s| s.to_str()).expect("UTF-8");
            expected.push(stem.to_owned());
        }
    }
    let mut names = templates();
    for name in &names {
        let written = pfaff(&["new", name, "--out", "-"]);
        assert_eq!(written.status.code(), Some(0), "{}", stderr(&written));
        let scene = stdout(&written);
        assert!(
            scene.starts_with(&format!("# Begun with `pfaff new {name}`.")),
            "{scene}"
        );
        assert!(scene.contains("#:schema ./pfaff.schema.json"));
        let checked = with_scene(&["check", "-"], &scene);
        assert_eq!(
            checked.status.code(),
            Some(0),
            "{name}: {}",
            stderr(&checked)
        );
    }
    names.sort();
    expected.sort();
    assert_eq!(names, expected);
}

#[test]
fn the_list_is_for_people_too() {
    let output = pfaff(&["new"]);
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
    let text = stdout(&output);
    assert!(
        text.contains("door") && text.contains("A door leaf, seen from the front"),
        "{text}"
    );
    assert!(
        text.ends_with("`pfaff new TEMPLATE` writes one\n"),
        "{text}"
    );
}

#[test]
fn a_file_that_is_there_is_kept() {
    let folder = place("new-kept");
    let file = folder.0.join("mine.toml");
    let path = file.to_str().expect("UTF-8");
    let output = pfaff(&["new", "sleigh", "--out", path]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(
        stdout(&output),
        format!("written to {path}\nnext: pfaff analyze {path}\n")
    );
    let scene = folder.read("mine.toml");
    assert!(
        scene.contains(
            &fs::read_to_string(Path::new(EXAMPLES).join("sleigh.toml")).expect("readable")
        )
    );

    fs::write(&file, "mine").expect("writable");
    let again = pfaff(&["new", "sleigh", "--out", path]);
    assert_eq!((again.status.code(), &*stdout(&again)), (Some(2), ""));
    assert_eq!(
        stderr(&again),
        format!(
            "error[P0003]: `{path}` exists already; use --force to replace it, or --out for another file\n"
        )
    );
    assert_eq!(folder.read("mine.toml"), "mine");
    let forced = pfaff(&["new", "sleigh", "--out", path, "--force", "--json"]);
    let document: Value = serde_json::from_slice(&forced.stdout).expect("JSON");
    assert_eq!(document["file"], path);
    assert_eq!(folder.read("mine.toml"), scene);
}

#[test]
fn wrong_orders_are_refused_with_one_message() {
    for (arguments, message) in [
        (&["new", "dor"][..], "tip: a similar value exists: 'door'"),
        (&["new", "--force"], "<TEMPLATE>"),
        (
            &["new", "door", "--out", "no/such/directory/door.toml"],
            "its directory does not exist",
        ),
        (&["new", "door", "--out", "-", "--json"], ""),
    ] {
        let output = pfaff(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            stderr(&output).contains(message),
            "{arguments:?}: {}",
            stderr(&output)
        );
    }
}
