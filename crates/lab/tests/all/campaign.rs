//! Tests a short campaign with a fixed seed, and all inputs that failed in the past.

use std::path::{Path, PathBuf};
use std::time::Duration;

use lab::fuzz::campaign::Campaign;
use lab::fuzz::scenes::Space;
use lab::fuzz::trial::Reach;
use lab::fuzz::watch::{Limits, one};

fn limits() -> Limits {
    Limits {
        program: PathBuf::from(env!("CARGO_BIN_EXE_lab")),
        deadline: Duration::from_secs(10),
        memory: 2048,
    }
}

#[test]
fn a_short_campaign_finds_nothing() {
    let campaign = Campaign {
        space: Space::Plane,
        seed: 1,
        from: 100,
        inputs: 700,
        threads: 2,
        limits: limits(),
        found: Path::new(env!("CARGO_TARGET_TMPDIR")).join("found"),
    };
    let tally = campaign.run(|_| {}).expect("processes can be begun");
    assert!(tally.faults.is_empty(), "{:#?}", tally.faults);
    let count: u64 = tally.reached.values().sum();
    assert_eq!(count, campaign.inputs);
    // The test would be useless if all texts were rejected immediately.
    for reach in Reach::ALL {
        assert!(tally.reached.contains_key(&reach), "no text is {reach}");
    }
}

#[test]
fn a_fault_is_seen() {
    // This program ends without an answer, like a crashed process.
    let limits = Limits {
        program: PathBuf::from("true"),
        ..limits()
    };
    let answer = one(&limits, "").expect("there is such a program");
    let fault = answer.expect_err("no answer is a fault");
    assert!(fault.place().contains("exit"), "{fault:?}");
    let limits = Limits {
        program: PathBuf::from("cat"),
        deadline: Duration::from_millis(50),
        ..limits
    };
    // `cat try -` ends with an error; its output is not accepted as an answer.
    assert!(one(&limits, "").expect("there is such a program").is_err());
}

/// Known results beyond the limits of the checker, see `FUZZ.md`.
const OPEN: [&str; 1] = ["drive-of-a-locked-pair-far.toml"];

#[test]
fn what_was_found_is_mended() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("found");
    let limits = Limits {
        deadline: Duration::from_secs(3),
        ..limits()
    };
    for entry in std::fs::read_dir(folder).expect("readable").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(entry.path()).expect("readable");
        let answer = one(&limits, &text).expect("processes can be begun");
        let is_open = OPEN.contains(&name.as_str());
        assert!(answer.is_ok() != is_open, "{name}: {answer:?}");
    }
}

#[test]
fn wrong_arguments_are_named_and_have_code_2() {
    for (arguments, named) in [
        (["fuzz", "try", "no-such-file"].as_slice(), "no-such-file"),
        (&["fuzz", "exact", "--scenes", "0"], "--scenes"),
        (&["fuzz", "rounded", "--drawings", "0"], "--drawings"),
        (&["fuzz", "run", "--inputs", "0"], "--inputs"),
    ] {
        let output = super::lab(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = super::stderr(&output);
        assert!(said.contains(named), "{arguments:?}: {said}");
    }
}
