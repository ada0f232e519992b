//! `pfaff view`: the assembled start as a picture, and the system's viewer for it.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use pfaff::report::figures::{Labels, Marking, labelled_mechanism};
use serde_json::json;

use crate::args::View;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, count};
use crate::start::Start;

pub(crate) fn run(arguments: &View, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source = Source::read(&arguments.scene, console)?.known(arguments.known);
    let path = place(arguments)?;
    arguments.resources.apply()?;
    let start = Start::of(&source, arguments.resources)?;
    let marking = Marking::Verdicts(&start.reactions);
    let svg = labelled_mechanism(
        &start.mechanism,
        0.0,
        &start.q,
        marking,
        Labels::NamesAndRows,
    )
    .map_err(|e| Failure::stopped(e.to_string()))?;
    fs::write(&path, &svg)
        .map_err(|e| Failure::input(format!("cannot write `{}`: {e}", path.display())))?;
    let open = start
        .document
        .reactions
        .iter()
        .filter(|r| r.wrench.verdict == "not_unique")
        .count();
    let fragile = start.document.fragile_reactions().count();
    if arguments.json {
        let facts = json!({
            "ok": true,
            "scene": start.scene.name(),
            "file": path.display().to_string(),
            "bytes": svg.len(),
            "reactions": start.reactions.len(),
            "not_unique": open,
            "fragile": fragile,
            "mobility": start.document.mobility,
            "mobility_without_drives": start.document.freedoms.mobility_without_drives(),
        });
        return console.print(&format!("{facts:#}\n"));
    }
    let opened = match arguments.no_open {
        true => String::new(),
        false => match show(&path) {
            Ok(()) => String::new(),
            Err(reason) => format!("not opened: {reason}\n"),
        },
    };
    let fragile = match fragile {
        0 => String::new(),
        n => format!(", {n} unique but FRAGILE"),
    };
    console.print(&format!(
        "{}: {}, {open} not unique{fragile}; {}\nwritten to {}\n{opened}",
        start.scene.name(),
        count(start.reactions.len(), "joint or drive", "joints and drives"),
        start.document.freedoms.summary(start.document.mobility),
        path.display()
    ))
}

/// Where the picture goes.
fn place(arguments: &View) -> Result<PathBuf, Failure> {
    let scene = &arguments.scene;
    let Some(path) = &arguments.out else {
        let stem = match scene.as_os_str() == "-" {
            true => None,
            false => scene.file_stem(),
        };
        return Ok(Path::new(stem.unwrap_or("scene".as_ref())).with_extension("svg"));
    };
    let refused = |what: &str| {
        Err(Failure::input(format!(
            "--out is `{}`, {what}",
            path.display()
        )))
    };
    if path.is_dir() {
        return refused("a directory, need a file");
    }
    match path.extension() {
        Some(end) if end.eq_ignore_ascii_case("svg") => Ok(path.clone()),
        _ => refused("need a name that ends with .svg"),
    }
}

/// Opens a file with what the system opens such files with, and does not wait for it.
fn show(path: &Path) -> Result<(), String> {
    let (program, before): (_, &[&str]) = match env::consts::OS {
        "macos" => ("open", &[]),
        // The first word in quotes would be the title of a window.
        "windows" => ("cmd", &["/C", "start", ""]),
        _ if !has_display() => return Err("there is no display".to_owned()),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    command.args(before).arg(path);
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    match command.spawn() {
        Ok(_) => Ok(()),
        Err(e) => Err(format!("cannot start `{program}`: {e}")),
    }
}

fn has_display() -> bool {
    let is_set = |name: &str| env::var_os(name).is_some_and(|value| !value.is_empty());
    is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}
