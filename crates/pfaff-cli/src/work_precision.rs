//! `pfaff work-precision`: error versus run time, as a table, a figure and a page.

use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::question::Control;
use pfaff::report::{
    Family, OutputDirectory, OutputFile, TableError, WorkPrecisionDocument, WorkPrecisionRow,
    WorkPrecisionScene, WorkPrecisionTable, figures, work_precision_page,
};
use pfaff::work_precision::{Plan, Rival, Subject, overview};
use pfaff::{RunOptions, StudyError};

use crate::args::{Settings, WorkPrecision};
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, Shortfall, beside, directory, json_or, wrapped};
use crate::picture::{can_paint, unpainted};
use crate::progress::Progress;
use crate::provenance::provenance;
use crate::resources::{Resources, start_threads};

pub(crate) fn run(arguments: &WorkPrecision, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    start_threads(None, console);
    // All scenes are read before the first is run.
    let scenes = arguments.scenes.iter();
    let read = |path: &PathBuf| read(path, &arguments.settings, console);
    let subjects: Result<Vec<Subject>, Failure> = scenes.map(read).collect();
    Request {
        subjects: &subjects?,
        rivals: &[],
        plan: plan(arguments.quick, arguments.all),
        out: &arguments.place.out,
        force: arguments.place.force,
        png: arguments.png,
        json: arguments.json,
    }
    .run(console)
}

/// The requested runs: three tolerances, every method with every stabilisation, or the default.
#[must_use]
pub fn plan(quick: bool, all: bool) -> Plan {
    match (quick, all) {
        (true, _) => Plan::quick(),
        (false, true) => Plan::everything(),
        (false, false) => Plan::standard(),
    }
}

/// The scene of a file, or of standard input for `-`.
///
/// # Errors
/// The error in the file or in the scene.
pub fn subject(path: &Path, console: &Console<'_>) -> Result<Subject, Failure> {
    read(path, &Settings::default(), console)
}

/// The scene of a file, with other numbers in it.
fn read(path: &Path, settings: &Settings, console: &Console<'_>) -> Result<Subject, Failure> {
    let source = Source::read(path, settings, console)?;
    let start = source.start(Resources::default());
    let shown = Progress::default();
    let control = Control {
        progress: &|progress| shown.show(progress),
        ..Control::quiet()
    };
    let study = start.prepared(&RunOptions::default(), &control)?;
    Ok(Subject::of_study(study).map_err(|e| start.refusal(e))?)
}

/// The files of a comparison; the last one is written if it is requested.
const FAMILY: Family = Family(&[TABLE, FIGURE, PAGE, PNG]);

const TABLE: &str = "work_precision.csv";
const FIGURE: &str = "work_precision.svg";
const PAGE: &str = "report.html";
const PNG: &str = "work_precision.png";

/// Scenes whose runs are compared, and the directory of the results.
pub struct Request<'a> {
    /// The scenes.
    pub subjects: &'a [Subject],
    /// Methods for comparison that are not part of pfaff.
    pub rivals: &'a [&'a dyn Rival],
    /// The runs of each scene.
    pub plan: Plan,
    /// Directory for table, figure and page.
    pub out: &'a Path,
    /// Whether files there are replaced that pfaff has not written.
    pub force: bool,
    /// Whether the figure is written as PNG, too.
    pub png: bool,
    /// Whether to answer with all results as one JSON document.
    pub json: bool,
}

impl Request<'_> {
    /// Makes all runs, with progress; if a stop is requested, the runs so far are the result.
    ///
    /// # Errors
    /// If a scene cannot be run or a file cannot be written.
    pub fn run(&self, console: &Console<'_>) -> Outcome {
        if self.png {
            can_paint(None)?;
        }
        let directory = directory(self.out, FAMILY, self.force)?;
        let file = directory.file(TABLE)?;
        let mut table = WorkPrecisionTable::new(file).map_err(|e| unfinished(&e))?;
        let mut rows = 0;
        let compared = self.compare(&directory, (&mut table, &mut rows));
        // Rows of scenes before one that cannot be compared are kept.
        if compared.is_ok() || rows > 0 {
            let file = table.finish().map_err(|e| unfinished(&e))?;
            let finished = match &compared {
                Ok(document) if !document.partial => file.finish(),
                _ => file.finish_partial(),
            };
            finished?;
        }
        let document = compared?;
        let figure = figures::work_precision(&document.scenes);
        let page = work_precision_page(&document, &figure);
        let mut pages = vec![
            (FIGURE, figure.clone().into_bytes()),
            (PAGE, page.into_bytes()),
        ];
        if self.png {
            let painted = figures::png(&figure, None).map_err(|e| unpainted(&e))?;
            pages.push((PNG, painted.bytes));
        }
        let mut kept = vec![TABLE];
        for (name, content) in &pages {
            directory.write(name, content)?;
            kept.push(name);
        }
        directory.keep(FAMILY, &kept)?;
        let shortfall = document.partial.then(|| {
            let (made, all) = (document.scenes.len(), self.subjects.len());
            Shortfall::interrupted(format!("interrupted in scene {made} of {all}"))
        });
        let text = if self.json {
            json_or(shortfall.as_ref(), &document)?
        } else {
            describe(&document, &self.out.display().to_string()) + &beside(&directory, FAMILY)
        };
        match shortfall {
            None => console.print(&text),
            Some(_) => Err(console.incomplete(&text)),
        }
    }

    /// Makes all runs, and counts the rows of the table; if a stop is requested, returns the runs
    /// so far.
    fn compare(
        &self,
        directory: &OutputDirectory,
        (table, rows): (&mut WorkPrecisionTable<OutputFile>, &mut usize),
    ) -> Result<WorkPrecisionDocument, Failure> {
        let ended = directory.clone();
        let interrupt = Interrupt::listen_with(move || {
            let place = ended.path().display();
            ended.abandon();
            format!("interrupted; kept: the finished runs in `{place}`")
        })?;
        let interrupted = || interrupt.is_asked();
        let curves = self.plan.curves.len() + self.rivals.len();
        let runs = curves * self.plan.tolerances.len() * self.subjects.len();
        // It hides itself if standard error is not a terminal.
        let bar = ProgressBar::new(runs as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {eta} left") {
            bar.set_style(style);
        }
        let mut scenes: Vec<WorkPrecisionScene> = Vec::with_capacity(self.subjects.len());
        let mut partial = false;
        for subject in self.subjects {
            bar.set_message(subject.name().to_owned());
            let row = |row: &WorkPrecisionRow| {
                bar.inc(1);
                bar.set_message(format!(
                    "{}: {} at {:.0e}",
                    row.scene, row.curve.method, row.tolerance
                ));
                *rows += 1;
                table.row(row).map_err(Interruption::Table)
            };
            let comparison = subject
                .compare(&self.plan, self.rivals, &interrupted, row)
                .map_err(|e| match e {
                    Interruption::Study(e) => Failure::stopped(e.to_string()).coded(e.code()),
                    Interruption::Table(e) => unfinished(&e),
                })?;
            scenes.push(comparison.scene);
            partial = comparison.interrupted;
            if partial {
                break;
            }
        }
        bar.finish_and_clear();
        Ok(WorkPrecisionDocument {
            provenance: provenance(),
            partial,
            summary: overview(&scenes),
            scenes,
        })
    }
}

/// The error that ends the runs or their table.
enum Interruption {
    Study(StudyError),
    Table(TableError),
}

impl From<StudyError> for Interruption {
    fn from(error: StudyError) -> Self {
        Self::Study(error)
    }
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

/// A table that was not written to its end.
fn unfinished(error: &TableError) -> Failure {
    Failure::stopped(error.to_string()).coded(error.code())
}
