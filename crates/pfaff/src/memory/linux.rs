//! The available memory of Linux, read from system files.

use std::fs;
use std::path::{Path, PathBuf};

/// Returns the memory (bytes) that is still available, if the system reports it. The result is the
/// smallest of three values: the available memory of the machine, of the control groups of this
/// process, and of the address space of this process.
pub(super) fn available() -> Option<u64> {
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
    machine.into_iter().chain(groups).chain(space).min()
}

/// Returns a number of bytes from a line of a system table. The line contains the number in kB.
fn kibibytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|l| l.strip_prefix(name))?;
    let number: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(number << 10)
}

/// Lists the directories of the control groups that limit the memory of a process. The argument is
/// the text of the `cgroup` file of the process. The list contains the group of the process and all
/// enclosing groups, for both versions of control groups.
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
}
