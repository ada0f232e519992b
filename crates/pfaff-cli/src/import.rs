//! The command `pfaff import`: converts a robot model to a scene.

use std::path::Path;

use pfaff::documents::{ImportDocument, OmissionDocument};
use pfaff::import::{Axes, FixedLinks, Folder, ImportedScene, Omission, Options, Refusal};
use pfaff::memory::of_import;
use pfaff::question::Ending;

use crate::args::Import;
use crate::console::Console;
use crate::input::text_of;
use crate::interrupt::Interrupt;
use crate::output::{self, Failure, Outcome, count, replaces, wrapped, write_file};

pub(crate) fn run(arguments: &Import, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let standard_output = arguments.out.as_os_str() == "-";
    let (name, text) = text_of(&arguments.file)?;
    let memory = of_import(text.len(), 0);
    arguments.memory.allow(memory, "importing this file")?;
    let imported = pfaff::import::import(&name, &text, &options(arguments)?);
    let imported = imported.map_err(|refusal| refused(*refusal))?;
    if standard_output {
        return if arguments.json {
            let message = "--json and --out - both want standard output";
            Err(Failure::input(message.to_owned()))
        } else {
            console.print(&imported.scene)
        };
    }
    let memory = of_import(text.len(), imported.scene.len());
    arguments.memory.allow(memory, "reading its scene")?;
    let file = arguments.out.display().to_string();
    let read = pfaff::scene::read(&file, &imported.scene, console.registry);
    let ending = read.err().and_then(|list| {
        let first = list.first()?;
        let (code, error) = (first.code, first.sentence());
        Some(Ending::Partial { code, error })
    });
    let ending = ending.unwrap_or(Ending::Complete);
    let scene = imported.scene.as_bytes();
    write_file(&arguments.out, scene, replaces(arguments.force))?;
    let error = match &ending {
        Ending::Partial { error, .. } => Some(error.as_str()),
        _ => None,
    };
    let answer = if arguments.json {
        ending.json(&document(&imported, &file, error))?
    } else {
        words(&imported, &file, error)
    };
    match ending {
        Ending::Complete => console.print(&answer),
        _ => Err(console.incomplete(&answer)),
    }
}

fn options(arguments: &Import) -> Result<Options, Failure> {
    let loops = arguments.loops.as_deref().map(text_of).transpose()?;
    let is_file = arguments.file.as_os_str() != Path::new("-");
    Ok(Options {
        loops,
        base: arguments.base,
        folder: if is_file {
            Folder::of(&arguments.file)
        } else {
            Folder::None
        },
        fixed: if arguments.keep_fixed {
            FixedLinks::Kept
        } else {
            FixedLinks::Merged
        },
        pose: arguments.pose.clone(),
        axes: if arguments.snap {
            Axes::Snapped
        } else {
            Axes::Told
        },
        keyframe: arguments.keyframe.clone(),
        model: arguments.model.clone(),
        drives: arguments.drives,
    })
}

fn refused(refusal: Refusal) -> Failure {
    output::Refusal::from(refusal).into()
}

fn document<'a>(
    imported: &'a ImportedScene,
    file: &'a str,
    scene_error: Option<&str>,
) -> ImportDocument<'a> {
    let left_out = |omission: &'a Omission| OmissionDocument {
        kind: omission.kind,
        subject: &omission.subject,
        file: omission.file.as_deref(),
        line: omission.line,
    };
    ImportDocument {
        ok: scene_error.is_none(),
        source_format: imported.format,
        file,
        bodies: imported.counts[0],
        joints: imported.counts[1],
        armatures: imported.armatures,
        remarks: &imported.remarks,
        left_out: imported.omissions.iter().map(left_out).collect(),
        scene_error: scene_error.map(str::to_owned),
    }
}

fn words(imported: &ImportedScene, file: &str, error: Option<&str>) -> String {
    let [bodies, joints] = imported.counts;
    let armatures = match imported.armatures {
        0 => String::new(),
        n => format!(
            " with {} (gyroscopic terms of rotors are neglected)",
            count(n, "armature", "armatures")
        ),
    };
    let mut out = format!(
        "{}: {}, {}{armatures}, written to {file}\n",
        imported.format,
        count(bodies, "body", "bodies"),
        count(joints, "joint or coupling", "joints and couplings"),
    );
    for remark in &imported.remarks {
        out += &wrapped("note: ", remark);
    }
    for (kind, list) in imported.left_out() {
        out += &wrapped("omitted: ", &format!("{kind}: {}", list.join(", ")));
    }
    if imported.omissions.is_empty() {
        out += "the whole file was converted\n";
    }
    out += &match error {
        Some(error) => wrapped(
            "error: ",
            &format!(
                "{file} is written, but it is rejected until this error is corrected: {error}"
            ),
        ),
        None => format!("next: pfaff analyze {file}\n"),
    };
    out
}
