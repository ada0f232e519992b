//! Keys of `[scene]` for the title of a report. These keys have no effect on the mechanism. The
//! program reads no clock, so the same scene gives the same report.

use crate::key::{Key, Takes};
use crate::mistake::Mistake;
use crate::section;
use crate::table::Table;

/// Largest number of characters of each text: about three lines of a printed title.
const LONGEST: usize = 200;

/// The title of a report, as the scene states it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cover {
    /// Title; without it, the name of the scene is the title.
    pub title: Option<String>,
    /// Author.
    pub author: Option<String>,
    /// Project.
    pub project: Option<String>,
    /// Date, as the author writes it.
    pub date: Option<String>,
}

const EXPECTED: &str = "a text of one line, in quotes";

const fn line(name: &'static str) -> Key {
    Key::optional(name, EXPECTED, Takes::Text)
}

const TITLE: Key = line("title").doc("The title of reports; without it, the name of the scene");
const AUTHOR: Key = line("author").doc("The author, for the title of reports");
const PROJECT: Key = line("project").doc("The project, for the title of reports");
const DATE: Key =
    line("date").doc("The date, for the title of reports; the program reads no clock");

/// The keys of `[scene]`.
pub(crate) const SCENE_KEYS: [Key; 4] = [TITLE, AUTHOR, PROJECT, DATE];

impl Cover {
    /// Reads the keys; an empty text counts as absent.
    pub(crate) fn read(table: &mut Table) -> Self {
        let [title, author, project, date] = SCENE_KEYS.map(|key| {
            let field = table.optional(&key)?;
            let text = field.text(EXPECTED)?.trim();
            if let Some(reason) = section::unfit_line(text, LONGEST, "texts of a title") {
                let message = format!(": `{}` {reason}", key.name);
                field.error(Mistake::UnfitName, message, "write one short line");
            }
            (!text.is_empty()).then(|| text.to_owned())
        });
        Self {
            title,
            author,
            project,
            date,
        }
    }
}
