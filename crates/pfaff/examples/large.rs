//! Measures the cost of a large scene. The steps are reading, building, assembling, the verdict on
//! every reaction, the sensitivities, the choice of rows, and one right-hand side.
//!
//! `cargo run --release -p pfaff --example large -- SCENE.toml …`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Instant;

use pfaff::dynamics::{KeptRowMotion, RowChoice, prepare};
use pfaff::model::{Mechanism, Registry, System};
use pfaff::solvability::{Verdict, analyse};

/// Number of evaluations. The smallest time counts.
const RUNS: usize = 25;

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "     rows   columns        p      read     build  assemble  verdicts   fragile      rows     order   right-hand side  not unique"
    );
    for file in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&file)?;
        let (read, scene) = timed(|| pfaff::scene::read(&file, &text, &Registry::standard()));
        let scene = scene.map_err(|all| all.first().map_or(String::new(), ToString::to_string))?;
        let (build, mechanism) = timed(|| Mechanism::build(&scene.description));
        let mut mechanism = mechanism.map_err(|all| format!("{:?}", all.first()))?;
        let (assemble, assembly) =
            timed(|| pfaff::model::start::assemble(&mut mechanism, &scene.start));
        let q = assembly?.q;
        let (verdicts, found) = timed(|| analyse(&mechanism, 0.0, &q));
        let found = found?;
        let open = found
            .reactions
            .iter()
            .filter(|r| r.wrench.verdict == Verdict::NotUnique);
        let count = open.count();
        let (rows, columns) = (mechanism.layout().rows(), mechanism.layout().n_v);
        let (choose, prepared) = timed(|| prepare(mechanism, &scene.start, &RowChoice::Automatic));
        let prepared = prepared?;
        let hanging = || found.sensitivities(&prepared.mechanism, &prepared.q, &prepared.v);
        let (fragile, hanging) = timed(hanging);
        hanging?;
        let (plan, motion) = timed(|| KeptRowMotion::new(&prepared));
        let mut motion = motion?;
        let mut a = vec![0.0; columns];
        let mut least = f64::INFINITY;
        for _ in 0..RUNS {
            let (seconds, solved) =
                timed(|| motion.acceleration(0.0, &prepared.q, &prepared.v, &mut a));
            solved?;
            least = least.min(seconds);
        }
        println!(
            "{rows:9} {columns:9} {:8} {read:7.3} s {build:7.3} s {assemble:7.3} s {verdicts:7.3} s {fragile:7.3} s {choose:7.3} s {plan:7.3} s {:9.3} ms  {count}",
            found.decision.redundancy,
            1e3 * least
        );
    }
    Ok(())
}

fn timed<T>(f: impl FnOnce() -> T) -> (f64, T) {
    let clock = Instant::now();
    let result = f();
    (clock.elapsed().as_secs_f64(), result)
}
