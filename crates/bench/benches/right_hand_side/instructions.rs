//! Counts instructions per call with callgrind. The counts do not depend on other processes or on
//! the speed of the processor. Callgrind does not support AVX-512, so faer uses its AVX2 kernels in
//! this measurement.

use std::process::Command;

use crate::Outcome;

/// Number of laps in a short run and in a long run. The difference of the two counts does not
/// contain the start-up.
const LAPS: [u64; 2] = [1, 4];

/// Returns the instructions of one lap of a candidate.
pub(crate) fn per_lap(key: &str) -> Outcome<u64> {
    let [few, many] = LAPS;
    let difference = collected(key, many)?.saturating_sub(collected(key, few)?);
    Ok(difference / (many - few))
}

/// Returns the count of callgrind while this program repeats one candidate.
fn collected(key: &str, laps: u64) -> Outcome<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe()?)
        .args(["--repeat", key, &laps.to_string()])
        .output()
        .map_err(|e| format!("instructions need valgrind on the path: {e}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    let count = said
        .lines()
        .find_map(|line| line.split_once("Collected : "));
    match (output.status.success(), count) {
        (true, Some((_, count))) => Ok(count.trim().parse()?),
        _ => Err(format!("callgrind on {key}: {}", said.trim()).into()),
    }
}
