//! The loads that contacts permit at the start, with the sentences and the table of `analyze`.

use super::run_page::RunPage;
use super::verdicts::marked;
use crate::contacts;
use crate::words::{Block, UnitSystem, cells_of_table};
use report::page::{add, safe};

pub(super) fn section(out: &mut String, page: &RunPage<'_>) {
    let Some(blocks) = page.analysis.and_then(contacts::blocks) else {
        return;
    };
    out.push_str("<h3>Contacts at the start</h3>\n");
    for block in &blocks {
        match block {
            Block::Sentence { lead, text } => {
                let text = format!("{lead}{text}.");
                add(out, format_args!("<p>{}</p>\n", marked(&text)));
            }
            Block::Table(lines) => table(
                out,
                &cells_of_table(lines, UnitSystem::Scene(page.scene.units)),
            ),
            Block::Heading(_) | Block::Legend(..) | Block::Gap | Block::Detail(_) => {}
        }
    }
}

/// Writes a table from its columns, whose first cells are the header.
fn table(out: &mut String, columns: &[Vec<String>]) {
    let lines = columns.first().map_or(0, Vec::len);
    out.push_str("<div class=\"wide\"><table>\n");
    for i in 0..lines {
        let mark = if i == 0 { "th" } else { "td" };
        let cells = columns.iter().map(|column| {
            let text = safe(column[i].trim());
            format!("<{mark}>{text}</{mark}>")
        });
        let cells: String = cells.collect();
        let line = match i {
            0 => format!("<thead><tr>{cells}</tr></thead>\n<tbody>\n"),
            _ => format!("<tr>{cells}</tr>\n"),
        };
        out.push_str(&line);
    }
    out.push_str("</tbody>\n</table></div>\n");
}
