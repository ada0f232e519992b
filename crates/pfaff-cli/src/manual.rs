//! Descriptions of the command and its files for other programs: schema, completions, manual pages.

use clap::CommandFactory;
use clap_mangen::Man;
use pfaff::questions::Questions;
use pfaff::scene;

use crate::args::{Arguments, Completions, Man as Page, Schema};
use crate::console::Console;
use crate::output::{Failure, Outcome};

/// The command `pfaff schema`.
pub(crate) fn schema(arguments: &Schema, console: &Console<'_>) -> Outcome {
    let all = Questions::FACTS.iter();
    let mut of_answer = all.filter(|facts| arguments.question.as_deref() == Some(facts.name));
    if let Some(facts) = of_answer.next() {
        return console.print(facts.schema);
    }
    console.print(&format!("{:#}\n", scene::schema(console.registry)))
}

/// The command `pfaff completions`.
pub(crate) fn completions(arguments: &Completions, console: &Console<'_>) -> Outcome {
    let mut out = Vec::new();
    let mut command = Arguments::command();
    clap_complete::generate(arguments.shell, &mut command, "pfaff", &mut out);
    console.print(&String::from_utf8_lossy(&out))
}

/// The command `pfaff man`.
pub(crate) fn page(arguments: &Page, console: &Console<'_>) -> Outcome {
    let mut whole = Arguments::command();
    whole.build();
    let command = match &arguments.command {
        None => whole,
        Some(name) => of_command(&whole, name)?,
    };
    // The examples are set separately, because the manual renderer would join their lines into
    // paragraphs.
    let examples = command.get_after_help().map(ToString::to_string);
    let command = command.after_help("");
    let mut out = Vec::new();
    let written = Man::new(command).render(&mut out);
    written.map_err(|e| Failure::stopped(format!("cannot make the page: {e}")))?;
    let mut text = String::from_utf8_lossy(&out).into_owned();
    if let Some(examples) = examples {
        text.push_str(".SH EXAMPLES AND REMARKS\n.nf\n");
        text.push_str(&set(&examples));
        text.push_str(".fi\n");
    }
    console.print(&text)
}

/// Formats lines in the syntax of `man`, without filling.
fn set(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let line = line.replace('\\', "\\e").replace('-', "\\-");
        // A point or an apostrophe at the beginning of a line would start a macro.
        if line.starts_with(['.', '\'']) {
            out.push_str("\\&");
        }
        out.push_str(&line);
        out.push('\n');
    }
    out
}

/// Finds the command whose page has this name.
fn of_command(whole: &clap::Command, name: &str) -> Result<clap::Command, Failure> {
    let commands = || {
        whole
            .get_subcommands()
            .filter(|command| command.get_name() != "help")
    };
    let found = commands().find(|command| command.get_name() == name);
    let found = found.ok_or_else(|| {
        let names: Vec<&str> = commands().map(clap::Command::get_name).collect();
        Failure::input(format!(
            "there is no command `{name}`; there are {}",
            names.join(", ")
        ))
    })?;
    let page = found.clone().display_name(format!("pfaff-{name}"));
    Ok(page.version(env!("CARGO_PKG_VERSION")))
}
