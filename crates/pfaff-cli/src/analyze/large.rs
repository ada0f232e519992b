//! `pfaff analyze` of a large mechanism: judged by parts, told as counts. The document has everything.

use std::collections::BTreeMap;

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::Blueprint;
use pfaff::report::AnalysisDocument;
use pfaff::solvability::Survey;

use super::{rank, text};
use crate::args::Analyze;
use crate::input::Source;
use crate::output::{Failure, columns, wrapped};

/// Names that are listed, and reasons.
const LISTED: usize = 12;
const REASONS: usize = 3;

/// The questions that are answered by parts: the verdicts of the start.
pub(super) fn document(
    arguments: &Analyze,
    source: &Source,
    blueprint: &mut Blueprint,
) -> Result<(AnalysisDocument, Survey), Failure> {
    let rows = pfaff::model::System::layout(&blueprint.mechanism).rows();
    if let Some(option) = beyond(arguments) {
        return Err(Failure::input(format!(
            "{option} needs the matrix of all rows, and this mechanism has {rows}: above {} rows there are verdicts of the start only; \
             leave {option} out, or ask a scene of the part that you mean",
            pfaff::solvability::LARGE
        )));
    }
    let joints = pfaff::model::System::layout(&blueprint.mechanism)
        .groups
        .len();
    let bar = ProgressBar::new(joints as u64).with_style(
        ProgressStyle::with_template("{bar:30} {pos} of {len} joints, {per_sec}, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let survey = blueprint
        .survey(|judged| bar.set_position(judged as u64))
        .map_err(|e| source.failure(e));
    bar.finish_and_clear();
    let survey = survey?;
    let document = AnalysisDocument::of_survey(blueprint.scene.name(), &survey);
    Ok((document, survey))
}

/// An option that asks more.
fn beyond(arguments: &Analyze) -> Option<&'static str> {
    let asked = [
        ("--at-time", arguments.at_time != 0.0),
        ("--drop", arguments.drop.is_some()),
        ("--combine", !arguments.combine.is_empty()),
        ("--make-unique", !arguments.make_unique.is_empty()),
        ("--eliminations", arguments.eliminations.is_some()),
        ("--frames", arguments.frames),
        ("--along", arguments.along.is_some()),
        ("--choose", !arguments.choose.is_empty()),
    ];
    asked
        .into_iter()
        .find(|(_, is)| *is)
        .map(|(option, _)| option)
}

/// The document in words.
pub(super) fn describe(d: &AnalysisDocument, survey: &Survey) -> String {
    let mut out = text::heading(d);
    out.push_str(&rank::by_parts(d, survey));
    out.push_str(&verdicts(d));
    out.push_str(&why(d));
    for warning in d.warnings.iter().take(LISTED) {
        out.push('\n');
        out.push_str(&wrapped("warning: ", warning));
    }
    if d.warnings.len() > LISTED {
        out.push_str(&format!(
            "and {} warnings more\n",
            d.warnings.len() - LISTED
        ));
    }
    out
}

/// Counts by type, and the first names.
fn verdicts(d: &AnalysisDocument) -> String {
    const WORDS: [&str; 3] = ["unique", "not_unique", "undecided"];
    let mut by_type: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for r in &d.reactions {
        if let Some(k) = WORDS.iter().position(|word| *word == r.wrench.verdict) {
            by_type.entry(r.kind).or_default()[k] += 1;
        }
    }
    let header = ["type", "reactions", "unique", "not unique", "undecided"];
    let mut table = vec![header.map(str::to_owned).to_vec()];
    for (kind, counts) in &by_type {
        let total: usize = counts.iter().sum();
        let numbers = [total, counts[0], counts[1], counts[2]];
        let mut line = vec![(*kind).to_owned()];
        line.extend(numbers.map(|n| n.to_string()));
        table.push(line);
    }
    let mut out = format!("\n{}", columns(&table));
    for (word, said) in [("not_unique", "not unique: "), ("undecided", "undecided: ")] {
        let of_word = d.reactions.iter().filter(|r| r.wrench.verdict == word);
        let names: Vec<&str> = of_word.map(|r| r.name.as_str()).collect();
        if names.is_empty() {
            continue;
        }
        let mut listed = names[..names.len().min(LISTED)].join(", ");
        if names.len() > LISTED {
            listed += &format!(" and {} more (`--json` lists all)", names.len() - LISTED);
        }
        out.push('\n');
        out.push_str(&wrapped(said, &listed));
    }
    out
}

fn why(d: &AnalysisDocument) -> String {
    if d.dependencies.is_empty() {
        return String::new();
    }
    let mut out = "\nWhy:\n".to_owned();
    for dependency in d.dependencies.iter().take(REASONS) {
        out.push_str(&wrapped("- ", &dependency.text));
    }
    if d.dependencies.len() > REASONS {
        let more = d.dependencies.len() - REASONS;
        out.push_str(&format!(
            "and {more} dependencies more (`--json` lists all)\n"
        ));
    }
    out
}
