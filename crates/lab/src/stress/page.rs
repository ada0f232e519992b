//! Writes `report.html` of the stiff and extreme cases, one file that can be opened offline. The
//! cases that do not pass come first.

use super::document::{Judgement, StressDocument, StressFamily, StressRow};
use report::page::{add, close, duration, open, safe, short};

const EXPLANATION: &str = "<p>Each case has its right answer: a closed form, a value in exact arithmetic, another derivation, or the error that has \
to come; never what the program said before. An answer within its bound is <em>right</em>; an error that says what is wrong is <em>refused by name</em>. An \
error where an answer exists, or one that does not say what is wrong, does not pass and is listed first. Everything else is <em>silently wrong</em>: an \
answer beyond its bound, an answer where none exists, a panic, or nothing at all within the time allowed. Cells are errors, in the units of the bound beside \
them; hold the pointer over a cell for what came out.</p>\n";

/// Builds the page; `figure` is the SVG of [`super::extremes`].
#[must_use]
pub fn stress_page(document: &StressDocument, figure: &str) -> String {
    let mut page = open("Stiff and extreme cases");
    if document.partial {
        page.push_str("<p><strong>Interrupted: not all cases were made.</strong></p>\n");
    }
    let line = document.tally.last_line();
    add(&mut page, format_args!("<p><strong>{line}</strong></p>\n"));
    page.push_str(EXPLANATION);
    overview(&mut page, document);
    failing(&mut page, document);
    page.push_str(figure);
    for family in &document.families {
        section(&mut page, family);
    }
    close(&mut page, &document.provenance);
    page
}

/// Writes one line for each family.
fn overview(page: &mut String, document: &StressDocument) {
    page.push_str(
        "<div class=\"wide\"><table>\n<tr><th class=\"name\">family</th><th>right</th><th>refused</th><th>silently wrong</th>\
         <th>does not pass</th><th class=\"name\">what it asks</th></tr>\n",
    );
    for StressFamily {
        name, about, tally, ..
    } in &document.families
    {
        let line = format_args!(
            "<tr><td class=\"name\"><a href=\"#{name}\">{name}</a></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td class=\"status\">{}</td></tr>\n",
            tally.right,
            tally.refused,
            tally.silently_wrong,
            tally.failing,
            safe(about)
        );
        add(page, line);
    }
    page.push_str("</table></div>\n");
}

/// Writes the cases that do not pass, the worst first.
fn failing(page: &mut String, document: &StressDocument) {
    let all = document.families.iter().flat_map(|f| &f.rows);
    let mut rows: Vec<&StressRow> = all.filter(|row| !row.judgement.passes()).collect();
    if rows.is_empty() {
        page.push_str("<p>Everything passes.</p>\n");
        return;
    }
    rows.sort_by_key(|row| row.judgement != Judgement::SilentlyWrong);
    page.push_str(
        "<h2>What does not pass</h2>\n<div class=\"wide\"><table>\n<tr><th class=\"name\">family</th><th class=\"name\">case</th>\
         <th class=\"name\">method</th><th class=\"name\">formulation</th><th class=\"name\">judgement</th><th class=\"name\">right is</th>\
         <th>error</th><th class=\"name\">what came out</th></tr>\n",
    );
    for row in rows {
        page.push_str("<tr>");
        for cell in [
            row.family,
            &row.case,
            &row.method,
            &row.formulation,
            row.judgement.words(),
        ] {
            add(page, format_args!("<td class=\"name\">{}</td>", safe(cell)));
        }
        let rest = format_args!(
            "<td class=\"status\">{}</td><td>{}</td><td class=\"status\">{}</td></tr>\n",
            safe(&row.expected),
            short(row.error),
            safe(&row.outcome)
        );
        add(page, rest);
    }
    page.push_str("</table></div>\n");
}

/// Writes a table with a line for each case and a column for each pair of method and formulation.
fn section(page: &mut String, family: &StressFamily) {
    let head = format_args!(
        "<h2 id=\"{0}\">{0}</h2>\n<p>{1}</p>\n<p class=\"grey\">{2}, {3} of computing</p>\n",
        family.name,
        safe(family.about),
        family.tally.last_line(),
        duration(family.rows.iter().map(|row| row.seconds).sum())
    );
    add(page, head);
    let mut columns: Vec<(&str, &str)> = Vec::new();
    let mut lines: Vec<(&str, &str)> = Vec::new();
    for row in &family.rows {
        let column = (row.method.as_str(), row.formulation.as_str());
        let line = (row.case.as_str(), row.expected.as_str());
        if !columns.contains(&column) {
            columns.push(column);
        }
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    page.push_str("<div class=\"wide\"><table>\n<tr><th class=\"name\">case</th><th>bound</th>");
    for (method, formulation) in &columns {
        let head = format_args!("<th>{}<br>{}</th>", safe(method), safe(formulation));
        add(page, head);
    }
    page.push_str("<th class=\"name\">right is</th></tr>\n");
    for (case, expected) in lines {
        let own = |row: &&StressRow| row.case == case && row.expected == expected;
        let bound = family.rows.iter().find(own).map_or(f64::NAN, |r| r.bound);
        let head = format_args!(
            "<tr><td class=\"name\">{}</td><td>{}</td>",
            safe(case),
            short(bound)
        );
        add(page, head);
        for (method, formulation) in &columns {
            let in_column =
                |row: &&StressRow| row.method == *method && row.formulation == *formulation;
            let cells = family.rows.iter().filter(own).filter(in_column);
            page.push_str("<td>");
            for row in cells {
                cell(page, row);
            }
            page.push_str("</td>");
        }
        add(
            page,
            format_args!("<td class=\"status\">{}</td></tr>\n", safe(expected)),
        );
    }
    page.push_str("</table></div>\n");
    refusals(page, family);
}

fn cell(page: &mut String, row: &StressRow) {
    let text = match row.judgement {
        Judgement::Right => short(row.error),
        Judgement::Refused => "refused".to_owned(),
        Judgement::Limit => "<strong>limit</strong>".to_owned(),
        Judgement::Misnamed => "<strong>misnamed</strong>".to_owned(),
        Judgement::SilentlyWrong => format!("<strong>wrong {}</strong>", short(row.error)),
    };
    let title = safe(&row.outcome);
    add(page, format_args!("<span title=\"{title}\">{text}</span> "));
}

/// Writes the texts of error messages, without duplicates.
fn refusals(page: &mut String, family: &StressFamily) {
    let mut texts: Vec<&str> = Vec::new();
    for row in family
        .rows
        .iter()
        .filter(|r| r.judgement == Judgement::Refused)
    {
        if !texts.contains(&row.outcome.as_str()) {
            texts.push(&row.outcome);
        }
    }
    if texts.is_empty() {
        return;
    }
    let n = texts.len();
    add(
        page,
        format_args!("<details><summary>What refusals say ({n})</summary>\n<ul>\n"),
    );
    for text in texts {
        add(page, format_args!("<li>{}</li>\n", safe(text)));
    }
    page.push_str("</ul>\n</details>\n");
}
