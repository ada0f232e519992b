//! Verdicts as text: the table of joints and drives, the coupled reactions, and what would make
//! reactions unique. Static text, so that it is available without scripts and on paper.

use super::run_page::RunPage;
use crate::documents::{MakeUniqueDocument, ReactionDocument, RunReactionDocument};
use report::page::{add, safe, short};

/// Largest number of lines of a list.
pub(super) const MOST: usize = 40;

/// Largest number of ways to make a reaction unique that a sentence lists.
const WAYS: usize = 5;

/// Largest number of lines of the table.
const LINES: usize = 300;

pub(super) fn section(out: &mut String, page: &RunPage<'_>) {
    let title = match page.stretches {
        Some(_) => "Verdicts",
        None => "Verdicts at the start",
    };
    add(
        out,
        format_args!(
            "<section id=\"verdicts\" aria-labelledby=\"verdicts-title\">\n<h2 id=\"verdicts-title\">{title}</h2>\n"
        ),
    );
    match page.analysis {
        Some(analysis) => {
            let told = selected(&analysis.reactions);
            table(out, page, &told);
            if told.len() < analysis.reactions.len() {
                let more = analysis.reactions.len() - told.len();
                add(
                    out,
                    format_args!(
                        "<p class=\"grey\">{more} more are not listed; summary.json has all.</p>\n"
                    ),
                );
            }
            why(out, page);
        }
        None => out.push_str("<p>The verdicts are in summary.json.</p>\n"),
    }
    out.push_str("</section>\n");
}

/// If there are too many, those that are not unique, or fragile, come first.
fn selected(all: &[ReactionDocument]) -> Vec<&ReactionDocument> {
    if all.len() <= LINES {
        return all.iter().collect();
    }
    let (unique, open): (Vec<_>, Vec<_>) = all
        .iter()
        .partition(|r| r.wrench.verdict == "unique" && !r.data.fragile);
    open.into_iter().chain(unique).take(LINES).collect()
}

fn table(out: &mut String, page: &RunPage<'_>, reactions: &[&ReactionDocument]) {
    out.push_str(
        "<div class=\"wide tall\"><table>\n<thead><tr><th>Joint or drive</th><th>Type</th><th>Rows</th><th>Reaction</th>\
         <th>Margin</th><th>Why</th></tr></thead>\n<tbody>\n",
    );
    for r in reactions {
        let rows: Vec<String> = r.rows.iter().map(ToString::to_string).collect();
        let margin = match r.wrench.verdict {
            "unique" => "~0".to_owned(),
            _ => margin(r.wrench.margin),
        };
        let of_run = page.run().and_then(|run| run.reactions.get(&r.name));
        let verdict = of_run.map_or(r.wrench.verdict, RunReactionDocument::verdict);
        let mut said = verdict.replace('_', " ");
        if r.data.fragile {
            said.push_str(match verdict {
                "unique" => ", fragile",
                _ => ", unique parts fragile",
            });
        }
        let badge = if r.data.fragile { "fragile" } else { verdict };
        let why = match of_run {
            Some(run) if verdict != r.wrench.verdict => over_the_run(r, run),
            _ => reason(r),
        };
        add(
            out,
            format_args!(
                "<tr><td><b>{}</b></td><td data-label=\"Type\">{}</td><td class=\"number\" data-label=\"Rows\">{}</td>\
                 <td data-label=\"Reaction\"><span class=\"badge {badge}\">{said}</span></td>\
                 <td class=\"number\" data-label=\"Margin\">{margin}</td><td class=\"why\" data-label=\"Why\">{}</td></tr>\n",
                safe(&r.name),
                safe(r.kind),
                rows.join(", "),
                marked(&why)
            ),
        );
    }
    out.push_str("</tbody>\n</table></div>\n");
    out.push_str(
        "<p class=\"grey\">The margin tells how far a reaction is from unique: it is the norm of its part of the left null space of the \
         constraint matrix at the start, rows and columns equilibrated. Rows are counted from 1. Fx and Fy are global: where bodies turn, \
         other components are determined later than at the start. A verdict of a run holds on all of it.</p>\n",
    );
}

/// Why the verdict of the run is not that of the start.
fn over_the_run(r: &ReactionDocument, run: &RunReactionDocument) -> String {
    let start = r.wrench.verdict.replace('_', " ");
    let on = run.of_run.iter().flat_map(|track| &track.determined);
    let on: Vec<String> = on
        .map(|[from, to]| format!("{} … {} s", short(*from), short(*to)))
        .collect();
    let determined = match on.as_slice() {
        [] => String::new(),
        on => format!("; it is determined on {}", on.join(", ")),
    };
    format!("at the start alone it is {start}{determined}")
}

fn reason(r: &ReactionDocument) -> String {
    if let Some(reason) = &r.wrench.reason {
        return reason.clone();
    }
    let hanging = r.data.hangs_on.clone();
    if r.wrench.verdict == "unique"
        && let Some(text) = hanging
    {
        return text;
    }
    let why = because(r);
    match hanging {
        Some(text) => format!("{why}; {text}"),
        None => why,
    }
}

/// Why a reaction is unique or not, apart from what it depends on.
fn because(r: &ReactionDocument) -> String {
    match (&r.explanation, r.settled, r.wrench.verdict) {
        (Some(text), ..) => {
            // The column before contains this text.
            let known = format!("the reaction of `{}` is not determined: ", r.name);
            text.strip_prefix(&known).unwrap_or(text).to_owned()
        }
        (None, Some("bridge"), _) => {
            "nothing else connects the two parts of the mechanism that it joins".to_owned()
        }
        (None, Some(_), _) => {
            "it follows from the bodies at the ends of the mechanism alone".to_owned()
        }
        (None, None, "unique") => "no dependency of rows reaches it".to_owned(),
        (None, None, _) => components(r),
    }
}

fn components(r: &ReactionDocument) -> String {
    let each = r.components.iter();
    let words: Vec<String> = each
        .map(|c| format!("{} {}", c.name, c.verdict.verdict.replace('_', " ")))
        .collect();
    words.join(", ")
}

fn why(out: &mut String, page: &RunPage<'_>) {
    let Some(analysis) = page.analysis else {
        return;
    };
    let mixing = analysis.reasons.mixing.iter().map(|m| m.text.clone());
    let dependencies = analysis.reasons.dependencies.iter().map(|d| d.text.clone());
    let reasons: Vec<String> = mixing.chain(dependencies).map(|t| capital(&t)).collect();
    if !reasons.is_empty() {
        out.push_str("<h3>What is redundant</h3>\n");
        some(out, &reasons);
    }
    let hints = remedies(page.hints);
    if !hints.is_empty() {
        out.push_str("<h3>What would make a reaction unique, without a change of motion</h3>\n");
        some(out, &hints);
    }
    let notes = analysis.notes.iter().map(|note| note.text.clone());
    let known: Vec<String> = analysis.warnings.iter().cloned().chain(notes).collect();
    if !known.is_empty() {
        out.push_str("<h3>To be known</h3>\n");
        some(out, &known);
    }
}

/// What would make reactions unique: those with the same ways in one sentence.
fn remedies(hints: &[MakeUniqueDocument]) -> Vec<String> {
    let mut grouped: Vec<(Vec<String>, Vec<String>)> = Vec::new();
    for hint in hints {
        let ways = match &hint.reason {
            Some(reason) => vec![format!("not known: {reason}")],
            None => hint.ways.iter().map(|w| w.text.clone()).collect(),
        };
        let reaction = format!("`{}`", hint.reaction);
        match grouped.iter_mut().find(|(_, known)| *known == ways) {
            Some((reactions, _)) => reactions.push(reaction),
            None => grouped.push((vec![reaction], ways)),
        }
    }
    let sentence = |(reactions, ways): (Vec<String>, Vec<String>)| {
        let reactions = match reactions.split_last() {
            Some((last, first)) if !first.is_empty() => {
                format!("each of {} and {last}", first.join(", "))
            }
            _ => reactions.concat(),
        };
        if ways.len() > WAYS {
            let more = ways.len() - WAYS;
            let few = ways[..WAYS].join("; ");
            return format!("{reactions}: {few}; or {more} others, which `--make-unique` lists");
        }
        match ways.split_last() {
            None => format!("{reactions}: no small set of deletions was found"),
            Some((last, [])) => format!("{reactions}: {last}"),
            Some((last, first)) => format!("{reactions}: {}; or {last}", first.join("; ")),
        }
    };
    grouped.into_iter().map(sentence).collect()
}

fn some(out: &mut String, sentences: &[String]) {
    let few = &sentences[..sentences.len().min(MOST)];
    out.push_str("<ul>\n");
    for sentence in few {
        add(out, format_args!("<li>{}</li>\n", marked(sentence)));
    }
    out.push_str("</ul>\n");
    if few.len() < sentences.len() {
        let more = sentences.len() - few.len();
        add(out, format_args!("<p class=\"grey\">and {more} more</p>\n"));
    }
}

/// A number with two digits.
fn margin(x: f64) -> String {
    if x >= 0.01 {
        format!("{x:.2}")
    } else {
        short(x)
    }
}

/// Text in which names are enclosed in grave accents.
pub(super) fn marked(text: &str) -> String {
    let mut out = String::new();
    for (k, part) in text.split('`').enumerate() {
        match k % 2 {
            0 => out.push_str(&safe(part)),
            _ => add(&mut out, format_args!("<b>{}</b>", safe(part))),
        }
    }
    out
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
