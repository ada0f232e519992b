//! `pfaff tolerance`: data vary within their tolerances: how far verdicts, reactions and places
//! hold, in words, as JSON, as a table and a page.

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::model::words::rounded;
use pfaff::report::documents::{
    QuantityRangeDocument, ReactionRangeDocument, ToleranceDocument, distance,
};
use pfaff::report::{
    Family, OutputDirectory, TableError, tolerance_page, tolerance_table, write_json,
};
use pfaff::tolerance::{ToleranceError, ToleranceOptions, ToleranceResult, ToleranceStudy, Varied};

use crate::args::Tolerance;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Files, Outcome, Shortfall, columns, directory, json_or, wrapped};
use crate::work_precision::provenance;

/// The files of a run.
const FAMILY: Family = Family(&[TABLE, DOCUMENT, PAGE]);

const TABLE: &str = "tolerance.csv";
const DOCUMENT: &str = "tolerance.json";
const PAGE: &str = "tolerance.html";

/// Reactions that are also told in a sentence.
const TOLD: usize = 3;

/// Lines of a list; a longer one is its first lines and a count.
const LISTED: usize = 12;

pub(crate) fn run(arguments: &Tolerance, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    arguments.resources.apply(console);
    let assembled = arguments.resources.assembled(&source)?;
    let failed = |e: ToleranceError| failure(&source, e);
    let vary = match &arguments.vary[..] {
        [] => None,
        list => {
            let (name, text) = (source.name.as_str(), source.text.as_str());
            let list = list.to_vec();
            let vary = Varied::new((name, text), source.registry, source.tolerance, list);
            Some(vary.map_err(failed)?)
        }
    };
    let study = ToleranceStudy::varying(assembled, arguments.at_time, vary).map_err(failed)?;
    let memory = study.memory(arguments.runs);
    arguments.resources.allow(memory, "keeping these samples")?;
    let place = match &arguments.out {
        Some(path) => Some(directory(path, FAMILY, arguments.force)?),
        None => None,
    };
    let options = ToleranceOptions {
        samples: arguments.runs,
        seed: arguments.seed,
        threads: arguments.resources.threads,
    };
    let found = sampled(&source, &study, &options)?;
    let written = match (&place, &arguments.out) {
        (Some(place), Some(path)) => write(place, path, &study, &found)?,
        _ => String::new(),
    };
    let document = &found.document;
    let shortfall = document.partial.then(|| {
        let (made, all) = (document.samples, arguments.runs);
        Shortfall::interrupted(format!("interrupted after {made} of {all} samples"))
    });
    let text = if arguments.json {
        json_or(shortfall.as_ref(), document)?
    } else {
        describe(document) + &written
    };
    match shortfall {
        None => console.print(&text),
        Some(_) => Err(console.incomplete(&text)),
    }
}

/// Makes the samples, with progress on a terminal; if a stop is requested, those so far.
fn sampled(
    source: &Source<'_>,
    study: &ToleranceStudy<'_>,
    options: &ToleranceOptions,
) -> Result<ToleranceResult, Failure> {
    let interrupt = Interrupt::listen().ok();
    let interrupted = || interrupt.as_ref().is_some_and(Interrupt::is_asked);
    // It hides itself if standard error is not a terminal.
    let bar = ProgressBar::new(options.samples as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} samples, {eta} left") {
        bar.set_style(style);
    }
    let found = study.run(options, interrupted, |_| bar.inc(1));
    bar.finish_and_clear();
    found.map_err(|e| failure(source, e))
}

fn failure(source: &Source<'_>, error: ToleranceError) -> Failure {
    match error {
        ToleranceError::Study(e) => source.failure(e),
        e if e.is_input() => Failure::input(e.to_string()).coded(e.code()),
        e => Failure::stopped(e.to_string()).coded(e.code()),
    }
}

/// Writes all files; returns what was written, in words.
fn write(
    place: &OutputDirectory,
    path: &Path,
    study: &ToleranceStudy<'_>,
    found: &ToleranceResult,
) -> Result<String, Failure> {
    let mut files = Files::of(place, FAMILY)?;
    let table = |e: TableError| Failure::stopped(e.to_string()).coded(e.code());
    let rows = found.samples.iter().map(|sample| study.row(sample));
    let text = tolerance_table(&study.columns(), rows, Vec::new()).map_err(table)?;
    files.put(TABLE, &text)?;
    let mut json = Vec::new();
    write_json(&mut json, &found.document).map_err(|e| Failure::stopped(e.to_string()))?;
    files.put(DOCUMENT, &json)?;
    let clouds = study.clouds(&found.samples);
    let text = tolerance_page(&found.document, &clouds, &provenance());
    files.put(PAGE, text.as_bytes())?;
    let beside = files.finish()?;
    Ok(format!(
        "\nwritten to {}: {TABLE}, {DOCUMENT}, {PAGE}; the page opens in any browser\n{beside}",
        path.display()
    ))
}

fn describe(d: &ToleranceDocument) -> String {
    let mut text = String::new();
    for sentence in d.sentences() {
        text.push_str(&wrapped("", &sentence));
    }
    text.push('\n');
    text.push_str(&reactions(d));
    text.push_str(&places(d));
    text
}

/// The reactions: a table of ranges, and sentences on those that have none of their own.
fn reactions(d: &ToleranceDocument) -> String {
    let mut text = String::new();
    let ranged: Vec<&ReactionRangeDocument> = (d.reactions.iter())
        .filter(|r| r.values.first().is_some_and(|v| v.range.is_some()))
        .collect();
    if !ranged.is_empty() {
        let header = [
            "reaction",
            "verdict",
            "what",
            "as described",
            "least",
            "greatest",
            "nine tenths between",
        ];
        let rows = ranged.iter().take(LISTED).filter_map(|r| row(r));
        let all = std::iter::once(header.map(str::to_owned).to_vec()).chain(rows);
        text.push_str(&columns(&all.collect::<Vec<_>>()));
        text.push_str(&more(ranged.len()));
        text.push('\n');
    }
    for reaction in ranged.iter().take(TOLD) {
        text.push_str(&wrapped("- ", &reaction.sentence));
    }
    for sentence in d.without_range() {
        text.push_str(&wrapped("- ", &sentence));
    }
    text
}

fn more(listed: usize) -> String {
    match listed.checked_sub(LISTED) {
        Some(more) if more > 0 => format!("and {more} more: `--json` lists all\n"),
        _ => String::new(),
    }
}

fn row(reaction: &ReactionRangeDocument) -> Option<Vec<String>> {
    let value: &QuantityRangeDocument = reaction.values.first()?;
    let range = value.range.as_ref()?;
    let verdict = match (reaction.fragile, value.unique) {
        (true, _) => "unique, FRAGILE".to_owned(),
        (false, true) => "unique".to_owned(),
        (false, false) => reaction.verdict.replace('_', " "),
    };
    let [low, _, high] = range.percentiles.map(digits);
    let what = match value.reading {
        "exact" => format!("{} ({}), rigid", value.name, value.unit),
        _ => format!("{} ({})", value.name, value.unit),
    };
    Some(vec![
        reaction.name.clone(),
        verdict,
        what,
        range.described.map_or("–".to_owned(), digits),
        digits(range.least),
        digits(range.greatest),
        format!("{low} … {high}"),
    ])
}

/// Markers and measures; without markers the body that moves farthest.
fn places(d: &ToleranceDocument) -> String {
    let mut text = String::new();
    for (name, marker) in d.markers.0.iter().take(LISTED) {
        if marker.farthest == 0.0 {
            text.push_str(&format!("marker {name}: does not move\n"));
            continue;
        }
        text.push_str(&format!(
            "marker {name}: up to {} from where it is described, {} on average\n",
            distance(marker.farthest),
            distance(marker.mean)
        ));
    }
    text.push_str(&more(d.markers.0.len()));
    for (name, measure) in d.measures.0.iter().take(LISTED) {
        let (range, unit) = (&measure.range, measure.unit);
        let described = range.described.map_or(String::new(), |x| {
            format!(" ({} {unit} as described)", digits(x))
        });
        text.push_str(&format!(
            "measure {name}: {} … {} {unit}{described}\n",
            digits(range.least),
            digits(range.greatest)
        ));
    }
    text.push_str(&more(d.measures.0.len()));
    let farthest = d
        .bodies
        .0
        .iter()
        .max_by(|a, b| a.1.greatest.total_cmp(&b.1.greatest));
    if let Some((name, moved)) = farthest
        && moved.greatest > 0.0
    {
        text.push_str(&format!(
            "body {name} moves farthest: up to {}, turned by up to {:.1e} rad\n",
            distance(moved.greatest),
            moved.turned
        ));
    }
    if text.is_empty() {
        text
    } else {
        format!("\n{text}")
    }
}

/// A number with four significant digits.
fn digits(x: f64) -> String {
    let short: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    rounded(short + 0.0)
}
