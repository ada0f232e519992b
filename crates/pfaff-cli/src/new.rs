//! The command `pfaff new`: creates a scene from a template.

use std::path::PathBuf;

use pfaff::documents::{NewDocument, TemplateDocument, TemplatesDocument};
use pfaff::template::Template;
use pfaff::words::{self, Block};

use crate::args::New;
use crate::console::Console;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, replaces, write_file};

pub(crate) fn run(arguments: &New, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let Some(template) = arguments.template else {
        return list(arguments.json, console);
    };
    let path = match &arguments.out {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.toml", template.name())),
    };
    let standard_output = path.as_os_str() == "-";
    let file = if standard_output {
        format!("{}.toml", template.name())
    } else {
        path.display().to_string()
    };
    let text = template.scene(&file);
    if standard_output {
        return if arguments.json {
            Err(Failure::input(
                "--json and --out - both want standard output".to_owned(),
            ))
        } else {
            console.print(&text)
        };
    }
    write_file(&path, text.as_bytes(), replaces(arguments.force))?;
    if arguments.json {
        console.document(&NewDocument {
            ok: true,
            template: template.name(),
            file: &file,
        })
    } else {
        console.print(&format!("written to {file}\nnext: pfaff analyze {file}\n"))
    }
}

fn list(json: bool, console: &Console<'_>) -> Outcome {
    let all = Template::ALL.iter();
    if json {
        let document = |t: &Template| TemplateDocument {
            name: t.name(),
            summary: t.summary(),
        };
        return console.document(&TemplatesDocument {
            ok: true,
            templates: all.map(document).collect(),
        });
    }
    let lines = all.map(|t| [t.name().to_owned(), t.summary()]);
    let blocks = [
        Block::table(["template", "is"], lines),
        Block::sentence("`pfaff new TEMPLATE` writes one"),
    ];
    console.print(&words::text(&blocks, false))
}
