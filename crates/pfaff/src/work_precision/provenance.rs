//! The origin of runs: machine and date.

use std::env::consts::{ARCH, OS};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};
use std::{env, fs};

/// Returns processor, number of available cores and operating system.
#[must_use]
pub fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "{}, {cores} cores, {} {}",
        processor().unwrap_or_else(|| "unknown processor".to_owned()),
        OS,
        ARCH
    )
}

/// Returns the name of the processor, if the system provides the name in a file, in a variable or
/// by a program. No library is linked for this purpose.
fn processor() -> Option<String> {
    let name = match OS {
        "windows" => env::var("PROCESSOR_IDENTIFIER").ok()?,
        "macos" => {
            let mut asked = Command::new("sysctl");
            let told = asked
                .args(["-n", "machdep.cpu.brand_string"])
                .output()
                .ok()?;
            String::from_utf8(told.stdout).ok()?
        }
        _ => {
            let text = fs::read_to_string("/proc/cpuinfo").ok()?;
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            line.split_once(':')?.1.to_owned()
        }
    };
    Some(name.trim().to_owned()).filter(|name| !name.is_empty())
}

/// Returns the current date and time in UTC, in the form `2026-11-21 16:20 UTC`.
#[must_use]
pub fn date() -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let minutes = since.map_or(0, |d| d.as_secs() / 60);
    let (days, minute) = (minutes / 1440, minutes % 1440);
    let [year, month, day] = civil(days);
    format!(
        "{year}-{month:02}-{day:02} {:02}:{:02} UTC",
        minute / 60,
        minute % 60
    )
}

/// Converts a number of days after 1970-01-01 to year, month and day, in the Gregorian calendar.
/// Here years begin in March, so that the leap day is the last day of a year. An era has 400 years.
fn civil(days: u64) -> [u64; 3] {
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    [era * 400 + year + next, month, day]
}

#[cfg(test)]
mod tests {
    use super::civil;

    #[test]
    fn days_have_their_dates() {
        // The dates come from the calendar: the first day, the leap days of 1972 and 2000, and the
        // first of March after each leap day.
        assert_eq!(civil(0), [1970, 1, 1]);
        assert_eq!(civil(789), [1972, 2, 29]);
        assert_eq!(civil(790), [1972, 3, 1]);
        assert_eq!(civil(11_016), [2000, 2, 29]);
        assert_eq!(civil(11_017), [2000, 3, 1]);
        assert_eq!(civil(20_778), [2026, 11, 21]);
    }
}
