//! The loads that contacts permit at the start, with the sentences and the table of `analyze`.

use super::run_page::RunPage;
use super::verdicts::marked;
use crate::contacts;
use crate::words::{Block, html_table};
use report::page::add;

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
            Block::Table(lines) => out.push_str(&html_table(lines)),
            Block::Heading(_) | Block::Legend(..) | Block::Gap | Block::Detail(_) => {}
        }
    }
}
