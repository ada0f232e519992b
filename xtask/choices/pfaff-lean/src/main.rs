//! Reads a scene, prints its verdicts and writes its motion.

use pfaff::model::Registry;
use pfaff::report::OutputDirectory;
use pfaff::{RunOptions, Study};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("which scene?")?;
    let text = std::fs::read_to_string(&path)?;
    let study = Study::read(&path, &text, &Registry::standard(), &RunOptions::default())?;
    for reaction in &study.analyse(0.0, None)?.analysis.reactions {
        println!("{}: {:?}", reaction.name, reaction.wrench.verdict);
    }
    let directory = OutputDirectory::create("out")?;
    study.simulate_into(&directory, |_| std::ops::ControlFlow::Continue(()))?;
    Ok(())
}
