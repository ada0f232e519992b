//! The command `pfaff explain`: prints the meaning of an error code, and the possible remedies.

use pfaff::documents::CodesDocument;
use pfaff::explain;
use pfaff::model::codes::{Entry, PAGE, entries};

use crate::args::Explain;
use crate::console::Console;
use crate::output::Outcome;

pub(crate) fn run(arguments: &Explain, console: &Console<'_>) -> Outcome {
    if arguments.book {
        return console.print(PAGE);
    }
    let Some(text) = &arguments.code else {
        if arguments.json {
            return console.document(&CodesDocument::new(entries()));
        }
        let line = |entry: &Entry| format!("{}  {}\n", entry.code, entry.title);
        return console.print(&entries().iter().map(line).collect::<String>());
    };
    let entry = explain::entry(text)?;
    if arguments.json {
        return console.document(&CodesDocument::new(std::slice::from_ref(entry)));
    }
    console.print(&explain::words(entry))
}
