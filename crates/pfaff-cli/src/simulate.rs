//! `pfaff simulate`: writes motion and reactions into a directory, with progress on a terminal.

use std::ops::ControlFlow;

use pfaff::choice::choices;
use pfaff::model::System;
use pfaff::model::words::{listed, rounded};
use pfaff::report::documents::{
    ChoiceDocument, EndedDocument, MisfitDocument, RunReactionDocument, choice_file,
};
use pfaff::study::FAMILY;

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::report::{Origin, OutputDirectory, Provenance, RunDocument};
use pfaff::{RunOptions, StudyError};

use crate::args::Simulate;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::{BY_REQUEST, Interrupt};
use crate::output::{Outcome, beside, count, directory, json, wrapped};
use crate::work_precision::provenance;

/// Largest error of the energy balance without a warning, as a fraction of the largest kinetic
/// energy. With the default tolerances the error is below a thousandth of this; larger errors are
/// visible in a plot.
pub(crate) const TRUSTED_BALANCE: f64 = 1e-3;

/// Steps of the progress bar over the whole run.
const TICKS: u64 = 1000;

pub(crate) fn run(arguments: &Simulate, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let run = RunOptions {
        threads: arguments.resources.threads,
        ..arguments.run.clone()
    };
    let mut study = source.study(&run, arguments.resources, console)?;
    let rows = study.prepared.mechanism.layout().rows();
    let reaction = |name: &str| study.reaction(name);
    let start = source.clone().start(arguments.resources);
    study.choices = choices(&arguments.choose, &start, (rows, &reaction))?;
    let memory = study
        .memory(source.text.len())
        .map_err(|e| source.failure(e))?;
    arguments.resources.allow(memory, "this run")?;
    let Some(options) = &study.options else {
        return Err(source.failure(StudyError::NoEnd));
    };
    let directory = directory(&arguments.place.out, FAMILY, arguments.place.force)?;
    let ended = last_act(&directory, study.scene.name());
    let interrupt = Interrupt::listen_with(ended)?;
    // It hides itself if standard error is not a terminal.
    let bar = ProgressBar::new(TICKS);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} t = {msg}, {eta} left") {
        bar.set_style(style);
    }
    let t_end = options.t_end;
    let stop = || interrupt.is_asked();
    let outcome = study.simulate_as(&origin(), &directory, &stop, |t| {
        if !bar.is_hidden() {
            bar.set_position((t / t_end * TICKS as f64) as u64);
            let rate = t / bar.elapsed().as_secs_f64();
            bar.set_message(format!("{t:.3} s, {rate:.2} s of motion each second"));
        }
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    let document = outcome.map_err(|e| source.failure(e))?;
    let text = if arguments.json {
        json(&document)?
    } else {
        let mut text = describe(study.scene.name(), &document, t_end);
        text.push_str(&written(
            &arguments.place.out.display().to_string(),
            study.scene.output.report,
        ));
        text.push_str(&beside(&directory, FAMILY));
        text
    };
    if document.partial {
        Err(console.incomplete(&text))
    } else {
        console.print(&text)
    }
}

/// The last act of a run that has to be ended: its tables and a summary.
fn last_act(directory: &OutputDirectory, scene: &str) -> impl Fn() -> String + Send + Sync + use<> {
    let directory = directory.clone();
    let (error, kept) = ("interrupted", "kept: whole rows of the tables");
    let document = json(&EndedDocument {
        scene: scene.to_owned(),
        partial: true,
        code: BY_REQUEST,
        error,
    });
    let summary = document.unwrap_or_default();
    move || {
        let place = directory.path().display().to_string();
        if directory.abandon_as("summary.json", summary.as_bytes(), FAMILY) {
            format!("{error}; {kept} in `{place}`; summary.json says that they are partial")
        } else {
            format!("{error}; nothing was written into `{place}`")
        }
    }
}

/// The command and the versions that made the page.
pub(crate) fn origin() -> Origin {
    let Provenance {
        versions, command, ..
    } = provenance();
    Origin { command, versions }
}

/// The summary in words.
fn describe(name: &str, d: &RunDocument, t_end: f64) -> String {
    let ending = if d.partial {
        format!(
            "interrupted at t = {} s of {}",
            rounded(d.t_end),
            rounded(t_end)
        )
    } else {
        format!("done to t = {} s", d.t_end)
    };
    let mut text = format!(
        "{name}: {ending} with {} ({}, {})\n\
         {} steps, {} rejected, {} evaluations in {:.2} ms\n\
         |Φ| ≤ {:.1e}, |C·v − b| ≤ {:.1e}, energy balance {:.1e}\n",
        d.method,
        d.formulation,
        d.stabilisation,
        d.steps,
        d.rejected,
        d.evaluations,
        1e3 * d.wall_seconds,
        d.max_position_residual,
        d.max_velocity_residual,
        d.energy_balance,
    );
    if d.energy_balance.is_nan() || d.energy_balance > TRUSTED_BALANCE {
        text.push_str(&format!(
            "warning: the energy balance is off by {:.1e} of the largest kinetic energy: do not trust this run; try \
             tighter tolerances\n",
            d.energy_balance
        ));
    }
    if d.start_correction > 0.0 || d.start_velocity_correction > 0.0 {
        text.push_str(&format!(
            "the start was corrected by {:.1e} in position and {:.1e} in velocity\n",
            d.start_correction, d.start_velocity_correction
        ));
    }
    if d.partial {
        text.push_str(&d.kept());
        text.push('\n');
    }
    for line in MisfitDocument::lines(&d.misfits) {
        text.push_str(&format!("within the tolerance: {line}\n"));
    }
    if let Some(spread) = &d.spread {
        text.push_str(&format!("which rows are kept is a choice: {spread}\n"));
    }
    for event in &d.events {
        text.push_str(&format!("t = {:.6} s: {}\n", event.time, event.text));
    }
    if let Some(warning) = d.data.warning(d.mobility) {
        text.push_str(&wrapped("", &format!("warning: {warning}")));
    }
    let reactions = d.reactions.0.iter().map(|(name, r)| (name, &r.data));
    let groups = d.groups.0.iter().map(|(name, g)| (name, &g.data));
    let fragile = reactions.chain(groups).filter(|(_, data)| data.fragile);
    let fragile: Vec<&str> = fragile.map(|(name, _)| name.as_str()).collect();
    if !fragile.is_empty() {
        text.push_str(&format!(
            "warning: unique but fragile at the start: {}. Their numbers are made of the last digits of the data; summary.json says of which.\n",
            listed(&fragile),
        ));
    }
    text.push_str(&open_reactions(d));
    text
}

/// What the model does not determine, and where its numbers are.
fn open_reactions(d: &RunDocument) -> String {
    let of = |word: &str| -> Vec<&str> {
        let reactions = d.reactions.0.iter();
        let is = |r: &RunReactionDocument| r.of_run.as_ref().is_some_and(|v| v.verdict == word);
        let those = reactions.filter(|(_, r)| is(r));
        those.map(|(name, _)| name.as_str()).collect()
    };
    let mut text = String::new();
    let undecided = of("undecided");
    if !undecided.is_empty() {
        text.push_str(&format!(
            "undecided: {}; summary.json gives the reasons.\n",
            listed(&undecided)
        ));
    }
    let open = of("not_unique");
    let Some(solutions) = solutions(&d.choice).filter(|_| !open.is_empty()) else {
        return text;
    };
    text.push_str(&format!(
        "not determined by the model: {}. In reactions.csv only what is determined has numbers; {solutions}.\n",
        listed(&open),
    ));
    for (k, choice) in d.choice.iter().enumerate() {
        if let Some(gap) = &choice.gap {
            text.push_str(&wrapped(
                "",
                &format!(
                    "warning: {} has empty cells in {}, the first at t = {} s: {}",
                    choice.file.clone().unwrap_or_else(|| choice_file(k)),
                    count(gap.rows, "row", "rows"),
                    rounded(gap.first),
                    gap.reason
                ),
            ));
        }
    }
    let some: Vec<String> = open
        .iter()
        .filter_map(|name| partly(name, d.reactions.get(name)?))
        .collect();
    if !some.is_empty() {
        text.push_str(&format!(
            "determined on parts of the run: {}.\n",
            some.join("; ")
        ));
    }
    text
}

/// Which tables have which solutions, in words.
fn solutions(choices: &[ChoiceDocument]) -> Option<String> {
    let [first, others @ ..] = choices else {
        return None;
    };
    if first.file.is_none() {
        let more = match others {
            [] => "",
            _ => " at first; summary.json has the others",
        };
        return Some(format!(
            "choice.csv has one solution of many ({first}{more})"
        ));
    }
    let each = choices.iter().filter_map(|choice| {
        let file = choice.file.as_ref()?;
        Some(format!("{file} has one solution of many ({choice})"))
    });
    Some(each.collect::<Vec<_>>().join("; "))
}

/// The components of a reaction that are determined on parts of the run.
fn partly(name: &str, reaction: &RunReactionDocument) -> Option<String> {
    let components = reaction.components.0.iter();
    let some = components.filter(|(_, c)| !c.of_run.determined.is_empty());
    let some: Vec<String> = some
        .map(|(component, c)| format!("{name}.{component} on {}", c.of_run.on_intervals()))
        .collect();
    (!some.is_empty()).then(|| some.join(", "))
}

/// The paths of the results, and the file to open first.
fn written(out: &str, report: bool) -> String {
    if report {
        format!("written to {out}; report.html there opens in any browser\n")
    } else {
        format!("written to {out}\n")
    }
}
