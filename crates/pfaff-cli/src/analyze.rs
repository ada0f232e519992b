//! `pfaff analyze`: the verdict of every reaction and the answers to the options, in words or as
//! JSON. Both forms contain the same document.

mod along;
mod ask;
mod counts;
mod data;
mod deletions;
mod numbers;
mod point;
mod rank;
mod text;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use pfaff::model::System;
use pfaff::report::AnalysisDocument;
use pfaff::{ConfigurationAnalysis, RunOptions, Study};

use crate::args::Analyze;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome};

pub(crate) fn run(arguments: &Analyze, console: &Console<'_>) -> Outcome {
    if !(arguments.at_time >= 0.0 && arguments.at_time.is_finite()) {
        return Err(Failure::input(format!(
            "--at-time is {}, need a time ≥ 0",
            arguments.at_time
        )));
    }
    Interrupt::ends_at_once()?;
    let drop = arguments.drop.clone();
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    arguments.resources.apply(console);
    let assembled = arguments.resources.assembled(&source)?;
    let overrides = RunOptions {
        drop: drop.clone(),
        ..RunOptions::default()
    };
    let error = match assembled.prepare(&overrides) {
        Ok(study) => return of_study(arguments, &source, &study, drop.as_deref(), console),
        Err(e) => e,
    };
    // A mechanism that cannot move can still be judged at the start.
    let Some(warning) = error.only_motion() else {
        return Err(source.failure(error));
    };
    if arguments.at_time == 0.0 && arguments.along.is_none() {
        of_start(arguments, &source, drop.as_deref(), warning, console)
    } else {
        Err(source.failure(error))
    }
}

fn of_study(
    arguments: &Analyze,
    source: &Source,
    study: &Study,
    drop: Option<&[usize]>,
    console: &Console<'_>,
) -> Outcome {
    let joints = study
        .scene
        .description
        .joints()
        .chain(study.scene.description.drives())
        .count();
    let bars = MultiProgress::new();
    let of_configuration = || {
        let bar = Judging::begin(&bars, joints);
        let configuration = study
            .analyse_with_progress(arguments.at_time, drop, |judged| bar.at(judged))
            .map_err(|e| source.failure(e))?;
        bar.end();
        let document = ask::document(arguments, source, &configuration)?;
        Ok::<_, Failure>((configuration, document))
    };
    // A motion is computed step by step, so the verdicts of the start can run in another thread.
    let (of_configuration, along) = match arguments.along {
        Some(t_end) => pfaff::both(of_configuration, || {
            Some(along::judge(source, study, t_end, &bars))
        }),
        None => (of_configuration(), None),
    };
    let (configuration, mut document) = of_configuration?;
    if arguments.at_time == 0.0 {
        let warned = study.add_warnings(&mut document);
        warned.map_err(|e| source.failure(e))?;
    }
    if let Some(found) = along.transpose()? {
        found.add_to(&mut document, configuration.mechanism.layout());
    }
    answer(arguments, &configuration, &document, console)?;
    if document
        .answers
        .along
        .is_some_and(|along| along.stopped.is_some())
    {
        Err(Failure::Incomplete)
    } else {
        Ok(())
    }
}

fn of_start(
    arguments: &Analyze,
    source: &Source,
    drop: Option<&[usize]>,
    warning: String,
    console: &Console<'_>,
) -> Outcome {
    let failure = |e| source.failure(e);
    let mut assembled = arguments.resources.assembled(source)?;
    let description = &assembled.scene.description;
    let joints = description.joints().chain(description.drives()).count();
    let bar = Judging::begin(&MultiProgress::new(), joints);
    let configuration = assembled.analyse_with_progress(drop, |judged| bar.at(judged));
    let configuration = configuration.map_err(failure)?;
    bar.end();
    let mut document = ask::document(arguments, source, &configuration)?;
    document.warnings.insert(0, warning);
    answer(arguments, &configuration, &document, console)
}

fn answer(
    arguments: &Analyze,
    configuration: &ConfigurationAnalysis<'_>,
    document: &AnalysisDocument,
    console: &Console<'_>,
) -> Outcome {
    if arguments.json {
        return console.document(&document);
    }
    let hints = ask::hints(configuration)?;
    console.print(&text::describe(document, &hints))
}

/// Shows on a terminal how many joints and drives have been judged.
struct Judging(ProgressBar);

impl Judging {
    fn begin(bars: &MultiProgress, joints: usize) -> Self {
        let style = "{bar:30} {pos} of {len} joints, {per_sec}, {eta} left";
        let style = ProgressStyle::with_template(style);
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        Self(bars.add(ProgressBar::new(joints as u64).with_style(style)))
    }

    fn at(&self, judged: usize) {
        self.0.set_position(judged as u64);
    }

    fn end(&self) {
        self.0.finish_and_clear();
    }
}
