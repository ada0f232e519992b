//! Computes one acceleration in the null space and through the Schur complement, on kept rows of
//! growing mechanisms. The program shows from how many rows and free motions on the Schur
//! complement is faster.
//!
//! `cargo run --release -p pfaff-rank --example cross_over`
#![allow(clippy::print_stdout, reason = "this example exists for its output")]

use std::time::Instant;

use linalg::{KeptRowSaddle, SchurSaddle, SchurStructure};
use mechanisms::{Known, chain, grid, table};
use pfaff_rank::{Sketch, decide_sparse};

#[path = "../tests/mechanisms/mod.rs"]
mod mechanisms;

/// Smallest time of several runs (s).
fn least(mut run: impl FnMut()) -> f64 {
    const RUNS: usize = 200;
    let times = (0..RUNS).map(|_| {
        let begun = Instant::now();
        run();
        begun.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

/// Returns the numbers of kept rows and free motions, and the microseconds that factorisation and
/// solution take with each method.
fn compare(known: &Known) -> ([usize; 2], [f64; 2]) {
    let decided = decide_sparse(&known.c, 0.0, &known.bodies, Sketch::default()).expect("sparse");
    assert_eq!(decided.redundancy, known.redundancy, "{}", known.name);
    let is_unique = |k: &usize| decided.margin(*k) < 1e-9;
    assert!((0..known.c.nrows()).all(|k| is_unique(&k) == known.is_unique[k]));
    let c = known.c.select_rows(&decided.kept);
    let (n, r) = (c.ncols(), c.nrows());
    let mass: Vec<f64> = (0..n).map(|j| if j % 3 == 2 { 0.1 } else { 1.0 }).collect();
    let force: Vec<f64> = (0..n)
        .map(|j| if j % 3 == 1 { -9.81 } else { 0.0 })
        .collect();
    let gamma = vec![0.1; r];
    let (mut a, mut b, mut lambda) = (vec![0.0; n], vec![0.0; n], vec![0.0; r]);

    let columns: Vec<Vec<usize>> = (0..r).map(|i| c.row(i).0.to_vec()).collect();
    let mut saddle = KeptRowSaddle::with_columns(n, &columns).expect("r ≤ n");
    let null_space = least(|| {
        saddle.factor(|k| c.row(k).1, &mass).expect("independent");
        saddle.motion(&force, &gamma, &mut a).expect("solved");
    });
    let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &known.bodies));
    let schur = least(|| {
        saddle.factor(&c, &mass).expect("independent");
        saddle
            .solve(&c, &force, &gamma, &mut b, &mut lambda)
            .expect("solved");
    });
    let size = a.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9 * size));
    ([r, n - r], [1e6 * null_space, 1e6 * schur])
}

fn main() {
    println!("mechanism    kept rows  free  null space      Schur  ratio");
    let chains = [1, 2, 3, 4, 5, 6, 8, 12, 24, 48].map(chain);
    let tables = [3, 6, 9, 12, 16, 24, 48].map(table);
    let grids = [2, 3, 4, 5, 6, 8, 12].map(grid);
    for known in chains.iter().chain(&tables).chain(&grids) {
        let ([rows, free], [null_space, schur]) = compare(known);
        println!(
            "{:12} {rows:9} {free:5} {null_space:8.2} µs {schur:7.2} µs {:6.2}",
            known.name,
            null_space / schur
        );
    }
}
