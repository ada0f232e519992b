//! A loop of `measure.py` in Rust: `cargo run --release --example loops -- SCENE text 1000` in
//! `python`. Analyses the scene this many times, from its `text` or after it was `read` once.

use pfaff::model::Registry;
use pfaff::{RunOptions as Overrides, Study, StudyError};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [path, what, times] = arguments.as_slice() else {
        return Err("need a scene, `text` or `read`, and a number".into());
    };
    let text = std::fs::read_to_string(path)?;
    let registry = Registry::standard();
    let read = || Study::read("robot.toml", &text, &registry, &Overrides::default());
    let judged = |study: &Study| {
        let start = study.analyse(0.0, None)?;
        Ok::<_, StudyError>(start.verdict("W3")?.wrench.verdict.is_unique())
    };
    let study = read()?;
    for _ in 0..times.parse()? {
        let is_unique = if what == "text" {
            judged(&read()?)?
        } else {
            judged(&study)?
        };
        assert!(!is_unique, "W3 of the robot is not unique");
    }
    Ok(())
}
