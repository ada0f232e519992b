//! `pfaff work-precision`: error against run time, as a table, a figure and a page.

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::StudyError;
use pfaff::report::{
    OutputDirectory, OutputFile, Provenance, TableError, WorkPrecisionDocument, WorkPrecisionRow,
    WorkPrecisionScene, WorkPrecisionTable, figures, work_precision_page, write_json,
};
use pfaff::suite;
use pfaff::work_precision::{Plan, Subject, overview, provenance};

use crate::args::WorkPrecision;
use crate::console::Console;
use crate::input::{Source, unknown};
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, wrapped};
use crate::resources::Resources;

pub(crate) fn run(arguments: &WorkPrecision, console: &Console<'_>) -> Outcome {
    let plan = match (arguments.quick, arguments.all) {
        (true, _) => Plan::quick(),
        (false, true) => Plan::everything(),
        (false, false) => Plan::standard(),
    };
    // All scenes are read before the first is run.
    let subjects = subjects(arguments, console)?;
    let stopped = |e: &dyn std::error::Error| Failure::stopped(e.to_string());
    let directory = OutputDirectory::create(&arguments.out).map_err(|e| stopped(&e))?;
    let file = directory
        .file("work_precision.csv")
        .map_err(|e| stopped(&e))?;
    let table = WorkPrecisionTable::new(file).map_err(|e| stopped(&e))?;
    let (document, table) = compare(&subjects, &plan, table)?;
    let file = table.finish().map_err(|e| stopped(&e))?;
    let finished = match document.partial {
        false => file.finish(),
        true => file.finish_partial(),
    };
    finished.map_err(|e| stopped(&e))?;
    let figure = figures::work_precision(&document.scenes);
    let page = work_precision_page(&document, &figure);
    for (name, text) in [("work_precision.svg", figure), ("report.html", page)] {
        directory
            .write(name, text.as_bytes())
            .map_err(|e| stopped(&e))?;
    }
    let text = match arguments.json {
        true => {
            let mut out = Vec::new();
            write_json(&mut out, &document).map_err(|e| stopped(&e))?;
            String::from_utf8_lossy(&out).into_owned()
        }
        false => describe(&document, &arguments.out.display().to_string()),
    };
    match document.partial {
        true => Err(console.incomplete(&text)),
        false => console.print(&text),
    }
}

/// The scenes that are asked for, or those of the suite.
fn subjects(arguments: &WorkPrecision, console: &Console<'_>) -> Result<Vec<Subject>, Failure> {
    let unreadable = |e: StudyError| Failure::stopped(e.to_string());
    if arguments.scenes.is_empty() {
        let cases = suite::COMPARED.iter().map(Subject::of_case);
        return cases.collect::<Result<_, _>>().map_err(unreadable);
    }
    let scenes = arguments.scenes.iter().map(|path| {
        // A file is nearer to the user than a case of the same name.
        let case = path
            .to_str()
            .filter(|_| !path.exists())
            .and_then(suite::find);
        if let Some(case) = case {
            return Subject::of_case(case).map_err(unreadable);
        }
        // A name without a place and an ending is that of a case.
        if let Some(name) = path.to_str().filter(|_| !path.exists() && is_bare(path)) {
            let names: Vec<&str> = suite::all().map(|case| case.name).collect();
            return Err(unknown("file or case", name, &names));
        }
        let source = Source::read(path, console)?;
        let study = source.study(&pfaff::Overrides::default(), Resources::default())?;
        Subject::of_study(study).map_err(|e| source.failure(e))
    });
    scenes.collect()
}

/// Whether this is a name alone: no directory, no ending, not standard input.
fn is_bare(path: &Path) -> bool {
    path.components().count() == 1 && path.extension().is_none() && path.as_os_str() != "-"
}

/// Why rows end early.
enum Interruption {
    Study(StudyError),
    Table(TableError),
}

impl From<StudyError> for Interruption {
    fn from(error: StudyError) -> Self {
        Self::Study(error)
    }
}

/// Runs everything; what there is of it when somebody asks to stop.
fn compare(
    subjects: &[Subject],
    plan: &Plan,
    mut table: WorkPrecisionTable<OutputFile>,
) -> Result<(WorkPrecisionDocument, WorkPrecisionTable<OutputFile>), Failure> {
    let interrupt = Interrupt::listen()?;
    let interrupted = || interrupt.is_asked();
    // Hidden by itself where standard error is no terminal.
    let bar = ProgressBar::new((plan.runs() * subjects.len()) as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {eta} left") {
        bar.set_style(style);
    }
    let mut scenes: Vec<WorkPrecisionScene> = Vec::with_capacity(subjects.len());
    let mut partial = false;
    for subject in subjects {
        bar.set_message(subject.name().to_owned());
        let row = |row: &WorkPrecisionRow| {
            bar.inc(1);
            bar.set_message(format!(
                "{}: {} at {:.0e}",
                row.scene, row.curve.method, row.tolerance
            ));
            table.row(row).map_err(Interruption::Table)
        };
        let comparison = subject
            .compare(plan, &interrupted, row)
            .map_err(|e| match e {
                Interruption::Study(e) => Failure::stopped(e.to_string()),
                Interruption::Table(e) => Failure::stopped(e.to_string()),
            })?;
        scenes.push(comparison.scene);
        partial = comparison.interrupted;
        if partial {
            break;
        }
    }
    bar.finish_and_clear();
    let document = WorkPrecisionDocument {
        provenance: provenance(),
        partial,
        summary: overview(&scenes),
        scenes,
    };
    Ok((document, table))
}

/// Where, when and by which command results are made.
pub(crate) fn provenance() -> Provenance {
    Provenance {
        machine: provenance::machine(),
        versions: format!(
            "pfaff {}, {}",
            env!("CARGO_PKG_VERSION"),
            env!("PFAFF_COMPILER")
        ),
        date: provenance::date(),
        command: command(),
    }
}

/// What was typed.
fn command() -> String {
    let arguments = std::env::args_os().skip(1);
    let words = arguments.map(|a| a.to_string_lossy().into_owned());
    let all: Vec<String> = std::iter::once("pfaff".to_owned()).chain(words).collect();
    all.join(" ")
}

/// The summary in words.
fn describe(document: &WorkPrecisionDocument, out: &str) -> String {
    let mut text = String::new();
    for scene in &document.scenes {
        text.push_str(&format!("{}: {}\n", scene.name, scene.title));
        let r = &scene.reference;
        let known = format!(
            "reference known to {:.0e}. {}",
            r.motion_limit(),
            r.agreement
        );
        text.push_str(&wrapped("  ", &known));
        for sentence in &scene.summary {
            text.push_str(&wrapped("  ", sentence));
        }
    }
    if document.partial {
        text.push_str("interrupted, partial\n");
    }
    for sentence in &document.summary {
        text.push_str(&wrapped("", sentence));
    }
    text.push_str(&format!("written to {out}\n"));
    text
}
