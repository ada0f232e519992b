//! Tests of files written for this project as scenes, and of files that are rejected.

mod details;
mod drives;
mod extensions;
mod fuzz;
mod hostile;
mod mistakes;
mod mjcf;
mod models;
mod poses;
mod sdf;
mod shapes;
mod urdf;

use model::Registry;
use pfaff_import::{Folder, ImportedScene, Options, Refusal};
use scene::Scene;

/// Returns a file of this folder.
fn text_of(file: &str) -> String {
    let path = path_of(file);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn path_of(file: &str) -> String {
    format!("{}/tests/all/{file}", env!("CARGO_MANIFEST_DIR"))
}

fn options_of(file: &str) -> Options {
    let folder = Folder::of(std::path::Path::new(&path_of(file)));
    Options {
        folder,
        ..Options::default()
    }
}

/// Imports a file of this folder as a scene.
fn imported(file: &str) -> ImportedScene {
    let done = pfaff_import::import(file, &text_of(file), &options_of(file));
    done.unwrap_or_else(|refusal| panic!("{file}: {:?}", refusal.diagnostics))
}

fn refused(text: &str) -> Refusal {
    let done = pfaff_import::import("file.xml", text, &Options::default());
    *done.err().unwrap_or_else(|| panic!("imported: {text}"))
}

/// Returns the scene as the reader of scenes reads it.
fn read(imported: &ImportedScene) -> Scene {
    let read = scene::read("imported.toml", &imported.scene, &Registry::standard());
    read.unwrap_or_else(|e| panic!("{e:?}\n{}", imported.scene))
}

/// Returns code, line and message of the first problem.
fn first(refusal: &Refusal) -> (String, usize, String) {
    let problem = &refusal.diagnostics[0];
    (
        problem.code.to_string(),
        problem.primary.line,
        problem.message.clone(),
    )
}

/// Returns the value of a key of a table of a scene, as text.
fn value(scene: &str, table: &str, name: &str, key: &str) -> Option<String> {
    let head = format!("[[{table}]]\nname = \"{name}\"\n");
    let (_, rest) = scene.split_once(&head)?;
    let own = rest.split("\n\n").next()?;
    let line = own
        .lines()
        .find_map(|line| line.strip_prefix(&format!("{key} = ")))?;
    Some(line.to_owned())
}

/// Returns the numbers of a list.
fn numbers(list: &str) -> Vec<f64> {
    let (_, rest) = list.split_once('[').expect("a list");
    let (inner, _) = rest.split_once(']').expect("a list");
    inner
        .split(", ")
        .map(|x| x.parse().expect("a number"))
        .collect()
}

/// Returns an MJCF file with one body around the given text, which is in line 4.
fn body(inner: &str) -> String {
    format!("<mujoco>\n<worldbody>\n<body name='b'>\n{inner}\n</body>\n</worldbody>\n</mujoco>")
}

/// Imports a text as a scene.
fn import_text(text: &str, options: &Options) -> ImportedScene {
    let done = pfaff_import::import("file.xml", text, options);
    done.unwrap_or_else(|refusal| panic!("{:?}", refusal.diagnostics))
}

/// Returns the values of a pose.
fn pose(values: &[(&str, f64)]) -> Vec<(String, f64)> {
    let own = values.iter().map(|(name, q)| ((*name).to_owned(), *q));
    own.collect()
}

/// Returns the angle of a body about y.
fn about_y(scene: &str, body: &str) -> f64 {
    let turned = value(scene, "body", body, "orientation").expect("turned");
    let (_, q) = turned.split_once("quaternion = ").expect("a quaternion");
    let q = numbers(q);
    2.0 * q[2].atan2(q[0])
}
