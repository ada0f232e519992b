//! The command `lab generate`: writes a large scene with a known answer to a file or to standard
//! output.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pfaff::report::OutputDirectory;
use serde_json::json;
use suite::generate::{Answer, Generator, Kind, Order};

use pfaff_cli::console::Console;
use pfaff_cli::input::LARGEST;
use pfaff_cli::interrupt::Interrupt;
use pfaff_cli::named;
use pfaff_cli::output::{Failure, Outcome, count};

#[derive(Args)]
pub(super) struct Generate {
    /// Family of mechanisms
    #[arg(value_parser = named(Kind::ALL, Kind::name))]
    kind: Kind,
    /// Size: number of loops, cells, cells along each side, robots, modules
    #[arg(long, value_name = "N")]
    n: usize,
    /// Seed of the random choices (parallelograms, random); default: 1
    #[arg(long, value_name = "SEED")]
    seed: Option<u64>,
    /// Fraction of the cells, blocks or modules that are redundant, 0 to 1
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    redundant: Option<f64>,
    /// File for the scene; default: standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The known answer of the scene as one JSON document on standard output
    #[arg(long, requires = "out")]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &Generate, console: &Console<'_>) -> Outcome {
    let order = Order {
        kind: arguments.kind,
        n: arguments.n,
        seed: arguments.seed,
        redundant: arguments.redundant,
    };
    let generator = order
        .generate()
        .map_err(|e| Failure::input(e.to_string()))?;
    let Some(path) = &arguments.out else {
        Interrupt::ends_at_once()?;
        return to_standard_output(&generator, console);
    };
    let bytes = to_file(&generator, path)?;
    if arguments.json {
        console.print(&format!("{:#}\n", facts(&generator, path, bytes)))
    } else {
        console.print(&describe(&generator, path, bytes))
    }
}

fn to_standard_output(generator: &Generator, console: &Console<'_>) -> Outcome {
    // The scene and the progress bar on one terminal would overwrite each other.
    let target = if console.is_terminal() {
        ProgressDrawTarget::hidden()
    } else {
        ProgressDrawTarget::stderr()
    };
    let bar = bar(generator, target);
    let written = console.write(|out| generator.write(bar.wrap_write(out)));
    bar.finish_and_clear();
    written
}

/// Writes a temporary file and renames it, so that a file with this name is always complete; pipes
/// and devices are written directly. Returns the number of bytes.
fn to_file(generator: &Generator, path: &Path) -> Result<u64, Failure> {
    let refused =
        |e: io::Error| Failure::stopped(format!("cannot write `{}`: {e}", path.display()));
    let bar = bar(generator, ProgressDrawTarget::stderr());
    let interrupt = Interrupt::listen()?;
    let known = fs::metadata(path).ok();
    if known.as_ref().is_some_and(fs::Metadata::is_dir) {
        let message = format!("`{}` is a directory, need a file", path.display());
        return Err(Failure::input(message));
    }
    if known.is_some_and(|known| !known.is_file()) {
        let file = File::options().write(true).open(path).map_err(refused)?;
        let mut watched = Watched::new(file, &bar, &interrupt);
        let written = generator.write(&mut watched);
        bar.finish_and_clear();
        return written.map(|()| watched.bytes).map_err(refused);
    }
    // A symbolic link is kept; the file to which it refers is replaced.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let name = path
        .file_name()
        .and_then(OsStr::to_str)
        .ok_or_else(|| Failure::input(format!("`{}` is not the name of a file", path.display())))?;
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let stopped = |e: pfaff::report::FileError| Failure::stopped(e.to_string());
    let mut file = OutputDirectory::create(folder)
        .and_then(|folder| folder.file(name))
        .map_err(stopped)?;
    let mut watched = Watched::new(&mut file, &bar, &interrupt);
    let written = generator.write(&mut watched);
    let bytes = watched.bytes;
    bar.finish_and_clear();
    if let Err(e) = written {
        // An incomplete file is removed; if that fails, its temporary name shows that it is
        // incomplete.
        drop(file);
        let _ = fs::remove_file(folder.join(format!("{name}.part")));
        return Err(Failure::stopped(e.to_string()));
    }
    file.finish().map_err(stopped)?;
    Ok(bytes)
}

fn bar(generator: &Generator, target: ProgressDrawTarget) -> ProgressBar {
    #[expect(
        clippy::cast_sign_loss,
        clippy::cast_possible_truncation,
        reason = "a size below 10 GB"
    )]
    let bytes = generator.bytes() as u64;
    // The bar is hidden if standard error is not a terminal.
    let bar = ProgressBar::with_draw_target(Some(bytes), target);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {bytes}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// A writer that shows its progress and stops if a stop is requested.
struct Watched<'a, W> {
    out: W,
    bytes: u64,
    bar: &'a ProgressBar,
    interrupt: &'a Interrupt,
}

impl<'a, W: Write> Watched<'a, W> {
    fn new(out: W, bar: &'a ProgressBar, interrupt: &'a Interrupt) -> Self {
        Self {
            out,
            bytes: 0,
            bar,
            interrupt,
        }
    }
}

impl<W: Write> Write for Watched<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.interrupt.is_asked() {
            return Err(io::Error::other("interrupted; nothing is kept"));
        }
        let written = self.out.write(bytes)?;
        self.bytes += written as u64;
        self.bar.set_position(self.bytes);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

fn facts(generator: &Generator, path: &Path, bytes: u64) -> serde_json::Value {
    let Answer {
        bodies,
        joints,
        drives,
        rows,
        rank,
        redundancy,
        mobility,
    } = generator.answer();
    json!({
        "ok": true,
        "scene": generator.name(),
        "file": path.display().to_string(),
        "bytes": bytes,
        "bodies": bodies,
        "joints": joints,
        "drives": drives,
        "rows": rows,
        "rank": rank,
        "redundancy": redundancy,
        "mobility": mobility,
        "not_unique": generator.free_reactions().len(),
    })
}

fn describe(generator: &Generator, path: &Path, bytes: u64) -> String {
    let answer = generator.answer();
    let mut text = format!(
        "{}: {}, {}, {}\nknown: rank {}, redundancy {}, mobility {}, {} not unique\nwritten to {}, {:.1} MB\n",
        generator.name(),
        count(answer.bodies, "body", "bodies"),
        count(
            answer.joints + answer.drives,
            "joint or drive",
            "joints and drives"
        ),
        count(answer.rows, "row", "rows"),
        answer.rank,
        answer.redundancy,
        answer.mobility,
        count(generator.free_reactions().len(), "reaction", "reactions"),
        path.display(),
        bytes as f64 / 1e6,
    );
    if bytes > LARGEST {
        text.push_str(&format!(
            "note: larger than the {} MiB that `pfaff` reads\n",
            LARGEST >> 20
        ));
    }
    text
}
