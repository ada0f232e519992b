//! The command `lab work-precision`: compares error and run time, for the methods of pfaff and for
//! reference methods.

use std::path::{Path, PathBuf};

use clap::Args;
use pfaff::RunOptions;
use pfaff::question::{Control, Question};
use pfaff::work_precision::{Rival, Subject};
use pfaff_cli::ask::{Asking, Hears, OutputOptions};
use pfaff_cli::console::Console;
use pfaff_cli::input::{start, unknown};
use pfaff_cli::output::{Failure, Outcome};

use crate::comparators::Comparator;
use crate::work_precision::{of_case, ways};

#[derive(Args)]
pub(super) struct WorkPrecision {
    /// Scene files, - for standard input, or names of cases of the suite; default: the suite
    scenes: Vec<PathBuf>,
    /// Directory for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Three tolerances, for a quick overview
    #[arg(long, conflicts_with = "all")]
    quick: bool,
    /// Every method of pfaff with every stabilisation
    #[arg(long)]
    all: bool,
    /// Only the methods of pfaff
    #[arg(long)]
    own: bool,
    /// All results as one JSON document on standard output
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &WorkPrecision, console: &Console<'_>) -> Outcome {
    let subjects = subjects(arguments, console)?;
    let ways: Vec<Comparator> = if arguments.own { Vec::new() } else { ways() };
    let rivals: Vec<&dyn Rival> = ways.iter().map(|way| way as &dyn Rival).collect();
    let question = pfaff::questions::WorkPrecision {
        quick: arguments.quick,
        all: arguments.all,
        png: false,
    };
    let place = OutputOptions {
        out: Some(arguments.out.clone()),
        force: true,
    };
    let asking = Asking {
        output: pfaff::questions::WorkPrecision::OUTPUT.map(|output| (output, &place)),
        is_json: arguments.json,
        is_verbose: false,
        is_si: false,
        threads: None,
        hears: Hears::Stops,
    };
    asking.run(console, |control| {
        Ok(control.answered(|| question.compared(&subjects, &rivals, control))?)
    })
}

/// Returns the requested scenes, or the scenes of the suite. All scenes are read before the first
/// scene is run.
fn subjects(arguments: &WorkPrecision, console: &Console<'_>) -> Result<Vec<Subject>, Failure> {
    let case = |case| of_case(case).map_err(|e| Failure::stopped(e.to_string()));
    if arguments.scenes.is_empty() {
        return suite::COMPARED.iter().map(case).collect();
    }
    let scenes = arguments.scenes.iter().map(|path| {
        // A file takes precedence over a case with the same name.
        let name = path.to_str().filter(|_| !path.exists());
        match name.and_then(suite::find) {
            Some(found) => case(found),
            None if name.is_some() && is_bare(path) => {
                let names: Vec<&str> = suite::all().map(|case| case.name).collect();
                Err(unknown("file or case", &path.display().to_string(), &names))
            }
            None => {
                let scene = start(path, console)?;
                let study = scene.prepared(&RunOptions::default(), &Control::quiet())?;
                Ok(Subject::of_study(study).map_err(|e| scene.refusal(e))?)
            }
        }
    });
    scenes.collect()
}

/// Whether this is a plain name: it has no directory and no extension, and is not standard input.
fn is_bare(path: &Path) -> bool {
    path.components().count() == 1 && path.extension().is_none() && path.as_os_str() != "-"
}
