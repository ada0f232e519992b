//! Commands start fast in a new process, including the start of the process. The bounds are five
//! times the documented times for an idle machine, so that the test detects only considerable
//! growth; `cargo xtask cold-start` prints the times.

use std::time::{Duration, Instant};

use super::{Folder, ROBOT, pfaff};

/// Number of runs of a command; the fastest one counts, because other processes can only slow it
/// down.
const RUNS: usize = 11;

fn fastest(arguments: &[&str]) -> Duration {
    let times = (0..RUNS).map(|_| {
        let clock = Instant::now();
        let output = pfaff(arguments);
        let time = clock.elapsed();
        assert!(output.status.success(), "{output:?}");
        time
    });
    times.min().unwrap_or(Duration::MAX)
}

#[test]
#[cfg_attr(debug_assertions, ignore = "times of a debug build mean nothing")]
fn an_analysis_takes_ten_milliseconds() {
    let time = fastest(&["analyze", ROBOT]);
    assert!(time < Duration::from_millis(5 * 10), "{time:?}");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "times of a debug build mean nothing")]
fn ten_seconds_with_files_take_sixty_milliseconds() {
    let folder = Folder::new("cold_start");
    let time = fastest(&["simulate", ROBOT, "--out", folder.text()]);
    assert!(time < Duration::from_millis(5 * 60), "{time:?}");
}
