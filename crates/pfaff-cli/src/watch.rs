//! `pfaff check --watch`: checks again whenever the file changes.

use std::fs;
use std::io;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, SystemTime};

use crate::args::Check;
use crate::check::Checked;
use crate::console::Console;
use crate::input::{Source, unreadable};
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, visible};

/// Time between two checks of the file.
const PAUSE: Duration = Duration::from_millis(500);

/// Number of checks after which a missing file is reported: editors replace a file by another one.
const PATIENCE: usize = 3;

pub(crate) fn run(arguments: &Check, console: &Console<'_>) -> Outcome {
    let path = &arguments.scene;
    if path.as_os_str() == "-" {
        return Err(Failure::input(
            "--watch looks at a file again and again; standard input comes once".to_owned(),
        ));
    }
    // A file that does not exist at the beginning has a wrong name.
    let mut seen = Stamp::of(path).map_err(|e| unreadable(path, &e))?;
    Interrupt::ends_well()?;
    arguments.resources.apply(console);
    loop {
        // Its colours are ours.
        let verdict = verdict(arguments, console);
        let heading = format!("──── {} ────\n", path.display());
        console.write(|out| write!(out, "{}{verdict}", visible(&heading)))?;
        seen = changed(path, seen, console)?;
    }
}

/// The text of a check, whether the scene is right or wrong.
fn verdict(arguments: &Check, console: &Console<'_>) -> String {
    let checked = Source::read(&arguments.scene, &arguments.known.settings, console)
        .map(|source| source.known(&arguments.known))
        .and_then(|source| Ok(Checked::of(&source, arguments.resources)?.describe()))
        .map(|text| visible(&text).into_owned());
    checked.unwrap_or_else(|failure| failure.words(console.is_coloured()))
}

/// Waits until the file differs from `seen`.
fn changed(path: &Path, seen: Stamp, console: &Console<'_>) -> Result<Stamp, Failure> {
    let mut missing = 0;
    loop {
        sleep(PAUSE);
        match Stamp::of(path) {
            Ok(stamp) if stamp != seen || missing >= PATIENCE => return Ok(stamp),
            Ok(_) => missing = 0,
            Err(e) => {
                missing += 1;
                if missing == PATIENCE {
                    console.print(&format!(
                        "──── {} ────\n{}",
                        path.display(),
                        unreadable(path, &e).words(false)
                    ))?;
                }
            }
        }
    }
}

/// Properties that change with a file.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
}

impl Stamp {
    fn of(path: &Path) -> io::Result<Self> {
        let known = fs::metadata(path)?;
        Ok(Self {
            modified: known.modified().ok(),
            length: known.len(),
        })
    }
}
