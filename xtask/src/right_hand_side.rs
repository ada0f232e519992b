//! The benchmark of right-hand sides and its report; the candidates are in
//! `crates/bench/benches/right_hand_side`.

use crate::tree::{cargo, root, run};

const REPORT: &str = "docs/reports/right-hand-side";

/// Measures times and instructions and writes the report.
pub(crate) fn report() -> Result<String, String> {
    bench(&["--out", REPORT])?;
    Ok(format!("written to {REPORT}"))
}

/// Measures times and instructions and only prints them.
pub(crate) fn instructions() -> Result<String, String> {
    bench(&["--instructions"])?;
    Ok("instructions by callgrind".to_owned())
}

fn bench(arguments: &[&str]) -> Result<(), String> {
    let bench = [
        "bench",
        "-p",
        "bench",
        "--features",
        "faer",
        "--bench",
        "right_hand_side",
        "--",
    ];
    run(cargo(&root()).args(bench).args(arguments))
}
