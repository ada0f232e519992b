//! `pfaff analyze`: the verdict of every reaction and what else was asked, for people or as JSON. Both tell the same document.

mod along;
mod ask;
mod choice;
mod deletions;
mod large;
mod numbers;
mod rank;
mod text;

use pfaff::model::{Registry, System};
use pfaff::report::{AnalysisDocument, write_json};
use pfaff::solvability::LARGE;
use pfaff::{Blueprint, Inquiry, Overrides, Study};

use crate::Outcome;
use crate::args::Analyze;
use crate::input::{Source, rows_from_zero};
use crate::interrupt::Interrupt;
use crate::output::{Failure, print};

pub(crate) fn run(arguments: &Analyze) -> Outcome {
    if !(arguments.at_time >= 0.0 && arguments.at_time.is_finite()) {
        return Err(Failure::input(format!(
            "--at-time is {}, need a time ≥ 0",
            arguments.at_time
        )));
    }
    Interrupt::ends_at_once()?;
    let drop = rows_from_zero(arguments.drop.as_deref())?;
    let source = Source::read(&arguments.scene)?;
    arguments.resources.apply()?;
    let blueprint = arguments.resources.blueprint(&source)?;
    if blueprint.mechanism.layout().rows() > LARGE {
        return of_large(arguments, &source, blueprint);
    }
    let overrides = Overrides {
        drop: drop.clone(),
        ..Overrides::default()
    };
    let error = match blueprint.prepare(&overrides) {
        Ok(study) => return of_study(arguments, &source, &study, drop.as_deref()),
        Err(e) => e,
    };
    // What cannot move can be judged all the same, at the start.
    let Some(warning) = error.only_motion() else {
        return Err(source.failure(error));
    };
    match arguments.at_time == 0.0 && arguments.along.is_none() {
        true => of_start(arguments, &source, drop.as_deref(), warning),
        false => Err(source.failure(error)),
    }
}

fn of_study(
    arguments: &Analyze,
    source: &Source,
    study: &Study,
    drop: Option<&[usize]>,
) -> Outcome {
    let inquiry = study
        .inquire(arguments.at_time, drop)
        .map_err(|e| source.failure(e))?;
    let mut document = ask::document(arguments, source, &inquiry)?;
    if let Some(t_end) = arguments.along {
        document.along = Some(along::judge(source, study, t_end)?);
    }
    answer(arguments, &inquiry, &document)?;
    match document.along.is_some_and(|along| along.stopped.is_some()) {
        // Said above, with what was computed.
        true => Err(Failure::Incomplete),
        false => Ok(()),
    }
}

fn of_start(
    arguments: &Analyze,
    source: &Source,
    drop: Option<&[usize]>,
    warning: String,
) -> Outcome {
    let failure = |e| source.failure(e);
    let read = Blueprint::read(&source.name, &source.text, &Registry::planar());
    let mut blueprint = read.map_err(failure)?;
    let inquiry = blueprint.inquire(drop).map_err(failure)?;
    let mut document = ask::document(arguments, source, &inquiry)?;
    document.warnings.insert(0, warning);
    answer(arguments, &inquiry, &document)
}

fn of_large(arguments: &Analyze, source: &Source, mut blueprint: Blueprint) -> Outcome {
    let (document, survey) = large::document(arguments, source, &mut blueprint)?;
    match arguments.json {
        true => json(&document),
        false => print(&large::describe(&document, &survey)),
    }
}

fn answer(arguments: &Analyze, inquiry: &Inquiry<'_>, document: &AnalysisDocument) -> Outcome {
    if arguments.json {
        return json(document);
    }
    let hints = ask::hints(inquiry)?;
    print(&text::describe(document, &hints))
}

fn json(document: &AnalysisDocument) -> Outcome {
    let mut out = Vec::new();
    write_json(&mut out, document).map_err(|e| Failure::stopped(e.to_string()))?;
    print(&String::from_utf8_lossy(&out))
}
