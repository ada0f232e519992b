//! Benchmarks the time to explain the verdicts on the robot, in addition to the time of its rank
//! decision:

use std::hint::black_box;

use divan::Bencher;
use model::{ConstraintId, Function, Mechanism, Scratch, System};
use rank::Limits;
use solvability::{DeletableRows, Solvability, certify, explain, make_unique};
use tests::robot::robot;

fn main() {
    divan::main();
}

fn judged() -> (Mechanism, Vec<f64>, Scratch, Solvability) {
    let motion = Function::constant(0.0).expect("finite");
    let mechanism = Mechanism::build(&robot(motion)).expect("the robot builds");
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let decision = certify(&mechanism, 0.0, &q).expect("C is finite");
    let solvability = Solvability::from_decision(&mechanism.layout().dense(&s), decision);
    (mechanism, q, s, solvability)
}

/// Computes self-stresses, coupled reactions, the text of reactions, and the structure.
#[divan::bench]
fn explanation(bencher: Bencher<'_, '_>) {
    let (m, q, s, solvability) = judged();
    assert_eq!(
        explain(&m, &s, &q, &solvability)
            .expect("finite")
            .stresses
            .len(),
        2
    );
    bencher.bench_local(|| explain(&m, &s, black_box(&q), &solvability));
}

/// Finds the four ways to make the reaction of W3 unique.
#[divan::bench]
fn making_w3_unique(bencher: Bencher<'_, '_>) {
    let (m, _, _, solvability) = judged();
    let w3 = m
        .layout()
        .groups
        .iter()
        .position(|g| g.name == "W3")
        .expect("W3 exists");
    let ask = || {
        make_unique(
            &m,
            &solvability,
            ConstraintId(w3),
            &DeletableRows::Sensible,
            Limits::default(),
        )
    };
    assert_eq!(ask().expect("decided").ways.len(), 4);
    bencher.bench_local(|| black_box(ask()));
}

/// Counts and lists nine admissible pairs.
#[divan::bench]
fn admissible_deletions(bencher: Bencher<'_, '_>) {
    let (_, _, _, solvability) = judged();
    let decision = solvability.decision();
    assert_eq!(rank::count_deletions(decision), Ok(9));
    bencher.bench_local(|| {
        (
            rank::count_deletions(decision),
            rank::deletions(decision, 100),
        )
    });
}
