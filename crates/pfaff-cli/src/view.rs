//! `pfaff view`: writes a page of the assembled start, or its picture as SVG or PNG, and opens it
//! in the system's viewer.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use pfaff::ConfigurationAnalysis;
use pfaff::model::System;
use pfaff::question::Control;
use pfaff::report::AnalysisDocument;
use pfaff::report::documents::ViewDocument;
use pfaff::report::figures::{Labels, Marking, labelled_mechanism, png};
use pfaff::report::{Frame, OutputDirectory, Recording, Replaces, RunPage, Shows, run_page};

use crate::args::View;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, count, write_file};
use crate::picture::{can_paint, missing, unpainted};
use crate::provenance::origin;
use pfaff::start::document_of;

pub(crate) fn run(arguments: &View, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let (path, form) = place(arguments)?;
    if form == Form::Png {
        can_paint(arguments.scale)?;
    }
    let replaces = if arguments.force {
        Replaces::Files
    } else {
        Replaces::Ours
    };
    // Before anything is computed, too.
    OutputDirectory::around(&path, replaces)?;
    arguments.resources.apply(console);
    let scene = source.start(arguments.resources);
    let judged = scene.judged(&Control::quiet())?;
    let start = scene
        .configuration(&judged, |_| ())
        .map_err(|e| scene.refusal(e))?;
    let document = document_of(&start).map_err(|e| scene.refusal(e))?;
    let (mut pixels, mut boxes) = (None, String::new());
    let content = match form {
        Form::Page => page(&start, &document).into_bytes(),
        Form::Svg => figure(&start)?.into_bytes(),
        Form::Png => {
            let painted = png(&figure(&start)?, arguments.scale).map_err(|e| unpainted(&e))?;
            (pixels, boxes) = (Some(painted.pixels), painted.boxes);
            painted.bytes
        }
    };
    write_file(&path, &content, replaces)?;
    let open = document
        .reactions
        .iter()
        .filter(|r| r.wrench.verdict == "not_unique")
        .count();
    let fragile = document.fragile_reactions().count();
    if arguments.json {
        return console.document(&ViewDocument {
            ok: true,
            scene: start.scene.name(),
            file: path.display().to_string(),
            bytes: content.len(),
            pixels,
            boxes: &boxes,
            reactions: start.analysis.reactions.len(),
            not_unique: open,
            fragile,
            mobility: document.ranks.mobility,
            mobility_without_drives: document.ranks.freedoms.mobility_without_drives(),
        });
    }
    let opened = if arguments.no_open {
        String::new()
    } else {
        let refused = show(&path).err();
        refused.map_or_else(String::new, |reason| format!("not opened: {reason}\n"))
    };
    let whole = document.fragile_reactions();
    let whole = whole.filter(|r| r.wrench.verdict == "unique").count();
    let fragile = match (whole, fragile - whole) {
        (0, 0) => String::new(),
        (n, 0) => format!(", {n} unique but FRAGILE"),
        (0, n) => format!(", {n} with FRAGILE components"),
        (whole, n) => format!(", {whole} unique but FRAGILE, {n} with FRAGILE components"),
    };
    let boxes = missing(&boxes);
    console.print(&format!(
        "{}: {}, {open} not unique{fragile}; {}\nwritten to {}\n{boxes}{opened}",
        start.scene.name(),
        count(
            start.analysis.reactions.len(),
            "joint or drive",
            "joints and drives"
        ),
        document.ranks.freedoms.summary(document.ranks.mobility),
        path.display()
    ))
}

/// The picture of the start as SVG.
fn figure(start: &ConfigurationAnalysis<'_>) -> Result<String, Failure> {
    let marking = Marking::Verdicts(&start.analysis.reactions);
    let labels = Labels::NamesAndRows;
    labelled_mechanism(start.mechanism, 0.0, &start.state.q, marking, labels)
        .map_err(|e| Failure::stopped(e.to_string()))
}

/// The page of a run that consists of the start only.
fn page(start: &ConfigurationAnalysis<'_>, document: &AnalysisDocument) -> String {
    let mut recording = Recording::new(0.0, 1.0, 1);
    let frame = Frame::at_rest(0.0, &start.state.q, start.mechanism.layout().n_v);
    recording.frames.push(frame);
    run_page(&RunPage {
        mechanism: start.mechanism,
        analysis: Some(document),
        hints: &[],
        shows: Shows::Start,
        stretches: None,
        recording: &recording,
        comparisons: &[],
        drives: &[],
        origin: &origin(),
        scene: pfaff::written_scene(start.scene),
        options: &[],
        left_out: &[],
        work_precision: None,
    })
}

/// What is written.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Page,
    Svg,
    Png,
}

impl Form {
    const ALL: [(&str, Self); 3] = [("html", Self::Page), ("svg", Self::Svg), ("png", Self::Png)];

    /// The form that the end of a name asks for.
    fn of(path: &Path) -> Option<Self> {
        let end = path.extension()?;
        let mut forms = Self::ALL.into_iter();
        forms.find_map(|(name, form)| end.eq_ignore_ascii_case(name).then_some(form))
    }
}

/// The path of the file, and what it is.
fn place(arguments: &View) -> Result<(PathBuf, Form), Failure> {
    let scene = &arguments.scene;
    let (path, form) = match &arguments.out {
        None => {
            let stem = scene.file_stem().filter(|_| scene.as_os_str() != "-");
            let stem = Path::new(stem.unwrap_or("scene".as_ref()));
            let (end, form) = Form::ALL[if arguments.png { 2 } else { 0 }];
            (stem.with_extension(end), form)
        }
        Some(path) => {
            let refused = |what: &str| {
                let path = path.display();
                Failure::input(format!("--out is `{path}`, {what}"))
            };
            if path.is_dir() {
                return Err(refused("a directory, need a file"));
            }
            let form = Form::of(path);
            let form =
                form.ok_or_else(|| refused("need a name that ends with .html, .svg or .png"))?;
            (path.clone(), form)
        }
    };
    if arguments.scale.is_some() && form != Form::Png {
        let message = "--scale is for PNG: take --png, or a name that ends with .png for --out";
        return Err(Failure::input(message.to_owned()));
    }
    Ok((path, form))
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
