//! A loop of `measure.py` in Rust: `cargo run --release --example loops -- SCENE text 1000` in
//! `python`. The loop answers the question `analyze` this many times, from the `text` of the scene
//! or after the scene was `read` once.

use pfaff::memory::Budget;
use pfaff::model::Registry;
use pfaff::question::{Control, Question};
use pfaff::questions::analyze::Analyze;
use pfaff::start::Start;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [path, what, times] = arguments.as_slice() else {
        return Err("need a scene, `text` or `read`, and a number".into());
    };
    let text = std::fs::read_to_string(path)?;
    let registry = Registry::standard();
    let budget = Budget {
        limit: None,
        option: "max_memory",
    };
    let read = || Start::new("robot.toml".to_owned(), text.clone(), &registry, budget);
    let is_unique = |start: &Start<'_>| {
        let answer = Analyze::default().answer(start, &Control::quiet());
        let answer = answer.map_err(|e| e.document().error)?;
        let mut reactions = answer.document.reactions.iter();
        let found = reactions.find(|reaction| reaction.name == "W3");
        found
            .map(|reaction| reaction.wrench.verdict == "unique")
            .ok_or("the robot has no W3".to_owned())
    };
    let start = read();
    is_unique(&start)?;
    for _ in 0..times.parse()? {
        let own;
        let start = if what == "text" {
            own = read();
            &own
        } else {
            &start
        };
        assert!(!is_unique(start)?, "W3 of the robot is not unique");
    }
    Ok(())
}
