//! `pfaff view`: writes a page of the assembled start, or its picture as SVG or PNG, and opens it
//! in the system's viewer.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use pfaff::documents::ViewDocument;
use pfaff::question::Control;
use pfaff::report::figures::check_png;
use pfaff::report::{OutputDirectory, Replaces};
use pfaff::view::{Drawing, Form};

use crate::args::View;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, count, write_file};
use crate::provenance::provenance;

pub(crate) fn run(arguments: &View, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let (path, form) = place(arguments)?;
    if form == Form::Png {
        check_png(arguments.scale)?;
    }
    let replaces = if arguments.force {
        Replaces::Files
    } else {
        Replaces::Ours
    };
    // This check is also performed before the computation.
    OutputDirectory::around(&path, replaces)?;
    arguments.resources.apply(console);
    let scene = source.start(arguments.resources);
    let control = Control {
        provenance: &provenance(),
        ..Control::quiet()
    };
    let Drawing {
        scene,
        content,
        pixels,
        boxes,
        document,
        ..
    } = Drawing::new(&scene, form, arguments.scale, &control)?;
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
            scene: &scene,
            file: path.display().to_string(),
            bytes: content.len(),
            pixels,
            boxes: &boxes,
            reactions: document.reactions.len(),
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
        scene,
        count(
            document.reactions.len(),
            "joint or drive",
            "joints and drives"
        ),
        document.ranks.freedoms.summary(document.ranks.mobility),
        path.display()
    ))
}

/// Returns the path of the file, and its format.
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

/// Opens a file with the system's program for such files. The function does not wait for this
/// program.
fn show(path: &Path) -> Result<(), String> {
    let (program, before): (_, &[&str]) = match env::consts::OS {
        "macos" => ("open", &[]),
        // Without this empty argument, the first quoted word would be the title of a window.
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

/// Returns a line about characters that are drawn as boxes. The text is empty if there are no such
/// characters.
fn missing(boxes: &str) -> String {
    if boxes.is_empty() {
        return String::new();
    }
    let named = boxes.chars().map(|c| match c {
        c if c.is_alphanumeric() => format!("`{c}`"),
        c => format!("U+{:04X}", u32::from(c)),
    });
    let named: Vec<String> = named.collect();
    format!(
        "printed as boxes, because no installed font has these characters: {}\n",
        named.join(", ")
    )
}
