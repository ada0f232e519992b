//! What a large scene costs: reading, building, assembling, and the verdict of every reaction.
//!
//! `cargo run --release -p pfaff --example large -- SCENE.toml …`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Instant;

use pfaff::model::{Mechanism, Registry, System};
use pfaff::solvability::{Verdict, survey};

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "{:>9} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9}  not unique",
        "rows", "columns", "p", "read", "build", "assemble", "verdicts"
    );
    for file in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&file)?;
        let (read, scene) = timed(|| pfaff::scene::read(&file, &text, &Registry::planar()));
        let scene = scene.map_err(|all| all.first().map_or(String::new(), ToString::to_string))?;
        let (build, mechanism) = timed(|| Mechanism::build(&scene.description));
        let mut mechanism = mechanism.map_err(|all| format!("{:?}", all.first()))?;
        let (assemble, assembly) =
            timed(|| pfaff::model::start::assemble(&mut mechanism, &scene.start));
        let q = assembly?.q;
        let (verdicts, found) = timed(|| survey(&mechanism, 0.0, &q, |_| ()));
        let found = found?;
        let open = found
            .reactions()
            .into_iter()
            .filter(|r| r.wrench.verdict == Verdict::NotUnique);
        let layout = mechanism.layout();
        println!(
            "{:9} {:9} {:8} {read:7.3} s {build:7.3} s {assemble:7.3} s {verdicts:7.3} s  {}",
            layout.rows(),
            layout.n_v,
            found.redundancy(),
            open.count()
        );
    }
    Ok(())
}

fn timed<T>(f: impl FnOnce() -> T) -> (f64, T) {
    let clock = Instant::now();
    let result = f();
    (clock.elapsed().as_secs_f64(), result)
}
