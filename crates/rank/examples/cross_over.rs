//! One acceleration by the dense and by the sparse solver, on kept rows of growing mechanisms: from
//! how many rows on is the sparse solver faster?
//!
//! `cargo run --release -p pfaff-rank --example cross_over`
#![allow(
    clippy::print_stdout,
    reason = "the output is what this example is for"
)]

use std::time::Instant;

use linalg::{KeptRowSaddle, SchurSaddle, SchurStructure};
use mechanisms::{Known, chain, grid, table};
use rank::{Sketch, decide_sparse};

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

/// Kept rows, and microseconds of factorisation and solution, dense and sparse.
fn compare(known: &Known) -> (usize, f64, f64) {
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

    let rows = c.dense();
    let columns: Vec<Vec<usize>> = (0..r).map(|i| c.row(i).0.to_vec()).collect();
    let mut saddle = KeptRowSaddle::with_columns(n, &columns).expect("r ≤ n");
    let dense = least(|| {
        saddle.factor(|k| rows.row(k), &mass).expect("independent");
        saddle.motion(&force, &gamma, &mut a).expect("solved");
    });
    let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &known.bodies));
    let sparse = least(|| {
        saddle.factor(&c, &mass).expect("independent");
        saddle
            .solve(&c, &force, &gamma, &mut b, &mut lambda)
            .expect("solved");
    });
    let size = a.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9 * size));
    (r, 1e6 * dense, 1e6 * sparse)
}

fn main() {
    println!("mechanism    kept rows      dense     sparse  dense/sparse");
    let chains = [1, 2, 3, 4, 5, 6, 8, 12, 24].map(chain);
    let tables = [3, 6, 9, 12, 16, 24, 48].map(table);
    let grids = [2, 3, 4, 5, 6, 8].map(grid);
    for known in chains.iter().chain(&tables).chain(&grids) {
        let (rows, dense, sparse) = compare(known);
        println!(
            "{:12} {rows:9} {dense:7.2} µs {sparse:7.2} µs {:13.2}",
            known.name,
            dense / sparse
        );
    }
}
