//! The complete page, from its head to its scripts. Names and sentences that come from the scene
//! are escaped at insertion.

use model::SpaceKind;
use model::words::{listed, rounded};

use super::cast::Cast;
use super::curves::{Curves, GROUPS, PLOTS, PRINTED};
use super::data::Data;
use super::run_page::{RunPage, Shows};
use super::{assumptions, inputs, motion, peaks, verdicts};
use crate::documents::{FreedomsDocument, RunDocument};
use crate::words::grouped;
use report::figures::LOOKS;
use report::page::{add, safe, short};

const STYLE: &str = include_str!("report.css");

/// Scripts in the order of their use. Together, the scripts form one module.
const SCRIPTS: [&str; 17] = [
    include_str!("script/data.js"),
    include_str!("script/poses.js"),
    include_str!("script/clock.js"),
    include_str!("script/shapes.js"),
    include_str!("script/solid.js"),
    include_str!("script/camera.js"),
    include_str!("script/looks.js"),
    include_str!("script/recorder.js"),
    include_str!("script/painters.js"),
    include_str!("script/loads.js"),
    include_str!("script/names.js"),
    include_str!("script/pointer.js"),
    include_str!("script/picture.js"),
    include_str!("script/first_order.js"),
    include_str!("script/chart.js"),
    include_str!("script/save.js"),
    include_str!("script/main.js"),
];

/// Content security policy: the page loads no external resource. Only data in the page itself are
/// allowed as addresses.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// Largest number of names that a sentence lists.
const LISTED: usize = 12;

pub(super) fn document(page: &RunPage<'_>) -> String {
    let cast = Cast::of(page.mechanism);
    let data = Data::new(page, &cast);
    let mut out = String::new();
    open(&mut out, page);
    head(&mut out, page);
    motion::section(&mut out, page, &data);
    match page.run() {
        Some(run) if page.is_for_customer() => {
            peaks::determined(&mut out, page);
            printed_curves(&mut out, page, &data.curves);
            assumptions::section(&mut out, page);
            events(&mut out, run);
            let omitted = inputs::left_out(page, &cast, &data.curves);
            out.push_str("<h3>Omitted from this report</h3>\n");
            verdicts::some(&mut out, &omitted);
            inputs::origin(&mut out, page);
            inputs::annexes(&mut out, page);
        }
        run => {
            if !matches!(page.shows, Shows::Mode(_)) {
                verdicts::section(&mut out, page);
            }
            if let Some(run) = run {
                curves(&mut out, page, run, &data.curves);
                assumptions::section(&mut out, page);
            }
            inputs::section(&mut out, page, &cast, &data.curves);
        }
    }
    out.push_str("</main>\n");
    if page.moves() {
        motion::transport(&mut out);
    }
    close(&mut out, &data);
    out
}

fn open(out: &mut String, page: &RunPage<'_>) {
    let name = safe(page.title());
    let class = if page.is_for_customer() {
        " class=\"customer\""
    } else {
        ""
    };
    add(
        out,
        format_args!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <meta name=\"generator\" content=\"pfaff {}\">\n<title>{name} – pfaff</title>\n\
             <style>\n{LOOKS}{STYLE}@page {{ @bottom-left {{ content: {} }} }}\n</style>\n</head>\n<body{class}>\n",
            env!("CARGO_PKG_VERSION"),
            footer(page)
        ),
    );
}

/// Returns the title and the project as a string of CSS, for the foot of printed pages.
fn footer(page: &RunPage<'_>) -> String {
    let case = page.run().and_then(|run| run.case.as_deref());
    let parts = [
        Some(page.title()),
        case,
        page.scene.cover.project.as_deref(),
    ];
    let parts: Vec<&str> = parts.into_iter().flatten().collect();
    let mut out = String::from("\"");
    for letter in parts.join(" · ").chars() {
        match letter {
            // Every character may be written as its number. The following characters would end the
            // text or the style.
            '"' | '\\' | '<' | '&' => add(&mut out, format_args!("\\{:x} ", u32::from(letter))),
            letter if letter.is_control() => out.push(' '),
            letter => out.push(letter),
        }
    }
    out.push('"');
    out
}

fn head(out: &mut String, page: &RunPage<'_>) {
    add(
        out,
        format_args!(
            "<header>\n<div class=\"head\"><div><p class=\"kicker\">{}</p>\n<h1>{}</h1></div>\n\
             <button id=\"theme\" type=\"button\">Dark</button></div>\n",
            match page.shows {
                Shows::Run(_) => "Motion and reactions",
                Shows::Mode(_) => "Mode of small motions",
                Shows::Start => "Start configuration",
            },
            safe(page.title())
        ),
    );
    let cover = &page.scene.cover;
    let case = page.run().and_then(|run| run.case.clone());
    let cover = [
        ("Load case", &case),
        ("Project", &cover.project),
        ("Author", &cover.author),
        ("Date", &cover.date),
    ];
    let lines = cover.into_iter().filter_map(|(what, text)| {
        let text = safe(text.as_deref()?);
        Some(format!("<dt>{what}</dt><dd>{text}</dd>\n"))
    });
    let lines: String = lines.collect();
    if !lines.is_empty() {
        add(out, format_args!("<dl class=\"cover\">\n{lines}</dl>\n"));
    }
    if let Some(run) = page.run().filter(|run| run.partial) {
        let why = run.error.as_deref().unwrap_or_default();
        add(
            out,
            format_args!(
                "<p class=\"warning\"><b>Partial:</b> the run ended at t = {} s. {}. The page shows the motion up to this time.</p>\n",
                rounded(run.t_end),
                verdicts::marked(&sentence(why))
            ),
        );
    }
    add(
        out,
        format_args!("<p class=\"answer\">{}</p>\n", answer(page)),
    );
    if page.is_for_customer() {
        verdicts::ways(out, page);
        out.push_str("</header>\n<main>\n");
        return;
    }
    if !page.scene.inactive.is_empty() {
        let names = verdicts::marked(&page.scene.inactive.join(", "));
        add(
            out,
            format_args!(
                "<p class=\"grey\">Inactive elements, excluded from this model: {names}.</p>\n"
            ),
        );
    }
    let free = page
        .freedoms()
        .map(FreedomsDocument::sentences)
        .unwrap_or_default();
    if !free.is_empty() {
        out.push_str("<ul class=\"free-motions\">\n");
        for (lead, text) in &free {
            let (lead, text) = (sentence(lead), verdicts::marked(text));
            add(out, format_args!("<li>{lead}: {text}</li>\n"));
        }
        out.push_str("</ul>\n");
    }
    let verdicts = match page.shows {
        Shows::Mode(_) => "",
        _ => {
            tiles(out, page);
            "<a href=\"#verdicts\">Verdicts</a> "
        }
    };
    let of_run = match page.run() {
        Some(_) => {
            "<a href=\"#reactions\">Reactions</a> <a href=\"#curves\">Curves and checks</a> <a href=\"#assumptions\">Assumptions</a> "
        }
        None => "",
    };
    add(
        out,
        format_args!(
            "<nav aria-label=\"Sections\"><a href=\"#motion\">{}</a> {verdicts}{of_run}\
             <a href=\"#inputs\">Inputs and versions</a></nav>\n</header>\n<main>\n",
            motion::title(page)
        ),
    );
}

/// Returns one or two sentences with the main result.
fn answer(page: &RunPage<'_>) -> String {
    if let Shows::Mode(words) = page.shows {
        return safe(words);
    }
    let all = page.verdicts();
    let of = |word: &str| -> Vec<&str> {
        let of_it = all.iter().filter(|(_, verdict, _)| *verdict == word);
        of_it.map(|(name, ..)| *name).collect()
    };
    let (unique, open, doubt) = (of("unique"), of("not_unique"), of("undecided"));
    // Selects reactions that are ill-determined as a whole, or reactions with ill-determined unique
    // components.
    let of_fragile = |is_whole: bool| -> Vec<&str> {
        let of_it = all
            .iter()
            .filter(|(_, verdict, is_fragile)| *is_fragile && (*verdict == "unique") == is_whole);
        of_it.map(|(name, ..)| *name).collect()
    };
    let (fragile, partly) = (of_fragile(true), of_fragile(false));
    let mut text = String::new();
    if let Some(a) = page.analysis {
        if a.configuration.rows == 0 {
            return "The mechanism has no constraints: all bodies move freely.".to_owned();
        }
        let rows = match a.configuration.rows {
            1 => "The one constraint row has".to_owned(),
            n => format!("The {n} constraint rows have"),
        };
        let redundant = match a.ranks.redundancy {
            0 => "no row is redundant".to_owned(),
            1 => "one row is redundant".to_owned(),
            p => format!("{} rows are redundant", count(p)),
        };
        let mut freedoms = match a.ranks.mobility {
            _ if page.freedoms().is_some_and(|f| f.cannot_move == Some(true)) => {
                "The mechanism cannot move".to_owned()
            }
            1 => "The mobility is one".to_owned(),
            f => format!("The mobility is {}", count(f)),
        };
        if let Some(without) = page.freedoms().and_then(|f| f.without_drives.as_ref()) {
            let left = count(without.mobility);
            freedoms += &format!(
                " with {}, and the mobility without drives is {left}",
                without.possessive()
            );
        }
        add(
            &mut text,
            format_args!("{rows} rank {}: {redundant}. {freedoms}. ", a.ranks.rank),
        );
    }
    match (unique.as_slice(), open.as_slice()) {
        ([], []) => {}
        (_, []) if !fragile.is_empty() => {
            add(&mut text, format_args!("<b>{}</b>. ", hanging(&fragile)));
            text.push_str(match (fragile.len() == unique.len(), doubt.is_empty()) {
                (true, _) => "",
                (false, true) => "All other reactions are unique. ",
                (false, false) => "All other reactions with a decided verdict are unique. ",
            });
        }
        (_, []) => text.push_str("<b>All reactions with a decided verdict are unique.</b> "),
        ([], names) => add(
            &mut text,
            format_args!(
                "<b>No reaction is unique</b>: the model does not determine the reactions of {}. ",
                names_in_words(names)
            ),
        ),
        (some, names) => add(
            &mut text,
            format_args!(
                "The reactions of {} are unique. <b>The reactions of {} are not unique</b>: the model does not determine them. ",
                names_in_words(some),
                names_in_words(names)
            ),
        ),
    }
    if !open.is_empty() && !fragile.is_empty() {
        add(&mut text, format_args!("<b>{}</b>. ", hanging(&fragile)));
    }
    if !partly.is_empty() {
        add(
            &mut text,
            format_args!(
                "<b>Unique components of the reactions of {} are fragile: they depend on the last digits of the data</b>. ",
                names_in_words(&partly)
            ),
        );
    }
    if !doubt.is_empty() {
        add(
            &mut text,
            format_args!("The verdict is undecided for {}. ", names_in_words(&doubt)),
        );
    }
    combined(&mut text, page);
    let contacts = page.analysis.and_then(|a| a.answers.contacts.as_ref());
    if let Some(tips) = contacts.and_then(|contacts| contacts.tips.as_ref()) {
        let tips = verdicts::marked(&sentence(tips));
        add(&mut text, format_args!("<b>{tips}.</b> "));
    }
    // The text is shorter if no verdict is undecided.
    if doubt.is_empty() {
        text = text.replace(
            "All reactions with a decided verdict are unique",
            "All reactions are unique",
        );
    }
    text.trim_end().to_owned()
}

/// States the verdicts on groups.
fn combined(text: &mut String, page: &RunPage<'_>) {
    let Some(run) = page.run() else {
        return;
    };
    for (word, verdict) in [
        ("unique", "unique"),
        ("not_unique", "not unique"),
        ("undecided", "undecided"),
    ] {
        let of_it = run.groups.0.iter();
        let of_it = of_it.filter(|(_, group)| group.of_run.verdict == word);
        // The name of a group may have several words.
        let names: Vec<String> = of_it.map(|(name, _)| format!("“{name}”")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let (reactions, are) = match names.len() {
            0 => continue,
            1 => ("reaction", "is"),
            _ => ("reactions", "are"),
        };
        let names = names_in_words(&names);
        add(
            text,
            format_args!("The combined {reactions} of {names} {are} {verdict}. "),
        );
    }
}

/// States that some unique reactions are sensitive to the data.
fn hanging(names: &[&str]) -> String {
    let names_in_words = names_in_words(names);
    match names.len() {
        1 => format!(
            "The reaction of {names_in_words} is unique but fragile: it depends on the last digits of the data"
        ),
        _ => format!(
            "The reactions of {names_in_words} are unique but fragile: they depend on the last digits of the data"
        ),
    }
}

/// Writes small numbers as words.
fn count(n: usize) -> String {
    let words = [
        "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
    ];
    words
        .get(n)
        .map_or_else(|| n.to_string(), |word| (*word).to_owned())
}

fn names_in_words(names: &[&str]) -> String {
    let few: Vec<String> = names.iter().take(LISTED).map(|n| safe(n)).collect();
    match (names.len() - few.len(), few.as_slice()) {
        (0, [one]) => one.clone(),
        (0, [most @ .., last]) => format!("{} and {last}", most.join(", ")),
        (more, _) => format!("{} and {more} more", few.join(", ")),
    }
}

fn tiles(out: &mut String, page: &RunPage<'_>) {
    let mut tiles: Vec<(String, &str)> = Vec::new();
    if let Some(a) = page.analysis {
        tiles.push((
            format!("{} of {}", a.ranks.rank, a.configuration.rows),
            "independent constraint rows",
        ));
        tiles.push((a.ranks.redundancy.to_string(), "degree of redundancy"));
        tiles.push((a.ranks.mobility.to_string(), "mobility"));
        if let Some(without) = page.freedoms().and_then(|f| f.without_drives.as_ref()) {
            tiles.push((without.mobility.to_string(), "mobility without drives"));
        }
    }
    let all = page.verdicts();
    let unique = all
        .iter()
        .filter(|(_, verdict, _)| *verdict == "unique")
        .count();
    tiles.push((format!("{unique} of {}", all.len()), "unique reactions"));
    match all.iter().filter(|(.., is_fragile)| *is_fragile).count() {
        0 => {}
        n => tiles.push((n.to_string(), "reactions with fragile components")),
    }
    if let Some(run) = page.run() {
        tiles.push((format!("{} s", rounded(run.t_end)), "simulated time"));
        tiles.push((
            short(run.max_position_residual),
            "largest constraint violation |Φ|",
        ));
        tiles.push((short(run.energy_balance), "relative energy error"));
    }
    out.push_str("<ul class=\"tiles\">\n");
    for (value, words) in tiles {
        add(
            out,
            format_args!("<li><b>{value}</b><span>{words}</span></li>\n"),
        );
    }
    out.push_str("</ul>\n");
}

/// Writes empty elements for the curves of a page for print; scripts add their contents.
fn printed_curves(out: &mut String, page: &RunPage<'_>, curves: &Curves) {
    if curves.charts.is_empty() {
        return;
    }
    let title = if page.plots.is_empty() {
        "Determined curves"
    } else {
        "Curves"
    };
    add(
        out,
        format_args!(
            "<section aria-labelledby=\"curves-title\">\n<h2 id=\"curves-title\">{title}</h2>\n<div class=\"curves\" id=\"{PRINTED}\"></div>\n</section>\n"
        ),
    );
}

/// Writes empty elements for the curves; scripts add their contents.
fn curves(out: &mut String, page: &RunPage<'_>, run: &RunDocument, curves: &Curves) {
    out.push_str(
        "<section id=\"reactions\" aria-labelledby=\"reactions-title\">\n<h2 id=\"reactions-title\">Reactions</h2>\n\
         <div class=\"picker\"><label for=\"joint\">Joint or drive</label> <select id=\"joint\"></select> \
         <label for=\"frame\">Components</label> <select id=\"frame\"><option value=\"global\">in global axes</option>\
         <option value=\"body\">in axes of the first body</option></select></div>\n\
         <p id=\"reaction-words\"></p>\n<div id=\"reaction-legend\"></div>\n<div class=\"curves\" id=\"reaction-curves\"></div>\n",
    );
    out.push_str(
        "<details class=\"on-request\" id=\"all-reactions\"><summary>Curves of all reactions</summary>\n\
         <p class=\"grey\">The curves are drawn when this section is opened. They are printed only if it is open.</p>\n<div id=\"all-curves\"></div>\n</details>\n</section>\n",
    );
    for (place, title) in [
        (GROUPS, "Combined reactions (groups)"),
        (PLOTS, "Requested plots"),
    ] {
        if curves.charts.iter().any(|chart| chart.place == place) {
            add(
                out,
                format_args!(
                    "<section aria-labelledby=\"{place}-title\">\n<h2 id=\"{place}-title\">{title}</h2>\n<div class=\"curves\" id=\"{place}\"></div>\n</section>\n"
                ),
            );
        }
    }
    out.push_str(
        "<section id=\"own-plot\" aria-labelledby=\"own-plot-title\">\n<h2 id=\"own-plot-title\">Several curves in one plot</h2>\n\
         <div class=\"picker\"><label for=\"own-curve\">Add a curve</label> <select id=\"own-curve\"></select> \
         <button id=\"own-clear\" type=\"button\">Remove all</button></div>\n\
         <p class=\"grey screen\">All curves of a plot have one unit. The plot is printed if it has curves. The key <code>plots</code> of <code>[output]</code> keeps plots in the scene.</p>\n\
         <div id=\"own-chart\"></div>\n</section>\n",
    );
    peaks::table(out, page);
    out.push_str(
        "<section id=\"curves\" aria-labelledby=\"curves-title\">\n<h2 id=\"curves-title\">Motion of bodies</h2>\n",
    );
    let units = page.scene.units;
    let units = units.length.into_iter().chain(units.angle);
    let units: Vec<&str> = units.map(|unit| unit.0).collect();
    if !units.is_empty() {
        add(
            out,
            format_args!(
                "<p class=\"grey\">Lengths and angles of these curves are in the units of the scene ({}). Values at the pointer are also shown in SI units. All files use SI units.</p>\n",
                safe(&units.join(", "))
            ),
        );
    }
    out.push_str("<div class=\"curves\">");
    let panels = match page.mechanism.space() {
        SpaceKind::Space3 => &[("a", "First"), ("b", "Second"), ("c", "Third")][..],
        _ => &[("a", "First"), ("b", "Second")],
    };
    for (letter, count) in panels {
        add(
            out,
            format_args!(
                "<div><div class=\"picker\"><select id=\"quantity-{letter}\" aria-label=\"{count} quantity\"></select></div>\
                 <div id=\"motion-{letter}\"></div></div>"
            ),
        );
    }
    out.push_str("</div>\n");
    let has_measures = !page.mechanism.frames().observed().measures.is_empty();
    let has_forces = !page.mechanism.applied_forces().is_empty();
    for (place, title, is_shown) in [
        (
            "measure",
            "Measures (quantities between markers)",
            has_measures,
        ),
        (
            "load",
            "Loads of force elements on their first bodies",
            has_forces,
        ),
        ("drive", "Drives", !page.drives.is_empty()),
    ] {
        if is_shown {
            add(
                out,
                format_args!(
                    "<h2>{title}</h2>\n<div class=\"curves\" id=\"{place}-curves\"></div>\n"
                ),
            );
        }
    }
    out.push_str("<h2>Energy and checks</h2>\n<div class=\"curves\" id=\"energy-curves\"></div>\n");
    events(out, run);
    if let Some(figure) = page.work_precision {
        out.push_str("<h2>Error against run time</h2>\n");
        add(
            out,
            format_args!(
                "<img alt=\"Error against run time, with one curve for each compared method\" src=\"data:image/svg+xml,{}\">\n",
                encoded(figure)
            ),
        );
    }
    out.push_str("</section>\n");
}

/// Lists the events. Events with the same text share a line.
fn events(out: &mut String, run: &RunDocument) {
    if run.events.is_empty() {
        return;
    }
    out.push_str("<h3>Events</h3>\n<ul>\n");
    let events = run.events.iter();
    let events = events.map(|event| (event.text.as_str(), format!("{:.6}", event.time)));
    for (text, times) in grouped(events).iter().take(verdicts::MOST) {
        let (times, text) = (listed(times), safe(text));
        add(
            out,
            format_args!("<li><b>t = {times} s</b> – {text}</li>\n"),
        );
    }
    out.push_str("</ul>\n");
}

fn close(out: &mut String, data: &Data<'_>) {
    // The data contain only numbers and names, so this cannot fail.
    let json = report::part_as_json(data).unwrap_or_else(|_| "null".to_owned());
    add(
        out,
        format_args!(
            "<script id=\"data\" type=\"application/json\">{}</script>\n<script type=\"module\">\n",
            harmless(&json)
        ),
    );
    for script in SCRIPTS {
        out.push_str(script);
    }
    out.push_str("</script>\n</body>\n</html>\n");
}

/// Returns JSON that cannot end a script. The character `<` occurs only in strings, and in strings
/// it may be written as an escape.
fn harmless(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// Adds a capital letter at the beginning and removes a full stop at the end.
fn sentence(text: &str) -> String {
    let mut letters = text.trim_end_matches('.').chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// A text as part of an address.
fn encoded(text: &str) -> String {
    let mut out = String::with_capacity(2 * text.len());
    for byte in text.bytes() {
        match byte {
            b'A'..=b'Z'
            | b'a'..=b'z'
            | b'0'..=b'9'
            | b'-'
            | b'_'
            | b'.'
            | b'!'
            | b'~'
            | b'*'
            | b'('
            | b')'
            | b' '
            | b'='
            | b':'
            | b'/'
            | b';'
            | b',' => out.push(char::from(byte)),
            _ => add(&mut out, format_args!("%{byte:02X}")),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    const RECORDER: &str = include_str!("script/recorder.js");

    /// This script uses a context only to find the element under the pointer. It paints nothing.
    const POINTER: &str = include_str!("script/pointer.js");

    /// Members of the context that only the screen has. In the SVG file, a hatch becomes an SVG
    /// pattern, and a `Pen` draws the symbols that the screen draws as stamps.
    const OF_THE_SCREEN: [&str; 2] = ["createPattern", "drawImage"];

    /// Returns the members of `context` that a script uses.
    fn members_of_context(script: &'static str) -> BTreeSet<&'static str> {
        let named = script.split("context.").skip(1);
        named
            .map(|rest| {
                let end = rest.find(|c: char| !c.is_ascii_alphanumeric());
                &rest[..end.unwrap_or(rest.len())]
            })
            .collect()
    }

    #[test]
    fn a_picture_in_a_file_has_all_that_painters_use() {
        let painters = SCRIPTS.into_iter().filter(|script| *script != POINTER);
        let used: BTreeSet<&str> = painters.flat_map(members_of_context).collect();
        assert!(used.len() > 20, "members are not found: {used:?}");
        let lacking: Vec<&&str> = used
            .iter()
            .filter(|name| !OF_THE_SCREEN.contains(name))
            .filter(|name| !RECORDER.contains(&format!("\n  {name}(")))
            .filter(|name| !RECORDER.contains(&format!(" {name}: ")))
            .collect();
        assert!(lacking.is_empty(), "add to `Recorder`: {lacking:?}");
    }

    /// A `Path2D` that is not a `Path` cannot be written as SVG.
    #[test]
    fn only_paths_that_can_be_written_are_painted() {
        for script in SCRIPTS {
            assert!(!script.contains("new Path2D("), "take a `Path`");
        }
    }
}
