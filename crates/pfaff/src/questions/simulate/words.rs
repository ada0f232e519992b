//! Text about a run.

use crate::documents::{
    BodyOfRunDocument, ChoiceDocument, MisfitDocument, RunDocument, RunReactionDocument,
    choice_file,
};
use dynamics::INDEPENDENT_ROWS;
use model::words::{listed, marked, rough, rounded};

use super::SimulateAnswer;
use crate::bounds_of_run::largest_loads;
use crate::pulls::{PullTimes, PullWarning};
use crate::words::{Block, count};

pub(super) fn of(answer: &SimulateAnswer) -> Vec<Block> {
    let d = &answer.document;
    let mut out = Vec::new();
    let mut say = |text: String| out.push(Block::sentence(text));
    let ending = if d.partial {
        let [at, of] = [d.t_end, answer.t_end].map(rounded);
        format!("interrupted at t = {at} s of {of} s")
    } else {
        format!("done to t = {} s", d.t_end)
    };
    let case = d.case.as_ref();
    let case = case.map_or_else(String::new, |case| format!(", load case `{case}`"));
    say(format!(
        "{}{case}: {ending} with {} ({}, {})",
        answer.scene, d.method, INDEPENDENT_ROWS, d.stabilisation
    ));
    say(format!(
        "{} steps, {} rejected, {} evaluations in {:.2} ms",
        d.steps,
        d.rejected,
        d.evaluations,
        1e3 * d.wall_seconds
    ));
    say(format!(
        "|Φ| ≤ {}, |C·v − b| ≤ {}, energy balance {}",
        rough(d.max_position_residual),
        rough(d.max_velocity_residual),
        rough(d.energy_balance)
    ));
    if let Some(warning) = d.energy_warning() {
        say(format!("warning: {warning}"));
    }
    if d.start_correction > 0.0 || d.start_velocity_correction > 0.0 {
        say(format!(
            "initial corrections: position {}, velocity {}",
            rough(d.start_correction),
            rough(d.start_velocity_correction)
        ));
    }
    if let Some(prevented) = d.freedoms.prevented() {
        say(format!("warning: {prevented}"));
    }
    if d.partial {
        say(d.kept());
    }
    for line in MisfitDocument::lines(&d.misfits) {
        say(format!("within the tolerance: {line}"));
    }
    if let Some(spread) = &d.spread {
        say(format!(
            "effect of the choice of independent rows: {spread}"
        ));
    }
    for event in &d.events {
        say(format!("t = {:.6} s: {}", event.time, event.text));
    }
    if let Some(warning) = d.data.warning(d.mobility) {
        say(format!("warning: {warning}"));
    }
    let reactions = d.reactions.0.iter().map(|(name, r)| (name, &r.data));
    let groups = d.groups.0.iter().map(|(name, g)| (name, &g.data));
    let fragile = reactions.chain(groups).filter(|(_, data)| data.fragile);
    let fragile: Vec<&str> = fragile.map(|(name, _)| name.as_str()).collect();
    if !fragile.is_empty() {
        say(format!(
            "warning: unique but ill-determined (fragile) at the start: {}. The values of these reactions depend on the last digits of the data; summary.json names these data.",
            listed(&fragile),
        ));
    }
    if let Some(warning) = PullWarning::new(&d.pulls, PullTimes::Run) {
        out.push(Block::after(PullWarning::lead(), warning.to_string()));
    }
    out.extend(open(d).into_iter().map(Block::sentence));
    for (name, table) in &d.bodies.0 {
        let BodyOfRunDocument {
            file,
            choice,
            rows_left_out,
        } = table;
        if *choice {
            out.push(Block::sentence(format!(
                "The model does not determine all loads on `{name}`: {file} contains those of one of many solutions."
            )));
        } else if *rows_left_out > 0 {
            let rows = count(*rows_left_out, "row", "rows");
            out.push(Block::sentence(format!(
                "{file} omits {rows} at which a reaction on `{name}` is not determined."
            )));
        }
    }
    if let Some(bounds) = &d.bounds {
        let most = |(name, r): &'_ (String, RunReactionDocument)| {
            Some((name.clone(), r.magnitude_at_most?))
        };
        let loads = d.reactions.0.iter().filter_map(most);
        out.extend(largest_loads(bounds, loads.collect()));
    }
    if answer.has_report {
        let words = "open report.html in a browser";
        out.push(Block::sentence(words));
    }
    out
}

/// Lists the numbers that the model does not determine, and the files that contain values of these
/// numbers.
fn open(d: &RunDocument) -> Vec<String> {
    let of = |word: &str| -> Vec<&str> {
        let reactions = d.reactions.0.iter();
        let is = |r: &RunReactionDocument| r.of_run.as_ref().is_some_and(|v| v.verdict == word);
        let those = reactions.filter(|(_, r)| is(r));
        those.map(|(name, _)| name.as_str()).collect()
    };
    let mut out = Vec::new();
    let undecided = of("undecided");
    if !undecided.is_empty() {
        let names = listed(&undecided);
        out.push(format!(
            "undecided: {names}; see summary.json for the reasons."
        ));
    }
    let open = of("not_unique");
    let Some(solutions) = solutions(&d.choice).filter(|_| !open.is_empty()) else {
        return out;
    };
    let names = listed(&open);
    out.push(format!(
        "not determined by the model: {names}. reactions.csv contains only determined values; {solutions}.",
    ));
    let is_contact = |r: &RunReactionDocument| r.contact.is_some();
    let contacts = open.iter();
    let contacts = contacts.filter(|name| d.reactions.get(name).is_some_and(is_contact));
    let contacts: Vec<&str> = contacts.copied().collect();
    if !contacts.is_empty() {
        out.push(format!(
            "{}: one of many solutions may contain loads that these contacts do not permit; `pfaff analyze --at-time T` \
             prints the ranges that they permit.",
            marked(&contacts)
        ));
    }
    for (k, choice) in d.choice.iter().enumerate() {
        let Some(gap) = &choice.gap else { continue };
        let rows = count(gap.rows, "row", "rows");
        let file = choice.file.clone().unwrap_or_else(|| choice_file(k));
        let (first, reason) = (rounded(gap.first), &gap.reason);
        out.push(format!(
            "warning: {file} has empty cells in {rows}, the first at t = {first} s: {reason}"
        ));
    }
    let some = open.iter();
    let some = some.filter_map(|name| partly(name, d.reactions.get(name)?));
    let some: Vec<String> = some.collect();
    if !some.is_empty() {
        let some = some.join("; ");
        out.push(format!("determined during parts of the run: {some}."));
    }
    out
}

/// Describes which tables contain which solutions.
fn solutions(choices: &[ChoiceDocument]) -> Option<String> {
    let [first, others @ ..] = choices else {
        return None;
    };
    if first.file.is_none() {
        let more = match others {
            [] => "",
            _ => " at first; see summary.json for the others",
        };
        return Some(format!(
            "choice.csv contains one of many solutions ({first}{more})"
        ));
    }
    let each = choices.iter().filter_map(|choice| {
        let file = choice.file.as_ref()?;
        Some(format!("{file} contains one of many solutions ({choice})"))
    });
    Some(each.collect::<Vec<_>>().join("; "))
}

/// Lists the components of a reaction that are determined on parts of the run.
fn partly(name: &str, reaction: &RunReactionDocument) -> Option<String> {
    let components = reaction.components.0.iter();
    let some = components.filter(|(_, c)| !c.of_run.determined.is_empty());
    let some: Vec<String> = some
        .map(|(component, c)| format!("{name}.{component} on {}", c.of_run.on_intervals()))
        .collect();
    (!some.is_empty()).then(|| some.join(", "))
}
