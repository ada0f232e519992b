//! Measures the times of right-hand sides (q̇ and v̇) of scenes. Each right-hand side is
//! interpreted and computed with generated code, for one state at a time and in lanes. The output
//! also contains the size of the code and the time of its compilation:
//! `cargo run --release -p pfaff-scene-codegen --example right_hand_side --
//! examples/hexapod.toml`. The states belong to the run that the scene defines; each time is the
//! smallest of several rounds.

use std::fmt::Write as _;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use dynamics::KeptRowMotion;
use model::System;
use pfaff::model::Registry;
use pfaff::{AssembledScene, RunOptions};
use pfaff_scene_codegen::{Choices, Subject, generate};

type Failure = Box<dyn std::error::Error>;

/// Number of rounds over all states. The time of the fastest round counts, because each round is
/// shorter than a time slice of the scheduler.
const ROUNDS: usize = 1000;

/// The program that is compiled with the module `code`. It prints the time for one state (ns):
/// computed alone, in 4 lanes and in 8 lanes.
const TIMER: &str = "
use std::hint::black_box;
use std::time::Instant;
use code::*;

fn least(states: usize, mut f: impl FnMut()) -> f64 {
    let time = || { let began = Instant::now(); f(); began.elapsed().as_secs_f64() };
    let least = std::iter::repeat_with(time).take(ROUNDS).fold(f64::INFINITY, f64::min);
    1e9 * least / states as f64
}

fn lanes<const L: usize>(states: &[(f64, [f64; N_Q], [f64; N_V])]) -> f64 {
    let groups: Vec<_> = states.chunks_exact(L).map(|group| {
        let (mut t, mut q, mut v) = ([0.0; L], [[0.0; L]; N_Q], [[0.0; L]; N_V]);
        for (l, state) in group.iter().enumerate() {
            t[l] = state.0;
            for k in 0..N_Q { q[k][l] = state.1[k]; }
            for k in 0..N_V { v[k][l] = state.2[k]; }
        }
        (t, q, v)
    }).collect();
    let (mut a, mut qd) = ([[0.0; L]; N_V], [[0.0; L]; N_Q]);
    least(L * groups.len(), || for (t, q, v) in &groups {
        RATE_OF
        black_box(acceleration_of(black_box(t), black_box(q), black_box(v), &mut a));
        black_box((&a, &qd));
    })
}

fn main() {
    let states = STATES;
    let (mut a, mut qd) = ([0.0; N_V], [0.0; N_Q]);
    let one = least(states.len(), || for (t, q, v) in &states {
        RATE
        black_box(acceleration(black_box(*t), black_box(q), black_box(v), &mut a));
        black_box((&a, &qd));
    });
    println!(\"{one} {} {}\", lanes::<4>(&states), lanes::<8>(&states));
}
";

#[expect(clippy::print_stdout, reason = "a program prints its measurements")]
fn main() -> Result<(), Failure> {
    println!(
        "| scene | bodies | operations | interpreted | generated | 4 lanes, each | 8 lanes, each | lines | bytes | compiled in |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for path in std::env::args().skip(1) {
        println!("{}", measured(&path)?);
    }
    Ok(())
}

fn measured(path: &str) -> Result<String, Failure> {
    let text = std::fs::read_to_string(path)?;
    let study =
        AssembledScene::read(path, &text, &Registry::standard())?.prepare(&RunOptions::default())?;
    let prepared = &study.prepared;
    let options = study.options.as_ref().ok_or("the scene has no run")?;
    let subject = Subject::of_run(prepared, options)?;
    let module = generate(&subject, &Choices::default())?.named("code");
    let code = module.as_item();

    let mechanism = &prepared.mechanism;
    let mut motion = KeptRowMotion::new(prepared)?;
    let mut a = vec![0.0; prepared.v.len()];
    let mut qd = vec![0.0; prepared.q.len()];
    let mut interpreted = f64::INFINITY;
    for _ in 0..ROUNDS {
        let began = Instant::now();
        for state in &subject.states {
            mechanism.rate(&state.q, &state.v, &mut qd);
            motion.acceleration(state.t, &state.q, &state.v, &mut a)?;
            black_box((&a, &qd));
        }
        interpreted = interpreted.min(began.elapsed().as_secs_f64());
    }
    let interpreted = 1e9 * interpreted / subject.states.len() as f64;

    let folder = std::env::temp_dir().join("pfaff-right-hand-side");
    std::fs::create_dir_all(&folder)?;
    let mut states = String::from("[");
    for state in &subject.states {
        write!(states, "({:?}, {:?}, {:?}),", state.t, state.q, state.v)?;
    }
    states.push(']');
    let has_rate = code.contains("pub fn rate(");
    let timer = TIMER
        .replace(
            "RATE_OF",
            if has_rate {
                "rate_of(t, q, v, &mut qd);"
            } else {
                ""
            },
        )
        .replace(
            "RATE",
            if has_rate {
                "rate(*t, q, v, &mut qd);"
            } else {
                ""
            },
        )
        .replace("STATES", &states)
        .replace("ROUNDS", &ROUNDS.to_string());
    std::fs::write(folder.join("main.rs"), format!("{code}\n{timer}"))?;
    let arguments = ["--edition", "2024", "-C", "opt-level=3", "-A", "warnings"];
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let began = Instant::now();
    let status = Command::new(compiler)
        .current_dir(&folder)
        .args(arguments)
        .args(["main.rs", "-o", "main"])
        .status()?;
    let compiled = began.elapsed().as_secs_f64();
    if !status.success() {
        return Err(format!("{path}: the module does not compile").into());
    }
    let output = Command::new(Path::new(&folder).join("main")).output()?;
    let times: Vec<String> = String::from_utf8(output.stdout)?
        .split_whitespace()
        .map(|ns| format!("{:.0} ns", ns.parse::<f64>().unwrap_or(f64::NAN)))
        .collect();
    let operations = code
        .lines()
        .find_map(|line| line.strip_prefix("/// | `acceleration` | "))
        .unwrap_or_default();
    Ok(format!(
        "| {} | {} | {operations} {interpreted:.0} ns | {} | {} | {} | {compiled:.1} s |",
        mechanism.name(),
        mechanism.bodies().len(),
        times.join(" | "),
        code.lines().count(),
        code.len(),
    ))
}
