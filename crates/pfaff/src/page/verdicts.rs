//! Verdicts as text: the table of joints and drives, the coupled reactions, and deletions that
//! would make reactions unique. The text is static, so that it is available without scripts and in
//! print.

use super::contacts;
use super::run_page::RunPage;
use crate::documents::{MakeUniqueDocument, ReactionDocument, RunReactionDocument};
use crate::words::grouped;
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
                        "<p class=\"grey\">The table omits {more} joints and drives. The file summary.json contains all of them.</p>\n"
                    ),
                );
            }
            contacts::section(out, page);
            why(out, page);
        }
        None => out.push_str("<p>The file summary.json contains the verdicts.</p>\n"),
    }
    out.push_str("</section>\n");
}

/// If there are too many reactions, reactions that are not unique or are ill-determined come first.
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
                _ => ", unique components fragile",
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
        "<p class=\"grey\">The margin measures how far a reaction is from being unique. It is the norm of the part of the left null space \
         of the constraint matrix that belongs to the reaction. The matrix is taken at the start and has equilibrated rows and columns. Row numbers begin at 1. \
         Fx and Fy are components in global axes. If bodies rotate, the determined components can differ from those at the start. \
         The verdict of a run applies to the whole run.</p>\n",
    );
}

/// Explains why the verdict on the run differs from the verdict on the initial state.
fn over_the_run(r: &ReactionDocument, run: &RunReactionDocument) -> String {
    let start = r.wrench.verdict.replace('_', " ");
    let on = run.of_run.iter().flat_map(|track| &track.determined);
    let on: Vec<String> = on
        .map(|[from, to]| format!("{} … {} s", short(*from), short(*to)))
        .collect();
    let determined = match on.as_slice() {
        [] => String::new(),
        on => format!("; over the run, it is determined on {}", on.join(", ")),
    };
    format!("at the start, the reaction is {start}{determined}")
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

/// Explains why a reaction is unique or not. The explanation does not contain the data on which the
/// reaction depends.
fn because(r: &ReactionDocument) -> String {
    match (&r.explanation, r.settled, r.wrench.verdict) {
        (Some(text), ..) => {
            // The previous column of the table already contains this text.
            let known = format!("the reaction of `{}` is not determined: ", r.name);
            text.strip_prefix(&known).unwrap_or(text).to_owned()
        }
        (None, Some("bridge"), _) => {
            "it is the only connection between the two parts of the mechanism that it joins".to_owned()
        }
        (None, Some(_), _) => {
            "it can be computed from the free ends of the mechanism inwards, without the joints that share loads".to_owned()
        }
        (None, None, "unique") => "its rows are not part of any linear dependency of constraint rows".to_owned(),
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
        out.push_str("<h3>Redundant constraints</h3>\n");
        some(out, &reasons);
    }
    ways(out, page);
    let known = notes(page);
    if !known.is_empty() {
        out.push_str("<h3>Warnings and notes</h3>\n");
        some(out, &known);
    }
}

/// Lists changes of the mechanism that would make reactions unique, if any are known.
pub(super) fn ways(out: &mut String, page: &RunPage<'_>) {
    let retyped = page.analysis.iter().flat_map(|a| &a.answers.remedies);
    let retyped = retyped.map(|remedy| capital(&remedy.text));
    let hints: Vec<String> = retyped.chain(remedies(page.hints)).collect();
    if !hints.is_empty() {
        out.push_str("<h3>Ways to make a reaction unique without changing the motion</h3>\n");
        some(out, &hints);
    }
}

/// Returns the warnings and notes on the scene.
pub(super) fn notes(page: &RunPage<'_>) -> Vec<String> {
    let Some(analysis) = page.analysis else {
        return Vec::new();
    };
    let notes = analysis.notes.iter().map(|note| note.text.clone());
    analysis.warnings.iter().cloned().chain(notes).collect()
}

/// Lists deletions that would make reactions unique. Reactions with the same deletions share a
/// sentence.
fn remedies(hints: &[MakeUniqueDocument]) -> Vec<String> {
    let ways = |hint: &MakeUniqueDocument| {
        let ways = match &hint.reason {
            Some(reason) => vec![format!("unknown: {reason}")],
            None => hint.ways.iter().map(|w| w.text.clone()).collect(),
        };
        (ways, format!("`{}`", hint.reaction))
    };
    let sentence = |(ways, reactions): (Vec<String>, Vec<String>)| {
        let reactions = match reactions.split_last() {
            Some((last, first)) if !first.is_empty() => {
                format!("each of {} and {last}", first.join(", "))
            }
            _ => reactions.concat(),
        };
        if ways.len() > WAYS {
            let more = ways.len() - WAYS;
            let few = ways[..WAYS].join("; ");
            return format!(
                "{reactions}: {few}; or {more} other sets of deletions (`--make-unique` lists them)"
            );
        }
        match ways.split_last() {
            None => format!("{reactions}: the search found no small set of deletions"),
            Some((last, [])) => format!("{reactions}: {last}"),
            Some((last, first)) => format!("{reactions}: {}; or {last}", first.join("; ")),
        }
    };
    grouped(hints.iter().map(ways))
        .into_iter()
        .map(sentence)
        .collect()
}

/// Writes sentences as a list. In the sentences, names are enclosed in grave accents.
pub(super) fn some(out: &mut String, sentences: &[String]) {
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

/// Formats a number with two digits.
fn margin(x: f64) -> String {
    if x >= 0.01 {
        format!("{x:.2}")
    } else {
        short(x)
    }
}

/// Marks names that are enclosed in grave accents.
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
