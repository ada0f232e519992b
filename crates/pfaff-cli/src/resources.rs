//! Limits of a command: threads and memory. A command that needs more memory than is available is
//! refused before it starts, with the number of bytes.

use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
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
        let (allowed, by) = match (self.max_memory, available()) {
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

/// The memory that is still available, if the system reports it: of the machine, of the control
/// groups of this process, and of its address space.
fn available() -> Option<Bytes> {
    let read = |path: &Path| fs::read_to_string(path).ok();
    let machine =
        read(Path::new("/proc/meminfo")).and_then(|text| kibibytes(&text, "MemAvailable:"));
    let groups = read(Path::new("/proc/self/cgroup")).unwrap_or_default();
    let groups = folders_of_groups(&groups).into_iter().filter_map(|folder| {
        let number = |name: &str| read(&folder.join(name))?.trim().parse::<u64>().ok();
        let left = |most: &str, used: &str| Some(number(most)?.saturating_sub(number(used)?));
        left("memory.max", "memory.current")
            .or_else(|| left("memory.limit_in_bytes", "memory.usage_in_bytes"))
    });
    let space = read(Path::new("/proc/self/limits")).and_then(|limits| {
        let line = limits
            .lines()
            .find_map(|l| l.strip_prefix("Max address space"))?;
        let most: u64 = line.split_whitespace().next()?.parse().ok()?;
        let status = read(Path::new("/proc/self/status"))?;
        Some(most.saturating_sub(kibibytes(&status, "VmSize:")?))
    });
    machine
        .into_iter()
        .chain(groups)
        .chain(space)
        .min()
        .map(Bytes)
}

/// The number of bytes in a line of a table of the system in kB.
fn kibibytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|l| l.strip_prefix(name))?;
    let number: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(number << 10)
}

/// Directories of the control groups that limit the memory of a process, from its `cgroup` file:
/// its own group and all groups around it, of both versions.
fn folders_of_groups(text: &str) -> Vec<PathBuf> {
    let mut folders = Vec::new();
    for line in text.lines() {
        let mut parts = line.splitn(3, ':');
        let (_, Some(controllers), Some(path)) = (parts.next(), parts.next(), parts.next()) else {
            continue;
        };
        let root = match controllers {
            "" => Path::new("/sys/fs/cgroup"),
            _ if controllers.split(',').any(|c| c == "memory") => {
                Path::new("/sys/fs/cgroup/memory")
            }
            _ => continue,
        };
        let own = Path::new(path.trim_start_matches('/'));
        folders.extend(own.ancestors().map(|group| root.join(group)));
    }
    folders
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
    fn groups_around_a_group_count() {
        let text = "12:cpu,cpuacct:/a\n5:memory:/x\n0::/user.slice/session\n";
        let folders = folders_of_groups(text);
        let expected = [
            "/sys/fs/cgroup/memory/x",
            "/sys/fs/cgroup/memory",
            "/sys/fs/cgroup/user.slice/session",
            "/sys/fs/cgroup/user.slice",
            "/sys/fs/cgroup",
        ];
        assert_eq!(folders, expected.map(PathBuf::from));
        assert_eq!(
            kibibytes("VmPeak: 9 kB\nVmSize:\t  12 kB\n", "VmSize:"),
            Some(12 << 10)
        );
    }

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
