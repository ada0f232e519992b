//! Computes rank, kept rows and unique rows of large sparse mechanisms whose answers are known, and
//! measures how the time grows: `cargo run --release -p pfaff-rank --example large_rank`. If a
//! directory is given as argument, the matrices are also written to this directory, for
//! `crates/bench/spqr`.
#![allow(clippy::print_stdout, reason = "this example exists for its output")]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use linalg::minimum_degree;
use mechanisms::{Known, chain, grid, table};
use pfaff_rank::{CoefficientReading, Sketch, SparsePattern};

#[path = "../tests/mechanisms/mod.rs"]
mod mechanisms;

/// Writes the matrix as lines `row column value` after a line `rows columns entries`.
fn write(known: &Known, directory: &Path) -> std::io::Result<()> {
    let name = known.name.replace(' ', "_");
    let mut file = std::io::BufWriter::new(std::fs::File::create(directory.join(name + ".txt"))?);
    let c = &known.c;
    writeln!(file, "{} {} {}", c.nrows(), c.ncols(), c.nnz())?;
    for i in 0..c.nrows() {
        let (columns, values) = c.row(i);
        for (j, value) in columns.iter().zip(values) {
            writeln!(file, "{i} {j} {value:e}")?;
        }
    }
    file.flush()
}

/// Runs one matrix; returns the total time (s) and a line of text.
fn run(known: &Known) -> (f64, String) {
    let seconds = |since: Instant| since.elapsed().as_secs_f64();
    let cliques: Vec<Vec<usize>> = (0..known.c.nrows())
        .map(|i| known.c.row(i).0.iter().map(|j| j / 3).collect())
        .collect();
    let start = Instant::now();
    let order = minimum_degree(known.bodies.len(), &cliques);
    let t_order = seconds(start);
    assert_eq!(order.len(), known.bodies.len());
    let start = Instant::now();
    let pattern = SparsePattern::new(&known.c, &known.bodies).expect("sparse");
    let t_pattern = seconds(start);
    let start = Instant::now();
    let found = pattern
        .decide(&known.c, 0.0, Sketch::default())
        .expect("finite");
    let t_decide = seconds(start);
    let wrong = known
        .is_unique
        .iter()
        .enumerate()
        .filter(|&(i, &is_unique)| {
            let reading = if is_unique {
                CoefficientReading::Zero
            } else {
                CoefficientReading::NonZero
            };
            found.read_row(i) != reading
        });
    let e = &found.evidence;
    let line = format!(
        "{:12} {:6} × {:6}, p {:5} (true {:5}) | order {:.4} s, pattern {:.4} s, decide {:.4} s, {:6.1} MB | wrong rows {}, {} | σ_r ≥ {:.1e}, \
         σ_next {:.1e}, E {:.1e}, spread {:.1e}",
        known.name,
        known.c.nrows(),
        known.c.ncols(),
        found.redundancy,
        known.redundancy,
        t_order,
        t_pattern,
        t_decide,
        e.bytes as f64 / 1e6,
        wrong.count(),
        if found.is_decided() {
            "decided"
        } else {
            "undecided"
        },
        e.sigma_r,
        e.sigma_next,
        e.backward_error,
        e.smallest_margin / e.largest_zero
    );
    (t_pattern + t_decide, line)
}

fn family(name: &str, members: Vec<Known>, directory: Option<&Path>) {
    let mut measured: Vec<(f64, f64)> = Vec::new();
    for known in &members {
        if let Some(directory) = directory {
            write(known, directory).expect("directory to write to");
        }
        let runs = (0..3).map(|_| run(known));
        let (best, line) = runs.min_by(|a, b| a.0.total_cmp(&b.0)).expect("three runs");
        println!("{line}");
        measured.push((known.c.nrows() as f64, best));
    }
    if let [_, (small, fast), .., (large, slow)] = measured[..] {
        let exponent = (slow / fast).ln() / (large / small).ln();
        println!("{name}: time grows with the power {exponent:.2} of the rows\n");
    }
}

fn main() {
    let directory = std::env::args().nth(1).map(PathBuf::from);
    let chains = [30, 300, 3_000, 9_000].map(chain);
    family("chains", chains.into(), directory.as_deref());
    let tables = [30, 100, 300, 1_000].map(table);
    family("tables", tables.into(), directory.as_deref());
    let grids = [10, 30, 60, 100].map(grid);
    family("grids", grids.into(), directory.as_deref());
}
