//! Questions that are repeated whenever a file changes.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

use crate::console::Console;
use crate::input::unreadable;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, visible};

/// Time between two checks of the files.
const PAUSE: Duration = Duration::from_millis(500);

/// Number of checks after which a missing file is reported. Editors may remove a file for a short
/// time when they save it.
const PATIENCE: usize = 3;

/// Prints the answer, and prints it again whenever one of the files has changed.
pub(crate) fn run(
    paths: &[PathBuf],
    console: &Console<'_>,
    ask: impl Fn() -> Result<String, Failure>,
) -> Outcome {
    if paths.iter().any(|path| path.as_os_str() == "-") {
        return Err(Failure::input(
            "--watch looks at a file again and again; standard input comes once".to_owned(),
        ));
    }
    // If a file does not exist at the beginning, the name of the file is wrong.
    let mut seen = stamps(paths)?;
    let named: Vec<String> = paths
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let heading = format!("──── {} ────\n", named.join(" "));
    let heading = visible(&heading);
    Interrupt::ends_well()?;
    loop {
        // The colour codes in an error text come from this program and are kept.
        let answer = ask().map(|text| visible(&text).into_owned());
        let answer = answer.unwrap_or_else(|failure| failure.words(console.is_coloured()));
        console.write(|out| write!(out, "{heading}{answer}"))?;
        seen = changed(paths, seen, |failure| {
            console.print(&format!("{heading}{}", failure.words(false)))
        })?;
    }
}

/// Waits until a file differs from its recorded properties, and reports a missing file.
fn changed(
    paths: &[PathBuf],
    seen: Vec<Stamp>,
    tell: impl Fn(Failure) -> Outcome,
) -> Result<Vec<Stamp>, Failure> {
    let mut missing = 0;
    loop {
        sleep(PAUSE);
        match stamps(paths) {
            Ok(stamps) if stamps != seen || missing >= PATIENCE => return Ok(stamps),
            Ok(_) => missing = 0,
            Err(failure) => {
                missing += 1;
                if missing == PATIENCE {
                    tell(failure)?;
                }
            }
        }
    }
}

fn stamps(paths: &[PathBuf]) -> Result<Vec<Stamp>, Failure> {
    let stamp = |path: &PathBuf| Stamp::of(path).map_err(|e| unreadable(path, &e));
    paths.iter().map(stamp).collect()
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
