//! `pfaff explain`: what the code of an error means, and what to do.

use pfaff::model::codes::{Code, Entry, Example, PAGE, entries};

use pfaff::report::documents::CodesDocument;

use crate::args::Explain;
use crate::console::Console;
use crate::output::{Failure, Outcome, wrapped};

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
    let Some(entry) = Code::find(text) else {
        return Err(Failure::input(format!(
            "there is no code `{text}`; `pfaff explain` lists all"
        )));
    };
    if arguments.json {
        return console.document(&CodesDocument::new(std::slice::from_ref(entry)));
    }
    console.print(&describe(entry))
}

fn describe(entry: &Entry) -> String {
    let mut text = wrapped(&format!("{}: ", entry.code), entry.title);
    text.push_str(&wrapped("what to do: ", entry.advice));
    match entry.example {
        Example::Scene(arguments, scene) => {
            text.push_str(&format!("example: pfaff {arguments}, with the scene\n\n"));
            for line in scene.trim().lines() {
                text.push_str(format!("    {line}").trim_end());
                text.push('\n');
            }
        }
        Example::Command(arguments) => text.push_str(&format!("example: pfaff {arguments}\n")),
        Example::None(reason) => text.push_str(&format!("no short example: {reason}\n")),
    }
    text
}
