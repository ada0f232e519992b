//! The process that writes a file, and whether it is still running. This needs no lock, because
//! locks are unreliable in network file systems.

use std::fs;

use serde::{Deserialize, Serialize};

/// A process on a machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Process {
    /// Name of the machine.
    pub(crate) host: String,
    /// Process identifier.
    pub(crate) pid: u32,
    /// Start time of the process, in a unit of the machine, because identifiers are reused; 0 if
    /// the time is unknown.
    pub(crate) born: u64,
}

/// Whether a process is running.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Life {
    Runs,
    Gone,
    /// The process is on another machine, or the system gives no information.
    Unknown,
}

impl Process {
    /// The present process.
    pub(crate) fn own() -> Self {
        let pid = std::process::id();
        let born = Stat::of(pid).map_or(0, |stat| stat.born);
        Self {
            host: host(),
            pid,
            born,
        }
    }

    pub(crate) fn life(&self) -> Life {
        let own = Self::own();
        if *self == own {
            return Life::Runs;
        }
        // If the start time of the present process is unknown, the start times of other processes
        // are also unknown.
        if self.host != own.host || own.born == 0 || self.born == 0 {
            return Life::Unknown;
        }
        match Stat::of(self.pid) {
            Some(stat) if stat.born == self.born && !stat.has_ended => Life::Runs,
            _ => Life::Gone,
        }
    }

    /// The process as a part of a file name.
    pub(crate) fn name(&self) -> String {
        format!("{}-{}", self.host, self.pid)
    }
}

/// Name of this machine, with letters, digits and hyphens.
fn host() -> String {
    let known = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let named = || {
        ["HOSTNAME", "COMPUTERNAME"]
            .into_iter()
            .find_map(|key| std::env::var(key).ok())
    };
    let name = known.or_else(named).unwrap_or_default();
    let plain = |c: &char| c.is_ascii_alphanumeric() || *c == '-';
    let name: String = name.trim().chars().filter(plain).take(40).collect();
    if name.is_empty() {
        "machine".to_owned()
    } else {
        name
    }
}

/// Information of Linux about a process in `/proc/PID/stat`.
struct Stat {
    /// Start time in clock ticks of the machine.
    born: u64,
    /// Whether the process has ended and its parent has not yet read its exit status.
    has_ended: bool,
}

impl Stat {
    fn of(pid: u32) -> Option<Self> {
        let text = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
        // The second field is a name in brackets, which may contain any characters.
        let (_, fields) = text.rsplit_once(')')?;
        let mut fields = fields.split_whitespace();
        let state = fields.next()?;
        Some(Self {
            // Fields 3 and 22 of proc(5).
            born: fields.nth(18)?.parse().ok()?,
            has_ended: matches!(state, "Z" | "X" | "x"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Life, Process};

    #[test]
    fn only_a_process_of_this_machine_is_known_to_be_gone() {
        let own = Process::own();
        assert_eq!(own.life(), Life::Runs);
        let elsewhere = Process {
            host: "elsewhere".to_owned(),
            ..own.clone()
        };
        assert_eq!(elsewhere.life(), Life::Unknown);
        if own.born == 0 {
            return;
        }
        // This is another process that had the same identifier earlier.
        assert_eq!(
            Process {
                born: own.born - 1,
                ..own.clone()
            }
            .life(),
            Life::Gone
        );
        #[cfg(target_os = "linux")]
        {
            let mut child = std::process::Command::new("sleep")
                .arg("60")
                .spawn()
                .expect("starts");
            let born = super::Stat::of(child.id()).expect("it runs").born;
            let process = Process {
                pid: child.id(),
                born,
                ..own
            };
            assert_eq!(process.life(), Life::Runs);
            child.kill().expect("it runs");
            // The loop waits until the process has ended. The parent process need not have read the
            // exit status.
            while !super::Stat::of(child.id()).is_none_or(|stat| stat.has_ended) {
                std::thread::yield_now();
            }
            assert_eq!(process.life(), Life::Gone);
            child.wait().expect("it ended");
            assert_eq!(process.life(), Life::Gone);
        }
    }
}
