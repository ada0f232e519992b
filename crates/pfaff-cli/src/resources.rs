//! Limits of a command: threads and memory. A command that needs more memory than is available is
//! refused before it starts, with the number of bytes.

#[cfg(target_os = "linux")]
mod linux;

use std::num::NonZeroUsize;
use std::str::FromStr;
use std::thread;
use std::time::Duration;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use pfaff::AssembledScene;
use pfaff::memory::of_reading;
use pfaff::model::codes::Code;

use crate::input::Source;
use crate::output::Failure;

#[cfg(target_os = "linux")]
use linux::available;

#[derive(Args, Clone, Copy, Default)]
pub(crate) struct Resources {
    /// Largest number of threads; default: the number of cores
    #[arg(long, value_name = "K")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Largest memory, as 500MB or 4GiB: computations that need more are refused; default: the
    /// available memory of the machine
    #[arg(long, value_name = "SIZE")]
    pub(crate) max_memory: Option<Bytes>,
}

impl Resources {
    /// Sets the number of threads for all parallel computations.
    pub(crate) fn apply(self) {
        pfaff::start_threads(self.threads);
    }

    /// Reads the scene and builds its mechanism, if the memory suffices for the mechanism and its
    /// verdicts.
    pub(crate) fn assembled(self, source: &Source) -> Result<AssembledScene, Failure> {
        let text = source.text.len();
        let reading = of_reading(text);
        self.allow(reading, "reading this scene")?;
        let _said = Stage::begin(source, "reading and building");
        let read = AssembledScene::read(&source.name, &source.text, source.registry)
            .and_then(|assembled| assembled.stating(source.tolerance));
        let assembled = read.map_err(|e| source.failure(e))?;
        let threads = pfaff::threads();
        let verdicts = assembled.memory_of_verdicts(threads);
        let verdicts = verdicts.map_err(|e| source.failure(e))?;
        self.allow(reading + verdicts, "deciding the ranks of this scene")?;
        Ok(assembled)
    }

    /// Refuses a computation that needs more memory than is allowed.
    pub(crate) fn allow(self, bytes: usize, what: &str) -> Result<(), Failure> {
        let needed = Bytes(bytes as u64);
        let (allowed, by) = match (self.max_memory, available().map(Bytes)) {
            (Some(limit), _) => (limit, "--max-memory allows"),
            (None, Some(left)) => (left, "the machine has left"),
            (None, None) => return Ok(()),
        };
        if needed.0 <= allowed.0 {
            Ok(())
        } else {
            Err(Failure::stopped(format!(
                "{what} takes about {needed} of memory, {by} {allowed}; nothing was computed{}",
                match self.max_memory {
                    Some(_) => "",
                    None => " (--max-memory overrides this)",
                }
            ))
            .coded(const { Code::new(7) }))
        }
    }
}

/// A size in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bytes(pub(crate) u64);

/// Units that can be read, larger ones first.
const UNITS: [(&str, u64); 9] = [
    ("TiB", 1 << 40),
    ("GiB", 1 << 30),
    ("MiB", 1 << 20),
    ("KiB", 1 << 10),
    ("TB", 1_000_000_000_000),
    ("GB", 1_000_000_000),
    ("MB", 1_000_000),
    ("kB", 1_000),
    ("B", 1),
];

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let said = || {
            format!(
                "`{text}` is no size; write a number with B, kB, MB, GB, TB, KiB, MiB, GiB or TiB, as 4GB"
            )
        };
        let (number, unit) = UNITS
            .iter()
            .find_map(|(name, bytes)| Some((text.strip_suffix(name)?, *bytes)))
            .ok_or_else(said)?;
        let number: f64 = number.trim().parse().map_err(|_| said())?;
        let bytes = number * unit as f64;
        if number > 0.0 && bytes < u64::MAX as f64 {
            Ok(Self(bytes as u64))
        } else {
            Err(said())
        }
    }
}

impl std::fmt::Display for Bytes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bytes = self.0 as f64;
        match self.0 {
            1_000_000_000.. => write!(f, "{:.1} GB", bytes / 1e9),
            _ => write!(f, "{:.0} MB", (bytes / 1e6).max(1.0)),
        }
    }
}

/// The memory (bytes) of the machine that is still available, if the system reports it.
#[cfg(not(target_os = "linux"))]
fn available() -> Option<u64> {
    let mut system = sysinfo::System::new().ok()?;
    system.refresh_memory();
    // A system that is not known reports 0.
    Some(system.available_memory()).filter(|bytes| *bytes > 0)
}

/// Texts of at least this size (bytes) take long to read.
const LONG: usize = 1 << 20;

/// A message on a terminal that names the present step of long work; dropping it removes the
/// message.
pub(crate) struct Stage(Option<ProgressBar>);

impl Stage {
    pub(crate) fn begin(source: &Source, what: &str) -> Self {
        let size = source.text.len();
        Self((size >= LONG).then(|| {
            let bar = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
                bar.set_style(style);
            }
            bar.set_message(format!("{what}: {}", Bytes(size as u64)));
            // The bar ticks on a thread of its own; without one it stands still.
            if !bar.is_hidden() && thread::Builder::new().spawn(|| ()).is_ok() {
                bar.enable_steady_tick(Duration::from_millis(100));
            }
            bar
        }))
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        let read = |text: &str| text.parse::<Bytes>().ok().map(|bytes| bytes.0);
        assert_eq!(read("4GB"), Some(4_000_000_000));
        assert_eq!(read("1.5 MiB"), Some(1_572_864));
        assert_eq!(read("10B"), Some(10));
        for wrong in ["", "4", "GB", "-1GB", "NaNGB", "0MB", "1e99TB", "4gb"] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
