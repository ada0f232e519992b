//! `pfaff new`: creates a scene from a template.

use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use pfaff::report::documents::{NewDocument, TemplateDocument, TemplatesDocument};

use pfaff::model::codes::Code;

use crate::args::New;
use crate::console::Console;
use crate::output::{Failure, Outcome, columns};
use crate::template::Template;

pub(crate) fn run(arguments: &New, console: &Console<'_>) -> Outcome {
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
    write(&path, &text, arguments.force)?;
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

/// Writes a file; replaces an existing one only with `force`.
pub(crate) fn write(path: &Path, text: &str, force: bool) -> Outcome {
    let refused = |e: std::io::Error| {
        let name = path.display();
        match e.kind() {
            ErrorKind::AlreadyExists => Failure::input(format!(
                "`{name}` is there already; --force replaces it, --out writes another file"
            )),
            ErrorKind::NotFound => Failure::input(format!(
                "cannot write `{name}`: its directory does not exist"
            )),
            _ => Failure::input(format!("cannot write `{name}`: {e}")),
        }
        .coded(const { Code::new(3) })
    };
    let mut options = File::options();
    options.write(true);
    if force {
        options.create(true).truncate(true)
    } else {
        options.create_new(true)
    };
    let mut file = options.open(path).map_err(refused)?;
    let written = file.write_all(text.as_bytes());
    written.map_err(|e| Failure::stopped(format!("cannot write `{}`: {e}", path.display())))
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
    let mut rows = vec![["template", "is"].map(str::to_owned).to_vec()];
    rows.extend(all.map(|t| vec![t.name().to_owned(), t.summary()]));
    console.print(&format!(
        "{}\n`pfaff new TEMPLATE` writes one\n",
        columns(&rows)
    ))
}
