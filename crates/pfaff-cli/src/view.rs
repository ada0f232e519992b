//! `pfaff view`: writes a page of the assembled start, or its picture as SVG, and opens it in the
//! system's viewer.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use pfaff::model::System;
use pfaff::report::documents::ViewDocument;
use pfaff::report::figures::{Labels, Marking, labelled_mechanism};
use pfaff::report::{FileError, Frame, Recording, RunPage, Shows, is_ours, replace_file, run_page};

use crate::args::View;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, count, unwritten};
use crate::simulate::origin;
use crate::start::Start;

pub(crate) fn run(arguments: &View, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let path = place(arguments)?;
    if !arguments.force && !is_ours(&path) {
        return Err(unwritten(&FileError::Foreign { paths: vec![path] }));
    }
    arguments.resources.apply();
    let start = Start::of(&source, arguments.resources)?;
    let picture = if is_svg(&path) {
        let marking = Marking::Verdicts(&start.reactions);
        labelled_mechanism(
            &start.mechanism,
            0.0,
            &start.q,
            marking,
            Labels::NamesAndRows,
        )
        .map_err(|e| Failure::stopped(e.to_string()))?
    } else {
        page(&start)
    };
    replace_file(&path, picture.as_bytes()).map_err(|e| unwritten(&e))?;
    let open = start
        .document
        .reactions
        .iter()
        .filter(|r| r.wrench.verdict == "not_unique")
        .count();
    let fragile = start.document.fragile_reactions().count();
    if arguments.json {
        return console.document(&ViewDocument {
            ok: true,
            scene: start.scene.name(),
            file: path.display().to_string(),
            bytes: picture.len(),
            reactions: start.reactions.len(),
            not_unique: open,
            fragile,
            mobility: start.document.ranks.mobility,
            mobility_without_drives: start.document.ranks.freedoms.mobility_without_drives(),
        });
    }
    let opened = if arguments.no_open {
        String::new()
    } else {
        let refused = show(&path).err();
        refused.map_or_else(String::new, |reason| format!("not opened: {reason}\n"))
    };
    let fragile = match fragile {
        0 => String::new(),
        n => format!(", {n} unique but FRAGILE"),
    };
    console.print(&format!(
        "{}: {}, {open} not unique{fragile}; {}\nwritten to {}\n{opened}",
        start.scene.name(),
        count(start.reactions.len(), "joint or drive", "joints and drives"),
        start
            .document
            .ranks
            .freedoms
            .summary(start.document.ranks.mobility),
        path.display()
    ))
}

/// The page of a run that consists of the start only.
fn page(start: &Start) -> String {
    let mut recording = Recording::new(0.0, 1.0, 1);
    let frame = Frame::at_rest(0.0, &start.q, start.mechanism.layout().n_v);
    recording.frames.push(frame);
    run_page(&RunPage {
        mechanism: &start.mechanism,
        analysis: Some(&start.document),
        hints: &[],
        shows: Shows::Start,
        recording: &recording,
        comparisons: &[],
        drives: &[],
        origin: &origin(),
        scene: pfaff::written_scene(&start.scene),
        options: &[],
        left_out: &[],
        work_precision: None,
    })
}

fn is_svg(path: &Path) -> bool {
    let end = path.extension();
    end.is_some_and(|end| end.eq_ignore_ascii_case("svg"))
}

/// The path of the file for the picture.
fn place(arguments: &View) -> Result<PathBuf, Failure> {
    let scene = &arguments.scene;
    let Some(path) = &arguments.out else {
        let stem = scene.file_stem().filter(|_| scene.as_os_str() != "-");
        return Ok(Path::new(stem.unwrap_or("scene".as_ref())).with_extension("html"));
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
        Some(end) if end.eq_ignore_ascii_case("html") => Ok(path.clone()),
        _ if is_svg(path) => Ok(path.clone()),
        _ => refused("need a name that ends with .html or .svg"),
    }
}

/// Opens a file with the system's program for such files, without waiting for it.
fn show(path: &Path) -> Result<(), String> {
    let (program, before): (_, &[&str]) = match env::consts::OS {
        "macos" => ("open", &[]),
        // The first quoted word would be taken as the title of a window.
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
